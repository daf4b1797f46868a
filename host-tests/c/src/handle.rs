//! Handles: objects that the library builds in the caller's memory.
//!
//! Each starts with a word that other memory is unlikely to hold: a mark of its kind, combined with its address. So the
//! library detects memory that was never made a handle, a handle of another kind, and a copy at another address; and
//! other objects may keep the address of a handle. It is a check against mistakes, not against malice.

use crate::pointers::{checked, checked_mut};
use crate::status::Status;
use core::mem::MaybeUninit;
use core::ptr::{addr_of, addr_of_mut};

/// Kinds of objects in a handle.
pub trait Kind: Sized {
    /// Mark of this kind in the first word.
    const MARK: usize;
}

/// Memory of the caller that holds a `T` after [`Self::make`].
#[repr(C)]
pub struct Handle<T> {
    mark: usize,
    value: MaybeUninit<T>,
}

impl<T: Kind> Handle<T> {
    fn mark_at(place: *const Self) -> usize {
        T::MARK ^ place.addr()
    }

    /// Checks memory that is to become a handle, and invalidates its content.
    ///
    /// # Safety
    /// If the pointer is neither null nor misaligned, it points to `bytes` bytes that nobody else uses.
    pub unsafe fn vacate(place: *mut Self, bytes: usize) -> Result<*mut Self, Status> {
        let place = checked_mut(place)?;
        if bytes < size_of::<Self>() {
            return Err(Status::TooSmall);
        }
        // SAFETY: neither null nor misaligned, large enough, and there by the caller's promise.
        unsafe { addr_of_mut!((*place).mark).write(0) };
        Ok(place)
    }

    /// Makes the handle.
    ///
    /// # Safety
    /// The place comes from [`Self::vacate`].
    pub unsafe fn fill(place: *mut Self, value: T) {
        // SAFETY: a place that was looked at.
        unsafe {
            Self::value(place).write(value);
            Self::seal(place);
        }
    }

    /// Where the value goes, to be written part by part.
    ///
    /// # Safety
    /// The place comes from [`Self::vacate`].
    pub unsafe fn value(place: *mut Self) -> *mut T {
        // SAFETY: within the handle.
        unsafe { addr_of_mut!((*place).value) }.cast()
    }

    /// Makes the handle of a value that is there.
    ///
    /// # Safety
    /// The place comes from [`Self::vacate`], and its value was written.
    pub unsafe fn seal(place: *mut Self) {
        // SAFETY: within the handle.
        unsafe { addr_of_mut!((*place).mark).write(Self::mark_at(place)) };
    }

    /// Where the value lies, if it is a handle.
    ///
    /// # Safety
    /// If it is neither null nor misaligned, there is memory for a handle.
    pub unsafe fn live(place: *const Self) -> Result<*const T, Status> {
        let place = checked(place)?;
        // SAFETY: neither null nor misaligned, and there by the caller's promise. Any bits are a number.
        let mark = unsafe { addr_of!((*place).mark).read_volatile() };
        if mark != Self::mark_at(place) {
            return Err(Status::NotReady);
        }
        // SAFETY: within the handle.
        Ok(unsafe { addr_of!((*place).value) }.cast())
    }

    /// The value, to look at.
    ///
    /// # Safety
    /// As [`Self::live`], and nobody writes to it for `'a`.
    pub unsafe fn get<'a>(place: *const Self) -> Result<&'a T, Status> {
        // SAFETY: by the caller's promise; a handle that is live holds a value.
        unsafe { Ok(&*Self::live(place)?) }
    }

    /// The value, to change.
    ///
    /// # Safety
    /// As [`Self::live`], and nobody else looks at it for `'a`.
    pub unsafe fn get_mut<'a>(place: *mut Self) -> Result<&'a mut T, Status> {
        // SAFETY: by the caller's promise; a handle that is live holds a value.
        unsafe { Ok(&mut *Self::live(place)?.cast_mut()) }
    }
}
