//! What a user chooses about the loop.

use crate::math::Vec3;
use thiserror::Error;

/// The loop's settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Servo rate, Hz.
    pub rate: f32,
    /// Stiffness of the surface, N/m.
    pub stiffness: f32,
    /// Damping of the surface, N·s/m.
    pub damping: f32,
    /// The greatest force, N. The device's own limit holds besides.
    pub greatest_force: f32,
    /// Corner frequency of the velocity filter, Hz.
    pub velocity_corner: f32,
    /// Seconds over which the force is faded in after force was asked for.
    pub soft_start: f32,
    /// Where the body's origin lies in the device's frame, metres.
    pub body_origin: Vec3,
}

/// Which setting is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SettingsError {
    /// The rate is not between 1 Hz and 100 kHz.
    #[error("the servo rate must be between 1 Hz and 100 kHz")]
    Rate,
    /// The stiffness is negative, not finite or above the device's.
    #[error("the stiffness must be between 0 and the device's greatest")]
    Stiffness,
    /// The damping is negative, not finite or above the device's.
    #[error("the damping must be between 0 and the device's greatest")]
    Damping,
    /// The greatest force is negative or not finite.
    #[error("the greatest force must be finite and not negative")]
    GreatestForce,
    /// The corner frequency is not positive and finite.
    #[error("the velocity corner must be positive and finite")]
    VelocityCorner,
    /// The soft start is negative or not finite.
    #[error("the soft start must be finite and not negative")]
    SoftStart,
    /// The body's origin is not finite.
    #[error("the body's origin must be finite")]
    BodyOrigin,
}

impl Settings {
    /// Checks the settings against a device's greatest stiffness (N/m) and damping (N·s/m).
    ///
    /// # Errors
    /// The first setting that is refused.
    pub const fn check(&self, greatest_stiffness: f32, greatest_damping: f32) -> Result<(), SettingsError> {
        if !within(self.rate, 1.0, 100_000.0) {
            return Err(SettingsError::Rate);
        }
        if !within(self.stiffness, 0.0, greatest_stiffness) {
            return Err(SettingsError::Stiffness);
        }
        if !within(self.damping, 0.0, greatest_damping) {
            return Err(SettingsError::Damping);
        }
        if !within(self.greatest_force, 0.0, f32::MAX) {
            return Err(SettingsError::GreatestForce);
        }
        if !within(self.velocity_corner, f32::MIN_POSITIVE, f32::MAX) {
            return Err(SettingsError::VelocityCorner);
        }
        if !within(self.soft_start, 0.0, f32::MAX) {
            return Err(SettingsError::SoftStart);
        }
        let origin = self.body_origin;
        if !(origin.x.is_finite() && origin.y.is_finite() && origin.z.is_finite()) {
            return Err(SettingsError::BodyOrigin);
        }
        Ok(())
    }
}

/// Whether `low ≤ x ≤ high`; false for NaN.
const fn within(x: f32, low: f32, high: f32) -> bool {
    x >= low && x <= high
}
