//! Whether a device's numbers can be those of a device.

use super::Device;
use thiserror::Error;

/// Which constant of a device is invalid, and of which joint, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum DeviceError {
    /// An encoder's angle per count is zero or not finite, or its angle at zero is not finite.
    #[error("joint {0}: the encoder's counts a turn and ratio must be finite and not zero, and its zero finite")]
    Encoder(usize),
    /// A motor's torque at full duty is zero or not finite.
    #[error("joint {0}: the motor's torque constant, current and ratio must be finite and not zero")]
    Motor(usize),
    /// The dry friction is negative or not finite.
    #[error("joint {0}: the dry friction must be finite and not negative")]
    Friction(usize),
    /// The range's minimum angle is not below its maximum.
    #[error(
        "joint {0}: the range's minimum must be below its maximum, and both finite, or both infinite of an only joint"
    )]
    Range(usize),
    /// A joint that turns without end has no whole number of counts a turn.
    #[error("joint {0} turns without end: its encoder needs a whole number of counts a turn, 4 to 16,777,216")]
    Endless(usize),
    /// A limit of the whole device is not positive and finite.
    #[error("minimum margin, maximum rate, force, stiffness and damping must be positive and finite")]
    Limit,
}

const fn is_positive(number: f32) -> bool {
    number > 0.0 && number < f32::INFINITY
}

const fn is_factor(number: f32) -> bool {
    number.is_finite() && number != 0.0
}

impl<K, const JOINTS: usize> Device<K, JOINTS> {
    /// Checks every number but the mechanism's.
    ///
    /// # Errors
    /// The first that no device has.
    pub const fn check(&self) -> Result<(), DeviceError> {
        let mut joint = 0;
        while joint < JOINTS {
            let encoder = &self.encoders[joint];
            if !(is_factor(encoder.radians_per_count) && encoder.angle_at_zero_rad.is_finite()) {
                return Err(DeviceError::Encoder(joint));
            }
            if !is_factor(self.motors[joint].torque_at_full_n_m) {
                return Err(DeviceError::Motor(joint));
            }
            let friction = self.dry_friction_n_m[joint];
            if !(friction >= 0.0 && friction < f32::INFINITY) {
                return Err(DeviceError::Friction(joint));
            }
            let [minimum, maximum] = self.joint_range_rad[joint];
            if let Some(counts) = self.endless() {
                // A whole number, but for three roundings.
                let off = counts as f32 * encoder.radians_per_count.abs() / core::f32::consts::TAU - 1.0;
                if !(counts >= 4 && counts <= 1 << 24 && off.abs() < 4e-7) {
                    return Err(DeviceError::Endless(joint));
                }
            } else if !(minimum < maximum && minimum.is_finite() && maximum.is_finite()) {
                return Err(DeviceError::Range(joint));
            }
            joint += 1;
        }
        let positive = is_positive(self.min_margin_m_per_rad)
            && is_positive(self.max_joint_rate_rad_per_s)
            && is_positive(self.max_force_n)
            && is_positive(self.max_stiffness_n_per_m)
            && is_positive(self.max_damping_n_s_per_m);
        if positive { Ok(()) } else { Err(DeviceError::Limit) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{
        Encoder, Motor,
        presets::{GIMBAL_KNOB, WOODEN_HAPTICS_2016 as DEVICE},
    };

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
}
