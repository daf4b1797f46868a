//! Copies the hot path and its tables to where the chip is fastest, before any Rust runs: the board's memory map says
//! what and where.

use core::arch::global_asm;
use core::ptr::addr_of;

use super::{ProgramCheck, ProgramCopy};

// SAFETY: the memory map defines them.
unsafe extern "C" {
    static __hot_start: u32;
    static __hot_end: u32;
    static __hot_image: u32;
    static __tables_start: u32;
    static __tables_end: u32;
    static __tables_image: u32;
}

/// The check of the copies made here.
pub fn program_check() -> ProgramCheck<2> {
    // SAFETY: the memory map's own places, whole words; nothing writes there after the copying.
    unsafe {
        ProgramCheck::new([
            ProgramCopy::new(addr_of!(__hot_start), addr_of!(__hot_end), addr_of!(__hot_image)),
            ProgramCopy::new(addr_of!(__tables_start), addr_of!(__tables_end), addr_of!(__tables_image)),
        ])
    }
}

// cortex-m-rt's reset handler calls `__pre_init` first of all. In assembly, since no Rust may run before its memory is
// there.
global_asm!(
    ".section .text.__pre_init, \"ax\", %progbits",
    ".global __pre_init",
    ".type __pre_init, %function",
    ".thumb_func",
    "__pre_init:",
    "    ldr r0, =__hot_image",
    "    ldr r1, =__hot_start",
    "    ldr r2, =__hot_end",
    "0:  cmp r1, r2",
    "    beq 1f",
    "    ldmia r0!, {{r3}}",
    "    stmia r1!, {{r3}}",
    "    b 0b",
    "1:  ldr r0, =__tables_image",
    "    ldr r1, =__tables_start",
    "    ldr r2, =__tables_end",
    "2:  cmp r1, r2",
    "    beq 3f",
    "    ldmia r0!, {{r3}}",
    "    stmia r1!, {{r3}}",
    "    b 2b",
    // The data just written is fetched as code next.
    "3:  dsb",
    "    isb",
    "    bx lr",
    ".pool",
    ".size __pre_init, . - __pre_init",
    ".text",
);
