//! Where a surface's witness point is seen: on a patch, on a body, or on one of several bodies that move.

use alloc::vec::Vec;
use palpate::body::{Body, BodyWitness, Feature};
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate::scene::Scene;
use palpate::servo::{Surface, Tracked as _};
use palpate::track::{Placement, Witness};

use crate::felt::{Felt, FeltWitness};

/// A witness point in the frame that its surface was baked in, and where that frame is.
#[derive(Clone, Copy, Debug)]
pub struct Sight<'a> {
    /// What the tracker keeps.
    pub witness: &'a Witness,
    /// Which face, edge or vertex it lies on.
    pub feature: Feature,
    /// The face's patch; none on an edge or a vertex.
    pub patch: Option<&'static SplinePatch<'static>>,
    /// Unit vector out of what is felt; zero where there is none.
    pub normal: Vec3,
    /// Evaluations of patches that the last tick has spent; none where several bodies share a tick.
    pub spent: u8,
    /// Of the frame.
    pub place: Placement,
}

/// A surface that can be looked at.
pub trait Sighted: Surface + 'static {
    /// Where its witness point is.
    fn sight<'a>(&'static self, kept: &'a Self::Witness) -> Sight<'a>;

    /// Which of several bodies is felt, and where each of them is: nothing of a surface that stands.
    fn places(&'static self, _kept: &Self::Witness, _out: &mut Vec<f32>) {}
}

impl Sighted for Felt {
    fn sight<'a>(&'static self, kept: &'a FeltWitness) -> Sight<'a> {
        let (feature, normal, spent) = (kept.place(), kept.normal(self), kept.spent);
        let patch = match self {
            Self::Patch(patch) => Some(patch),
            Self::Body(body) => patch_of(body, feature),
        };
        Sight { witness: kept.witness(), feature, patch, normal, spent, place: Placement::IDENTITY }
    }
}

impl<const N: usize> Sighted for Scene<'static, Body<'static>, N> {
    fn sight<'a>(&'static self, kept: &'a Self::Witness) -> Sight<'a> {
        let body = self.parts().get(kept.felt()).map(|part| part.surface);
        let part = kept.part(kept.felt());
        let of: Option<&BodyWitness> = part.map(|part| part.witness());
        let feature = of.map_or(Feature::Face(0), |witness| witness.feature);
        Sight {
            witness: kept.witness(),
            feature,
            patch: body.and_then(|body| patch_of(body, feature)),
            normal: of.map_or(Vec3::ZERO, |witness| witness.normal),
            spent: 0,
            place: part.map_or(Placement::IDENTITY, |part| part.placement()),
        }
    }

    fn places(&'static self, kept: &Self::Witness, out: &mut Vec<f32>) {
        out.push(kept.felt() as f32);
        for part in (0..N).filter_map(|index| kept.part(index)) {
            let Placement { axes: [x, y, z], origin, .. } = part.placement();
            for vector in [x, y, z, origin] {
                out.extend(vector.to_array());
            }
        }
    }
}

fn patch_of(body: &Body<'static>, feature: Feature) -> Option<&'static SplinePatch<'static>> {
    let Feature::Face(face) = feature else { return None };
    body.faces().get(usize::from(face)).map(|face| &face.patch)
}
