//! A single patch as what the loop touches: the tracker's witness point, and whether it is touched.

use super::surface::{Surface, Touched, Tracked, witness_words};
use crate::body::TableCursor;
use crate::math::Vec3;
use crate::patch::Patch;
use crate::track::{Contact, Controller, Outcome, Probe, Witness};

/// What is kept of a patch between two ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchWitness {
    witness: Witness,
    gap: f32,
    contact: Contact,
}

impl<P: Patch> Surface for P {
    type Witness = PatchWitness;

    fn rest(&self) -> PatchWitness {
        PatchWitness { witness: Witness::at(self, 0.5, 0.5), gap: 0.0, contact: Contact::default() }
    }

    #[inline(always)]
    fn follow(&self, controller: &Controller, state: &mut PatchWitness, probe: Probe, period: f32) -> Touched {
        let PatchWitness { witness, gap, contact } = state;
        let step = controller.step(self, witness, probe, period);
        let normal = witness.normal(self).unwrap_or(Vec3::ZERO);
        *gap = (probe.position - witness.surface.point).dot(normal);
        *contact = contact.next(*gap, witness.mode);
        Touched { normal, rejected: step.outcome == Outcome::Rejected, unexplained: false }
    }

    fn lose(&self, state: &mut PatchWitness) {
        state.contact = Contact::Behind;
    }

    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        if cursor.record == 0 { Patch::table_word(self, cursor.word as usize) } else { None }
    }

    fn baked_crc(&self) -> Option<u32> {
        Patch::baked_crc(self)
    }
}

impl Tracked for PatchWitness {
    fn witness(&self) -> &Witness {
        &self.witness
    }

    fn gap(&self) -> f32 {
        self.gap
    }

    fn contact(&self) -> Contact {
        self.contact
    }

    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        witness_words(&self.witness, &mut take);
        take(self.contact as u32);
        take(self.gap.to_bits());
    }
}
