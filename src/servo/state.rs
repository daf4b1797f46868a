//! Everything that changes from tick to tick.

use super::{Fault, Phase};
use crate::device::{Counts, Duty};
use crate::math::Vec3;
use crate::render::Contact;
use crate::track::Witness;

/// The state of the loop after a tick. A plain value: copy it, compare it, keep it in RAM.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoState<const JOINTS: usize> {
    /// What the loop is doing.
    pub phase: Phase,
    /// What stopped it, and at which tick. Latched.
    pub fault: Option<(Fault, u32)>,
    /// Ticks done.
    pub ticks: u32,
    /// Frames lost, late or damaged so far.
    pub frames_lost: u32,
    /// Controller steps that were undone because the distance would have risen.
    pub steps_undone: u32,
    /// The last good encoder counts; `None` before the first.
    pub counts: Option<[Counts; JOINTS]>,
    /// Joint angles, radians.
    pub angles: [f32; JOINTS],
    /// Joint rates, rad/s, filtered.
    pub rates: [f32; JOINTS],
    /// The probe in the body's frame, metres.
    pub probe: Vec3,
    /// The witness point.
    pub witness: Witness,
    /// Signed gap along the outward normal, metres; negative behind the surface.
    pub gap: f32,
    /// Whether the surface is touched.
    pub contact: Contact,
    /// How far the force is faded in, 0 to 1.
    pub fade: f32,
    /// Force on the probe, N, in the device's frame.
    pub force: Vec3,
    /// Duties now applied.
    pub duties: [Duty; JOINTS],
}

impl<const JOINTS: usize> ServoState<JOINTS> {
    /// A hash of every bit of the state (FNV-1a over 32-bit words): two runs agree bit for bit if it agrees at each tick.
    pub fn digest(&self) -> u32 {
        let mut hash = Fnv::new();
        let (fault, fault_tick) = self.fault.map_or((0, 0), |(fault, tick)| (fault.code(), tick));
        hash.words([self.phase as u32, u32::from(fault), fault_tick, self.ticks]);
        hash.words([self.frames_lost, self.steps_undone, u32::from(self.counts.is_some())]);
        for counts in self.counts.iter().flatten() {
            hash.words([counts.0 as u32]);
        }
        hash.floats(self.angles);
        hash.floats(self.rates);
        hash.floats(self.probe.to_array());
        let witness = &self.witness;
        hash.floats(witness.parameters);
        for vector in [witness.surface.point, witness.surface.tangent_u, witness.surface.tangent_v] {
            hash.floats(vector.to_array());
        }
        hash.words([witness.mode as u32, self.contact as u32]);
        hash.floats([witness.caution, self.gap, self.fade]);
        hash.floats(self.force.to_array());
        for duty in self.duties {
            hash.words([duty.0 as u32]);
        }
        hash.0
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
}
