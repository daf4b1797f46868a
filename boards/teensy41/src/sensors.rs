//! Three AS5047P on one SPI bus, each with its own select line.

use embedded_hal_bus::spi::{AtomicDevice, NoDelay};
use embedded_hal_bus::util::AtomicCell;
use palpate::device::Counts;
use palpate::device::sensor::{AmsAngle, AmsChip, TurnCount};
use teensy4_bsp::board::Lpspi;
use teensy4_bsp::hal::gpio::Output;

type Sensor = AmsAngle<AtomicDevice<'static, Lpspi, Output, NoDelay>>;

/// A quarter turn between two ticks is no hand's.
const GREATEST_STEP: i32 = 4_096;

/// The three sensors.
pub struct Sensors {
    sensors: [Sensor; 3],
    counts: [TurnCount; 3],
    zero: [i32; 3],
}

/// A sensor failed: absent, damaged or jumped.
pub struct Failed;

impl Sensors {
    /// The sensors on their bus.
    ///
    /// # Errors
    /// A sensor that is not there, not ready or does not see its magnet.
    pub fn start(bus: &'static AtomicCell<Lpspi>, [a, b, c]: [Output; 3]) -> Result<Self, Failed> {
        let mut sensors = [sensor(bus, a)?, sensor(bus, b)?, sensor(bus, c)?];
        for sensor in &mut sensors {
            sensor.start().map_err(|_| Failed)?;
        }
        Ok(Self { sensors, counts: [TurnCount::new(GREATEST_STEP); 3], zero: [0; 3] })
    }

    /// Here is zero.
    ///
    /// # Errors
    /// A sensor that failed.
    pub fn zero(&mut self) -> Result<(), Failed> {
        self.zero = [0; 3];
        self.zero = self.read()?.map(|Counts(count)| count);
        Ok(())
    }

    /// The counts now: two frames a sensor, about 20 µs in all.
    ///
    /// # Errors
    /// A sensor that failed.
    #[inline]
    pub fn read(&mut self) -> Result<[Counts; 3], Failed> {
        let mut counts = [Counts(0); 3];
        let sensors = self.sensors.iter_mut().zip(&mut self.counts).zip(self.zero);
        for (count, ((sensor, turns), zero)) in counts.iter_mut().zip(sensors) {
            let angle = sensor.read_fresh().map_err(|_| Failed)?;
            let Counts(total) = turns.count(u32::from(angle)).map_err(|_| Failed)?;
            *count = Counts(total.wrapping_sub(zero));
        }
        Ok(counts)
    }
}

fn sensor(bus: &'static AtomicCell<Lpspi>, select: Output) -> Result<Sensor, Failed> {
    let device = AtomicDevice::new_no_delay(bus, select).map_err(|_| Failed)?;
    Ok(AmsAngle::new(device, AmsChip::As5047p))
}
