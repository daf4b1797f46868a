//! Dynamics of a mechanism whose masses are points that its geometry moves.
//!
//! With places `xᵢ(q)` and Jacobians `Jᵢ`: `M = D + Σ mᵢ Jᵢᵀ Jᵢ`, velocity torques `Σ mᵢ Jᵢᵀ J̇ᵢ q̇`, gravity
//! `Σ mᵢ Jᵢᵀ g`. `J̇ q̇` is a central difference of the Jacobian along the motion.

use super::mechanism::Mechanism;
use super::vector::{Matrix, Vector, add_scaled, dot, norm, scaled, times};
use std::fmt::Debug;

/// A point mass, or an angle with its moment of inertia (then `place` holds the angle, and m and kg read rad and kg·m²).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Mass that must be moved, kg.
    pub inertia: f64,
    /// Mass that gravity pulls at, kg.
    pub weight: f64,
    /// Where it is, m.
    pub place: Vector,
    /// `∂place/∂angles` by rows, m/rad.
    pub jacobian: Matrix,
}

/// As many points as any mechanism here has; the rest weigh nothing.
pub type Points = [Point; 8];

/// How a mechanism moves its points.
pub trait Geometry: Debug + Send + Sync {
    /// How many joints it has.
    fn joints(&self) -> usize;
    /// The points at these joint angles. The first is the probe, m from the workspace centre; not finite where the mechanism
    /// cannot be closed.
    fn points(&self, angles: Vector) -> Points;
    /// The joint angles that put the probe at a position; none if out of reach.
    fn angles(&self, position: Vector) -> Option<Vector>;
}

/// A geometry with the inertia and weight it moves.
#[derive(Clone, Debug)]
pub struct Lumped<G> {
    /// Where the points are.
    pub geometry: G,
    /// Inertia that turns with each joint alone, kg·m².
    pub joint_inertia: Vector,
    /// Mass of the hand on the probe, kg: inertia without weight.
    pub hand_mass: f64,
    /// Acceleration of free fall as a vector of the device frame, m/s².
    pub gravity: Vector,
}

impl<G: Geometry> Lumped<G> {
    fn points(&self, angles: Vector) -> Points {
        let mut points = self.geometry.points(angles);
        points[0].inertia += self.hand_mass;
        points
    }
}

/// `Jᵀ v`.
fn transposed_times(jacobian: &Matrix, vector: Vector) -> Vector {
    core::array::from_fn(|joint| (0..3).map(|row| jacobian[row][joint] * vector[row]).sum())
}

impl<G: Geometry> Mechanism for Lumped<G> {
    fn joints(&self) -> usize {
        self.geometry.joints()
    }

    fn position(&self, angles: Vector) -> Vector {
        self.geometry.points(angles)[0].place
    }

    fn jacobian(&self, angles: Vector) -> Matrix {
        self.geometry.points(angles)[0].jacobian
    }

    fn angles(&self, position: Vector) -> Option<Vector> {
        self.geometry.angles(position)
    }

    fn mass_matrix(&self, angles: Vector) -> Matrix {
        let mut mass = [[0.0; 3]; 3];
        for (joint, row) in mass.iter_mut().enumerate() {
            row[joint] = if joint < self.joints() { self.joint_inertia[joint] } else { 1.0 };
        }
        for point in self.points(angles).iter().filter(|point| point.inertia != 0.0) {
            for (i, row) in mass.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry += point.inertia * point.jacobian.iter().map(|row| row[i] * row[j]).sum::<f64>();
                }
            }
        }
        mass
    }

    fn velocity_torques(&self, angles: Vector, rates: Vector) -> Vector {
        let speed = norm(rates);
        if speed == 0.0 {
            return [0.0; 3];
        }
        // A turn of 1e-5 rad: truncation 1e-10 of the curvature, rounding 1e-16 / 1e-5.
        let step = 1e-5 / speed;
        let [ahead, behind] = [step, -step].map(|h| self.points(add_scaled(angles, rates, h)));
        let here = self.points(angles);
        let mut torques = [0.0; 3];
        for ((point, ahead), behind) in here.iter().zip(&ahead).zip(&behind).filter(|((p, _), _)| p.inertia != 0.0) {
            let change = add_scaled(times(&ahead.jacobian, rates), times(&behind.jacobian, rates), -1.0);
            let drift = scaled(change, 0.5 / step * point.inertia);
            torques = add_scaled(torques, transposed_times(&point.jacobian, drift), 1.0);
        }
        torques
    }

    fn gravity_torques(&self, angles: Vector) -> Vector {
        if self.gravity == [0.0; 3] {
            return [0.0; 3];
        }
        self.points(angles)
            .iter()
            .fold([0.0; 3], |sum, point| add_scaled(sum, transposed_times(&point.jacobian, self.gravity), point.weight))
    }

    fn height_energy(&self, angles: Vector) -> f64 {
        self.points(angles).iter().map(|point| -point.weight * dot(self.gravity, point.place)).sum()
    }
}
