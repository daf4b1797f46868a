//! What happens when the code is wrong: the amplifiers are disabled, by the register, trusting nothing that ran before.
//! Then the watchdog resets the chip, and the loop starts in a fault that says so.

use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, exception};
use stm32g4xx_hal::stm32::{GPIOC, TIM1};

fn stop() -> ! {
    cortex_m::interrupt::disable();
    // SAFETY: nothing else runs any more; each write only takes power away.
    unsafe {
        // The three enable pins low, and every output of the timer off.
        (*GPIOC::ptr()).bsrr().write(|w| w.br0().set_bit().br1().set_bit().br2().set_bit());
        (*TIM1::ptr()).bdtr().modify(|_, w| w.moe().clear_bit());
    }
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
