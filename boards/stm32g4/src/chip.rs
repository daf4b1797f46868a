//! Clocks, power and reset, as the reference manual (RM0440) wants them.

use palpate_bench::ResetFlags;
use palpate_cortex::MemoCell;
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::pwr::VoltageScale;
use stm32g4xx_hal::rcc::{Config, PllConfig, PllMDiv, PllNMul, PllRDiv, PllSrc, Rcc};
use stm32g4xx_hal::stm32::{FLASH, PWR, RCC};

/// 16 MHz / 4 · 85 / 2: the most that the chip takes.
pub const CLOCK: u32 = 170_000_000;

/// What was left to be known after the next reset. Used, whatever the compiler thinks that it knows of its first value.
#[unsafe(link_section = ".uninit.MEMO")]
#[used]
pub static MEMO: MemoCell = MemoCell::new();

/// Sets the clocks, and gives why the chip was reset.
pub fn start(rcc: RCC, power: PWR, flash: &FLASH) -> (Rcc, ResetFlags) {
    // The power interface answers only once it has its clock, which the HAL does not give it: without it, the boost
    // that 170 MHz need would not be set.
    rcc.apb1enr1().modify(|_, w| w.pwren().set_bit());
    // Read back, for the clock takes two cycles.
    let _ = rcc.apb1enr1().read();
    // The pull-downs by which a dead battery asks a USB-C supply for power hang on PB6 and PB4; with them, what is on
    // PA9 and PA10 pulls at an encoder's line.
    power.cr3().modify(|_, w| w.ucpd1_dbdis().set_bit());
    // Instructions and tables that stay in flash are cached, and fetched ahead.
    flash.acr().modify(|_, w| w.icen().set_bit().dcen().set_bit().prften().set_bit());

    let power = power.constrain().vos(VoltageScale::Range1 { enable_boost: true }).freeze();
    let pll = PllConfig {
        mux: PllSrc::HSI,
        m: PllMDiv::DIV_4,
        n: PllNMul::MUL_85,
        r: Some(PllRDiv::DIV_2),
        ..PllConfig::default()
    };
    let mut rcc = rcc.freeze(Config::pll().pll_cfg(pll), power);
    let flags = rcc.get_reset_reason();
    rcc.clear_reset_reason();
    let flags = ResetFlags {
        // Raised at power-on too.
        power: flags.brown_out,
        watchdog: flags.independent_watchdog || flags.window_watchdog,
        software: flags.software,
        pin: flags.reset_pin,
        ..ResetFlags::default()
    };
    (rcc, flags)
}
