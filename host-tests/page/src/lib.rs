//! The page's firmware: the same servo loop, compiled for the browser, on a device that a simulated hand holds:
//! three slides, or that of a device file. The exports are plain functions on numbers; longer data lies in memory at an address that a function
//! returns. Each instance of the module is one device with one body, as a board has one image.
//!
//! `unsafe` is only in the names of the exports, which the linker takes as they are.

// The host only lints it.
#![cfg_attr(target_arch = "wasm32", no_std)]

extern crate alloc;

mod basin;
mod exports;
mod felt;
mod held;
mod knob;
mod mesh;
mod page;
mod replay;
mod view;

#[global_allocator]
static ALLOCATOR: dlmalloc::GlobalDlmalloc = dlmalloc::GlobalDlmalloc;

/// No panic is expected; one ends the instance, and the browser's console names the function.
#[cfg(target_arch = "wasm32")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}
