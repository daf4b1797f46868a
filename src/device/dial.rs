//! A dial: one joint that turns on and on.

use super::device_error::lengths;
use super::{CoggingMap, DeviceError, Kinematics, ProbePose};
use crate::math::vec3;

/// A dial on a motor's shaft, rendered at its rim.
///
/// Joint angle, radians: as the sensor has it. As with [`super::Paddle`] the probe's place is the arc length of the
/// rim, `x = r θ`, so that the device stays one-dimensional and turns differ; y and z stay zero.
///
/// ```
/// use core::f32::consts::TAU;
/// use palpate::device::{Dial, Kinematics as _};
///
/// let dial = Dial { radius_m: 0.02, cogging: None };
/// let after_two_turns = dial.pose([2.0 * TAU]).expect("always");
/// assert!((after_two_turns.position.x - 0.02 * 2.0 * TAU).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dial {
    /// Radius of the rim, where the fingers are, `r`, metres.
    pub radius_m: f32,
    /// Compensation of the motor's cogging.
    pub cogging: Option<CoggingMap>,
}

impl Dial {
    /// As [`Kinematics::check`], for constants.
    ///
    /// # Errors
    /// The first number that no such device has.
    pub const fn check(&self) -> Result<(), DeviceError> {
        lengths(&[("radius", self.radius_m)])
    }
}

impl Kinematics<1> for Dial {
    #[inline]
    fn pose(&self, [angle]: [f32; 1]) -> Option<ProbePose<1>> {
        Some(ProbePose { position: vec3(self.radius_m * angle, 0.0, 0.0), jacobian: [vec3(self.radius_m, 0.0, 0.0)] })
    }

    #[inline]
    fn held_pose(&self, [angle]: [f32; 1]) -> Option<(ProbePose<1>, [f32; 1])> {
        let torque = match &self.cogging {
            Some(map) => map.torque(angle),
            None => 0.0,
        };
        Some((self.pose([angle])?, [torque]))
    }

    fn check(&self, _: [f32; 1]) -> Result<(), DeviceError> {
        Self::check(self)
    }
}
