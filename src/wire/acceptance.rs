//! Messages between a host and a device in acceptance, motors disabled. The protocol and the expected figures are in
//! `docs/howto/acceptance.md` of the repository.

use serde::{Deserialize, Serialize};

/// To the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Request {
    /// Identify yourself: the device answers with a [`Finding::Identity`].
    Identity,
    /// Runs the script, each lap for a maximum number of ticks: the device answers with a [`Finding::Line`] for each
    /// line of it, then [`Finding::Done`].
    Script {
        /// Ticks.
        most: u32,
    },
    /// Whether it tells of its own ticks, ten times a second: a [`Finding::Ticks`] each time.
    Watch(bool),
    /// Fails on purpose: then the device answers with its identity after the reset, with the reason.
    Fail(Failure),
}

/// How a device fails on purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Failure {
    /// Main hangs, and the watchdog is no longer fed.
    Hang,
    /// It panics.
    Panic,
    /// Executes an invalid instruction.
    Exception,
}

/// From the device.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Finding {
    /// The device's identity.
    Identity(Identity),
    /// A line's result so far.
    Line(Line),
    /// The script is over.
    Done,
    /// Of its own ticks.
    Ticks(Ticks),
}

/// The unit in which a tick of the script is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Counted {
    /// Cycles of the core.
    #[default]
    Cycles,
    /// Instructions: an emulator has no cycles.
    Instructions,
}

/// The identity of a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Identity {
    /// The core, as its CPUID register names it.
    pub core: u32,
    /// Counts of the board's counter in a second, Hz.
    pub clock: u32,
    /// The unit in which a tick of the script is measured.
    pub counted: Counted,
    /// Servo rate, Hz.
    pub rate: f32,
    /// [`crate::servo::ResetReason`] as its number.
    pub reset: u8,
    /// CRC-32 of the body's tables as they lie in the device's memory.
    pub table: u32,
    /// The same as they were baked; 0 where they carry none.
    pub baked: u32,
    /// The chip's option bytes; 0 of a chip without.
    pub options: u32,
}

/// A line's result so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Line {
    /// Which line this is, from 0.
    pub number: u32,
    /// Ticks of its lap so far.
    pub ticks: u32,
    /// A hash of every bit of the state after each of them.
    pub digest: u32,
    /// Boundary modes visited, a bit each.
    pub modes: u32,
    /// Phases visited, a bit each.
    pub phases: u32,
    /// Faults seen, a bit each.
    pub faults: u32,
    /// Ticks in contact.
    pub touching: u32,
    /// The longest tick of the lap so far, counts.
    pub longest: u32,
}

/// The device's own ticks since the frame before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ticks {
    /// Which frame this is, counted from 0: a gap is frames that were lost on the line.
    pub number: u32,
    /// Ticks since the reset.
    pub ticks: u32,
    /// The counter at the last tick's interrupt, which wraps at 32 bits.
    pub began: u32,
    /// The shortest period between two interrupts, counts.
    pub shortest: u32,
    /// The longest.
    pub longest: u32,
    /// The longest that a tick took, from its interrupt to its end, counts.
    pub took: u32,
    /// Ticks since the reset that took longer than their period.
    pub overruns: u32,
    /// Bad sensor frames since the reset: missing, damaged, implausible, with a bad magnet, frozen.
    pub bad: [u32; 5],
    /// The most bad frames in a row since the reset.
    pub in_a_row: u32,
    /// The inputs of the operator's panel ([`panel`]).
    pub panel: u8,
    /// The motors' supply, mV; 0 where it is not measured.
    pub supply: u32,
    /// The highest automatic gain of each magnetic sensor since the reset, 255 in a weak field; 0 of one without.
    pub gains: [u8; 3],
}

/// The bits of [`Ticks::panel`].
pub mod panel {
    /// Force is requested.
    pub const ENABLE: u8 = 1 << 0;
    /// The stop input is pressed, or its wire is broken.
    pub const STOP: u8 = 1 << 1;
    /// Every amplifier reports that it is ready.
    pub const READY: u8 = 1 << 2;
}
