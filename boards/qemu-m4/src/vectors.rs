//! The chip's interrupts, as far as they are used. A real chip's crate brings its own.

use cortex_m::interrupt::InterruptNumber;

unsafe extern "C" {
    fn TIMER0();
}

/// The interrupts this board uses, by their position in the vector table.
#[derive(Clone, Copy, Debug)]
pub enum Interrupt {
    /// The first timer of the chip: it sets the servo's pace.
    TIMER0 = TIMER0_NUMBER as isize,
}

/// The name under which the `#[interrupt]` attribute looks for them, and the attribute.
pub use {Interrupt as interrupt, cortex_m_rt::interrupt};

const TIMER0_NUMBER: u16 = 8;

// SAFETY: the numbers are the chip's (application note AN386), fixed and below the size of its vector table.
unsafe impl InterruptNumber for Interrupt {
    fn number(self) -> u16 {
        self as u16
    }
}

/// An entry of the vector table.
#[derive(Clone, Copy)]
pub union Vector {
    handler: unsafe extern "C" fn(),
    reserved: usize,
}

/// Read by the core, from where the linker script of cortex-m-rt puts it.
#[doc(hidden)]
// SAFETY: nothing else has this name or section; cortex-m-rt asks for both.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".vector_table.interrupts")]
pub static __INTERRUPTS: [Vector; 32] = {
    let mut table = [Vector { reserved: 0 }; 32];
    table[TIMER0_NUMBER as usize] = Vector { handler: TIMER0 };
    table
};
