//! Set-points as pulse widths, 2 kHz: the ESCON takes 10 Hz to 5 kHz, and measures worse the faster it is.

use palpate::device::drive::SetPointRange;
use stm32g4xx_hal::gpio::{AF6, Output, PA5, PA8, PA9, PA10};
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::pwm::{ActiveHigh, C1, C2, C3, ComplementaryDisabled, Pwm};
use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::stm32::TIM1;
use stm32g4xx_hal::time::RateExtU32;

use crate::amplifiers::Amplifiers;
use crate::body::SETTINGS;

/// One width.
type Width<C> = Pwm<TIM1, C, ComplementaryDisabled, ActiveHigh, ActiveHigh>;
/// The three outputs.
type Outputs = (Width<C1>, Width<C2>, Width<C3>);
/// The amplifiers on them.
pub type Drives = Amplifiers<Width<C1>, Width<C2>, Width<C3>>;
/// The green light of the board.
pub type Light = PA5<Output>;

const FREQUENCY: u32 = 2_000;
/// As the amplifiers are configured.
pub const RANGE: SetPointRange = SetPointRange::TEN_TO_NINETY;
/// Two periods of a width.
pub const DWELL: u8 = (2.0 * SETTINGS.rate_hz / FREQUENCY as f32) as u8 + 1;

/// The outputs, at no width until the first command or release.
pub fn outputs(timer: TIM1, pins: (PA8<AF6>, PA9<AF6>, PA10<AF6>), rcc: &mut Rcc) -> Outputs {
    let (mut a, mut b, mut c) = timer.pwm(pins, FREQUENCY.Hz(), rcc);
    a.enable();
    b.enable();
    c.enable();
    (a, b, c)
}
