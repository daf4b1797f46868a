//! The one-joint paddle of the Hapkit kind.

use super::device_error::{all_of, lengths, weights};
use super::{DeviceError, GRAVITY, Kinematics, ProbePose};
use crate::math::{sin_cos, vec3};

/// A handle on one axis.
///
/// Joint angle, radians: zero with the handle upright, positive towards x. The probe's place is the arc the handle has
/// gone, as such devices are programmed: `x = r θ`, so that one dimension stays one. The frame's x axis points the way
/// the handle goes; y and z stay zero.
///
/// ```
/// use palpate::device::{Kinematics as _, Paddle};
///
/// let paddle = Paddle { handle_m: 0.07, mass_moment_kg_m: 0.0 };
/// let pose = paddle.pose([0.1]).expect("always");
/// assert!((pose.position.x - 0.007).abs() < 1e-7);
/// // 2 N at the handle.
/// let [torque] = pose.torques(palpate::math::vec3(2.0, 0.0, 0.0));
/// assert!((torque - 0.14).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paddle {
    /// From the axis to the hand, `r`, metres.
    pub handle_m: f32,
    /// Mass of the paddle times the height of its centre over the axis, kg·m; zero if it is balanced or not known.
    pub mass_moment_kg_m: f32,
}

impl Paddle {
    /// As [`Kinematics::check`], for constants.
    ///
    /// # Errors
    /// The first number that no such device has.
    pub const fn check(&self, holds_n_m: [f32; 1]) -> Result<(), DeviceError> {
        all_of!(lengths(&[("handle", self.handle_m)]), weights([self.mass_moment_kg_m], holds_n_m))
    }
}

impl Kinematics<1> for Paddle {
    #[inline]
    fn pose(&self, [angle]: [f32; 1]) -> Option<ProbePose<1>> {
        Some(ProbePose { position: vec3(self.handle_m * angle, 0.0, 0.0), jacobian: [vec3(self.handle_m, 0.0, 0.0)] })
    }

    #[inline]
    fn held_pose(&self, [angle]: [f32; 1]) -> Option<(ProbePose<1>, [f32; 1])> {
        // The weight tips the paddle over; the torque that holds it goes the other way.
        let torque =
            if self.mass_moment_kg_m == 0.0 { 0.0 } else { -GRAVITY * self.mass_moment_kg_m * sin_cos(angle).0 };
        Some((self.pose([angle])?, [torque]))
    }

    fn check(&self, holds_n_m: [f32; 1]) -> Result<(), DeviceError> {
        Self::check(self, holds_n_m)
    }
}
