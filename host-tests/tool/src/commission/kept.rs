//! What was measured, as the device keeps it.

use palpate::commission::{Calibration, JointCalibration};
use palpate::device::{Device, ZeroOf};
use palpate_sim::devices::preset::Preset;
use palpate_sim::devices::{HomingEntry, OwnDevice};

/// What a device of three joints keeps of a file; `None` of one with fewer.
pub fn calibration(own: &OwnDevice) -> Option<Calibration<3>> {
    match own.preset {
        Preset::SerialArm(device) => Some(of(own, device)),
        Preset::LinkageArm(device) => Some(of(own, device)),
        Preset::Delta(device) => Some(of(own, device)),
        Preset::FiveBar(_) | Preset::Paddle(_) => None,
    }
}

fn of<K>(own: &OwnDevice, device: &Device<K, 3>) -> Calibration<3> {
    Calibration(core::array::from_fn(|joint| JointCalibration {
        // Below three, as the file was read.
        input: own.file.joint[joint].encoder.channel as u8,
        output: own.file.joint[joint].motor.channel as u8,
        radians_per_count: device.encoders[joint].radians_per_count,
        zero_of: match own.file.homing {
            HomingEntry::Pose => ZeroOf::Pose,
            HomingEntry::Index => ZeroOf::Mark,
            HomingEntry::None => ZeroOf::Count,
        },
        angle_at_zero_rad: device.encoders[joint].angle_at_zero_rad,
        torque_at_full_n_m: device.motors[joint].torque_at_full_n_m,
        dry_friction_n_m: device.dry_friction_n_m[joint],
    }))
}
