//! palpate on the emulated board mps2-an386, a Cortex-M4F with timers and a UART.
//!
//! Where a real device has encoders and motors, this board has a link to a host: one frame with the sensors in, one
//! with the report out, a tick. The programs are those of every emulated board, in `../emulated/programs`.

#![no_std]

use palpate_emulated::board::Board;
use palpate_emulated::reset::ResetRegister;
use palpate_emulated::vectors::{self, INTERRUPTS, Vector};

/// The board (application note AN386).
pub const BOARD: Board = Board {
    clock: 25_000_000,
    timer: 0x4000_0000,
    timer_interrupt: 8,
    uart: 0x4000_4000,
    reset: ResetRegister::DESIGN_KIT,
};

/// Read by the core, from where the linker script of cortex-m-rt puts it.
#[doc(hidden)]
// SAFETY: nothing else has this name or section; cortex-m-rt asks for both.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".vector_table.interrupts")]
pub static __INTERRUPTS: [Vector; INTERRUPTS] = vectors::table(&BOARD);
