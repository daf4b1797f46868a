//! What happens when the code is wrong: the bridges are disabled, by the register, trusting nothing that ran before.
//! Then the watchdog resets the chip, and the loop starts in a fault that says so.

use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, exception};
use rp235x_hal::pac::SIO;

use crate::ENABLE_PIN;

fn stop() -> ! {
    cortex_m::interrupt::disable();
    // SAFETY: nothing else runs on this core any more; the write only takes power away.
    unsafe { (*SIO::ptr()).gpio_out_clr().write(|w| w.bits(1 << ENABLE_PIN)) };
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
