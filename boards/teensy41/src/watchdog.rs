//! The watchdog with a clock of its own (RTWDOG).

use imxrt_ral::{read_reg, rtwdog::RTWDOG, write_reg};
use palpate_bench::{WINDOW_MS, Watchdog};

/// Opens the registers for a moment (i.MX RT1060 reference manual, "RTWDOG unlock").
const UNLOCK: u32 = 0xd928_c520;
/// Feeds it ("RTWDOG refresh").
const REFRESH: u32 = 0xb480_a602;
/// 20 ms of its 32 kHz.
const PATIENCE: u32 = 655;
/// The count from which it may be fed again ("RTWDOG_WIN").
const WINDOW: u32 = PATIENCE * WINDOW_MS / 20;
/// Looks until it must have taken its configuration: some cycles of its own clock, a fiftieth of a millisecond each.
const LOOKS: u32 = 1_000_000;

/// The running watchdog.
pub struct Rtwdog(RTWDOG);

impl Rtwdog {
    /// Starts it, for good, and reads back what it took.
    ///
    /// # Panics
    /// If it did not take its configuration: then nobody would notice that the program hangs.
    pub fn start(registers: RTWDOG) -> Self {
        cortex_m::interrupt::free(|_| {
            write_reg!(imxrt_ral::rtwdog, registers, CNT, UNLOCK);
            write_reg!(imxrt_ral::rtwdog, registers, TOVAL, PATIENCE);
            write_reg!(imxrt_ral::rtwdog, registers, WIN, WINDOW);
            // With DBG, for a breakpoint is a program that hangs while its motors turn.
            write_reg!(imxrt_ral::rtwdog, registers, CS, EN: 1, CLK: 1, CMD32EN: 1, UPDATE: 0, DBG: 1, WIN: 1);
        });
        let took = (0..LOOKS).any(|_| read_reg!(imxrt_ral::rtwdog, registers, CS, RCS == 1));
        let runs = read_reg!(imxrt_ral::rtwdog, registers, CS, EN == 1);
        let clock = read_reg!(imxrt_ral::rtwdog, registers, CS, CLK == 1);
        let is_windowed = read_reg!(imxrt_ral::rtwdog, registers, CS, WIN == 1);
        let times = [read_reg!(imxrt_ral::rtwdog, registers, TOVAL), read_reg!(imxrt_ral::rtwdog, registers, WIN)];
        assert!(
            took && runs && clock && is_windowed && times == [PATIENCE, WINDOW],
            "the watchdog did not take its configuration"
        );
        Self(registers)
    }
}

impl Watchdog for Rtwdog {
    #[inline]
    fn feed(&mut self) {
        // One word is one feed.
        write_reg!(imxrt_ral::rtwdog, self.0, CNT, REFRESH);
    }
}
