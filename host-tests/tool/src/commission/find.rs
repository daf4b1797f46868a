//! What stands in a device file, measured: encoders by two known angles, motors by a gentle push, torques by a weight.

use super::Lab;
use crate::own::{DeviceFile, OwnDevice};
use anyhow::{Context, bail};
use std::f64::consts::TAU;

/// How far the hand turns each joint from the middle of the workspace, either way, rad.
const TURN: f64 = 0.15;
/// What the weight loads a joint with, as a share of what its motor gives by its data sheet.
const LOAD: f64 = 0.1;
/// Halvings of the duty in the search for the one that just moves a joint.
const HALVINGS: usize = 9;
/// The greatest share of full duty that is tried: what a jog may have.
const MOST: f64 = 0.29;

/// What was found to be other than the file had it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding(pub String);

/// Measures a device and writes what it finds into its file. What is within what a measurement can tell stays as it is.
///
/// # Errors
/// What cannot be: a joint that moves no encoder, or two; a motor that moves nothing.
pub fn find(lab: &mut dyn Lab, own: &OwnDevice) -> anyhow::Result<(DeviceFile, Vec<Finding>)> {
    let (mut file, mut findings) = find_mounting(lab, own)?;
    let centre = middle(own)?;
    torques(lab, &mut file, own, centre, &mut findings)?;
    lab.place(centre)?;
    Ok((file, findings))
}

/// The same without a weight: inputs, outputs, signs, ratios and zeroes.
///
/// # Errors
/// As [`find`]'s.
pub fn find_mounting(lab: &mut dyn Lab, own: &OwnDevice) -> anyhow::Result<(DeviceFile, Vec<Finding>)> {
    let (mut file, mut findings) = (own.file.clone(), Vec::new());
    let centre = middle(own)?;
    encoders(lab, &mut file, centre, &mut findings)?;
    motors(lab, &mut file, centre, &mut findings)?;
    Ok((file, findings))
}

/// The joint angles in the middle of the workspace.
fn middle(own: &OwnDevice) -> anyhow::Result<[f64; 3]> {
    own.plant.mechanism(0.0).angles([0.0; 3]).context("the workspace centre is out of reach")
}

fn differs(found: f64, before: f64, share: f64) -> bool {
    (found - before).abs() > share * before.abs()
}

/// Input, sign, ratio and zero of each encoder.
fn encoders(
    lab: &mut dyn Lab,
    file: &mut DeviceFile,
    centre: [f64; 3],
    findings: &mut Vec<Finding>,
) -> anyhow::Result<()> {
    for index in 0..3 {
        let mut at = |angle: f64| -> anyhow::Result<[i32; 3]> {
            let mut angles = centre;
            angles[index] = angle;
            lab.place(angles)?;
            Ok(lab.step(None)?.counts)
        };
        let [low, high] = [centre[index] - TURN, centre[index] + TURN];
        let (first, second) = (at(low)?, at(high)?);
        let moved: [i32; 3] = core::array::from_fn(|input| second[input] - first[input]);
        let input = (0..3).max_by_key(|input| moved[*input].abs()).unwrap_or(0);
        let name = file.joint[index].name.clone();
        if moved[input].abs() < 50 {
            bail!("joint {name}: no encoder moved by 50 counts when it was turned by {:.2} rad", 2.0 * TURN);
        }
        if (0..3).any(|other| other != input && moved[other].abs() * 10 > moved[input].abs()) {
            bail!("joint {name}: two encoders moved when it was turned alone: {moved:?} counts");
        }
        let per_radian = f64::from(moved[input]) / (high - low);
        let entry = &mut file.joint[index].encoder;
        let ratio = per_radian * TAU / entry.counts;
        // Either reading is up to half a count off its middle.
        let telling = 2.0 / f64::from(moved[input].abs());
        if differs(ratio, entry.ratio, telling) {
            let what = if differs(ratio.abs(), entry.ratio.abs(), telling) { "ratio" } else { "sign" };
            findings.push(Finding(format!("joint {name}: encoder {what} {:.3}, not {:.3}", ratio, entry.ratio)));
            entry.ratio = if what == "sign" { -entry.ratio } else { ratio };
        }
        if entry.channel != input {
            findings.push(Finding(format!("joint {name}: encoder on input {input}, not {}", entry.channel)));
            entry.channel = input;
        }
        let count = TAU / (entry.counts * entry.ratio);
        let zero = low - (f64::from(first[input]) + 0.5) * count;
        if (zero - entry.zero).abs() > 2.0 * count.abs() {
            findings.push(Finding(format!("joint {name}: encoder zero {zero:.4} rad, not {:.4}", entry.zero)));
            entry.zero = zero;
        }
    }
    Ok(())
}

/// Angles of the joints, less those at zero counts, from a reading's counts.
fn angle(file: &DeviceFile, joint: usize, counts: [i32; 3]) -> f64 {
    let encoder = &file.joint[joint].encoder;
    (f64::from(counts[encoder.channel]) + 0.5) * TAU / (encoder.counts * encoder.ratio) + encoder.zero
}

/// How far a joint has gone, rad, when its hand lets it go for a moment under a motor at a duty.
fn nudge(lab: &mut dyn Lab, file: &DeviceFile, centre: [f64; 3], joint: usize, push: (u8, i16)) -> anyhow::Result<f64> {
    lab.place(centre)?;
    // The duty grows while the hand still holds.
    for _ in 0..6 {
        lab.step(Some(push))?;
    }
    let before = angle(file, joint, lab.step(Some(push))?.counts);
    lab.let_go(joint)?;
    let after = angle(file, joint, lab.step(Some(push))?.counts);
    lab.step(None)?;
    Ok(after - before)
}

/// Output and sign of each motor: the joint that a push one way and the other sends furthest apart.
fn motors(
    lab: &mut dyn Lab,
    file: &mut DeviceFile,
    centre: [f64; 3],
    findings: &mut Vec<Finding>,
) -> anyhow::Result<()> {
    const PUSH: i16 = 8_000;
    let mut motors = [None; 3];
    for output in 0..3_u8 {
        let mut apart = [0.0; 3];
        for (joint, apart) in apart.iter_mut().enumerate() {
            *apart =
                nudge(lab, file, centre, joint, (output, PUSH))? - nudge(lab, file, centre, joint, (output, -PUSH))?;
        }
        let joint = (0..3).max_by(|a, b| apart[*a].abs().total_cmp(&apart[*b].abs())).unwrap_or(0);
        if apart[joint].abs() < 1e-3 {
            bail!("output {output}: no joint moved under {:.0} % of full duty", f64::from(PUSH) / 327.67);
        }
        if motors[joint].is_some() {
            bail!("joint {}: two motors move it", file.joint[joint].name);
        }
        motors[joint] = Some((usize::from(output), apart[joint] > 0.0));
    }
    for (index, motor) in motors.into_iter().enumerate() {
        let (output, with) = motor.context("a motor moves no joint")?;
        let joint = &mut file.joint[index];
        if joint.motor.channel != output {
            findings
                .push(Finding(format!("joint {}: motor on output {output}, not {}", joint.name, joint.motor.channel)));
            joint.motor.channel = output;
        }
        if (joint.motor.ratio > 0.0) != with {
            joint.motor.ratio = -joint.motor.ratio;
            findings.push(Finding(format!("joint {}: motor sign, ratio {:.3}", joint.name, joint.motor.ratio)));
        }
    }
    Ok(())
}

/// Torque constant and friction, rather too much of it, for a joint that moves by less than two counts in a fiftieth of
/// a second counts as at rest: the duties that just move the joint up and down, with and without a known weight.
fn torques(
    lab: &mut dyn Lab,
    file: &mut DeviceFile,
    own: &OwnDevice,
    centre: [f64; 3],
    findings: &mut Vec<Finding>,
) -> anyhow::Result<()> {
    let jacobian = own.plant.mechanism(0.0).jacobian(centre);
    let columns: [[f64; 3]; 3] = core::array::from_fn(|joint| core::array::from_fn(|axis| jacobian[axis][joint]));
    for (index, column) in columns.into_iter().enumerate() {
        let lever = column.iter().map(|part| part * part).sum::<f64>().sqrt();
        let motor = &file.joint[index].motor;
        let pull = LOAD * (motor.torque_constant * motor.current_at_full * motor.ratio).abs() / lever;
        let force = column.map(|part| part / lever * pull);
        let mut edges = [[0.0; 2]; 2];
        for (weight, edges) in edges.iter_mut().enumerate() {
            lab.pull(if weight == 1 { force } else { [0.0; 3] })?;
            for (side, edge) in edges.iter_mut().enumerate() {
                *edge = just_moves(lab, file, centre, index, side == 0)?;
            }
        }
        lab.pull([0.0; 3])?;
        let mean = |[up, down]: [f64; 2]| 0.5 * (up + down);
        let spread = |[up, down]: [f64; 2]| 0.5 * (up - down);
        // A share of full duty up carries what the weight pulls down, and the other way round.
        let full = pull * lever / (mean(edges[0]) - mean(edges[1]));
        let joint = &mut file.joint[index];
        let motor = &mut joint.motor;
        let found = (full / (motor.current_at_full * motor.ratio)).abs();
        // To a percent: friction and the last duty tried.
        if !found.is_finite() || found <= 0.0 {
            bail!("joint {}: the weight changed nothing", joint.name);
        }
        if differs(found, motor.torque_constant, 0.03) {
            findings.push(Finding(format!(
                "joint {}: torque constant {found:.4} N·m/A, not {:.4}",
                joint.name, motor.torque_constant
            )));
            motor.torque_constant = found;
        }
        let friction = 0.5 * (spread(edges[0]) + spread(edges[1])) * full.abs();
        if differs(friction, joint.friction, 0.3) && (friction - joint.friction).abs() > 2e-3 {
            findings
                .push(Finding(format!("joint {}: friction {friction:.3} N·m, not {:.3}", joint.name, joint.friction)));
            joint.friction = friction;
        }
    }
    Ok(())
}

/// The share of full duty towards rising angles that just moves a joint up, or just no longer keeps it from moving
/// down.
fn just_moves(lab: &mut dyn Lab, file: &DeviceFile, centre: [f64; 3], joint: usize, up: bool) -> anyhow::Result<f64> {
    let motor = &file.joint[joint].motor;
    let (output, sign) = (motor.channel as u8, motor.ratio.signum());
    let encoder = &file.joint[joint].encoder;
    let two_counts = 2.0 * (TAU / (encoder.counts * encoder.ratio)).abs();
    let [mut low, mut high] = [-MOST, MOST];
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let moved = nudge(lab, file, centre, joint, (output, (middle * sign * 32_767.0) as i16))?;
        let goes = if up { moved > two_counts } else { moved > -two_counts };
        if goes { high = middle } else { low = middle }
    }
    // At an end of what may be tried it is not known.
    if low == -MOST || high == MOST {
        bail!(
            "joint {}: {:.0} % of full duty either way does not tell its friction and the weight apart: take less weight",
            file.joint[joint].name,
            100.0 * MOST
        );
    }
    Ok(0.5 * (low + high))
}
