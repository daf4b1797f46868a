//! Where one emulated board differs from another, and the one that this image is for.

use palpate::servo::ResetReason;

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
    /// Says why the chip was reset, if anything does.
    pub reset: Option<ResetRegister>,
}

impl Board {
    /// mps2-an386, a Cortex-M4F, mps2-an500, a Cortex-M7, and mps2-an385, a Cortex-M3 (application notes of these
    /// numbers): around the core they are the same.
    pub const DESIGN_KIT: Self = Self {
        clock: 25_000_000,
        timer: 0x4000_0000,
        timer_interrupt: 8,
        uart: 0x4000_4000,
        reset: Some(ResetRegister::DESIGN_KIT),
    };

    /// mps2-an505, a Cortex-M33 (application note AN505; the secure aliases of its peripherals).
    pub const AN505: Self = Self {
        clock: 20_000_000,
        timer: 0x5000_0000,
        timer_interrupt: 3,
        uart: 0x5020_0000,
        reset: Some(ResetRegister::SSE_200),
    };

    /// The emulator's own machine `virt` for RISC-V: its time, its interrupt controller (CLINT), its UART.
    pub const VIRT: Self =
        Self { clock: 10_000_000, timer: 0x0200_0000, timer_interrupt: 0, uart: 0x1000_0000, reset: None };

    /// Why the chip was reset: power, where nothing says.
    pub fn reset_reason(&self) -> ResetReason {
        self.reset.map_or(ResetReason::PowerOn, |register| register.reason())
    }
}

/// The board that this image is for, chosen by `build.rs`.
pub const BOARD: Board = if cfg!(board = "m33") {
    Board::AN505
} else if cfg!(target_arch = "riscv32") {
    Board::VIRT
} else {
    Board::DESIGN_KIT
};
