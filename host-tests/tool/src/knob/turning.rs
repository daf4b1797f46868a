//! A hand that turns the knob through every feel, and the measurements during that.

use super::{DIAL_ZERO, KnobServo, KnobState, MODULATION, SEARCH, SETTINGS, report, widths, widths_of};
use crate::firmware::LinkError;
use palpate::device::Counts;
use palpate::device::sensor::Frozen;
use palpate::render::Feel;
use palpate::servo::{Event, Input};
use palpate::wire::{Report, Sensors};
use palpate_sim::plant::{Dial, DialSettings, Fingers, MagneticFault};

/// Ticks from the start until force is there: the rotor is aligned, and force fades in.
const UNTIL_FELT: u32 = SEARCH.ticks() + 1_200;
/// Ticks of a way, there or back.
const WAY: u32 = 4_800;
/// Length of a way, radians: a whole number of detents and of the finest cogging.
const FAR: f64 = std::f64::consts::TAU / 4.0;
/// How far a hand presses into end stops, radians.
const INTO_STOPS: f64 = 0.06;
/// Ticks between two feels, in which the hand moves to the start of the next one.
const BETWEEN: u32 = 800;
/// Ticks after the magnet has slipped.
const AFTER: u32 = 400;
/// By how many counts it slips.
const SLIP: i32 = 900;

/// The tick at which the magnet slips, after a way there and back in each feel.
pub const fn slips_at(feels: &[Feel]) -> u32 {
    UNTIL_FELT + feels.len() as u32 * (BETWEEN + 2 * WAY)
}

/// Ticks of a whole run.
pub const fn ticks(feels: &[Feel]) -> u32 {
    slips_at(feels) + AFTER
}

/// The feel of a table that has no part, in which the cogging is measured and the magnet slips.
pub fn free(feels: &[Feel]) -> Option<u8> {
    feels.iter().position(|feel| *feel == Feel::FREE).map(|index| index as u8)
}

/// One tick as both ends saw it.
#[derive(Clone, Copy, Debug)]
pub struct Turned {
    /// Seconds since the start.
    pub time: f64,
    /// Which feel is chosen.
    pub feel: u8,
    /// Whether the hand is on a way that is measured, and which: 0 there, 1 back.
    pub way: Option<usize>,
    /// The dial's angle from its sensor's zero, radians.
    pub angle: f64,
    /// The torque on the shaft, N·m.
    pub torque: f64,
    /// The largest of the phases' currents, A.
    pub current: f64,
    /// The loop's report.
    pub report: Report,
}

/// Turns a dial through every feel of the loop's table, there and back, and lets its magnet slip at the end. `exchange` passes the sensors
/// to the loop.
///
/// # Errors
/// An error of the link.
pub fn turn(
    settings: DialSettings,
    feels: &[Feel],
    mut exchange: impl FnMut(&Sensors) -> Result<Report, LinkError>,
    mut progress: impl FnMut(u32),
) -> Result<Vec<Turned>, LinkError> {
    let mut dial = Dial::new(settings, f64::from(SETTINGS.rate_hz));
    let ticks = ticks(feels);
    let mut turned = Vec::with_capacity(ticks as usize);
    for tick in 0..ticks {
        let (feel, way) = grip(&mut dial, feels, tick);
        // A sensor that does not answer is one that says what cannot be.
        let counts = [dial.counts().unwrap_or(i32::MIN), i32::from(feel), (dial.supply_volts() * 1e3) as i32];
        let report = exchange(&Sensors { tick, counts, enable: true })?;
        dial.advance(widths_of(&report));
        turned.push(Turned {
            time: dial.time(),
            feel,
            way,
            angle: dial.angle() - DIAL_ZERO,
            torque: dial.torque(),
            current: dial.currents().into_iter().map(f64::abs).fold(0.0, f64::max),
            report,
        });
        progress(tick + 1);
    }
    Ok(turned)
}

/// The hand's action at a tick, the chosen feel, and the current way.
fn grip(dial: &mut Dial, feels: &[Feel], tick: u32) -> (u8, Option<usize>) {
    let Some(felt) = tick.checked_sub(UNTIL_FELT) else { return (0, None) };
    let (index, within) = (felt / (BETWEEN + 2 * WAY), felt % (BETWEEN + 2 * WAY));
    if tick >= slips_at(feels) {
        if tick == slips_at(feels) {
            dial.spoil(Some(MagneticFault::Slipped(SLIP)));
        }
        return (free(feels).unwrap_or(feels.len() as u8 - 1), None);
    }
    let ends = feels.get(index as usize).and_then(|feel| feel.ends);
    let far = ends.map_or(FAR, |ends| f64::from(ends.between_rad[1] - ends.between_rad[0]) + 2.0 * INTO_STOPS);
    let rate = far / f64::from(WAY) * f64::from(SETTINGS.rate_hz);
    let start = DIAL_ZERO - 0.5 * far;
    let (aim, rate, way) = match within.checked_sub(BETWEEN) {
        None => {
            let share = f64::from(within + 1) / f64::from(BETWEEN);
            (dial.angle() + (start - dial.angle()) * share, 0.0, None)
        }
        Some(gone) if gone < WAY => (start + far * f64::from(gone) / f64::from(WAY), rate, Some(0)),
        Some(gone) => (start + far * f64::from(2 * WAY - gone) / f64::from(WAY), -rate, Some(1)),
    };
    dial.hold(Fingers { rate, ..Fingers::clamp(aim) });
    (index as u8, way)
}

/// The knob's loop compiled for the host, as the firmware has it.
#[derive(Clone, Debug)]
pub struct HostEnd {
    servo: KnobServo,
    state: KnobState,
    frozen: Frozen,
}

impl HostEnd {
    /// A loop before its first tick.
    pub fn new(servo: KnobServo) -> Self {
        let state = servo.start();
        Self { servo, state, frozen: Frozen::AS5047P }
    }

    /// One tick: sensors in, report out, as the board's loop does it.
    pub fn exchange(&mut self, sensors: &Sensors) -> Report {
        let [counts, feel, supply] = sensors.counts;
        self.servo.note(&mut self.state, Event::Chosen { index: feel as u8 });
        self.servo.note(&mut self.state, Event::Supply { millivolts: supply as u32 });
        let input = if self.frozen.is_frozen(counts as u32) {
            Input::Frozen
        } else {
            Input::Sensors { counts: [Counts(counts)], enable: sensors.enable }
        };
        let _ = self.servo.tick(&mut self.state, input);
        report(&self.state, widths(&self.servo, &self.state, &MODULATION), 0)
    }
}

/// Angles a third of a degree apart, radians, and the mean torque there and back, N·m; `None` where a way has none.
fn by_angle(turned: &[Turned], feel: u8) -> impl Iterator<Item = (f64, [Option<f64>; 2])> {
    const STEP: f64 = std::f64::consts::PI / 540.0;
    let mut sums = std::collections::BTreeMap::<i64, [(f64, u32); 2]>::new();
    for sample in turned.iter().filter(|sample| sample.feel == feel) {
        let Some(way) = sample.way else { continue };
        let (sum, count) = &mut sums.entry((sample.angle / STEP).round() as i64).or_default()[way];
        *sum += sample.torque;
        *count += 1;
    }
    let mean = |(sum, count): (f64, u32)| (count > 0).then(|| sum / f64::from(count));
    sums.into_iter().map(move |(place, ways)| (place as f64 * STEP, ways.map(mean)))
}

/// The torque over the angle in one feel, as the mean of there and back, N·m, which is without friction and damping.
pub fn curve(turned: &[Turned], feel: u8) -> Vec<(f64, f64)> {
    by_angle(turned, feel).filter_map(|(angle, [there, back])| Some((angle, 0.5 * (there? + back?)))).collect()
}

/// The torque over the angle in one feel on one way, 0 there and 1 back.
pub fn way(turned: &[Turned], feel: u8, way: usize) -> Vec<(f64, f64)> {
    by_angle(turned, feel).filter_map(|(angle, torques)| Some((angle, (*torques.get(way)?)?))).collect()
}

/// Maximum relative error of the detents' peak torques on the ways. A peak is the maximum torque within three tenths of
/// a pitch, on either side of each complete detent.
pub fn worst_detent(curve: &[(f64, f64)], pitch: f64, torque: f64) -> f64 {
    let whole = (0.5 * FAR / pitch) as i32 - 1;
    let peak = |detent: i32, side: f64| {
        let middle = (f64::from(detent) + 0.25 * side) * pitch;
        let near = curve.iter().filter(|(angle, _)| (angle - middle).abs() < 0.1 * pitch);
        near.map(|(_, felt)| -side * felt).fold(f64::NEG_INFINITY, f64::max)
    };
    let sides = (-whole..=whole).flat_map(|detent| [(detent, -1.0), (detent, 1.0)]);
    sides.map(|(detent, side)| (peak(detent, side) / torque - 1.0).abs()).fold(0.0, f64::max)
}

/// The root mean square and the largest torque of a curve, N·m.
pub fn size(curve: &[(f64, f64)]) -> [f64; 2] {
    let squares: f64 = curve.iter().map(|(_, torque)| torque * torque).sum();
    let most = curve.iter().map(|(_, torque)| torque.abs()).fold(0.0, f64::max);
    [(squares / curve.len().max(1) as f64).sqrt(), most]
}
