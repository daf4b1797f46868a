//! A motor's cogging, recorded while its field is led round.

use super::{HostKnob, PROTECTION, SEARCH, TOLD_OF_SUPPLY, device, servo};
use palpate::device::presets::GIMBAL_KNOB;
use palpate::device::{Commutation, Counts, ElectricalAngle, FieldSearch};
use palpate_plant::Dial;
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Entries of a map: eight to the finest cogging of 264 a turn.
pub const ENTRIES: usize = 2_048;
/// Parts that come so seldom a turn are no cogging, which comes with every pole or tooth, but a magnet off its centre.
const SLOW: usize = 4;

/// The search that goes round the whole motor, slowly, and an electrical turn more: where the way begins, friction has
/// yet to come round. Its torque is all that the motor bears for ever, so that its heat never takes any of it away: the
/// field must hold the rotor more stiffly than the finest cogging pulls it on, or it jumps from tooth to tooth.
pub const AROUND: FieldSearch =
    FieldSearch { turns: SEARCH.commutation.pole_pairs + 1, turn_ticks: 16_000, torque: 0.04, ..SEARCH };
const _: () = assert!(AROUND.torque <= PROTECTION.motors[0].continuous * GIMBAL_KNOB.motors[0].torque_at_full);
/// Ticks at the beginning of each way in which it comes round: three quarters of an electrical turn.
const COMING_ROUND: u32 = AROUND.turn_ticks / 4 * 3;

/// Torques that cancel the cogging, N·m, evenly spaced from joint angle zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording(Vec<f64>);

/// What is seen of a place.
#[derive(Clone, Copy, Default)]
struct Place {
    sum: [f64; 2],
    seen: [u32; 2],
}

/// Leads a dial's field round the whole motor, there and back, and records how far its rotor is behind.
///
/// The field's torque on the rotor is `T sin(lag)`; at the speed of a creep it is what cancels the cogging and the
/// friction. That is as much on the way there as against it on the way back: the mean of both ways is without it.
///
/// # Errors
/// The alignment is refused.
pub fn record(dial: Dial) -> anyhow::Result<Recording> {
    let mut knob = HostKnob::new(servo(Box::leak(Box::new(device(None))), AROUND, TOLD_OF_SUPPLY), dial);
    let mut seen = Vec::new();
    let mut fields = vec![ElectricalAngle(0)];
    while !knob.state().homing().is_done() {
        knob.tick();
        if let Some((fault, _)) = knob.state().fault() {
            anyhow::bail!("{fault}: {:?}", knob.state().homing().refusal());
        }
        let [Counts(counts)] = knob.state().counts().unwrap_or_default();
        seen.push(counts);
        let [field] = knob.servo().fields(knob.state()).unwrap_or_default();
        fields.push(field);
    }
    let Commutation { counts_per_turn, .. } = AROUND.commutation;
    let [aligned] = knob.state().homing().aligned();
    let mut places = vec![Place::default(); ENTRIES];
    // The first tick of the loop senses, and the second begins the search.
    let begin = seen.len() as u32 - AROUND.ticks() - 1;
    for (tick, counts) in seen.iter().enumerate() {
        let Some(led) = (tick as u32).checked_sub(begin) else { continue };
        if !AROUND.plan(led).2 {
            continue;
        }
        let there = AROUND.turn_ticks * u32::from(AROUND.turns);
        let gone = led - AROUND.ramp_ticks - AROUND.turn_ticks;
        let way = usize::from(gone >= there);
        if gone % there < COMING_ROUND {
            continue;
        }
        // What the rotor follows is the field of the tick before.
        let ahead = fields[tick].0.wrapping_sub(AROUND.commutation.rotor(aligned, Counts(*counts)).0);
        let lag = f64::from(ElectricalAngle(ahead).radians()) * if aligned.reversed { -1.0 } else { 1.0 };
        let turn = f64::from(counts.rem_euclid(counts_per_turn as i32)) + 0.5;
        let place = (turn / f64::from(counts_per_turn) * ENTRIES as f64 + 0.5) as usize % ENTRIES;
        places[place].sum[way] += f64::from(AROUND.torque) * lag.sin();
        places[place].seen[way] += 1;
    }
    let mean = |place: &Place, way: usize| (place.seen[way] > 0).then(|| place.sum[way] / f64::from(place.seen[way]));
    let mut torques: Vec<Option<f64>> =
        places.iter().map(|place| Some(0.5 * (mean(place, 0)? + mean(place, 1)?))).collect();
    // Where it jumped over a place, what is on its left.
    for index in 0..2 * ENTRIES {
        let left = torques[(index + ENTRIES - 1) % ENTRIES];
        let here = &mut torques[index % ENTRIES];
        *here = here.or(left);
    }
    let mut torques: Vec<f64> = torques.into_iter().map(Option::unwrap_or_default).collect();
    for order in 0..=SLOW {
        remove(&mut torques, order);
    }
    Ok(Recording(torques))
}

/// Takes a part out that comes so often a turn.
fn remove(torques: &mut [f64], order: usize) {
    let count = torques.len() as f64;
    let angle = |index: usize| order as f64 * index as f64 / count * TAU;
    let part = |of: fn(f64) -> f64| torques.iter().enumerate().map(|(i, torque)| torque * of(angle(i))).sum::<f64>();
    let scale = if order == 0 { 1.0 } else { 2.0 } / count;
    let (cosine, sine) = (scale * part(f64::cos), scale * part(f64::sin));
    for (index, torque) in torques.iter_mut().enumerate() {
        *torque -= cosine * angle(index).cos() + sine * angle(index).sin();
    }
}

impl Recording {
    /// The torques, N·m.
    pub fn torques(&self) -> &[f64] {
        &self.0
    }

    /// How much cogging it found: the root of its mean square, N·m.
    pub fn size(&self) -> f64 {
        (self.0.iter().map(|torque| torque * torque).sum::<f64>() / self.0.len() as f64).sqrt()
    }

    /// The table of a [`palpate::device::CoggingMap`]: its step, N·m, and its entries.
    pub fn table(&self) -> (f32, Vec<i8>) {
        let most = self.0.iter().fold(0.0_f64, |most, torque| most.max(torque.abs()));
        let step = (most / 127.0) as f32;
        let entry = |torque: &f64| if step > 0.0 { (torque / f64::from(step)).round() as i8 } else { 0 };
        (step, self.0.iter().map(entry).collect())
    }

    /// The table as Rust source.
    pub fn source(&self, from: &str) -> String {
        let (step, entries) = self.table();
        let mut text = format!("// The cogging of {from}, as it is recorded: the torques that cancel it.\n\n");
        let map = "palpate::device::CoggingMap";
        let _ = writeln!(text, "/// The map.\npub const COGGING: {map} = {map}::new({step:e}, &TABLE);\n");
        let _ = writeln!(text, "static TABLE: [i8; {}] = [", entries.len());
        for line in entries.chunks(20) {
            let numbers: Vec<String> = line.iter().map(ToString::to_string).collect();
            let _ = writeln!(text, "    {},", numbers.join(", "));
        }
        text.push_str("];\n");
        text
    }
}
