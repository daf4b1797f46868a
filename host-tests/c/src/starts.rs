//! A loop for each mechanism. A program that starts one links no other.

use crate::body::Loaded;
use crate::handle::Handle;
use crate::mechanisms::{DeltaNumbers, FiveBarNumbers, LinkageArmNumbers, PaddleNumbers, SerialArmNumbers};
use crate::numbers::{DeviceNumbers, SettingsNumbers};
use crate::protection::Unprotected;
use crate::servo::{Parts, Started, begin};
use crate::status::{Status, code};

/// A loop of a serial arm.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_serial_arm(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const SerialArmNumbers,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    reset: u32,
) -> Status {
    let parts = Parts { device, body, settings, guarding: Unprotected, reset };
    // SAFETY: the caller's memory, numbers and body.
    code(unsafe { begin::<_, 3, _>(servo, servo_bytes, mechanism, parts) })
}

/// A loop of a delta.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_delta(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const DeltaNumbers,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    reset: u32,
) -> Status {
    let parts = Parts { device, body, settings, guarding: Unprotected, reset };
    // SAFETY: the caller's memory, numbers and body.
    code(unsafe { begin::<_, 3, _>(servo, servo_bytes, mechanism, parts) })
}

/// A loop of a linkage arm.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_linkage_arm(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const LinkageArmNumbers,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    reset: u32,
) -> Status {
    let parts = Parts { device, body, settings, guarding: Unprotected, reset };
    // SAFETY: the caller's memory, numbers and body.
    code(unsafe { begin::<_, 3, _>(servo, servo_bytes, mechanism, parts) })
}

/// A loop of a five-bar.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_five_bar(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const FiveBarNumbers,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    reset: u32,
) -> Status {
    let parts = Parts { device, body, settings, guarding: Unprotected, reset };
    // SAFETY: the caller's memory, numbers and body.
    code(unsafe { begin::<_, 2, _>(servo, servo_bytes, mechanism, parts) })
}

/// A loop of a paddle.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_paddle(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const PaddleNumbers,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    reset: u32,
) -> Status {
    let parts = Parts { device, body, settings, guarding: Unprotected, reset };
    // SAFETY: the caller's memory, numbers and body.
    code(unsafe { begin::<_, 1, _>(servo, servo_bytes, mechanism, parts) })
}
