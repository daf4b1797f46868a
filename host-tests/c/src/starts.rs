//! Starts a loop: functions for each mechanism, without and with protection, on a body and on one that gives way.

use crate::body::Loaded;
use crate::handle::Handle;
use crate::mechanisms::{DeltaNumbers, FiveBarNumbers, LinkageArmNumbers, PaddleNumbers, SerialArmNumbers};
use crate::numbers::{DeviceNumbers, SettingsNumbers};
use crate::pointers::get;
use crate::protection::{ProtectionNumbers, Unprotected};
use crate::servo::{Parts, Started, begin};
use crate::soft::Softened;
use crate::status::{Status, code};

/// Exports the two functions of a mechanism and a kind of body. Each refers to one loop, so that the linker drops the
/// others.
macro_rules! starts {
    ($unprotected:ident, $protected:ident, $numbers:ty, $joints:literal, $body:ty) => {
        /// Starts a loop without protection.
        ///
        /// # Safety
        /// As the header says of all functions.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $unprotected(
            servo: *mut Handle<Started>,
            servo_bytes: usize,
            mechanism: *const $numbers,
            device: *const DeviceNumbers,
            body: *const Handle<$body>,
            settings: *const SettingsNumbers,
            reset: u32,
        ) -> Status {
            let parts = Parts { device, ground: body, settings, guarding: Unprotected, reset };
            // SAFETY: the caller's memory, numbers and body.
            code(unsafe { begin::<_, $joints, _, _>(servo, servo_bytes, mechanism, parts) })
        }

        /// Starts a loop with protection.
        ///
        /// # Safety
        /// As the header says of all functions.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $protected(
            servo: *mut Handle<Started>,
            servo_bytes: usize,
            mechanism: *const $numbers,
            device: *const DeviceNumbers,
            body: *const Handle<$body>,
            settings: *const SettingsNumbers,
            protection: *const ProtectionNumbers,
            reset: u32,
        ) -> Status {
            let start = || {
                // SAFETY: the caller's numbers.
                let guarding = unsafe { get(protection) }?;
                let parts = Parts { device, ground: body, settings, guarding, reset };
                // SAFETY: the caller's memory, numbers and body.
                unsafe { begin::<_, $joints, _, _>(servo, servo_bytes, mechanism, parts) }
            };
            code(start())
        }
    };
}

starts!(palpate_servo_start_serial_arm, palpate_servo_start_serial_arm_protected, SerialArmNumbers, 3, Loaded);
starts!(palpate_servo_start_delta, palpate_servo_start_delta_protected, DeltaNumbers, 3, Loaded);
starts!(palpate_servo_start_linkage_arm, palpate_servo_start_linkage_arm_protected, LinkageArmNumbers, 3, Loaded);
starts!(palpate_servo_start_five_bar, palpate_servo_start_five_bar_protected, FiveBarNumbers, 2, Loaded);
starts!(palpate_servo_start_paddle, palpate_servo_start_paddle_protected, PaddleNumbers, 1, Loaded);
starts!(
    palpate_servo_start_serial_arm_soft,
    palpate_servo_start_serial_arm_soft_protected,
    SerialArmNumbers,
    3,
    Softened
);
starts!(palpate_servo_start_delta_soft, palpate_servo_start_delta_soft_protected, DeltaNumbers, 3, Softened);
starts!(
    palpate_servo_start_linkage_arm_soft,
    palpate_servo_start_linkage_arm_soft_protected,
    LinkageArmNumbers,
    3,
    Softened
);
starts!(palpate_servo_start_five_bar_soft, palpate_servo_start_five_bar_soft_protected, FiveBarNumbers, 2, Softened);
starts!(palpate_servo_start_paddle_soft, palpate_servo_start_paddle_soft_protected, PaddleNumbers, 1, Softened);
