//! What the loop touches: a body, or one patch. Nothing is added to either: the words of the state are theirs.

use palpate::body::{Body, BodyWitness, Feature, TableCursor};
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate::servo::{PatchWitness, Surface, Touched, Tracked};
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
    /// What the surface keeps.
    pub kept: Kept,
    /// Evaluations of patches that the last tick has spent.
    pub spent: u8,
}

/// What a surface keeps from tick to tick.
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

    fn lose(&self, witness: &mut FeltWitness) {
        match (self, &mut witness.kept) {
            (Self::Body(body), Kept::Body(witness)) => body.lose(witness),
            (Self::Patch(patch), Kept::Patch(witness)) => patch.lose(witness),
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

    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        match self {
            Self::Body(body) => body.table_word(cursor),
            Self::Patch(patch) => Surface::table_word(patch, cursor),
        }
    }

    fn table_records(&self) -> u32 {
        match self {
            Self::Body(body) => Surface::table_records(body),
            Self::Patch(patch) => Surface::table_records(patch),
        }
    }

    fn baked_crc(&self) -> Option<u32> {
        match self {
            Self::Body(body) => body.baked_crc(),
            Self::Patch(patch) => Surface::baked_crc(patch),
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
    /// Unit vector out of what is felt at the witness point; zero where there is none.
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
