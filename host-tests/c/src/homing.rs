//! How a loop finds out where its joints are, as numbers.

use crate::pointers::{Plain, flag};
use crate::status::Status;
use palpate_core::device::{Encoder, Homing, Reference, StopSearch};

/// A joint's reference; all but its angle for its stop alone.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct ReferenceNumbers {
    pub angle: f32,
    pub speed: f32,
    pub torque: f32,
    pub clearance: f32,
    pub travel: f32,
}

/// How joint angles are found; joints that a device does not have are not looked at.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct HomingNumbers {
    pub by: u32,
    pub still_ticks: u32,
    pub still_counts: u32,
    pub timeout_ticks: u32,
    pub when_asked: u32,
    pub joints: [ReferenceNumbers; 3],
}

// SAFETY: numbers alone.
unsafe impl Plain for HomingNumbers {}

impl HomingNumbers {
    /// The homing of a device with these encoders.
    pub fn homing<const JOINTS: usize>(&self, encoders: [Encoder; JOINTS]) -> Result<Homing<JOINTS>, Status> {
        let mut angles = [0.0; JOINTS];
        let mut stops =
            [StopSearch { angle_rad: 0.0, speed_rad_per_s: 0.0, torque_n_m: 0.0, clearance_rad: 0.0, travel_rad: 0.0 };
                JOINTS];
        // No device has more than three joints: the numbers reach.
        for ((angle, stop), given) in angles.iter_mut().zip(&mut stops).zip(&self.joints) {
            let ReferenceNumbers { angle: at, speed, torque, clearance, travel } = *given;
            *angle = at;
            *stop = StopSearch {
                angle_rad: at,
                speed_rad_per_s: speed,
                torque_n_m: torque,
                clearance_rad: clearance,
                travel_rad: travel,
            };
        }
        let reference = match self.by {
            1 => Reference::Pose(angles),
            2 => Reference::Index(angles),
            3 => Reference::Stops(stops),
            _ => return Err(Status::OutOfRange),
        };
        let homing = Homing::try_new(encoders, reference, self.still_ticks, self.still_counts, self.timeout_ticks)?;
        Ok(if flag(self.when_asked)? { homing.when_asked() } else { homing })
    }
}
