//! The device: encoder counts to joint angles to the probe, and a force at the probe back to motor duty.
//!
//! One direction in, one out: [`sensor`] → [`Encoder`] → [`Kinematics`] → … → [`Kinematics`] (transposed Jacobian) →
//! [`Motor`] → [`drive`]. [`Homing`] finds the joints' absolute angles at the start. A new device is a [`Kinematics`]
//! and a preset in [`presets`]; the servo treats one, two and three joints alike.

mod cogging;
mod commutation;
mod delta;
mod device_error;
mod dial;
pub mod drive;
mod encoder;
mod five_bar;
mod homing;
mod linkage_arm;
mod motor;
mod paddle;
mod pose;
pub mod presets;
mod protection;
pub mod sensor;
mod serial_arm;
mod velocity;
mod wrist;

pub use cogging::CoggingMap;
pub use commutation::{Aligned, Commutation, ElectricalAngle};
pub use delta::Delta;
pub use device_error::DeviceError;
pub use dial::Dial;
pub use encoder::{Counts, Encoder};
pub use five_bar::FiveBar;
pub use homing::{
    FieldSearch, Homing, HomingError, HomingInput, HomingProgress, HomingState, Reference, Refusal, StopSearch, ZeroOf,
};
pub use linkage_arm::{LinkMass, LinkageArm};
pub use motor::{Duty, Motor};
pub use paddle::Paddle;
pub use pose::ProbePose;
pub use protection::{Endurance, PolarityCheck, Protection, SupplyRange};
pub use serial_arm::SerialArm;
pub use velocity::{BetweenCounts, VelocityEstimator, VelocityFilter, VelocityMethod, VelocityState};
pub use wrist::{Mount, Wrist, WristError, WristState};

use crate::math::saturate;

/// Acceleration of free fall, m/s².
pub const GRAVITY: f32 = 9.81;

/// The forward map of a mechanism and the weight of its links.
///
/// The device's frame is each mechanism's own; its documentation says where the axes point.
///
/// A mechanism of one's own, its device, and the loop on it pressed into a wall:
///
/// ```
/// use palpate::device::drive::Feed;
/// use palpate::device::{Counts, Device, Encoder, Kinematics, Motor, ProbePose};
/// use palpate::math::{sin_cos, vec3};
/// use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};
/// use palpate::servo::{Config, Input, Servo, Settings};
///
/// /// Two links in a plane, the second turned by a motor in the elbow.
/// struct Planar {
///     links_m: [f32; 2],
/// }
///
/// impl Kinematics<2> for Planar {
///     fn pose(&self, [shoulder, elbow]: [f32; 2]) -> Option<ProbePose<2>> {
///         let [(s, c), (s2, c2)] = [shoulder, shoulder + elbow].map(sin_cos);
///         let [a, b] = self.links_m;
///         let by_elbow = vec3(-b * s2, b * c2, 0.0);
///         let by_shoulder = vec3(-a * s, a * c, 0.0) + by_elbow;
///         let position = vec3(a * c + b * c2, a * s + b * s2, 0.0);
///         Some(ProbePose { position, jacobian: [by_shoulder, by_elbow] })
///     }
/// }
///
/// const DEVICE: Device<Planar, 2> = Device {
///     kinematics: Planar { links_m: [0.12, 0.12] },
///     // 1,024 lines, four counts each, a drum ten times the pulley; the angles of the pose at which it is switched on.
///     encoders: [Encoder::new(1.534e-4, 0.6), Encoder::new(1.534e-4, 1.2)],
///     motors: [Motor { torque_at_full_n_m: 0.6 }; 2],
///     feeds: [Feed::Current; 2],
///     dry_friction_n_m: [0.005; 2],
///     joint_range_rad: [[-0.5, 2.0], [0.3, 2.8]],
///     // Stretched and folded the arm cannot push along itself.
///     min_margin_m_per_rad: 0.03,
///     max_joint_rate_rad_per_s: 30.0,
///     max_force_n: 4.0,
///     max_stiffness_n_per_m: 800.0,
///     max_damping_n_s_per_m: 5.0,
/// };
/// const _: () = assert!(DEVICE.check().is_ok());
/// static ARM: Device<Planar, 2> = DEVICE;
///
/// // 20 cm of a plane across the arm's, facing y.
/// static WALL: SplinePatch = SplineTable {
///     degree: [1, 1], breaks_u: &[0.0, 1.0], breaks_v: &[0.0, 1.0],
///     coefficients: Coefficients::Polynomial(&[[0.0; 3], [0.2, 0.0, 0.0], [0.0, 0.0, 0.2], [0.0; 3]]),
///     shape: ShapeBounds::unknown(SecondDerivativeBounds::ZERO), orientation: Orientation::Outward, size_m: 0.2, crc: None,
/// }.checked();
/// static LOOP: Servo<SplinePatch, Planar, 2> = Servo::new(&ARM, &WALL, Config {
///     settings: Settings {
///         rate_hz: 4_000.0, stiffness_n_per_m: 500.0, damping_n_s_per_m: 1.0, max_force_n: 4.0,
///         // A millimetre below the probe's first place.
///         body_origin_m: vec3(0.0, 0.1835, -0.1),
///         ..Settings::DEFAULT
///     },
///     ..Config::DEFAULT
/// });
///
/// let mut state = LOOP.start();
/// for tick in 0..1_000 {
///     // The shoulder lowers the probe.
///     LOOP.tick(&mut state, Input::Sensors { counts: [Counts(-tick / 2), Counts(0)], enable: true });
/// }
/// assert!(state.gap() < -0.003 && state.force().y > 1.5, "{} m, {} N", state.gap(), state.force());
/// ```
pub trait Kinematics<const JOINTS: usize> {
    /// Probe position and Jacobian at these joint angles, radians; `None` where the mechanism cannot be closed.
    fn pose(&self, angles: [f32; JOINTS]) -> Option<ProbePose<JOINTS>>;

    /// The pose, and the joint torques of gravity compensation, N·m: together, for they share sines and cosines. Zero
    /// where the masses are not known or do not load the joints.
    #[inline]
    fn held_pose(&self, angles: [f32; JOINTS]) -> Option<(ProbePose<JOINTS>, [f32; JOINTS])> {
        self.pose(angles).map(|pose| (pose, [0.0; JOINTS]))
    }

    /// The joint torques of gravity compensation alone, N·m; zero where there is no pose.
    fn holding_torques(&self, angles: [f32; JOINTS]) -> [f32; JOINTS] {
        self.held_pose(angles).map_or([0.0; JOINTS], |(_, torques)| torques)
    }

    /// Checks the mechanism's numbers: lengths, the centre of the workspace, and that no joint's links weigh more than
    /// its motor holds, N·m. The mechanisms of this library have it as a `const fn`, for a constant:
    ///
    /// ```
    /// use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
    ///
    /// const _: () = assert!(DEVICE.check().is_ok() && DEVICE.kinematics.check(DEVICE.full_torques_n_m()).is_ok());
    /// ```
    ///
    /// # Errors
    /// The first number that no device has. A mechanism without a check of its own has none.
    fn check(&self, holds_n_m: [f32; JOINTS]) -> Result<(), DeviceError> {
        let _ = holds_n_m;
        Ok(())
    }
}

/// A device as the servo sees it: mechanism, encoders, motors and limits. Lives in flash.
///
/// ```
/// use palpate::device::{Device, Kinematics as _, SerialArm, presets::WOODEN_HAPTICS_2016};
/// use palpate::math::Vec3;
///
/// /// A preset with a lower limit.
/// static DEVICE: Device<SerialArm, 3> = Device { max_force_n: 3.0, ..WOODEN_HAPTICS_2016 };
/// let angles = DEVICE.angles_at_zero();
/// assert!(DEVICE.in_workspace(angles));
///
/// // The turntable's axis is vertical: it has no part in a force along z.
/// let pose = DEVICE.kinematics.pose(angles).expect("within reach");
/// assert_eq!(pose.torques(Vec3::Z)[0], 0.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Device<K, const JOINTS: usize> {
    /// The mechanism.
    pub kinematics: K,
    /// One encoder a joint.
    pub encoders: [Encoder; JOINTS],
    /// One motor a joint.
    pub motors: [Motor; JOINTS],
    /// How each motor is fed.
    pub feeds: [drive::Feed; JOINTS],
    /// Dry friction of each joint, N·m, generously; 0 where it is not known. A joint may stick under a load below it.
    pub dry_friction_n_m: [f32; JOINTS],
    /// Minimum and maximum angle of each joint, radians: an angle outside is a sensor fault. From −∞ to ∞ a
    /// device's only joint turns without end; its encoder then has a whole number of counts a turn.
    pub joint_range_rad: [[f32; 2]; JOINTS],
    /// Below this [`ProbePose::singularity_margin`], m/rad, the device counts as outside its workspace.
    pub min_margin_m_per_rad: f32,
    /// Maximum plausible joint speed, rad/s: a faster one is a sensor fault.
    pub max_joint_rate_rad_per_s: f32,
    /// Maximum force of the device, N.
    pub max_force_n: f32,
    /// Maximum recommended stiffness, N/m.
    pub max_stiffness_n_per_m: f32,
    /// Maximum recommended damping, N·s/m.
    pub max_damping_n_s_per_m: f32,
}

impl<K, const JOINTS: usize> Device<K, JOINTS> {
    /// Counts of a turn of a device's only joint, where it turns without end; `None` where joints have a range.
    pub const fn endless(&self) -> Option<i32> {
        if JOINTS != 1 {
            return None;
        }
        let [minimum, maximum] = self.joint_range_rad[0];
        if minimum == f32::NEG_INFINITY && maximum == f32::INFINITY {
            // Rounded to nearest; the cast saturates.
            Some((core::f32::consts::TAU / self.encoders[0].radians_per_count.abs() + 0.5) as i32)
        } else {
            None
        }
    }

    /// Whether a motor is fed by a voltage, so that the supply matters.
    pub const fn needs_supply(&self) -> bool {
        let mut joint = 0;
        while joint < JOINTS {
            if matches!(self.feeds[joint], drive::Feed::Voltage(_)) {
                return true;
            }
            joint += 1;
        }
        false
    }

    /// The joint angles, radians, at which the encoders count zero: the pose in which homing by [`Reference::Pose`]
    /// sets the counts to zero.
    pub const fn angles_at_zero(&self) -> [f32; JOINTS] {
        let mut angles = [0.0; JOINTS];
        let mut joint = 0;
        while joint < JOINTS {
            angles[joint] = self.encoders[joint].angle_at_zero_rad;
            joint += 1;
        }
        angles
    }
}

/// How wide the rim of a joint's range is, radians.
const RIM: f32 = 0.05;
/// Above the rounding of an angle within a turn and of the ends of its range, radians.
const ROUNDED: f32 = 1.0e-5;
/// The width of the fade at a singularity, as a fraction of the minimum margin.
pub(crate) const MARGIN_RIM: f32 = 0.25;

impl<K: Kinematics<JOINTS>, const JOINTS: usize> Device<K, JOINTS> {
    /// Whether these joint angles, radians, are in the workspace: each in its range, the mechanism closed, and far
    /// enough from a singularity for forces to make sense. False for NaN.
    pub fn in_workspace(&self, angles: [f32; JOINTS]) -> bool {
        let in_range = |(angle, [least, most]): (&f32, &[f32; 2])| least <= angle && angle <= most;
        angles.iter().zip(&self.joint_range_rad).all(in_range)
            && self.kinematics.pose(angles).is_some_and(|pose| pose.singularity_margin() >= self.min_margin_m_per_rad)
    }

    /// How far the nearest joint is from the end of its range, radians, below 0 beyond it; no more than the width of
    /// the rim.
    #[inline]
    pub fn to_stop(&self, angles: &[f32; JOINTS]) -> f32 {
        // The usual case, by half as many comparisons.
        let is_inside = |(angle, [least, most]): (&f32, &[f32; 2])| {
            (angle - 0.5 * (least + most)).abs() < 0.5 * (most - least) - (RIM + ROUNDED)
        };
        if angles.iter().zip(&self.joint_range_rad).all(is_inside) {
            return RIM;
        }
        let mut to_stop = RIM;
        for (angle, [least, most]) in angles.iter().zip(&self.joint_range_rad) {
            for way in [angle - least, most - angle] {
                if way < to_stop {
                    to_stop = way;
                }
            }
        }
        to_stop
    }

    /// The workspace margin, 0 to 1, from the distance of the joints to their stops (radians, [`Self::to_stop`]) and a
    /// finite pose: 1 well inside, 0 on the rim and outside. In between it is the smaller of two fractions: of the last
    /// 0.05 rad of a joint's range, and of the last quarter above the minimum margin over a singularity. The loop
    /// multiplies the force by it, so that the force fades out at the rim and keeps its direction.
    #[inline]
    pub fn workspace_margin(&self, to_stop: f32, pose: &ProbePose<JOINTS>) -> f32 {
        let over = pose.margin() - self.min_margin_m_per_rad;
        let width = MARGIN_RIM * self.min_margin_m_per_rad;
        if to_stop >= RIM && over >= width {
            return 1.0;
        }
        let (of_range, of_margin) = (to_stop / RIM, over / width);
        saturate(if of_range < of_margin { of_range } else { of_margin }, 0.0, 1.0)
    }

    /// Each drive's command for a duty of torque at a joint rate, rad/s, on this supply.
    ///
    /// Unless `live` it is zero: a bridge compensates back-EMF even where no torque is requested, and after a fault the
    /// rates are untrusted. At zero volts a motor brakes by itself.
    #[inline]
    pub fn feed(
        &self,
        live: bool,
        duties: [Duty; JOINTS],
        joint_rates: [f32; JOINTS],
        supply: drive::Supply,
    ) -> [Duty; JOINTS] {
        if !live {
            return [Duty::ZERO; JOINTS];
        }
        let mut fed = duties;
        for ((fed, feed), rate) in fed.iter_mut().zip(&self.feeds).zip(joint_rates) {
            *fed = feed.command(*fed, rate, supply);
        }
        fed
    }
}

#[cfg(test)]
mod tests {
    use super::presets::{GIMBAL_KNOB, WOODEN_HAPTICS_2016};
    use super::*;

    #[test]
    fn the_distance_to_the_nearest_stop_is_that_of_every_joint() {
        let ranges = WOODEN_HAPTICS_2016.joint_range_rad;
        let middle = ranges.map(|[least, most]| 0.5 * (least + most));
        for joint in 0..3 {
            let [least, most] = ranges[joint];
            for step in -200..=10_200 {
                let mut angles = middle;
                angles[joint] = least + (most - least) * step as f32 * 1e-4;
                let expected = RIM.min(angles[joint] - least).min(most - angles[joint]);
                assert_eq!(WOODEN_HAPTICS_2016.to_stop(&angles), expected, "joint {joint}, {angles:?}");
            }
        }
        // Angles that are not numbers are refused before; they are beyond no stop.
        assert_eq!(WOODEN_HAPTICS_2016.to_stop(&[f32::NAN; 3]), RIM);
        // An endless joint has no stop.
        assert_eq!(GIMBAL_KNOB.to_stop(&[40.0]), RIM);
    }
}
