//! Starts a loop of any mechanism, with or without protection.

use crate::body::Loaded;
use crate::handle::Handle;
use crate::mechanisms::{Mechanism, MechanismNumbers};
use crate::numbers::{DeviceNumbers, SettingsNumbers};
use crate::pointers::get;
use crate::protection::{ProtectionNumbers, Unprotected};
use crate::servo::{Parts, Started, begin};
use crate::status::{Status, code};
use palpate_core::device::Kinematics;

/// Starts a loop; without protection where that pointer is null.
///
/// # Safety
/// As the header says of all functions.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn palpate_servo_start(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: *const Mechanism,
    device: *const DeviceNumbers,
    body: *const Handle<Loaded>,
    settings: *const SettingsNumbers,
    protection: *const ProtectionNumbers,
    reset: u32,
) -> Status {
    let start = || {
        // SAFETY: the caller's numbers.
        let mechanism = unsafe { get(mechanism) }?;
        let parts = Parts { device, body, settings, guarding: protection, reset };
        // SAFETY: every member of the union is floats alone; and the caller's memory, numbers and body.
        unsafe {
            match mechanism.kind {
                #[cfg(feature = "serial-arm")]
                1 => begin_any::<_, 3>(servo, servo_bytes, &mechanism.of.serial_arm, parts),
                #[cfg(feature = "delta")]
                2 => begin_any::<_, 3>(servo, servo_bytes, &mechanism.of.delta, parts),
                #[cfg(feature = "linkage-arm")]
                3 => begin_any::<_, 3>(servo, servo_bytes, &mechanism.of.linkage_arm, parts),
                #[cfg(feature = "five-bar")]
                4 => begin_any::<_, 2>(servo, servo_bytes, &mechanism.of.five_bar, parts),
                #[cfg(feature = "paddle")]
                5 => begin_any::<_, 1>(servo, servo_bytes, &mechanism.of.paddle, parts),
                _ => Err(Status::OutOfRange),
            }
        }
    };
    code(start())
}

/// # Safety
/// As [`begin`].
unsafe fn begin_any<M: MechanismNumbers, const JOINTS: usize>(
    servo: *mut Handle<Started>,
    servo_bytes: usize,
    mechanism: &M,
    parts: Parts<*const ProtectionNumbers>,
) -> Result<(), Status>
where
    M::Mechanism: Kinematics<JOINTS> + Copy + 'static,
{
    let Parts { device, body, settings, guarding, reset } = parts;
    if guarding.is_null() {
        let parts = Parts { device, body, settings, guarding: Unprotected, reset };
        // SAFETY: by the caller's promise.
        return unsafe { begin::<_, JOINTS, _>(servo, servo_bytes, mechanism, parts) };
    }
    #[cfg(not(feature = "protection"))]
    return Err(Status::OutOfRange);
    // SAFETY: the caller's numbers.
    #[cfg(feature = "protection")]
    let guarding = unsafe { get(guarding) }?;
    // SAFETY: by the caller's promise.
    #[cfg(feature = "protection")]
    unsafe {
        begin::<_, JOINTS, _>(servo, servo_bytes, mechanism, Parts { device, body, settings, guarding, reset })
    }
}
