//! Input, sign, ratio and zero of each encoder: from two known angles of each joint.

use super::finding::differs;
use super::{Finding, Lab, Zero};
use crate::own::{DeviceFile, HomingEntry};
use anyhow::bail;
use std::f64::consts::TAU;

/// How far each joint is turned from the middle of the workspace, either way, rad.
const TURN: f64 = 0.15;
/// Fewer counts than this between the two angles are no encoder.
const LEAST: i32 = 50;

/// Finds them and writes them into the file. The counters begin wherever the joints stood at the board's reset: of a
/// device that is homed by a pose, zero is the angle there.
pub(super) fn find_encoders(
    lab: &mut Lab,
    file: &mut DeviceFile,
    (centre, by): ([f64; 3], Zero),
    findings: &mut Vec<Finding>,
) -> anyhow::Result<()> {
    let file_pose = core::array::from_fn(|joint| file.joint[joint].encoder.zero);
    let pose = match file.homing {
        HomingEntry::Pose => lab.pose(file_pose)?,
        HomingEntry::None => [0; 3],
    };
    for index in 0..3 {
        let [low, high] = match by {
            Zero::Jig => [centre[index] - TURN, centre[index] + TURN],
            Zero::Stops => file.joint[index].range,
        };
        let mut at = |angle: f64| {
            let mut angles = centre;
            angles[index] = angle;
            lab.place(angles)
        };
        let (first, second) = (at(low)?, at(high)?);
        let moved: [i32; 3] = core::array::from_fn(|input| second[input].wrapping_sub(first[input]));
        let size = |input: usize| moved[input].unsigned_abs();
        let input = (0..3).max_by_key(|input| size(*input)).unwrap_or(0);
        let name = file.joint[index].name.clone();
        if size(input) < LEAST as u32 {
            bail!("joint {name}: no encoder moved by {LEAST} counts when it was turned by {:.2} rad", high - low);
        }
        if (0..3).any(|other| other != input && size(other) > size(input) / 10) {
            bail!("joint {name}: two encoders moved when it was turned alone: {moved:?} counts");
        }
        let per_radian = f64::from(moved[input]) / (high - low);
        let entry = &mut file.joint[index].encoder;
        let ratio = per_radian * TAU / entry.counts;
        // Either reading is up to half a count off its middle.
        let telling = 2.0 / f64::from(size(input));
        if differs(ratio, entry.ratio, telling) {
            let what = if differs(ratio.abs(), entry.ratio.abs(), telling) { "ratio" } else { "sign" };
            findings.push(Finding(format!("joint {name}: encoder {what} {ratio:.3}, not {:.3}", entry.ratio)));
            entry.ratio = if what == "sign" { -entry.ratio } else { ratio };
        }
        if entry.channel != input {
            findings.push(Finding(format!("joint {name}: encoder on input {input}, not {}", entry.channel)));
            entry.channel = input;
        }
        let count = TAU / (entry.counts * entry.ratio);
        let zero = low - (f64::from(first[input].wrapping_sub(pose[input])) + 0.5) * count;
        if (zero - entry.zero).abs() > 2.0 * count.abs() {
            findings.push(Finding(format!("joint {name}: encoder zero {zero:.4} rad, not {:.4}", entry.zero)));
            entry.zero = zero;
        }
    }
    Ok(())
}

/// A joint's angle, rad, from a reading's counts.
pub fn angle(file: &DeviceFile, joint: usize, counts: [i32; 3]) -> f64 {
    let encoder = &file.joint[joint].encoder;
    (f64::from(counts[encoder.channel]) + 0.5) * TAU / (encoder.counts * encoder.ratio) + encoder.zero
}
