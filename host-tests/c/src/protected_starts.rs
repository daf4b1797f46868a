//! The same, protected. A program that starts none of them links no protection.

use crate::body::Loaded;
use crate::handle::Handle;
use crate::mechanisms::{DeltaNumbers, FiveBarNumbers, LinkageArmNumbers, PaddleNumbers, SerialArmNumbers};
use crate::numbers::{DeviceNumbers, SettingsNumbers};
use crate::pointers::get;
use crate::protection::ProtectionNumbers;
use crate::servo::{Parts, Started, begin};
use crate::status::{Status, code};

/// A loop of a serial arm, protected.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_serial_arm_protected(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const SerialArmNumbers,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    protection: *const ProtectionNumbers,
    reset: u32,
) -> Status {
    let start = || {
        // SAFETY: the caller's numbers.
        let protection = unsafe { get(protection) }?;
        let parts = Parts { device, body, settings, guarding: protection, reset };
        // SAFETY: the caller's memory, numbers and body.
        unsafe { begin::<_, 3, _>(servo, servo_bytes, mechanism, parts) }
    };
    code(start())
}

/// A loop of a delta, protected.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_delta_protected(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const DeltaNumbers,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    protection: *const ProtectionNumbers,
    reset: u32,
) -> Status {
    let start = || {
        // SAFETY: the caller's numbers.
        let protection = unsafe { get(protection) }?;
        let parts = Parts { device, body, settings, guarding: protection, reset };
        // SAFETY: the caller's memory, numbers and body.
        unsafe { begin::<_, 3, _>(servo, servo_bytes, mechanism, parts) }
    };
    code(start())
}

/// A loop of a linkage arm, protected.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_linkage_arm_protected(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const LinkageArmNumbers,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    protection: *const ProtectionNumbers,
    reset: u32,
) -> Status {
    let start = || {
        // SAFETY: the caller's numbers.
        let protection = unsafe { get(protection) }?;
        let parts = Parts { device, body, settings, guarding: protection, reset };
        // SAFETY: the caller's memory, numbers and body.
        unsafe { begin::<_, 3, _>(servo, servo_bytes, mechanism, parts) }
    };
    code(start())
}

/// A loop of a five-bar, protected.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_five_bar_protected(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const FiveBarNumbers,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    protection: *const ProtectionNumbers,
    reset: u32,
) -> Status {
    let start = || {
        // SAFETY: the caller's numbers.
        let protection = unsafe { get(protection) }?;
        let parts = Parts { device, body, settings, guarding: protection, reset };
        // SAFETY: the caller's memory, numbers and body.
        unsafe { begin::<_, 2, _>(servo, servo_bytes, mechanism, parts) }
    };
    code(start())
}

/// A loop of a paddle, protected.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start_paddle_protected(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const PaddleNumbers,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    protection: *const ProtectionNumbers,
    reset: u32,
) -> Status {
    let start = || {
        // SAFETY: the caller's numbers.
        let protection = unsafe { get(protection) }?;
        let parts = Parts { device, body, settings, guarding: protection, reset };
        // SAFETY: the caller's memory, numbers and body.
        unsafe { begin::<_, 1, _>(servo, servo_bytes, mechanism, parts) }
    };
    code(start())
}
