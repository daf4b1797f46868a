//! Copies the hot path and its tables to where the chip is fastest, before any Rust runs: the board's memory map says
//! what and where.

use core::arch::global_asm;

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
