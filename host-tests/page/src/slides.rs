//! The device in the page's hand: three slides for the mouse.

use palpate::device::drive::Feed;
use palpate::device::{Device, Encoder, Kinematics, Motor, ProbePose};
use palpate::math::{Vec3, vec3};

/// Three slides at right angles: where a joint is said to turn by a radian, it slides by a metre.
#[derive(Clone, Copy, Debug)]
pub struct Slides;

impl Kinematics<3> for Slides {
    fn pose(&self, angles: [f32; 3]) -> ProbePose<3> {
        ProbePose { position: Vec3::from_array(angles), jacobian: [Vec3::X, Vec3::Y, Vec3::Z] }
    }
}

/// What the slides' motors give at most, N.
const GREATEST_FORCE: f32 = 20.0;

/// The slides for a thing of this size, metres. An encoder resolves the 2⁻¹⁸th part of what is felt: a quarter of a
/// micrometre of 6 cm.
pub fn slides(size: f32) -> Device<Slides, 3> {
    let reach = 16.0 * size;
    Device {
        kinematics: Slides,
        // The pose at count zero is exact: there is no line to be in the middle of.
        encoders: [Encoder { radians_per_count: size / 262_144.0, angle_at_zero_rad: 0.0 }; 3],
        motors: [Motor { torque_at_full_n_m: GREATEST_FORCE }; 3],
        feeds: [Feed::Current; 3],
        dry_friction_n_m: [0.0; 3],
        // The rim of 0.05 is one of radians: the slides have none.
        joint_range_rad: [[-reach - 1.0, reach + 1.0]; 3],
        min_margin_m_per_rad: 0.01,
        // A mouse jumps.
        max_joint_rate_rad_per_s: f32::MAX,
        max_force_n: GREATEST_FORCE,
        max_stiffness_n_per_m: 10_000.0,
        max_damping_n_s_per_m: 50.0,
    }
}

/// The counts at which the slides are nearest to a place, metres.
pub fn counts_at(device: &Device<Slides, 3>, place: Vec3) -> [i32; 3] {
    let place = place.to_array();
    core::array::from_fn(|joint| {
        let count = place[joint] / device.encoders[joint].radians_per_count;
        // The cast truncates.
        (count + if count < 0.0 { -0.5 } else { 0.5 }) as i32
    })
}

/// The force that duties give on the slides, N.
pub fn force_of(device: &Device<Slides, 3>, duties: [f32; 3]) -> Vec3 {
    let [x, y, z] = core::array::from_fn(|joint| duties[joint] * device.motors[joint].torque_at_full_n_m);
    vec3(x, y, z)
}
