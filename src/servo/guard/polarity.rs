//! Polarity check: whether a joint moves the way its motor pushes.
//!
//! An encoder that counts against its motor turns every wall into an attractor: the force grows with the depth and
//! pulls further in, and gravity compensation adds weight instead of carrying it. So both are withheld until every
//! joint has followed its motor. If a surface requests a force and a joint is unconfirmed, the force is withheld, and
//! one motor at a time gives a polarity pulse to its joint: a constant torque `u` in the direction in which the contact
//! loads it, for [`SLOT`], of at most a quarter of the maximum force. That is the force on a hand that keeps the probe
//! in place: `F` with `Jᵀ F = u eⱼ`, which loads no other joint.
//!
//! Power tells the two polarities apart. A hand that holds a device is passive, and so is the device: from whatever
//! motion they are in, as far as that continues evenly by itself, the work `u·Δx` that a constant torque does on the
//! *change* of motion is never negative. (The change starts from rest, and a passive system gives back no more than it
//! received.) So `Δx` has the sign of `u`, or nothing moves; with the wrong polarity it has the other. This holds for
//! every inertia, spring and friction that does not depend on the direction of motion; the stiffer and heavier the
//! grip, the smaller is `Δx`.
//!
//! The last three positions predict the hand's own motion: `Δx = x − 3x₁ + 3x₂ − x₃`, a [`SLOT`] apart, which cancels
//! every constant speed and acceleration. The motion that an equal torque left behind a slot ago cancels too (½ + 1 −
//! 3·½; all but a fifteenth, because a pulse starts one tick after its slot), and three slots ago; so the joints take
//! turns, one a slot, each in every third slot at most. Jerks of the hand and the encoder's counts remain, so no single
//! pulse decides: `Δx` as a fraction of `u T²/2I`, the motion of the joint alone, is summed up until the sum is clear.

use super::Motion;
use crate::device::{Device, Encoder, Kinematics, PolarityCheck, ProbePose};
use crate::math::{Vec3, inverse_sqrt_from_below};
use crate::servo::Fault;

/// Pulse length, s: long enough to accumulate counts, shorter than a human reaction.
const SLOT: f32 = 8e-3;
/// Maximum speed of the probe at the end of a pulse on a joint alone, m/s: 0.4 mm of travel.
const SPEED: f32 = 0.1;
/// Maximum force of a pulse, as a fraction of the maximum force: below a quarter, because its torque is computed for
/// the pose at its start.
const ON_TRIAL: f32 = 0.245;
/// The contact force from which on joints are pulsed, as a fraction of a pulse's maximum force: low, so that a light
/// touch is rendered too.
const ASKED: f32 = 1.0 / 3.0;
/// Slots between two pulses of a joint; the number of joints, if that is more.
const ROUND: usize = 3;
/// Maximum contribution of one pulse to the sum, either way.
const SAYS: f32 = 0.5;
/// Sum from which on the polarity is confirmed: two pulses at least.
const GOOD: f32 = 0.75;
/// Sum below which the polarity is wrong: three pulses at least.
const WRONG: f32 = -1.25;
/// Sum below which there is a rest before the next pulse.
const DOUBTFUL: f32 = -0.2;
/// Length of that rest, s: the motion of the pulses before decays.
const REST: f32 = 0.06;
/// Maximum number of pulses per contact. If the polarity is still unconfirmed, the force is withheld until the contact
/// ends.
const KNOCKS: u8 = 24;
/// Minimum expected displacement of the probe, m: a pulse with less is ignored.
const LEAST: f32 = 2e-5;
/// The same of the joint, in counts of its encoder; a pulse of less than twice that contributes less. Otherwise rounding
/// decides, and a wrong motor is taken for right.
const COUNTS: f32 = 2.0;
/// The time in which force and weight come once all joints were seen, s.
const RISE: f32 = 0.05;

/// The watch as the tick needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polarities<const JOINTS: usize> {
    /// Turn of each joint per unit of torque in a pulse, rad/(N·m).
    yields: [f32; JOINTS],
    /// The dry friction of each joint, N·m: the part of a pulse that moves nothing.
    friction: [f32; JOINTS],
    /// Minimum expected turn of each joint by a pulse, rad.
    least: [f32; JOINTS],
    /// Maximum displacement of the probe by a pulse on a joint alone, m.
    way: f32,
    /// Maximum force of a pulse, N.
    force: f32,
    /// The square of the force that a contact asks for at least, N².
    asked: f32,
    /// Ticks of a slot.
    slot: u16,
    /// Slots of a rest.
    rest: u16,
    /// By how much the share of force and weight grows in a tick.
    rise: f32,
}

/// How far the contact at hand has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// No contact.
    FreeAir,
    /// The force is withheld, and joints are pulsed.
    OnTrial,
    /// All joints were seen: force and weight come.
    Rising,
    /// All joints were seen, and nothing is withheld any more.
    Over,
}

/// The state of the polarity check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PolarityState<const JOINTS: usize> {
    stage: Stage,
    /// Ticks until this slot ends.
    ticks: u16,
    /// Slots until joints may be pulsed.
    rest: u16,
    /// Slots so far of this contact, from 0 again after each round.
    slot: usize,
    /// Pulses left in this contact.
    knocks: u8,
    /// Whether the joint of this slot is pulsed.
    is_knocking: bool,
    /// The torque of a pulse, N·m.
    torque: f32,
    /// The force of that at a probe that is held, N.
    force: Vec3,
    /// The share of force and weight that is given: 0 until all joints were seen, and then rising to 1.
    share: f32,
    /// The angles at the starts of this slot and of the two before, the newest first, rad.
    places: [[f32; JOINTS]; 3],
    /// The sum of each joint's pulses so far.
    sums: [f32; JOINTS],
}

impl<const JOINTS: usize> PolarityState<JOINTS> {
    pub(super) const START: Self = Self {
        stage: Stage::FreeAir,
        ticks: 0,
        rest: 0,
        slot: 0,
        knocks: 0,
        is_knocking: false,
        torque: 0.0,
        force: Vec3::ZERO,
        share: 0.0,
        places: [[0.0; JOINTS]; 3],
        sums: [0.0; JOINTS],
    };

    /// Which joints were seen to follow their motors.
    pub(super) fn seen(&self) -> [bool; JOINTS] {
        self.sums.map(|sum| sum >= GOOD)
    }

    /// Whether a contact is on trial: the pulses are its only force.
    #[inline]
    pub(super) fn is_on_trial(&self) -> bool {
        self.stage == Stage::OnTrial
    }

    pub(super) fn for_each_word(&self, mut take: impl FnMut(u32)) {
        take(u32::from(self.ticks) << 16 | u32::from(self.rest));
        take((self.stage as u32) << 24 | (self.slot as u32) << 16 | u32::from(self.knocks) << 8);
        [f32::from(u8::from(self.is_knocking)), self.torque, self.share]
            .into_iter()
            .chain(self.force.to_array())
            .chain(self.places.into_iter().flatten())
            .chain(self.sums)
            .for_each(|float| take(float.to_bits()));
    }

    /// Starts a contact: two slots must pass before the hand's motion is known.
    #[cold]
    fn begin(&mut self) {
        *self = Self { stage: Stage::OnTrial, rest: 3, knocks: KNOCKS, sums: self.sums, ..Self::START };
    }

    /// The share of force and weight that may be given.
    #[inline]
    pub(super) fn share(&self) -> f32 {
        self.share
    }

    /// Force is no longer requested.
    #[inline]
    pub(super) fn end(&mut self) {
        match self.stage {
            Stage::FreeAir | Stage::Over => (),
            Stage::OnTrial => self.stage = Stage::FreeAir,
            // With the next request all of it fades in.
            Stage::Rising => self.rise_by(1.0),
        }
    }

    fn rise_by(&mut self, more: f32) {
        self.share += more;
        if self.share >= 1.0 {
            (self.stage, self.share) = (Stage::Over, 1.0);
        }
    }
}

impl<const JOINTS: usize> Polarities<JOINTS> {
    pub(super) const fn new(
        watch: &PolarityCheck<JOINTS>,
        encoders: &[Encoder; JOINTS],
        friction: [f32; JOINTS],
        rate: f32,
        max_force_n: f32,
    ) -> Self {
        let ticks = rate * SLOT;
        let slot = if ticks < 3.0 { 3.0 } else { ticks };
        let time = slot / rate;
        // A pulse starts a tick after its slot.
        let knock = (slot - 1.0) / rate;
        let mut yields = watch.inertia_kg_m2;
        let mut joint = 0;
        while joint < JOINTS {
            yields[joint] = 0.5 * knock * knock / watch.inertia_kg_m2[joint];
            joint += 1;
        }
        Self {
            yields,
            friction,
            least: least(encoders),
            way: 0.5 * SPEED * knock,
            force: 0.0,
            asked: 0.0,
            slot: slot as u16,
            rest: (REST / time) as u16,
            rise: 1.0 / (RISE * rate),
        }
        .of_max_force(max_force_n)
    }

    /// The same of joints of other encoders and another dry friction, N·m.
    pub(super) fn of_joints(self, encoders: &[Encoder; JOINTS], friction: [f32; JOINTS]) -> Self {
        Self { friction, least: least(encoders), ..self }
    }

    /// The torque of a pulse that presses with 1 N, or a little less, and that which moves the probe at `SPEED`, N·m.
    /// `None` at a singularity.
    #[inline(always)]
    fn torques(&self, pose: &ProbePose<JOINTS>, joint: usize) -> Option<[f32; 2]> {
        let squared = pose.force_of_joint(joint).length_squared();
        if !squared.is_finite() {
            return None;
        }
        let lever = inverse_sqrt_from_below(squared);
        // No faster than `SPEED`, for a column is no shorter than its lever.
        let column = pose.jacobian[joint].length_squared();
        Some([lever, self.way * lever / (self.yields[joint] * column) + self.friction[joint]])
    }

    /// The same for a loop of another maximum force, N.
    pub(super) const fn of_max_force(self, max_force_n: f32) -> Self {
        let asked = ASKED * ON_TRIAL * max_force_n;
        Self { force: ON_TRIAL * max_force_n, asked: asked * asked, ..self }
    }

    /// Checks a tick in which force may be given. On return `force` and its joint torques, `felt`, are the permitted
    /// ones.
    #[inline(always)]
    pub(super) fn look(
        &self,
        state: &mut PolarityState<JOINTS>,
        moving: &Motion<'_, JOINTS>,
        force: &mut Vec3,
        felt: &mut [f32; JOINTS],
    ) -> Result<(), Fault> {
        match state.stage {
            Stage::Over => Ok(()),
            Stage::FreeAir if *force == Vec3::ZERO => Ok(()),
            Stage::FreeAir | Stage::OnTrial | Stage::Rising => self.try_joints(state, moving, force, felt),
        }
    }

    /// A tick before all joints were seen, and all is given.
    #[inline(never)]
    fn try_joints(
        &self,
        state: &mut PolarityState<JOINTS>,
        moving: &Motion<'_, JOINTS>,
        force: &mut Vec3,
        felt: &mut [f32; JOINTS],
    ) -> Result<(), Fault> {
        if state.stage == Stage::Rising {
            state.rise_by(self.rise);
            *felt = felt.map(|torque| torque * state.share);
            *force *= state.share;
            return Ok(());
        }
        if *force == Vec3::ZERO {
            state.stage = Stage::FreeAir;
            return Ok(());
        }
        // One after the other, so that none has to fit in a tick beside another.
        if state.stage == Stage::FreeAir {
            state.begin();
        } else if state.ticks == 0 {
            state.ticks = self.slot - 1;
            self.judge(state, moving)?;
        } else {
            state.ticks -= 1;
            if state.ticks == self.slot - 2 {
                self.next_slot(state, moving, *force, felt);
            }
        }
        (*force, *felt) = (Vec3::ZERO, [0.0; JOINTS]);
        if let Some(torque) = felt.get_mut(state.slot).filter(|_| state.is_knocking) {
            (*force, *torque) = (state.force, state.torque);
        }
        Ok(())
    }

    /// Evaluates the pulse of the slot that has ended.
    fn judge(&self, state: &mut PolarityState<JOINTS>, moving: &Motion<'_, JOINTS>) -> Result<(), Fault> {
        let joint = state.slot;
        let [first, second, third] = state.places;
        if state.is_knocking && joint < JOINTS {
            let moved = moving.angles[joint] - 3.0 * (first[joint] - second[joint]) - third[joint];
            let alone = (state.torque.abs() - self.friction[joint]) * self.yields[joint];
            if alone >= self.least[joint] && alone * moving.pose.jacobian[joint].length() >= LEAST {
                let turn = alone.max(2.0 * self.least[joint]);
                let says = if state.torque < 0.0 { -moved } else { moved } / turn;
                state.sums[joint] += says.clamp(-SAYS, SAYS);
            }
            if state.sums[joint] <= WRONG {
                return Err(Fault::WrongPolarity);
            }
            if state.sums[joint] < DOUBTFUL {
                state.rest = self.rest;
            }
        }
        state.is_knocking = false;
        state.places = [*moving.angles, first, second];
        Ok(())
    }

    /// Starts the next slot: selects its joint, and pulses it with the sign of the contact's load if that is large
    /// enough.
    fn next_slot(
        &self,
        state: &mut PolarityState<JOINTS>,
        moving: &Motion<'_, JOINTS>,
        force: Vec3,
        felt: &[f32; JOINTS],
    ) {
        state.slot = if state.slot + 1 < JOINTS.max(ROUND) { state.slot + 1 } else { 0 };
        state.rest = state.rest.saturating_sub(1);
        if state.sums.iter().all(|sum| *sum >= GOOD) {
            state.stage = Stage::Rising;
            return;
        }
        let joint = state.slot;
        let waits = state.rest > 0 || state.knocks == 0 || force.length_squared() < self.asked;
        if waits || joint >= JOINTS || state.sums[joint] >= GOOD {
            return;
        }
        let Some([lever, fast]) = self.torques(moving.pose, joint) else { return };
        let most = self.force * lever;
        let torque = if fast < most { fast } else { most };
        state.is_knocking = true;
        state.knocks -= 1;
        state.torque = if felt[joint] < 0.0 { -torque } else { torque };
        state.force = moving.pose.force_of_joint(joint) * state.torque;
    }
}

/// The minimum expected turns.
const fn least<const JOINTS: usize>(encoders: &[Encoder; JOINTS]) -> [f32; JOINTS] {
    let mut least = [0.0; JOINTS];
    let mut joint = 0;
    while joint < JOINTS {
        least[joint] = COUNTS * encoders[joint].radians_per_count.abs();
        joint += 1;
    }
    least
}

impl<const JOINTS: usize> PolarityCheck<JOINTS> {
    /// The maximum force of a loop from which on the polarity pulses of each joint can be judged at these angles, N:
    /// below it a pulse, a quarter of that force, does not turn the joint far enough against its dry friction and the
    /// counts of its encoder, and the force stays withheld. Infinite for an encoder that is too coarse; `None` outside
    /// the workspace.
    pub fn min_force_n<K: Kinematics<JOINTS>>(
        &self,
        device: &Device<K, JOINTS>,
        rate_hz: f32,
        angles: [f32; JOINTS],
    ) -> Option<[f32; JOINTS]> {
        let check = Polarities::new(self, &device.encoders, device.dry_friction_n_m, rate_hz, 0.0);
        let pose = device.kinematics.pose(angles)?;
        let mut forces = [f32::INFINITY; JOINTS];
        for (joint, force) in forces.iter_mut().enumerate() {
            let [lever, fast] = check.torques(&pose, joint)?;
            let turn = check.least[joint].max(LEAST / pose.jacobian[joint].length());
            let torque = check.friction[joint] + turn / check.yields[joint];
            if torque <= fast {
                *force = torque / (lever * ON_TRIAL);
            }
        }
        Some(forces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commission::FRICTION_WITHIN;
    use crate::device::presets::*;
    use crate::device::{Device, Kinematics, Protection};
    use core::f32::consts::FRAC_PI_2;

    /// Whether each joint of a device moves far enough when it knocks in the middle of its workspace, though it sticks
    /// as much as a calibration may say.
    fn sees<K: Kinematics<3>>(device: &Device<K, 3>, protection: &Protection<3>, middle: [f32; 3]) {
        let of_range = device
            .kinematics
            .pose(device.joint_range_rad.map(|[least, most]| 0.5 * (least + most)))
            .expect("within reach");
        let friction = of_range.jacobian.map(|column| FRICTION_WITHIN * device.max_force_n * column.length());
        let watch = protection.polarity.expect("watched");
        let signs = Polarities::new(&watch, &device.encoders, friction, 4_000.0, device.max_force_n);
        for (joint, column) in device.kinematics.pose(middle).expect("within reach").jacobian.into_iter().enumerate() {
            let reach = column.length();
            let most = (signs.force * reach).min(signs.way / (signs.yields[joint] * reach) + friction[joint]);
            let way = (most - friction[joint]) * signs.yields[joint] * reach;
            assert!(
                way >= LEAST && way >= signs.least[joint] * reach,
                "joint {joint}: {most} N·m against {}: {way} m",
                friction[joint]
            );
        }
    }

    #[test]
    fn no_friction_that_a_calibration_may_say_keeps_a_knock_from_being_seen() {
        sees(&WOODEN_HAPTICS_2016, &WOODEN_HAPTICS_2016_PROTECTION, [0.0, 0.5, 0.2]);
        sees(&POLHEM_V2, &POLHEM_V2_PROTECTION, [0.0, 0.912_695, 2.360_105]);
        sees(&PHANTOM_PREMIUM, &PHANTOM_PREMIUM_PROTECTION, [0.0, FRAC_PI_2, FRAC_PI_2]);
        let middle = NOVINT_FALCON.kinematics.angles(Vec3::ZERO).expect("within reach");
        sees(&NOVINT_FALCON, &NOVINT_FALCON_PROTECTION, middle);
    }
}
