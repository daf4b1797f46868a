//! The surface that the loop renders: a body, one that gives way, one under a tool with a shape, or one patch. None adds
//! words to the state.

use alloc::boxed::Box;
use alloc::string::{String, ToString as _};
use alloc::vec;
use alloc::vec::Vec;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};
use palpate::body::{Body, BodyBuffer, BodyWitness, Edge, Effort, Face, Feature, FileHead, Soft, TableCursor};
use palpate::field::{Bump, FieldBounds, MAX_MODES, Modal, Mode, Quadratic};
use palpate::math::{Vec3, inverse_sqrt, sqrt};
use palpate::pair::{HeldTool, ToolSurface};
use palpate::patch::SplinePatch;
use palpate::render::Penalty;
use palpate::servo::{BakedTables, PatchWitness, SoftBody, SoftContact, Surface, ToolContact, Touched, Tracked};
use palpate::track::{Contact, Controller, Outcome, Probe, Witness};

/// A surface that is chosen when the page runs.
#[derive(Clone, Copy, Debug)]
pub enum Felt {
    /// All patches, joined.
    Body(Body<'static>),
    /// The same with modes.
    Soft(&'static Yielding),
    /// A body under a tool with a shape.
    Tool(ToolSurface<'static>),
    /// A patch alone.
    Patch(SplinePatch<'static>),
}

/// Its witness point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeltWitness {
    /// State of the surface.
    pub kept: Kept,
    /// Evaluations of patches in the last tick.
    pub spent: u8,
}

/// State of a surface between ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a witness is `Copy`")]
pub enum Kept {
    /// On a body.
    Body(BodyWitness),
    /// On one that gives way.
    Soft(SoftContact),
    /// Of a tool with a shape.
    Tool(HeldTool),
    /// On a patch.
    Patch(PatchWitness),
}

impl Surface for Felt {
    type Witness = FeltWitness;

    fn rest(&self) -> FeltWitness {
        let kept = match self {
            Self::Body(body) => Kept::Body(body.rest()),
            Self::Soft(soft) => Kept::Soft(soft.body.rest()),
            Self::Tool(tool) => Kept::Tool(tool.rest()),
            Self::Patch(patch) => Kept::Patch(patch.rest()),
        };
        FeltWitness { kept, spent: 0 }
    }

    fn follow(&self, controller: &Controller, witness: &mut FeltWitness, probe: Probe, period: f32) -> Touched {
        let FeltWitness { kept, spent } = witness;
        match (self, kept) {
            (Self::Body(body), Kept::Body(witness)) => {
                // As the body's own `follow`, which keeps to itself what was spent.
                let step = body.step(controller, witness, probe, period);
                *spent = step.evaluations;
                let rejected = step.outcome == Outcome::Rejected;
                Touched { normal: witness.normal, rejected, unexplained: step.unexplained }
            }
            (Self::Soft(soft), Kept::Soft(contact)) => {
                soft.hold(contact);
                // Its evaluations are not counted here.
                *spent = 0;
                soft.body.follow(controller, contact, probe, period)
            }
            (Self::Tool(tool), Kept::Tool(held)) => {
                let touched = tool.follow(controller, held, probe, period);
                *spent = held.proxy().evaluations().min(255) as u8;
                touched
            }
            (Self::Patch(patch), Kept::Patch(witness)) => {
                *spent = 1;
                patch.follow(controller, witness, probe, period)
            }
            // Each surface makes its own witness.
            _ => Touched { normal: Vec3::ZERO, rejected: false, unexplained: false },
        }
    }

    fn is_for(&self, period: f32) -> bool {
        match self {
            Self::Soft(soft) => soft.body.is_for(period),
            Self::Tool(tool) => tool.is_for(period),
            Self::Body(_) | Self::Patch(_) => true,
        }
    }

    fn push(&self, witness: &mut FeltWitness, wall: &Penalty, touch: Option<ToolContact>) -> f32 {
        match (self, &mut witness.kept) {
            (Self::Body(body), Kept::Body(witness)) => body.push(witness, wall, touch),
            (Self::Soft(soft), Kept::Soft(contact)) => soft.body.push(contact, wall, touch),
            (Self::Tool(tool), Kept::Tool(held)) => tool.push(held, wall, touch),
            (Self::Patch(patch), Kept::Patch(witness)) => patch.push(witness, wall, touch),
            _ => 0.0,
        }
    }

    fn release(&self, witness: &mut FeltWitness) {
        match (self, &mut witness.kept) {
            (Self::Body(body), Kept::Body(witness)) => body.release(witness),
            (Self::Soft(soft), Kept::Soft(contact)) => soft.body.release(contact),
            (Self::Tool(tool), Kept::Tool(held)) => tool.release(held),
            (Self::Patch(patch), Kept::Patch(witness)) => patch.release(witness),
            _ => {}
        }
    }

    fn is_too_deep(&self, witness: &FeltWitness) -> bool {
        match (self, &witness.kept) {
            (Self::Body(body), Kept::Body(witness)) => Surface::is_too_deep(body, witness),
            (Self::Soft(soft), Kept::Soft(contact)) => soft.body.is_too_deep(contact),
            (Self::Tool(tool), Kept::Tool(held)) => tool.is_too_deep(held),
            (Self::Patch(patch), Kept::Patch(witness)) => Surface::is_too_deep(patch, witness),
            _ => false,
        }
    }

    fn orient(&self, witness: &mut FeltWitness, orientation: [f32; 4]) {
        if let (Self::Tool(tool), Kept::Tool(held)) = (self, &mut witness.kept) {
            tool.orient(held, orientation);
        }
    }
}

impl BakedTables for Felt {
    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        match self {
            Self::Body(body) => body.table_word(cursor),
            Self::Soft(soft) => soft.body.table_word(cursor),
            Self::Tool(tool) => tool.table_word(cursor),
            Self::Patch(patch) => BakedTables::table_word(patch, cursor),
        }
    }

    fn table_records(&self) -> u32 {
        match self {
            Self::Body(body) => BakedTables::table_records(body),
            Self::Soft(soft) => soft.body.table_records(),
            Self::Tool(tool) => tool.table_records(),
            Self::Patch(patch) => BakedTables::table_records(patch),
        }
    }

    fn baked_crc(&self) -> Option<u32> {
        match self {
            Self::Body(body) => body.baked_crc(),
            Self::Soft(soft) => soft.body.baked_crc(),
            Self::Tool(tool) => tool.baked_crc(),
            Self::Patch(patch) => BakedTables::baked_crc(patch),
        }
    }
}

impl Tracked for FeltWitness {
    fn witness(&self) -> &Witness {
        match &self.kept {
            Kept::Body(body) => body.witness(),
            Kept::Soft(contact) => contact.witness(),
            Kept::Tool(held) => held.witness(),
            Kept::Patch(patch) => patch.witness(),
        }
    }

    fn gap(&self) -> f32 {
        match &self.kept {
            Kept::Body(body) => body.gap(),
            Kept::Soft(contact) => contact.gap(),
            Kept::Tool(held) => held.gap(),
            Kept::Patch(patch) => patch.gap(),
        }
    }

    fn contact(&self) -> Contact {
        match &self.kept {
            Kept::Body(body) => body.contact(),
            Kept::Soft(contact) => contact.contact(),
            Kept::Tool(held) => held.contact(),
            Kept::Patch(patch) => patch.contact(),
        }
    }

    fn feature(&self) -> u16 {
        match &self.kept {
            Kept::Body(body) => body.feature(),
            Kept::Soft(contact) => contact.feature(),
            Kept::Tool(held) => held.feature(),
            Kept::Patch(patch) => patch.feature(),
        }
    }

    fn for_each_word(&self, take: impl FnMut(u32)) {
        match &self.kept {
            Kept::Body(body) => body.for_each_word(take),
            Kept::Soft(contact) => contact.for_each_word(take),
            Kept::Tool(held) => held.for_each_word(take),
            Kept::Patch(patch) => patch.for_each_word(take),
        }
    }
}

impl FeltWitness {
    /// Unit vector out of the surface at the witness point; zero without one.
    pub fn normal(&self, felt: &Felt) -> Vec3 {
        match (&self.kept, felt) {
            (Kept::Body(witness), _) => witness.normal,
            (Kept::Soft(contact), _) => contact.track().body.normal,
            (Kept::Tool(held), _) => out_of(held),
            (Kept::Patch(witness), Felt::Patch(patch)) => witness.witness().normal(patch).unwrap_or(Vec3::ZERO),
            _ => Vec3::ZERO,
        }
    }

    /// `q` of each mode at which the surface was tracked, metres; zero of a rigid one.
    pub fn q(&self) -> [f32; MAX_MODES] {
        match &self.kept {
            Kept::Soft(contact) => *contact.track().q(),
            Kept::Body(_) | Kept::Tool(_) | Kept::Patch(_) => [0.0; MAX_MODES],
        }
    }

    /// Which face, edge or vertex it lies on.
    pub fn place(&self) -> Feature {
        match &self.kept {
            Kept::Body(witness) => witness.feature,
            Kept::Soft(contact) => contact.track().body.feature,
            Kept::Tool(held) => Feature::Face(held.feature()),
            Kept::Patch(_) => Feature::Face(0),
        }
    }
}

/// Unit vector from the hand's tool to the drawn one, which is held outside; before contact from the body's point to the
/// tool's. Zero without either.
fn out_of(held: &HeldTool) -> Vec3 {
    let away = match held.contact() {
        Contact::Touching => -held.proxy().stretch(),
        Contact::InFront | Contact::Behind => -held.proxy().difference(),
    };
    let squared = away.length_squared();
    if squared > f32::MIN_POSITIVE { away * inverse_sqrt(squared) } else { Vec3::ZERO }
}

// A body that gives way, with modes that a reader may hold.

/// A body with its modes, and where a reader holds them.
#[derive(Clone, Copy, Debug)]
pub struct Yielding {
    /// The surface.
    pub body: SoftBody<'static>,
    motion: &'static [Modal],
    /// Bits of `q`, metres; those of a NaN where the mode moves freely.
    held: &'static [AtomicU32; MAX_MODES],
}

/// Numbers of a mode, as `palpate_tool::page` writes them: its field, its bump with a radius of 0 where there is none,
/// limit, bounds and motion.
const NUMBERS: usize = 30 + 7 + 1 + 4 + 3;

impl Yielding {
    /// Modes from their numbers.
    ///
    /// # Errors
    /// The error in the modes, in a sentence.
    fn of(body: Body<'static>, numbers: &[f32], rate: f32) -> Result<Self, String> {
        let mut modes = Vec::new();
        let mut motion = Vec::new();
        for numbers in numbers.as_chunks::<NUMBERS>().0 {
            let vectors: Vec<Vec3> =
                numbers.as_chunks::<3>().0.iter().map(|vector| Vec3::from_array(*vector)).collect();
            let [constant, x, y, z, xx, xy, xz, yy, yz, zz, direction, at, ..] = vectors[..] else { continue };
            let [.., radius, limit, moves, stretch, bend, twist, mass_kg, damping_n_s_per_m, stiffness_n_per_m] =
                *numbers;
            modes.push(Mode {
                field: Quadratic { constant, linear: [x, y, z], quadratic: [xx, xy, xz, yy, yz, zz] },
                bump: (radius > 0.0).then_some(Bump { direction, at, radius }),
                limit,
                bounds: FieldBounds { motion: moves, stretch, bend, twist },
            });
            motion.push(Modal { mass_kg, damping_n_s_per_m, stiffness_n_per_m });
        }
        let soft = Soft::new(body, modes.leak()).map_err(|error| error.to_string())?;
        let motion: &'static [Modal] = motion.leak();
        let held = Box::leak(Box::new([const { AtomicU32::new(f32::NAN.to_bits()) }; MAX_MODES]));
        let body = SoftBody::new(soft, motion, rate).map_err(|error| error.to_string())?;
        Ok(Self { body, motion, held })
    }

    /// For a loop of another rate, Hz.
    fn at_rate(&self, rate: f32) -> Result<Self, String> {
        let body = SoftBody::new(*self.body.soft(), self.motion, rate).map_err(|error| error.to_string())?;
        Ok(Self { body, ..*self })
    }

    /// Holds a mode at some `q`, metres, or with a NaN lets go of it.
    pub fn grasp(&self, mode: usize, q: f32) {
        if let Some(held) = self.held.get(mode) {
            held.store(q.to_bits(), Relaxed);
        }
    }

    fn held(&self, mode: usize) -> Option<f32> {
        let q = f32::from_bits(self.held.get(mode)?.load(Relaxed));
        (!q.is_nan()).then_some(q)
    }

    fn hold(&self, contact: &mut SoftContact) {
        for mode in 0..self.motion.len() {
            if let Some(q) = self.held(mode) {
                self.body.put(contact, mode, q);
            }
        }
    }

    /// Of each mode: `q` at which it was tracked and its limit, metres, its frequency, Hz, and whether it is held.
    pub fn view(&self, witness: &FeltWitness, out: &mut Vec<f32>) {
        for (index, ((mode, modal), q)) in self.body.soft().modes().iter().zip(self.motion).zip(witness.q()).enumerate()
        {
            let frequency = sqrt(modal.stiffness_n_per_m / modal.mass_kg) / core::f32::consts::TAU;
            let is_held = self.held(index).is_some();
            out.extend([q, mode.limit, frequency, f32::from(u8::from(is_held))]);
        }
    }
}

// A body's file, checked and built, for as long as the instance lives.

/// A loaded surface, and the place of its tables in the model.
#[derive(Clone, Copy)]
pub struct Loaded {
    /// The body, with all features.
    pub body: &'static Body<'static>,
    /// The rendered surface: the body, or its only patch.
    pub felt: &'static Felt,
    /// Origin of the tables in the model, metres.
    pub centre: Vec3,
}

impl Loaded {
    /// Takes a file with all the checks that a device makes.
    ///
    /// # Errors
    /// The file's first fault, in a sentence.
    pub fn new(words: &'static [u32], length: usize) -> Result<Self, String> {
        let bytes = bytemuck::cast_slice(words).get(..length).unwrap_or_default();
        let head = FileHead::of(bytes).map_err(|error| error.to_string())?;
        let faces = Box::leak(vec![Face::VACANT; head.faces].into_boxed_slice());
        let edges = Box::leak(vec![Edge::VACANT; head.edges].into_boxed_slice());
        // As the emulated boards, whose runs it replays.
        let body = Body::from_bytes(bytes, BodyBuffer { faces, edges }).map_err(|error| error.to_string())?;
        let body = body.with_effort(Effort::ONE);
        let body: &'static Body<'static> = Box::leak(Box::new(body));
        // As the tool's commands take a file: a body of one face is felt as its patch.
        let felt = match body.faces() {
            [face] => Felt::Patch(face.patch.with_crc(face.patch.table_crc())),
            _ => Felt::Body(*body),
        };
        Ok(Self { body, felt: Box::leak(Box::new(felt)), centre: head.centre })
    }

    /// The body with modes, from their numbers, for a loop of this rate, Hz.
    ///
    /// # Errors
    /// The error in the modes, in a sentence.
    pub fn softened(&self, numbers: &[f32], rate: f32) -> Result<Self, String> {
        // No board's run is compared with it.
        Ok(self.yielding(Yielding::of(self.body.with_effort(Effort::BENCH), numbers, rate)?))
    }

    fn yielding(&self, soft: Yielding) -> Self {
        Self { felt: Box::leak(Box::new(Felt::Soft(Box::leak(Box::new(soft))))), ..*self }
    }

    /// For a loop of another rate, Hz, for which modes move by other steps.
    ///
    /// # Errors
    /// A mode that is too fast for it.
    pub fn at_rate(&self, rate: f32) -> Result<Self, String> {
        match self.felt {
            Felt::Soft(soft) if !soft.body.is_for(1.0 / rate) => Ok(self.yielding(soft.at_rate(rate)?)),
            _ => Ok(*self),
        }
    }
}
