//! The drives of all joints.

use crate::NotObeyed;
use crate::interlock::ticks;
use embedded_hal::digital::OutputPin;
use palpate::device::Duty;
use palpate::device::drive::{Drive, Field};

/// The drives of all joints, as one.
pub trait Drives<const JOINTS: usize> {
    /// The field of each motor for the duties that follow; those without phases take no notice.
    fn aim(&mut self, _: [Field; JOINTS]) {}

    /// Gives each its duty, and enables it.
    ///
    /// # Errors
    /// A drive that failed. The others have been set.
    fn apply(&mut self, duties: [Duty; JOINTS]) -> Result<(), NotObeyed>;

    /// Disables all. Tries each, whatever fails.
    ///
    /// # Errors
    /// A drive that failed.
    fn release(&mut self) -> Result<(), NotObeyed>;

    /// Whether the pin of a line that enables a drive reads as on; false where it cannot be read.
    #[inline]
    fn reads_enabled(&self) -> bool {
        false
    }
}

fn obeyed(all: bool) -> Result<(), NotObeyed> {
    if all { Ok(()) } else { Err(NotObeyed) }
}

impl<D: Drive, const JOINTS: usize> Drives<JOINTS> for [D; JOINTS] {
    #[inline]
    fn aim(&mut self, fields: [Field; JOINTS]) {
        for (drive, field) in self.iter_mut().zip(fields) {
            drive.aim(field);
        }
    }

    #[inline]
    fn apply(&mut self, duties: [Duty; JOINTS]) -> Result<(), NotObeyed> {
        let mut all = true;
        for (drive, duty) in self.iter_mut().zip(duties) {
            all &= drive.apply(duty).is_ok();
        }
        obeyed(all)
    }

    #[inline]
    fn release(&mut self) -> Result<(), NotObeyed> {
        let mut all = true;
        for drive in self {
            all &= drive.release().is_ok();
        }
        obeyed(all)
    }
}

/// Three whose channels are types of their own.
impl<A: Drive, B: Drive, C: Drive> Drives<3> for (A, B, C) {
    #[inline]
    fn aim(&mut self, [a, b, c]: [Field; 3]) {
        self.0.aim(a);
        self.1.aim(b);
        self.2.aim(c);
    }

    #[inline]
    fn apply(&mut self, [a, b, c]: [Duty; 3]) -> Result<(), NotObeyed> {
        obeyed(self.0.apply(a).is_ok() & self.1.apply(b).is_ok() & self.2.apply(c).is_ok())
    }

    #[inline]
    fn release(&mut self) -> Result<(), NotObeyed> {
        obeyed(self.0.release().is_ok() & self.1.release().is_ok() & self.2.release().is_ok())
    }
}

/// Drives that one pin enables, high.
#[derive(Debug)]
pub struct Switched<D, E> {
    drives: D,
    enable: E,
}

impl<D, E> Switched<D, E> {
    /// These drives behind this pin, which is low.
    pub const fn new(drives: D, enable: E) -> Self {
        Self { drives, enable }
    }
}

impl<D: Drives<JOINTS>, E: OutputPin, const JOINTS: usize> Drives<JOINTS> for Switched<D, E> {
    #[inline]
    fn aim(&mut self, fields: [Field; JOINTS]) {
        self.drives.aim(fields);
    }

    #[inline]
    fn apply(&mut self, duties: [Duty; JOINTS]) -> Result<(), NotObeyed> {
        self.drives.apply(duties)?;
        // Only now that the duties are there.
        obeyed(self.enable.set_high().is_ok())
    }

    #[inline]
    fn release(&mut self) -> Result<(), NotObeyed> {
        let off = self.enable.set_low().is_ok();
        obeyed(self.drives.release().is_ok() & off)
    }
}

/// Seconds for which a break may go unexplained, two commands at least: stop may be pressed between looking at it and
/// driving.
const UNEXPLAINED_S: f32 = 0.000_5;

/// Drives whose outputs an input of the hardware ends, without the program. A break that is over is taken back; one that
/// lasts enables nothing, and is soon a failure.
#[derive(Debug)]
pub struct Breakable<D, F = fn() -> bool> {
    drives: D,
    is_broken: F,
    /// Commands in a row that found them off.
    broken: u32,
    max_broken: u32,
}

impl<D, F> Breakable<D, F> {
    /// These drives, in a loop of this rate. `is_broken` is whether their outputs are off, and stay so although it tried
    /// to take the break back.
    pub const fn new(drives: D, is_broken: F, rate_hz: u32) -> Self {
        Self { drives, is_broken, broken: 0, max_broken: ticks(UNEXPLAINED_S, rate_hz as f32) }
    }
}

impl<D: Drives<JOINTS>, F: Fn() -> bool, const JOINTS: usize> Drives<JOINTS> for Breakable<D, F> {
    #[inline]
    fn aim(&mut self, fields: [Field; JOINTS]) {
        self.drives.aim(fields);
    }

    #[inline]
    fn apply(&mut self, duties: [Duty; JOINTS]) -> Result<(), NotObeyed> {
        if (self.is_broken)() {
            self.broken = self.broken.saturating_add(1);
            self.drives.release()?;
            return obeyed(self.broken <= self.max_broken);
        }
        self.broken = 0;
        self.drives.apply(duties)
    }

    #[inline]
    fn release(&mut self) -> Result<(), NotObeyed> {
        self.drives.release()
    }

    #[inline]
    fn reads_enabled(&self) -> bool {
        self.drives.reads_enabled()
    }
}

/// Drives whose enable lines are read back at their pins, past whatever was written to them.
#[derive(Debug)]
pub struct ReadBack<D, F = fn() -> bool> {
    drives: D,
    reads_enabled: F,
}

impl<D, F> ReadBack<D, F> {
    /// These drives. `reads_enabled` is whether any of their enable pins reads as on.
    pub const fn new(drives: D, reads_enabled: F) -> Self {
        Self { drives, reads_enabled }
    }
}

impl<D: Drives<JOINTS>, F: Fn() -> bool, const JOINTS: usize> Drives<JOINTS> for ReadBack<D, F> {
    #[inline]
    fn aim(&mut self, fields: [Field; JOINTS]) {
        self.drives.aim(fields);
    }

    #[inline]
    fn apply(&mut self, duties: [Duty; JOINTS]) -> Result<(), NotObeyed> {
        self.drives.apply(duties)
    }

    #[inline]
    fn release(&mut self) -> Result<(), NotObeyed> {
        self.drives.release()
    }

    #[inline]
    fn reads_enabled(&self) -> bool {
        (self.reads_enabled)()
    }
}
