//! `truck-geometry`: Newton's method on B-splines in double precision; without a hint from the nearest of 51 × 51
//! samples.

use crate::contestant::{Answer, Contestant};
use crate::ours;
use crate::scene::{Probe, Scene};
use truck_geometry::prelude::{BSplineSurface, KnotVec, Point3, SPHint2D, SearchNearestParameter as _};

/// As in truck's own use of it.
const TRIALS: usize = 100;
/// truck's tolerances are absolute, made for lengths of about this.
const SIZE: f64 = 10.0;

/// Without a hint.
pub fn cold(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    let (surface, scale) = surface(scene);
    Ok(Box::new(Truck { surface, scale, is_tracking: false, last: None }))
}

/// With its last answer as the hint, as it is: also where it lies off the patch. Without one after it gave up.
pub fn track(scene: &Scene) -> anyhow::Result<Box<dyn Contestant>> {
    let (surface, scale) = surface(scene);
    let [u, v] = ours::start(scene).parameters.map(f64::from);
    Ok(Box::new(Truck { surface, scale, is_tracking: true, last: Some((u, v)) }))
}

struct Truck {
    surface: BSplineSurface<Point3>,
    scale: f64,
    is_tracking: bool,
    last: Option<(f64, f64)>,
}

impl Contestant for Truck {
    fn answer(&mut self, probe: &Probe) -> Answer {
        let hint = match self.last {
            Some((u, v)) if self.is_tracking => SPHint2D::Parameter(u, v),
            _ => SPHint2D::None,
        };
        let [x, y, z] = probe.double.map(|value| value * self.scale);
        self.last = self.surface.search_nearest_parameter(Point3::new(x, y, z), hint, TRIALS);
        self.last.map_or(Answer::Nothing, |(u, v)| Answer::Parameters([u, v]))
    }
}

fn surface(scene: &Scene) -> (BSplineSurface<Point3>, f64) {
    let all = || scene.points.iter().flatten();
    let largest = |axis: usize| {
        let values = || all().map(move |point| point[axis]);
        values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
    };
    let scale = SIZE / (0..3).map(largest).fold(0.0, f64::max);
    let [knots_u, knots_v] = scene.knots.clone().map(KnotVec::from);
    let point = |[x, y, z]: &[f64; 3]| Point3::new(x * scale, y * scale, z * scale);
    let points = scene.points.iter().map(|row| row.iter().map(point).collect()).collect();
    (BSplineSurface::new((knots_u, knots_v), points), scale)
}
