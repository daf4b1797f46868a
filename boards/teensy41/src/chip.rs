//! Reset, watchdog and stop of the i.MX RT1062.

use core::ptr::{addr_of, addr_of_mut};

use imxrt_ral::gpio::GPIO1;
use imxrt_ral::snvs::SNVS;
use imxrt_ral::src::SRC;
use imxrt_ral::{modify_reg, read_reg, write_reg};
use palpate_bench::cortex::{ProgramCheck, ProgramCopy, holds_its_bits};
use palpate_bench::{Cause, Memo, ResetFlags};

/// Pins 16, 17 and 18, which enable the amplifiers, are these bits of GPIO1.
const ENABLE_BITS: u32 = 1 << 23 | 1 << 22 | 1 << 17;
/// Pin 22, the light.
const LIGHT_BIT: u32 = 1 << 24;

/// The memo lies in two registers of the always-on domain. They fade with the supply, but not with a coin cell on VBAT:
/// with one every power-on reads as a brown-out, and has to be acknowledged.
pub fn remember(cause: Cause) {
    let Memo([word, complement]) = Memo::new(cause);
    // SAFETY: two registers that nobody else uses.
    let registers = unsafe { SNVS::instance() };
    write_reg!(imxrt_ral::snvs, registers, LPGPR[0], word);
    write_reg!(imxrt_ral::snvs, registers, LPGPR[1], complement);
}

/// Why the chip was reset, and the memo. The flags are cleared, lest the next reset finds them still up.
pub fn reset() -> (ResetFlags, Memo) {
    // SAFETY: read once, before anything else runs.
    let (reset, registers) = unsafe { (SRC::instance(), SNVS::instance()) };
    let memo = Memo([read_reg!(imxrt_ral::snvs, registers, LPGPR[0]), read_reg!(imxrt_ral::snvs, registers, LPGPR[1])]);
    let flags = read_reg!(imxrt_ral::src, reset, SRSR);
    modify_reg!(imxrt_ral::src, reset, SRSR, |flags| flags);
    let is_set = |bit: u32| flags & (1 << bit) != 0;
    // Bits as the reference manual numbers them ("SRC Reset Status Register").
    let flags = ResetFlags {
        power: is_set(0),
        // Asked for, or the core locked up: a program that hung is the safer reading. So it is where the chip stopped
        // itself, by its security unit or because it was too hot.
        watchdog: [1, 2, 4, 7, 8].into_iter().any(is_set),
        pin: is_set(3) || is_set(5) || is_set(6),
        ..ResetFlags::default()
    };
    (flags, memo)
}

// SAFETY: the run time defines them.
unsafe extern "C" {
    static __stext: u32;
    static __etext: u32;
    static __sitext: u32;
    static __srodata: u32;
    static __erodata: u32;
    static __sirodata: u32;
    static mut __estack: u32;
    static mut __sstack: u32;
    static mut __sdata: u32;
    static mut __ebss: u32;
}

/// Tests the memory of stack and variables.
///
/// # Panics
/// If a bit sticks.
pub fn test_memory() {
    // SAFETY: the run time's own symbols, whole words; no interrupt is unmasked yet.
    let holds = unsafe {
        holds_its_bits(addr_of_mut!(__estack), addr_of_mut!(__sstack))
            && holds_its_bits(addr_of_mut!(__sdata), addr_of_mut!(__ebss))
    };
    assert!(holds, "a bit of the memory sticks");
}

/// The check of what the run time copies before main.
pub fn program_check() -> ProgramCheck<2> {
    // SAFETY: the run time's own symbols, whole words; nothing writes there after the copying.
    unsafe {
        ProgramCheck::new([
            ProgramCopy::new(addr_of!(__stext), addr_of!(__etext), addr_of!(__sitext)),
            ProgramCopy::new(addr_of!(__srodata), addr_of!(__erodata), addr_of!(__sirodata)),
        ])
    }
}

/// Whether any of the amplifiers' enable pins reads as high.
pub fn reads_enabled() -> bool {
    // SAFETY: read alone.
    let port = unsafe { GPIO1::instance() };
    read_reg!(imxrt_ral::gpio, port, PSR) & ENABLE_BITS != 0
}

/// Takes the motors' power away, by the register. Before anything else too: a reset of the core alone leaves the levels
/// as they were, and a pin that becomes an output shows it.
pub fn motors_off() {
    // SAFETY: a write that clears three bits, and leaves the others alone.
    let port = unsafe { GPIO1::instance() };
    write_reg!(imxrt_ral::gpio, port, DR_CLEAR, ENABLE_BITS);
}

#[unsafe(no_mangle)]
fn palpate_motors_off(cause: Cause) {
    motors_off();
    // SAFETY: nothing else runs any more; it lights the light.
    let port = unsafe { GPIO1::instance() };
    write_reg!(imxrt_ral::gpio, port, DR_SET, LIGHT_BIT);
    remember(cause);
}
