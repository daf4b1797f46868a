//! Calls that home a loop's joints.

use crate::handle::Handle;
use crate::homing::HomingNumbers;
use crate::pointers::{checked_mut, get, put};
use crate::servo::{Started, running};
use crate::state::MotorOutput;
use crate::status::{Status, code};
use palpate_core::device::Counts;
use palpate_core::servo::Event;

/// Has the loop find out where its joints are, before its first tick.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_home(servo: *mut Handle<Started>, homing: *const HomingNumbers) -> Status {
    let home = || {
        // SAFETY: the caller's numbers, and handle, nobody else's.
        let (homing, running) = unsafe { (get(homing)?, running(servo)?) };
        running.home(&homing)
    };
    code(home())
}

/// A joint passed its index mark.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_index(
    servo: *mut Handle<Started>,
    joint: u32,
    counts: i32,
    output: *mut MotorOutput,
) -> Status {
    let note = || {
        checked_mut(output)?;
        // SAFETY: the caller's handle, nobody else's.
        let running = unsafe { running(servo) }?;
        let joint = usize::try_from(joint).ok().filter(|joint| *joint < running.joints()).ok_or(Status::OutOfRange)?;
        running.note(Event::IndexPassed { joint, counts: Counts(counts) });
        // SAFETY: the caller's place for it.
        unsafe { put(output, running.output()) }
    };
    code(note())
}
