//! The certificate of one patch: every probe over it reaches its closest point (theory §8).
//!
//! - *Regular*: the minimum stretch is proved positive.
//! - *Smooth*: no knot is a crease.
//! - *Normal cone*: the normal `f_u × f_v` is, up to a positive factor, a polynomial; on a cell it is a mean of its
//!   Bernstein coefficients. If all of them lie within less than 45° of one axis, any two normals are less than 90°
//!   apart.
//! - *Equilibrium*: for every probe `f(x₀) + s N(x₀)` with `x₀` in the patch and `0 ≤ s ≤ range`, exactly one point is
//!   not improved by any first-order step within the outline. Boxes of probes cover that region; [`super::locator`]
//!   proves one minimum for each, borders and corners included: a boundary that traps would be a second one, so the
//!   *outline* is proved with it.
//!
//! Where a proof fails, random probes are sampled; they can disprove the property, or remain the only evidence.

use super::BakedPatch;
use super::convexity::{Convexity, convexity};
use super::locator::{StoredSurface, Territory};
use super::patch::NurbsPatch;
use crate::random::Random;
use glam::DVec3;
use rayon::prelude::*;
use std::fmt;

/// The evidence for a property.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// Proved of the stored table.
    Proved,
    /// Proved but for rounding of the table to `f32`.
    UpToRounding,
    /// Not proved, and not disproved by this many samples.
    Sampled(usize),
    /// It does not hold, or cannot be had.
    Failed(String),
}

impl Finding {
    /// Whether it counts for a certificate.
    pub const fn is_proved(&self) -> bool {
        matches!(self, Self::Proved | Self::UpToRounding)
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Proved => formatter.pad("proved"),
            Self::UpToRounding => formatter.pad("up to rounding"),
            Self::Sampled(count) => formatter.pad(&format!("sampled ({count})")),
            Self::Failed(reason) => formatter.pad(&format!("no: {reason}")),
        }
    }
}

/// The certificate of a patch.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// The tangents span a plane everywhere.
    pub regular: Finding,
    /// Nothing bends inward.
    pub convex: Finding,
    /// There is no crease.
    pub smooth: Finding,
    /// Any two normals are less than 90° apart.
    pub normal_cone: Finding,
    /// Half of the angle of the cone, degrees; 180 if there is none.
    pub cone_angle: f64,
    /// No boundary holds the witness back from the closest point.
    pub outline: Finding,
    /// No probe over the patch, up to the range, has a second resting place.
    pub equilibrium: Finding,
    /// How far from the patch that is proved, metres: the range, or less.
    pub proved_range: f64,
}

/// How a patch that failed is to be split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// 0 for a cut at one `u`, 1 for one at one `v`.
    pub axis: usize,
    /// The parameter.
    pub at: f64,
}

/// Half the angle, degrees, of a cone in which any two normals are less than 90° apart.
const NORMALS: f64 = 45.0;
/// Random probes tried where there is no proof.
const SAMPLES: usize = 400;
/// Boxes of probes tried for the proof at one range.
const BOXES: usize = 1000;
/// Number of ranges tried: the whole, its half, its quarter and so on.
const HALVINGS: usize = 5;

impl Certificate {
    /// Certifies a patch for probes up to `range` metres over it.
    pub fn new(patch: &NurbsPatch, baked: &BakedPatch, convexity: &Convexity, range: f64) -> Self {
        let creases = [0, 1].map(|axis| creases(patch, axis));
        let smooth = match creases.iter().position(|creases| !creases.is_empty()) {
            None => Finding::Proved,
            Some(axis) => Finding::Failed(format!("a knot along {} may be a crease", ["u", "v"][axis])),
        };
        let regular = if baked.shape.min_stretch > 0.0 {
            Finding::Proved
        } else {
            Finding::Failed("the tangents are not proved to span a plane everywhere".to_owned())
        };
        let convex = match convexity {
            Convexity::Proved => Finding::Proved,
            Convexity::UpToRounding(_) => Finding::UpToRounding,
            Convexity::Open(_) => Finding::Sampled(SAMPLES),
            Convexity::Disproved { curvature, parameters: [u, v] } => {
                Finding::Failed(format!("it bends inward, {curvature:.2} 1/m at u = {u:.3}, v = {v:.3}"))
            }
        };
        let surface = StoredSurface::new(baked);
        let Some(territory) = Territory::new(baked, &creases, range) else {
            let none = || Finding::Failed("a weight is not proved positive".to_owned());
            let [outline, equilibrium] = [none(), none()];
            return Self {
                regular,
                convex,
                smooth,
                normal_cone: none(),
                cone_angle: 180.0,
                outline,
                equilibrium,
                proved_range: 0.0,
            };
        };
        let cone_angle = territory.cone_angle().to_degrees();
        let normal_cone = if cone_angle < NORMALS {
            Finding::Proved
        } else {
            Finding::Failed(format!("normals may lie {:.0}° apart", (2.0 * cone_angle).min(180.0)))
        };
        let sampled = sample(&surface, territory.turn(), range);
        let is_disproved = |nearer: f64| {
            let found = if nearer == range { sampled.clone() } else { sample(&surface, territory.turn(), nearer) };
            matches!(found, Finding::Failed(_))
        };
        // Nearer probes are easier: halved until it is proved, or not worth having. What samples disprove is not tried.
        let mut ranges = (0..HALVINGS).map(|halvings| range / f64::from(1 << halvings));
        let proved = ranges.find(|range| !is_disproved(*range) && territory.has_one_minimum(*range, BOXES));
        let proved_range = proved.unwrap_or(0.0);
        let equilibrium = if proved_range == range { Finding::Proved } else { sampled };
        Self {
            regular,
            convex,
            smooth,
            normal_cone,
            cone_angle,
            outline: equilibrium.clone(),
            equilibrium,
            proved_range,
        }
    }

    /// Whether [`Self::new`] would prove all of every patch. The quickest properties go first, for all
    /// patches: one patch that fails spares the others their proof.
    pub fn all_hold(patches: &[(&NurbsPatch, &BakedPatch)], range: f64) -> bool {
        let creases_of = |patch: &NurbsPatch| [0, 1].map(|axis| creases(patch, axis));
        let territory = |patch: &NurbsPatch, baked: &BakedPatch| Territory::new(baked, &creases_of(patch), range);
        let has_shape = |(patch, baked): &(&NurbsPatch, &BakedPatch)| {
            creases_of(patch).iter().all(Vec::is_empty)
                && baked.shape.min_stretch > 0.0
                && matches!(convexity(patch, baked), Convexity::Proved | Convexity::UpToRounding(_))
        };
        let may_hold = |(patch, baked): &(&NurbsPatch, &BakedPatch)| {
            territory(patch, baked).is_some_and(|territory| {
                territory.cone_angle().to_degrees() < NORMALS
                    && !matches!(sample(&StoredSurface::new(baked), territory.turn(), range), Finding::Failed(_))
            })
        };
        let holds = |(patch, baked): &(&NurbsPatch, &BakedPatch)| {
            territory(patch, baked).is_some_and(|territory| territory.has_one_minimum(range, BOXES))
        };
        patches.par_iter().all(has_shape) && patches.par_iter().all(may_hold) && patches.par_iter().all(holds)
    }

    /// Whether all of it is proved.
    pub const fn is_certified(&self) -> bool {
        self.regular.is_proved()
            && self.convex.is_proved()
            && self.smooth.is_proved()
            && self.normal_cone.is_proved()
            && self.outline.is_proved()
            && self.equilibrium.is_proved()
    }

    /// The reasons why a patch has no certificate, for the person at the terminal.
    pub fn reasons(&self, range: f64) -> Vec<String> {
        let findings = [
            ("regular", &self.regular),
            ("convex", &self.convex),
            ("smooth", &self.smooth),
            ("normal cone", &self.normal_cone),
            ("no false equilibrium, outline included", &self.equilibrium),
        ];
        let open = findings.into_iter().filter(|(_, finding)| !finding.is_proved());
        let mut reasons: Vec<_> = open.map(|(name, finding)| format!("{name}: {finding}")).collect();
        if !self.equilibrium.is_proved() && self.proved_range > 0.0 {
            let [near, far] = [self.proved_range, range].map(|range| 1e3 * range);
            reasons.push(format!("no false equilibrium is proved up to {near:.3} mm over it, not up to {far:.3} mm"));
        }
        reasons
    }

    /// The cut that is likeliest to help: at a crease, else across the direction in which the normal turns most. `None`
    /// where none would: a pole stays a pole, and what bends inward keeps a second resting place beyond its radius.
    pub fn cut(&self, patch: &NurbsPatch, baked: &BakedPatch) -> Option<Cut> {
        for axis in 0..2 {
            if let Some(at) = creases(patch, axis).first() {
                return Some(Cut { axis, at: *at });
            }
        }
        let is_curable = self.regular.is_proved() && self.convex.is_proved();
        if !is_curable || self.normal_cone.is_proved() && self.equilibrium.is_proved() {
            return None;
        }
        let surface = StoredSurface::new(baked);
        let turn = |axis: usize| {
            let line = |other: usize| {
                let normal = |k: usize| {
                    let at =
                        |axis_value: f64, other: f64| if axis == 0 { [axis_value, other] } else { [other, axis_value] };
                    let here = surface.evaluate(at(k as f64 / 8.0, (other as f64 + 0.5) / 4.0));
                    here.first[0].cross(here.first[1]).normalize_or_zero()
                };
                (0..8).map(|k| normal(k).angle_between(normal(k + 1))).filter(|angle| angle.is_finite()).sum::<f64>()
            };
            (0..4).map(line).fold(0.0, f64::max)
        };
        let axis = usize::from(turn(1) > turn(0));
        Some(Cut { axis, at: 0.5 })
    }
}

/// The inner knots along an axis at which the patch is only C⁰.
fn creases(patch: &NurbsPatch, axis: usize) -> Vec<f64> {
    patch.creases([super::Axis::U, super::Axis::V][axis])
}

/// Random probes over the patch: whether every start of a 4 × 4 grid ends at one distance.
fn sample(surface: &StoredSurface, turn: f64, range: f64) -> Finding {
    let mut random = Random::new(1);
    for _ in 0..SAMPLES {
        let at = [0, 1].map(|_| random.between(0.0, 1.0));
        let here = surface.evaluate(at);
        let normal: DVec3 = (here.first[0].cross(here.first[1]) * turn).normalize_or_zero();
        let height = random.between(0.0, range);
        let probe = here.point + normal * height;
        let mut distances = [f64::INFINITY, f64::NEG_INFINITY];
        for start in 0..16 {
            let start = [start / 4, start % 4].map(|k| (f64::from(k) + 0.5) / 4.0);
            let distance = surface.descend(probe, start, [[0.0; 2], [1.0; 2]]).distance;
            distances = [distances[0].min(distance), distances[1].max(distance)];
        }
        // Descents stop where doubles no longer fall: far below this.
        if distances[1] > distances[0] * (1.0 + 1e-6) + 1e-9 {
            let [u, v] = at;
            return Finding::Failed(format!(
                "a probe {:.3} mm over u = {u:.3}, v = {v:.3} has a second resting place, {:.3} mm away instead of {:.3}",
                1e3 * height,
                1e3 * distances[1],
                1e3 * distances[0]
            ));
        }
    }
    Finding::Sampled(SAMPLES)
}
