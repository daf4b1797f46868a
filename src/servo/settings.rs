//! The user's choices: settings, rendering and safety, each with the check that refuses a bad value.

use super::ContactLimits;
use crate::commission::Gains;
use crate::device::VelocityMethod;
use crate::math::Vec3;
use crate::render::{Coupling, Ease, Friction, Passivity, Penalty, Texture};

/// The loop's settings. Start with [`Settings::DEFAULT`]; [`SettingsError`] has the range of each.
///
/// ```
/// use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
/// use palpate::servo::{Settings, SettingsError};
///
/// let settings = Settings { rate_hz: 4_000.0, stiffness_n_per_m: 500.0, damping_n_s_per_m: 2.0, ..Settings::DEFAULT };
/// let check = |settings: Settings| settings.check(DEVICE.max_stiffness_n_per_m, DEVICE.max_damping_n_s_per_m);
/// assert_eq!(check(settings), Ok(()));
/// assert_eq!(check(Settings { stiffness_n_per_m: 10_000.0, ..settings }), Err(SettingsError::Stiffness));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Servo rate, Hz: 20 to 100,000.
    pub rate_hz: f32,
    /// Stiffness of the surface, N/m.
    pub stiffness_n_per_m: f32,
    /// Damping of the surface, N·s/m.
    pub damping_n_s_per_m: f32,
    /// Maximum force, N. The device's own limit applies as well.
    pub max_force_n: f32,
    /// Corner frequency of the velocity filter, Hz.
    pub velocity_corner_hz: f32,
    /// Seconds over which the force fades in after a request.
    pub soft_start_s: f32,
    /// The origin of the body's tables in the device's frame, metres. `CENTRE` in baked source is that origin in the
    /// model.
    pub body_origin_m: Vec3,
}

impl Settings {
    /// The maximum gains of a loop with these settings, if nothing changes them.
    pub const fn gains(&self) -> Gains {
        Gains {
            stiffness_n_per_m: self.stiffness_n_per_m,
            damping_n_s_per_m: self.damping_n_s_per_m,
            force_n: self.max_force_n,
        }
    }
}

/// Which setting is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SettingsError {
    /// The rate is not between 20 Hz and 100 kHz: 4.0 is no 4 kHz.
    Rate,
    /// The stiffness is negative, not finite or above the device's.
    Stiffness,
    /// The damping is negative, not finite or above the device's.
    Damping,
    /// The maximum force is negative or not finite.
    MaxForce,
    /// The corner frequency is not positive and finite.
    VelocityCorner,
    /// The soft start is negative or not finite.
    SoftStart,
    /// The body's origin is not finite.
    BodyOrigin,
}

impl SettingsError {
    /// The same as `Display`, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Rate => "the servo rate is in Hz and must be between 20 Hz and 100 kHz",
            Self::Stiffness => "the stiffness must be between 0 and the device's maximum",
            Self::Damping => "the damping must be between 0 and the device's maximum",
            Self::MaxForce => "the maximum force must be finite and not negative",
            Self::VelocityCorner => "the velocity corner must be positive and finite",
            Self::SoftStart => "the soft start must be finite and not negative",
            Self::BodyOrigin => "the body's origin must be finite",
        }
    }
}

crate::message::display!(SettingsError);

impl Settings {
    /// 1 kHz, a soft wall and little force, within the limits of every device that ships; the body's origin is the
    /// device's.
    pub const DEFAULT: Self = Self {
        rate_hz: 1_000.0,
        stiffness_n_per_m: 200.0,
        damping_n_s_per_m: 0.5,
        max_force_n: 1.0,
        velocity_corner_hz: 100.0,
        soft_start_s: 0.2,
        body_origin_m: Vec3::ZERO,
    };

    /// Checks the settings against a device's maximum stiffness (N/m) and damping (N·s/m).
    ///
    /// # Errors
    /// The first setting that is refused.
    pub const fn check(&self, max_stiffness: f32, max_damping: f32) -> Result<(), SettingsError> {
        if !within(self.rate_hz, 20.0, 100_000.0) {
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

impl Settings {
    /// The wall of these settings on a device of this maximum force, N.
    pub(super) const fn penalty(&self, device_force: f32) -> Penalty {
        let max_force_n = if self.max_force_n < device_force { self.max_force_n } else { device_force };
        let Self { stiffness_n_per_m, damping_n_s_per_m, .. } = *self;
        Penalty { stiffness_n_per_m, damping_n_s_per_m, max_force_n }
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

/// How the surface feels. Start with [`Rendering::PLAIN`].
///
/// ```
/// use palpate::render::Friction;
/// use palpate::servo::Rendering;
///
/// let friction = Friction {
///     stiffness_n_per_m: 500.0,
///     damping_n_s_per_m: 1.0,
///     static_coefficient: 0.4,
///     dynamic_coefficient: 0.3,
/// };
/// let rendering = Rendering { friction: Some(friction), ..Rendering::SMOOTH };
/// assert_eq!(rendering.check(500.0, 1.0 / 4_000.0), Ok(()));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Rendering {
    /// The velocity estimator.
    pub velocity: VelocityMethod,
    /// Dry friction of the surface.
    pub friction: Option<Friction>,
    /// Texture on top.
    pub texture: Option<Texture>,
    /// A virtual tool between probe and surface.
    pub coupling: Option<Coupling>,
    /// Passivity control.
    pub passivity: Option<Passivity>,
    /// Easing: prevents clicks of the force at contact and over edges. In a scene the damping of its bodies is there at
    /// once, and the settings' stiffness should be that of the stiffest body: easing limits a stiffer spring.
    pub ease: Option<Ease>,
    /// How fast the force may grow, N/s. It may always fall at once.
    pub max_slew_n_per_s: f32,
    /// Gravity compensation: whether the motors carry the weight of the device's own links, as far as its kinematics
    /// knows it.
    ///
    /// Its torques are added to those of the force, last before the gate, which serves them first. They fade in with
    /// the force: at the start the hand still supports the links, and a step would lift it. They are not part of
    /// [`super::ServoState::force`], and the maximum force, the slew limit and the passivity control exclude them: they
    /// are conservative, and return the energy that they took. At the rim of the workspace they stay. Without
    /// [`super::Phase::Running`], and so after any fault, they are zero.
    pub compensates_gravity: bool,
}

/// Which choice is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RenderingError {
    /// A parameter of the friction is negative or not finite, or slipping holds more than sticking.
    Friction,
    /// A number of the texture is out of range: [`Texture::is_valid`].
    Texture,
    /// The tool is too light for coupling and surface at this rate, or a parameter is negative or not finite.
    Coupling,
    /// A parameter of the passivity control is negative or not finite.
    Passivity,
    /// A parameter of the easing is negative or not finite, or its rate zero.
    Ease,
    /// The slew limit is not positive.
    Slew,
    /// Friction, texture or a virtual coupling with a tool that has a shape.
    ShapedTool,
}

impl RenderingError {
    /// The same as `Display`, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Friction => {
                "friction must be finite and not negative, its dynamic coefficient not above the static one"
            }
            Self::Texture => "a texture needs a share between 0 and 1, a pitch of 0.1 mm to 1 m and a unit direction",
            Self::Coupling => "the virtual tool is too light for its coupling and the surface at this rate",
            Self::Passivity => "passivity control's parameters must be finite and not negative",
            Self::Ease => "easing's onset must be finite and not negative, its rate finite and positive",
            Self::Slew => "the slew limit must be positive",
            Self::ShapedTool => {
                "friction, texture and virtual coupling are those of a point; leave them out with a tool that has a shape, whose \
                 friction is `ToolSurface::with_friction`"
            }
        }
    }
}

crate::message::display!(RenderingError);

impl Rendering {
    /// Spring and damper alone, low-pass velocity, no slew limit, the links' weight carried.
    pub const PLAIN: Self = Self {
        velocity: VelocityMethod::LowPass,
        friction: None,
        texture: None,
        coupling: None,
        passivity: None,
        ease: None,
        max_slew_n_per_s: f32::INFINITY,
        compensates_gravity: true,
    };

    /// As little to feel as there can be of counts, ticks and edges: position between counts, and [`Ease::SMOOTH`].
    /// Best with a velocity corner of 80 Hz and a wall of at most 500 N/m at 4 kHz ([`crate::render::Material`]): the
    /// position's delay costs stiffness.
    pub const SMOOTH: Self = Self { velocity: VelocityMethod::BetweenCounts, ..Self::EASED };

    /// For stiff walls: no clicks at contact and over edges, but the encoder's counts stay perceptible. It costs little
    /// stiffness, because nothing lags.
    pub const EASED: Self = Self { ease: Some(Ease::SMOOTH), ..Self::PLAIN };

    /// Checks the choices, for a surface's stiffness (N/m) and a period (s).
    ///
    /// # Errors
    /// The first that is refused.
    pub const fn check(&self, stiffness: f32, period: f32) -> Result<(), RenderingError> {
        if let Some(friction) = &self.friction
            && !friction.is_valid()
        {
            return Err(RenderingError::Friction);
        }
        if let Some(texture) = &self.texture
            && !texture.is_valid()
        {
            return Err(RenderingError::Texture);
        }
        if let Some(coupling) = &self.coupling
            && !coupling.is_valid(stiffness, period)
        {
            return Err(RenderingError::Coupling);
        }
        if let Some(passivity) = &self.passivity
            && !passivity.is_valid()
        {
            return Err(RenderingError::Passivity);
        }
        if let Some(ease) = &self.ease
            && !ease.is_valid()
        {
            return Err(RenderingError::Ease);
        }
        let grows = self.max_slew_n_per_s > 0.0;
        if grows { Ok(()) } else { Err(RenderingError::Slew) }
    }
}

impl Default for Rendering {
    fn default() -> Self {
        Self::PLAIN
    }
}

/// The motors' output from the tick in which a fault is detected.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SafeOutput {
    /// Nothing.
    Zero,
    /// They brake the probe with this damping, N·s/m, in every tick whose sensors are trusted. They give zero in all
    /// other ticks, after a fault of a drive, of the supply or of a polarity ([`super::Fault::leaves_damping`]), and
    /// while a polarity check has not confirmed all joints. Use it where the device would fall.
    Damping(f32),
}

/// When a joint sensor counts as stuck: the contact force loads its joint beyond dry friction, and its count stays the
/// same, while the other joints move the probe far.
///
/// A joint at rest under load proves nothing: the hand may hold it. But a hand that moves the probe by `travel_m`
/// meanwhile would have to balance the load on this joint to within its dry friction all the way, on the one curve on
/// which it does not turn. Below friction no hand is needed for that, so a smaller torque counts as no load.
///
/// The way is counted in straight pieces of a sixth of `travel_m`, forth or back, so that a small workspace has it too
/// and a count that flickers adds nothing. It takes the time of 40 mm/s at least, or 2 s: 0.75 s for 30 mm. Without load
/// the count pauses. A device with one joint has no others: this check never trips there. The probe and the joints take
/// turns, one per tick.
///
/// A slide along a wall may keep the joint that carries the depth where it is. A person's hand moves it all the same, for
/// its force varies by some percent within a second. Nothing tells a machine that holds the probe steadier than a count
/// from a stuck sensor: use `None` for it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct StuckLimits {
    /// Minimum load, as a multiple of the joint's [`crate::device::Device::dry_friction_n_m`]; at least 1.
    pub load: f32,
    /// Distance that the probe moves meanwhile, m.
    pub travel_m: f32,
}

impl StuckLimits {
    /// Five times dry friction, so that a hand would have to balance the load to a fifth of it, over 30 mm. Where
    /// simulated hands slide about under load, a Falcon's joint stays where it is over 50 mm under its own friction and
    /// over 28 mm under three times that, but never over 1 mm under five times; a joint of a device with little friction
    /// turns back while the probe goes on for 26 mm at most, of Polhem.
    pub const DEFAULT: Self = Self { load: 5.0, travel_m: 0.03 };
}

/// Limits and reactions of the loop. Start with [`Safety::DEFAULT`].
///
/// ```
/// use palpate::servo::{SafeOutput, Safety, SafetyError};
///
/// // For a device that would fall, with a host that must send a message every 50 ms.
/// let safety = Safety { output: SafeOutput::Damping(2.0), link_timeout_s: 0.05, ..Safety::DEFAULT };
/// assert_eq!(safety.check(8.0), Ok(()));
/// assert_eq!(safety.check(1.0), Err(SafetyError::Damping));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Safety {
    /// The motors' output after a fault.
    pub output: SafeOutput,
    /// How many ticks in a row may overrun before it is a fault.
    pub max_overruns: u32,
    /// Seconds of silence after which the host's link is lost; infinite where no host watches.
    pub link_timeout_s: f32,
    /// Ticks of believable sensors before the loop is armed.
    pub settle_ticks: u32,
    /// Whether the loop waits for [`super::Event::Homed`] before it is armed.
    pub wait_for_homing: bool,
    /// When a sensor counts as stuck; `None` does not watch.
    pub stuck: Option<StuckLimits>,
    /// When contact counts as lost; `None` does not watch.
    pub contact: Option<ContactLimits>,
    /// Whether tables that carry the CRC they were baked with are checked: whole before the first tick, and again and
    /// again after, a word every eighth tick; not while a guard withholds the force of a contact.
    pub checks_tables: bool,
}

/// Which limit is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SafetyError {
    /// The damping is negative, not finite or above the device's.
    Damping,
    /// The link's timeout is not above zero.
    LinkTimeout,
    /// The load is below dry friction, or the travel is not above zero.
    Stuck,
    /// The depth is not above that of the maximum force, or a time is negative or not finite.
    Contact,
}

impl SafetyError {
    /// The same as `Display`, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Damping => "the safe damping must be between 0 and the device's maximum",
            Self::LinkTimeout => "the link's timeout must be positive",
            Self::Stuck => "the load of a stuck sensor must be dry friction at least, and the travel positive",
            Self::Contact => {
                "contact limits must be deeper than the maximum force reaches, and their times not negative"
            }
        }
    }
}

crate::message::display!(SafetyError);

impl Safety {
    /// Zero output, no overrun allowed, no host, stuck sensors and lost contact watched for, tables checked.
    pub const DEFAULT: Self = Self {
        output: SafeOutput::Zero,
        max_overruns: 0,
        link_timeout_s: f32::INFINITY,
        settle_ticks: 1,
        wait_for_homing: false,
        stuck: Some(StuckLimits::DEFAULT),
        contact: Some(ContactLimits::DEFAULT),
        checks_tables: true,
    };

    /// Checks the limits against a device's maximum damping (N·s/m).
    ///
    /// # Errors
    /// The first that is refused.
    pub const fn check(&self, max_damping: f32) -> Result<(), SafetyError> {
        if let SafeOutput::Damping(damping) = self.output {
            let sensible = damping >= 0.0 && damping <= max_damping;
            if !sensible {
                return Err(SafetyError::Damping);
            }
        }
        let lasts = self.link_timeout_s > 0.0;
        if !lasts {
            return Err(SafetyError::LinkTimeout);
        }
        if let Some(StuckLimits { load, travel_m: travel }) = self.stuck {
            let sensible = load >= 1.0 && travel > 0.0;
            if !sensible {
                return Err(SafetyError::Stuck);
            }
        }
        if let Some(contact) = &self.contact
            && !contact.is_valid()
        {
            return Err(SafetyError::Contact);
        }
        Ok(())
    }
}

impl Default for Safety {
    fn default() -> Self {
        Self::DEFAULT
    }
}

#[cfg(test)]
mod settings_tests {
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
        for (rate, good) in
            [(4.0, false), (19.99, false), (20.0, true), (100_000.0, true), (100_100.0, false), (0.0, false)]
        {
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

#[cfg(test)]
mod rendering_tests {
    use super::*;
    use crate::math::Vec3;
    use crate::render::TextureShape;

    const STIFFNESS: f32 = 1_000.0;
    const PERIOD: f32 = 1e-3;
    const FRICTION: Friction = Friction {
        stiffness_n_per_m: 500.0,
        damping_n_s_per_m: 1.0,
        static_coefficient: 0.4,
        dynamic_coefficient: 0.3,
    };
    const COUPLING: Coupling = Coupling { stiffness_n_per_m: 500.0, damping_n_s_per_m: 3.0, mass_kg: 0.01 };
    const PASSIVITY: Passivity = Passivity {
        device_damping_n_s_per_m: 0.1,
        device_friction_n: 0.01,
        max_damping_n_s_per_m: 8.0,
        resolution_m: 1e-4,
    };

    fn refused(rendering: Rendering, error: RenderingError) {
        assert_eq!(rendering.check(STIFFNESS, PERIOD), Err(error), "{rendering:?}");
    }

    #[test]
    fn each_choice_that_cannot_be_felt_is_refused_by_its_name() {
        let texture = Texture { shape: TextureShape::Custom(|_| Vec3::ZERO), max_fraction: 1.0 };
        let all = Rendering {
            friction: Some(FRICTION),
            texture: Some(texture),
            coupling: Some(COUPLING),
            passivity: Some(PASSIVITY),
            max_slew_n_per_s: 100.0,
            ..Rendering::PLAIN
        };
        assert_eq!(Rendering::PLAIN.check(STIFFNESS, PERIOD), Ok(()));
        assert_eq!(all.check(STIFFNESS, PERIOD), Ok(()));
        for bad in [-1.0, f32::NAN, f32::INFINITY] {
            for friction in [
                Friction { stiffness_n_per_m: bad, ..FRICTION },
                Friction { damping_n_s_per_m: bad, ..FRICTION },
                Friction { static_coefficient: bad, ..FRICTION },
                Friction { dynamic_coefficient: bad, ..FRICTION },
            ] {
                refused(Rendering { friction: Some(friction), ..all }, RenderingError::Friction);
            }
            let coarse = Texture { max_fraction: bad, ..texture };
            refused(Rendering { texture: Some(coarse), ..all }, RenderingError::Texture);
            for coupling in [
                Coupling { stiffness_n_per_m: bad, ..COUPLING },
                Coupling { damping_n_s_per_m: bad, ..COUPLING },
                Coupling { mass_kg: bad, ..COUPLING },
            ] {
                refused(Rendering { coupling: Some(coupling), ..all }, RenderingError::Coupling);
            }
            for passivity in [
                Passivity { device_damping_n_s_per_m: bad, ..PASSIVITY },
                Passivity { device_friction_n: bad, ..PASSIVITY },
                Passivity { max_damping_n_s_per_m: bad, ..PASSIVITY },
                Passivity { resolution_m: bad, ..PASSIVITY },
            ] {
                refused(Rendering { passivity: Some(passivity), ..all }, RenderingError::Passivity);
            }
        }
        let hasty = Ease { change_n_per_s: 0.0, ..Ease::SMOOTH };
        refused(Rendering { ease: Some(hasty), ..all }, RenderingError::Ease);
        assert!([Rendering::SMOOTH, Rendering::EASED].iter().all(|kind| kind.check(STIFFNESS, PERIOD).is_ok()));
        // Slipping must not hold more than sticking.
        let sticky = Friction { dynamic_coefficient: 0.41, ..FRICTION };
        refused(Rendering { friction: Some(sticky), ..all }, RenderingError::Friction);
        let still = Passivity { resolution_m: 0.0, ..PASSIVITY };
        refused(Rendering { passivity: Some(still), ..all }, RenderingError::Passivity);
        refused(Rendering { texture: Some(Texture { max_fraction: 1.01, ..texture }), ..all }, RenderingError::Texture);
        // (500 + 1,000) N/m · 1 ms² < 2 m asks for 0.75 g.
        refused(
            Rendering { coupling: Some(Coupling { mass_kg: 7.4e-4, ..COUPLING }), ..all },
            RenderingError::Coupling,
        );
        let light = Rendering { coupling: Some(Coupling { mass_kg: 7.6e-4, ..COUPLING }), ..all };
        assert_eq!(light.check(STIFFNESS, PERIOD), Ok(()));
        for max_slew in [0.0, -1.0, f32::NAN] {
            refused(Rendering { max_slew_n_per_s: max_slew, ..all }, RenderingError::Slew);
        }
    }
}

#[cfg(test)]
mod safety_tests {
    use super::*;

    #[test]
    fn limits_that_protect_nobody_are_refused() {
        const MAX_DAMPING: f32 = 5.0;
        assert_eq!(Safety::DEFAULT.check(MAX_DAMPING), Ok(()));
        for (damping, good) in [(0.0, true), (5.0, true), (5.001, false), (-0.001, false), (f32::NAN, false)] {
            let safety = Safety { output: SafeOutput::Damping(damping), ..Safety::DEFAULT };
            assert_eq!(safety.check(MAX_DAMPING), if good { Ok(()) } else { Err(SafetyError::Damping) }, "{damping}");
        }
        for (link_timeout, good) in
            [(1e-3, true), (f32::INFINITY, true), (0.0, false), (-1.0, false), (f32::NAN, false)]
        {
            let safety = Safety { link_timeout_s: link_timeout, ..Safety::DEFAULT };
            assert_eq!(safety.check(MAX_DAMPING), if good { Ok(()) } else { Err(SafetyError::LinkTimeout) });
        }
        for (load, travel, good) in
            [(1.0, 0.1, true), (0.99, 0.1, false), (5.0, 0.0, false), (f32::NAN, 0.1, false), (5.0, f32::NAN, false)]
        {
            let safety = Safety { stuck: Some(StuckLimits { load, travel_m: travel }), ..Safety::DEFAULT };
            assert_eq!(
                safety.check(MAX_DAMPING),
                if good { Ok(()) } else { Err(SafetyError::Stuck) },
                "{load} {travel}"
            );
        }
        assert_eq!(Safety { stuck: None, ..Safety::DEFAULT }.check(MAX_DAMPING), Ok(()));
    }
}
