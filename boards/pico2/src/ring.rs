//! The ring oscillator, which needs no crystal: it clocks the watchdog, and the core's clock is measured by it.
//!
//! The crystal makes the core's clock, the ticks and the pulse widths. Were it the watchdog's too, nothing would be left
//! that notices when it stops.

use palpate_bench::ClocksDisagree;
use rp235x_hal::pac::clocks::RegisterBlock;
use rp235x_hal::pac::{CLOCKS, TICKS};

use crate::chip::{CLOCK, CRYSTAL};

/// Its frequency after reset and the boot ROM, kHz (RP2350 data sheet, 8.3.1).
const RANGE: core::ops::RangeInclusive<u32> = 4_600..=24_000;
/// Looks until a measurement must be over, some 0.25 ms.
const LOOKS: u32 = 100_000;
/// A fifth: it drifts with temperature and supply.
const TOLERANCE: u32 = 5;

/// The oscillator, measured by the crystal once.
#[derive(Debug)]
pub struct Ring {
    /// Looks at a measurement that is not over.
    looks: u32,
}

impl Ring {
    /// Measures it, and hands the reference clock over to it: with that the watchdog, whose ticks are set to
    /// match. The clocks are set up.
    ///
    /// # Panics
    /// If it is out of its range: then nothing would watch the crystal.
    pub fn start() -> Self {
        let clocks = registers();
        // SAFETY: frequencies in kHz; the counter is nobody else's.
        unsafe { clocks.fc0_ref_khz().write(|w| w.bits(CRYSTAL / 1_000)) };
        clocks.fc0_src().write(|w| w.fc0_src().rosc_clksrc_ph());
        let is_over = (0..LOOKS).any(|_| clocks.fc0_status().read().done().bit_is_set());
        let khz = clocks.fc0_result().read().khz().bits();
        assert!(is_over && RANGE.contains(&khz), "the ring oscillator is out of its range");
        clocks.clk_ref_ctrl().modify(|_, w| w.src().rosc_clksrc_ph());
        let has_switched = (0..LOOKS).any(|_| clocks.clk_ref_selected().read().bits() == 1);
        assert!(has_switched, "the reference clock does not switch");
        // SAFETY: at most 24 cycles a microsecond, of nine bits; a frequency in kHz.
        unsafe {
            (*TICKS::ptr()).tickwatchdog().cycles().write(|w| w.bits((khz + 500) / 1_000));
            clocks.fc0_ref_khz().write(|w| w.bits(khz));
        }
        clocks.fc0_src().write(|w| w.fc0_src().clk_sys());
        Self { looks: 0 }
    }

    /// A turn of main: looks at the measurement of the core's clock, and starts the next.
    ///
    /// # Errors
    /// The core's clock is a fifth off, or was not measured.
    pub fn step(&mut self) -> Result<(), ClocksDisagree> {
        let clocks = registers();
        if clocks.fc0_status().read().done().bit_is_clear() {
            self.looks += 1;
            return if self.looks > LOOKS { Err(ClocksDisagree) } else { Ok(()) };
        }
        self.looks = 0;
        let khz = clocks.fc0_result().read().khz().bits();
        clocks.fc0_src().write(|w| w.fc0_src().clk_sys());
        let is_off = khz.abs_diff(CLOCK / 1_000) > CLOCK / 1_000 / TOLERANCE;
        if is_off { Err(ClocksDisagree) } else { Ok(()) }
    }
}

fn registers() -> &'static RegisterBlock {
    // SAFETY: after set-up main alone uses them.
    unsafe { &*CLOCKS::ptr() }
}
