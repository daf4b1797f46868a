//! The surface of a loop: a body, with one tracking law.

use palpate_core::body::{Body, BodyWitness, TableCursor};
use palpate_core::servo::{BakedTables, Surface, Touched};
use palpate_core::track::{Controller, Probe};

/// A body whose witness point always follows the law of second order, whatever the settings say: so the compiler sees
/// that no other law is used and links none.
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
