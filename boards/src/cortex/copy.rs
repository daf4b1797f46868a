//! Before any Rust runs: tests the memory of stack and variables, and copies the hot path and its tables to where the
//! chip is fastest. The board's memory map says what and where.
//!
//! The test is March X: a pattern written upwards, read and its complement written upwards, read and the pattern written
//! downwards, read. It finds bits that stick, bits that do not change and addresses that meet (van de Goor, "Using March
//! tests to test SRAMs", IEEE Design & Test 10(1), 1993). Memory that fails keeps the program from starting: no motor has
//! been enabled. The section `.uninit` outlives resets and is left alone; `ProgramCheck` compares the copies.

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
    "    mov r12, lr",
    "    ldr r3, =0xa5a5a5a5",
    "    ldr r0, =_stack_end",
    "    ldr r1, =_stack_start",
    "    bl __march",
    "    ldr r0, =__sdata",
    "    ldr r1, =__ebss",
    "    bl __march",
    "    mov lr, r12",
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
    // From r0 to r1, with the pattern in r3, which it leaves there.
    ".thumb_func",
    "__march:",
    "    mov r2, r0",
    "4:  cmp r2, r1",
    "    beq 5f",
    "    stmia r2!, {{r3}}",
    "    b 4b",
    "5:  mvn r3, r3",
    "    mov r2, r0",
    "6:  cmp r2, r1",
    "    beq 7f",
    "    ldr r4, [r2]",
    "    mvn r4, r4",
    "    cmp r4, r3",
    "    bne 10f",
    "    stmia r2!, {{r3}}",
    "    b 6b",
    "7:  cmp r2, r0",
    "    beq 8f",
    "    ldr r4, [r2, #-4]!",
    "    cmp r4, r3",
    "    bne 10f",
    "    mvn r4, r4",
    "    str r4, [r2]",
    "    b 7b",
    "8:  mvn r3, r3",
    "9:  cmp r2, r1",
    "    it eq",
    "    bxeq lr",
    "    ldmia r2!, {{r4}}",
    "    cmp r4, r3",
    "    beq 9b",
    // It stays here: no watchdog runs yet.
    "10: b 10b",
    ".pool",
    ".size __pre_init, . - __pre_init",
    ".text",
);
