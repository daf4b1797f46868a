//! The reference by which joints are homed.

use super::{FieldSearch, StopSearch};
use crate::device::Counts;

/// The reference: a pose, index marks, end stops or magnetic fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reference<const JOINTS: usize> {
    /// The hand holds the device still in a mechanical reference pose, at these joint angles, radians.
    Pose([f32; JOINTS]),
    /// As a pose, with absolute sensors that must read these counts there, within the tolerance: the counts stored at
    /// assembly detect a device that was put down or assembled wrongly.
    KnownPose {
        /// Joint angles at the pose, radians.
        angles: [f32; JOINTS],
        /// The sensors' counts in the pose.
        counts: [Counts; JOINTS],
        /// How far off they may be, counts.
        tolerance: u32,
    },
    /// Each joint passes its index mark once, at this joint angle, radians; the hand moves the device about meanwhile.
    Index([f32; JOINTS]),
    /// The motors drive one joint after the other to its end stop, while the others hang free.
    Stops([StopSearch; JOINTS]),
    /// The motors have three phases. Their fields lead one joint after the other: homing measures the alignment of each
    /// rotor, and from then on [`Homing::fields`](super::Homing::fields) gives the field's angle. The joints' angles
    /// stay those of the encoders.
    Fields([FieldSearch; JOINTS]),
}

/// The place where a joint's angle is its encoder's [`angle_at_zero_rad`](crate::device::Encoder::angle_at_zero_rad):
/// a number measured for one of them is not valid for another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ZeroOf {
    /// Count zero, of sensors that know it after each reset.
    #[default]
    Count,
    /// The pose in which the device is homed ([`Reference::Pose`]).
    Pose,
    /// The joint's index mark ([`Reference::Index`]).
    Mark,
}
