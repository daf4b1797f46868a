//! The loop's configuration, checked when it is built, and the state it starts from.

use super::lost_contact::{ContactWatch, LostContact};
use super::{
    Fault, Guard, Guarded, Phase, ProtectionError, Rendering, RenderingError, ResetReason, Safety, SafetyError,
    ServoState, Settings, SettingsError, Stillness, Surface, TableCheck, Unguarded,
};
use crate::device::{Device, Duty, Homing, HomingState, Kinematics, Protection, VelocityEstimator, ZeroOf};
use crate::math::Vec3;
use crate::render::{Anchor, Eased, Energy, Penalty, Tool};
use crate::track::Controller;

/// The loop's configuration: device, surface, controller and settings. Constant, in flash. `G` is what guards it beyond
/// its own checks: nothing, unless [`Self::protect`] says so.
#[derive(Debug)]
pub struct Servo<'a, S, K, const JOINTS: usize, G = Unguarded> {
    pub(super) device: &'a Device<K, JOINTS>,
    pub(super) surface: &'a S,
    pub(super) controller: Controller,
    pub(super) penalty: Penalty,
    pub(super) estimators: [VelocityEstimator; JOINTS],
    pub(super) rendering: Rendering,
    pub(super) safety: Safety,
    pub(super) homing: Option<Homing<JOINTS>>,
    pub(super) settings: Settings,
    pub(super) rate: f32,
    pub(super) period: f32,
    pub(super) max_move: f32,
    pub(super) max_growth: f32,
    pub(super) eased: Option<Eased>,
    pub(super) fade_step: f32,
    pub(super) link_ticks: u32,
    pub(super) contact_watch: ContactWatch,
    pub(super) guard: G,
}

// By hand, for a derived one would ask a copy of the surface and the mechanism too, which are only referred to.
impl<S, K, const JOINTS: usize, G: Copy> Clone for Servo<'_, S, K, JOINTS, G> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, K, const JOINTS: usize, G: Copy> Copy for Servo<'_, S, K, JOINTS, G> {}

impl<'a, S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize> Servo<'a, S, K, JOINTS> {
    /// The loop of a device that touches a patch or a body, with [`Rendering::PLAIN`] and [`Safety::DEFAULT`].
    ///
    /// A device has one to three joints: with more it does not compile, for a force in space does not say how they
    /// share it.
    ///
    /// ```compile_fail
    /// # use palpate::{device::{Device, Kinematics}, patch::SplinePatch, servo::{Servo, Settings}, track::Controller};
    /// fn four_joints<K: Kinematics<4>>(device: &Device<K, 4>, patch: &SplinePatch) {
    ///     let _ = Servo::try_new(device, patch, Controller::SECOND_ORDER, Settings::DEFAULT);
    /// }
    /// # struct Snake;
    /// # impl Kinematics<4> for Snake {
    /// #     fn pose(&self, _: [f32; 4]) -> palpate::device::ProbePose<4> { palpate::device::ProbePose::UNREACHABLE }
    /// # }
    /// # fn main() { let make: fn(&Device<Snake, 4>, &SplinePatch) = four_joints; let _ = make; }
    /// ```
    ///
    /// # Errors
    /// The setting that is refused.
    pub const fn try_new(
        device: &'a Device<K, JOINTS>,
        surface: &'a S,
        controller: Controller,
        settings: Settings,
    ) -> Result<Self, SettingsError> {
        const { assert!(JOINTS >= 1 && JOINTS <= 3, "a device has one to three joints") };
        if let Err(error) = settings.check(device.max_stiffness_n_per_m, device.max_damping_n_s_per_m) {
            return Err(error);
        }
        let period = 1.0 / settings.rate_hz;
        let max_force =
            if settings.max_force_n < device.max_force_n { settings.max_force_n } else { device.max_force_n };
        let servo = Self {
            device,
            surface,
            controller,
            penalty: Penalty {
                stiffness_n_per_m: settings.stiffness_n_per_m,
                damping_n_s_per_m: settings.damping_n_s_per_m,
                max_force_n: max_force,
            },
            // Any: the rendering below sets them.
            estimators: [VelocityEstimator::new(Rendering::PLAIN.velocity, 1.0, 1.0, 0.0); JOINTS],
            rendering: Rendering::PLAIN,
            safety: Safety::DEFAULT,
            homing: None,
            settings,
            rate: settings.rate_hz,
            period,
            max_move: device.max_joint_rate_rad_per_s * period,
            max_growth: f32::INFINITY,
            eased: None,
            // A fade no longer than a tick is no fade.
            fade_step: if settings.soft_start_s > period { period / settings.soft_start_s } else { 1.0 },
            link_ticks: u32::MAX,
            contact_watch: ContactWatch::new(
                Safety::DEFAULT.contact,
                max_force / settings.stiffness_n_per_m,
                settings.rate_hz,
            ),
            guard: Unguarded,
        };
        Ok(servo.set_rendering(Rendering::PLAIN))
    }

    /// [`Self::try_new`] for a `static`: refused settings do not compile.
    ///
    /// # Panics
    /// At compile time, naming the setting.
    pub const fn new(
        device: &'a Device<K, JOINTS>,
        surface: &'a S,
        controller: Controller,
        settings: Settings,
    ) -> Self {
        match Self::try_new(device, surface, controller, settings) {
            Ok(servo) => servo,
            Err(SettingsError::Rate) => panic!("rate"),
            Err(SettingsError::Stiffness) => panic!("stiffness"),
            Err(SettingsError::Damping) => panic!("damping"),
            Err(SettingsError::MaxForce) => panic!("max_force"),
            Err(SettingsError::VelocityCorner) => panic!("velocity_corner"),
            Err(SettingsError::SoftStart) => panic!("soft_start"),
            Err(SettingsError::BodyOrigin) => panic!("body_origin"),
        }
    }

    /// The same loop with its device's motors protected. `protect` goes before what else is chosen.
    ///
    /// # Errors
    /// The number that is refused.
    pub const fn try_protect(
        self,
        protection: Protection<JOINTS>,
    ) -> Result<Servo<'a, S, K, JOINTS, Guarded<JOINTS>>, ProtectionError> {
        let guard = match Guarded::try_new(
            protection,
            &self.device.motors,
            self.device.dry_friction_n_m,
            self.rate,
            &self.penalty,
        ) {
            Ok(guard) => guard,
            Err(error) => return Err(error),
        };
        Ok(Servo {
            device: self.device,
            surface: self.surface,
            controller: self.controller,
            penalty: self.penalty,
            estimators: self.estimators,
            rendering: self.rendering,
            safety: self.safety,
            homing: self.homing,
            settings: self.settings,
            rate: self.rate,
            period: self.period,
            max_move: self.max_move,
            max_growth: self.max_growth,
            eased: self.eased,
            fade_step: self.fade_step,
            link_ticks: self.link_ticks,
            contact_watch: self.contact_watch,
            guard,
        })
    }

    /// [`Self::try_protect`] for a `static`.
    ///
    /// # Panics
    /// At compile time, naming the number.
    pub const fn protect(self, protection: Protection<JOINTS>) -> Servo<'a, S, K, JOINTS, Guarded<JOINTS>> {
        match self.try_protect(protection) {
            Ok(servo) => servo,
            Err(ProtectionError::Continuous) => panic!("continuous"),
            Err(ProtectionError::TimeConstant) => panic!("time_constant"),
            Err(ProtectionError::Speed) => panic!("a maximum speed"),
            Err(ProtectionError::Supply) => panic!("supply"),
            Err(ProtectionError::Inertia) => panic!("inertia"),
        }
    }
}

impl<'a, S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Servo<'a, S, K, JOINTS, G> {
    /// What guards the loop beyond its own checks.
    pub const fn guard(&self) -> &G {
        &self.guard
    }

    /// The same loop with this rendering.
    ///
    /// # Errors
    /// The choice that is refused.
    pub const fn try_rendering(self, rendering: Rendering) -> Result<Self, RenderingError> {
        match rendering.check(self.penalty.stiffness_n_per_m, self.period) {
            Ok(()) => Ok(self.set_rendering(rendering)),
            Err(error) => Err(error),
        }
    }

    /// [`Self::try_rendering`] for a `static`.
    ///
    /// # Panics
    /// At compile time, naming the choice.
    pub const fn rendering(self, rendering: Rendering) -> Self {
        match self.try_rendering(rendering) {
            Ok(servo) => servo,
            Err(RenderingError::Friction) => panic!("friction"),
            Err(RenderingError::Texture) => panic!("texture"),
            Err(RenderingError::Coupling) => panic!("coupling"),
            Err(RenderingError::Passivity) => panic!("passivity"),
            Err(RenderingError::Ease) => panic!("ease"),
            Err(RenderingError::Slew) => panic!("max_slew"),
        }
    }

    const fn set_rendering(mut self, rendering: Rendering) -> Self {
        let mut joint = 0;
        while joint < JOINTS {
            let count = self.device.encoders[joint].radians_per_count;
            self.estimators[joint] =
                VelocityEstimator::new(rendering.velocity, self.settings.velocity_corner_hz, self.rate, count);
            joint += 1;
        }
        self.max_growth = rendering.max_slew_n_per_s * self.period;
        self.eased = match rendering.ease {
            Some(ease) => Some(Eased::new(ease, &self.penalty, self.period)),
            None => None,
        };
        self.rendering = rendering;
        self
    }

    /// The same loop with these limits.
    ///
    /// # Errors
    /// The limit that is refused.
    pub const fn try_safety(mut self, safety: Safety) -> Result<Self, SafetyError> {
        match safety.check(self.device.max_damping_n_s_per_m) {
            Ok(()) => {
                // The cast saturates: ∞ is 2³² ticks, which is never.
                self.link_ticks = (safety.link_timeout_s * self.rate) as u32;
                let full_force_depth = self.penalty.max_force_n / self.penalty.stiffness_n_per_m;
                self.contact_watch = ContactWatch::new(safety.contact, full_force_depth, self.rate);
                self.safety = safety;
                Ok(self)
            }
            Err(error) => Err(error),
        }
    }

    /// [`Self::try_safety`] for a `static`.
    ///
    /// # Panics
    /// At compile time, naming the limit.
    pub const fn safety(self, safety: Safety) -> Self {
        match self.try_safety(safety) {
            Ok(servo) => servo,
            Err(SafetyError::Damping) => panic!("output"),
            Err(SafetyError::LinkTimeout) => panic!("link_timeout"),
            Err(SafetyError::Stuck) => panic!("stuck"),
            Err(SafetyError::Contact) => panic!("contact"),
        }
    }

    /// What the encoders' zeroes have to be the joints' angles at, for this loop's homing; `None` where that is found
    /// out anew each time.
    pub const fn zero_of(&self) -> Option<ZeroOf> {
        match &self.homing {
            Some(homing) => homing.zero_of(),
            None => Some(ZeroOf::Count),
        }
    }

    /// Whether it is a fault that the host falls silent ([`Safety::link_timeout`]).
    pub const fn watches_link(&self) -> bool {
        self.link_ticks < u32::MAX
    }

    /// The same loop, which finds out in [`Phase::Calibrate`] where the joints are.
    ///
    /// Until that is done no angle is believed: ranges are not looked at, there is no pose, and only homing itself
    /// drives the motors, within the torque and speed it was given and only while force is asked for; otherwise it
    /// waits. A refusal is [`super::Fault::Homing`], and [`ServoState::homing`] has the reason.
    pub const fn homing(self, homing: Homing<JOINTS>) -> Self {
        Self { homing: Some(homing), ..self }
    }

    /// The same loop on the same device as commissioning found it ([`Device::calibrated`]): its encoders, motors and
    /// friction take the place of those that the loop was made with, in homing and for what guards it too.
    #[must_use]
    pub fn calibrated<'b>(self, device: &'b Device<K, JOINTS>) -> Servo<'b, S, K, JOINTS, G>
    where
        'a: 'b,
    {
        let homing = self.homing.map(|homing| homing.of_encoders(device.encoders));
        let rendering = self.rendering;
        let guard = self.guard.of_motors(&device.motors, &device.dry_friction_n_m);
        Servo { device, homing, guard, ..self }.set_rendering(rendering)
    }

    /// The state before the first tick after power-on: motors at zero, the witness point at rest.
    pub fn start(&self) -> ServoState<JOINTS, S::Witness, G::State> {
        self.start_after(ResetReason::PowerOn)
    }

    /// The state before the first tick after a reset. One by the watchdog or a brown-out is a fault from the start, and
    /// so are tables that are not what was baked ([`Safety::checks_tables`]): they are read whole here.
    pub fn start_after(&self, reset: ResetReason) -> ServoState<JOINTS, S::Witness, G::State> {
        let mut table_check = TableCheck::default();
        let is_good = self.expected_crc().is_none_or(|expected| table_check.run(self.surface, expected));
        let fault = reset.fault().or((!is_good).then_some(Fault::TableCorrupt));
        ServoState {
            phase: if fault.is_some() { Phase::Fault } else { Phase::Reset },
            fault: fault.map(|fault| (fault, 0)),
            later: None,
            reset,
            ticks: 0,
            frames_lost: 0,
            overruns: 0,
            overruns_in_a_row: 0,
            overran: false,
            link_silence: 0,
            settled: 0,
            homed: !self.safety.wait_for_homing && self.homing.is_none(),
            homing: HomingState::default(),
            angles_at_zero: self.device.encoders.map(|encoder| encoder.angle_at_zero_rad),
            table_check,
            rejected_steps: 0,
            lost_contact: LostContact::default(),
            is_too_deep: false,
            counts: None,
            angles: [0.0; JOINTS],
            rates: [0.0; JOINTS],
            velocities: self.estimators.map(|estimator| estimator.start()),
            stillness: Stillness::START,
            room: 1.0,
            probe: Vec3::ZERO,
            tool: Tool::default(),
            witness: self.surface.rest(),
            anchor: Anchor::default(),
            energy: Energy::default(),
            fade: 0.0,
            force: Vec3::ZERO,
            drives: false,
            duties: [Duty::ZERO; JOINTS],
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
            Servo::try_new(&DEVICE, &WALL, Controller::SECOND_ORDER, settings).unwrap()
        };
        assert_eq!(with(1.0, 20.0).penalty.max_force_n, 1.0);
        // No more than the device bears.
        assert_eq!(with(1_000.0, 20.0).penalty.max_force_n, DEVICE.max_force_n);
        // 1 N at 20 N/m is 5 cm deep: contact is lost at twice that.
        assert_eq!(with(1.0, 20.0).contact_watch.max_depth, 0.1);
        let limits = ContactLimits { depth: 4.0, ..ContactLimits::DEFAULT };
        let safety = Safety { link_timeout_s: 0.05, contact: Some(limits), ..Safety::DEFAULT };
        let careful = with(1.0, 20.0).try_safety(safety).unwrap();
        assert_eq!((careful.link_ticks, careful.contact_watch.max_depth), (200, 0.2));
    }
}
