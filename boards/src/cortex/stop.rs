//! Stops: every panic, exception, NMI and interrupt that nobody waits for takes the
//! motors' power away, leaves a memo and a light, and waits for the watchdog.

use crate::Cause;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicPtr, Ordering};
use core::{mem, ptr};
use cortex_m_rt::{ExceptionFrame, exception};

unsafe extern "Rust" {
    /// The board's: by the registers, trusting nothing that ran before, it disables every drive, then lights its light
    /// and leaves the memo of the cause.
    safe fn palpate_motors_off(cause: Cause);
}

/// Decides whether an NMI is expected; null while none is.
static BEARS: AtomicPtr<()> = AtomicPtr::new(ptr::null_mut());

/// Does something during which an NMI may come that is no stop: `is_borne` says so of it, and has dealt with it. For
/// main, before there are ticks.
pub fn bearing_nmi<T>(is_borne: fn() -> bool, work: impl FnOnce() -> T) -> T {
    BEARS.store(is_borne as *mut (), Ordering::SeqCst);
    let done = work();
    BEARS.store(ptr::null_mut(), Ordering::SeqCst);
    done
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
unsafe fn NonMaskableInt() {
    let bears = BEARS.load(Ordering::SeqCst);
    if !bears.is_null() {
        // SAFETY: `bearing_nmi` made it of such a function.
        let is_borne = unsafe { mem::transmute::<*mut (), fn() -> bool>(bears) };
        if is_borne() {
            return;
        }
    }
    stop(Cause::Exception)
}

// SAFETY: as above. Every other exception, and every interrupt of the chip that nobody waits for.
#[exception]
unsafe fn DefaultHandler(_: i16) -> ! {
    stop(Cause::Exception)
}
