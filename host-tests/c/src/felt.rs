//! What a loop feels: a body, by one law.

use palpate_core::body::{Body, BodyWitness, TableCursor};
use palpate_core::servo::{BakedTables, Surface, Touched};
use palpate_core::track::{Controller, Probe};

/// A body whose closest point is followed by the law of second order, whatever the loop says: so the compiler sees that
/// there is no other, and links none.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct Felt(pub Body<'static>);

impl Surface for Felt {
    type Witness = BodyWitness;

    fn rest(&self) -> BodyWitness {
        self.0.rest()
    }

    #[inline]
    fn follow(&self, _: &Controller, witness: &mut BodyWitness, probe: Probe, period: f32) -> Touched {
        self.0.follow(&Controller::SecondOrder, witness, probe, period)
    }

    fn release(&self, witness: &mut BodyWitness) {
        self.0.release(witness);
    }

    #[inline]
    fn is_too_deep(&self, witness: &BodyWitness) -> bool {
        Surface::is_too_deep(&self.0, witness)
    }
}

impl BakedTables for Felt {
    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        self.0.table_word(cursor)
    }

    fn baked_crc(&self) -> Option<u32> {
        self.0.baked_crc()
    }
}
