//! Three AS5047P on one SPI bus, each with its own select line.

use embedded_hal_bus::spi::{AtomicDevice, NoDelay};
use embedded_hal_bus::util::AtomicCell;
use palpate::device::Counts;
use palpate::device::sensor::{AmsAngle, AmsChip, TurnCount};
use rp235x_hal::gpio::bank0::{Gpio2, Gpio3, Gpio4, Gpio5, Gpio6, Gpio7};
use rp235x_hal::gpio::{FunctionSio, FunctionSpi, Pin, PullDown, SioOutput};
use rp235x_hal::pac::SPI0;
use rp235x_hal::spi::{Enabled, Spi};

type Line<P> = Pin<P, FunctionSpi, PullDown>;
/// The bus: data out, data in, clock.
pub type Bus = Spi<Enabled, SPI0, (Line<Gpio3>, Line<Gpio4>, Line<Gpio2>), 8>;
type Select<P> = Pin<P, FunctionSio<SioOutput>, PullDown>;
type Sensor<P> = AmsAngle<AtomicDevice<'static, Bus, Select<P>, NoDelay>>;

/// A quarter turn between two ticks is no hand's.
const GREATEST_STEP: i32 = 4_096;

/// The three sensors.
pub struct Sensors {
    sensors: (Sensor<Gpio5>, Sensor<Gpio6>, Sensor<Gpio7>),
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
    pub fn start(
        bus: &'static AtomicCell<Bus>,
        a: Select<Gpio5>,
        b: Select<Gpio6>,
        c: Select<Gpio7>,
    ) -> Result<Self, Failed> {
        let mut sensors = (sensor(bus, a)?, sensor(bus, b)?, sensor(bus, c)?);
        sensors.0.start().map_err(|_| Failed)?;
        sensors.1.start().map_err(|_| Failed)?;
        sensors.2.start().map_err(|_| Failed)?;
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
        let (a, b, c) = &mut self.sensors;
        let angles = [
            a.read_fresh().map_err(|_| Failed)?,
            b.read_fresh().map_err(|_| Failed)?,
            c.read_fresh().map_err(|_| Failed)?,
        ];
        let mut counts = [Counts(0); 3];
        for (((count, turns), angle), zero) in counts.iter_mut().zip(&mut self.counts).zip(angles).zip(self.zero) {
            let Counts(total) = turns.count(u32::from(angle)).map_err(|_| Failed)?;
            *count = Counts(total.wrapping_sub(zero));
        }
        Ok(counts)
    }
}

fn sensor<P>(bus: &'static AtomicCell<Bus>, select: Select<P>) -> Result<Sensor<P>, Failed>
where
    P: rp235x_hal::gpio::PinId,
    Select<P>: embedded_hal::digital::OutputPin,
{
    let device = AtomicDevice::new_no_delay(bus, select).map_err(|_| Failed)?;
    Ok(AmsAngle::new(device, AmsChip::As5047p))
}
