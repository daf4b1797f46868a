//! The state of the loop, and read access to it. Only the loop writes it.

use super::contact::LostContact;
use super::{Fault, PatchWitness, Phase, Remembered, ResetReason, Servo, Settings, Stillness, TableCheck, Tracked};
use crate::device::drive::Supply;
use crate::device::{Counts, Device, Duty, HomingState};
use crate::math::Vec3;
use crate::render::{Anchor, Energy, Tool};
use crate::track::Contact;

/// The state of the loop after a tick. A plain value: copy it, compare it, keep it in RAM. `G` is the state of its guard.
///
/// ```
/// use palpate::servo::{Loop, Output, Phase, ServoState, State, Tracked};
///
/// /// Any loop's state has these.
/// fn is_rendering<const JOINTS: usize, W: Tracked, G>(state: &ServoState<JOINTS, W, G>) -> bool {
///     state.phase() == Phase::Running && state.fault().is_none() && matches!(state.output(), Output::Drive(_))
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoState<const JOINTS: usize, W = PatchWitness, G = ()> {
    pub(super) phase: Phase,
    /// Ticks done.
    pub(super) ticks: u32,
    pub(super) sensors: Sensors<JOINTS>,
    pub(super) faults: Faults,
    pub(super) readiness: Readiness<JOINTS>,
    pub(super) contact: ContactState<W>,
    pub(super) drive: DriveState<JOINTS>,
    /// The guard's own state.
    pub(super) guard: G,
}

/// The joints as the sensors have them; written by `sense.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sensors<const JOINTS: usize> {
    /// The last good encoder counts; `None` before the first.
    pub counts: Option<[Counts; JOINTS]>,
    /// Joint angles, radians.
    pub angles: [f32; JOINTS],
    /// Joint rates, rad/s, as estimated.
    pub rates: [f32; JOINTS],
    /// [`crate::device::VelocityState::lag`] of each joint.
    pub lags: [f32; JOINTS],
    /// Joint angle in the middle of count zero, radians: the encoders' own, or the one that homing found.
    pub angles_at_zero: [f32; JOINTS],
    /// Whole turns, of the encoder's count, that were taken out of the angle of an only joint that turns without end.
    pub turns: i32,
    /// Since when each joint has not moved under load.
    pub stillness: Stillness<JOINTS>,
    /// Frames lost, late or damaged so far.
    pub frames_lost: u32,
}

/// Latched faults, and the counters that lead to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Faults {
    /// The first fault and its tick. Latched.
    pub first: Option<(Fault, u32)>,
    /// The gravest of the faults since. Latched; one that forbids damping stands before one that allows it.
    pub later: Option<Fault>,
    /// Why the chip was reset before the loop started.
    pub reset: ResetReason,
    /// Ticks that overran so far.
    pub overruns: u32,
    /// Ticks that overran in a row.
    pub overruns_in_a_row: u32,
    /// Whether an overrun was noted since the last tick.
    pub overran: bool,
    /// Ticks since the host was heard.
    pub link_silence: u32,
    /// How far the check of the tables has come.
    pub table_check: TableCheck,
}

/// Progress of [`Phase::Calibrate`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Readiness<const JOINTS: usize> {
    /// Ticks with plausible sensors so far, while calibrating.
    pub settled: u32,
    /// Whether the device is homed.
    pub homed: bool,
    pub homing: HomingState<JOINTS>,
}

/// The probe, its virtual tool, and the surface that it touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ContactState<W> {
    /// The probe in the body's frame, metres.
    pub probe: Vec3,
    /// The virtual tool; it is the probe unless there is a coupling.
    pub tool: Tool,
    /// The witness point.
    pub witness: W,
    /// Where friction holds the surface.
    pub anchor: Anchor,
    /// Contact that was released.
    pub lost: LostContact,
    /// Whether the probe is deeper inside than the minimum radius of curvature.
    pub is_too_deep: bool,
    /// Controller steps that were rejected because the distance would have risen.
    pub rejected_steps: u32,
}

/// The force and its way to the motors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DriveState<const JOINTS: usize> {
    /// Force on the probe, N, in the device's frame, as the motors give it.
    pub force: Vec3,
    /// How far the force is faded in, 0 to 1.
    pub fade: f32,
    /// Workspace margin ([`crate::device::Device::workspace_margin`]): 1 well inside; the force is multiplied by it.
    pub margin: f32,
    /// The passivity observer's energy.
    pub energy: Energy,
    /// Whether the motors are driven though no force is rendered: by homing, or to damp after a fault.
    pub drives: bool,
    /// Duties applied since the last tick.
    pub duties: [Duty; JOINTS],
    /// The motors' supply.
    pub supply: Supply,
}

impl<const JOINTS: usize, W: Tracked, G: Remembered> ServoState<JOINTS, W, G> {
    /// A hash of every bit of the state (FNV-1a over 32-bit words): two runs agree bit for bit if it agrees at each
    /// tick.
    pub fn digest(&self) -> u32 {
        let mut hash = Fnv::new();
        let (fault, fault_tick) = self.faults.first.map_or((0, 0), |(fault, tick)| (fault.code(), tick));
        let faults = u32::from(fault) | u32::from(self.faults.later.map_or(0, Fault::code)) << 8;
        hash.words([self.phase as u32, faults, fault_tick, self.ticks]);
        hash.words([
            self.faults.reset as u32,
            self.faults.overruns,
            self.faults.overruns_in_a_row,
            u32::from(self.faults.overran),
        ]);
        hash.words([self.faults.link_silence, self.readiness.settled, u32::from(self.readiness.homed)]);
        self.readiness.homing.words(|word| hash.words([word]));
        hash.floats(self.sensors.angles_at_zero);
        // Of devices that have them.
        if self.sensors.turns != 0 {
            hash.words([self.sensors.turns as u32]);
        }
        let TableCheck { place, crc, passes, is_read } = self.faults.table_check;
        hash.words([place.record, place.word, crc, passes, u32::from(is_read)]);
        hash.words([self.sensors.frames_lost, self.contact.rejected_steps, u32::from(self.sensors.counts.is_some())]);
        let LostContact { count, in_a_row, tick, force, share } = self.contact.lost;
        hash.words([count, in_a_row, tick, share.to_bits(), u32::from(self.contact.is_too_deep)]);
        hash.vectors([force]);
        for counts in self.sensors.counts.iter().flatten() {
            hash.words([counts.0 as u32]);
        }
        hash.floats(self.sensors.angles);
        hash.floats(self.sensors.rates);
        hash.floats(self.sensors.lags);
        let stillness = &self.sensors.stillness;
        hash.words([u32::from(stillness.turn) | u32::from(stillness.due) << 8]);
        let joints = stillness.pieces.into_iter().zip(stillness.since).zip(stillness.counts);
        for ((pieces, since), Counts(count)) in joints {
            hash.words([u32::from(pieces) | u32::from(since) << 8, count as u32]);
        }
        hash.vectors([stillness.mark]);
        hash.floats([self.drive.margin]);
        hash.vectors([self.contact.probe, self.contact.tool.position, self.contact.tool.velocity]);
        self.contact.witness.for_each_word(|word| hash.words([word]));
        hash.words([u32::from(self.contact.anchor.point.is_some()), u32::from(self.contact.anchor.slips)]);
        hash.vectors([self.contact.anchor.point.unwrap_or(Vec3::ZERO), self.drive.force]);
        hash.floats([self.drive.fade, self.drive.energy.stored, self.drive.energy.damping]);
        hash.words([u32::from(self.drive.energy.cut) | u32::from(self.drive.drives) << 1]);
        for duty in self.drive.duties {
            hash.words([duty.0 as u32]);
        }
        if self.drive.supply != Supply::UNMEASURED {
            hash.words(self.drive.supply.words());
        }
        self.guard.for_each_word(|word| hash.words([word]));
        hash.0
    }
}

impl<const JOINTS: usize> Sensors<JOINTS> {
    /// Joint angles, radians, as the estimators have them: the middle of each count, or between counts.
    #[inline]
    pub fn estimated_angles(&self) -> [f32; JOINTS] {
        let mut angles = self.angles;
        for (angle, lag) in angles.iter_mut().zip(self.lags) {
            *angle -= lag;
        }
        angles
    }
}

/// FNV-1a, a word at a time.
struct Fnv(u32);

impl Fnv {
    const fn new() -> Self {
        Self(0x811c_9dc5)
    }

    fn words<const N: usize>(&mut self, words: [u32; N]) {
        for word in words {
            self.0 = (self.0 ^ word).wrapping_mul(0x0100_0193);
        }
    }

    fn floats<const N: usize>(&mut self, floats: [f32; N]) {
        self.words(floats.map(f32::to_bits));
    }

    fn vectors<const N: usize>(&mut self, vectors: [Vec3; N]) {
        for vector in vectors {
            self.floats(vector.to_array());
        }
    }
}

impl<'a, S, K, const JOINTS: usize, G> Servo<'a, S, K, JOINTS, G> {
    /// The settings it was made with.
    #[inline]
    pub const fn settings(&self) -> &Settings {
        &self.core.settings
    }

    /// Whether its homing moves the joints by their motors.
    #[inline]
    pub const fn homing_drives(&self) -> bool {
        match &self.core.homing {
            Some(homing) => homing.drives(),
            None => false,
        }
    }

    /// Its device.
    #[inline]
    pub const fn device(&self) -> &'a Device<K, JOINTS> {
        self.core.device
    }

    /// The surface that it renders.
    #[inline]
    pub const fn surface(&self) -> &'a S {
        self.core.surface
    }
}

impl<const JOINTS: usize, W, G> ServoState<JOINTS, W, G> {
    /// The phase of the loop.
    #[inline]
    pub const fn phase(&self) -> Phase {
        self.phase
    }

    /// The fault that stopped the loop, and its tick. Latched.
    ///
    /// ```
    /// # use palpate::device::{Counts, SerialArm, presets::WOODEN_HAPTICS_2016 as DEVICE};
    /// # use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};
    /// use palpate::servo::{Config, Fault, Input, Output, Servo};
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
    /// static LOOP: Servo<SplinePatch, SerialArm, 3> = Servo::new(&DEVICE, &WALL, Config::DEFAULT);
    ///
    /// let mut state = LOOP.start();
    /// // The encoders' frames do not come.
    /// for _ in 0..100 {
    ///     assert!(matches!(LOOP.tick(&mut state, Input::Lost), Output::Off));
    /// }
    /// let (fault, _) = state.fault().expect("latched");
    /// assert_eq!((fault, fault.code()), (Fault::FrameLost, 1)); // `Display` gives "sensor frame lost or late"
    /// // Once a person has mended it and asks, as after a reset. Force fades in as soon as an input requests it: pass
    /// // `enable: false` until the person has let go of the enable button.
    /// state = LOOP.start();
    /// assert_eq!(state.fault(), None);
    /// ```
    #[inline]
    pub const fn fault(&self) -> Option<(Fault, u32)> {
        self.faults.first
    }

    /// The reason for the chip's last reset.
    #[inline]
    pub const fn reset(&self) -> ResetReason {
        self.faults.reset
    }

    /// Ticks done.
    #[inline]
    pub const fn ticks(&self) -> u32 {
        self.ticks
    }

    /// Frames lost, late or damaged so far.
    #[inline]
    pub const fn frames_lost(&self) -> u32 {
        self.sensors.frames_lost
    }

    /// Ticks that overran so far.
    #[inline]
    pub const fn overruns(&self) -> u32 {
        self.faults.overruns
    }

    /// How often contact was lost so far: ended because no motion explained it, see [`super::ContactLimits`].
    #[inline]
    pub const fn contacts_lost(&self) -> u32 {
        self.contact.lost.count
    }

    /// Whether the probe is in contact and deeper inside than the surface's minimum radius of curvature: the closest
    /// point is no longer unique there, and the theory no longer bounds the witness point's error (theory §11). Normal
    /// where a small fillet is pressed.
    #[inline]
    pub const fn is_too_deep(&self) -> bool {
        self.contact.is_too_deep
    }

    /// Ticks since the host was heard.
    #[inline]
    pub const fn link_silence(&self) -> u32 {
        self.faults.link_silence
    }

    /// Whether the device is homed.
    #[inline]
    pub const fn homed(&self) -> bool {
        self.readiness.homed
    }

    /// How far homing has come.
    #[inline]
    pub const fn homing(&self) -> &HomingState<JOINTS> {
        &self.readiness.homing
    }

    /// Joint angle in the middle of count zero, radians: the encoders' own, or the homed one.
    #[inline]
    pub const fn angles_at_zero(&self) -> [f32; JOINTS] {
        self.sensors.angles_at_zero
    }

    /// How far the check of the tables has come.
    #[inline]
    pub const fn table_check(&self) -> &TableCheck {
        &self.faults.table_check
    }

    /// Controller steps that were rejected because the distance would have risen.
    #[inline]
    pub const fn rejected_steps(&self) -> u32 {
        self.contact.rejected_steps
    }

    /// The last good encoder counts; `None` before the first.
    #[inline]
    pub const fn counts(&self) -> Option<[Counts; JOINTS]> {
        self.sensors.counts
    }

    /// Whole turns that were taken out of the angle of a device's only joint, where it turns without end, by its
    /// encoder's counts; 0 where joints have a range. [`Self::angles`] is within eight turns, so that it stays precise.
    #[inline]
    pub const fn turns(&self) -> i32 {
        self.sensors.turns
    }

    /// Joint angles, radians.
    #[inline]
    pub const fn angles(&self) -> [f32; JOINTS] {
        self.sensors.angles
    }

    /// Joint rates, rad/s, as estimated.
    #[inline]
    pub const fn rates(&self) -> [f32; JOINTS] {
        self.sensors.rates
    }

    /// The workspace margin, 0 to 1 ([`crate::device::Device::workspace_margin`]): 1 well inside; the force is
    /// multiplied by it.
    #[inline]
    pub const fn workspace_margin(&self) -> f32 {
        self.drive.margin
    }

    /// The probe in the body's frame, metres.
    #[inline]
    pub const fn probe(&self) -> Vec3 {
        self.contact.probe
    }

    /// The virtual tool; it is the probe unless there is a coupling.
    #[inline]
    pub const fn tool(&self) -> Tool {
        self.contact.tool
    }

    /// The witness point.
    #[inline]
    pub const fn witness(&self) -> &W {
        &self.contact.witness
    }

    /// The same, for changes between two ticks that its surface permits, as a [`crate::scene::Scene`] does.
    #[inline]
    pub const fn witness_mut(&mut self) -> &mut W {
        &mut self.contact.witness
    }

    /// Where friction holds the surface.
    #[inline]
    pub const fn anchor(&self) -> Anchor {
        self.contact.anchor
    }

    /// The energy that the passivity observer counted.
    #[inline]
    pub const fn energy(&self) -> Energy {
        self.drive.energy
    }

    /// How far the force is faded in, 0 to 1.
    #[inline]
    pub const fn fade(&self) -> f32 {
        self.drive.fade
    }

    /// Force on the probe, N, in the device's frame, as the motors give it.
    #[inline]
    pub const fn force(&self) -> Vec3 {
        self.drive.force
    }

    /// Duties now applied.
    #[inline]
    pub const fn duties(&self) -> [Duty; JOINTS] {
        self.drive.duties
    }

    /// The guard's state.
    #[inline]
    pub const fn guard(&self) -> &G {
        &self.guard
    }
}

impl<const JOINTS: usize, W: Tracked, G> ServoState<JOINTS, W, G> {
    /// Signed gap along the outward normal, metres; negative behind the surface.
    #[inline]
    pub fn gap(&self) -> f32 {
        self.contact.witness.gap()
    }

    /// Whether the surface is touched.
    #[inline]
    pub fn contact(&self) -> Contact {
        self.contact.witness.contact()
    }
}
