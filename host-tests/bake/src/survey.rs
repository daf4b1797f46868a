//! The certified and sampled properties of a baked patch.

use super::baked::BakedPatch;
use super::certificate::{Certificate, Cut};
use super::convexity::{Convexity, POLE, convexity};
use super::patch::NurbsPatch;
use crate::patch::Axis;
use palpate::patch::ShapeBounds;
use std::fmt;

/// Whether the guarantee of the controller is proved for a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Proved: no false equilibrium for any probe over it, up to the range that was asked for.
    Certified,
    /// It can be rendered; there is no proof that the witness point always ends at the closest point.
    Usable,
}

impl fmt::Display for Verdict {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Certified => "certified",
            Self::Usable => "usable, not certified",
        })
    }
}

/// How the tangents stand to each other, on a grid of 12 intervals a span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Regularity {
    /// The minimum sine of the angle between the tangents, away from poles.
    Regular {
        /// The sine.
        least_sine: f64,
    },
    /// The tangents are parallel or vanish at an inner point.
    Singular {
        /// Where it is worst.
        parameters: [f64; 2],
    },
}

/// The properties of a patch.
#[derive(Clone, Debug)]
pub struct Survey {
    /// Degrees.
    pub degree: [usize; 2],
    /// Numbers of spans.
    pub spans: [usize; 2],
    /// Whether the weights differ.
    pub rational: bool,
    /// The largest side of the bounding box, metres.
    pub size: f64,
    /// Derivatives that the knots leave continuous; `None` without inner knots.
    pub continuity: [Option<usize>; 2],
    /// Sampled.
    pub regularity: Regularity,
    /// Edges that are one point: `u = 0`, `u = 1`, `v = 0`, `v = 1`.
    pub poles: Vec<&'static str>,
    /// Proved.
    pub shape: ShapeBounds,
    /// Proved or disproved.
    pub convexity: Convexity,
    /// The certificate of the controller on it.
    pub certificate: Certificate,
    /// Bytes in flash.
    pub bytes: TableBytes,
    /// The verdict.
    pub verdict: Verdict,
    /// Why it is not better.
    pub reasons: Vec<String>,
}

/// Bytes of a patch's table, by kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableBytes {
    /// Polynomial coefficients.
    pub coefficients: usize,
    /// Span borders.
    pub breaks: usize,
    /// The patch's own record on a 32-bit target: two slices, one tagged slice, bounds, degrees, orientation, size.
    pub record: usize,
}

impl TableBytes {
    /// Their sum.
    pub const fn total(&self) -> usize {
        self.coefficients + self.breaks + self.record
    }
}

/// Tangents at a smaller sine leave less than four digits of `f32` to the step of the controller.
const LEAST_SINE: f64 = 1e-3;
/// `2 · 8 + 12 + 32 + 2 + 1 + 4` bytes, padded to words.
const RECORD_BYTES: usize = 68;

impl Survey {
    /// Surveys a patch and its table; the certificate is for probes up to `range` metres over it.
    pub fn new(patch: &NurbsPatch, baked: &BakedPatch, range: f64) -> Self {
        let size = patch.size();
        let continuity = [Axis::U, Axis::V].map(|axis| patch.continuity(axis));
        let (regularity, poles) = regularity(patch, size);
        let convexity = convexity(patch, baked);
        let certificate = Certificate::new(patch, baked, &convexity, range);
        let verdict = if certificate.is_certified() { Verdict::Certified } else { Verdict::Usable };
        let mut reasons = certificate.reasons(range);
        for (axis, continuity) in [Axis::U, Axis::V].into_iter().zip(continuity) {
            if continuity == Some(0) {
                reasons.push(format!("a knot along {axis} may be a crease: the bounds hold on either side of it only"));
            }
        }
        if let Some(Cut { axis, at }) = certificate.cut(patch, baked) {
            reasons.push(format!("splitting it at {} = {at:.4} may help", ["u", "v"][axis]));
        }
        if let Regularity::Singular { parameters: [u, v] } = regularity {
            reasons.push(format!("the tangents span no plane near u = {u:.4}, v = {v:.4}"));
        }
        reasons.extend(poles.iter().map(|edge| format!("the edge {edge} is one point (a pole)")));
        let bytes = TableBytes {
            coefficients: baked.coefficients.bytes(),
            breaks: baked.breaks.iter().map(|breaks| size_of_val(breaks.as_slice())).sum(),
            record: RECORD_BYTES,
        };
        Self {
            degree: baked.degree.map(usize::from),
            spans: baked.breaks.each_ref().map(|breaks| breaks.len() - 1),
            rational: patch.is_rational(),
            size,
            continuity,
            regularity,
            poles,
            shape: baked.shape,
            convexity,
            certificate,
            bytes,
            verdict,
            reasons,
        }
    }
}

fn regularity(patch: &NurbsPatch, size: f64) -> (Regularity, Vec<&'static str>) {
    const EDGES: [&str; 4] = ["u = 0", "u = 1", "v = 0", "v = 1"];
    let on_edge = |[u, v]: [f64; 2]| [u == 0.0, u == 1.0, v == 0.0, v == 1.0];
    let mut longest = [0.0_f64; 4];
    patch.for_each_sample(12, |parameters, surface| {
        let along = [surface.tangent_v, surface.tangent_v, surface.tangent_u, surface.tangent_u];
        for (edge, on) in on_edge(parameters).into_iter().enumerate() {
            if on {
                longest[edge] = longest[edge].max(along[edge].length());
            }
        }
        true
    });
    let is_pole = longest.map(|longest| longest <= POLE * size);
    let (mut least_sine, mut worst) = (1.0, [0.0; 2]);
    patch.for_each_sample(12, |parameters, surface| {
        let at_pole = on_edge(parameters).into_iter().zip(is_pole).any(|(on, pole)| on && pole);
        let (across, lengths) =
            (surface.tangent_u.cross(surface.tangent_v), surface.tangent_u.length() * surface.tangent_v.length());
        let sine = if lengths > 0.0 { across.length() / lengths } else { 0.0 };
        if !at_pole && sine < least_sine {
            (least_sine, worst) = (sine, parameters);
        }
        true
    });
    let poles = EDGES.into_iter().zip(is_pole).filter_map(|(edge, pole)| pole.then_some(edge)).collect();
    if least_sine < LEAST_SINE {
        (Regularity::Singular { parameters: worst }, poles)
    } else {
        (Regularity::Regular { least_sine }, poles)
    }
}
