//! Faults put into the tick on purpose, each behind a feature of its name: what looks for them in the image must find
//! them.

#[cfg(feature = "planted-alloc")]
mod alloc;

use core::hint::black_box;

/// The chosen fault, at a tick with this much force faded in and this many frames lost; nothing if none was chosen.
#[inline]
pub fn fault(ticks: u32, fade: f32, frames_lost: u32) {
    if cfg!(feature = "planted-panic") {
        // A bounds check that may fail.
        let table = black_box([1_u32, 2, 3]);
        black_box(table[ticks as usize]);
    }
    if cfg!(feature = "planted-f64") {
        black_box(f64::from(fade) * black_box(1.0_f64));
    }
    if cfg!(feature = "planted-loop") {
        while black_box(ticks) == u32::MAX {}
    }
    if cfg!(feature = "planted-recursion") {
        black_box(recursion(frames_lost));
    }
    if cfg!(feature = "planted-indirect") {
        let function: fn(u32) -> u32 = black_box(|x| x);
        black_box(function(frames_lost));
    }
    if cfg!(feature = "planted-stack") {
        black_box([ticks; 512]);
    }
    #[cfg(feature = "planted-alloc")]
    alloc::fault(ticks);
}

#[inline(never)]
fn recursion(depth: u32) -> u32 {
    if depth == 0 { 0 } else { black_box(recursion(black_box(depth - 1))) + 1 }
}
