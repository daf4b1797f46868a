//! Panics and exceptions: the motors lose their current, and the emulator ends with an error.

use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, exception};

/// Motors safe, then stop. Here the motors are the host's, and an emulator that ends with an error is how it knows; on
/// a real board, switch the PWM outputs off here, by the register, trusting nothing that ran before.
///
/// A function of its own: whatever panics ends here, and the proof that no tick does looks for it by name.
#[inline(never)]
fn stop() -> ! {
    cortex_m::interrupt::disable();
    semihosting::process::exit(1)
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    stop()
}

// SAFETY: it touches no state, so it does not matter where the fault struck.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    stop()
}
