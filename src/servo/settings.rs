//! What a user chooses about the loop.

use crate::math::Vec3;
use thiserror::Error;

/// The loop's settings. Begin with [`Settings::DEFAULT`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Servo rate, Hz.
    pub rate_hz: f32,
    /// Stiffness of the surface, N/m.
    pub stiffness_n_per_m: f32,
    /// Damping of the surface, N·s/m.
    pub damping_n_s_per_m: f32,
    /// The greatest force, N. The device's own limit applies as well.
    pub max_force_n: f32,
    /// Corner frequency of the velocity filter, Hz.
    pub velocity_corner_hz: f32,
    /// Seconds over which the force is faded in after force was asked for.
    pub soft_start_s: f32,
    /// Where the origin of the body's tables lies in the device's frame, metres. Baked source says with `CENTRE` where
    /// that lies in the model.
    pub body_origin_m: Vec3,
}

/// Which setting is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SettingsError {
    /// The rate is not between 1 Hz and 100 kHz.
    #[error("the servo rate must be between 1 Hz and 100 kHz")]
    Rate,
    /// The stiffness is negative, not finite or above the device's.
    #[error("the stiffness must be between 0 and the device's maximum")]
    Stiffness,
    /// The damping is negative, not finite or above the device's.
    #[error("the damping must be between 0 and the device's maximum")]
    Damping,
    /// The greatest force is negative or not finite.
    #[error("the maximum force must be finite and not negative")]
    MaxForce,
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
    /// 1 kHz, a soft wall and little force, within what every device that ships takes; the body's origin in that of the
    /// device.
    pub const DEFAULT: Self = Self {
        rate_hz: 1_000.0,
        stiffness_n_per_m: 200.0,
        damping_n_s_per_m: 0.5,
        max_force_n: 1.0,
        velocity_corner_hz: 100.0,
        soft_start_s: 0.2,
        body_origin_m: Vec3::ZERO,
    };

    /// Checks the settings against a device's greatest stiffness (N/m) and damping (N·s/m).
    ///
    /// # Errors
    /// The first setting that is refused.
    pub const fn check(&self, max_stiffness: f32, max_damping: f32) -> Result<(), SettingsError> {
        if !within(self.rate_hz, 1.0, 100_000.0) {
            return Err(SettingsError::Rate);
        }
        if !within(self.stiffness_n_per_m, 0.0, max_stiffness) {
            return Err(SettingsError::Stiffness);
        }
        if !within(self.damping_n_s_per_m, 0.0, max_damping) {
            return Err(SettingsError::Damping);
        }
        if !within(self.max_force_n, 0.0, f32::MAX) {
            return Err(SettingsError::MaxForce);
        }
        if !within(self.velocity_corner_hz, f32::MIN_POSITIVE, f32::MAX) {
            return Err(SettingsError::VelocityCorner);
        }
        if !within(self.soft_start_s, 0.0, f32::MAX) {
            return Err(SettingsError::SoftStart);
        }
        let origin = self.body_origin_m;
        if !(origin.x.is_finite() && origin.y.is_finite() && origin.z.is_finite()) {
            return Err(SettingsError::BodyOrigin);
        }
        Ok(())
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Whether `low ≤ x ≤ high`; false for NaN.
const fn within(x: f32, low: f32, high: f32) -> bool {
    x >= low && x <= high
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::presets;

    #[test]
    fn the_default_is_taken_by_every_device_that_ships_and_what_no_loop_can_have_by_none() {
        let limits = [
            [presets::WOODEN_HAPTICS_2016.max_stiffness_n_per_m, presets::WOODEN_HAPTICS_2016.max_damping_n_s_per_m],
            [presets::POLHEM_V2.max_stiffness_n_per_m, presets::POLHEM_V2.max_damping_n_s_per_m],
            [presets::NOVINT_FALCON.max_stiffness_n_per_m, presets::NOVINT_FALCON.max_damping_n_s_per_m],
            [presets::HAPKIT.max_stiffness_n_per_m, presets::HAPKIT.max_damping_n_s_per_m],
            [presets::HAPLY_2DIY_V3.max_stiffness_n_per_m, presets::HAPLY_2DIY_V3.max_damping_n_s_per_m],
            [presets::HAPLY_KIT_V1.max_stiffness_n_per_m, presets::HAPLY_KIT_V1.max_damping_n_s_per_m],
            [presets::PHANTOM_PREMIUM.max_stiffness_n_per_m, presets::PHANTOM_PREMIUM.max_damping_n_s_per_m],
        ];
        for [max_stiffness, max_damping] in limits {
            assert_eq!(Settings::DEFAULT.check(max_stiffness, max_damping), Ok(()));
            for bad in [-1.0, f32::NAN, f32::INFINITY] {
                let spoilt = [
                    (Settings { rate_hz: bad, ..Settings::DEFAULT }, SettingsError::Rate),
                    (Settings { stiffness_n_per_m: bad, ..Settings::DEFAULT }, SettingsError::Stiffness),
                    (Settings { damping_n_s_per_m: bad, ..Settings::DEFAULT }, SettingsError::Damping),
                    (Settings { max_force_n: bad, ..Settings::DEFAULT }, SettingsError::MaxForce),
                    (Settings { velocity_corner_hz: bad, ..Settings::DEFAULT }, SettingsError::VelocityCorner),
                    (Settings { soft_start_s: bad, ..Settings::DEFAULT }, SettingsError::SoftStart),
                ];
                for (settings, error) in spoilt {
                    assert_eq!(settings.check(max_stiffness, max_damping), Err(error));
                }
            }
            let stiff = Settings { stiffness_n_per_m: max_stiffness * 1.001, ..Settings::DEFAULT };
            assert_eq!(stiff.check(max_stiffness, max_damping), Err(SettingsError::Stiffness));
            let damped = Settings { damping_n_s_per_m: max_damping * 1.001, ..Settings::DEFAULT };
            assert_eq!(damped.check(max_stiffness, max_damping), Err(SettingsError::Damping));
        }
        for (rate, good) in [(0.999, false), (1.0, true), (100_000.0, true), (100_100.0, false), (0.0, false)] {
            assert_eq!(Settings { rate_hz: rate, ..Settings::DEFAULT }.check(1e3, 1e1).is_ok(), good, "{rate} Hz");
        }
        let still = Settings { velocity_corner_hz: 0.0, ..Settings::DEFAULT };
        assert_eq!(still.check(1e3, 1e1), Err(SettingsError::VelocityCorner));
        for bad in [f32::NAN, f32::INFINITY] {
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let away = Settings { body_origin_m: axis * bad, ..Settings::DEFAULT };
                assert_eq!(away.check(1e3, 1e1), Err(SettingsError::BodyOrigin));
            }
        }
    }
}
