//! Output and sign of each motor: which one moves a joint that rests against a support, and with which duty.

use super::encoders::angle;
use super::ramp::{Growth, grow};
use super::{Finding, Lab};
use anyhow::{Context, bail};
use palpate_sim::devices::DeviceFile;

/// What is taken for motion, rad: many counts, and little for whoever holds the rest.
const MOVED: f64 = 0.01;

/// Finds them and writes them into the file. `loads` is what gravity does to each joint, N·m: the way it falls.
pub(super) fn find_motors(
    lab: &mut Lab,
    file: &mut DeviceFile,
    most: f64,
    (centre, loads): ([f64; 3], [f64; 3]),
    findings: &mut Vec<Finding>,
) -> anyhow::Result<()> {
    let mut taken = [false; 3];
    for (index, load) in loads.into_iter().enumerate() {
        let towards = away(load);
        let (output, with) = find_motor(lab, file, (index, most), (centre, towards), taken)?;
        taken[output] = true;
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

/// Which way a load falls off its support.
pub(super) fn away(load: f64) -> f64 {
    if load > 0.0 { -1.0 } else { 1.0 }
}

/// The output that moves a joint off its support, and whether a positive duty moves it towards rising angles.
fn find_motor(
    lab: &mut Lab,
    file: &DeviceFile,
    (joint, most): (usize, f64),
    (centre, towards): ([f64; 3], f64),
    taken: [bool; 3],
) -> anyhow::Result<(usize, bool)> {
    // The one that the file names first: most files are right.
    let named = file.joint[joint].motor.channel;
    let mut outputs: Vec<usize> = (0..3).filter(|output| !taken[*output]).collect();
    outputs.sort_by_key(|output| *output != named);
    for output in outputs {
        for sign in [1.0, -1.0] {
            lab.place(centre)?;
            lab.hands.rest(joint, towards)?;
            let counts = lab.device.step(None)?.counts;
            let before = angle(file, joint, counts);
            let moved = |counts| towards * (angle(file, joint, counts) - before);
            if (0..5).any(|_| lab.device.step(None).is_ok_and(|reading| moved(reading.counts).abs() > 0.5 * MOVED)) {
                bail!("joint {}: it moves by itself; support it against falling", file.joint[joint].name);
            }
            let output_byte = u8::try_from(output)?;
            let found = grow(lab, output_byte, sign, (0.0, Growth::BRISK, most), |counts| moved(counts) > MOVED)?;
            lab.device.step(None)?;
            if found.is_some() {
                return Ok((output, sign * towards > 0.0));
            }
        }
    }
    None.with_context(|| format!("joint {}: no motor moves it", file.joint[joint].name))
}
