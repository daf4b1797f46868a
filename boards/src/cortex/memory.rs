//! A test of memory that is in use, where a run time leaves no place for one before it.

use core::arch::global_asm;

unsafe extern "C" {
    /// In assembly, since it changes memory that the compiler believes at rest.
    fn palpate_turn_over(from: *mut u32, to: *mut u32) -> bool;
}

/// Whether every word from `from` to `to` holds its complement and then what it held. It finds bits that stick, and none
/// that depends on another. Before interrupts: some ten cycles a word.
///
/// # Safety
/// Whole words of memory, and nothing else uses them meanwhile.
pub unsafe fn holds_its_bits(from: *mut u32, to: *mut u32) -> bool {
    // SAFETY: as asked for above; it leaves what it found.
    unsafe { palpate_turn_over(from, to) }
}

// Registers alone are used: the stack may lie there.
global_asm!(
    ".section .text.palpate_turn_over, \"ax\", %progbits",
    ".global palpate_turn_over",
    ".type palpate_turn_over, %function",
    ".thumb_func",
    "palpate_turn_over:",
    "0:  cmp r0, r1",
    "    bhs 1f",
    "    ldr r2, [r0]",
    "    mvn r3, r2",
    "    str r3, [r0]",
    "    dsb",
    "    ldr r12, [r0]",
    "    str r2, [r0]",
    "    cmp r12, r3",
    "    bne 2f",
    "    dsb",
    "    ldr r12, [r0], #4",
    "    cmp r12, r2",
    "    beq 0b",
    "2:  movs r0, #0",
    "    bx lr",
    "1:  movs r0, #1",
    "    bx lr",
    ".size palpate_turn_over, . - palpate_turn_over",
    ".text",
);
