//! palpate on the emulated board mps2-an505, a Cortex-M33 with timers and a UART.
//!
//! Where a real device has encoders and motors, this board has a link to a host: one frame with the sensors in, one
//! with the report out, a tick. The programs are those of every emulated board, in `../emulated/programs`.

#![no_std]

use palpate_emulated::board::Board;
use palpate_emulated::reset::ResetRegister;
use palpate_emulated::vectors::{self, INTERRUPTS, Vector};

/// The board (application note AN505; the secure aliases of its peripherals).
pub const BOARD: Board = Board {
    clock: 20_000_000,
    timer: 0x5000_0000,
    timer_interrupt: 3,
    uart: 0x5020_0000,
    reset: ResetRegister::SSE_200,
};

/// Read by the core, from where the linker script of cortex-m-rt puts it.
#[doc(hidden)]
// SAFETY: nothing else has this name or section; cortex-m-rt asks for both.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".vector_table.interrupts")]
pub static __INTERRUPTS: [Vector; INTERRUPTS] = vectors::table(&BOARD);
