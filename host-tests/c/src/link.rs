//! The wire's frames: sensors in, reports out, in lockstep with a simulated device.

use crate::frame::pack;
use crate::handle::{Handle, Kind};
use crate::pointers::{checked_mut, put};
use crate::servo::{Started, running};
use crate::status::{Status, code};
use core::slice;
use palpate_core::wire::Sensors;
use palpate_core::wire::frame::{MAX_FRAME, Received, Receiver};

/// Bytes of a frame on their way in.
pub struct Listening(Receiver<Sensors>);

impl Kind for Listening {
    const MARK: usize = 0x5041_4c4c;
}

/// The message that a byte completed.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Heard {
    pub what: u32,
    pub tick: u32,
    pub counts: [i32; 3],
    pub enable: u32,
}

/// Makes a receiver at the start of a frame.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_receiver_start(receiver: *mut Handle<Listening>, receiver_bytes: usize) -> Status {
    let start = || {
        // SAFETY: the caller's memory for the receiver.
        unsafe { Handle::fill(Handle::vacate(receiver, receiver_bytes)?, Listening(Receiver::new())) };
        Ok(())
    };
    code(start())
}

/// Takes a byte.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_receiver_feed(
    receiver: *mut Handle<Listening>,
    byte: u8,
    heard: *mut Heard,
) -> Status {
    let feed = || {
        checked_mut(heard)?;
        // SAFETY: the caller's handle, nobody else's.
        let Listening(receiver) = unsafe { Handle::get_mut(receiver) }?;
        let nothing = Heard { what: 0, tick: 0, counts: [0; 3], enable: 0 };
        let found = match receiver.feed(byte) {
            None => nothing,
            Some(Received::Message(Sensors { tick, counts, enable })) => {
                Heard { what: 1, tick, counts, enable: u32::from(enable) }
            }
            Some(Received::Damaged) => Heard { what: 2, ..nothing },
            Some(Received::Empty) => Heard { what: 3, ..nothing },
        };
        // SAFETY: the caller's place for it.
        unsafe { put(heard, found) }
    };
    code(feed())
}

/// Packs the report of the last tick.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_report(
    servo: *mut Handle<Started>,
    instructions: u32,
    frame: *mut u8,
    frame_bytes: usize,
    written: *mut usize,
) -> Status {
    let packed = || {
        checked_mut(written)?;
        let first = checked_mut(frame)?;
        // SAFETY: the caller's handle, nobody else's.
        let report = unsafe { running(servo) }?.report(instructions);
        let mut buffer = [0; MAX_FRAME];
        let packed = pack(&report, &mut buffer).ok_or(Status::TooSmall)?;
        if packed.len() > frame_bytes {
            return Err(Status::TooSmall);
        }
        // SAFETY: not null, and so many bytes by the caller's promise.
        let place = unsafe { slice::from_raw_parts_mut(first, packed.len()) };
        for (to, from) in place.iter_mut().zip(packed) {
            *to = *from;
        }
        // SAFETY: the caller's place for it.
        unsafe { put(written, packed.len()) }
    };
    code(packed())
}
