//! The devices that the page's loop runs on: three slides for the mouse, and those that ship, for recordings.

use palpate::device::drive::Feed;
use palpate::device::presets::{NOVINT_FALCON, PHANTOM_PREMIUM, POLHEM_V2, WOODEN_HAPTICS_2016};
use palpate::device::{Delta, Device, Encoder, Kinematics, LinkageArm, Motor, ProbePose, SerialArm};
use palpate::math::{Vec3, vec3};

/// A mechanism that is chosen when the page runs.
#[derive(Clone, Copy, Debug)]
pub enum Mechanism {
    /// Three slides at right angles: where a joint is said to turn by a radian, it slides by a metre.
    Slides,
    /// See [`SerialArm`].
    Serial(SerialArm),
    /// See [`LinkageArm`].
    Linkage(LinkageArm),
    /// See [`Delta`].
    Delta(Delta),
}

impl Kinematics<3> for Mechanism {
    fn pose(&self, angles: [f32; 3]) -> ProbePose<3> {
        match self {
            Self::Slides => ProbePose { position: Vec3::from_array(angles), jacobian: [Vec3::X, Vec3::Y, Vec3::Z] },
            Self::Serial(arm) => arm.pose(angles),
            Self::Linkage(arm) => arm.pose(angles),
            Self::Delta(delta) => delta.pose(angles),
        }
    }

    fn held_pose(&self, angles: [f32; 3]) -> (ProbePose<3>, [f32; 3]) {
        match self {
            Self::Slides => (self.pose(angles), [0.0; 3]),
            Self::Serial(arm) => arm.held_pose(angles),
            Self::Linkage(arm) => arm.held_pose(angles),
            Self::Delta(delta) => delta.held_pose(angles),
        }
    }
}

/// What the slides' motors give at most, N.
const GREATEST_FORCE: f32 = 20.0;

/// The device in the page's hand. An encoder resolves the 2⁻¹⁸th part of what is felt: a quarter of a micrometre of
/// 6 cm.
pub fn slides(size: f32) -> Device<Mechanism, 3> {
    let reach = 16.0 * size;
    Device {
        kinematics: Mechanism::Slides,
        // The pose at count zero is exact: there is no line to be in the middle of.
        encoders: [Encoder { radians_per_count: size / 262_144.0, angle_at_zero: 0.0 }; 3],
        motors: [Motor { torque_at_full: GREATEST_FORCE }; 3],
        feeds: [Feed::Current; 3],
        dry_friction: [0.0; 3],
        // The rim of 0.05 is one of radians: the slides have none.
        joint_range: [[-reach - 1.0, reach + 1.0]; 3],
        min_margin: 0.01,
        // A mouse jumps.
        max_joint_rate: f32::MAX,
        max_force: GREATEST_FORCE,
        max_stiffness: 10_000.0,
        max_damping: 50.0,
    }
}

/// A device that ships, by its name on the tool's command line.
pub fn shipped(name: &str) -> Option<Device<Mechanism, 3>> {
    Some(match name {
        "woodenhaptics-2016" => chosen(&WOODEN_HAPTICS_2016, Mechanism::Serial),
        "phantom-premium" => chosen(&PHANTOM_PREMIUM, Mechanism::Serial),
        "polhem-v2" => chosen(&POLHEM_V2, Mechanism::Linkage),
        "falcon" => chosen(&NOVINT_FALCON, Mechanism::Delta),
        _ => return None,
    })
}

fn chosen<K: Copy>(device: &Device<K, 3>, mechanism: fn(K) -> Mechanism) -> Device<Mechanism, 3> {
    Device {
        kinematics: mechanism(device.kinematics),
        encoders: device.encoders,
        motors: device.motors,
        feeds: device.feeds,
        dry_friction: device.dry_friction,
        joint_range: device.joint_range,
        min_margin: device.min_margin,
        max_joint_rate: device.max_joint_rate,
        max_force: device.max_force,
        max_stiffness: device.max_stiffness,
        max_damping: device.max_damping,
    }
}

/// The counts at which the slides are nearest to a place, metres.
pub fn counts_at(device: &Device<Mechanism, 3>, place: Vec3) -> [i32; 3] {
    let place = place.to_array();
    core::array::from_fn(|joint| {
        let count = place[joint] / device.encoders[joint].radians_per_count;
        // The cast truncates.
        (count + if count < 0.0 { -0.5 } else { 0.5 }) as i32
    })
}

/// The force that duties give on the slides, N.
pub fn force_of(device: &Device<Mechanism, 3>, duties: [f32; 3]) -> Vec3 {
    let [x, y, z] = core::array::from_fn(|joint| duties[joint] * device.motors[joint].torque_at_full);
    vec3(x, y, z)
}
