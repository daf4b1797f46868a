//! Why a calibration is not used.

use thiserror::Error;

/// Why a calibration is not used. Joints are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CalibrationError {
    /// No record: the flash is erased.
    #[error("no calibration is stored")]
    Absent,
    /// Its first words are missing: the power went while it was written.
    #[error("calibration record incomplete (power was lost while saving); save it again")]
    Interrupted,
    /// Its CRC is not that of its words, or it is something else.
    #[error("the calibration stored in flash is damaged; save it again, or forget it")]
    Damaged,
    /// It is of another version.
    #[error("the calibration stored in flash has version {version}; save it again")]
    Version {
        /// Its version.
        version: u16,
    },
    /// It is of a device with another number of joints.
    #[error("the calibration is of a device of {joints} joints")]
    Joints {
        /// How many.
        joints: u16,
    },
    /// A joint has no input or output of the board, or another's.
    #[error("the calibration gives two joints the same encoder input or motor output, or one that the board has not")]
    Channels,
    /// A number is not finite.
    #[error("joint {joint}: a number of the calibration is not finite")]
    NotFinite {
        /// Which.
        joint: u8,
    },
    /// The encoder is too fine or too coarse compared with the preset's.
    #[error("joint {joint}: the encoder's counts are more than five times off those that the device was built with")]
    Encoder {
        /// Which.
        joint: u8,
    },
    /// The encoder's zero is not near the joint's range.
    #[error("joint {joint}: the encoder's zero lies more than a turn outside of the joint's range")]
    Zero {
        /// Which.
        joint: u8,
    },
    /// The motor is too strong or too weak compared with the preset's.
    #[error("joint {joint}: the motor's torque is more than two times off that which the device was built with")]
    Torque {
        /// Which.
        joint: u8,
    },
    /// The friction is negative, or so great that the joint would not be seen to follow its motor.
    #[error("joint {joint}: the dry friction is negative, or more than an eighth of the load of the maximum force")]
    Friction {
        /// Which.
        joint: u8,
    },
    /// The zero is that of another way of homing: of a pose, of a mark, or of none.
    #[error("joint {joint}: the stored zero uses another homing reference than this firmware; run commissioning again")]
    ZeroOf {
        /// Which.
        joint: u8,
    },
    /// Encoders and motors together would make the device stiffer than it may be.
    #[error(
        "with these scales the device could be stiffer than its limit; correct its file and build the firmware again"
    )]
    Stiffness,
    /// The same of its damping.
    #[error("with these scales the damping could exceed the device's; correct its file and build the firmware again")]
    Damping,
    /// A motor would give more force than the device may.
    #[error(
        "joint {joint}: with this torque the force could exceed the device's; correct its file and build the firmware again"
    )]
    Force {
        /// Which.
        joint: u8,
    },
}
