//! The chip's interrupts, as far as they are used. A real chip's crate brings its own.

use cortex_m::interrupt::InterruptNumber;

use crate::board::{BOARD, Board};

unsafe extern "C" {
    fn TIMER0();
}

/// The interrupts that a program may handle.
#[derive(Clone, Copy, Debug)]
pub enum Interrupt {
    /// The first timer of the chip: it sets the servo's pace.
    TIMER0,
}

/// The name under which the `#[interrupt]` attribute looks for them, and the attribute.
pub use {Interrupt as interrupt, cortex_m_rt::interrupt};

/// The position of an interrupt in a chip's vector table.
#[derive(Clone, Copy, Debug)]
pub struct Position(pub u16);

// SAFETY: a board gives a number that is the chip's and fixed; `table` does not compile with one beyond it.
unsafe impl InterruptNumber for Position {
    fn number(self) -> u16 {
        self.0
    }
}

/// An entry of the vector table.
#[derive(Clone, Copy)]
pub union Vector {
    handler: unsafe extern "C" fn(),
    reserved: usize,
}

/// The interrupts that any of the boards has.
pub const INTERRUPTS: usize = 32;

/// Read by the core, from where the linker script of cortex-m-rt puts it.
#[doc(hidden)]
// SAFETY: nothing else has this name or section; cortex-m-rt asks for both.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".vector_table.interrupts")]
pub static __INTERRUPTS: [Vector; INTERRUPTS] = table(&BOARD);

/// The chip's part of a board's vector table. Does not compile for a chip that has no such interrupt.
const fn table(board: &Board) -> [Vector; INTERRUPTS] {
    let mut table = [Vector { reserved: 0 }; INTERRUPTS];
    table[board.timer_interrupt as usize] = Vector { handler: TIMER0 };
    table
}
