//! Interface of all mechanisms to the plant.

use super::arm::Arm;
use super::vector::{Matrix, Vector, dot, times};
use std::fmt::Debug;

/// The terms of the equation of motion at one place and speed.
#[derive(Clone, Copy, Debug)]
pub struct Dynamics {
    /// [`Mechanism::position`].
    pub position: Vector,
    /// [`Mechanism::jacobian`].
    pub jacobian: Matrix,
    /// [`Mechanism::mass_matrix`].
    pub mass_matrix: Matrix,
    /// [`Mechanism::velocity_torques`].
    pub velocity_torques: Vector,
    /// [`Mechanism::gravity_torques`].
    pub gravity_torques: Vector,
}

/// Geometry and inertia of a device's moving parts.
///
/// One to three joints; the entries of the others are zero in vectors and Jacobians, and one on the mass matrix's
/// diagonal, so that they stay where they are. Written in f64 apart from the library's kinematics, so that the two
/// check each other.
pub trait Mechanism: Debug + Send + Sync {
    /// How many joints it has.
    fn joints(&self) -> usize;
    /// The probe's position, m from the workspace centre. Not finite where the mechanism cannot be closed.
    fn position(&self, angles: Vector) -> Vector;
    /// `∂position/∂angles` by rows, m/rad.
    fn jacobian(&self, angles: Vector) -> Matrix;
    /// The joint angles that put the probe at a position (as far as the mechanism's dimensions go); none if out of
    /// reach.
    fn angles(&self, position: Vector) -> Option<Vector>;
    /// The joint-space mass matrix, kg·m²: the kinetic energy is `½ q̇ᵀ M q̇`.
    fn mass_matrix(&self, angles: Vector) -> Matrix;
    /// Coriolis and centrifugal torques, N·m, on the left of the equation of motion.
    fn velocity_torques(&self, angles: Vector, rates: Vector) -> Vector;
    /// The torques gravity puts on the joints, N·m, on the right of the equation of motion.
    fn gravity_torques(&self, angles: Vector) -> Vector;
    /// Energy of height, J, from some zero.
    fn height_energy(&self, angles: Vector) -> f64;

    /// All of it at once, in the same bits: what several of these need is computed once.
    fn dynamics(&self, angles: Vector, rates: Vector) -> Dynamics {
        Dynamics {
            position: self.position(angles),
            jacobian: self.jacobian(angles),
            mass_matrix: self.mass_matrix(angles),
            velocity_torques: self.velocity_torques(angles, rates),
            gravity_torques: self.gravity_torques(angles),
        }
    }

    /// Kinetic energy, J.
    fn kinetic_energy(&self, angles: Vector, rates: Vector) -> f64 {
        0.5 * dot(rates, times(&self.mass_matrix(angles), rates))
    }
}

impl Mechanism for Arm {
    fn joints(&self) -> usize {
        3
    }

    fn position(&self, angles: Vector) -> Vector {
        Self::position(self, angles)
    }

    fn jacobian(&self, angles: Vector) -> Matrix {
        Self::jacobian(self, angles)
    }

    fn angles(&self, position: Vector) -> Option<Vector> {
        Self::angles(self, position)
    }

    fn mass_matrix(&self, angles: Vector) -> Matrix {
        Self::mass_matrix(self, angles)
    }

    #[inline(always)]
    fn velocity_torques(&self, angles: Vector, rates: Vector) -> Vector {
        Self::velocity_torques(self, angles, rates)
    }

    fn gravity_torques(&self, angles: Vector) -> Vector {
        Self::gravity_torques(self, angles)
    }

    fn height_energy(&self, angles: Vector) -> f64 {
        Self::height_energy(self, angles)
    }
}
