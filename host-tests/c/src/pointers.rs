//! Checks of a caller's pointers before use: null, alignment and size.
//!
//! The rest is the caller's promise, stated in the header once for all functions: a pointer that is not null points to
//! that much memory, and nobody else writes to it meanwhile.

use crate::status::Status;
use core::ffi::c_void;
use core::mem::MaybeUninit;
use core::slice;

/// Numbers in any arrangement: every pattern of bits is one.
///
/// # Safety
/// It holds integers, floats and arrays and structures of them alone, and has no padding that is read.
pub unsafe trait Plain: Copy {}

// SAFETY: numbers.
unsafe impl Plain for u8 {}
// SAFETY: numbers.
unsafe impl Plain for i32 {}
// SAFETY: numbers.
unsafe impl Plain for f32 {}
// SAFETY: an array of numbers.
unsafe impl<T: Plain, const N: usize> Plain for [T; N] {}

/// Whether a pointer is one to a `T`, as far as can be seen.
pub fn checked<T>(pointer: *const T) -> Result<*const T, Status> {
    match pointer {
        null if null.is_null() => Err(Status::Null),
        there if there.is_aligned() => Ok(there),
        _ => Err(Status::Misaligned),
    }
}

/// The same of a pointer to write to.
pub fn checked_mut<T>(pointer: *mut T) -> Result<*mut T, Status> {
    checked(pointer.cast_const()).map(<*const T>::cast_mut)
}

/// The numbers that a pointer points to.
///
/// # Safety
/// If it is neither null nor misaligned, there is a `T`.
pub unsafe fn get<T: Plain>(pointer: *const T) -> Result<T, Status> {
    let there = checked(pointer)?;
    // SAFETY: neither null nor misaligned, there by the caller's promise, and any bits are a `T`.
    Ok(unsafe { there.read() })
}

/// Writes a result, unless the caller passed null.
///
/// # Safety
/// If the pointer is neither null nor misaligned, it points to memory for a `T`.
pub unsafe fn put<T: Copy>(pointer: *mut T, value: T) -> Result<(), Status> {
    let there = checked_mut(pointer)?;
    // SAFETY: neither null nor misaligned, and there by the caller's promise.
    unsafe { there.write(value) };
    Ok(())
}

/// A row of numbers.
///
/// # Safety
/// If the pointer is neither null nor misaligned, it points to `count` numbers, which do not change during `'a`.
pub unsafe fn row<'a, T: Plain>(pointer: *const T, count: usize) -> Result<&'a [T], Status> {
    let there = checked(pointer)?;
    if count > isize::MAX as usize / size_of::<T>() {
        return Err(Status::OutOfRange);
    }
    // SAFETY: neither null nor misaligned, no longer than memory can be, there by the caller's promise; any bits are a
    // `T`.
    Ok(unsafe { slice::from_raw_parts(there, count) })
}

/// Slots for a number of `T` at the start of a block of memory, and the rest of the block.
///
/// # Safety
/// If it is not null, the block is there for good, and nobody else's.
pub unsafe fn take_slots<T: Copy>(
    block: *mut c_void,
    bytes: usize,
    count: usize,
    vacant: T,
) -> Result<(&'static mut [T], *mut c_void, usize), Status> {
    let first = checked_mut(block.cast::<MaybeUninit<T>>())?;
    let needed = count.checked_mul(size_of::<T>()).ok_or(Status::TooSmall)?;
    let left = bytes.checked_sub(needed).ok_or(Status::TooSmall)?;
    // SAFETY: neither null nor misaligned, there by the caller's promise, and no longer than the block; what is not
    // yet a `T` need not be one.
    let places = unsafe { slice::from_raw_parts_mut(first, count) };
    for place in places.iter_mut() {
        place.write(vacant);
    }
    // SAFETY: each of them has just been written.
    let written = unsafe { slice::from_raw_parts_mut(first.cast::<T>(), count) };
    // SAFETY: within the block, or one past its end.
    let rest = unsafe { block.byte_add(needed) };
    Ok((written, rest, left))
}

/// Whether all of some numbers are finite.
pub fn finite(numbers: &[f32]) -> Result<(), Status> {
    if numbers.iter().all(|number| number.is_finite()) { Ok(()) } else { Err(Status::NotFinite) }
}

/// A choice of two: 0 or 1. Any other number is another field's.
pub const fn flag(number: u32) -> Result<bool, Status> {
    match number {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(Status::OutOfRange),
    }
}
