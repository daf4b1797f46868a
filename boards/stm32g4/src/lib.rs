//! The chip of a Nucleo-G474RE, as both of its programs use it: the arm (`main.rs`) and the knob (`knob/main.rs`).

#![no_std]

pub mod flash;
mod supply;
mod ticks;

pub use supply::{Converters, Volts, converters};
pub use ticks::{Clock, Slow, Ticks};

use palpate::servo::ResetReason;
use palpate_bench::cortex::MemoCell;
use palpate_bench::{Memo, OptionBytes, Port, ResetFlags, WINDOW_MS, Watchdog};
use stm32g4xx_hal::gpio::{AF7, PA2, PA3};
use stm32g4xx_hal::independent_watchdog::IndependentWatchdog;
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::pwr::VoltageScale;
use stm32g4xx_hal::rcc::{Config, PllConfig, PllMDiv, PllNMul, PllRDiv, PllSrc, Rcc};
use stm32g4xx_hal::serial::{FullConfig, Serial};
use stm32g4xx_hal::stm32::{FLASH, IWDG, PWR, RCC, USART2};
use stm32g4xx_hal::time::ExtU32;

// Clocks, power and reset, as the reference manual (RM0440) requires.

/// 16 MHz / 4 · 85 / 2: the most that the chip takes.
pub const CLOCK: u32 = 170_000_000;

/// Looks until the watchdog must have taken its window: six cycles of a divided clock of 32 kHz, 1 ms at most.
const LOOKS: u32 = 1_000_000;

/// The memo for after the next reset. `used`, since the compiler must not assume its first value.
#[unsafe(link_section = ".uninit.MEMO")]
#[used]
pub static MEMO: MemoCell = MemoCell::new();

/// The option bytes.
pub fn option_bytes(flash: &FLASH) -> OptionBytes {
    OptionBytes(flash.optr().read().bits())
}

/// Checks them, before a motor may be driven.
///
/// # Panics
/// If they are refused.
pub fn accept(options: OptionBytes) {
    assert!(options.refused().is_none(), "the watchdog would stand still in Stop mode");
}

/// Sets the clocks, and gives why the chip was reset.
pub fn start(rcc: RCC, power: PWR, flash: &FLASH) -> (Rcc, ResetReason) {
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
    // The option that checks the parity of SRAM, 0 if it does (RM0440, FLASH_OPTR, SRAM_PE): then reading a word that
    // nobody has written since power-on is an NMI. A brown-out is no longer told from power-on.
    let is_checked = flash.optr().read().sram2_pe().bit_is_clear();
    if flags.power && is_checked {
        MEMO.write(Memo::EMPTY);
    }
    (rcc, flags.reason(MEMO.read()))
}

/// The port of the board's own USB, 500,000 baud: 170 MHz / 340.
pub struct Usart(Serial<USART2, PA2<AF7>, PA3<AF7>>);

/// Opens it.
///
/// # Panics
/// If the clock could not make the rate: it can.
pub fn open_port(port: USART2, out: PA2<AF7>, back: PA3<AF7>, rcc: &mut Rcc) -> Usart {
    let Ok(serial) = port.usart(out, back, FullConfig::default().baudrate(500_000.bps()), rcc) else {
        panic!("170 MHz make 500,000 baud")
    };
    Usart(serial)
}

impl Port for Usart {
    #[inline]
    fn send(&mut self, byte: u8) -> bool {
        let Self(_) = self;
        // SAFETY: nobody else uses the registers of the port that this owns.
        let port = unsafe { &*USART2::ptr() };
        let is_free = port.isr().read().txe().bit_is_set();
        if is_free {
            // SAFETY: nine bits, of which eight are used.
            port.tdr().write(|w| unsafe { w.tdr().bits(u16::from(byte)) });
        }
        is_free
    }

    #[inline]
    fn receive(&mut self) -> Option<u8> {
        // SAFETY: as above.
        let port = unsafe { &*USART2::ptr() };
        // A byte that nobody took in time keeps all later ones out until this.
        port.icr().write(|w| w.orecf().clear_bit_by_one());
        let has_come = port.isr().read().rxne().bit_is_set();
        has_come.then(|| port.rdr().read().rdr().bits() as u8)
    }
}

/// The independent watchdog, with a window.
pub struct Iwdg(IndependentWatchdog);

impl Iwdg {
    /// Starts it for good: it must be fed within this time, and not before [`WINDOW_MS`].
    ///
    /// # Panics
    /// If it does not take its window: then nobody would notice that it is fed too early.
    pub fn start(registers: IWDG, timeout_ms: u32) -> Self {
        let mut watchdog = IndependentWatchdog::new(registers);
        watchdog.start(timeout_ms.millis());
        // The HAL's own start with a window feeds once more at once, which is too early. Writing the window feeds it
        // (RM0440, "Configuring the IWDG when the window option is enabled").
        // SAFETY: nobody else uses the registers of the watchdog that this owns.
        let registers = unsafe { &*IWDG::ptr() };
        let counts = registers.rlr().read().rl().bits();
        let closed = u32::from(counts) * WINDOW_MS / timeout_ms;
        let window = counts - closed as u16;
        registers.kr().write(|w| w.key().unlock());
        // SAFETY: twelve bits, as RLR has.
        registers.winr().write(|w| unsafe { w.win().bits(window) });
        let took = (0..LOOKS).any(|_| registers.sr().read().bits() == 0);
        assert!(took && registers.winr().read().win().bits() == window, "the watchdog did not take its window");
        Self(watchdog)
    }
}

impl Watchdog for Iwdg {
    #[inline]
    fn feed(&mut self) {
        self.0.feed();
    }
}
