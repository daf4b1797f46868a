//! What the page sees of the loop after a tick, as numbers in an order that `web/firmware.js` has names for.

use alloc::vec::Vec;
use palpate::body::Feature;
use palpate::math::{Vec3, sqrt};
use palpate::servo::{Remembered, ServoState, Tracked as _};
use palpate::track::{Controller, Probe, ProjectionErrors, Step};

use crate::sight::{Sight, Sighted};

/// The next step from where the witness point is: its gain, and the projection error in metres; of a probe in the frame
/// of the sight. It is computed apart, on a copy, and changes nothing.
pub fn next_step(sight: &Sight<'_>, controller: &Controller, probe: Vec3) -> [f32; 2] {
    let mut copy = *sight.witness;
    match sight.feature {
        Feature::Face(_) => {
            let Some(patch) = sight.patch else { return [0.0; 2] };
            let step: Step = controller.step(patch, &mut copy, Probe::at(probe), 1.0 / 4_000.0);
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
