//! The core of a board that is being accepted.

use super::Cycles;
use crate::Counter;
use crate::accept::Stopwatch;
use palpate::wire::acceptance::{Counted, Failure};

impl Stopwatch for Cycles {
    const COUNTED: Counted = Counted::Cycles;

    #[inline(always)]
    fn measure(&mut self, work: impl FnOnce()) -> u32 {
        cortex_m::interrupt::free(|_| {
            let began = self.now();
            work();
            self.now().wrapping_sub(began)
        })
    }
}

/// The core, as its CPUID register names it.
pub fn core_id() -> u32 {
    // SAFETY: a register that is only ever read.
    unsafe { (*cortex_m::peripheral::CPUID::PTR).base.read() }
}

/// Fails, in the way asked for.
///
/// # Panics
/// That is one of them.
pub fn fail(failure: Failure) -> ! {
    match failure {
        // Ticks go on: it is the watchdog that has to find this.
        Failure::Hang => loop {
            cortex_m::asm::nop();
        },
        Failure::Panic => panic!("requested by the host"),
        Failure::Exception => cortex_m::asm::udf(),
    }
}
