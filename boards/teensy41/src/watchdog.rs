//! The watchdog with a clock of its own (RTWDOG), and why the chip was reset.

use imxrt_ral::{modify_reg, read_reg, rtwdog::RTWDOG, src::SRC, write_reg};
use palpate::servo::ResetReason;

/// Opens the registers for a moment (i.MX RT1060 reference manual, "RTWDOG unlock").
const UNLOCK: u32 = 0xd928_c520;
/// Feeds it ("RTWDOG refresh").
const REFRESH: u32 = 0xb480_a602;
/// 20 ms of its 32 kHz.
const PATIENCE: u32 = 655;

/// The running watchdog.
pub struct Watchdog(RTWDOG);

impl Watchdog {
    /// Starts it, for good.
    pub fn start(registers: RTWDOG) -> Self {
        cortex_m::interrupt::free(|_| {
            write_reg!(imxrt_ral::rtwdog, registers, CNT, UNLOCK);
            write_reg!(imxrt_ral::rtwdog, registers, TOVAL, PATIENCE);
            write_reg!(imxrt_ral::rtwdog, registers, CS, EN: 1, CLK: 1, CMD32EN: 1, UPDATE: 0);
        });
        Self(registers)
    }

    /// Feeds it.
    pub fn feed(&mut self) {
        // Two feeds may not overlap; one word is one feed.
        write_reg!(imxrt_ral::rtwdog, self.0, CNT, REFRESH);
    }
}

/// The reason, read once: the flags are cleared, lest the next reset finds them still up.
pub fn reset_reason(registers: &SRC) -> ResetReason {
    let flags = read_reg!(imxrt_ral::src, registers, SRSR);
    modify_reg!(imxrt_ral::src, registers, SRSR, |flags| flags);
    let is_set = |bit: u32| flags & (1 << bit) != 0;
    // Bits as the reference manual numbers them ("SRC Reset Status Register").
    if is_set(4) || is_set(7) {
        ResetReason::Watchdog
    } else if is_set(1) {
        // Asked for, or the core locked up: a program that hung is the safer reading.
        ResetReason::Watchdog
    } else if is_set(5) || is_set(6) || is_set(3) {
        ResetReason::Pin
    } else {
        ResetReason::PowerOn
    }
}
