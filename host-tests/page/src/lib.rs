//! What the page runs: the firmware's own servo loop, compiled for the browser, on a device of three slides that a
//! simulated hand holds. The exports are plain functions on numbers; what is more than a number lies in the memory,
//! where a function says. An instance of the module is a device: another body takes another instance, as another
//! image would.
//!
//! `unsafe` is only in the names of the exports, which the linker takes as they are.

// The host only lints it.
#![cfg_attr(target_arch = "wasm32", no_std)]

extern crate alloc;

mod basin;
mod exports;
mod felt;
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
