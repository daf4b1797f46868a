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

/// The sensors, on a bus in mode 1 of at most 10 MHz.
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
        }
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

    fn start_all(&mut self) -> Result<(), BadFrame> {
        for joint in 0..JOINTS {
            if self.unwell[joint] {
                self.sensor(joint).start().map_err(|error| bad(&error))?;
                self.unwell[joint] = false;
            }
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
        self.start_all()?;
        let mut counts = [Counts(0); JOINTS];
        for (joint, count) in counts.iter_mut().enumerate() {
            match self.sensor(joint).read() {
                Ok(reading) => {
                    self.gains[joint] = reading.gain;
                    let angle = u32::from(reading.angle);
                    if self.frozen[joint].is_frozen(angle) {
                        return Err(BadFrame::Frozen);
                    }
                    *count = self.turns[joint].count(angle).map_err(|_| BadFrame::Jumped)?;
                }
                Err(error) => {
                    // Its flag would stand in every later frame.
                    self.unwell[joint] = true;
                    return Err(bad(&error));
                }
            }
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
