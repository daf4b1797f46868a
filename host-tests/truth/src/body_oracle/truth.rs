//! The closest point of a whole body, in double precision.

use crate::oracle::{ClosestPoint, Oracle, OraclePoint};
use glam::DVec3;
use palpate_bake::NurbsPatch;

/// One oracle a patch.
#[derive(Clone, Debug)]
pub struct BodyOracle<'a> {
    patches: &'a [NurbsPatch],
    oracles: Vec<Oracle<'a>>,
    /// Bounding boxes of the control points: weights are positive, so that they hold the patches.
    boxes: Vec<[DVec3; 2]>,
}

/// Points of several patches that differ by less than this part of the size are one.
const SAME: f64 = 1e-9;
/// Of the way to the middle of the patch.
const OFF_THE_BORDER: f64 = 1e-4;
/// The sine of an angle that turning by the curvature over that way can make up.
const IN_ITS_PLANE: f64 = 1e-3;

/// What is true of a probe.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The closest point of each patch.
    pub feet: Vec<ClosestPoint>,
    /// Index of the patch with the nearest.
    pub nearest: usize,
    /// Height of the probe over each patch's foot along the outward normal there, metres. At a pole, where there is no
    /// normal, NaN.
    pub heights: Vec<f64>,
}

impl Truth {
    /// The body's distance, metres.
    pub fn distance(&self) -> f64 {
        self.feet[self.nearest].distance
    }

    /// The closest point.
    pub fn point(&self) -> DVec3 {
        self.feet[self.nearest].point
    }

    /// Whether the probe is inside a closed convex body: behind every face.
    pub fn is_inside_convex(&self) -> bool {
        self.heights.iter().all(|height| is_behind(*height))
    }
}

impl<'a> BodyOracle<'a> {
    /// Samples every patch.
    pub fn new(patches: &'a [NurbsPatch]) -> Self {
        let bounds = |patch: &NurbsPatch| {
            let whole = [DVec3::INFINITY, DVec3::NEG_INFINITY];
            patch.points.iter().fold(whole, |[low, high], point| [low.min(*point), high.max(*point)])
        };
        let boxes = patches.iter().map(bounds).collect();
        Self { patches, oracles: patches.iter().map(Oracle::new).collect(), boxes }
    }

    /// The closest point of the body and those of other patches that are at most `within` metres farther, with the
    /// patches' indices, the nearest first. Patches whose bounding box is too far are left out.
    pub fn nearest(&self, probe: DVec3, within: f64) -> Vec<(usize, ClosestPoint)> {
        let distance = |[low, high]: &[DVec3; 2]| probe.distance(probe.clamp(*low, *high));
        let mut order: Vec<_> = self.boxes.iter().map(distance).enumerate().collect();
        order.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut found: Vec<(usize, ClosestPoint)> = Vec::new();
        let mut least = f64::INFINITY;
        for (index, bound) in order {
            if bound > least + within {
                break;
            }
            let foot = self.oracles[index].closest(probe);
            least = least.min(foot.distance);
            found.push((index, foot));
        }
        found.retain(|(_, foot)| foot.distance <= least + within);
        found.sort_by(|a, b| a.1.distance.total_cmp(&b.1.distance));
        found
    }

    /// Height of the probe over one patch's closest point, see [`Truth::heights`].
    pub fn height(&self, index: usize, probe: DVec3) -> f64 {
        height(&self.patches[index], &self.oracles[index].closest(probe), probe)
    }

    /// Whether the probe is inside a closed convex body; `nearest` is the patch with the closest point.
    pub fn is_inside_convex(&self, nearest: usize, probe: DVec3) -> bool {
        // Outside it is mostly the nearest that says so.
        let rest = (0..self.patches.len()).filter(|index| *index != nearest);
        std::iter::once(nearest).chain(rest).all(|index| is_behind(self.height(index, probe)))
    }

    /// Whether the probe is inside a closed body of any shape, by the outward normals of all patches that hold the
    /// closest point; `None` on the surface, and where these normals do not agree (at a vertex that is a saddle).
    pub fn is_inside(&self, probe: DVec3) -> Option<bool> {
        let nearest = self.nearest(probe, SAME * self.scale());
        let (_, foot) = nearest.first()?;
        let away = (probe - foot.point).try_normalize()?;
        let heights: Vec<f64> = nearest
            .iter()
            .map(|(index, foot)| {
                // A little way off the border: a pole has no normal.
                let [u, v] = foot.parameters.map(|parameter| parameter + OFF_THE_BORDER * (0.5 - parameter));
                away.dot(OraclePoint::evaluate(&self.patches[*index], u, v).normal(self.patches[*index].flip))
            })
            .collect();
        let sum: f64 = heights.iter().sum();
        // Beside an edge the probe may lie in the plane of one of its faces.
        let agree = heights.iter().all(|height| height * sum.signum() > -IN_ITS_PLANE);
        (agree && sum.abs() > IN_ITS_PLANE).then_some(sum < 0.0)
    }

    /// A length of about the body's size.
    fn scale(&self) -> f64 {
        self.boxes.iter().map(|[low, high]| (*high - *low).max_element()).fold(0.0, f64::max)
    }

    /// The truth about a probe, metres.
    pub fn closest(&self, probe: DVec3) -> Truth {
        let feet: Vec<_> = self.oracles.iter().map(|oracle| oracle.closest(probe)).collect();
        let nearest = (0..feet.len())
            .fold(0, |best, index| if feet[index].distance < feet[best].distance { index } else { best });
        let heights = self.patches.iter().zip(&feet).map(|(patch, foot)| height(patch, foot, probe)).collect();
        Truth { feet, nearest, heights }
    }
}

fn height(patch: &NurbsPatch, foot: &ClosestPoint, probe: DVec3) -> f64 {
    let [u, v] = foot.parameters;
    (probe - foot.point).dot(OraclePoint::evaluate(patch, u, v).normal(patch.flip))
}

/// A pole has no height, and never decides.
fn is_behind(height: f64) -> bool {
    height.is_nan() || height < 0.0
}
