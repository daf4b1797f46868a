//! The surface that the loop renders: a body, or one patch. Neither adds words to the state.

use alloc::boxed::Box;
use alloc::string::{String, ToString as _};
use alloc::vec;
use palpate::body::{Body, BodyBuffer, BodyWitness, Edge, Effort, Face, Feature, FileHead, TableCursor};
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate::servo::{BakedTables, PatchWitness, Surface, Touched, Tracked};
use palpate::track::{Contact, Controller, Outcome, Probe, Witness};

/// A surface that is chosen when the page runs.
#[derive(Clone, Copy, Debug)]
pub enum Felt {
    /// All patches, joined.
    Body(Body<'static>),
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
pub enum Kept {
    /// On a body.
    Body(BodyWitness),
    /// On a patch.
    Patch(PatchWitness),
}

impl Surface for Felt {
    type Witness = FeltWitness;

    fn rest(&self) -> FeltWitness {
        let kept = match self {
            Self::Body(body) => Kept::Body(body.rest()),
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
            (Self::Patch(patch), Kept::Patch(witness)) => {
                *spent = 1;
                patch.follow(controller, witness, probe, period)
            }
            // Each surface makes its own witness.
            _ => Touched { normal: Vec3::ZERO, rejected: false, unexplained: false },
        }
    }

    fn release(&self, witness: &mut FeltWitness) {
        match (self, &mut witness.kept) {
            (Self::Body(body), Kept::Body(witness)) => body.release(witness),
            (Self::Patch(patch), Kept::Patch(witness)) => patch.release(witness),
            _ => {}
        }
    }

    fn is_too_deep(&self, witness: &FeltWitness) -> bool {
        match (self, &witness.kept) {
            (Self::Body(body), Kept::Body(witness)) => Surface::is_too_deep(body, witness),
            (Self::Patch(patch), Kept::Patch(witness)) => Surface::is_too_deep(patch, witness),
            _ => false,
        }
    }
}

impl BakedTables for Felt {
    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        match self {
            Self::Body(body) => body.table_word(cursor),
            Self::Patch(patch) => BakedTables::table_word(patch, cursor),
        }
    }

    fn table_records(&self) -> u32 {
        match self {
            Self::Body(body) => BakedTables::table_records(body),
            Self::Patch(patch) => BakedTables::table_records(patch),
        }
    }

    fn baked_crc(&self) -> Option<u32> {
        match self {
            Self::Body(body) => body.baked_crc(),
            Self::Patch(patch) => BakedTables::baked_crc(patch),
        }
    }
}

impl Tracked for FeltWitness {
    fn witness(&self) -> &Witness {
        match &self.kept {
            Kept::Body(body) => body.witness(),
            Kept::Patch(patch) => patch.witness(),
        }
    }

    fn gap(&self) -> f32 {
        match &self.kept {
            Kept::Body(body) => body.gap(),
            Kept::Patch(patch) => patch.gap(),
        }
    }

    fn contact(&self) -> Contact {
        match &self.kept {
            Kept::Body(body) => body.contact(),
            Kept::Patch(patch) => patch.contact(),
        }
    }

    fn feature(&self) -> u16 {
        match &self.kept {
            Kept::Body(body) => body.feature(),
            Kept::Patch(patch) => patch.feature(),
        }
    }

    fn for_each_word(&self, take: impl FnMut(u32)) {
        match &self.kept {
            Kept::Body(body) => body.for_each_word(take),
            Kept::Patch(patch) => patch.for_each_word(take),
        }
    }
}

impl FeltWitness {
    /// Unit vector out of the surface at the witness point; zero without one.
    pub fn normal(&self, felt: &Felt) -> Vec3 {
        match (&self.kept, felt) {
            (Kept::Body(witness), _) => witness.normal,
            (Kept::Patch(witness), Felt::Patch(patch)) => witness.witness().normal(patch).unwrap_or(Vec3::ZERO),
            _ => Vec3::ZERO,
        }
    }

    /// Which face, edge or vertex it lies on.
    pub fn place(&self) -> Feature {
        match &self.kept {
            Kept::Body(witness) => witness.feature,
            Kept::Patch(_) => Feature::Face(0),
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
}
