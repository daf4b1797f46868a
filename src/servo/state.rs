//! Everything that changes from tick to tick.

use super::lost_contact::LostContact;
use super::{Fault, PatchWitness, Phase, Remembered, ResetReason, Stillness, TableCheck, Tracked};
use crate::device::{Counts, Duty, HomingState, VelocityState};
use crate::math::Vec3;
use crate::render::{Anchor, Energy, Tool};

/// The state of the loop after a tick. A plain value: copy it, compare it, keep it in RAM. Only the loop
/// writes it. `G` is what its guard remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoState<const JOINTS: usize, W = PatchWitness, G = ()> {
    /// What the loop is doing.
    pub(super) phase: Phase,
    /// What stopped it, and at which tick. Latched.
    pub(super) fault: Option<(Fault, u32)>,
    /// What else was found wrong since. Latched; what lets nothing be driven any more stands before what does.
    pub(super) later: Option<Fault>,
    /// Why the chip was reset before the loop began.
    pub(super) reset: ResetReason,
    /// Ticks done.
    pub(super) ticks: u32,
    /// Frames lost, late or damaged so far.
    pub(super) frames_lost: u32,
    /// Ticks that overran so far.
    pub(super) overruns: u32,
    /// Ticks that overran in a row.
    pub(super) overruns_in_a_row: u32,
    /// Whether an overrun was noted since the last tick.
    pub(super) overran: bool,
    /// Ticks since the host was heard.
    pub(super) link_silence: u32,
    /// Ticks of believable sensors so far, while calibrating.
    pub(super) settled: u32,
    /// Whether the device is homed.
    pub(super) homed: bool,
    /// How far homing has come.
    pub(super) homing: HomingState<JOINTS>,
    /// Joint angle in the middle of count zero, radians: the encoders' own, or what homing found.
    pub(super) angles_at_zero: [f32; JOINTS],
    /// How far the check of the tables has come.
    pub(super) table_check: TableCheck,
    /// Controller steps that were rejected because the distance would have risen.
    pub(super) rejected_steps: u32,
    /// Contact that was lost.
    pub(super) lost_contact: LostContact,
    /// Whether the probe is deeper inside than the least radius of curvature.
    pub(super) is_too_deep: bool,
    /// The last good encoder counts; `None` before the first.
    pub(super) counts: Option<[Counts; JOINTS]>,
    /// Joint angles, radians.
    pub(super) angles: [f32; JOINTS],
    /// Joint rates, rad/s, as estimated.
    pub(super) rates: [f32; JOINTS],
    /// What the velocity estimators remember.
    pub(super) velocities: [VelocityState; JOINTS],
    /// Since when each joint has not moved under load.
    pub(super) stillness: Stillness<JOINTS>,
    /// How much room there is to the rim of the workspace ([`crate::device::Device::room`]): 1 well inside; the force
    /// is multiplied by it.
    pub(super) room: f32,
    /// The probe in the body's frame, metres.
    pub(super) probe: Vec3,
    /// The virtual tool; it is the probe unless there is a coupling.
    pub(super) tool: Tool,
    /// The witness point.
    pub(super) witness: W,
    /// Where friction holds the surface.
    pub(super) anchor: Anchor,
    /// What the passivity observer counted.
    pub(super) energy: Energy,
    /// How far the force is faded in, 0 to 1.
    pub(super) fade: f32,
    /// Force on the probe, N, in the device's frame, as the motors give it.
    pub(super) force: Vec3,
    /// Whether the motors are driven though no force is rendered: by homing, or to damp after a fault.
    pub(super) drives: bool,
    /// Duties now applied.
    pub(super) duties: [Duty; JOINTS],
    /// What the guard remembers.
    pub(super) guard: G,
}

impl<const JOINTS: usize, W: Tracked, G: Remembered> ServoState<JOINTS, W, G> {
    /// A hash of every bit of the state (FNV-1a over 32-bit words): two runs agree bit for bit if it agrees at each
    /// tick.
    pub fn digest(&self) -> u32 {
        let mut hash = Fnv::new();
        let (fault, fault_tick) = self.fault.map_or((0, 0), |(fault, tick)| (fault.code(), tick));
        let faults = u32::from(fault) | u32::from(self.later.map_or(0, Fault::code)) << 8;
        hash.words([self.phase as u32, faults, fault_tick, self.ticks]);
        hash.words([self.reset as u32, self.overruns, self.overruns_in_a_row, u32::from(self.overran)]);
        hash.words([self.link_silence, self.settled, u32::from(self.homed)]);
        self.homing.words(|word| hash.words([word]));
        hash.floats(self.angles_at_zero);
        let TableCheck { place, crc, passes, read } = self.table_check;
        hash.words([place.record, place.word, crc, passes, u32::from(read.is_some()), read.unwrap_or(0)]);
        hash.words([self.frames_lost, self.rejected_steps, u32::from(self.counts.is_some())]);
        let LostContact { count, in_a_row, tick, force, share } = self.lost_contact;
        hash.words([count, in_a_row, tick, share.to_bits(), u32::from(self.is_too_deep)]);
        hash.vectors([force]);
        for counts in self.counts.iter().flatten() {
            hash.words([counts.0 as u32]);
        }
        hash.floats(self.angles);
        hash.floats(self.rates);
        for velocity in &self.velocities {
            match velocity {
                VelocityState::LowPass(velocity) => hash.floats([*velocity]),
                VelocityState::BetweenCounts { lag, velocity } => hash.floats([*lag, *velocity]),
            }
        }
        hash.words([self.stillness.turn]);
        for (still, Counts(count)) in self.stillness.since.into_iter().zip(self.stillness.counts) {
            hash.floats(still);
            hash.words([count as u32]);
        }
        hash.floats([self.room]);
        hash.vectors([self.probe, self.tool.position, self.tool.velocity]);
        self.witness.for_each_word(|word| hash.words([word]));
        hash.words([u32::from(self.anchor.point.is_some()), u32::from(self.anchor.slips)]);
        hash.vectors([self.anchor.point.unwrap_or(Vec3::ZERO), self.force]);
        hash.floats([self.fade, self.energy.stored, self.energy.damping]);
        hash.words([u32::from(self.energy.cut) | u32::from(self.drives) << 1]);
        for duty in self.duties {
            hash.words([duty.0 as u32]);
        }
        self.guard.for_each_word(|word| hash.words([word]));
        hash.0
    }
}

impl<const JOINTS: usize, W, G> ServoState<JOINTS, W, G> {
    /// Joint angles, radians, as the estimators believe them: the middle of each count, or between counts.
    #[inline]
    pub(super) fn believed_angles(&self) -> [f32; JOINTS] {
        let mut angles = self.angles;
        for (angle, velocity) in angles.iter_mut().zip(&self.velocities) {
            *angle -= velocity.lag();
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
