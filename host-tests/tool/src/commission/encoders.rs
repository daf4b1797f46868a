//! Input, sign, ratio and zero of each encoder: from two known angles of each joint.

use super::lab::differs;
use super::{Finding, Lab, Zero};
use anyhow::bail;
use palpate_sim::devices::{DeviceFile, HomingEntry, JointEntry};
use std::f64::consts::TAU;

/// How far each joint is turned from the middle of the workspace, either way, rad.
const TURN: f64 = 0.15;
/// Travel beyond the expected position of a mark, in either direction, turns of its encoder.
const PAST: f64 = 0.6;
/// Distance from the ends of its range, rad.
const OFF_STOPS: f64 = 0.05;
/// More than a hard support, or a jig, yields under the links' weight, rad: a smaller difference from the file is not of
/// the device.
pub const GIVE: f64 = 5e-4;
/// Minimum counts between the two angles for an input with an encoder.
const LEAST: i32 = 50;

/// Measures the encoders and writes the results into the file. The counters start at the joints' position at the
/// board's reset: for a device that is homed by a pose, zero is the angle there.
pub(super) fn find_encoders(
    lab: &mut Lab,
    file: &mut DeviceFile,
    (centre, by): ([f64; 3], Zero),
    findings: &mut Vec<Finding>,
) -> anyhow::Result<()> {
    let file_pose = core::array::from_fn(|joint| file.joint[joint].encoder.zero);
    let pose = match file.homing {
        HomingEntry::Pose => lab.pose(file_pose)?,
        HomingEntry::Index | HomingEntry::None => [0; 3],
    };
    for index in 0..3 {
        let [low, high] = match by {
            Zero::Jig | Zero::Index => [centre[index] - TURN, centre[index] + TURN],
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
        // Either reading is up to half a count off its middle, and its support yields.
        let telling = (2.0 / f64::from(size(input))).max(GIVE / (high - low));
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
        let zero = if file.homing == HomingEntry::Index {
            // As after a pose: half a count below the angle there.
            zero + count * mark(lab, &file.joint[index], (index, input), (centre, zero))?
        } else {
            zero
        };
        let entry = &mut file.joint[index].encoder;
        if (zero - entry.zero).abs() > GIVE.max(2.0 * count.abs()) {
            findings.push(Finding(format!("joint {name}: encoder zero {zero:.4} rad, not {:.4}", entry.zero)));
            entry.zero = zero;
        }
    }
    Ok(())
}

/// The counts from the start of the counter to the joint's mark, which comes once in each turn of the encoder's shaft;
/// with several marks in the workspace, to the one nearest to its middle. `line` is the angle at which the count steps
/// from −1 to 0.
fn mark(
    lab: &mut Lab,
    joint: &JointEntry,
    (index, input): (usize, usize),
    (centre, line): ([f64; 3], f64),
) -> anyhow::Result<f64> {
    let (name, JointEntry { range: [least, most], encoder, .. }) = (&joint.name, joint);
    let turn = TAU / encoder.ratio;
    let reach = PAST * turn.abs();
    let at = |angle: f64| {
        let mut angles = centre;
        angles[index] = angle.clamp(least + OFF_STOPS, most - OFF_STOPS);
        angles
    };
    let (low, high) = (at(centre[index] - reach), at(centre[index] + reach));
    lab.place(low)?;
    let before = lab.device.marked();
    let forth = lab.pass(index, high)?;
    let back = lab.pass(index, low)?;
    let has_passed =
        |input: usize| forth.passes[input] != before.passes[input] && back.passes[input] != forth.passes[input];
    if !has_passed(input) {
        if let Some(other) = (0..3).find(|other| has_passed(*other)) {
            bail!("joint {name}: its encoder is on input {input}, and its index mark came on input {other}");
        }
        bail!(
            "joint {name}: no index mark came on input {input}, there and back between {:.1}° and {:.1}°: the board has \
             none wired there, or the encoder has none",
            low[index].to_degrees(),
            high[index].to_degrees()
        );
    }
    let apart = f64::from(back.counts[input].wrapping_sub(forth.counts[input]));
    let turns = (apart / encoder.counts).round();
    if (apart - turns * encoder.counts).abs() > 1.5 {
        bail!(
            "joint {name}: its index mark came at counts {} and {}, which are not whole turns of {} apart: it is loose, \
             or the file's counts are wrong",
            forth.counts[input],
            back.counts[input],
            encoder.counts
        );
    }
    let found = f64::from(forth.counts[input]);
    let angle = line + (found + 0.5) * turn / encoder.counts;
    Ok(found - ((angle - centre[index]) / turn).round() * encoder.counts)
}

/// From which angles on homing by a mark finds the very mark that was measured, of each joint that has several: a
/// sentence each.
pub fn begin_within(file: &DeviceFile) -> Vec<String> {
    let joints = file.joint.iter().filter(|_| file.homing == HomingEntry::Index);
    let several = joints.filter_map(|joint| {
        let (turn, [least, most]) = ((TAU / joint.encoder.ratio).abs(), joint.range);
        let mark = joint.encoder.zero + 0.5 * turn / joint.encoder.counts * joint.encoder.ratio.signum();
        let [low, high] = [(mark - 0.5 * turn).max(least), (mark + 0.5 * turn).min(most)];
        (turn < most - least).then(|| {
            format!(
                "joint {}: its mark comes once in {:.1}° of it. Begin homing between {:.1}° and {:.1}°, and move it \
                 towards {:.1}° first: another mark would be taken for this one",
                joint.name,
                turn.to_degrees(),
                low.to_degrees(),
                high.to_degrees(),
                mark.to_degrees()
            )
        })
    });
    several.collect()
}

/// A joint's angle, rad, from a reading's counts.
pub fn angle(file: &DeviceFile, joint: usize, counts: [i32; 3]) -> f64 {
    let encoder = &file.joint[joint].encoder;
    (f64::from(counts[encoder.channel]) + 0.5) * TAU / (encoder.counts * encoder.ratio) + encoder.zero
}
