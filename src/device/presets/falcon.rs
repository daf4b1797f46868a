//! Novint Falcon.

use crate::device::drive::Feed;
use crate::device::{Delta, Device, Encoder, Motor};
use crate::math::vec3;

/// Cosine and sine of 15°.
const COS_15: f32 = 0.965_925_8;
const SIN_15: f32 = 0.258_819_04;
const HALF_ROOT: f32 = core::f32::consts::FRAC_1_SQRT_2;

/// Arm's drum over motor shaft.
const RATIO: f32 = 0.110 / 0.014_25;

/// Novint Falcon, a delta that stands on its side.
///
/// Stamper's lengths in mm: a 60, b 102.5, c 14.43, d = e 11.25, f −25, r 40, s −23.09; legs at 90°, −30° and −150°,
/// each plus 15°; drum 110 mm on a shaft of 14.25 mm; 320 lines, four counts each: 38 µm at a thigh's end; 35° at zero
/// counts. Source: libnifalcon, `FalconGeometry.h`; its Jacobian has `sin² θ₂` where `sin θ₂ sin θ₃` belongs and is not
/// followed. 8.9 N: CHAI3D. The frame is libnifalcon's: seen from the front x to the right, y up, z towards the hand;
/// the origin is moved to the middle of the workspace, 120 mm before the base. A plain wall of 2,000 N/m and 5
/// N·s/m at 4 kHz, pressed in simulation, gives stiffness times depth to 2 %, without a limit cycle;
/// [`crate::servo::recommended`] is softer. At the 3,000 N/m and 20 N·s/m in use on it none is either, but dry friction holds the grip anywhere in a count, and
/// half a count of 65 µm is 3 % of the millimetre that such a wall yields to a hand. The joint range keeps out the
/// region 80 mm and more to the side, where the forward map's steps leave up to 41 µm. Assumed, because no source
/// states them: torque of the motors, such that they give 8.9 N in every direction there; friction of a joint; and the
/// masses: 150 g of plate and grip, shins of 15 g, thighs of 60 g with their centre 20 mm out, together 1.7 N at the
/// grip. Weigh yours: a grip that rises or sinks by itself shows how wrong they are.
pub const NOVINT_FALCON: Device<Delta, 3> = Device {
    kinematics: Delta {
        thigh_m: 0.060,
        shin_m: 0.102_5,
        stub_m: 0.011_25 + 0.011_25,
        reach_m: 0.040 - 0.014_43,
        side_m: -0.023_09 + 0.025,
        directions: [[-SIN_15, COS_15], [COS_15, -SIN_15], [-HALF_ROOT, -HALF_ROOT]],
        workspace_centre_m: vec3(0.0, 0.0, 0.120),
        up: vec3(0.0, 1.0, 0.0),
        carried_mass_kg: 0.150 + 1.5 * 0.015,
        thigh_moment_kg_m: 0.060 * 0.020 + 0.5 * 0.015 * 0.060,
    },
    encoders: [Encoder::geared(1_280.0, RATIO, 35.0 * core::f32::consts::PI / 180.0); 3],
    motors: [Motor { torque_at_full_n_m: 0.53 }; 3],
    feeds: [Feed::Current; 3],
    dry_friction_n_m: [0.05; 3],
    joint_range_rad: [[-0.75, 1.3]; 3],
    min_margin_m_per_rad: 0.010,
    max_joint_rate_rad_per_s: 60.0,
    max_force_n: 8.9,
    max_stiffness_n_per_m: 2_000.0,
    max_damping_n_s_per_m: 5.0,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Kinematics;
    use crate::math::Vec3;

    #[test]
    fn the_published_force_is_within_reach_at_the_workspace_centre() {
        let delta = NOVINT_FALCON.kinematics;
        let pose = delta.pose(delta.angles(Vec3::ZERO).unwrap());
        for axis in [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)] {
            let torques = pose.unwrap().torques(axis * NOVINT_FALCON.max_force_n);
            assert!(torques.iter().all(|torque| torque.abs() <= 0.53), "{axis}: {torques:?}");
        }
    }
}
