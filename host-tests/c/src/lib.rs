//! palpate for C: bodies from files, closest points, pairs of patches and the whole servo tick, in memory of the
//! caller. The header `include/palpate.h` documents every function for callers.
//!
//! Stages of a call: `pointers` checks each pointer (null, alignment, size) and turns it into a value or a reference;
//! `handle` checks that it is a handle made here and not moved; the rest is the library's own safe code. Errors are
//! returned as a [`status::Status`]; nothing panics or allocates.

// With unwinding, as linters check it beside the host's packages, a crate without `std` does not compile.
#![cfg_attr(panic = "abort", no_std)]

mod body;
mod felt;
mod frame;
mod ground;
mod handle;
mod held;
mod homing;
mod homing_calls;
mod knob;
mod link;
mod mechanisms;
mod memory;
mod numbers;
mod pair;
mod pointers;
mod protection;
mod running;
mod servo;
mod soft;
mod starts;
mod state;
mod status;
mod texture;
mod tool;
mod tracker;

/// Never reached: a test looks at every branch to a panic in the linked image.
#[cfg(panic = "abort")]
#[inline(never)]
#[panic_handler]
fn palpate_panicked(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
