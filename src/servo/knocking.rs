//! A surface that rings when it is struck.

use super::surface::{Surface, Touched, Tracked};
use crate::body::TableCursor;
use crate::math::Vec3;
use crate::render::{Ring, Struck, Transient};
use crate::track::{Contact, Controller, Probe, Witness};

/// Any surface, which answers each blow with a [`Transient`]: a part of the surface, so that a loop without one has
/// none of it. The transient acts along the normal as long as the surface is touched, passes easing, limits and
/// passivity control as any force of a surface does, and ends with the contact.
///
/// ```
/// use palpate::render::Transient;
/// use palpate::servo::Knocking;
/// # use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch};
/// # static COEFFICIENTS: [[f32; 3]; 4] = [[0.0; 3], [0.0, 0.2, 0.0], [0.2, 0.0, 0.0], [0.0; 3]];
/// # static WALL: SplinePatch = SplinePatch::from_table(
/// #     [1, 1], &[0.0, 1.0], &[0.0, 1.0], Coefficients::Polynomial(&COEFFICIENTS),
/// #     ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 }), Orientation::Outward, 0.2,
/// # );
/// static TABLE_TOP: Option<Knocking<SplinePatch>> = Knocking::new(&WALL, Transient::WOOD, 4_000.0);
/// assert!(TABLE_TOP.is_some());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Knocking<'a, S> {
    surface: &'a S,
    struck: Struck,
}

/// What is kept of it between two ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnockingWitness<W> {
    within: W,
    ring: Ring,
    normal: Vec3,
}

impl<'a, S> Knocking<'a, S> {
    /// A surface with its transient at a rate, Hz; `None` for a transient that makes no sense there
    /// ([`Transient::at`]).
    pub const fn new(surface: &'a S, transient: Transient, rate: f32) -> Option<Self> {
        match transient.at(rate) {
            Some(struck) => Some(Self { surface, struck }),
            None => None,
        }
    }
}

impl<W> KnockingWitness<W> {
    /// What the surface itself keeps.
    pub const fn within(&self) -> &W {
        &self.within
    }

    /// What still rings.
    pub const fn ring(&self) -> Ring {
        self.ring
    }
}

impl<S: Surface> Surface for Knocking<'_, S> {
    const FEELS_ITSELF: bool = S::FEELS_ITSELF;

    type Witness = KnockingWitness<S::Witness>;

    fn rest(&self) -> Self::Witness {
        KnockingWitness { within: self.surface.rest(), ring: Ring::default(), normal: Vec3::ZERO }
    }

    #[inline]
    fn follow(&self, controller: &Controller, witness: &mut Self::Witness, probe: Probe, period: f32) -> Touched {
        let was = witness.within.contact();
        let touched = self.surface.follow(controller, &mut witness.within, probe, period);
        witness.normal = touched.normal;
        witness.ring = match (was, witness.within.contact()) {
            (Contact::Touching, Contact::Touching) => self.struck.next(witness.ring),
            (_, Contact::Touching) => self.struck.blow(-probe.velocity.dot(touched.normal)),
            (_, Contact::Behind | Contact::InFront) => Ring::default(),
        };
        touched
    }

    fn lose(&self, witness: &mut Self::Witness) {
        self.surface.lose(&mut witness.within);
        witness.ring = Ring::default();
    }

    #[inline]
    fn is_too_deep(&self, witness: &Self::Witness) -> bool {
        self.surface.is_too_deep(&witness.within)
    }

    #[inline]
    fn own_force(&self, witness: &Self::Witness) -> Option<Vec3> {
        let rings = witness.normal * witness.ring.push();
        Some(self.surface.own_force(&witness.within).map_or(rings, |own| own + rings))
    }

    fn choose(&self, witness: &mut Self::Witness, index: u8) {
        self.surface.choose(&mut witness.within, index);
    }

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

impl<W: Tracked> Tracked for KnockingWitness<W> {
    fn witness(&self) -> &Witness {
        self.within.witness()
    }

    fn gap(&self) -> f32 {
        self.within.gap()
    }

    fn contact(&self) -> Contact {
        self.within.contact()
    }

    fn feature(&self) -> u16 {
        self.within.feature()
    }

    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        self.within.for_each_word(&mut take);
        self.ring.words().into_iter().for_each(&mut take);
        for coordinate in self.normal.to_array() {
            take(coordinate.to_bits());
        }
    }
}
