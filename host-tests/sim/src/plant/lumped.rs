//! Dynamics of a mechanism whose masses are points that its geometry moves.
//!
//! With places `xᵢ(q)` and Jacobians `Jᵢ`: `M = D + Σ mᵢ Jᵢᵀ Jᵢ`, velocity torques `Σ mᵢ Jᵢᵀ J̇ᵢ q̇`, gravity
//! `Σ mᵢ Jᵢᵀ g`. `J̇ q̇` is a central difference of the Jacobian along the motion.

use super::mechanism::{Dynamics, Mechanism};
use super::vector::{Matrix, Vector, add_scaled, dot, norm, scaled, times};
use std::fmt::Debug;

/// A point mass, or an angle with its moment of inertia (then `place` holds the angle, and m and kg read rad and
/// kg·m²).
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
    /// The points at these joint angles. The first is the probe, m from the workspace centre; not finite where the
    /// mechanism cannot be closed.
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

    fn mass_matrix_of(&self, points: &Points) -> Matrix {
        let mut mass = [[0.0; 3]; 3];
        for (joint, row) in mass.iter_mut().enumerate() {
            row[joint] = if joint < self.joints() { self.joint_inertia[joint] } else { 1.0 };
        }
        for point in points.iter().filter(|point| point.inertia != 0.0) {
            for (i, row) in mass.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry += point.inertia * point.jacobian.iter().map(|row| row[i] * row[j]).sum::<f64>();
                }
            }
        }
        mass
    }

    fn velocity_torques_of(&self, here: &Points, angles: Vector, rates: Vector) -> Vector {
        let speed = norm(rates);
        if speed == 0.0 {
            return [0.0; 3];
        }
        // A turn of 1e-5 rad: truncation 1e-10 of the curvature, rounding 1e-16 / 1e-5.
        let step = 1e-5 / speed;
        let [ahead, behind] = [step, -step].map(|h| self.points(add_scaled(angles, rates, h)));
        let mut torques = [0.0; 3];
        for ((point, ahead), behind) in here.iter().zip(&ahead).zip(&behind).filter(|((p, _), _)| p.inertia != 0.0) {
            let change = add_scaled(times(&ahead.jacobian, rates), times(&behind.jacobian, rates), -1.0);
            let drift = scaled(change, 0.5 / step * point.inertia);
            torques = add_scaled(torques, transposed_times(&point.jacobian, drift), 1.0);
        }
        torques
    }

    fn gravity_torques_of(&self, points: &Points) -> Vector {
        if self.gravity == [0.0; 3] {
            return [0.0; 3];
        }
        points
            .iter()
            .fold([0.0; 3], |sum, point| add_scaled(sum, transposed_times(&point.jacobian, self.gravity), point.weight))
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
        self.mass_matrix_of(&self.points(angles))
    }

    fn velocity_torques(&self, angles: Vector, rates: Vector) -> Vector {
        self.velocity_torques_of(&self.points(angles), angles, rates)
    }

    fn gravity_torques(&self, angles: Vector) -> Vector {
        self.gravity_torques_of(&self.points(angles))
    }

    fn dynamics(&self, angles: Vector, rates: Vector) -> Dynamics {
        let points = self.points(angles);
        Dynamics {
            position: points[0].place,
            jacobian: points[0].jacobian,
            mass_matrix: self.mass_matrix_of(&points),
            velocity_torques: self.velocity_torques_of(&points, angles, rates),
            gravity_torques: self.gravity_torques_of(&points),
        }
    }

    fn height_energy(&self, angles: Vector) -> f64 {
        self.points(angles).iter().map(|point| -point.weight * dot(self.gravity, point.place)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::PlantSettings;
    use crate::plant::vector::difference;

    /// Every lumped mechanism, with a hand, at poses about its workspace centre, and rates.
    fn poses() -> Vec<(Box<dyn Mechanism>, Vector, Vector)> {
        let mut poses = Vec::new();
        for settings in [
            PlantSettings::polhem_v2(),
            PlantSettings::hapkit(),
            PlantSettings::haply_2diy_v3(),
            PlantSettings::haply_kit_v1(),
            PlantSettings::novint_falcon(),
        ] {
            for offset in [[0.0; 3], [0.02, 0.01, -0.015], [-0.015, -0.02, 0.01]] {
                let mechanism = settings.mechanism(0.05);
                let angles = mechanism.angles(offset).unwrap();
                let joints = mechanism.joints();
                let rates = core::array::from_fn(|joint| if joint < joints { [2.0, -1.5, 3.0][joint] } else { 0.0 });
                poses.push((mechanism, angles, rates));
            }
        }
        poses
    }

    fn unit(joint: usize) -> Vector {
        core::array::from_fn(|other| if other == joint { 1.0 } else { 0.0 })
    }

    #[test]
    fn velocity_torques_follow_from_the_mass_matrix() {
        for (mechanism, angles, rates) in poses() {
            let step = 1e-5;
            let momentum = |h: f64| times(&mechanism.mass_matrix(add_scaled(angles, rates, h)), rates);
            let drift = scaled(difference(momentum(step), momentum(-step)), 0.5 / step);
            let expected: Vector = core::array::from_fn(|joint| {
                let energy = |h: f64| mechanism.kinetic_energy(add_scaled(angles, unit(joint), h), rates);
                drift[joint] - (energy(step) - energy(-step)) / (2.0 * step)
            });
            let found = mechanism.velocity_torques(angles, rates);
            // Energies near 0.01 J round at 1e-18 over 2e-5 rad; truncation is of the order of the step squared.
            assert!(norm(difference(found, expected)) < 1e-9, "{mechanism:?}: {found:?} {expected:?}");
        }
    }

    #[test]
    fn dynamics_at_once_are_those_one_by_one_in_every_bit() {
        let arm = PlantSettings::wooden_haptics_2016().mechanism(0.05);
        let arm = (arm, [0.2, 0.5, 0.6], [6.0, -3.0, 4.0]);
        for (mechanism, angles, rates) in poses().into_iter().chain([arm]) {
            let at_once = mechanism.dynamics(angles, rates);
            let bits = |numbers: &[Vector]| numbers.concat().into_iter().map(f64::to_bits).collect::<Vec<_>>();
            let position = mechanism.position(angles);
            let [velocity, gravity] = [mechanism.velocity_torques(angles, rates), mechanism.gravity_torques(angles)];
            assert_eq!(bits(&at_once.jacobian), bits(&mechanism.jacobian(angles)), "{mechanism:?}");
            assert_eq!(bits(&at_once.mass_matrix), bits(&mechanism.mass_matrix(angles)), "{mechanism:?}");
            let at_once = [at_once.position, at_once.velocity_torques, at_once.gravity_torques];
            assert_eq!(bits(&at_once), bits(&[position, velocity, gravity]), "{mechanism:?}");
        }
    }

    #[test]
    fn gravity_torques_follow_from_the_energy_of_height() {
        for (mechanism, angles, _) in poses() {
            let found = mechanism.gravity_torques(angles);
            for joint in 0..mechanism.joints() {
                let energy = |h: f64| mechanism.height_energy(add_scaled(angles, unit(joint), h));
                let slope = (energy(1e-5) - energy(-1e-5)) / 2e-5;
                // Energies of 0.2 J round at 3e-17 over 2e-5 rad.
                assert!((found[joint] + slope).abs() < 1e-10, "{mechanism:?}: {found:?} {slope}");
            }
        }
    }

    #[test]
    fn joints_that_are_not_there_stay_where_they_are() {
        for (mechanism, angles, rates) in poses() {
            let mass = mechanism.mass_matrix(angles);
            let torques = add_scaled(mechanism.velocity_torques(angles, rates), mechanism.gravity_torques(angles), 1.0);
            for (joint, (row, torque)) in mass.into_iter().zip(torques).enumerate().skip(mechanism.joints()) {
                assert_eq!((row, torque), (unit(joint), 0.0));
            }
        }
    }

    #[test]
    fn the_paddle_is_a_physical_pendulum() {
        let settings = PlantSettings::hapkit();
        let mechanism = settings.mechanism(0.0);
        // Paddle, and the rotor through (0.073152/0.004191)²; the weight of 60 g at 25 mm, tipped by 0.1 rad.
        let inertia = 1e-4 + 5e-7 * (0.073152_f64 / 0.004191).powi(2);
        assert!((mechanism.mass_matrix([0.1, 0.0, 0.0])[0][0] - inertia).abs() < 1e-15);
        let weight = 9.81 * 0.06 * 0.025 * 0.1_f64.sin();
        assert!((mechanism.gravity_torques([0.1, 0.0, 0.0])[0] - weight).abs() < 1e-15);
    }
}
