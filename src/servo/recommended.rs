//! Recommended settings of each device that ships, at 4 kHz, so that a hand feels the surface and not the loop.
//! Measured in simulation by `palpate feel`, which uses them by default.
//!
//! All have [`Rendering::SMOOTH`]: with a spring of 500 N/m a hand feels counts of 23 to 146 µm on every device whose
//! own friction does not hide them. The corner of 80 Hz is the fastest with which one count that a resting probe
//! crosses makes a damper of 2 N·s/m step by at most 50 mN on WoodenHaptics. Keep it at other rates: at 20 kHz a corner
//! of 400 Hz lets a hand feel a hum. The devices differ in stiffness: 500 N/m, whose spring alone steps by 38 mN in a
//! tick at 0.3 m/s, except where noted below.

use super::{Rendering, Settings};
use crate::device::{Device, presets};

/// Settings and rendering that go together.
///
/// ```
/// use palpate::device::presets::PHANTOM_PREMIUM as DEVICE;
/// use palpate::servo::recommended;
///
/// const TOUCH: recommended::Recommended = recommended::PHANTOM_PREMIUM;
/// assert!(TOUCH.settings.check(DEVICE.max_stiffness_n_per_m, DEVICE.max_damping_n_s_per_m).is_ok());
/// assert!(TOUCH.rendering.check(TOUCH.settings.stiffness_n_per_m, 1.0 / TOUCH.settings.rate_hz).is_ok());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Recommended {
    /// Rate, wall, maximum force and velocity corner; the body's origin is yours to set.
    pub settings: Settings,
    /// Filters and easing of the force.
    pub rendering: Rendering,
}

/// For a device of one's own: the wall of those that ship, or its own maximum where that is lower. Measure it with
/// `palpate feel --device my.toml`: a hand may feel coarse encoders or a heavy arm even so.
///
/// ```
/// use palpate::device::presets::HAPLY_KIT_V1 as MINE;
/// use palpate::servo::recommended;
///
/// let recommended = recommended::of(&MINE);
/// assert_eq!(recommended.settings.stiffness_n_per_m, MINE.max_stiffness_n_per_m);
/// assert_eq!(recommended.settings.max_force_n, MINE.max_force_n);
/// ```
pub const fn of<K, const JOINTS: usize>(device: &Device<K, JOINTS>) -> Recommended {
    wall(
        device.max_stiffness_n_per_m.min(STIFFNESS_N_PER_M),
        device.max_damping_n_s_per_m.min(DAMPING_N_S_PER_M),
        device.max_force_n,
    )
}

/// The recommended wall: N/m, and N·s/m.
const STIFFNESS_N_PER_M: f32 = 500.0;
const DAMPING_N_S_PER_M: f32 = 2.0;

/// A wall of a stiffness, N/m, and a damping, N·s/m, for a device with a maximum force, N.
const fn wall(stiffness: f32, damping: f32, max_force: f32) -> Recommended {
    Recommended {
        settings: Settings {
            rate_hz: 4_000.0,
            stiffness_n_per_m: stiffness,
            damping_n_s_per_m: damping,
            max_force_n: max_force,
            velocity_corner_hz: 80.0,
            soft_start_s: 0.1,
            ..Settings::DEFAULT
        },
        rendering: Rendering::SMOOTH,
    }
}

/// For [`presets::WOODEN_HAPTICS_2016`]. Without smoothing a hand feels its counts even at 200 N/m.
pub const WOODEN_HAPTICS_2016: Recommended = of(&presets::WOODEN_HAPTICS_2016);

/// For [`presets::POLHEM_V2`]. Its friction hides its counts: the smooth rendering is for contact and edges.
pub const POLHEM_V2: Recommended = of(&presets::POLHEM_V2);

/// For [`presets::PHANTOM_PREMIUM`]: softer, because the estimated position lags by a count where a joint turns back,
/// and its friction is too low to hide that: a hand just feels it at 500 N/m.
pub const PHANTOM_PREMIUM: Recommended = wall(400.0, 2.0, presets::PHANTOM_PREMIUM.max_force_n);

/// For [`presets::NOVINT_FALCON`]: softer, for its third of a kilogram swings ahead of a hand that draws it at 0.3 m/s
/// and comes to the wall at 0.41, where a spring of 500 N/m steps by 51 mN in a tick.
pub const NOVINT_FALCON: Recommended = wall(400.0, 2.0, presets::NOVINT_FALCON.max_force_n);

/// For [`presets::HAPLY_2DIY_V3`]: as stiff and as damped as the device is recommended for.
pub const HAPLY_2DIY_V3: Recommended = of(&presets::HAPLY_2DIY_V3);

/// For [`presets::HAPLY_KIT_V1`]: as stiff and as damped as the device is recommended for.
pub const HAPLY_KIT_V1: Recommended = of(&presets::HAPLY_KIT_V1);

/// For [`presets::HAPKIT`].
pub const HAPKIT: Recommended = of(&presets::HAPKIT);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_device_takes_what_is_recommended_for_it_and_no_spring_alone_steps_by_fifty_millinewtons() {
        macro_rules! taken {
            ($($name:ident),*) => { $({
                let (Recommended { settings, rendering }, device) = ($name, presets::$name);
                assert_eq!(settings.check(device.max_stiffness_n_per_m, device.max_damping_n_s_per_m), Ok(()));
                assert_eq!(rendering.check(settings.stiffness_n_per_m, 1.0 / settings.rate_hz), Ok(()));
                assert!(settings.max_force_n <= device.max_force_n);
                assert!(settings.stiffness_n_per_m * 0.3 / settings.rate_hz < 0.05);
            })* };
        }
        taken!(WOODEN_HAPTICS_2016, POLHEM_V2, PHANTOM_PREMIUM, NOVINT_FALCON, HAPLY_2DIY_V3, HAPLY_KIT_V1, HAPKIT);
    }
}
