//! Torque constant and friction of each joint: the duties that just lift it off its support and just let it sink back,
//! with and without a known weight.
//!
//! A joint that just moves up has a motor that carries the load and the friction; one that just sinks back, the load
//! less the friction. Their mean is the load, which weighs the links, half their difference the friction; what a known weight adds to the load
//! is what a share of full duty is worth. Where that duty lies is found briskly first; then it is come to slowly, for a
//! joint that has just come loose is not seen to move before it has gone two counts. The duty's growth meanwhile is no
//! friction: it follows from inertia and, on a bridge, back-EMF, and is subtracted.

use super::device::said;
use super::encoders::{GIVE, angle};
use super::lab::differs;
use super::motors::away;
use super::motors::{Growth, duty, grow, most};
use super::{Finding, Lab};
use anyhow::{Context as _, bail};
use palpate::wire::Reading;
use palpate_sim::devices::{DeviceFile, JointEntry, LinkageEntry, MechanismEntry, OwnDevice};
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Load of the weight on a joint, as a fraction of its motor's data-sheet torque: maximum, and minimum where gravity
/// and friction leave no more.
const LOADS: [f64; 2] = [0.1, 0.02];
/// Lead of the slow search below the duty that the brisk one found, as a fraction of full duty: a fifth of that duty,
/// or this.
const LEAD: f64 = 0.03;
/// Minimum motion, counts, and at least [`GIVE`].
const COUNTS: f64 = 2.0;

/// The outcome of weighing.
#[derive(Clone, Debug)]
pub struct Weights {
    /// The measured torques that hold each joint beside the file's.
    pub line: String,
    /// A sentence for each contradiction. The masses are then as the file had them; torque constants and friction too,
    /// unless the file's masses alone do not fit.
    pub doubts: Vec<String>,
}

/// Measured torques of a joint.
#[derive(Clone, Copy, Debug, Default)]
struct Torques {
    /// N·m/A.
    constant: f64,
    /// N·m.
    friction: f64,
    /// That holds the joint, N·m, with the sign of gravity's load.
    held: f64,
}

impl Torques {
    /// Whether the motor's torque constant, N·m/A, explains this load where the measured one does not. The known weight
    /// then weighed something else: the arm's own weight would have to be wrong by the same factor.
    fn contradicts(&self, constant: f64, load: f64) -> bool {
        let by_file = self.held * constant / self.constant;
        load.abs() > LIGHT && is_off(load, self.held) && !is_off(load, by_file)
    }
}

/// Measures the torques and writes them into the file. `loads` are gravity's torques on the joints, N·m.
pub(super) fn find_torques(
    lab: &mut Lab,
    file: &mut DeviceFile,
    own: &OwnDevice,
    (centre, loads): ([f64; 3], [f64; 3]),
    findings: &mut Vec<Finding>,
) -> anyhow::Result<Weights> {
    let most = most(own);
    let jacobian = own.plant.mechanism(0.0).jacobian(centre);
    let mut found = [Torques::default(); 3];
    for (index, (found, load)) in found.iter_mut().zip(loads).enumerate() {
        let column = core::array::from_fn(|axis| jacobian[axis][index]);
        *found = weigh_joint(lab, file, (centre, index), (away(load), most), column)?;
    }
    let held = found.map(|found| found.held);
    let line = weights(file, loads, held);
    let joints = file.joint.iter().zip(found.iter().zip(loads));
    let doubtful = joints.filter(|(joint, (found, load))| found.contradicts(joint.motor.torque_constant, *load));
    let doubts: Vec<_> = doubtful
        .map(|(joint, (found, _))| {
            format!(
                "joint {}: by the known mass its torque constant is {:.4} N·m/A, by the arm's own weight {:.4} as in the \
                 file: torque constants, friction and masses are left as they are. Check the known mass and its \
                 direction, and weigh again",
                joint.name, found.constant, joint.motor.torque_constant
            )
        })
        .collect();
    if !doubts.is_empty() {
        return Ok(Weights { line, doubts });
    }
    for (joint, Torques { constant, friction, .. }) in file.joint.iter_mut().zip(found) {
        let (name, motor) = (&joint.name, &mut joint.motor);
        // The weight's duty is read to the last step of the ramp, 1.5 % of it and of friction.
        if differs(constant, motor.torque_constant, 0.05) {
            let known = motor.torque_constant;
            findings.push(Finding(format!("joint {name}: torque constant {constant:.4} N·m/A, not {known:.4}")));
            motor.torque_constant = constant;
        }
        if differs(friction, joint.friction, 0.3) && (friction - joint.friction).abs() > 4e-3 {
            findings.push(Finding(format!("joint {name}: friction {friction:.3} N·m, not {:.3}", joint.friction)));
            joint.friction = friction;
        }
    }
    // The torque constants rest on the known mass alone, so that masses of the file that are not known harm none.
    let doubts = weigh(file, loads, held, findings).into_iter().collect();
    Ok(Weights { line, doubts })
}

/// Measures a joint's torques. `column` is the probe's motion with the joint, m/rad.
fn weigh_joint(
    lab: &mut Lab,
    file: &DeviceFile,
    (centre, index): ([f64; 3], usize),
    (towards, most): (f64, f64),
    column: [f64; 3],
) -> anyhow::Result<Torques> {
    let joint = &file.joint[index];
    let JointEntry { name, motor, .. } = joint;
    let lever = column.iter().map(|part| part * part).sum::<f64>().sqrt();
    let by_file = (motor.torque_constant * motor.current_at_full * motor.ratio).abs();
    let bare = edges(lab, file, (centre, index), (towards, most))?;
    let up = bare[0].share;
    // What is left for a weight, and two fifths of it for a motor that is weaker than the file says.
    let share = LOADS[0].min(0.6 * (most - up));
    if share < LOADS[1] {
        bail!(
            "joint {name}: gravity and friction take {:.0} % of full duty, and with {:.0} % of it at most there is \
             nothing left to measure a weight with: balance the arm first",
            100.0 * up,
            100.0 * most
        );
    }
    let wanted = share * by_file / lever;
    // The way the load falls.
    let pulled = lab.hands.pull(column.map(|part| -towards * part / lever * wanted))?;
    let weighed = edges(lab, file, (centre, index), (towards, most))?;
    lab.hands.pull([0.0; 3])?;
    // What brakes the joint depends on the torque that is looked for, little: the third time changes nothing.
    let mut full = by_file;
    for _ in 0..3 {
        let joint = Resistance::of(joint, full);
        full = pulled * lever / (mean(joint.loose(&weighed)) - mean(joint.loose(&bare)));
    }
    let constant = full / (motor.current_at_full * motor.ratio).abs();
    if !constant.is_finite() || constant <= 0.0 {
        bail!("joint {name}: the added mass changed nothing; use a larger one");
    }
    let [up, down] = Resistance::of(joint, full).loose(&bare);
    // The motor holds against the load.
    Ok(Torques { constant, friction: 0.5 * (up - down) * full, held: -towards * mean([up, down]) * full })
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
/// By which factor masses are corrected; more is another arm, or none.
const MASSES_WITHIN: RangeInclusive<f64> = 0.25..=4.0;
/// Loads below which a joint weighs nothing, N·m: friction hides them.
const LIGHT: f64 = 0.01;

/// Compares what holding each joint takes, N·m, with gravity's loads by the file, and writes the masses that explain
/// it. A sentence where none do.
fn weigh(file: &mut DeviceFile, loads: [f64; 3], held: [f64; 3], findings: &mut Vec<Finding>) -> Option<String> {
    let off: Vec<usize> = (0..3).filter(|joint| is_off(loads[*joint], held[*joint])).collect();
    for &joint in &off {
        let (name, held, load) = (&file.joint[joint].name, held[joint], loads[joint]);
        findings.push(Finding(format!("joint {name}: holding it takes {held:.3} N·m, not {load:.3}")));
    }
    let ratio = |joint: usize| if loads[joint].abs() > LIGHT { held[joint] / loads[joint] } else { f64::NAN };
    let all = loads.iter().map(|load| load * load).sum::<f64>();
    let common = (0..3).map(|joint| held[joint] * loads[joint]).sum::<f64>() / all;
    // A load the other way, of a joint that should have none, or of next to nothing is no matter of masses.
    let masses = off.iter().all(|joint| MASSES_WITHIN.contains(&ratio(*joint)));
    if off.is_empty() {
        return None;
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
        _ => {
            return Some(
                "the file's masses do not explain the torques that hold the arm, and are left as they are: correct \
                 them, and check that nothing but the arm pulls"
                    .to_owned(),
            );
        }
    }
    None
}

/// A duty, growing or falling, at which a joint was seen to move.
#[derive(Clone, Copy, Debug)]
struct Edge {
    /// Fraction of full duty.
    share: f64,
    /// By how much it changed in the last step, as a fraction of full duty.
    step: f64,
    /// How far the joint had moved, rad.
    motion: f64,
}

/// The resistance of a moving joint, apart from load and friction.
#[derive(Clone, Copy, Debug)]
struct Resistance {
    /// Torque at full duty, N·m.
    full: f64,
    /// Kg·m²; 0 where the file states none.
    inertia: f64,
    /// Back-EMF of a motor on a bridge, N·m·s: a jog commands the bridge as if the joint were at rest.
    braking: f64,
}

impl Resistance {
    /// Of a joint whose motor has this torque at full duty, N·m. `V = R i + k N q̇`, and full duty of torque is a current.
    fn of(joint: &JointEntry, full: f64) -> Self {
        let JointEntry { inertia, motor, .. } = joint;
        let constant = full / motor.current_at_full;
        let braking = motor.bridge.map_or(0.0, |bridge| constant * constant / bridge.resistance);
        Self { full, inertia: inertia.unwrap_or(0.0), braking }
    }

    /// By which share of full duty an edge lies beyond the one at which the joint came loose: the duty goes on changing
    /// until the motion is seen.
    fn excess(&self, edge: &Edge) -> f64 {
        let Self { full, inertia, braking } = *self;
        if inertia + braking <= 0.0 {
            return 0.0;
        }
        let (mut time, mut rate, mut moved) = (0.0, 0.0, 0.0);
        while moved < edge.motion && time < LONGEST {
            time += MOMENT;
            let torque = full * edge.step * time / STEP;
            // Implicit Euler: stable for any braking.
            rate = (inertia * rate + MOMENT * torque) / (inertia + MOMENT * braking);
            moved += MOMENT * rate;
        }
        // The duty is constant through a step: on average it lags behind an even growth by half of one.
        (edge.step * (time / STEP - 0.5)).max(0.0)
    }

    /// The shares of full duty, up and down, at which the joint came loose.
    fn loose(&self, [up, down]: &[Edge; 2]) -> [f64; 2] {
        [up.share - self.excess(up), down.share + self.excess(down)]
    }
}

/// A step of a jog, s.
const STEP: f64 = 0.02;
/// Step and end of the integration of a joint's motion, s.
const MOMENT: f64 = 1e-3;
const LONGEST: f64 = 5.0;

fn mean([up, down]: [f64; 2]) -> f64 {
    0.5 * (up + down)
}

/// The height of a joint over the place where it rested on its support, reading by reading.
struct Rise<'a> {
    file: &'a DeviceFile,
    joint: usize,
    /// The direction of rising: 1 or −1.
    towards: f64,
    /// Angle at rest, rad.
    rested: f64,
    /// Now, and by how much more than a reading before, rad.
    height: f64,
    risen: f64,
}

impl<'a> Rise<'a> {
    fn at_rest(file: &'a DeviceFile, (joint, towards): (usize, f64), reading: &Reading) -> Self {
        Self { file, joint, towards, rested: angle(file, joint, reading.counts), height: 0.0, risen: 0.0 }
    }

    /// The height at this reading, rad.
    fn next(&mut self, reading: &Reading) -> f64 {
        let height = self.towards * (angle(self.file, self.joint, reading.counts) - self.rested);
        (self.height, self.risen) = (height, height - self.height);
        height
    }
}

/// The shares of full duty, off the support, that just move a joint up, and just let it sink back.
fn edges(
    lab: &mut Lab,
    file: &DeviceFile,
    (centre, joint): ([f64; 3], usize),
    (towards, most): (f64, f64),
) -> anyhow::Result<[Edge; 2]> {
    let entry = &file.joint[joint];
    let (output, sign) = (u8::try_from(entry.motor.channel)?, entry.motor.ratio.signum() * towards);
    let motion = GIVE.max(COUNTS * (TAU / (entry.encoder.counts * entry.encoder.ratio)).abs());
    // A support rises by what it yielded once its load goes: sinking must be seen before it takes the load again.
    let clear = motion + GIVE;
    let rest = |lab: &mut Lab| {
        lab.place(centre)?;
        lab.hands.rest(joint, towards)?;
        anyhow::Ok(Rise::at_rest(file, (joint, towards), &lab.device.step(None)?))
    };
    let climb = |lab: &mut Lab, rise: &mut Rise<'_>, (from, growth): (f64, Growth), least: f64| {
        let risen = grow(lab, output, sign, (from, growth, most), |reading| rise.next(reading) >= least)?;
        risen.map(|(share, _)| share).with_context(|| {
            format!(
                "joint {}: {:.0} % of full duty do not lift it off its support: take less weight, or balance the arm",
                entry.name,
                100.0 * most
            )
        })
    };
    let hold = |lab: &mut Lab, rise: &mut Rise<'_>, share: f64| {
        let reading = lab.device.step(Some((output, duty(sign * share))))?;
        rise.next(&reading);
        if !reading.live {
            bail!(
                "joint {}: key or enable button were released during a measurement{}; start again",
                entry.name,
                said(&reading)
            );
        }
        Ok(())
    };
    let mut rise = rest(lab)?;
    let about = climb(lab, &mut rise, (0.0, Growth::BRISK), motion)?;
    let mut rise = rest(lab)?;
    let mut share = climb(lab, &mut rise, ((about - LEAD.max(0.2 * about)).max(0.0), Growth::FINE), motion)?;
    let up = Edge { share, step: Growth::FINE.least, motion: rise.height };
    let mut highest = rise.height;
    loop {
        let (top, mut drop) = (share, 0.0);
        while rise.risen > 0.0 && share > -most {
            drop = Growth::BACK.next(drop);
            share = top - drop;
            hold(lab, &mut rise, share)?;
            highest = highest.max(rise.height);
        }
        if highest >= clear {
            break;
        }
        share = climb(lab, &mut rise, (share, Growth::FINE), clear)?;
        highest = highest.max(rise.height);
    }
    let (top, mut drop) = (share, 0.0);
    while share > -most {
        let before = drop;
        drop = Growth::SINK.next(drop);
        share = top - drop;
        hold(lab, &mut rise, share)?;
        highest = highest.max(rise.height);
        if rise.height <= highest - motion {
            lab.device.step(None)?;
            return Ok([up, Edge { share, step: drop - before, motion: highest - rise.height }]);
        }
    }
    bail!("joint {}: it does not sink back on its support", entry.name)
}
