//! Where one emulated board differs from another.

use crate::reset::ResetRegister;

/// What a board's own crate says about it.
#[derive(Clone, Copy, Debug)]
pub struct Board {
    /// The clock of the core, of its timers and of SysTick, Hz.
    pub clock: u32,
    /// Address of the first APB timer.
    pub timer: usize,
    /// Its position among the chip's interrupts.
    pub timer_interrupt: u16,
    /// Address of the first APB UART.
    pub uart: usize,
    /// Why the chip was reset.
    pub reset: ResetRegister,
}
