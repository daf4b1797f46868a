//! The loop's configuration, checked when it is built, and the state it starts from.

use super::contact::{ContactWatch, LostContact};
use super::state::{ContactState, DriveState, Faults, Readiness, Sensors};
use super::{
    Event, Fault, Guard, Guarded, Input, Output, Phase, ProtectionError, Rendering, RenderingError, ResetReason,
    Safety, SafetyError, ServoState, Settings, SettingsError, Stillness, Surface, TableCheck, Unguarded,
};
use crate::device::drive::Supply;
use crate::device::{
    Device, DeviceError, Duty, Homing, HomingState, Kinematics, Protection, VelocityEstimator, ZeroOf,
};
use crate::math::Vec3;
use crate::render::{Anchor, Eased, Energy, Penalty, Tool};
use crate::track::Controller;
use thiserror::Error;

/// Everything a user chooses of a loop, as one literal.
///
/// ```
/// use palpate::servo::{Config, Rendering, SafeOutput, Safety, Settings};
///
/// const CONFIG: Config<3> = Config {
///     settings: Settings { rate_hz: 4_000.0, stiffness_n_per_m: 800.0, ..Settings::DEFAULT },
///     rendering: Rendering::SMOOTH,
///     safety: Safety { output: SafeOutput::Damping(2.0), ..Safety::DEFAULT },
///     ..Config::DEFAULT
/// };
/// # let _ = CONFIG;
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Config<const JOINTS: usize> {
    /// The tracker's control law.
    pub controller: Controller,
    /// Rate, wall, maximum force, and where the body is.
    pub settings: Settings,
    /// How the surface feels.
    pub rendering: Rendering,
    /// Limits and reactions.
    pub safety: Safety,
    /// How the loop finds the joints' angles in [`Phase::Calibrate`]; `None` where counts are angles after each reset.
    ///
    /// Joint angles are untrusted until homing finishes: ranges are not checked, there is no pose, and only homing
    /// drives the motors, within its torque and speed and only while enable is held. A refusal is
    /// [`super::Fault::Homing`]; [`ServoState::homing`] has the reason.
    pub homing: Option<Homing<JOINTS>>,
}

impl<const JOINTS: usize> Config<JOINTS> {
    /// [`Settings::DEFAULT`], [`Rendering::PLAIN`], [`Safety::DEFAULT`], no homing.
    pub const DEFAULT: Self = Self {
        controller: Controller::SecondOrder,
        settings: Settings::DEFAULT,
        rendering: Rendering::PLAIN,
        safety: Safety::DEFAULT,
        homing: None,
    };
}

impl<const JOINTS: usize> Default for Config<JOINTS> {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Which part of a configuration is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ConfigError {
    /// A constant of the device ([`Device::check`]).
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A setting.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A choice of the rendering.
    #[error(transparent)]
    Rendering(#[from] RenderingError),
    /// A limit.
    #[error(transparent)]
    Safety(#[from] SafetyError),
    /// A number of the protection.
    #[error(transparent)]
    Protection(#[from] ProtectionError),
}

impl ConfigError {
    /// The same as `Display`, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Device(error) => error.message(),
            Self::Settings(error) => error.message(),
            Self::Rendering(error) => error.message(),
            Self::Safety(error) => error.message(),
            Self::Protection(error) => error.message(),
        }
    }
}

/// A loop, so that an application names its types by one alias.
///
/// ```
/// use palpate::device::{SerialArm, presets::WOODEN_HAPTICS_2016 as DEVICE};
/// use palpate::patch::SplinePatch;
/// use palpate::servo::{Input, Loop, Output, Servo, State};
///
/// type App = Servo<'static, SplinePatch<'static>, SerialArm, 3>;
///
/// /// The timer's interrupt.
/// fn on_timer(servo: &App, state: &mut State<App>, input: Input<3>) -> Output<3> {
///     servo.tick(state, input)
/// }
/// # let _ = (on_timer, DEVICE);
/// ```
pub trait Loop {
    /// The input of a tick.
    type Input;
    /// The drive commands: the result of a tick.
    type Output;
    /// Everything that changes from tick to tick.
    type State: Copy;

    /// The state before the first tick after power-on.
    fn start(&self) -> Self::State {
        self.start_after(ResetReason::PowerOn)
    }

    /// The state before the first tick after a reset.
    fn start_after(&self, reset: ResetReason) -> Self::State;

    /// Takes note of an event outside a tick, between two ticks.
    fn note(&self, state: &mut Self::State, event: Event);

    /// One tick.
    fn tick(&self, state: &mut Self::State, input: Self::Input) -> Self::Output;
}

/// The state of a loop.
pub type State<L> = <L as Loop>::State;

impl<S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Loop for Servo<'_, S, K, JOINTS, G> {
    type Input = Input<JOINTS>;
    type Output = Output<JOINTS>;
    type State = ServoState<JOINTS, S::Witness, G::State>;

    fn start_after(&self, reset: ResetReason) -> Self::State {
        Self::start_after(self, reset)
    }

    fn note(&self, state: &mut Self::State, event: Event) {
        Self::note(self, state, event);
    }

    #[inline]
    fn tick(&self, state: &mut Self::State, input: Input<JOINTS>) -> Output<JOINTS> {
        Self::tick(self, state, input)
    }
}

/// The servo loop: device, surface and configuration, checked. Constant, in flash. `G` is its guard beyond the loop's
/// own checks: [`Unguarded`] from [`Self::new`], [`Guarded`] from [`Self::protected`].
///
/// ```
/// use palpate::device::{Counts, SerialArm, presets::WOODEN_HAPTICS_2016 as DEVICE};
/// use palpate::patch::SplinePatch;
/// use palpate::servo::{Config, Input, Output, Phase, Servo, Settings};
/// # use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplineTable};
/// # static WALL: SplinePatch = SplineTable {
/// #     degree: [1, 1],
/// #     breaks_u: &[0.0, 1.0],
/// #     breaks_v: &[0.0, 1.0],
/// #     coefficients: Coefficients::Polynomial(&[[0.0; 3], [0.0, 0.2, 0.0], [0.2, 0.0, 0.0], [0.0; 3]]),
/// #     shape: ShapeBounds::unknown(SecondDerivativeBounds::ZERO),
/// #     orientation: Orientation::Outward,
/// #     size_m: 0.2,
/// #     crc: None,
/// # }
/// # .checked();
/// static SERVO: Servo<SplinePatch, SerialArm, 3> =
///     Servo::new(&DEVICE, &WALL, Config { settings: Settings::DEFAULT, ..Config::DEFAULT });
///
/// let mut state = SERVO.start();
/// for _ in 0..10 {
///     match SERVO.tick(&mut state, Input::Sensors { counts: [Counts(0); 3], enable: true }) {
///         Output::Off => { /* disable the stages */ }
///         Output::Drive(_duties) => { /* write the duties, enable the stages */ }
///     }
/// }
/// assert_eq!(state.phase(), Phase::Running);
/// ```
#[derive(Debug)]
pub struct Servo<'a, S, K, const JOINTS: usize, G = Unguarded> {
    pub(super) core: Core<'a, S, K, JOINTS>,
    pub(super) guard: G,
}

/// The configuration as the tick needs it.
#[derive(Debug)]
pub(super) struct Core<'a, S, K, const JOINTS: usize> {
    pub device: &'a Device<K, JOINTS>,
    pub surface: &'a S,
    pub controller: Controller,
    pub penalty: Penalty,
    pub estimators: [VelocityEstimator; JOINTS],
    pub rendering: Rendering,
    pub safety: Safety,
    pub homing: Option<Homing<JOINTS>>,
    pub settings: Settings,
    pub rate: f32,
    pub period: f32,
    pub max_move: f32,
    /// Counts of a turn of an only joint that turns without end ([`Device::endless`]).
    pub per_turn: Option<i32>,
    pub max_growth: f32,
    pub eased: Option<Eased>,
    pub fade_step: f32,
    pub link_ticks: u32,
    pub contact_watch: ContactWatch,
}

// Manual impls: `derive` would require `S: Copy` and `K: Copy`.
impl<S, K, const JOINTS: usize> Clone for Core<'_, S, K, JOINTS> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, K, const JOINTS: usize> Copy for Core<'_, S, K, JOINTS> {}

impl<S, K, const JOINTS: usize, G: Copy> Clone for Servo<'_, S, K, JOINTS, G> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, K, const JOINTS: usize, G: Copy> Copy for Servo<'_, S, K, JOINTS, G> {}

impl<'a, S: Surface, K, const JOINTS: usize> Core<'a, S, K, JOINTS> {
    const fn try_new(
        device: &'a Device<K, JOINTS>,
        surface: &'a S,
        config: Config<JOINTS>,
    ) -> Result<Self, ConfigError> {
        const { assert!(JOINTS >= 1 && JOINTS <= 3, "a device has one to three joints") };
        if let Err(error) = device.check() {
            return Err(ConfigError::Device(error));
        }
        if let Err(error) = check::<S, K, JOINTS>(device, &config) {
            return Err(error);
        }
        let Config { controller, settings, rendering, safety, homing } = config;
        let rate = settings.rate_hz;
        let period = 1.0 / rate;
        let penalty = settings.penalty(device.max_force_n);
        Ok(Self {
            device,
            surface,
            controller,
            penalty,
            estimators: estimators(device, &settings, &rendering),
            rendering,
            safety,
            homing,
            settings,
            rate,
            period,
            max_move: device.max_joint_rate_rad_per_s * period,
            per_turn: device.endless(),
            max_growth: rendering.max_slew_n_per_s * period,
            eased: eased(&rendering, &penalty, period),
            // A fade no longer than a tick is no fade.
            fade_step: if settings.soft_start_s > period { period / settings.soft_start_s } else { 1.0 },
            // The cast saturates: ∞ is 2³² ticks, which is never.
            link_ticks: (safety.link_timeout_s * rate) as u32,
            contact_watch: ContactWatch::new(safety.contact, &penalty, rate),
        })
    }

    /// Other gains: all numbers that follow from them, as [`Self::try_new`] has them.
    pub(super) fn retune(&mut self, settings: Settings, penalty: Penalty) {
        self.settings = settings;
        self.penalty = penalty;
        self.eased = eased(&self.rendering, &penalty, self.period);
        self.contact_watch = ContactWatch::new(self.safety.contact, &penalty, self.rate);
    }
}

/// Checks a configuration for a device.
pub(super) const fn check<S: Surface, K, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    config: &Config<JOINTS>,
) -> Result<(), ConfigError> {
    let Config { settings, rendering, safety, .. } = config;
    if let Err(error) = settings.check(device.max_stiffness_n_per_m, device.max_damping_n_s_per_m) {
        return Err(ConfigError::Settings(error));
    }
    if let Err(error) = rendering.check(settings.stiffness_n_per_m, 1.0 / settings.rate_hz) {
        return Err(ConfigError::Rendering(error));
    }
    let is_of_a_point = rendering.friction.is_some() || rendering.texture.is_some() || rendering.coupling.is_some();
    if S::HAS_SHAPED_TOOL && is_of_a_point {
        return Err(ConfigError::Rendering(RenderingError::ShapedTool));
    }
    if let Err(error) = safety.check(device.max_damping_n_s_per_m) {
        return Err(ConfigError::Safety(error));
    }
    Ok(())
}

const fn estimators<K, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    settings: &Settings,
    rendering: &Rendering,
) -> [VelocityEstimator; JOINTS] {
    let mut estimators = [VelocityEstimator::new(rendering.velocity, 1.0, 1.0, 0.0); JOINTS];
    let mut joint = 0;
    while joint < JOINTS {
        let count = device.encoders[joint].radians_per_count;
        estimators[joint] =
            VelocityEstimator::new(rendering.velocity, settings.velocity_corner_hz, settings.rate_hz, count);
        joint += 1;
    }
    estimators
}

const fn eased(rendering: &Rendering, penalty: &Penalty, period: f32) -> Option<Eased> {
    match rendering.ease {
        Some(ease) => Some(Eased::new(ease, penalty, period)),
        None => None,
    }
}

impl<'a, S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize> Servo<'a, S, K, JOINTS> {
    /// The loop of a device on a surface. Its motors are not protected beyond the loop's own checks: see
    /// [`Self::protected`].
    ///
    /// A device has one to three joints: with more it does not compile, for a force in space does not say how they
    /// share it.
    ///
    /// ```compile_fail
    /// # use palpate::{device::{Device, Kinematics, ProbePose}, patch::SplinePatch, servo::{Config, Servo}};
    /// fn four_joints<K: Kinematics<4>>(device: &Device<K, 4>, patch: &SplinePatch) {
    ///     let _ = Servo::try_new(device, patch, Config::DEFAULT);
    /// }
    /// # struct Snake;
    /// # impl Kinematics<4> for Snake { fn pose(&self, _: [f32; 4]) -> Option<ProbePose<4>> { None } }
    /// # fn main() { let make: fn(&Device<Snake, 4>, &SplinePatch) = four_joints; let _ = make; }
    /// ```
    ///
    /// # Errors
    /// The constant of the device, or the part of the configuration, that is refused.
    pub const fn try_new(
        device: &'a Device<K, JOINTS>,
        surface: &'a S,
        config: Config<JOINTS>,
    ) -> Result<Self, ConfigError> {
        match Core::try_new(device, surface, config) {
            Ok(core) => Ok(Self { core, guard: Unguarded }),
            Err(error) => Err(error),
        }
    }

    /// [`Self::try_new`] for a `static`: a refused device or configuration does not compile.
    ///
    /// # Panics
    /// At compile time, naming the value.
    pub const fn new(device: &'a Device<K, JOINTS>, surface: &'a S, config: Config<JOINTS>) -> Self {
        match Self::try_new(device, surface, config) {
            Ok(servo) => servo,
            Err(error) => panic!("{}", error.message()),
        }
    }
}

impl<'a, S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize> Servo<'a, S, K, JOINTS, Guarded<JOINTS>> {
    /// The loop of a device whose motors are protected: heat, speeds, supply, polarity.
    ///
    /// ```
    /// use palpate::device::presets::{WOODEN_HAPTICS_2016 as DEVICE, WOODEN_HAPTICS_2016_PROTECTION as PROTECTION};
    /// use palpate::device::SerialArm;
    /// use palpate::patch::SplinePatch;
    /// use palpate::servo::{Config, ConfigError, Guarded, Servo};
    ///
    /// fn arm(patch: &SplinePatch) -> Result<(), ConfigError> {
    ///     let _servo: Servo<SplinePatch, SerialArm, 3, Guarded<3>> =
    ///         Servo::try_protected(&DEVICE, patch, PROTECTION, Config::DEFAULT)?;
    ///     Ok(())
    /// }
    /// # let _ = arm;
    /// ```
    ///
    /// # Errors
    /// The constant of the device, or the part of the configuration, that is refused.
    pub const fn try_protected(
        device: &'a Device<K, JOINTS>,
        surface: &'a S,
        protection: Protection<JOINTS>,
        config: Config<JOINTS>,
    ) -> Result<Self, ConfigError> {
        let core = match Core::try_new(device, surface, config) {
            Ok(core) => core,
            Err(error) => return Err(error),
        };
        let (wall, max_depth) = (&core.penalty, core.contact_watch.max_depth);
        match Guarded::try_new(
            protection,
            &device.motors,
            &device.encoders,
            device.dry_friction_n_m,
            core.rate,
            wall,
            max_depth,
        ) {
            Ok(guard) => Ok(Self { core, guard }),
            Err(error) => Err(ConfigError::Protection(error)),
        }
    }

    /// [`Self::try_protected`] for a `static`: a refused device or configuration does not compile.
    ///
    /// # Panics
    /// At compile time, naming the value.
    pub const fn protected(
        device: &'a Device<K, JOINTS>,
        surface: &'a S,
        protection: Protection<JOINTS>,
        config: Config<JOINTS>,
    ) -> Self {
        match Self::try_protected(device, surface, protection, config) {
            Ok(servo) => servo,
            Err(error) => panic!("{}", error.message()),
        }
    }
}

impl<'a, S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Servo<'a, S, K, JOINTS, G> {
    /// The guard beyond the loop's own checks.
    pub const fn guard(&self) -> &G {
        &self.guard
    }

    /// The configuration it was made with.
    pub const fn config(&self) -> Config<JOINTS> {
        let Core { controller, settings, rendering, safety, homing, .. } = self.core;
        Config { controller, settings, rendering, safety, homing }
    }

    /// The reference of the encoders' zeroes for this loop's homing; `None` where homing finds it each time.
    pub const fn zero_of(&self) -> Option<ZeroOf> {
        match &self.core.homing {
            Some(homing) => homing.zero_of(),
            None => Some(ZeroOf::Count),
        }
    }

    /// Whether silence of the host is a fault ([`Safety::link_timeout_s`]).
    pub const fn watches_link(&self) -> bool {
        self.core.link_ticks < u32::MAX
    }

    /// The same loop with this homing: for a loop whose homing is chosen at run time. Restart its state.
    #[must_use]
    pub const fn with_homing(mut self, homing: Homing<JOINTS>) -> Self {
        self.core.homing = Some(homing);
        self
    }

    /// The same loop on the same device with the values that commissioning found ([`Device::calibrated`]): its encoders,
    /// motors and friction replace those that the loop was made with, also in homing and in the guard.
    #[must_use]
    pub fn calibrated<'b>(self, device: &'b Device<K, JOINTS>) -> Servo<'b, S, K, JOINTS, G>
    where
        'a: 'b,
    {
        let guard = self.guard.of_joints(&device.motors, &device.encoders, &device.dry_friction_n_m);
        let core = self.core;
        let homing = core.homing.map(|homing| homing.of_encoders(device.encoders));
        let estimators = estimators(device, &core.settings, &core.rendering);
        Servo { core: Core { device, homing, estimators, ..core }, guard }
    }

    /// The state before the first tick after power-on: motors at zero, the witness point at rest.
    pub fn start(&self) -> ServoState<JOINTS, S::Witness, G::State> {
        self.start_after(ResetReason::PowerOn)
    }

    /// The state before the first tick after a reset. A reset by the watchdog or a brown-out is a fault from the start,
    /// and so are a surface for another rate ([`Surface::is_for`]) and tables that are not those that were baked
    /// ([`Safety::checks_tables`]): they are read whole here.
    pub fn start_after(&self, reset: ResetReason) -> ServoState<JOINTS, S::Witness, G::State> {
        let core = &self.core;
        let mut table_check = TableCheck::default();
        let is_good = self.expected_crc().is_none_or(|expected| table_check.run(core.surface, expected));
        let of_surface = if !core.surface.is_for(core.period) {
            Some(Fault::OtherRate)
        } else if is_good {
            None
        } else {
            Some(Fault::TableCorrupt)
        };
        // That of the reset can be acknowledged: the other one then stands.
        let fault = reset.fault().or(of_surface);
        ServoState {
            phase: if fault.is_some() { Phase::Fault } else { Phase::Reset },
            ticks: 0,
            sensors: Sensors {
                counts: None,
                angles: [0.0; JOINTS],
                rates: [0.0; JOINTS],
                lags: [0.0; JOINTS],
                angles_at_zero: core.device.encoders.map(|encoder| encoder.angle_at_zero_rad),
                turns: 0,
                stillness: Stillness::START,
                frames_lost: 0,
            },
            faults: Faults {
                first: fault.map(|fault| (fault, 0)),
                later: of_surface.filter(|_| reset.fault().is_some()),
                reset,
                overruns: 0,
                overruns_in_a_row: 0,
                overran: false,
                link_silence: 0,
                table_check,
            },
            readiness: Readiness {
                settled: 0,
                homed: !core.safety.wait_for_homing && core.homing.is_none(),
                homing: HomingState::default(),
            },
            contact: ContactState {
                probe: Vec3::ZERO,
                tool: Tool::default(),
                witness: core.surface.rest(),
                anchor: Anchor::default(),
                lost: LostContact::default(),
                is_too_deep: false,
                rejected_steps: 0,
            },
            drive: DriveState {
                force: Vec3::ZERO,
                fade: 0.0,
                margin: 1.0,
                energy: Energy::default(),
                drives: false,
                duties: [Duty::ZERO; JOINTS],
                supply: Supply::UNMEASURED,
            },
            guard: self.guard.start(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
    use crate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};
    use crate::servo::ContactLimits;

    static WALL: SplinePatch = SplineTable {
        degree: [1, 1],
        breaks_u: &[0.0, 1.0],
        breaks_v: &[0.0, 1.0],
        coefficients: Coefficients::Polynomial(&[[0.0, 0.0, 0.0], [0.0, 0.2, 0.0], [0.2, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        shape: ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 }),
        orientation: Orientation::Outward,
        size_m: 0.2,
        crc: None,
    }
    .checked();

    #[test]
    fn settings_become_what_the_tick_needs() {
        let with = |max_force, stiffness| {
            let settings = Settings {
                rate_hz: 4_000.0,
                max_force_n: max_force,
                stiffness_n_per_m: stiffness,
                ..Settings::DEFAULT
            };
            Servo::try_new(&DEVICE, &WALL, Config { settings, ..Config::DEFAULT }).unwrap().core
        };
        assert_eq!(with(1.0, 20.0).penalty.max_force_n, 1.0);
        // No more than the device allows.
        assert_eq!(with(1_000.0, 20.0).penalty.max_force_n, DEVICE.max_force_n);
        // 1 N at 20 N/m is 5 cm deep: contact is released at twice that.
        assert_eq!(with(1.0, 20.0).contact_watch.max_depth, 0.1);
        let limits = ContactLimits { depth: 4.0, ..ContactLimits::DEFAULT };
        let safety = Safety { link_timeout_s: 0.05, contact: Some(limits), ..Safety::DEFAULT };
        let settings = with(1.0, 20.0).settings;
        let careful = Servo::try_new(&DEVICE, &WALL, Config { settings, safety, ..Config::DEFAULT }).unwrap().core;
        assert_eq!((careful.link_ticks, careful.contact_watch.max_depth), (200, 0.2));
    }

    #[test]
    fn a_device_read_at_run_time_is_checked_as_a_constant_one_is() {
        let mut device = DEVICE;
        device.encoders[1].radians_per_count = 0.0;
        let refused = Some(ConfigError::Device(DeviceError::Encoder(1)));
        assert_eq!(Servo::try_new(&device, &WALL, Config::DEFAULT).err(), refused);
        let protection = crate::device::presets::WOODEN_HAPTICS_2016_PROTECTION;
        assert_eq!(Servo::try_protected(&device, &WALL, protection, Config::DEFAULT).err(), refused);
        // In mm/s, and in rpm.
        let in_mm = Protection { max_probe_speed_m_per_s: 1500.0, ..protection };
        let in_rpm = Protection { max_joint_rates_rad_per_s: [3000.0; 3], ..protection };
        for wrong in [in_mm, in_rpm] {
            let refused = Some(ConfigError::Protection(ProtectionError::Speed));
            assert_eq!(Servo::try_protected(&DEVICE, &WALL, wrong, Config::DEFAULT).err(), refused);
        }
    }
}
