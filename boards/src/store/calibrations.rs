//! Flash for what commissioning found.

use crate::Calibrations;
use core::cell::RefCell;
use embedded_storage::nor_flash::NorFlash;
use palpate::commission::{Calibration, CalibrationError, Gains, JointCalibration, Wiring};
use palpate::device::{Device, Kinematics, ZeroOf};
use palpate::wire::{Calibrated, KeepError};

/// Of a record.
const WORDS: usize = 16;
const BYTES: usize = 4 * WORDS;
/// Its first bytes, which are written last: as many as a chip of any kind writes at once, and magic and version among
/// them.
const HEAD: usize = 8;

/// The device that an image was built with: what a calibration is checked against.
#[derive(Clone, Copy, Debug)]
pub struct Built<K: 'static, const JOINTS: usize> {
    /// The device.
    pub device: &'static Device<K, JOINTS>,
    /// Which input and output each joint is on.
    pub wiring: Wiring<JOINTS>,
    /// The homing reference of the zeroes ([`palpate::device::Homing::zero_of`]; [`ZeroOf::Count`] without homing); `None`
    /// where it does not matter.
    pub homed_by: Option<ZeroOf>,
    /// The maximum gains of the loop.
    pub gains: Gains,
}

impl<K: Kinematics<JOINTS> + Copy, const JOINTS: usize> Built<K, JOINTS> {
    /// The device as it was measured.
    fn calibrated(&self, found: &Calibration<JOINTS>) -> Result<Device<K, JOINTS>, CalibrationError> {
        let device = self.device.calibrated(found)?;
        found.check_gains(self.device, &self.gains)?;
        Ok(device)
    }
}

/// One calibration in the first page of some flash, for a device as it was built. Main's.
pub struct KeptCalibration<F, K: 'static, const JOINTS: usize> {
    flash: RefCell<F>,
    built: Built<K, JOINTS>,
    in_use: Calibrated,
}

/// The device that a loop is made with.
#[derive(Clone, Copy, Debug)]
pub struct Found<K, const JOINTS: usize> {
    /// The device, as it was built or as it was found.
    pub device: Device<K, JOINTS>,
    /// Which input and output each joint is on.
    pub wiring: Wiring<JOINTS>,
    /// Whether the stored calibration cannot be used: then no motor may be driven.
    pub is_miscalibrated: bool,
}

impl<F: NorFlash, K: Kinematics<JOINTS> + Copy, const JOINTS: usize> KeptCalibration<F, K, JOINTS> {
    /// Looks for a calibration, before the loop is made. Where none is kept, or one that cannot be used, the device is
    /// what it was built with; [`Calibrations::in_use`] says which. One whose zeroes are not of what the device is
    /// homed by is not used.
    pub fn find(flash: F, built: Built<K, JOINTS>) -> (Self, Found<K, JOINTS>) {
        const { assert!(HEAD.is_multiple_of(F::WRITE_SIZE), "a head is written whole") };
        const { assert!(HEAD.is_multiple_of(F::READ_SIZE), "a record is read whole") };
        let mut kept = Self { flash: RefCell::new(flash), built, in_use: Calibrated::BuiltIn };
        let found = kept.read().and_then(|words| {
            let calibration = Calibration::from_words(&words)?;
            calibration.check_zeroes(built.homed_by)?;
            let (device, wiring) = (built.calibrated(&calibration)?, calibration.wiring()?);
            kept.in_use = Calibrated::Kept { crc: calibration.crc() };
            Ok(Found { device, wiring, is_miscalibrated: false })
        });
        let found = found.unwrap_or_else(|error| match error {
            CalibrationError::Absent => kept.as_built(false),
            error => {
                kept.in_use = Calibrated::Refused(error);
                kept.as_built(true)
            }
        });
        (kept, found)
    }

    /// The same where the chip says that it could not read what lies there, whatever it read in its place: a
    /// calibration that cannot be used. Words that were erased for a new one may read as none at all.
    pub fn damaged(mut self) -> (Self, Found<K, JOINTS>) {
        self.in_use = Calibrated::Refused(CalibrationError::Damaged);
        let found = self.as_built(true);
        (self, found)
    }

    fn as_built(&self, is_miscalibrated: bool) -> Found<K, JOINTS> {
        Found { device: *self.built.device, wiring: self.built.wiring, is_miscalibrated }
    }

    fn read(&self) -> Result<[u32; WORDS], CalibrationError> {
        let mut bytes = [0; BYTES];
        let mut flash = self.flash.try_borrow_mut().map_err(|_| CalibrationError::Damaged)?;
        flash.read(0, &mut bytes).map_err(|_| CalibrationError::Damaged)?;
        let mut words = [0; WORDS];
        for (word, bytes) in words.iter_mut().zip(bytes.as_chunks().0) {
            *word = u32::from_le_bytes(*bytes);
        }
        Ok(words)
    }

    /// Erases the page, and writes the record if there is one: its head last, so that it is there whole or not at all.
    fn write(&self, words: Option<&[u32; WORDS]>) -> Option<()> {
        let mut flash = self.flash.try_borrow_mut().ok()?;
        flash.erase(0, F::ERASE_SIZE as u32).ok()?;
        let Some(words) = words else { return Some(()) };
        let mut bytes = [0; BYTES];
        for (place, word) in bytes.as_chunks_mut().0.iter_mut().zip(words) {
            *place = word.to_le_bytes();
        }
        let (head, rest) = bytes.split_at_checked(HEAD)?;
        flash.write(HEAD as u32, rest).ok()?;
        flash.write(0, head).ok()
    }
}

impl<F: NorFlash, K: Kinematics<JOINTS> + Copy, const JOINTS: usize> Calibrations for KeptCalibration<F, K, JOINTS> {
    fn in_use(&self) -> Calibrated {
        self.in_use
    }

    fn keep(&self, joints: Option<&[JointCalibration; 3]>) -> Result<(), KeepError> {
        let mut words = None;
        if let Some(joints) = joints {
            let joints = joints.first_chunk().ok_or(KeepError::Calibration(CalibrationError::Joints { joints: 3 }))?;
            let calibration = Calibration(*joints);
            calibration.check_zeroes(self.built.homed_by).map_err(KeepError::Calibration)?;
            self.built.calibrated(&calibration).map_err(KeepError::Calibration)?;
            words = Some(calibration.to_words());
        }
        self.write(words.as_ref()).ok_or(KeepError::Flash)?;
        let wanted = words.unwrap_or([u32::MAX; WORDS]);
        if self.read() == Ok(wanted) { Ok(()) } else { Err(KeepError::Flash) }
    }
}
