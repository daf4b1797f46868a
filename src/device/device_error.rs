//! Whether a device's numbers can be those of a device.

use super::{Device, GRAVITY};
use thiserror::Error;

/// Which constant of a device is invalid, and of which joint, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum DeviceError {
    /// An encoder's angle per count is zero or not finite, or its angle at zero is not finite.
    #[error("joint {0}: the encoder's counts a turn and ratio must be finite and not zero, and its zero finite")]
    Encoder(usize),
    /// A motor's torque at full duty is zero, not finite, or above 200 N·m: 26 mN·m/A are 0.026 N·m/A.
    #[error(
        "joint {0}: the motor's torque constant (N·m/A), current (A) and ratio must be finite and not zero, together at most \
         200 N·m"
    )]
    Motor(usize),
    /// The dry friction is negative, not finite, or more than the motor's torque at full duty.
    #[error(
        "joint {0}: the dry friction (N·m) must be finite, not negative and at most the motor's torque at full duty"
    )]
    Friction(usize),
    /// The range's minimum angle is not below its maximum, or one is beyond two turns, of an only joint 20.
    #[error(
        "joint {0}: the range's minimum must be below its maximum, and both within two turns (20 of an only joint), in rad, \
         or both infinite of an only joint"
    )]
    Range(usize),
    /// A joint that turns without end has no whole number of counts a turn.
    #[error("joint {0} turns without end: its encoder needs a whole number of counts a turn, 4 to 16,777,216")]
    Endless(usize),
    /// A limit of the whole device is not positive and finite, the minimum margin above 10 m/rad or the maximum force
    /// above 1,000 N.
    #[error(
        "minimum margin (m/rad, at most 10), maximum rate, force (N, at most 1,000), stiffness and damping must be positive \
         and finite"
    )]
    Limit,
    /// A number of the mechanism, by the name that a device file has for it.
    #[error(
        "mechanism.{0}: a length must be 0.001 to 2 m, an offset −2 to 2 m, a side 1 or −1, a direction a unit vector"
    )]
    Mechanism(&'static str),
    /// The centre of the workspace is farther away than the mechanism reaches.
    #[error("mechanism: the workspace's centre is out of the mechanism's reach")]
    Centre,
    /// A mass of the mechanism is negative or not finite.
    #[error("mechanism.{0}: must be finite and not negative")]
    Mass(&'static str),
    /// A motor cannot hold the links' weight.
    #[error(
        "joint {joint}: gravity compensation takes {takes_n_m:.2} N·m, and its motor holds {holds_n_m:.2} N·m: check the \
         mechanism's masses, and the motor's torque constant, current and ratio"
    )]
    Weight {
        /// Which joint.
        joint: usize,
        /// Torque for its links held out level, N·m.
        takes_n_m: f32,
        /// Torque of its motor, N·m.
        holds_n_m: f32,
    },
}

impl DeviceError {
    /// The text without joint and numbers, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Encoder(_) => "an encoder's counts a turn and ratio must be finite and not zero, and its zero finite",
            Self::Motor(_) => {
                "a motor's torque at full duty (N·m/A times A times ratio) must be finite, not zero and at most 200 N·m"
            }
            Self::Friction(_) => "a dry friction (N·m) must be finite, not negative and at most its motor's torque",
            Self::Range(_) => {
                "a range's minimum must be below its maximum, and both within two turns (20 of an only joint), in rad"
            }
            Self::Endless(_) => "an endless joint's encoder needs a whole number of counts a turn, 4 to 16,777,216",
            Self::Limit => {
                "minimum margin (m/rad, at most 10), maximum rate, force (N, at most 1,000), stiffness and damping must be positive and finite"
            }
            Self::Mechanism(_) => {
                "a length of the mechanism must be 0.001 to 2 m, an offset −2 to 2 m, a direction a unit vector"
            }
            Self::Centre => "the workspace's centre is out of the mechanism's reach",
            Self::Mass(_) => "a mass of the mechanism must be finite and not negative",
            Self::Weight { .. } => "gravity compensation takes more than a motor holds",
        }
    }
}

/// More torque than a haptic device's motor gives at its joint, N·m.
const MAX_TORQUE_N_M: f32 = 200.0;
/// Two turns either way, and 20, radians: a range in degrees is beyond.
const MAX_ANGLE_RAD: [f32; 2] = [12.6, 126.0];
/// A margin is shorter than the links, m/rad; in mm it is above.
const MAX_MARGIN_M_PER_RAD: f32 = 10.0;
/// More force than a haptic device gives, N.
const MAX_FORCE_N: f32 = 1e3;

/// Lengths of a mechanism by name: 1 mm to 2 m.
pub(super) const fn lengths(all: &[(&'static str, f32)]) -> Result<(), DeviceError> {
    let mut at = 0;
    while at < all.len() {
        let (name, length) = all[at];
        if !(length >= 0.001 && length <= 2.0) {
            return Err(DeviceError::Mechanism(name));
        }
        at += 1;
    }
    Ok(())
}

/// Offsets of a mechanism by name: at most 2 m either way.
pub(super) const fn offsets(all: &[(&'static str, f32)]) -> Result<(), DeviceError> {
    let mut at = 0;
    while at < all.len() {
        let (name, offset) = all[at];
        if !(offset >= -2.0 && offset <= 2.0) {
            return Err(DeviceError::Mechanism(name));
        }
        at += 1;
    }
    Ok(())
}

/// Whether a vector has the length 1, to a part in a thousand.
pub(super) const fn is_unit(vector: &[f32]) -> bool {
    (squared(vector) - 1.0).abs() < 2e-3
}

const fn squared(vector: &[f32]) -> f32 {
    let (mut at, mut sum) = (0, 0.0);
    while at < vector.len() {
        sum += vector[at] * vector[at];
        at += 1;
    }
    sum
}

/// The centre of the workspace, from where the links start, against their reach; metres.
pub(super) const fn centre(from_start: &[f32], reach_m: f32) -> Result<(), DeviceError> {
    if squared(from_start) <= reach_m * reach_m { Ok(()) } else { Err(DeviceError::Centre) }
}

/// Each joint's links, as mass times lever, kg·m, against the torque that its motor holds.
pub(super) const fn weights<const JOINTS: usize>(
    moments_kg_m: [f32; JOINTS],
    holds_n_m: [f32; JOINTS],
) -> Result<(), DeviceError> {
    let mut joint = 0;
    while joint < JOINTS {
        let (takes_n_m, holds_n_m) = (GRAVITY * moments_kg_m[joint].abs(), holds_n_m[joint]);
        let is_held = takes_n_m <= holds_n_m;
        if !is_held {
            return Err(DeviceError::Weight { joint, takes_n_m, holds_n_m });
        }
        joint += 1;
    }
    Ok(())
}

/// The error of a check, for a caller that is const.
macro_rules! all_of {
    ($($check:expr),+) => {{
        $(if let Err(error) = $check {
            return Err(error);
        })+
        Ok(())
    }};
}
pub(super) use all_of;

const fn is_positive(number: f32) -> bool {
    number > 0.0 && number < f32::INFINITY
}

const fn is_factor(number: f32) -> bool {
    number.is_finite() && number != 0.0
}

impl<K, const JOINTS: usize> Device<K, JOINTS> {
    /// The torque of each joint's motor at full duty, N·m, for [`super::Kinematics::check`].
    pub const fn full_torques_n_m(&self) -> [f32; JOINTS] {
        let (mut joint, mut torques) = (0, [0.0; JOINTS]);
        while joint < JOINTS {
            torques[joint] = self.motors[joint].torque_at_full_n_m.abs();
            joint += 1;
        }
        torques
    }

    /// Checks every number but the mechanism's, which has its own check: [`super::Kinematics::check`]. A number in
    /// another unit is refused where it is beyond every device's by an order of magnitude.
    ///
    /// # Errors
    /// The first that no device has.
    pub const fn check(&self) -> Result<(), DeviceError> {
        let max_angle = MAX_ANGLE_RAD[(JOINTS == 1) as usize];
        let mut joint = 0;
        while joint < JOINTS {
            let encoder = &self.encoders[joint];
            if !(is_factor(encoder.radians_per_count) && encoder.angle_at_zero_rad.is_finite()) {
                return Err(DeviceError::Encoder(joint));
            }
            let torque = self.motors[joint].torque_at_full_n_m;
            if !(is_factor(torque) && torque.abs() <= MAX_TORQUE_N_M) {
                return Err(DeviceError::Motor(joint));
            }
            let friction = self.dry_friction_n_m[joint];
            if !(friction >= 0.0 && friction <= torque.abs()) {
                return Err(DeviceError::Friction(joint));
            }
            let [minimum, maximum] = self.joint_range_rad[joint];
            if let Some(counts) = self.endless() {
                // A whole number, but for three roundings.
                let off = counts as f32 * encoder.radians_per_count.abs() / core::f32::consts::TAU - 1.0;
                if !(counts >= 4 && counts <= 1 << 24 && off.abs() < 4e-7) {
                    return Err(DeviceError::Endless(joint));
                }
            } else if !(minimum < maximum && minimum >= -max_angle && maximum <= max_angle) {
                return Err(DeviceError::Range(joint));
            }
            joint += 1;
        }
        let positive = is_positive(self.min_margin_m_per_rad)
            && self.min_margin_m_per_rad <= MAX_MARGIN_M_PER_RAD
            && is_positive(self.max_joint_rate_rad_per_s)
            && is_positive(self.max_force_n)
            && self.max_force_n <= MAX_FORCE_N
            && is_positive(self.max_stiffness_n_per_m)
            && is_positive(self.max_damping_n_s_per_m);
        if positive { Ok(()) } else { Err(DeviceError::Limit) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::presets::{
        GIMBAL_KNOB, HAPKIT, HAPLY_2DIY_V3, HAPLY_KIT_V1, NOVINT_FALCON, PHANTOM_PREMIUM, POLHEM_V2,
        WOODEN_HAPTICS_2016 as DEVICE,
    };
    use crate::device::{Delta, Encoder, FiveBar, Kinematics, Motor, SerialArm};
    use crate::math::vec3;

    #[test]
    fn every_number_that_no_device_has_is_refused_by_its_joint() {
        assert_eq!(DEVICE.check(), Ok(()));
        for bad in [f32::NAN, f32::INFINITY, 0.0] {
            let mut device = DEVICE;
            device.encoders[1] = Encoder { radians_per_count: bad, angle_at_zero_rad: 0.0 };
            assert_eq!(device.check(), Err(DeviceError::Encoder(1)));
            let mut device = DEVICE;
            device.motors[2] = Motor { torque_at_full_n_m: bad };
            assert_eq!(device.check(), Err(DeviceError::Motor(2)));
            assert_eq!(Device { max_force_n: bad, ..DEVICE }.check(), Err(DeviceError::Limit));
        }
        let mut device = DEVICE;
        device.joint_range_rad[0] = [1.0, 1.0];
        assert_eq!(device.check(), Err(DeviceError::Range(0)));
        device = DEVICE;
        device.joint_range_rad[0] = [f32::NEG_INFINITY, f32::INFINITY];
        assert_eq!((device.check(), device.endless()), (Err(DeviceError::Range(0)), None), "one of three");
        let mut dial = GIMBAL_KNOB;
        dial.joint_range_rad[0] = [f32::NEG_INFINITY, f32::INFINITY];
        dial.encoders[0] = Encoder::geared(2_000.0, 16.0, 0.0);
        assert_eq!((dial.check(), dial.endless()), (Ok(()), Some(32_000)));
        dial.encoders[0] = Encoder::geared(2_000.0, 16.000_1, 0.0);
        assert_eq!(dial.check(), Err(DeviceError::Endless(0)));
        device = DEVICE;
        device.joint_range_rad[0] = [f32::NEG_INFINITY, 1.0];
        assert_eq!(device.check(), Err(DeviceError::Range(0)));
        device = DEVICE;
        device.dry_friction_n_m[0] = -0.1;
        assert_eq!(device.check(), Err(DeviceError::Friction(0)));
    }

    #[test]
    fn a_number_in_another_unit_is_refused() {
        let changed = |change: fn(&mut Device<SerialArm, 3>)| {
            let mut device = DEVICE;
            change(&mut device);
            device.check()
        };
        // mN·m/A, mN·m, degrees, mm/rad, mN.
        let torque = |device: &mut Device<SerialArm, 3>| device.motors[1] = Motor::current_driven(25.9, 3.0, -12.0);
        assert_eq!(changed(torque), Err(DeviceError::Motor(1)));
        assert_eq!(changed(|device| device.dry_friction_n_m[2] *= 1e3), Err(DeviceError::Friction(2)));
        assert_eq!(changed(|device| device.joint_range_rad[0] = [-92.0, 92.0]), Err(DeviceError::Range(0)));
        assert_eq!(changed(|device| device.min_margin_m_per_rad *= 1e3), Err(DeviceError::Limit));
        assert_eq!(changed(|device| device.max_force_n *= 1e3), Err(DeviceError::Limit));
        // A dial may turn ten times either way; 270 degrees are no radians.
        let range = |most: f32| Device { joint_range_rad: [[-most, most]], ..GIMBAL_KNOB }.check();
        assert_eq!((range(62.8), range(270.0)), (Ok(()), Err(DeviceError::Range(0))));
    }

    /// Checks a device, its mechanism with it.
    fn whole<K: Kinematics<JOINTS>, const JOINTS: usize>(device: &Device<K, JOINTS>) -> Result<(), DeviceError> {
        device.check().and_then(|()| device.kinematics.check(device.full_torques_n_m()))
    }

    #[test]
    fn a_mechanism_is_refused_by_its_entry_and_every_preset_passes() {
        let all = [
            whole(&DEVICE),
            whole(&PHANTOM_PREMIUM),
            whole(&POLHEM_V2),
            whole(&NOVINT_FALCON),
            whole(&HAPLY_2DIY_V3),
            whole(&HAPLY_KIT_V1),
            whole(&HAPKIT),
            whole(&GIMBAL_KNOB),
        ];
        assert_eq!(all, [Ok(()); 8]);
        let arm = DEVICE.kinematics;
        let of = |arm: SerialArm| whole(&Device { kinematics: arm, ..DEVICE });
        for bad in [-0.2, 0.0, 200.0, f32::NAN] {
            assert_eq!(of(SerialArm { first_link_m: bad, ..arm }), Err(DeviceError::Mechanism("first_link")));
        }
        assert_eq!(of(SerialArm { workspace_centre_m: vec3(9.0, 0.0, 0.0), ..arm }), Err(DeviceError::Centre));
        // Links of 205 and 245 mm start 80 mm above the foot: the farthest point upright is 530 mm above it.
        let upright = |z| of(SerialArm { workspace_centre_m: vec3(0.0, 0.0, z), ..arm });
        assert_eq!((upright(0.529), upright(0.531)), (Ok(()), Err(DeviceError::Centre)));
        let delta = Delta { up: vec3(0.0, 2.0, 0.0), ..NOVINT_FALCON.kinematics };
        assert_eq!(delta.check([1.0; 3]), Err(DeviceError::Mechanism("up")));
        let delta = Delta { carried_mass_kg: -0.1, ..NOVINT_FALCON.kinematics };
        assert_eq!(delta.check([1.0; 3]), Err(DeviceError::Mass("carried_mass")));
        let five_bar = FiveBar { side: 0.5, ..HAPLY_2DIY_V3.kinematics };
        assert_eq!(five_bar.check(), Err(DeviceError::Mechanism("side")));
    }

    #[test]
    fn a_weight_that_its_motor_cannot_hold_is_refused_with_both_numbers() {
        // 0.0259 N·m/A, 3 A, 12:1: 0.9324 N·m hold 0.4636 kg at the end of 205 mm, and 0.3879 kg at 245 mm.
        let of = |masses| SerialArm { end_masses_kg: masses, ..DEVICE.kinematics }.check(DEVICE.full_torques_n_m());
        assert_eq!((of([0.463, 0.387]), of([-0.463, -0.387])), (Ok(()), Ok(())));
        for (masses, joint, takes) in
            [([-5.0, 0.0], 1, 10.055_25), ([0.0, 50.0], 2, 120.172_5), ([0.464, 0.0], 1, 0.933_1)]
        {
            let Err(DeviceError::Weight { joint: refused, takes_n_m, holds_n_m }) = of(masses) else {
                panic!("{masses:?}")
            };
            assert_eq!(refused, joint);
            assert!((takes_n_m - takes).abs() < 1e-4 && (holds_n_m - 0.932_4).abs() < 1e-5, "{takes_n_m} {holds_n_m}");
        }
        assert!(of([f32::NAN, 0.0]).is_err());
    }

    /// The most that a pose of the workspace takes, as a share of what the check assumes: what it lets just through.
    fn share<K: Kinematics<3>>(device: &Device<K, 3>) -> f32 {
        let mut assumed = [0.0; 3];
        while let Err(DeviceError::Weight { joint, takes_n_m, .. }) = device.kinematics.check(assumed) {
            assumed[joint] = takes_n_m;
        }
        let at = |joint: usize, step: usize| {
            let [least, most] = device.joint_range_rad[joint];
            least + (most - least) * step as f32 / 24.0
        };
        let poses = (0..25 * 25 * 25).map(|step| [at(0, step % 25), at(1, step / 25 % 25), at(2, step / 625)]);
        let shares = poses.filter(|angles| device.in_workspace(*angles)).flat_map(|angles| {
            let torques = device.kinematics.holding_torques(angles);
            core::array::from_fn::<f32, 3, _>(|joint| {
                if torques[joint] == 0.0 { 0.0 } else { torques[joint].abs() / assumed[joint] }
            })
        });
        shares.fold(0.0, f32::max)
    }

    #[test]
    fn the_weight_that_a_check_assumes_is_that_of_the_worst_pose() {
        let (serial, linkage, delta) = (share(&DEVICE), share(&POLHEM_V2), share(&NOVINT_FALCON));
        // A serial arm's is exact. The others' levers are those of the middle: towards a singularity more is taken.
        assert!(serial > 0.99 && serial <= 1.0, "{serial}");
        assert!(linkage > 0.9 && linkage < 1.2, "{linkage}");
        assert!(delta > 0.9 && delta < 1.9, "{delta}");
    }
}
