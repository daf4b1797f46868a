//! The failures of a device on the bench, each with its detector, the promised time and the loop's reaction. `palpate
//! faults` plants them in a simulated device; the page `docs/reference/faults.md` is written from these tables.

mod bench;
mod chip;
mod clock;
mod hand;
mod host;
mod knob;
mod line;
mod memory;
mod motor;
mod sensor;
mod supply;

pub use bench::{Subject, Touch};
pub use hand::{RELEASES, Release, SINKS, is_let_go};
pub use knob::{KNOB, brakes_with_a_chopper};

use knob::{KnobFailure, KnobFound};
use palpate::servo::{Fault, ResetReason};
use std::fmt::Write as _;

/// How a failure shows in the loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// The motors are off, and this fault is latched.
    Latched(Fault),
    /// The motors are off until the cause has gone and enable was released.
    Hold,
    /// The program does not start: the motors stay off.
    NoStart,
}

/// The loop and the hand in which a failure is planted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// The hand presses 4 mm into a wall, and force is rendered.
    Pressed,
    /// The same with magnetic sensors.
    Magnetic,
    /// The same with a host that must be heard every 50 ms.
    Linked,
    /// The same, but a protected loop and a hand 10 mm over the wall, which then comes.
    Protected,
    /// As [`Self::Protected`], with an unprotected loop.
    Unprotected,
    /// As [`Self::Protected`], with the motor of a joint reversed.
    ReversedMotor(usize),
    /// The same with the encoder of a joint reversed.
    ReversedEncoder(usize),
    /// The same, without a supply reading.
    NoSupply,
    /// Before force: after this reset.
    Reset(ResetReason),
    /// Before force: the stop button must be tried first.
    StopUntested,
    /// Before force: the calibration in flash is damaged.
    Miscalibrated,
    /// Before force: the device is homed by absolute sensors in another pose.
    Misplaced,
    /// Free air, links 10 % heavier than the loop has them.
    Heavier,
    /// As [`Self::Pressed`], with the tables of the capped box.
    Tabled,
    /// Before force: the surface is for another rate.
    OtherRate,
    /// Before force: a bit of memory sticks from the start on.
    NoStart,
}

/// A change of the simulated device before each tick; whether the failure acts in that tick.
pub type Change = fn(&mut Touch<'_>) -> bool;

/// How the row is shown.
#[derive(Clone, Copy, Debug)]
pub enum Shown {
    /// Planted.
    Planted(Setting, Change),
    /// Planted in a knob, whose loop has what an arm's has not: by the rows of [`KNOB`] with this detector.
    OnKnob(&'static str),
    /// Not detected, and why; planted, where the simulated device has the part.
    Gap(&'static str, Option<(Setting, Change)>),
}

/// Why a device does not show a failure; `None` where it does.
pub type Except = fn(&Subject) -> Option<&'static str>;

/// A failure.
#[derive(Clone, Copy, Debug)]
pub struct Failure {
    /// The failing part.
    pub part: &'static str,
    /// The failure.
    pub failure: &'static str,
    /// The detector.
    pub detected_by: &'static str,
    /// Promised time until the motors are off, ms.
    pub within_ms: f64,
    /// The reaction.
    pub reaction: Reaction,
    /// The test that shows it.
    pub test: &'static str,
    /// How it is shown here.
    pub shown: Shown,
    /// Devices that do not detect it.
    pub except: Option<(&'static str, Except)>,
}

const fn row(
    [part, failure, detected_by, test]: [&'static str; 4],
    within_ms: f64,
    reaction: Reaction,
    shown: Shown,
) -> Failure {
    Failure { part, failure, detected_by, within_ms, reaction, test, shown, except: None }
}

const fn gap(
    part: &'static str,
    failure: &'static str,
    reason: &'static str,
    planted: Option<(Setting, Change)>,
) -> Failure {
    row([part, failure, "", ""], f64::INFINITY, Reaction::Hold, Shown::Gap(reason, planted))
}

impl Failure {
    /// The same, but for these devices.
    const fn but(self, words: &'static str, except: Except) -> Self {
        Self { except: Some((words, except)), ..self }
    }

    /// The effect on a device; `None` where it has no such part.
    pub fn plant(&self, subject: &Subject) -> Option<Found> {
        match self.shown {
            Shown::Planted(setting, change) | Shown::Gap(_, Some((setting, change))) => subject.plant(setting, change),
            Shown::OnKnob(_) | Shown::Gap(_, None) => None,
        }
    }

    /// The worst of the rows that show it on a knob.
    pub fn plant_on_knob(&self) -> Option<KnobFound> {
        let Shown::OnKnob(detector) = self.shown else { return None };
        KNOB.iter().filter(|row| row.detected_by == detector).map(KnobFailure::plant).max_by(|one, other| {
            let time = |found: &KnobFound| found.off_ms.unwrap_or(f64::INFINITY);
            time(one).total_cmp(&time(other))
        })
    }

    /// Whether registers of a chip take part, which are a model here; the test reads them in the boards' images.
    pub fn is_in_registers(&self) -> bool {
        self.test.starts_with("test_")
    }

    /// Whether it is one of sensors on a bus, whose readings come in frames; a counter of pulses is always there.
    pub fn is_of_frames(&self) -> bool {
        matches!(self.shown, Shown::Planted(Setting::Magnetic, _)) || self.failure.contains("frame")
    }

    /// Why this device need not detect it.
    pub fn excuse(&self, subject: &Subject) -> Option<&'static str> {
        self.except.and_then(|(_, except)| except(subject))
    }

    /// Whether the device did as the row says.
    pub fn is_as_stated(&self, found: &Found) -> bool {
        self.is_as_stated_of(found.off_ms, found.fault)
    }

    /// The same of a time until the motors were off, ms, and a latched fault.
    pub fn is_as_stated_of(&self, off_ms: Option<f64>, latched: Option<Fault>) -> bool {
        let fault = match self.reaction {
            Reaction::Latched(fault) => Some(fault),
            Reaction::Hold | Reaction::NoStart => None,
        };
        // Two detectors of an angle that cannot be.
        let is_same = latched == fault || (latched, fault) == (Some(Fault::Unreachable), Some(Fault::JointOutOfRange));
        off_ms.is_some_and(|time| time <= self.within_ms) && is_same
    }

    /// Whether the page calls it detected.
    pub const fn is_detected(&self) -> bool {
        !matches!(self.shown, Shown::Gap(..))
    }
}

/// The effect of a planted failure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The longest time for which it acted until the motors were off, ms; `None` if they never were.
    pub off_ms: Option<f64>,
    /// The latched fault, 100 ms later.
    pub fault: Option<Fault>,
    /// Largest motion of the probe until the motors were off, mm.
    pub motion_mm: f64,
    /// Largest speed of the probe until the motors were off, m/s.
    pub speed_m_per_s: f64,
}

/// Every failure, by part.
pub fn table() -> impl Iterator<Item = &'static Failure> {
    [sensor::TABLE, line::TABLE, motor::TABLE, clock::TABLE, supply::TABLE, memory::TABLE, host::TABLE, hand::TABLE]
        .into_iter()
        .flatten()
}

/// The diagnostic coverage: failures of the table that are detected, not weighted by how often they happen.
pub fn coverage() -> String {
    let count = |is: fn(&Failure) -> bool| table().filter(|row| is(row)).count();
    let (all, detected) = (count(|_| true), count(Failure::is_detected));
    let mut text = format!(
        "Diagnostic coverage of the whole table, by count: {detected} of {all} failures detected, {} %, planted in a simulated arm or knob wherever that has the part. In {} the chip's registers take part: there they are a model, and the test `test_…` reads them in the boards' images.",
        (100 * detected + all / 2) / all,
        count(Failure::is_in_registers)
    );
    let mut parts: Vec<&str> = Vec::new();
    for row in table() {
        if !parts.contains(&row.part) {
            parts.push(row.part);
        }
    }
    let each = parts.iter().map(|part| {
        let rows = || table().filter(|row| row.part == *part);
        format!("{part} {} of {}", rows().filter(|row| row.is_detected()).count(), rows().count())
    });
    let _ = write!(text, " By part: {}.", each.collect::<Vec<_>>().join(", "));
    text
}

/// The table as Markdown, and the counted coverage.
pub fn page() -> String {
    let mut page =
        "| part | failure | detected by | within, ms | reaction | shown by |\n|---|---|---|---|---|---|\n".to_owned();
    for row in table() {
        let Failure { part, failure, detected_by, within_ms, reaction, test, shown, except } = row;
        let detected_by = except
            .map_or_else(|| (*detected_by).to_owned(), |(devices, _)| format!("{detected_by}; **not on** {devices}"));
        let _ = match (shown, reaction) {
            (Shown::Gap(reason, _), _) => writeln!(page, "| {part} | {failure} | **not detected**: {reason} | | | |"),
            (_, Reaction::Latched(fault)) => writeln!(
                page,
                "| {part} | {failure} | {detected_by} | {within_ms} | off, [{}: {fault}](../troubleshooting.md#faults) | `{test}` |",
                fault.code()
            ),
            (_, Reaction::Hold) => {
                writeln!(page, "| {part} | {failure} | {detected_by} | {within_ms} | off, hold | `{test}` |")
            }
            (_, Reaction::NoStart) => {
                writeln!(page, "| {part} | {failure} | {detected_by} | {within_ms} | no start | `{test}` |")
            }
        };
    }
    let _ = writeln!(
        page,
        "\n{}\n\nSink in 2 s of an arm that is let go in the middle of its workspace and weighs 10 % more than its device file says:\n",
        coverage()
    );
    let _ = writeln!(page, "| device | mm |\n|---|---|");
    for (device, sink) in SINKS {
        let _ = writeln!(page, "| {device} | {sink} |");
    }
    let _ = writeln!(
        page,
        "\nAn arm that is let go at its deepest press, when it is stopped, and without protection:\n\n| device | m/s | mm | without, m/s |\n|---|---|---|---|"
    );
    for Release { device, stopped, free } in RELEASES {
        let [speed, motion] =
            stopped.map_or(["not stopped".to_owned(), String::new()], |found| found.map(|number| number.to_string()));
        let free = free.map_or_else(|| "another fault first".to_owned(), |free| free.to_string());
        let _ = writeln!(page, "| {device} | {speed} | {motion} | {free} |");
    }
    let _ = writeln!(
        page,
        "\nOf a knob, all planted by `cargo palpate faults --knob`:\n\n| failure | detected by | within, ms | reaction | shown by |\n|---|---|---|---|---|"
    );
    for KnobFailure { failure, detected_by, within_ms, fault, test, .. } in KNOB {
        let _ = writeln!(
            page,
            "| {failure} | {detected_by} | {within_ms} | off, [{}: {fault}](../troubleshooting.md#faults) | `{test}` |",
            fault.code()
        );
    }
    page
}
