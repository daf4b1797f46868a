//! The simulated delta, after Stamper's drawing.
//!
//! The forward map is Newton's method in f64 on the legs' closures as differences of squares; the inverse is closed
//! form. Lumped: each shin is half at its knee and half at the probe.

use super::lumped::{Geometry, Point, Points};
use super::vector::{Matrix, Vector, add_scaled, difference, dot, inverse, norm, scaled, times};

/// Stamper's lengths, and the masses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeltaSettings {
    /// Thigh, m.
    pub a: f64,
    /// Long side of the shin's parallelogram, m.
    pub b: f64,
    /// From the shins' ends to the probe, outward, m.
    pub c: f64,
    /// Stub at the knee, m.
    pub d: f64,
    /// Stub at the probe, m.
    pub e: f64,
    /// From the shins' ends to the probe, sideways, m.
    pub f: f64,
    /// From the axis to the hip, outward, m.
    pub r: f64,
    /// From the axis to the hip, sideways, m.
    pub s: f64,
    /// Each leg's direction about z, rad.
    pub legs: Vector,
    /// Origin of probe positions, m before the base.
    pub workspace_depth: f64,
    /// Inertia of a thigh with its drum about the hip, kg·m².
    pub thigh_inertia: f64,
    /// Mass of a shin, kg.
    pub shin_mass: f64,
    /// Mass of the plate with the grip, kg.
    pub plate_mass: f64,
    /// Mass of a thigh, kg.
    pub thigh_mass: f64,
    /// Its centre, m from the hip.
    pub thigh_centre: f64,
}

/// The longest step of Newton's method, m: a fifth of a shin.
const GREATEST_STEP: f64 = 0.02;

/// The u and v directions of each leg.
type Axes = [[Vector; 2]; 3];

impl DeltaSettings {
    /// Each leg's u and v directions.
    fn axes(&self) -> Axes {
        self.legs.map(|leg| {
            let (sine, cosine) = leg.sin_cos();
            [[cosine, sine, 0.0], [-sine, cosine, 0.0]]
        })
    }

    /// Over its hip, in the leg's frame: u, v and w of the probe, less the plate's own size.
    fn in_leg(&self, [u, v]: [Vector; 2], place: Vector) -> Vector {
        [dot(u, place) - self.r + self.c, dot(v, place) - self.s + self.f, place[2]]
    }

    /// How far a leg is from closing, m²; its gradient over the probe's place, and its slope over the angle.
    fn closure(&self, axes: [Vector; 2], place: Vector, (sine, cosine): (f64, f64)) -> (f64, Vector, f64) {
        let [u, v, w] = self.in_leg(axes, place);
        let (over_u, over_w) = (u - self.a * cosine, w - self.a * sine);
        let span = (self.b * self.b - v * v).sqrt();
        let length = self.d + self.e + span;
        let gap = over_u * over_u + over_w * over_w - length * length;
        let gradient = add_scaled(scaled(axes[0], 2.0 * over_u), axes[1], 2.0 * length * v / span);
        let gradient = [gradient[0], gradient[1], gradient[2] + 2.0 * over_w];
        (gap, gradient, 2.0 * self.a * (over_u * sine - over_w * cosine))
    }

    fn closures(&self, axes: &Axes, place: Vector, turns: [(f64, f64); 3]) -> [(f64, Vector, f64); 3] {
        core::array::from_fn(|leg| self.closure(axes[leg], place, turns[leg]))
    }

    /// The probe's place, m from the middle of the base, by sines and cosines of the angles.
    fn place(&self, axes: &Axes, turns: [(f64, f64); 3]) -> Vector {
        let mut place = [0.0, 0.0, self.workspace_depth];
        for _ in 0..30 {
            let closures = self.closures(axes, place, turns);
            let step = times(&inverse(&closures.map(|(_, gradient, _)| gradient)), closures.map(|(gap, ..)| gap));
            // Far from the solution a whole step may lead to where a shin is too short for its sideways swing.
            let step = scaled(step, (GREATEST_STEP / norm(step)).min(1.0));
            place = difference(place, step);
            // Quadratic: the next step would be below rounding.
            if norm(step) < 1e-9 {
                break;
            }
        }
        place
    }

    /// How the probe moves, m/rad by rows.
    fn motion(&self, axes: &Axes, place: Vector, turns: [(f64, f64); 3]) -> Matrix {
        let closures = self.closures(axes, place, turns);
        let back = inverse(&closures.map(|(_, gradient, _)| gradient));
        core::array::from_fn(|row| core::array::from_fn(|leg| -back[row][leg] * closures[leg].2))
    }
}

impl Geometry for DeltaSettings {
    fn joints(&self) -> usize {
        3
    }

    fn points(&self, angles: Vector) -> Points {
        let mut points = Points::default();
        let (axes, turns) = (self.axes(), angles.map(f64::sin_cos));
        let place = self.place(&axes, turns);
        let carried = self.plate_mass + 1.5 * self.shin_mass;
        points[0] = Point {
            inertia: carried,
            weight: carried,
            place: difference(place, [0.0, 0.0, self.workspace_depth]),
            jacobian: self.motion(&axes, place, turns),
        };
        // The thighs' inertia is in the joints'; here is their weight, and half a shin's at the knee.
        let moment = self.thigh_mass * self.thigh_centre + 0.5 * self.shin_mass * self.a;
        for leg in 0..3 {
            let ([u, _], (sine, cosine)) = (axes[leg], turns[leg]);
            let point = &mut points[leg + 1];
            point.weight = moment / self.a;
            point.place = [u[0] * self.a * cosine, u[1] * self.a * cosine, self.a * sine];
            for (row, entry) in [-u[0] * self.a * sine, -u[1] * self.a * sine, self.a * cosine].into_iter().enumerate()
            {
                point.jacobian[row][leg] = entry;
            }
        }
        points
    }

    fn angles(&self, position: Vector) -> Option<Vector> {
        let place = add_scaled(position, [0.0, 0.0, self.workspace_depth], 1.0);
        let mut angles = [0.0; 3];
        for (axes, angle) in self.axes().into_iter().zip(&mut angles) {
            let [u, v, w] = self.in_leg(axes, place);
            let length = self.d + self.e + (self.b * self.b - v * v).sqrt();
            // `u cos θ + w sin θ` is known, and the knee points out.
            let cosine = (u * u + w * w + self.a * self.a - length * length) / (2.0 * self.a * u.hypot(w));
            if !(-1.0..=1.0).contains(&cosine) {
                return None; // also where it is NaN
            }
            *angle = w.atan2(u) - cosine.acos();
        }
        Some(angles)
    }
}
