//! palpate for C: bodies from files, closest points, pairs of patches and the whole servo tick, in memory that the
//! caller gives. The header is `include/palpate.h`, where every function is documented for those who call it.
//!
//! The way of a call: `pointers` looks at each pointer (null, alignment, room) and turns it into a value or a
//! reference; `handle` sees whether it is a handle that was made here and still lies where it was made; the rest is the
//! library's own safe code. What is wrong comes back as a [`status::Status`]; nothing panics, nothing allocates.

// With unwinding, as linters check it beside the host's packages, a crate without `std` does not compile.
#![cfg_attr(panic = "abort", no_std)]

mod body;
mod felt;
mod frame;
mod handle;
mod homing;
mod homing_calls;
mod link;
mod mechanisms;
mod memory;
mod numbers;
mod pair;
mod pointers;
mod protection;
mod running;
mod servo;
mod starts;
mod state;
mod status;
mod texture;
mod tracker;

/// Never reached: a test looks at every branch to a panic in the linked image.
#[cfg(panic = "abort")]
#[inline(never)]
#[panic_handler]
fn palpate_panicked(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
