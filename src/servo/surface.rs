//! What the loop can touch: a patch, a body, or a surface of your own.

use crate::body::{Body, BodyWitness, Feature, TableCursor};
use crate::math::Vec3;
use crate::order::{Order, SceneError};
use crate::track::{Contact, Controller, Outcome, Probe, Witness};
use core::fmt::Debug;

/// A surface whose closest point can be followed from tick to tick.
pub trait Surface {
    /// Whether all of its force is its own ([`Self::own_force`]): the loop then adds no spring, friction or texture to
    /// it, and does not fade out what is left of contact that was lost.
    const FEELS_ITSELF: bool = false;

    /// What is kept between two ticks.
    type Witness: Tracked;

    /// Before the first tick.
    fn rest(&self) -> Self::Witness;

    /// One tick: bounded work, no panic. `period` in seconds.
    fn follow(&self, controller: &Controller, witness: &mut Self::Witness, probe: Probe, period: f32) -> Touched;

    /// Ends contact that no motion explains: where the closest point is has to be found anew, and nothing is touched
    /// until the probe has been in front.
    fn lose(&self, witness: &mut Self::Witness);

    /// Whether the probe is so deep behind the surface that the witness point is no longer proved to follow it.
    fn is_too_deep(&self, _: &Self::Witness) -> bool {
        false
    }

    /// A force of its own on the probe, N, which needs no contact: that of a dial's detents. The loop treats it as it
    /// treats a surface's.
    #[inline]
    fn own_force(&self, _: &Self::Witness) -> Option<Vec3> {
        None
    }

    /// Somebody has chosen another of what it can feel like ([`super::Event::Chosen`]).
    fn choose(&self, _: &mut Self::Witness, _: u8) {}

    /// Does what a host asks for between two ticks, or nothing. Bounded work.
    ///
    /// # Errors
    /// What is out of range, or not offered.
    fn obey(&self, witness: &mut Self::Witness, order: &Order) -> Result<(), SceneError> {
        let _ = (witness, order);
        Err(SceneError::NotOffered)
    }

    /// A word of the tables, for the check that flash still holds what was baked; `None` past the end of the cursor's
    /// record, and of the tables. Bounded work.
    fn table_word(&self, cursor: TableCursor) -> Option<u32>;

    /// How many records the tables have: for what is put together from several.
    fn table_records(&self) -> u32 {
        1
    }

    /// CRC-32 of all those words as they were baked; `None` for tables that carry none: they are not checked.
    fn baked_crc(&self) -> Option<u32>;
}

/// The state of a tracker, as the loop looks at it.
pub trait Tracked: Copy + Debug + PartialEq {
    /// The witness point.
    fn witness(&self) -> &Witness;

    /// Signed gap along the outward normal, metres; negative behind the surface.
    fn gap(&self) -> f32;

    /// Whether the surface is touched.
    fn contact(&self) -> Contact;

    /// The feature it lies on, see [`Feature::code`]; 0 for a surface of one patch.
    fn feature(&self) -> u16 {
        0
    }

    /// The index of the body that is felt, of several.
    fn body(&self) -> u8 {
        0
    }

    /// Gives every word of the state to a hash.
    fn for_each_word(&self, take: impl FnMut(u32));
}

/// What a tick has found, beside what the witness keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touched {
    /// Unit vector out of the body at the witness point, or zero where there is none.
    pub normal: Vec3,
    /// Whether the controller's step was rejected.
    pub rejected: bool,
    /// Whether the witness point is farther from the probe than the probe has moved since contact began.
    pub unexplained: bool,
}

impl Surface for Body<'_> {
    type Witness = BodyWitness;

    fn rest(&self) -> BodyWitness {
        self.start()
    }

    #[inline]
    fn follow(&self, controller: &Controller, witness: &mut BodyWitness, probe: Probe, period: f32) -> Touched {
        let step = self.step(controller, witness, probe, period);
        Touched { normal: witness.normal, rejected: step.outcome == Outcome::Rejected, unexplained: step.unexplained }
    }

    fn lose(&self, witness: &mut BodyWitness) {
        witness.forget();
    }

    #[inline]
    fn is_too_deep(&self, witness: &BodyWitness) -> bool {
        Self::is_too_deep(self, witness)
    }

    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        Self::table_word(self, cursor)
    }

    fn table_records(&self) -> u32 {
        Self::table_records(self)
    }

    fn baked_crc(&self) -> Option<u32> {
        Self::baked_crc(self)
    }
}

impl Tracked for BodyWitness {
    fn witness(&self) -> &Witness {
        &self.witness
    }

    fn gap(&self) -> f32 {
        self.gap
    }

    fn contact(&self) -> Contact {
        self.contact
    }

    fn feature(&self) -> u16 {
        self.feature.code()
    }

    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        witness_words(&self.witness, &mut take);
        take(u32::from(self.feature.code()) | u32::from(self.is_located) << 16 | (self.contact as u32) << 17);
        for coordinate in self.normal.to_array() {
            take(coordinate.to_bits());
        }
        take(self.gap.to_bits());
        take(self.reach.to_bits());
    }
}

/// Every word of a witness point.
pub(super) fn witness_words(witness: &Witness, mut take: impl FnMut(u32)) {
    for parameter in witness.parameters {
        take(parameter.to_bits());
    }
    let surface = &witness.surface;
    let second = &witness.second;
    for vector in [surface.point, surface.tangent_u, surface.tangent_v, second.half_uu, second.uv, second.half_vv] {
        for coordinate in vector.to_array() {
            take(coordinate.to_bits());
        }
    }
    take(witness.mode as u32 | u32::from(witness.is_free) << 8 | u32::from(witness.halvings) << 16);
}

impl Feature {
    /// As a number: the index of a face, of an edge with bit 14 set, of a vertex with bit 15.
    pub const fn code(self) -> u16 {
        match self {
            Self::Face(index) => index,
            Self::Edge(index) => index | 1 << 14,
            Self::Vertex(index) => index | 1 << 15,
        }
    }
}
