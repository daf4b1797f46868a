//! Set-points as voltages of the chip's own converters: 0 V for no current, 3.3 V for full. A chip without power, and a
//! wire that is off, ask for none. PA5 is a set-point here: there is no light.

use core::convert::Infallible;
use embedded_hal::delay::DelayNs;
use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use palpate::device::drive::{NoPin, SetPointRange};
use stm32g4xx_hal::dac::{Dac1Ch1, Dac1Ch2, Dac2Ch1, DacExt, DacOut, Enabled, M_EXT_PIN};
use stm32g4xx_hal::gpio::{Analog, PA4, PA5, PA6};
use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::stm32::{DAC1, DAC2};

use crate::amplifiers::Amplifiers;

/// A converter of 12 bits in the place of a pulse width.
pub struct Voltage<C>(C);

impl<C> ErrorType for Voltage<C> {
    type Error = Infallible;
}

impl<C: DacOut<u16>> SetDutyCycle for Voltage<C> {
    fn max_duty_cycle(&self) -> u16 {
        4_095
    }

    #[inline]
    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.0.set_value(duty.min(4_095));
        Ok(())
    }
}

type First = Voltage<Dac1Ch1<M_EXT_PIN, Enabled>>;
type Second = Voltage<Dac1Ch2<M_EXT_PIN, Enabled>>;
type Third = Voltage<Dac2Ch1<M_EXT_PIN, Enabled>>;
/// The amplifiers on them.
pub type Drives = Amplifiers<First, Second, Third>;
/// There is none.
pub type Light = NoPin;

/// As the amplifiers are configured.
pub const RANGE: SetPointRange = SetPointRange::WHOLE;
/// A voltage is there within microseconds: one tick at no current is enough.
pub const DWELL: u8 = 1;

/// They have no break: a core that locks up or is halted leaves the voltages, until the watchdog resets the chip.
pub fn guarded(amplifiers: Drives) -> Drives {
    amplifiers
}

/// The outputs, at no voltage.
pub fn outputs(
    (first, second): (DAC1, DAC2),
    pins: (PA4<Analog>, PA5<Analog>, PA6<Analog>),
    delay: &mut impl DelayNs,
    rcc: &mut Rcc,
) -> (First, Second, Third) {
    let (a, b) = first.constrain((pins.0, pins.1), rcc);
    let c = second.constrain(pins.2, rcc);
    let a = a.calibrate_buffer(delay).enable(rcc);
    let b = b.calibrate_buffer(delay).enable(rcc);
    let c = c.calibrate_buffer(delay).enable(rcc);
    (Voltage(a), Voltage(b), Voltage(c))
}
