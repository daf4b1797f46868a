//! The core's cycle counter, for the acceptance: a debugger that detaches switches it off, so nothing that supervises
//! uses it.

use crate::Counter;
use cortex_m::peripheral::{DCB, DWT};

/// The counter, running. Copies of it are the same counter.
#[derive(Clone, Copy, Debug)]
pub struct Cycles(());

impl Cycles {
    /// Starts it.
    pub fn start(debug: &mut DCB, mut trace: DWT) -> Self {
        debug.enable_trace();
        // On a Cortex-M7 it is locked until it is asked for; the others have no lock, and take no notice.
        DWT::unlock();
        trace.enable_cycle_counter();
        Self(())
    }
}

impl Counter for Cycles {
    #[inline]
    fn now(&self) -> u32 {
        DWT::cycle_count()
    }
}
