//! The device: encoder counts to joint angles to the probe, and a force at the probe back to motor duty.
//!
//! One direction in, one out: [`Encoder`] → [`Kinematics`] → … → [`Kinematics`] (transposed Jacobian) → [`Motor`].
//! A new device is a [`Kinematics`] and a preset in [`presets`].

mod encoder;
mod motor;
pub mod presets;
mod serial_arm;
mod velocity;

pub use encoder::{Counts, Encoder};
pub use motor::{Duty, Motor};
pub use serial_arm::SerialArm;
pub use velocity::{
    AdaptiveWindow, TrackingObserver, VelocityEstimator, VelocityFilter, VelocityMethod, VelocityState, WINDOW, Window,
};

use crate::math::Vec3;

/// Where the probe is and how it moves with each joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbePose<const JOINTS: usize> {
    /// The probe's position in the device's frame, metres from the centre of its workspace.
    pub position: Vec3,
    /// The Jacobian's columns `∂position/∂angle`, metres per radian.
    pub jacobian: [Vec3; JOINTS],
}

impl<const JOINTS: usize> ProbePose<JOINTS> {
    /// The probe's velocity, m/s, from the joint rates, rad/s.
    pub fn velocity(&self, joint_rates: [f32; JOINTS]) -> Vec3 {
        self.jacobian.iter().zip(joint_rates).fold(Vec3::ZERO, |sum, (column, rate)| sum + *column * rate)
    }

    /// The joint torques, N·m, that hold a force at the probe, N: `τ = Jᵀ F`.
    pub fn torques(&self, force: Vec3) -> [f32; JOINTS] {
        self.jacobian.map(|column| column.dot(force))
    }
}

/// The forward map of a mechanism.
pub trait Kinematics<const JOINTS: usize> {
    /// Probe position and Jacobian at these joint angles, radians.
    fn pose(&self, angles: [f32; JOINTS]) -> ProbePose<JOINTS>;
}

/// A device as the servo sees it: mechanism, encoders, motors and limits. Lives in flash.
#[derive(Clone, Copy, Debug)]
pub struct Device<K, const JOINTS: usize> {
    /// The mechanism.
    pub kinematics: K,
    /// One encoder a joint.
    pub encoders: [Encoder; JOINTS],
    /// One motor a joint.
    pub motors: [Motor; JOINTS],
    /// Least and greatest angle of each joint, radians: what lies outside is a sensor fault.
    pub joint_range: [[f32; 2]; JOINTS],
    /// The greatest believable joint speed, rad/s: what is faster is a sensor fault.
    pub greatest_joint_rate: f32,
    /// The greatest force the device is to be asked for, N.
    pub greatest_force: f32,
    /// The greatest stiffness recommended for it, N/m.
    pub greatest_stiffness: f32,
    /// The greatest damping recommended for it, N·s/m.
    pub greatest_damping: f32,
}
