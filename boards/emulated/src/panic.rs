//! Panics and exceptions: the motors lose their current, and the emulator ends with an error.

use core::panic::PanicInfo;

/// Motors safe, then stop. Here the motors are the host's, and an emulator that ends with an error is how it knows; on
/// a real board, switch the PWM outputs off here, by the register, trusting nothing that ran before.
///
/// A function of its own: whatever panics ends here, and the proof that no tick does looks for it by name.
#[inline(never)]
pub(crate) fn stop() -> ! {
    #[cfg(target_arch = "arm")]
    cortex_m::interrupt::disable();
    semihosting::process::exit(1)
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    stop()
}
