//! The surface of a loop, with one tracking law.

use palpate_core::body::{Body, TableCursor};
use palpate_core::math::Vec3;
use palpate_core::render::Penalty;
use palpate_core::servo::{BakedTables, Surface, ToolContact, Touched};
use palpate_core::track::{Controller, Probe};

/// A surface whose witness point always follows the law of second order, whatever the settings say: so the compiler sees
/// that no other law is used and links none.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct Felt<S = Body<'static>>(pub S);

impl<S: Surface> Surface for Felt<S> {
    type Witness = S::Witness;

    const HAS_OWN_PUSH: bool = S::HAS_OWN_PUSH;
    const HAS_SHAPED_TOOL: bool = S::HAS_SHAPED_TOOL;

    fn rest(&self) -> S::Witness {
        self.0.rest()
    }

    fn is_for(&self, period: f32) -> bool {
        self.0.is_for(period)
    }

    #[inline]
    fn follow(&self, _: &Controller, witness: &mut S::Witness, probe: Probe, period: f32) -> Touched {
        self.0.follow(&Controller::SecondOrder, witness, probe, period)
    }

    #[inline]
    fn push(&self, witness: &mut S::Witness, wall: &Penalty, touch: Option<ToolContact>) -> f32 {
        self.0.push(witness, wall, touch)
    }

    fn release(&self, witness: &mut S::Witness) {
        self.0.release(witness);
    }

    fn choose(&self, witness: &mut S::Witness, index: u8) {
        self.0.choose(witness, index);
    }

    fn orient(&self, witness: &mut S::Witness, orientation: [f32; 4]) {
        self.0.orient(witness, orientation);
    }

    fn start_force(&self, witness: &mut S::Witness) {
        self.0.start_force(witness);
    }

    fn turn(&self, witness: &mut S::Witness, turns: i32) {
        self.0.turn(witness, turns);
    }

    fn stopped(&self, witness: &mut S::Witness, probe: Vec3) {
        self.0.stopped(witness, probe);
    }

    #[inline]
    fn is_too_deep(&self, witness: &S::Witness) -> bool {
        self.0.is_too_deep(witness)
    }
}

impl<S: BakedTables> BakedTables for Felt<S> {
    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        self.0.table_word(cursor)
    }

    fn baked_crc(&self) -> Option<u32> {
        self.0.baked_crc()
    }
}
