//! The surfaces that the loop can track: a patch, a body, or one of your own.

use crate::body::{Body, BodyWitness, Feature, TableCursor};
use crate::field::{MAX_MODES, Rigid};
use crate::math::{Vec3, saturate};
use crate::patch::{Patch, SplinePatch, crc32, crc32_of, crc32_with};
use crate::render::Penalty;
use crate::track::{Contact, Controller, Outcome, Probe, Witness};
use core::fmt::Debug;

/// A surface whose closest point can be followed from tick to tick.
///
/// A patch of your own is a surface as [`OnePatch`]. Any other surface implements this trait, here a plane:
///
/// ```
/// use palpate::math::Vec3;
/// use palpate::patch::SecondDerivatives;
/// use palpate::servo::{BakedTables, Surface, Touched, Tracked};
/// use palpate::track::{BoundaryMode, Contact, Controller, Probe, Witness};
/// # use palpate::patch::SurfacePoint;
///
/// /// Everything below z = 0.
/// struct Floor;
///
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// struct Below {
///     witness: Witness,
///     gap: f32,
///     contact: Contact,
/// }
///
/// impl Surface for Floor {
///     type Witness = Below;
///
///     fn rest(&self) -> Below {
///         let surface = SurfacePoint { point: Vec3::ZERO, tangent_u: Vec3::X, tangent_v: Vec3::Y };
///         let second = SecondDerivatives::NONE;
///         let mode = BoundaryMode::Interior;
///         let witness = Witness { parameters: [0.0; 2], surface, second, mode, is_free: true, halvings: 0 };
///         Below { witness, gap: 0.0, contact: Contact::default() }
///     }
///
///     fn follow(&self, _: &Controller, below: &mut Below, probe: Probe, _: f32) -> Touched {
///         below.witness.surface.point = Vec3::new(probe.position.x, probe.position.y, 0.0);
///         below.gap = probe.position.z;
///         below.contact = below.contact.next(below.gap, BoundaryMode::Interior);
///         Touched { normal: Vec3::Z, rejected: false, unexplained: false }
///     }
///
///     fn release(&self, below: &mut Below) {
///         below.contact = Contact::Behind;
///     }
/// }
///
/// impl BakedTables for Floor {}
///
/// impl Tracked for Below {
///     fn witness(&self) -> &Witness {
///         &self.witness
///     }
///     fn gap(&self) -> f32 {
///         self.gap
///     }
///     fn contact(&self) -> Contact {
///         self.contact
///     }
///     fn for_each_word(&self, mut take: impl FnMut(u32)) {
///         take(self.gap.to_bits());
///         take(self.contact as u32);
///     }
/// }
///
/// let mut below = Floor.rest();
/// Floor.follow(&Controller::SecondOrder, &mut below, Probe::at(Vec3::Z * 0.01), 1e-3);
/// Floor.follow(&Controller::SecondOrder, &mut below, Probe::at(Vec3::Z * -0.01), 1e-3);
/// assert_eq!(below.contact(), Contact::Touching);
/// ```
pub trait Surface: BakedTables {
    /// The state of the tracker between two ticks.
    type Witness: Tracked;

    /// Whether [`Self::push`] is its own. A [`crate::scene::Scene`] calls it of such a surface alone.
    const HAS_OWN_PUSH: bool = false;

    /// Whether it renders a tool with a shape ([`crate::pair::ToolSurface`]): the loop then refuses friction, texture and a
    /// virtual coupling, which are those of a point.
    const HAS_SHAPED_TOOL: bool = false;

    /// The state before the first tick.
    fn rest(&self) -> Self::Witness;

    /// Whether it works in a loop of this period, seconds: a surface with a motion of its own, as
    /// [`super::SoftBody`], is made for one. In another loop it is [`super::Fault::OtherRate`] from the start.
    fn is_for(&self, _period: f32) -> bool {
        true
    }

    /// One tick: bounded work, no panic. `period` in seconds.
    fn follow(&self, controller: &Controller, witness: &mut Self::Witness, probe: Probe, period: f32) -> Touched;

    /// The push on a tool, N, along the normal that [`Self::follow`] gave, by the loop's wall of this tick: called once
    /// after each `follow`, with `None` where nothing is touched. By default that of the wall.
    #[inline]
    fn push(&self, _: &mut Self::Witness, wall: &Penalty, touch: Option<ToolContact>) -> f32 {
        match touch {
            Some(touch) => wall.push(touch.gap_m, touch.velocity.dot(touch.normal)),
            None => 0.0,
        }
    }

    /// Releases contact when the tracked point is inconsistent with the probe's motion: the closest point is searched
    /// again, and there is no contact until the probe has been in front.
    fn release(&self, witness: &mut Self::Witness);

    /// Whether the probe is so deep behind the surface that the witness point is no longer proved to follow it.
    fn is_too_deep(&self, _: &Self::Witness) -> bool {
        false
    }

    /// Selects an entry, where the surface offers several ([`super::Event::Chosen`]).
    fn choose(&self, _: &mut Self::Witness, _: u8) {}

    /// The orientation of the tool, a quaternion `(x, y, z, w)` that takes its frame to the device's
    /// ([`super::Event::Oriented`]). A surface that a point touches has no use for it.
    fn orient(&self, _: &mut Self::Witness, _: [f32; 4]) {}

    /// Force starts with this tick: the loop comes to [`super::Phase::Running`].
    fn start_force(&self, _: &mut Self::Witness) {}

    /// Whole turns, of the encoder's count, that are no part of the first joint's angle any more
    /// ([`super::ServoState::turns`]).
    fn turn(&self, _: &mut Self::Witness, _: i32) {}

    /// The probe's place in a tick of a loop that a fault has stopped: nothing is followed.
    fn stopped(&self, _: &mut Self::Witness, _: Vec3) {}
}

/// A tool that touches a surface, in the body's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolContact {
    /// From the tool to the surface, metres; negative inside.
    pub gap_m: f32,
    /// Unit vector out of the body.
    pub normal: Vec3,
    /// The tool's velocity past the body, m/s.
    pub velocity: Vec3,
    /// The body's own motion, where the push moves all of it.
    pub carrier: Carrier,
    /// Length of a tick, s.
    pub period_s: f32,
}

impl ToolContact {
    /// The push of a wall, N, whose body moves as a whole under it: the spring's force with the body in the middle of the
    /// tick, not at its start.
    #[inline]
    pub fn carried(&self, push: f32, wall: &Penalty) -> f32 {
        let (Carrier { outward_m_per_s: towards, mobility_per_kg: mobility }, half) =
            (self.carrier, 0.5 * self.period_s);
        let yielding = 1.0 + half * mobility * (wall.stiffness_n_per_m * half + wall.damping_n_s_per_m);
        saturate((push + wall.stiffness_n_per_m * half * towards) / yielding, 0.0, wall.max_force_n)
    }
}

/// The motion of a free body at a point of its surface, along the outward normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Carrier {
    /// m/s.
    pub outward_m_per_s: f32,
    /// Its change by an impulse of 1 N·s, 1/kg.
    pub mobility_per_kg: f32,
}

impl Carrier {
    /// A body that no push moves.
    pub const FIXED: Self = Self { outward_m_per_s: 0.0, mobility_per_kg: 0.0 };
}

/// The tables of a surface in flash, for the check that they are still those that were baked. A surface without tables
/// takes the defaults: nothing is checked.
pub trait BakedTables {
    /// A word of the tables; `None` past the end of the cursor's record, and of the tables. Bounded work.
    fn table_word(&self, _: TableCursor) -> Option<u32> {
        None
    }

    /// The number of records of the tables, for a surface made of several.
    fn table_records(&self) -> u32 {
        1
    }

    /// CRC-32 of all words as they were baked; `None` for tables that carry none: they are not checked.
    fn baked_crc(&self) -> Option<u32> {
        None
    }
}

/// The state of a tracker, as the loop reads it.
pub trait Tracked: Copy + Debug + PartialEq {
    /// Whether all of the surface's force is its own ([`Self::own_force`]): the loop then adds no spring, friction or
    /// texture, and does not fade out the rest of a released contact.
    const HAS_OWN_FORCE_ONLY: bool = false;

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

    /// The index of the body in contact, of several.
    fn body(&self) -> u8 {
        0
    }

    /// `q` of each mode, metres, of a body that deforms; modes that it has not are 0.
    #[inline]
    fn modes(&self) -> Option<[f32; MAX_MODES]> {
        None
    }

    /// A force of the surface's own on the probe, N, in the body's frame, which needs no contact: that of a dial's detents,
    /// or of a field in an application's own crate. The loop limits it as it limits the force of contact.
    ///
    /// Of the floor in [`Surface`]'s example, 0.2 N downwards within 10 mm, beside the force of contact:
    ///
    /// ```
    /// # use palpate::math::Vec3;
    /// # struct Below { gap: f32 }
    /// # impl Below {
    /// fn own_force(&self) -> Option<Vec3> {
    ///     Some(Vec3::Z * if self.gap < 0.01 { -0.2 } else { 0.0 })
    /// }
    /// # }
    /// # assert_eq!(Below { gap: 0.005 }.own_force().map(|force| force.z), Some(-0.2));
    /// ```
    #[inline]
    fn own_force(&self) -> Option<Vec3> {
        None
    }

    /// Gives every word of the state to a hash.
    fn for_each_word(&self, take: impl FnMut(u32));
}

/// The result of a tick that the witness does not keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touched {
    /// Unit vector out of the body at the witness point, in the body's frame, or zero where there is none.
    pub normal: Vec3,
    /// Whether the controller's step was rejected.
    pub rejected: bool,
    /// Whether the witness point is farther from the probe than the probe has moved since the contact started.
    pub unexplained: bool,
}

impl<const KINDS: u32> Surface for Body<'_, Rigid<KINDS>> {
    type Witness = BodyWitness;

    fn rest(&self) -> BodyWitness {
        self.start()
    }

    #[inline]
    fn follow(&self, controller: &Controller, witness: &mut BodyWitness, probe: Probe, period: f32) -> Touched {
        let step = self.step(controller, witness, probe, period);
        Touched { normal: witness.normal, rejected: step.outcome == Outcome::Rejected, unexplained: step.unexplained }
    }

    fn release(&self, witness: &mut BodyWitness) {
        witness.forget();
    }

    #[inline]
    fn is_too_deep(&self, witness: &BodyWitness) -> bool {
        Self::is_too_deep(self, witness)
    }
}

impl<const KINDS: u32> BakedTables for Body<'_, Rigid<KINDS>> {
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
pub(crate) fn witness_words(witness: &Witness, mut take: impl FnMut(u32)) {
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

/// The state of a patch between two ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchWitness {
    witness: Witness,
    gap: f32,
    contact: Contact,
}

/// A patch of your own as a surface; a [`SplinePatch`] is one by itself.
///
/// ```
/// use palpate::patch::Patch;
/// use palpate::servo::{OnePatch, Surface};
///
/// fn surface_of<P: Patch>(patch: P) -> impl Surface {
///     OnePatch(patch)
/// }
/// # let _ = surface_of::<palpate::patch::SplinePatch>;
/// ```
#[derive(Clone, Copy, Debug)]
pub struct OnePatch<P>(pub P);

impl PatchWitness {
    fn rest(patch: &impl Patch) -> Self {
        Self { witness: Witness::at(patch, 0.5, 0.5), gap: 0.0, contact: Contact::default() }
    }

    #[inline(always)]
    fn follow(&mut self, patch: &impl Patch, controller: &Controller, probe: Probe, period: f32) -> Touched {
        let Self { witness, gap, contact } = self;
        let step = controller.step(patch, witness, probe, period);
        let normal = witness.normal(patch).unwrap_or(Vec3::ZERO);
        *gap = (probe.position - witness.surface.point).dot(normal);
        *contact = contact.next(*gap, witness.mode);
        Touched { normal, rejected: step.outcome == Outcome::Rejected, unexplained: false }
    }
}

/// The same for both: `$patch` is the patch in `$this`.
macro_rules! surface_of_a_patch {
    ($type:ty, [$($generics:tt)*], |$this:ident| $patch:expr) => {
        impl<$($generics)*> Surface for $type {
            type Witness = PatchWitness;

            fn rest(&self) -> PatchWitness {
                let $this = self;
                PatchWitness::rest($patch)
            }

            #[inline(always)]
            fn follow(&self, controller: &Controller, state: &mut PatchWitness, probe: Probe, period: f32) -> Touched {
                let $this = self;
                state.follow($patch, controller, probe, period)
            }

            fn release(&self, state: &mut PatchWitness) {
                state.contact = Contact::Behind;
            }
        }

        impl<$($generics)*> BakedTables for $type {
            fn table_word(&self, cursor: TableCursor) -> Option<u32> {
                let $this = self;
                if cursor.record == 0 { Patch::table_word($patch, cursor.word as usize) } else { None }
            }

            fn baked_crc(&self) -> Option<u32> {
                let $this = self;
                Patch::baked_crc($patch)
            }
        }
    };
}

surface_of_a_patch!(SplinePatch<'_>, [], |patch| patch);
surface_of_a_patch!(OnePatch<P>, [P: Patch], |wrapper| &wrapper.0);

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

/// Progress of the check that the tables in flash are those that were baked: they are read whole before the first tick,
/// and then repeatedly, a word every eighth tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableCheck {
    /// The next word.
    pub place: TableCursor,
    /// The CRC so far.
    pub crc: u32,
    /// How often the whole table was found good.
    pub passes: u32,
    /// Whether the last word that was read is not yet in the CRC; `crc` then holds both.
    pub is_read: bool,
}

impl TableCheck {
    /// Number of ticks between two steps; two steps are a word.
    pub const EVERY: u32 = 4;

    /// Reads one word more, or takes the last one into the CRC: some 40 instructions either way. False if the tables
    /// were read to their end and their CRC is not the expected one.
    #[inline]
    pub fn step<S: BakedTables>(&mut self, surface: &S, expected: u32) -> bool {
        if self.is_read {
            (self.crc, self.is_read) = (crc32_of(self.crc), false);
            return true;
        }
        let found = surface.table_word(self.place);
        if let Some(word) = found {
            (self.crc, self.is_read) = (crc32_with(self.crc, word), true);
        }
        let Some(next) = self.place.after(found) else {
            let good = self.crc == expected;
            *self = Self { passes: self.passes.wrapping_add(u32::from(good)), ..Self::default() };
            return good;
        };
        self.place = next;
        true
    }

    /// CRC-32 of the tables as they lie in memory, read from their start to their end: before the first tick, for it
    /// takes time in proportion to their size.
    pub fn read<S: BakedTables>(surface: &S) -> u32 {
        let (mut place, mut crc) = (TableCursor::default(), 0);
        loop {
            let found = surface.table_word(place);
            if let Some(word) = found {
                crc = crc32(crc, word);
            }
            match place.after(found) {
                Some(next) => place = next,
                None => return crc,
            }
        }
    }

    /// Reads the tables once, as [`Self::read`] does. True if they are good.
    pub fn run<S: BakedTables>(&mut self, surface: &S, expected: u32) -> bool {
        let good = Self::read(surface) == expected;
        *self = Self { passes: self.passes.wrapping_add(u32::from(good)), ..Self::default() };
        good
    }
}
