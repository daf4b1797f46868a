//! Where one emulated board differs from another, and the one that this image is for.

use crate::reset::ResetRegister;

/// A board's clock and addresses.
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

impl Board {
    /// mps2-an386, a Cortex-M4F, and mps2-an500, a Cortex-M7 (application notes AN386 and AN500): around the core they
    /// are the same.
    pub const DESIGN_KIT: Self = Self {
        clock: 25_000_000,
        timer: 0x4000_0000,
        timer_interrupt: 8,
        uart: 0x4000_4000,
        reset: ResetRegister::DESIGN_KIT,
    };

    /// mps2-an505, a Cortex-M33 (application note AN505; the secure aliases of its peripherals).
    pub const AN505: Self = Self {
        clock: 20_000_000,
        timer: 0x5000_0000,
        timer_interrupt: 3,
        uart: 0x5020_0000,
        reset: ResetRegister::SSE_200,
    };
}

/// The board that this image is for, chosen by `build.rs`.
pub const BOARD: Board = if cfg!(board = "m33") { Board::AN505 } else { Board::DESIGN_KIT };
