//! What happens when the code is wrong: the amplifiers are disabled, by the register, trusting nothing that ran before.
//! Then the watchdog resets the chip, and the loop starts in a fault that says so.

use core::panic::PanicInfo;

use imxrt_ral::gpio::GPIO1;
use imxrt_ral::write_reg;
use imxrt_rt::{ExceptionFrame, exception};

use crate::ENABLE_BITS;

fn stop() -> ! {
    cortex_m::interrupt::disable();
    // SAFETY: nothing else runs any more; the write only takes power away.
    let port = unsafe { GPIO1::instance() };
    write_reg!(imxrt_ral::gpio, port, DR_CLEAR, ENABLE_BITS);
    loop {
        cortex_m::asm::nop();
    }
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
