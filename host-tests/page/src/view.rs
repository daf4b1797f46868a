//! What the page sees of the loop after a tick, as numbers in an order that `web/firmware.js` has names for.

use alloc::vec::Vec;
use palpate::body::{Body, Feature};
use palpate::math::{Vec3, sqrt};
use palpate::servo::{Remembered, ServoState, Tracked as _};
use palpate::track::{Controller, Probe, ProjectionErrors, Step};

use crate::felt::{Felt, FeltWitness};

/// The next step from where the witness point is: its gain, and the projection error in metres. It is computed
/// apart, on a copy, and changes nothing.
pub fn next_step(body: &Body<'static>, controller: &Controller, witness: &FeltWitness, probe: Vec3) -> [f32; 2] {
    let mut copy = *witness.witness();
    match witness.place() {
        Feature::Face(face) => {
            let Some(face) = body.faces().get(usize::from(face)) else { return [0.0; 2] };
            let step: Step = controller.step(&face.patch, &mut copy, Probe::at(probe), 1.0 / 4_000.0);
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
pub fn write<G: Remembered>(
    state: &ServoState<3, FeltWitness, G>,
    felt: &Felt,
    [gain, error]: [f32; 2],
    target: Vec3,
    out: &mut Vec<f32>,
) {
    let kept = state.witness();
    let witness = kept.witness();
    let anchor = state.anchor();
    out.clear();
    for vector in [
        target,
        state.probe(),
        witness.surface.point,
        kept.normal(felt),
        state.force(),
        anchor.point.unwrap_or(witness.surface.point),
    ] {
        out.extend(vector.to_array());
    }
    let fault = state.fault().map_or(0, |(fault, _)| fault.code());
    out.extend([
        kept.gap(),
        witness.parameters[0],
        witness.parameters[1],
        f32::from(witness.mode as u8),
        f32::from(kept.contact() as u8),
        f32::from(kept.feature()),
        gain,
        error,
        f32::from(kept.spent),
        f32::from(state.phase() as u8),
        f32::from(fault),
        f32::from(u8::from(anchor.point.is_some())),
        f32::from(u8::from(anchor.slips)),
        f32::from(u8::from(state.is_too_deep())),
        state.steps_undone() as f32,
    ]);
}
