//! Gains that are changed while the loop runs: checked when they are requested, and approached over many ticks.

use super::config::check;
use super::{
    Config, ConfigError, Event, Guard, Input, Loop, Output, ResetReason, Servo, ServoState, Settings, Surface,
};
use crate::device::Kinematics;
use crate::math::saturate;
use crate::render::Penalty;
use crate::servo::Unguarded;
use crate::track::Contact;
use core::ops::{Deref, DerefMut};

/// Minimum duration of a change, s: longer than the reflexes of an arm, some 0.05 s, so that a hand in the wall follows
/// the change and is not thrown by it.
const MIN_RAMP_S: f32 = 0.1;
/// Minimum duration of a change, ticks, for loops below 1 kHz.
const MIN_RAMP_TICKS: f32 = 100.0;

/// The gains that can be changed between two ticks ([`TunableState::request`]): those of the same names in [`Settings`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tuning {
    /// Stiffness of the surface, N/m.
    pub stiffness_n_per_m: f32,
    /// Damping of the surface, N·s/m.
    pub damping_n_s_per_m: f32,
    /// Maximum force, N. The device's own limit applies as well.
    pub max_force_n: f32,
}

impl Tuning {
    /// The gains of these settings.
    pub const fn of(settings: &Settings) -> Self {
        let Settings { stiffness_n_per_m, damping_n_s_per_m, max_force_n, .. } = *settings;
        Self { stiffness_n_per_m, damping_n_s_per_m, max_force_n }
    }

    /// These settings with other gains.
    const fn on(self, settings: Settings) -> Settings {
        let Self { stiffness_n_per_m, damping_n_s_per_m, max_force_n } = self;
        Settings { stiffness_n_per_m, damping_n_s_per_m, max_force_n, ..settings }
    }
}

/// A loop whose gains can be changed between two ticks, without a new image. Its state holds a copy of the [`Servo`] in
/// RAM; the tick is the servo's own. After each start the gains are those it was built with. Of a servo in a `static` the
/// compiler leaves out the code of every rendering that it does not have; here all of it stays in flash.
///
/// **The ramp.** Gains move linearly to those requested over [`Settings::soft_start_s`], but not less than 0.1 s and
/// 100 ticks. They rise and fall alike, in any phase. A request drives nothing by itself, and changes no phase, no fault
/// and no fade (gravity compensation, which has the same fade, does not change). A tick of the ramp adds to the change
/// of the wall's force that the motion gives at most the larger of `(|Δk|·depth + |Δb|·speed)/ticks` and `|Δf|/ticks`,
/// for changes `Δk` of stiffness, `Δb` of damping and `Δf` of the maximum force. With [`crate::render::Ease`] its
/// stiffness term is up to `1 + b·speed/onset` times as large. Friction adds its coefficient's share, and may slip;
/// passivity control brakes as it does without a ramp.
///
/// **Energy.** A stiffness that rises under a pressed hand does work, however slowly: a request adds at most
/// `½·Δk·x² + Δf·x` at depth `x`. Rising by 600 N/m at 5 mm adds 7.5 mJ, at 75 mW or less. The damping of device and
/// hand must take it; [`crate::render::Passivity`] counts it, and limits the debt to its quantum. Do not compute
/// requests from the motion: in step with it, each cycle can add as much.
///
/// **Depth.** The depth at which contact is released ([`super::ContactLimits`]) follows the gains, but does not fall
/// while contact lasts: a hand that rests deep in a soft wall keeps its contact when the wall gets stiff.
///
/// ```
/// use palpate::device::{Counts, presets::WOODEN_HAPTICS_2016 as DEVICE};
/// use palpate::servo::{Config, ConfigError, Input, Loop, Servo, SettingsError, Tunable, Tuning};
/// # use palpate::device::SerialArm;
/// # use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};
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
/// static TUNABLE: Tunable<SplinePatch, SerialArm, 3> = Tunable::new(Servo::new(&DEVICE, &WALL, Config::DEFAULT));
///
/// let mut state = TUNABLE.start();
/// let stiffer = Tuning { stiffness_n_per_m: 400.0, max_force_n: 2.0, ..state.tuning() };
/// state.request(stiffer)?;
/// while !state.is_settled() {
///     let _ = TUNABLE.tick(&mut state, Input::Sensors { counts: [Counts(0); 3], enable: true });
/// }
/// // 0.2 s of soft start at 1 kHz.
/// assert_eq!((state.ticks(), state.tuning()), (200, stiffer));
///
/// // A device has limits: nothing changes.
/// let refused = state.request(Tuning { stiffness_n_per_m: 1e6, ..stiffer });
/// assert_eq!(refused, Err(ConfigError::Settings(SettingsError::Stiffness)));
/// # Ok::<(), ConfigError>(())
/// ```
#[derive(Debug)]
pub struct Tunable<'a, S, K, const JOINTS: usize, G = Unguarded> {
    servo: Servo<'a, S, K, JOINTS, G>,
}

/// The state of a [`Tunable`]: that of its [`Servo`], to which it dereferences, and the gains on their way.
#[derive(Debug)]
pub struct TunableState<'a, S: Surface, K, const JOINTS: usize, G: Guard<JOINTS> = Unguarded> {
    /// With the gains of the last tick.
    servo: Servo<'a, S, K, JOINTS, G>,
    state: ServoState<JOINTS, S::Witness, G::State>,
    target: Settings,
    /// Ticks until the gains are the target's; 1 while contact holds the depth of release, 0 at rest.
    ticks_left: u32,
}

impl<'a, S, K, const JOINTS: usize, G> Tunable<'a, S, K, JOINTS, G> {
    /// The loop that starts as this one was built.
    pub const fn new(servo: Servo<'a, S, K, JOINTS, G>) -> Self {
        Self { servo }
    }

    /// The loop as it was built.
    pub const fn servo(&self) -> &Servo<'a, S, K, JOINTS, G> {
        &self.servo
    }
}

impl<'a, S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Loop
    for Tunable<'a, S, K, JOINTS, G>
{
    type Input = Input<JOINTS>;
    type Output = Output<JOINTS>;
    type State = TunableState<'a, S, K, JOINTS, G>;

    fn start_after(&self, reset: ResetReason) -> Self::State {
        let servo = self.servo;
        TunableState { servo, state: servo.start_after(reset), target: servo.core.settings, ticks_left: 0 }
    }

    fn note(&self, state: &mut Self::State, event: Event) {
        state.servo.note(&mut state.state, event);
    }

    #[inline]
    fn tick(&self, state: &mut Self::State, input: Input<JOINTS>) -> Output<JOINTS> {
        if state.ticks_left > 0 {
            state.approach();
        }
        state.servo.tick(&mut state.state, input)
    }
}

impl<'a, S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> TunableState<'a, S, K, JOINTS, G> {
    /// Requests other gains, between two ticks. The ramp to them starts with the next tick, from the gains as they are:
    /// a request during a ramp replaces its target.
    ///
    /// # Errors
    /// The same as [`Servo::try_new`] with these gains; nothing changes then.
    pub fn request(&mut self, tuning: Tuning) -> Result<(), ConfigError> {
        let config = self.servo.config();
        let settings = tuning.on(config.settings);
        check::<S, K, JOINTS>(self.servo.core.device, &Config { settings, ..config })?;
        let ticks = settings.soft_start_s.max(MIN_RAMP_S) * settings.rate_hz;
        self.target = settings;
        // The cast saturates, above anything that a loop lives for.
        self.ticks_left = ticks.max(MIN_RAMP_TICKS) as u32;
        Ok(())
    }

    /// The gains now.
    pub const fn tuning(&self) -> Tuning {
        Tuning::of(&self.servo.core.settings)
    }

    /// The gains that were requested last, or those that the loop was built with.
    pub const fn target(&self) -> Tuning {
        Tuning::of(&self.target)
    }

    /// Whether the gains are those requested.
    pub fn is_settled(&self) -> bool {
        self.tuning() == self.target()
    }

    /// The loop with the gains as they are now.
    pub const fn servo(&self) -> &Servo<'a, S, K, JOINTS, G> {
        &self.servo
    }

    /// The gains of the next tick. At each of them all are within the limits: these bound each gain, and the sum of two
    /// stiffnesses, so they hold between any two gains at which they hold.
    #[inline(never)]
    fn approach(&mut self) {
        let core = &mut self.servo.core;
        let (from, to) = (core.penalty, self.target.penalty(core.device.max_force_n));
        let (settings, penalty) = if self.ticks_left > 1 {
            let share = 1.0 / self.ticks_left as f32;
            let penalty = Penalty {
                stiffness_n_per_m: between(from.stiffness_n_per_m, to.stiffness_n_per_m, share),
                damping_n_s_per_m: between(from.damping_n_s_per_m, to.damping_n_s_per_m, share),
                max_force_n: between(from.max_force_n, to.max_force_n, share),
            };
            self.ticks_left -= 1;
            let Penalty { stiffness_n_per_m, damping_n_s_per_m, max_force_n } = penalty;
            (Tuning { stiffness_n_per_m, damping_n_s_per_m, max_force_n }.on(core.settings), penalty)
        } else {
            self.ticks_left = 0;
            (self.target, to)
        };
        let depth = core.contact_watch.max_depth;
        core.retune(settings, penalty);
        if core.contact_watch.max_depth < depth && self.state.contact() == Contact::Touching {
            core.contact_watch.max_depth = depth;
            // Not before contact ends.
            self.ticks_left = self.ticks_left.max(1);
        }
        let max_depth = core.contact_watch.max_depth;
        self.servo.guard = self.servo.guard.of_wall(&penalty, max_depth);
    }
}

/// A share of the way from one gain to another, never beyond either by a rounding.
fn between(from: f32, to: f32, share: f32) -> f32 {
    let (low, high) = if from < to { (from, to) } else { (to, from) };
    saturate(from + (to - from) * share, low, high)
}

// Manual impls: `derive` would require `S: Copy` and `K: Copy`.
impl<S, K, const JOINTS: usize, G: Copy> Clone for Tunable<'_, S, K, JOINTS, G> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, K, const JOINTS: usize, G: Copy> Copy for Tunable<'_, S, K, JOINTS, G> {}

impl<S: Surface, K, const JOINTS: usize, G: Guard<JOINTS>> Clone for TunableState<'_, S, K, JOINTS, G> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Surface, K, const JOINTS: usize, G: Guard<JOINTS>> Copy for TunableState<'_, S, K, JOINTS, G> {}

impl<S: Surface, K, const JOINTS: usize, G: Guard<JOINTS>> Deref for TunableState<'_, S, K, JOINTS, G> {
    type Target = ServoState<JOINTS, S::Witness, G::State>;

    fn deref(&self) -> &Self::Target {
        &self.state
    }
}

impl<S: Surface, K, const JOINTS: usize, G: Guard<JOINTS>> DerefMut for TunableState<'_, S, K, JOINTS, G> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.state
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use crate::device::presets::{WOODEN_HAPTICS_2016 as DEVICE, WOODEN_HAPTICS_2016_PROTECTION as PROTECTION};
    use crate::device::{Counts, SerialArm};
    use crate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};
    use crate::render::{Coupling, Passivity};
    use crate::servo::{Fault, Guarded, Phase, Rendering, RenderingError, Safety, SettingsError};
    use std::format;

    static WALL: SplinePatch = SplineTable {
        degree: [1, 1],
        breaks_u: &[0.0, 1.0],
        breaks_v: &[0.0, 1.0],
        coefficients: Coefficients::Polynomial(&[[0.0; 3], [0.0, 0.2, 0.0], [0.2, 0.0, 0.0], [0.0; 3]]),
        shape: ShapeBounds::unknown(SecondDerivativeBounds::ZERO),
        orientation: Orientation::Outward,
        size_m: 0.2,
        crc: None,
    }
    .checked();

    /// At 4 kHz the tool bears 400 N/m of wall.
    const RENDERING: Rendering = Rendering {
        coupling: Some(Coupling {
            stiffness_n_per_m: 400.0,
            damping_n_s_per_m: 3.0,
            mass_kg: 800.0 / 16e6 / 2.0 * 1.000_01,
        }),
        passivity: Some(Passivity {
            device_damping_n_s_per_m: 0.0,
            device_friction_n: 0.0,
            max_damping_n_s_per_m: 5.0,
            resolution_m: 1e-4,
        }),
        ..Rendering::EASED
    };
    const CONFIG: Config<3> = Config {
        settings: Settings { rate_hz: 4_000.0, soft_start_s: 0.0, ..Settings::DEFAULT },
        rendering: RENDERING,
        ..Config::DEFAULT
    };
    const RAMP: usize = 400;

    type Guarding = Tunable<'static, SplinePatch<'static>, SerialArm, 3, Guarded<3>>;

    fn built(
        settings: Settings,
    ) -> Result<Servo<'static, SplinePatch<'static>, SerialArm, 3, Guarded<3>>, ConfigError> {
        Servo::try_protected(&DEVICE, &WALL, PROTECTION, Config { settings, ..CONFIG })
    }

    fn tunable() -> Guarding {
        Tunable::new(built(CONFIG.settings).unwrap())
    }

    fn sensors(enable: bool) -> Input<3> {
        Input::Sensors { counts: [Counts(0); 3], enable }
    }

    /// Numbers from 0 to 1.
    fn random() -> impl FnMut() -> f32 {
        let mut seed = 1_u32;
        move || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32
        }
    }

    /// Gains of which a third are refused.
    fn any(draw: &mut impl FnMut() -> f32) -> Tuning {
        Tuning {
            stiffness_n_per_m: draw() * 500.0,
            damping_n_s_per_m: draw() * 1.1 * DEVICE.max_damping_n_s_per_m,
            max_force_n: draw() * 2.0 * DEVICE.max_force_n - 0.1,
        }
    }

    #[test]
    fn a_request_is_checked_as_a_configuration_is_and_a_refused_one_leaves_everything_as_it_was() {
        let (tunable, mut draw) = (tunable(), random());
        let mut state = tunable.start();
        let good = Tuning::of(&CONFIG.settings);
        let spoilt = [f32::NAN, f32::INFINITY, -1.0, -0.0, 0.0, 1e9].into_iter().flat_map(|bad| {
            [
                Tuning { stiffness_n_per_m: bad, ..good },
                Tuning { damping_n_s_per_m: bad, ..good },
                Tuning { max_force_n: bad, ..good },
            ]
        });
        let mut seen = std::vec::Vec::new();
        for tuning in spoilt.chain((0..1_000).map(|_| any(&mut draw))) {
            let before = format!("{state:?}");
            let asked = state.request(tuning);
            assert_eq!(asked, built(tuning.on(CONFIG.settings)).map(|_| ()), "{tuning:?}");
            if asked.is_err() {
                assert_eq!(format!("{state:?}"), before, "{tuning:?}");
            }
            if !seen.contains(&asked) {
                seen.push(asked);
            }
            let _ = tunable.tick(&mut state, sensors(true));
        }
        for error in [
            ConfigError::Settings(SettingsError::Stiffness),
            ConfigError::Settings(SettingsError::Damping),
            ConfigError::Settings(SettingsError::MaxForce),
            ConfigError::Rendering(RenderingError::Coupling),
        ] {
            assert!(seen.contains(&Err(error)), "{error:?} must come up");
        }
    }

    #[test]
    fn a_ramp_stays_within_the_limits_and_ends_with_every_number_of_a_loop_built_so() {
        let (tunable, mut draw) = (tunable(), random());
        let mut state = tunable.start();
        let mut ramps = 0;
        while ramps < 50 {
            let (from, to) = (state.servo.core.penalty, any(&mut draw));
            if state.request(to).is_err() {
                continue;
            }
            ramps += 1;
            let most = to.max_force_n.min(DEVICE.max_force_n);
            let mut last = from;
            for tick in 1..=RAMP {
                assert!(!state.is_settled(), "{tick}");
                let _ = tunable.tick(&mut state, sensors(true));
                let core = &state.servo.core;
                let Config { settings, .. } = state.servo.config();
                assert_eq!(check::<SplinePatch, _, 3>(&DEVICE, &Config { settings, ..CONFIG }), Ok(()));
                let gains = |wall: &Penalty| [wall.stiffness_n_per_m, wall.damping_n_s_per_m, wall.max_force_n];
                let ends = [gains(&from), [to.stiffness_n_per_m, to.damping_n_s_per_m, most]];
                for (gain, now) in gains(&core.penalty).into_iter().enumerate() {
                    let [from, to] = ends.map(|end| end[gain]);
                    let (line, step) =
                        (from + (to - from) * tick as f32 / RAMP as f32, (to - from).abs() / RAMP as f32);
                    // Roundings of 400 steps.
                    let rounding = 1e-5 * from.max(to);
                    assert!((now - line).abs() <= rounding, "{gain} {tick}: {now} {line}");
                    assert!((now - gains(&last)[gain]).abs() <= step + rounding, "{gain} {tick}");
                    assert!(now >= from.min(to) && now <= from.max(to));
                }
                last = core.penalty;
            }
            assert!(state.is_settled() && state.ticks_left == 0);
            let new = built(to.on(CONFIG.settings)).unwrap();
            assert_eq!(format!("{:?}", state.servo), format!("{new:?}"));
        }
    }

    #[test]
    fn a_request_changes_no_phase_and_drives_nothing() {
        let tunable = tunable();
        let stiffer = Tuning { stiffness_n_per_m: 400.0, max_force_n: 3.0, ..Tuning::of(&CONFIG.settings) };
        // At rest, armed, running, and in a fault.
        for (ticks, enable, fault) in [(0, false, false), (10, false, false), (10, true, false), (10, true, true)] {
            let mut state = tunable.start();
            for _ in 0..ticks {
                let _ = tunable.tick(&mut state, sensors(enable));
            }
            if fault {
                tunable.note(&mut state, Event::Stop);
            }
            let (mut tuned, before) = (state, *state);
            assert_eq!(tuned.request(stiffer), Ok(()));
            assert_eq!(*tuned, before);
            for _ in 0..2 * RAMP {
                let outputs = [&mut tuned, &mut state].map(|state| tunable.tick(state, sensors(enable)));
                // In free air the gains make no difference.
                assert_eq!((outputs[0], *tuned), (outputs[1], *state));
            }
            assert_eq!(tuned.fault().map(|(fault, _)| fault), fault.then_some(Fault::Stopped));
            assert!(tuned.is_settled() && (fault || tuned.phase() != Phase::Fault));
        }
        assert_eq!(Tuning::of(&tunable.servo().config().settings), tunable.start().tuning());
    }

    #[test]
    fn a_ramp_lasts_a_tenth_of_a_second_and_a_hundred_ticks_at_least() {
        for (rate_hz, soft_start_s, ticks) in
            [(4_000.0, 0.0, 400), (4_000.0, 0.05, 400), (4_000.0, 0.5, 2_000), (20.0, 0.0, 100), (50.0, 10.0, 500)]
        {
            let settings = Settings { rate_hz, soft_start_s, ..Settings::DEFAULT };
            let safety = Safety { contact: None, ..Safety::DEFAULT };
            let servo = Servo::new(&DEVICE, &WALL, Config { settings, safety, ..Config::DEFAULT });
            let mut state = Tunable::new(servo).start();
            state.request(Tuning { stiffness_n_per_m: 300.0, ..state.tuning() }).unwrap();
            assert_eq!(state.ticks_left, ticks, "{rate_hz} Hz, {soft_start_s} s");
        }
    }
}
