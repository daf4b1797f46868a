//! Measures the entries of a device file.

use super::encoders::find_encoders;
use super::motors::find_motors;
use super::motors::most;
use super::torques::{Weights, find_torques};
use super::{Finding, Lab, Zero};
use anyhow::Context;
use palpate::commission::{Calibration, JointCalibration};
use palpate::device::{Device, ZeroOf};
use palpate_sim::devices::preset::Preset;
use palpate_sim::devices::{DeviceFile, HomingEntry, OwnDevice};

/// Measures a device and writes the results into its file. Entries within the uncertainty of the measurement do not
/// change. The last of what it returns compares measured and modelled weights.
///
/// # Errors
/// An impossible result: a joint that moves no encoder, or two; a motor that moves no joint.
pub fn find(lab: &mut Lab, own: &OwnDevice, by: Zero) -> anyhow::Result<(DeviceFile, Vec<Finding>, Weights)> {
    let (mut file, mut findings) = find_mounting(lab, own, by)?;
    let weights = find_torques(lab, &mut file, own, middle(own)?, &mut findings)?;
    Ok((file, findings, weights))
}

/// The same without a weight: inputs, outputs, signs, ratios and zeroes.
///
/// # Errors
/// As [`find`]'s.
pub fn find_mounting(lab: &mut Lab, own: &OwnDevice, by: Zero) -> anyhow::Result<(DeviceFile, Vec<Finding>)> {
    let (mut file, mut findings) = (own.file.clone(), Vec::new());
    if by == Zero::Index {
        file.homing = HomingEntry::Index;
    }
    let middle = middle(own)?;
    lab.hands.enable(false)?;
    lab.device.step(None)?;
    find_encoders(lab, &mut file, (middle.0, by), &mut findings)?;
    // Only now can anything move.
    lab.hands.enable(true)?;
    lab.device.wait_for_enable()?;
    find_motors(lab, &mut file, most(own), middle, &mut findings)?;
    Ok((file, findings))
}

/// The joint angles in the middle of the workspace, and gravity's torques on the joints there, N·m.
fn middle(own: &OwnDevice) -> anyhow::Result<([f64; 3], [f64; 3])> {
    let mechanism = own.plant.mechanism(0.0);
    let centre = mechanism.angles([0.0; 3]).context("the workspace centre is out of reach")?;
    Ok((centre, mechanism.gravity_torques(centre)))
}

// What was measured, as the device keeps it.

/// The calibration of a device of three joints from its file; `None` with fewer joints.
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
