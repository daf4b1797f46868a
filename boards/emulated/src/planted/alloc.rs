//! An allocator, and a tick that uses it.

extern crate alloc;

use core::alloc::{GlobalAlloc, Layout};
use core::hint::black_box;

use alloc::boxed::Box;

struct Nothing;

// SAFETY: it never gives any memory, which an allocator may.
unsafe impl GlobalAlloc for Nothing {
    unsafe fn alloc(&self, _: Layout) -> *mut u8 {
        core::ptr::null_mut()
    }

    unsafe fn dealloc(&self, _: *mut u8, _: Layout) {}
}

#[global_allocator]
static NOTHING: Nothing = Nothing;

pub fn fault(ticks: u32) {
    if black_box(ticks) == u32::MAX {
        black_box(Box::new(ticks));
    }
}
