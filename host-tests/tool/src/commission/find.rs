//! What stands in a device file, measured.

use super::encoders::find_encoders;
use super::motors::find_motors;
use super::ramp::most;
use super::torques::find_torques;
use super::{Finding, Lab, Zero};
use anyhow::Context;
use palpate_sim::devices::{DeviceFile, HomingEntry, OwnDevice};

/// Measures a device and writes what it finds into its file. What is within what a measurement can tell stays as it is.
///
/// # Errors
/// What cannot be: a joint that moves no encoder, or two; a motor that moves nothing.
pub fn find(lab: &mut Lab, own: &OwnDevice, by: Zero) -> anyhow::Result<(DeviceFile, Vec<Finding>)> {
    let (mut file, mut findings) = find_mounting(lab, own, by)?;
    find_torques(lab, &mut file, own, middle(own)?, &mut findings)?;
    Ok((file, findings))
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

/// The joint angles in the middle of the workspace, and what gravity does to the joints there, N·m.
fn middle(own: &OwnDevice) -> anyhow::Result<([f64; 3], [f64; 3])> {
    let mechanism = own.plant.mechanism(0.0);
    let centre = mechanism.angles([0.0; 3]).context("the workspace centre is out of reach")?;
    Ok((centre, mechanism.gravity_torques(centre)))
}
