//! What happens when the code is wrong: every panic, exception, NMI and interrupt that nobody waits for takes the
//! motors' power away, leaves a memo and a light, and waits for the watchdog.

use core::panic::PanicInfo;
use cortex_m_rt::{ExceptionFrame, exception};
use palpate_bench::Cause;

unsafe extern "Rust" {
    /// The board's: by the registers, trusting nothing that ran before, it disables every drive, then lights its light
    /// and leaves the memo of the cause.
    safe fn palpate_motors_off(cause: Cause);
}

fn stop(cause: Cause) -> ! {
    cortex_m::interrupt::disable();
    palpate_motors_off(cause);
    // Nobody feeds the watchdog any more. Before it runs, which is before the motors do, the light stays on.
    loop {
        cortex_m::asm::nop();
    }
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    stop(Cause::Panic)
}

// SAFETY: none of them touches any state, so it does not matter where they strike.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    stop(Cause::Exception)
}

// SAFETY: as above.
#[exception]
unsafe fn NonMaskableInt() -> ! {
    stop(Cause::Exception)
}

// SAFETY: as above. Every other exception, and every interrupt of the chip that nobody waits for.
#[exception]
unsafe fn DefaultHandler(_: i16) -> ! {
    stop(Cause::Exception)
}
