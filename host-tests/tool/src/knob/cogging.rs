//! A motor's cogging, from how far its rotor is behind a field that is led round.
//!
//! The field's torque on the rotor is `T sin(lag)`; at the speed of a creep it is what cancels the cogging and the
//! friction. That is as much on the way there as against it on the way back: the mean of both ways is without it.

use crate::commission::device::said;
use crate::commission::{Device, Hands};
use anyhow::bail;
use palpate::device::{Aligned, Commutation, Counts, ElectricalAngle};
use palpate::wire::Reading;
use palpate_sim::knob::{JOG, SEARCH, led_torque};
use std::f64::consts::TAU;
use std::fmt::Write as _;
use thiserror::Error;

/// Entries of a map: eight to the finest cogging of 264 a turn.
pub const ENTRIES: usize = 2_048;
/// Parts that come so seldom a turn are no cogging, which comes with every pole or tooth, but a magnet off its centre.
const SLOW: usize = 4;
/// Parts that come more often than this are the sensor's noise, for the entries could not follow them.
const FAST: usize = ENTRIES / 6;
/// An electrical turn of the field.
const TURN: i32 = 65_536;
/// Start of the measured part in both directions: by then friction has reversed and the rotor follows the field.
const BEGIN: i32 = TURN + TURN / 4 * 3;
/// Travel of the field, 65,536ths of an electrical turn: a whole turn of the motor is measured, and on the way back
/// friction reverses before that part.
pub const LED: i32 = BEGIN + SEARCH.commutation.pole_pairs as i32 * TURN + TURN / 4 * 3;
/// Maximum distance of the rotor from its average position, radians: a sixth of an electrical turn. Beyond, it slips.
const ASTRAY: f64 = TAU / 6.0;

const COMMUTATION: Commutation = SEARCH.commutation;

/// Field and rotor at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// How far the field has been led, 65,536ths of an electrical turn.
    pub field: i32,
    /// The sensor's counts.
    pub counts: i32,
}

/// Why no map comes of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Unbelievable {
    /// A way without samples.
    #[error("the field was not led all the way there and back")]
    Incomplete,
    /// It was held, or the field was too weak.
    #[error("the rotor did not follow its field: let go of the dial; or its cogging is stronger than the field")]
    NotFollowed,
}

/// Torques that cancel the cogging, N·m, evenly spaced from joint angle zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording(Vec<f64>);

/// Sums of the samples near a place, there and back.
#[derive(Clone, Copy, Default)]
struct Place {
    sum: [f64; 2],
    seen: [u32; 2],
}

/// The cogging, from what was seen on the way there, from field 0 to [`LED`], and back. `torque` is the field's on a
/// rotor a quarter turn behind it, N·m.
///
/// # Errors
/// A rotor that did not follow, all the way.
pub fn analyse(ways: [&[Sample]; 2], torque: f64) -> Result<Recording, Unbelievable> {
    let end = BEGIN + i32::from(COMMUTATION.pole_pairs) * TURN;
    let measured = |way: usize| ways[way].iter().copied().filter(move |sample| (BEGIN..end).contains(&sample.field));
    let mut there = measured(0);
    let (Some(first), Some(last)) = (there.next(), there.next_back()) else { return Err(Unbelievable::Incomplete) };
    let reversed = last.counts < first.counts;
    let unaligned = Aligned { at_zero: ElectricalAngle(0), reversed };
    let ahead_of = |sample: &Sample, at_zero: ElectricalAngle| {
        let ElectricalAngle(rotor) = COMMUTATION.rotor(Aligned { at_zero, ..unaligned }, Counts(sample.counts));
        f64::from(ElectricalAngle((sample.field as u16).wrapping_sub(rotor)).radians())
    };
    // How far the field is ahead on average over whole turns there and back; friction and cogging leave that.
    let ElectricalAngle(rotor) = COMMUTATION.rotor(unaligned, Counts(first.counts));
    let near = (first.field as u16).wrapping_sub(rotor);
    let mut mean = 0.0;
    for way in 0..2 {
        let (sum, count) = measured(way)
            .fold((0.0, 0_u32), |(sum, count), sample| (sum + ahead_of(&sample, ElectricalAngle(near)), count + 1));
        if count < ENTRIES as u32 {
            return Err(Unbelievable::Incomplete);
        }
        mean += 0.5 * sum / f64::from(count);
    }
    let at_zero = ElectricalAngle(near.wrapping_add((mean / TAU * f64::from(TURN)).round() as i32 as u16));
    let mut places = vec![Place::default(); ENTRIES];
    for way in 0..2 {
        for sample in measured(way) {
            let lag = ahead_of(&sample, at_zero);
            if lag.abs() > ASTRAY {
                return Err(Unbelievable::NotFollowed);
            }
            let turn = f64::from(sample.counts.rem_euclid(COMMUTATION.counts_per_turn as i32)) + 0.5;
            let place = (turn / f64::from(COMMUTATION.counts_per_turn) * ENTRIES as f64 + 0.5) as usize % ENTRIES;
            places[place].sum[way] += torque * lag.sin() * if reversed { -1.0 } else { 1.0 };
            places[place].seen[way] += 1;
        }
    }
    let went = f64::from((last.counts - first.counts).abs()) / f64::from(COMMUTATION.counts_per_turn);
    // What cogging at both ends leaves of a whole turn: as the alignment has it.
    if (went - 1.0).abs() > 0.07 {
        return Err(Unbelievable::NotFollowed);
    }
    Ok(Recording(smooth(&filled(&places))))
}

/// The mean of both directions at each place; a place that the rotor jumped over takes the value to its left.
fn filled(places: &[Place]) -> Vec<f64> {
    let mean = |place: &Place, way: usize| (place.seen[way] > 0).then(|| place.sum[way] / f64::from(place.seen[way]));
    let mut torques: Vec<Option<f64>> =
        places.iter().map(|place| Some(0.5 * (mean(place, 0)? + mean(place, 1)?))).collect();
    for index in 0..2 * ENTRIES {
        let left = torques[(index + ENTRIES - 1) % ENTRIES];
        let here = &mut torques[index % ENTRIES];
        *here = here.or(left);
    }
    torques.into_iter().map(Option::unwrap_or_default).collect()
}

/// Without what comes too seldom or too often a turn to be cogging.
fn smooth(torques: &[f64]) -> Vec<f64> {
    let count = torques.len();
    // Of a place times an order, modulo a turn.
    let waves: Vec<(f64, f64)> = (0..count).map(|index| (index as f64 / count as f64 * TAU).sin_cos()).collect();
    let mut smoothed = vec![0.0; count];
    for order in SLOW + 1..=FAST {
        let wave = |index: usize| waves[order * index % count];
        let (sine, cosine) = torques.iter().enumerate().fold((0.0, 0.0), |(sine, cosine), (index, torque)| {
            (sine + torque * wave(index).0, cosine + torque * wave(index).1)
        });
        for (index, smoothed) in smoothed.iter_mut().enumerate() {
            *smoothed += 2.0 / count as f64 * (sine * wave(index).0 + cosine * wave(index).1);
        }
    }
    smoothed
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
        let _ =
            writeln!(text, "/// The map.\npub const COGGING: Option<{map}> = Some({map}::new({step:e}, &TABLE));\n");
        let _ = writeln!(text, "static TABLE: [i8; {}] = [", entries.len());
        for line in entries.chunks(20) {
            let numbers: Vec<String> = line.iter().map(ToString::to_string).collect();
            let _ = writeln!(text, "    {},", numbers.join(", "));
        }
        text.push_str("];\n");
        text
    }
}

// The cogging of a knob's motor, recorded over its line while somebody holds button and key.

/// Steps of a fiftieth of a second in which the key may be found: half a minute.
const PATIENCE: u32 = 1_500;

/// Field and rotor according to a reading.
const fn sample(reading: &Reading) -> Sample {
    Sample { field: reading.counts[2], counts: reading.counts[0] }
}

/// Leads the field of a knob that is being set up round its motor, there and back, and makes its map.
///
/// # Errors
/// Key or button let go of, what the device refuses, and a rotor that did not follow: nothing is recorded then.
pub fn record(device: &mut Device, hands: &mut dyn Hands) -> anyhow::Result<Recording> {
    hands.enable(false)?;
    device.wait_for_release()?;
    hands.enable(true)?;
    device.wait_for_enable()?;
    let duty = (JOG.share * 32_767.0) as i16;
    wait_for_key(device, duty)?;
    let begun = sample(&device.last()).field;
    let mut ways = [Vec::new(), Vec::new()];
    for (way, duty) in ways.iter_mut().zip([duty, -duty]) {
        loop {
            let reading = device.step_telling(Some((0, duty)), |reading| {
                let Sample { field, counts } = sample(reading);
                way.push(Sample { field: field.wrapping_sub(begun), counts });
            })?;
            if !reading.live {
                let why = said(&reading);
                // What was refused stands until the key is let go.
                device.step(None)?;
                bail!("the recording ended early{why}; no file is written; start again");
            }
            let gone = sample(&reading).field.wrapping_sub(begun);
            if if duty > 0 { gone >= LED } else { gone <= 0 } {
                break;
            }
        }
    }
    device.step(None)?;
    hands.enable(false)?;
    let [there, back] = &ways;
    Ok(analyse([there, back], f64::from(led_torque(JOG.share)))?)
}

/// Until the key is held.
fn wait_for_key(device: &mut Device, duty: i16) -> anyhow::Result<()> {
    for _ in 0..PATIENCE {
        let reading = device.step(Some((0, duty)))?;
        if reading.live {
            return Ok(());
        }
        if reading.refusal != 0 {
            bail!("the knob does not start{}", said(&reading));
        }
    }
    bail!("the key was not held for half a minute{}", said(&device.last()))
}
