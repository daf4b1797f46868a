//! A surface that dents where it is touched: the loop's spring is that of Hertz's contact.

use super::surface::{BakedTables, Surface, ToolContact, Touched};
use crate::body::TableCursor;
use crate::math::Vec3;
use crate::render::{Hertz, Penalty};
use crate::track::{Controller, Probe};

/// A surface with local compliance. Its stiffness is at most the loop's, or that of its [`crate::scene::Material`]: set
/// it to [`Hertz::steepest_n_per_m`] of the maximum force. Beyond, the force goes on straight.
///
/// ```
/// use palpate::patch::SplinePatch;
/// use palpate::render::Hertz;
/// use palpate::servo::{Hertzian, Surface};
///
/// const FOAM: Hertz = Hertz::new(5e4, 0.008);
/// fn dented<'a>(patch: &'a SplinePatch<'a>) -> impl Surface + 'a {
///     Hertzian::new(patch, FOAM)
/// }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Hertzian<'a, S> {
    surface: &'a S,
    contact: Hertz,
}

impl<'a, S> Hertzian<'a, S> {
    /// A surface and its contact with the tool.
    pub const fn new(surface: &'a S, contact: Hertz) -> Self {
        Self { surface, contact }
    }

    /// The surface without its dent.
    pub const fn surface(&self) -> &'a S {
        self.surface
    }
}

impl<S: Surface> Surface for Hertzian<'_, S> {
    type Witness = S::Witness;

    const HAS_OWN_PUSH: bool = true;
    const HAS_SHAPED_TOOL: bool = S::HAS_SHAPED_TOOL;

    fn rest(&self) -> S::Witness {
        self.surface.rest()
    }

    #[inline]
    fn is_for(&self, period: f32) -> bool {
        self.surface.is_for(period)
    }

    #[inline]
    fn follow(&self, controller: &Controller, witness: &mut S::Witness, probe: Probe, period: f32) -> Touched {
        self.surface.follow(controller, witness, probe, period)
    }

    /// That of a wall which has the contact's force and stiffness at this depth, so that modes and a free body yield to
    /// it as to a wall.
    fn push(&self, witness: &mut S::Witness, wall: &Penalty, touch: Option<ToolContact>) -> f32 {
        let depth = touch.map_or(0.0, |touch| -touch.gap_m);
        let [force, stiffness_n_per_m] = self.contact.at(depth, wall.stiffness_n_per_m);
        let Some(touch) = touch.filter(|_| force > 0.0) else { return self.surface.push(witness, wall, None) };
        let wall = Penalty { stiffness_n_per_m, ..*wall };
        let touch = ToolContact { gap_m: -force / stiffness_n_per_m, ..touch };
        let push = self.surface.push(witness, &wall, Some(touch));
        if !S::HAS_OWN_PUSH && touch.carrier.mobility_per_kg > 0.0 { touch.carried(push, &wall) } else { push }
    }

    fn release(&self, witness: &mut S::Witness) {
        self.surface.release(witness);
    }

    #[inline]
    fn is_too_deep(&self, witness: &S::Witness) -> bool {
        self.surface.is_too_deep(witness)
    }

    fn choose(&self, witness: &mut S::Witness, index: u8) {
        self.surface.choose(witness, index);
    }

    fn orient(&self, witness: &mut S::Witness, orientation: [f32; 4]) {
        self.surface.orient(witness, orientation);
    }

    #[inline]
    fn start_force(&self, witness: &mut S::Witness) {
        self.surface.start_force(witness);
    }

    fn turn(&self, witness: &mut S::Witness, turns: i32) {
        self.surface.turn(witness, turns);
    }

    fn stopped(&self, witness: &mut S::Witness, probe: Vec3) {
        self.surface.stopped(witness, probe);
    }
}

impl<S: BakedTables> BakedTables for Hertzian<'_, S> {
    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        self.surface.table_word(cursor)
    }

    fn table_records(&self) -> u32 {
        self.surface.table_records()
    }

    fn baked_crc(&self) -> Option<u32> {
        self.surface.baked_crc()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::presets::GIMBAL_KNOB;
    use crate::render::Feel;
    use crate::servo::{Knob, KnobWitness};

    /// A knob takes all of them.
    #[test]
    fn what_the_loop_tells_a_surface_reaches_the_one_within() {
        static FEELS: [Feel; 2] = [Feel::FREE; 2];
        const KNOB: Knob = Knob::new(&GIMBAL_KNOB, &FEELS, 1.0);
        let dented = Hertzian::new(&KNOB, Hertz::new(5e4, 0.008));
        let is_passed_on = |tell: &dyn Fn(&mut KnobWitness), tell_within: &dyn Fn(&mut KnobWitness)| {
            let (mut told, mut expected) = (dented.rest(), KNOB.rest());
            assert_eq!(told, expected);
            tell(&mut told);
            tell_within(&mut expected);
            told == expected && told != KNOB.rest()
        };
        assert!(is_passed_on(&|told| dented.choose(told, 1), &|told| KNOB.choose(told, 1)));
        assert!(is_passed_on(&|told| dented.start_force(told), &|told| KNOB.start_force(told)));
        assert!(is_passed_on(&|told| dented.turn(told, 3), &|told| KNOB.turn(told, 3)));
        assert!(is_passed_on(&|told| dented.stopped(told, Vec3::X), &|told| KNOB.stopped(told, Vec3::X)));
    }
}
