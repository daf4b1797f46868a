//! View of the loop after a tick: numbers in an order that `web/firmware.js` has names for.

use crate::felt::{Felt, FeltWitness};
use alloc::vec::Vec;
use palpate::body::{Body, BodyWitness, Feature};
use palpate::field::{Displaced, Field};
use palpate::math::{Vec3, sqrt};
use palpate::patch::SplinePatch;
use palpate::scene::Scene;
use palpate::servo::{Remembered, ServoState, Surface, Tracked as _};
use palpate::track::{Controller, Placement, Probe, ProjectionErrors, Step, Witness};

/// The next step from where the witness point is: its gain, and the projection error in metres; of a probe in the frame
/// of the sight. It is computed apart, on a copy, and changes nothing.
pub fn next_step(sight: &Sight<'_>, controller: &Controller, probe: Vec3) -> [f32; 2] {
    let mut copy = *sight.witness;
    match sight.feature {
        Feature::Face(_) => {
            let Some(patch) = sight.patch else { return [0.0; 2] };
            let (probe, period) = (Probe::at(probe), 1.0 / 4_000.0);
            let step: Step = match &sight.field {
                Some(field) => controller.step(&Displaced::new(patch, field), &mut copy, probe, period),
                None => controller.step(patch, &mut copy, probe, period),
            };
            [step.gain, step.residual()]
        }
        Feature::Edge(_) => {
            let ProjectionErrors { gradient, form, .. } = ProjectionErrors::new(&copy.surface, probe);
            let length = sqrt(form.e);
            [1.0, if length > 0.0 { gradient[0].abs() / length } else { 0.0 }]
        }
        Feature::Vertex(_) => [1.0, 0.0],
    }
}

/// Everything about a state.
pub fn write<S: Sighted, G: Remembered>(
    state: &ServoState<3, S::Witness, G>,
    surface: &'static S,
    controller: &Controller,
    target: Vec3,
    out: &mut Vec<f32>,
) {
    let (kept, probe) = (state.witness(), state.probe());
    let sight = surface.sight(kept);
    let [gain, error] = next_step(&sight, controller, sight.place.point_to_b(probe));
    let point = sight.place.point_to_a(sight.witness.surface.point);
    let anchor = state.anchor();
    out.clear();
    for vector in
        [target, probe, point, sight.place.direction_to_a(sight.normal), state.force(), anchor.point.unwrap_or(point)]
    {
        out.extend(vector.to_array());
    }
    let fault = state.fault().map_or(0, |(fault, _)| fault.code());
    out.extend([
        kept.gap(),
        sight.witness.parameters[0],
        sight.witness.parameters[1],
        f32::from(sight.witness.mode as u8),
        f32::from(kept.contact() as u8),
        f32::from(kept.feature()),
        gain,
        error,
        f32::from(sight.spent),
        f32::from(state.phase() as u8),
        f32::from(fault),
        f32::from(u8::from(anchor.point.is_some())),
        f32::from(u8::from(anchor.slips)),
        f32::from(u8::from(state.is_too_deep())),
        state.rejected_steps() as f32,
    ]);
    surface.places(kept, out);
}

// Where a surface's witness point is seen: on a patch, on a body, or on one of several bodies that move.

/// A witness point in the frame that its surface was baked in, and where that frame is.
#[derive(Clone, Copy, Debug)]
pub struct Sight<'a> {
    /// The tracker's state.
    pub witness: &'a Witness,
    /// The feature of the witness point.
    pub feature: Feature,
    /// The face's patch; `None` on an edge or a vertex.
    pub patch: Option<&'static SplinePatch<'static>>,
    /// Unit vector out of the surface; zero without a witness point.
    pub normal: Vec3,
    /// Evaluations of patches in the last tick; `None` if several bodies share a tick.
    pub spent: u8,
    /// Of the frame.
    pub place: Placement,
    /// By which the patch is displaced, where it is.
    pub field: Option<Field<'static>>,
}

/// A surface that can be looked at.
pub trait Sighted: Surface + 'static {
    /// Where its witness point is.
    fn sight<'a>(&'static self, kept: &'a Self::Witness) -> Sight<'a>;

    /// The body in contact and the position of each body; nothing for a fixed surface.
    fn places(&'static self, _kept: &Self::Witness, _out: &mut Vec<f32>) {}
}

impl Sighted for Felt {
    fn sight<'a>(&'static self, kept: &'a FeltWitness) -> Sight<'a> {
        let (feature, normal, spent) = (kept.place(), kept.normal(self), kept.spent);
        let (patch, field) = match self {
            Self::Patch(patch) => (Some(patch), None),
            Self::Body(body) => (patch_of(body, feature), None),
            // No step of one patch is a step of a tool.
            Self::Tool(_) => (None, None),
            Self::Soft(soft) => {
                let soft = soft.body.soft();
                (patch_of(soft.rest(), feature), Some(soft.field(&kept.q())))
            }
        };
        Sight { witness: kept.witness(), feature, patch, normal, spent, place: Placement::IDENTITY, field }
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
            field: None,
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
