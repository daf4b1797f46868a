//! What the servo knows of a device, whichever its mechanism.

use palpate::device::{Delta, Device, FiveBar, Kinematics, LinkageArm, Paddle, SerialArm};

/// What the servo knows of a device, by its mechanism. Only who matches on it need know that there are several; from
/// there on the loop is generic, on the host as on the target.
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

/// What a device is to be asked for at most.
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

    /// How much room there is to the rim of the workspace at these joint angles, rad: 1 well inside, 0 on it.
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
