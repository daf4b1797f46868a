//! What the loop can touch: a patch, a body, or a surface of your own.

use crate::body::{Body, BodyWitness, Feature, TableCursor};
use crate::math::Vec3;
use crate::patch::Patch;
use crate::render::Contact;
use crate::track::{Controller, Outcome, Probe, Witness};
use core::fmt::Debug;

/// A surface whose closest point can be followed from tick to tick.
pub trait Surface {
    /// What is kept between two ticks.
    type Witness: Tracked;

    /// Before the first tick.
    fn rest(&self) -> Self::Witness;

    /// One tick: bounded work, no panic. `contact` is that of the last tick, `period` in seconds.
    fn follow(
        &self,
        controller: &Controller,
        witness: &mut Self::Witness,
        probe: Probe,
        contact: Contact,
        period: f32,
    ) -> Touched;

    /// A word of the tables, for the check that flash still holds what was baked; `None` past the end of the cursor's record, and of the
    /// tables. Bounded work.
    fn table_word(&self, cursor: TableCursor) -> Option<u32>;
}

/// The state of a tracker, as the loop looks at it.
pub trait Tracked: Copy + Debug + PartialEq {
    /// The witness point.
    fn witness(&self) -> &Witness;

    /// The feature it lies on, see [`Feature::code`]; 0 for a surface of one patch.
    fn feature(&self) -> u16 {
        0
    }

    /// Gives every word of the state to a hash.
    fn for_each_word(&self, take: impl FnMut(u32));
}

/// What a tick has found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touched {
    /// Unit vector out of the body at the witness point, or zero where there is none.
    pub normal: Vec3,
    /// Signed gap along it, metres; negative behind the surface.
    pub gap: f32,
    /// Whether the surface is touched.
    pub contact: Contact,
    /// Whether the controller's step was undone.
    pub undone: bool,
}

impl<P: Patch> Surface for P {
    type Witness = Witness;

    fn rest(&self) -> Witness {
        Witness::at(self, 0.5, 0.5)
    }

    #[inline(always)]
    fn follow(
        &self,
        controller: &Controller,
        witness: &mut Witness,
        probe: Probe,
        contact: Contact,
        period: f32,
    ) -> Touched {
        let step = controller.step(self, witness, probe, period);
        let normal = witness.normal(self).unwrap_or(Vec3::ZERO);
        let gap = (probe.position - witness.surface.point).dot(normal);
        Touched { normal, gap, contact: contact.next(gap, witness.mode), undone: step.outcome == Outcome::Undone }
    }

    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        if cursor.record == 0 { Patch::table_word(self, cursor.word as usize) } else { None }
    }
}

impl Tracked for Witness {
    fn witness(&self) -> &Witness {
        self
    }

    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        for parameter in self.parameters {
            take(parameter.to_bits());
        }
        let surface = &self.surface;
        for vector in [surface.point, surface.tangent_u, surface.tangent_v] {
            for coordinate in vector.to_array() {
                take(coordinate.to_bits());
            }
        }
        take(self.mode as u32 | u32::from(self.is_free) << 8 | u32::from(self.halvings) << 16);
    }
}

impl Surface for Body {
    type Witness = BodyWitness;

    fn rest(&self) -> BodyWitness {
        self.start()
    }

    #[inline]
    fn follow(
        &self,
        controller: &Controller,
        witness: &mut BodyWitness,
        probe: Probe,
        _: Contact,
        period: f32,
    ) -> Touched {
        let step = self.step(controller, witness, probe, period);
        let BodyWitness { normal, gap, contact, .. } = *witness;
        Touched { normal, gap, contact, undone: step.outcome == Outcome::Undone }
    }

    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        Self::table_word(self, cursor)
    }
}

impl Tracked for BodyWitness {
    fn witness(&self) -> &Witness {
        &self.witness
    }

    fn feature(&self) -> u16 {
        self.feature.code()
    }

    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        self.witness.for_each_word(&mut take);
        take(u32::from(self.feature.code()) | u32::from(self.is_located) << 16 | (self.contact as u32) << 17);
        for coordinate in self.normal.to_array() {
            take(coordinate.to_bits());
        }
        take(self.gap.to_bits());
    }
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
