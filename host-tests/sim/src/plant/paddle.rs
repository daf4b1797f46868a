//! The simulated one-joint paddle.

use super::lumped::{Geometry, Point, Points};
use super::vector::Vector;

/// A handle on an axis; the probe's place is the arc it has gone, along x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaddleSettings {
    /// From the axis to the hand, m.
    pub handle: f64,
    /// Moment of inertia of the paddle about its axis, kg·m².
    pub inertia: f64,
    /// Mass of the paddle, kg.
    pub mass: f64,
    /// Height of its centre over the axis, m.
    pub centre: f64,
}

impl Geometry for PaddleSettings {
    fn joints(&self) -> usize {
        1
    }

    fn points(&self, [angle, ..]: Vector) -> Points {
        let (sine, cosine) = angle.sin_cos();
        let column = |entries: Vector| entries.map(|entry| [entry, 0.0, 0.0]);
        let probe = Point {
            place: [self.handle * angle, 0.0, 0.0],
            jacobian: column([self.handle, 0.0, 0.0]),
            ..Point::default()
        };
        // Its inertia is in the joint's.
        let centre = Point {
            weight: self.mass,
            place: [self.centre * sine, 0.0, self.centre * cosine],
            jacobian: column([self.centre * cosine, 0.0, -self.centre * sine]),
            ..Point::default()
        };
        let mut points = Points::default();
        (points[0], points[1]) = (probe, centre);
        points
    }

    fn angles(&self, [x, ..]: Vector) -> Option<Vector> {
        x.is_finite().then_some([x / self.handle, 0.0, 0.0])
    }
}
