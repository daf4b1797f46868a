//! Pieces of a model's patches: what cannot be baked whole is cut, and so are its neighbours where the cut runs out
//! into them.
//!
//! [`prepared`] cuts what the tables cannot hold: patches that close on themselves, sectors of a pole of half a turn or
//! more, and creases. [`cut`] cuts where it is asked to, for a patch that fails a certificate.

use crate::error::{ModelError, PatchFault};
use crate::model::Model;
use crate::patch::NurbsPatch;
use crate::topology::{Border, BorderRole, SeamFault, Topology};
use crate::{Axis, spline};
use glam::{DVec3, DVec4, Vec4Swizzles as _};
use palpate::body::MAX_FACES;
use std::f64::consts::PI;

/// Maximum rounds of cuts: closed patches first, then the remaining poles and creases.
const ROUNDS: usize = 8;

/// A model in pieces that the tables can hold.
///
/// # Errors
/// Weights too uneven for `f32`; a fault between its patches; more pieces than a body can have.
pub fn prepared(model: &Model, file: &str) -> Result<Vec<Piece>, ModelError> {
    let mut pieces = Piece::whole(model);
    for piece in &pieces {
        // What is wrong with a patch is said before what is wrong between patches.
        let uneven = |spline::UnevenSpan([u, v])| ModelError::Patch {
            file: file.to_owned(),
            patch: label(piece.source, model),
            fault: PatchFault::Uneven { u, v },
        };
        spline::extract(&piece.patch).map_err(uneven)?;
    }
    // Looked at before the work begins, and again after each cut.
    let too_many = |count: usize| ModelError::Seam {
        file: file.to_owned(),
        fault: SeamFault::TooMany { count, limit: MAX_FACES },
    };
    if pieces.len() > MAX_FACES {
        return Err(too_many(pieces.len()));
    }
    for _ in 0..ROUNDS {
        let topology = topology(&pieces, model, file)?;
        let wanted = cuts(&pieces, &topology);
        if wanted.is_empty() {
            break;
        }
        pieces = cut(&pieces, &topology, &wanted);
        if pieces.len() > MAX_FACES {
            return Err(too_many(pieces.len()));
        }
    }
    Ok(pieces)
}

/// How pieces hang together.
///
/// # Errors
/// A fault between them.
pub fn topology(pieces: &[Piece], model: &Model, file: &str) -> Result<Topology, ModelError> {
    let patches: Vec<_> = pieces.iter().map(|piece| piece.patch.clone()).collect();
    Topology::new(&patches, &|index| label(pieces[index].source, model))
        .map_err(|fault| ModelError::Seam { file: file.to_owned(), fault })
}

/// The name of a piece in messages: its patch, and which part of it unless it is the whole.
pub fn label(source: Provenance, model: &Model) -> String {
    let Provenance { patch, lower, upper } = source;
    let name = model.patches[patch].name.as_ref().map_or_else(|| patch.to_string(), |name| format!("\"{name}\""));
    if source == Provenance::whole(patch) {
        return name;
    }
    format!("{name} (u {:.4} to {:.4}, v {:.4} to {:.4})", lower[0], upper[0], lower[1], upper[1])
}

// Pieces, and where they are from.

/// Which part of a model a piece is: `(u, v)` of the piece is `lower + (u, v) · (upper − lower)` of the patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Provenance {
    /// Index of the patch.
    pub patch: usize,
    /// The minimum parameters.
    pub lower: [f64; 2],
    /// The maximum parameters.
    pub upper: [f64; 2],
}

impl Provenance {
    /// The whole of a patch.
    pub const fn whole(patch: usize) -> Self {
        Self { patch, lower: [0.0; 2], upper: [1.0; 2] }
    }

    /// A part of this part, from `low` to `high` of its own parameter along one axis.
    pub fn part(&self, axis: usize, low: f64, high: f64) -> Self {
        let mut part = *self;
        let width = self.upper[axis] - self.lower[axis];
        part.lower[axis] = self.lower[axis] + low * width;
        // Ends stay the ends to the last bit.
        part.upper[axis] = if high == 1.0 { self.upper[axis] } else { self.lower[axis] + high * width };
        part
    }

    /// The parameters of the model's patch at those of the piece.
    pub fn parameters(&self, piece: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.lower[axis] + piece[axis] * (self.upper[axis] - self.lower[axis]))
    }
}

/// A piece with where it is from.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The surface over the unit square.
    pub patch: NurbsPatch,
    /// Its place in the model.
    pub source: Provenance,
}

impl Piece {
    /// Every patch of a model, whole.
    pub fn whole(model: &Model) -> Vec<Self> {
        let whole =
            |(patch, surface): (usize, &NurbsPatch)| Self { patch: surface.clone(), source: Provenance::whole(patch) };
        model.patches.iter().enumerate().map(whole).collect()
    }
}

// Cuts that run on: a border that is cut is cut for its other face as well, and so across that face to the next, until
// the cut ends at a pole or an open border or comes back. Otherwise edges would meet only in part.

/// A cut through a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Index of the piece.
    pub piece: usize,
    /// The parameter that is cut: 0 for `u`, 1 for `v`.
    pub axis: usize,
    /// Where, between 0 and 1.
    pub at: f64,
}

/// Cuts nearer to each other or to a border than this are one: a span of `f32` borders cannot be narrower than a few of
/// its units.
const NEAREST: f64 = 1e-5;

/// Cuts pieces, and all that the cuts run through.
pub fn cut(pieces: &[Piece], topology: &Topology, wanted: &[Cut]) -> Vec<Piece> {
    let mut cuts: Vec<[Vec<f64>; 2]> = vec![[Vec::new(), Vec::new()]; pieces.len()];
    let mut open = wanted.to_vec();
    while let Some(Cut { piece, axis, at }) = open.pop() {
        let known = &mut cuts[piece][axis];
        // Also refuses NaN.
        let is_inside = at > NEAREST && at < 1.0 - NEAREST;
        if !is_inside || known.iter().any(|other| (other - at).abs() < NEAREST) {
            continue;
        }
        known.push(at);
        // The cut ends on both borders along which its parameter runs.
        for edge in &topology.edges {
            let Some((partner, sense)) = edge.partner else { continue };
            for (from, to) in [(edge.owner, partner), (partner, edge.owner)] {
                if from.patch == piece && from.axis() == axis {
                    open.push(Cut { piece: to.patch, axis: to.axis(), at: sense.apply(at) });
                }
            }
        }
    }
    let mut all = Vec::new();
    for (piece, mut cuts) in pieces.iter().zip(cuts) {
        cuts.iter_mut().for_each(|cuts| cuts.sort_by(f64::total_cmp));
        let strips = along(piece.clone(), 0, &cuts[0]);
        all.extend(strips.into_iter().flat_map(|strip| along(strip, 1, &cuts[1])));
    }
    all
}

/// A piece cut along one axis, the lowest part first.
fn along(piece: Piece, axis: usize, cuts: &[f64]) -> Vec<Piece> {
    let source = piece.source;
    let (mut parts, mut rest, mut low) = (Vec::new(), piece.patch, 0.0);
    for at in cuts {
        let [below, above] = cut_in_two(&rest, axis, (at - low) / (1.0 - low));
        parts.push(Piece { patch: below, source: source.part(axis, low, *at) });
        (rest, low) = (above, *at);
    }
    parts.push(Piece { patch: rest, source: source.part(axis, low, 1.0) });
    parts
}

// What the tables cannot hold whole.
//
// - *Closed patches*: a face that meets itself along a seam is its own neighbour, and a probe that has left it has
//   not.
// - *Wide poles*: the region of a face at its pole lies between the separators of its two sides there, which cut out a
//   wedge only if the sides span less than half a turn.
// - *Creases*: at a knot of full multiplicity the patch need not be smooth, and nothing that is proved of it holds
//   across.

/// Points along a pole's side between which the turning of the tangents is added up.
const SAMPLES: usize = 64;
/// Half a turn, less the rounding of a model's decimals.
const WIDE: f64 = PI * (1.0 - 1e-6);

/// The cuts that are needed, without those that follow from them.
fn cuts(pieces: &[Piece], topology: &Topology) -> Vec<Cut> {
    let mut all = Vec::new();
    for (piece, Piece { patch, .. }) in pieces.iter().enumerate() {
        for axis in [0, 1] {
            let creases = creases(patch, axis);
            let at = if !creases.is_empty() {
                creases
            } else if is_closed(topology, piece, axis) {
                vec![1.0 / 3.0, 2.0 / 3.0]
            } else if is_wide_pole(patch, topology, piece, axis) {
                vec![0.5]
            } else {
                continue;
            };
            all.extend(at.into_iter().map(|at| Cut { piece, axis, at }));
        }
    }
    all
}

/// Inner knots of full multiplicity.
fn creases(patch: &NurbsPatch, axis: usize) -> Vec<f64> {
    let inner = patch.borders(if axis == 0 { Axis::U } else { Axis::V });
    let times = |at: f64| patch.knots[axis].iter().filter(|knot| **knot == at).count();
    let inside = inner.into_iter().filter(|at| 0.0 < *at && *at < 1.0);
    inside.filter(|at| times(*at) >= patch.degree[axis]).collect()
}

/// Whether both borders at the ends of a parameter are one edge.
fn is_closed(topology: &Topology, piece: usize, axis: usize) -> bool {
    let edge = |side: usize| match topology.roles[piece][side] {
        BorderRole::Edge { edge, .. } => Some(edge),
        BorderRole::Pole { .. } => None,
    };
    edge(2 * axis).is_some() && edge(2 * axis) == edge(2 * axis + 1)
}

/// Whether a side along which a parameter runs is a pole whose sector spans half a turn or more.
fn is_wide_pole(patch: &NurbsPatch, topology: &Topology, piece: usize, axis: usize) -> bool {
    let mut sides = (0..4).map(|side| Border { patch: piece, side }).filter(|border| border.axis() == axis);
    sides.any(|border| {
        let is_pole = matches!(topology.roles[piece][border.side], BorderRole::Pole { .. });
        is_pole && sector(patch, border) >= WIDE
    })
}

/// The angle through which the tangents across a pole turn about its axis, radians. Their tips lie on a circle about
/// the axis, in the pole's tangent plane or, on a cone, above it.
fn sector(patch: &NurbsPatch, border: Border) -> f64 {
    let directions = (0..=SAMPLES).map(|k| border.at(patch, k as f64 / SAMPLES as f64).across.normalize_or_zero());
    let directions: Vec<_> = directions.collect();
    let off = |index: usize| directions[index] - directions[0];
    let axis = (1..SAMPLES).map(|k| off(k).cross(off(k + 1))).sum::<DVec3>().normalize_or_zero();
    let around = |direction: DVec3| direction - axis * direction.dot(axis);
    let turn = |a: DVec3, b: DVec3| a.cross(b).length().atan2(a.dot(b));
    directions.windows(2).map(|pair| turn(around(pair[0]), around(pair[1]))).sum()
}

// A patch cut in two by inserting a knot (Boehm) until the control net falls apart there.

/// Knots nearer than this are one: some thousand roundings of `f64`.
const SAME_KNOT: f64 = 1e-12;

/// The parts below and above `at` along an axis (0 for `u`), each over the unit square again. Both have the very same
/// control points where they were one.
pub fn cut_in_two(patch: &NurbsPatch, axis: usize, at: f64) -> [NurbsPatch; 2] {
    let degree = patch.degree[axis];
    let lines = lines(patch, axis);
    // A cut that is meant for a knot is at the knot: beside it a span of no width would be left.
    let at = patch.knots[axis].iter().copied().find(|knot| (knot - at).abs() < SAME_KNOT).unwrap_or(at);
    let present = patch.knots[axis].iter().filter(|knot| **knot == at).count();
    let (mut knots, mut lines) = (patch.knots[axis].clone(), lines);
    for _ in present..degree {
        let span = knots.partition_point(|knot| *knot <= at) - 1;
        for line in &mut lines {
            *line = inserted(&knots, degree, line, span, at);
        }
        knots.insert(span + 1, at);
    }
    // The knot is there `degree` times now, or as often as it was. The control point that both parts share belongs to
    // the first of them.
    let first = knots.partition_point(|knot| *knot < at);
    let times = knots.partition_point(|knot| *knot <= at) - first;
    let shared = first + times - 1 - degree;
    let below: Vec<f64> = knots[..first + times].iter().copied().chain([at]).collect();
    let above: Vec<f64> = [at].into_iter().chain(knots[first + times - degree..].iter().copied()).collect();
    let mapped = |knots: Vec<f64>, low: f64, high: f64| -> Vec<f64> {
        // Ends to the last bit.
        let map = |knot: f64| if knot == high { 1.0 } else { (knot - low) / (high - low) };
        knots.into_iter().map(map).collect()
    };
    let part = |range: std::ops::RangeInclusive<usize>| lines.iter().map(|line| line[range.clone()].to_vec()).collect();
    let last = lines[0].len() - 1;
    [
        assembled(patch, axis, mapped(below, 0.0, at), part(0..=shared)),
        assembled(patch, axis, mapped(above, at, 1.0), part(shared..=last)),
    ]
}

/// The lines of control points along an axis, homogeneous.
fn lines(patch: &NurbsPatch, axis: usize) -> Vec<Vec<DVec4>> {
    let (along, across) = (patch.counts[axis], patch.counts[1 - axis]);
    let control = |k: usize, line: usize| {
        let index = if axis == 0 { k * patch.counts[1] + line } else { line * patch.counts[1] + k };
        patch.points[index].extend(1.0) * patch.weights[index]
    };
    (0..across).map(|line| (0..along).map(|k| control(k, line)).collect()).collect()
}

/// One line with the knot `at` inserted, which lies in the span that starts with knot `span`.
fn inserted(knots: &[f64], degree: usize, line: &[DVec4], span: usize, at: f64) -> Vec<DVec4> {
    let point = |k: usize| {
        if k + degree <= span {
            line[k]
        } else if k > span {
            line[k - 1]
        } else {
            let share = (at - knots[k]) / (knots[k + degree] - knots[k]);
            // Of no width where the knot is at the end of its support already: all of one point.
            if share >= 1.0 { line[k] } else { line[k - 1] * (1.0 - share) + line[k] * share }
        }
    };
    (0..=line.len()).map(point).collect()
}

fn assembled(patch: &NurbsPatch, axis: usize, knots: Vec<f64>, lines: Vec<Vec<DVec4>>) -> NurbsPatch {
    let mut counts = patch.counts;
    counts[axis] = lines[0].len();
    let entry = |index: usize| {
        let (i, j) = (index / counts[1], index % counts[1]);
        if axis == 0 { lines[j][i] } else { lines[i][j] }
    };
    let controls: Vec<DVec4> = (0..counts[0] * counts[1]).map(entry).collect();
    // Only ratios of weights matter. By a power of two, so that the parts of a border keep the same bits but for the
    // exponent.
    let largest = controls.iter().map(|control| control.w).fold(0.0, f64::max);
    let scale = (-largest.log2().ceil()).exp2();
    let mut all_knots = patch.knots.clone();
    all_knots[axis] = knots;
    NurbsPatch {
        name: patch.name.clone(),
        degree: patch.degree,
        knots: all_knots,
        counts,
        points: controls.iter().map(|control| control.xyz() / control.w).collect(),
        weights: controls.iter().map(|control| control.w * scale).collect(),
        flip: patch.flip,
    }
}
