//! Torque constant and friction of each joint: the duties that just lift it off its support and just let it sink back,
//! with and without a known weight.
//!
//! A joint that just moves up has a motor that carries the load and the friction; one that just sinks back, the load
//! less the friction. Their mean is the load, which weighs the links, half their difference the friction; what a known weight adds to the load
//! is what a share of full duty is worth. Where that duty lies is found briskly first; then it is come to slowly, for a
//! joint that has just come loose is not seen to move before it has gone two counts, and by how much the duty has grown
//! meanwhile is taken for friction too.

use super::device::said;
use super::encoders::{GIVE, angle};
use super::lab::differs;
use super::motors::away;
use super::motors::{Growth, duty, grow, most};
use super::{Finding, Lab};
use anyhow::{Context as _, bail};
use palpate_sim::devices::{DeviceFile, LinkageEntry, MechanismEntry, OwnDevice};
use std::f64::consts::TAU;

/// Load of the weight on a joint, as a fraction of its motor's data-sheet torque: maximum, and minimum where gravity
/// and friction leave no more.
const LOADS: [f64; 2] = [0.1, 0.02];
/// Lead of the slow search below the duty that the brisk one found, as a fraction of full duty: a fifth of that duty,
/// or this.
const LEAD: f64 = 0.03;
/// Minimum motion, counts, and at least [`GIVE`].
const COUNTS: f64 = 2.0;

/// Measures the torques and writes them into the file. `loads` are gravity's torques on the joints, N·m. Returns them
/// beside the measured ones, in a line.
pub(super) fn find_torques(
    lab: &mut Lab,
    file: &mut DeviceFile,
    own: &OwnDevice,
    (centre, loads): ([f64; 3], [f64; 3]),
    findings: &mut Vec<Finding>,
) -> anyhow::Result<String> {
    let most = most(own);
    let mut held = [0.0; 3];
    let jacobian = own.plant.mechanism(0.0).jacobian(centre);
    for (index, load) in loads.into_iter().enumerate() {
        let column: [f64; 3] = core::array::from_fn(|axis| jacobian[axis][index]);
        let lever = column.iter().map(|part| part * part).sum::<f64>().sqrt();
        let motor = &file.joint[index].motor;
        let by_file = (motor.torque_constant * motor.current_at_full * motor.ratio).abs();
        let towards = away(load);
        let [up, down] = edges(lab, file, (centre, index), (towards, most))?;
        // What is left for a weight, and two fifths of it for a motor that is weaker than the file says.
        let share = LOADS[0].min(0.6 * (most - up));
        if share < LOADS[1] {
            bail!(
                "joint {}: gravity and friction take {:.0} % of full duty, and with {:.0} % of it at most there is \
                 nothing left to measure a weight with: balance the arm first",
                file.joint[index].name,
                100.0 * up,
                100.0 * most
            );
        }
        let wanted = share * by_file / lever;
        // The way the load falls.
        let pulled = lab.hands.pull(column.map(|part| -towards * part / lever * wanted))?;
        let [weighed_up, weighed_down] = edges(lab, file, (centre, index), (towards, most))?;
        lab.hands.pull([0.0; 3])?;
        let full = pulled * lever / (0.5 * (weighed_up + weighed_down) - 0.5 * (up + down));
        // The motor holds against the load.
        held[index] = -towards * 0.5 * (up + down) * full;
        let joint = &mut file.joint[index];
        let motor = &mut joint.motor;
        let found = full / (motor.current_at_full * motor.ratio).abs();
        if !found.is_finite() || found <= 0.0 {
            bail!("joint {}: the added mass changed nothing; use a larger one", joint.name);
        }
        // The weight's duty is read to the last step of the ramp, 1.5 % of it and of friction.
        if differs(found, motor.torque_constant, 0.05) {
            findings.push(Finding(format!(
                "joint {}: torque constant {found:.4} N·m/A, not {:.4}",
                joint.name, motor.torque_constant
            )));
            motor.torque_constant = found;
        }
        let friction = 0.5 * (up - down) * full;
        if differs(friction, joint.friction, 0.3) && (friction - joint.friction).abs() > 4e-3 {
            findings
                .push(Finding(format!("joint {}: friction {friction:.3} N·m, not {:.3}", joint.name, joint.friction)));
            joint.friction = friction;
        }
    }
    weigh(file, loads, held, findings);
    Ok(weights(file, loads, held))
}

/// The torques that hold each joint, N·m, measured and by the file, in a line.
fn weights(file: &DeviceFile, loads: [f64; 3], held: [f64; 3]) -> String {
    let joints = file.joint.iter().zip(held.into_iter().zip(loads));
    let each: Vec<String> =
        joints.map(|(joint, (held, load))| format!("{} {held:.3} ({load:.3})", joint.name)).collect();
    let verdict = if (0..3).any(|joint| is_off(loads[joint], held[joint])) { "differ" } else { "agree" };
    format!(
        "weights {verdict}, N·m that hold each joint, measured (by the file): {}; {:.0} % and {STEPS} N·m are allowed",
        each.join(", "),
        100.0 * WEIGHT_WITHIN
    )
}

fn is_off(load: f64, held: f64) -> bool {
    (held - load).abs() > WEIGHT_WITHIN * load.abs() + STEPS
}

/// Share of a load by which holding it may differ: the torque constant's uncertainty. Less than the 10 % with which a
/// light arm sinks.
const WEIGHT_WITHIN: f64 = 0.05;
/// And this, N·m: a few steps of the duty beyond the one at which a joint just moves.
const STEPS: f64 = 2e-3;
/// Loads below which a joint weighs nothing, N·m: friction hides them.
const LIGHT: f64 = 0.01;

/// Compares what holding each joint takes, N·m, with gravity's loads by the file, and writes the masses that explain
/// it.
fn weigh(file: &mut DeviceFile, loads: [f64; 3], held: [f64; 3], findings: &mut Vec<Finding>) {
    let off: Vec<usize> = (0..3).filter(|joint| is_off(loads[*joint], held[*joint])).collect();
    for &joint in &off {
        let (name, held, load) = (&file.joint[joint].name, held[joint], loads[joint]);
        findings.push(Finding(format!("joint {name}: holding it takes {held:.3} N·m, not {load:.3}")));
    }
    let ratio = |joint: usize| if loads[joint].abs() > LIGHT { held[joint] / loads[joint] } else { f64::NAN };
    let all = loads.iter().map(|load| load * load).sum::<f64>();
    let common = (0..3).map(|joint| held[joint] * loads[joint]).sum::<f64>() / all;
    // A load the other way, or of a joint that should have none, is no matter of masses.
    let masses = off.iter().all(|joint| ratio(*joint) > 0.0);
    if off.is_empty() {
        return;
    }
    match &mut file.mechanism {
        MechanismEntry::SerialArm { end_masses, .. } if masses => {
            for joint in off {
                // The first joint is a turntable, whose ratio is none.
                end_masses[joint - 1] *= ratio(joint);
            }
            findings.push(Finding(format!("end masses {:.4} and {:.4} kg", end_masses[0], end_masses[1])));
        }
        MechanismEntry::LinkageArm(LinkageEntry { masses: Some(links), .. }) if masses => {
            links.iter_mut().for_each(|link| link.mass *= common);
            findings.push(Finding(format!("links weigh {common:.3} times as much")));
        }
        MechanismEntry::Delta { carried_mass, thigh_moment, .. } if masses => {
            (*carried_mass, *thigh_moment) = (*carried_mass * common, *thigh_moment * common);
            findings.push(Finding(format!("plate and thighs weigh {common:.3} times as much")));
        }
        _ => findings.push(Finding(
            "the file's masses do not explain it: check them, and that nothing but the arm pulls".to_owned(),
        )),
    }
}

/// The shares of full duty, off the support, that just move a joint up, and just let it sink back.
fn edges(
    lab: &mut Lab,
    file: &DeviceFile,
    (centre, joint): ([f64; 3], usize),
    (towards, most): (f64, f64),
) -> anyhow::Result<[f64; 2]> {
    let entry = &file.joint[joint];
    let (output, sign) = (u8::try_from(entry.motor.channel)?, entry.motor.ratio.signum() * towards);
    let motion = GIVE.max(COUNTS * (TAU / (entry.encoder.counts * entry.encoder.ratio)).abs());
    let mut lift = |from: f64, growth: Growth| {
        lab.place(centre)?;
        lab.hands.rest(joint, towards)?;
        let before = angle(file, joint, lab.device.step(None)?.counts);
        let height = move |counts| towards * (angle(file, joint, counts) - before);
        let lifted = grow(lab, output, sign, (from, growth, most), |counts| height(counts) >= motion)?;
        let (up, counts) = lifted.with_context(|| {
            format!(
                "joint {}: {:.0} % of full duty do not lift it off its support: take less weight, or balance the arm",
                entry.name,
                100.0 * most
            )
        })?;
        anyhow::Ok((up, height(counts), before))
    };
    let (about, ..) = lift(0.0, Growth::BRISK)?;
    let (up, reached, before) = lift((about - LEAD.max(0.2 * about)).max(0.0), Growth::FINE)?;
    let height = |counts| towards * (angle(file, joint, counts) - before);
    let (mut highest, mut drop) = (reached, 0.0);
    while up - drop > -most {
        drop = Growth::BACK.next(drop);
        let reading = lab.device.step(Some((output, duty(sign * (up - drop)))))?;
        let now = height(reading.counts);
        highest = highest.max(now);
        if now <= highest - motion {
            lab.device.step(None)?;
            return Ok([up, up - drop]);
        }
        if !reading.live {
            bail!(
                "joint {}: key or enable button were released during a measurement{}; start again",
                entry.name,
                said(&reading)
            );
        }
    }
    bail!("joint {}: it does not sink back on its support", entry.name)
}
