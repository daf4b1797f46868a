//! AS5047P angle sensors on one SPI bus, each with its own select line.

use super::{BadFrame, SelectTiming, Selected, Sensors};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiBus;
use palpate::device::Counts;
use palpate::device::sensor::{AmsAngle, AmsChip, Frozen, SensorError, TurnCount};

/// The select line's times (AS5047P data sheet, "SPI timing": `tCSn` and `tL` 350 ns; `tH` half a clock, which is 500
/// ns at the slowest clock one would choose, 1 MHz).
pub const SELECT: SelectTiming = SelectTiming { high: 350, set_up: 350, hold: 500 };
/// Milliseconds after power-on before it answers (data sheet, "system parameters").
const POWER_UP_MILLISECONDS: u32 = 10;
/// How often it is tried to start, and how many milliseconds apart: a supply that comes up slowly.
const TRIES: u32 = 20;
const BETWEEN_TRIES_MILLISECONDS: u32 = 5;

/// Seconds for the two frames of a reading at 8 MHz: 16 bits, the select line's times, and the looks at a counter for them.
const READING_S: f32 = 8e-6;
/// Seconds after which equal readings are a frozen sensor: 1,000 at 4 kHz.
const FROZEN_S: f32 = 0.25;

/// Ticks from one reading of a sensor to its next: one, where the frames of all take at most a quarter of a tick, which
/// three do up to 10.4 kHz. Above it a tick reads one of them.
///
/// # Panics
/// At compile time, where one takes more than half of a tick.
pub const fn ticks_per_round(joints: u32, rate_hz: f32) -> u32 {
    assert!(READING_S * rate_hz <= 0.5, "the angle sensors' bus is too slow for this servo rate");
    if READING_S * joints as f32 * rate_hz <= 0.25 { 1 } else { joints }
}

/// The sensors, on a bus in mode 1 of at most 10 MHz.
///
/// Where a tick reads one of them, each count is led to the last reading in as many ticks as a round has: all counts are
/// those of the same moment, a round less a tick ago, and no joint seems to stand and to jump in turn.
#[derive(Debug)]
pub struct Angles<B, P, D, const JOINTS: usize> {
    bus: B,
    selects: [P; JOINTS],
    delay: D,
    turns: [TurnCount; JOINTS],
    frozen: [Frozen; JOINTS],
    gains: [u8; JOINTS],
    /// Whose error flags have to be cleared first.
    unwell: [bool; JOINTS],
    round: Round<JOINTS>,
}

/// Readings that take turns.
#[derive(Debug)]
struct Round<const JOINTS: usize> {
    /// Ticks that it takes.
    ticks: i32,
    /// Whether each sensor was read once.
    is_placed: bool,
    /// Whose turn it is.
    turn: usize,
    /// The last two readings of each, and the ticks since the last.
    from: [Counts; JOINTS],
    to: [Counts; JOINTS],
    since: [i32; JOINTS],
}

impl<B: SpiBus, P: OutputPin, D: DelayNs, const JOINTS: usize> Angles<B, P, D, JOINTS> {
    /// The sensors, each with the maximum step between two readings, counts ([`super::max_step`]). Their select
    /// lines are high. Nothing is sent yet.
    pub fn new(bus: B, selects: [P; JOINTS], delay: D, greatest_steps: [i32; JOINTS]) -> Self {
        Self {
            bus,
            selects,
            delay,
            turns: greatest_steps.map(TurnCount::new),
            frozen: [Frozen::AS5047P; JOINTS],
            gains: [0; JOINTS],
            unwell: [true; JOINTS],
            round: Round {
                ticks: 1,
                is_placed: false,
                turn: 0,
                from: [Counts(0); JOINTS],
                to: [Counts(0); JOINTS],
                since: [0; JOINTS],
            },
        }
    }

    /// The same in a loop of this rate, Hz, with maximum steps over [`ticks_per_round`].
    #[must_use]
    pub fn at(mut self, rate_hz: f32) -> Self {
        let ticks = ticks_per_round(JOINTS as u32, rate_hz);
        // The casts saturate.
        self.round.ticks = ticks as i32;
        self.frozen = [Frozen::after((FROZEN_S * rate_hz / ticks as f32) as u32); JOINTS];
        self
    }

    /// Waits until they have powered up, and starts each, repeatedly for a tenth of a second.
    ///
    /// # Errors
    /// Why one does not start. [`Sensors::read`] goes on trying, and says so in every tick: let the loop run, and it
    /// names the fault.
    pub fn start(&mut self) -> Result<(), BadFrame> {
        self.delay.delay_ms(POWER_UP_MILLISECONDS);
        let mut started = self.start_all();
        for _ in 1..TRIES {
            if started.is_ok() {
                break;
            }
            self.delay.delay_ms(BETWEEN_TRIES_MILLISECONDS);
            started = self.start_all();
        }
        started
    }

    /// Reads each, where readings take turns: just before the first tick, which is too short for it. A hand that moves
    /// farther until then than it may in a round is a jump.
    ///
    /// # Errors
    /// The first bad frame; the first tick tries again.
    pub fn place(&mut self) -> Result<(), BadFrame> {
        for joint in 0..JOINTS {
            let count = self.read_one(joint)?;
            (self.round.from[joint], self.round.to[joint], self.round.since[joint]) = (count, count, 0);
        }
        self.round.is_placed = true;
        Ok(())
    }

    /// Reads the one whose turn it is; after an error it is its turn again.
    fn take_turn(&mut self) -> Result<[Counts; JOINTS], BadFrame> {
        if !self.round.is_placed {
            return self.place().map(|()| self.round.to);
        }
        let joint = self.round.turn;
        let count = self.read_one(joint)?;
        let round = &mut self.round;
        (round.from[joint], round.to[joint], round.since[joint]) = (round.to[joint], count, 0);
        round.turn = if joint + 1 < JOINTS { joint + 1 } else { 0 };
        let mut counts = round.to;
        for ((count, from), since) in counts.iter_mut().zip(round.from).zip(&mut round.since) {
            *since = round.ticks.min(*since + 1);
            // A step is at most that of the fastest hand.
            *count = Counts(from.0.wrapping_add(count.0.wrapping_sub(from.0) * *since / round.ticks));
        }
        Ok(counts)
    }

    #[inline]
    fn read_one(&mut self, joint: usize) -> Result<Counts, BadFrame> {
        self.start_one(joint)?;
        match self.sensor(joint).read() {
            Ok(reading) => {
                self.gains[joint] = reading.gain;
                let angle = u32::from(reading.angle);
                if self.frozen[joint].is_frozen(angle) {
                    return Err(BadFrame::Frozen);
                }
                self.turns[joint].count(angle).map_err(|_| BadFrame::Jumped)
            }
            Err(error) => {
                // Its flag would stand in every later frame.
                self.unwell[joint] = true;
                Err(bad(&error))
            }
        }
    }

    fn start_all(&mut self) -> Result<(), BadFrame> {
        (0..JOINTS).try_for_each(|joint| self.start_one(joint))
    }

    #[inline]
    fn start_one(&mut self, joint: usize) -> Result<(), BadFrame> {
        if self.unwell[joint] {
            self.sensor(joint).start().map_err(|error| bad(&error))?;
            self.unwell[joint] = false;
        }
        Ok(())
    }

    fn sensor(&mut self, joint: usize) -> AmsAngle<Selected<'_, B, P, D>> {
        let Self { bus, selects, delay, .. } = self;
        AmsAngle::new(Selected { bus, select: &mut selects[joint], delay, timing: SELECT }, AmsChip::As5047p)
    }
}

impl<B: SpiBus, P: OutputPin, D: DelayNs, const JOINTS: usize> Sensors<JOINTS> for Angles<B, P, D, JOINTS> {
    /// Two frames a sensor, some 3 µs each at 8 MHz; three more for one that reported an error in the tick before.
    #[inline]
    fn read(&mut self) -> Result<[Counts; JOINTS], BadFrame> {
        if self.round.ticks > 1 {
            return self.take_turn();
        }
        self.start_all()?;
        let mut counts = [Counts(0); JOINTS];
        for (joint, count) in counts.iter_mut().enumerate() {
            *count = self.read_one(joint)?;
        }
        Ok(counts)
    }

    #[inline]
    fn gains(&self) -> [u8; JOINTS] {
        self.gains
    }
}

fn bad<E>(error: &SensorError<E>) -> BadFrame {
    match error {
        SensorError::Absent | SensorError::Bus(_) => BadFrame::Absent,
        SensorError::Damaged | SensorError::Refused | SensorError::TrackLost => BadFrame::Damaged,
        SensorError::Magnet => BadFrame::Magnet,
    }
}
