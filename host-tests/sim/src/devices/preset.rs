//! The servo's description of a device, for any mechanism.

use palpate::device::{Delta, Device, FiveBar, Kinematics, LinkageArm, Paddle, PolarityCheck, SerialArm};
use palpate::servo::recommended::{self, Recommended};

/// The servo's description of a device, by its mechanism. Only a `match` on it distinguishes mechanisms; the loop
/// behind it is generic, on the host as on the target.
#[derive(Clone, Copy, Debug)]
pub enum Preset {
    /// Three joints, serial.
    SerialArm(&'static Device<SerialArm, 3>),
    /// Three joints, a linkage on a turntable.
    LinkageArm(&'static Device<LinkageArm, 3>),
    /// Three joints, a delta.
    Delta(&'static Device<Delta, 3>),
    /// Two joints.
    FiveBar(&'static Device<FiveBar, 2>),
    /// One joint.
    Paddle(&'static Device<Paddle, 1>),
}

/// Limits of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// N.
    pub force: f32,
    /// N/m.
    pub stiffness: f32,
    /// N·s/m.
    pub damping: f32,
}

impl Limits {
    fn of<K, const JOINTS: usize>(device: &Device<K, JOINTS>) -> Self {
        Self {
            force: device.max_force_n,
            stiffness: device.max_stiffness_n_per_m,
            damping: device.max_damping_n_s_per_m,
        }
    }
}

impl Preset {
    /// The device's limits.
    pub fn limits(self) -> Limits {
        match self {
            Self::SerialArm(device) => Limits::of(device),
            Self::LinkageArm(device) => Limits::of(device),
            Self::Delta(device) => Limits::of(device),
            Self::FiveBar(device) => Limits::of(device),
            Self::Paddle(device) => Limits::of(device),
        }
    }

    /// Settings recommended for any device of these limits, as the boards take them.
    pub fn recommended(self) -> Recommended {
        match self {
            Self::SerialArm(device) => recommended::of(device),
            Self::LinkageArm(device) => recommended::of(device),
            Self::Delta(device) => recommended::of(device),
            Self::FiveBar(device) => recommended::of(device),
            Self::Paddle(device) => recommended::of(device),
        }
    }

    /// Workspace margin at these joint angles, rad: 1 well inside, 0 on the border.
    pub fn room(self, angles: [f64; 3]) -> f32 {
        fn of<K: Kinematics<JOINTS>, const JOINTS: usize>(device: &Device<K, JOINTS>, angles: [f64; 3]) -> f32 {
            let angles = core::array::from_fn(|joint| angles[joint] as f32);
            device.kinematics.pose(angles).map_or(0.0, |pose| device.workspace_margin(device.to_stop(&angles), &pose))
        }
        match self {
            Self::SerialArm(device) => of(device, angles),
            Self::LinkageArm(device) => of(device, angles),
            Self::Delta(device) => of(device, angles),
            Self::FiveBar(device) => of(device, angles),
            Self::Paddle(device) => of(device, angles),
        }
    }

    /// The maximum force of a loop that the polarity check of each joint needs at these angles, N
    /// ([`PolarityCheck::min_force_n`]); `None` with less than three joints.
    pub fn min_force_n(self, check: &PolarityCheck<3>, rate: f32, angles: [f64; 3]) -> Option<[f32; 3]> {
        let angles = angles.map(|angle| angle as f32);
        match self {
            Self::SerialArm(device) => check.min_force_n(device, rate, angles),
            Self::LinkageArm(device) => check.min_force_n(device, rate, angles),
            Self::Delta(device) => check.min_force_n(device, rate, angles),
            Self::FiveBar(_) | Self::Paddle(_) => None,
        }
    }

    /// How each motor is fed.
    pub fn feeds(self) -> &'static [palpate::device::drive::Feed] {
        match self {
            Self::SerialArm(device) => &device.feeds,
            Self::LinkageArm(device) => &device.feeds,
            Self::Delta(device) => &device.feeds,
            Self::FiveBar(device) => &device.feeds,
            Self::Paddle(device) => &device.feeds,
        }
    }
}
