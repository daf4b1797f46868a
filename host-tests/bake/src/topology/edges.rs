//! Edges from borders: each border is a pole, or on one edge.

use super::border::{Border, BorderPoint};
use crate::NurbsPatch;
use crate::error::SeamFault;
use crate::jet::Jet;
use glam::DVec3;
use palpate::body::EdgeKind;

/// An edge: one border, or two that are the same curve. Its parameter is that of the first.
#[derive(Clone, Debug)]
pub struct TopologyEdge {
    /// The border whose curve it has.
    pub owner: Border,
    /// The other one, and how it runs; none beyond the border of an open body.
    pub partner: Option<(Border, Sense)>,
    /// The vertices at 0 and 1.
    pub ends: [usize; 2],
    /// How the faces meet.
    pub kind: EdgeKind,
}

/// Role of a border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BorderRole {
    /// On an edge.
    Edge {
        /// Its index.
        edge: usize,
        /// How the border runs on it.
        sense: Sense,
    },
    /// One point.
    Pole {
        /// Its vertex.
        vertex: usize,
    },
}

/// The borders that are not poles, matched.
pub(super) struct Matched<'a> {
    pub candidates: Vec<Candidate<'a>>,
    /// Pairs of indices; a border without partner has none.
    pub pairs: Vec<(usize, Option<(usize, Sense)>)>,
    pub poles: Vec<Candidate<'a>>,
}

/// Two sides of a patch that meet and are points: around their corner its other borders are one curve.
fn cusp(patch: usize, poles: &[Candidate<'_>], label: &dyn Fn(usize) -> String) -> Option<SeamFault> {
    let pole = |along_u: bool| {
        poles.iter().map(|pole| pole.border).find(|border| border.patch == patch && (border.side < 2) == along_u)
    };
    let (first, second) = (pole(true)?.to_string(), pole(false)?.to_string());
    Some(SeamFault::Cusp { patch: label(patch), first, second })
}

/// Finds which borders are the same curve, and refuses near matches.
pub(super) fn match_borders<'a>(
    patches: &'a [NurbsPatch],
    tolerance: f64,
    label: &dyn Fn(usize) -> String,
) -> Result<Matched<'a>, SeamFault> {
    let all = Border::all(patches.len()).map(|border| Candidate::new(border, &patches[border.patch]));
    let (poles, candidates): (Vec<_>, Vec<_>) = all.partition(|candidate| candidate.is_pole(tolerance));
    let name =
        |candidate: &Candidate<'_>| format!("side {} of patch {}", candidate.border, label(candidate.border.patch));
    let mut partners: Vec<Vec<(usize, Sense)>> = vec![Vec::new(); candidates.len()];
    for (i, first) in candidates.iter().enumerate() {
        for (j, second) in candidates.iter().enumerate().skip(i + 1) {
            if let Some(sense) = first.sense_of(second, tolerance) {
                partners[i].push((j, sense));
                partners[j].push((i, sense));
            }
        }
    }
    duplicates(&candidates, &partners, tolerance, label)?;
    for (i, all) in partners.iter().enumerate() {
        if let [(second, _), (third, _), ..] = all[..] {
            let of_these = [i, second, third].map(|index| candidates[index].border.patch);
            if let Some(cusp) = of_these.iter().find_map(|patch| cusp(*patch, &poles, label)) {
                return Err(cusp);
            }
            let [first, second, third] = [i, second, third].map(|index| name(&candidates[index]));
            return Err(SeamFault::ThreeFaces { first, second, third });
        }
    }
    for (i, open) in candidates.iter().enumerate().filter(|(i, _)| partners[*i].is_empty()) {
        for (j, other) in candidates.iter().enumerate().filter(|(j, _)| *j != i) {
            check_partial(open, other, partners[j].is_empty(), tolerance, &name)?;
        }
    }
    let is_first = |i: usize| partners[i].first().is_none_or(|(j, _)| i < *j);
    let pairs = (0..candidates.len()).filter(|i| is_first(*i)).map(|i| (i, partners[i].first().copied())).collect();
    Ok(Matched { candidates, pairs, poles })
}

/// Patches that agree in all borders and in their interior.
fn duplicates(
    candidates: &[Candidate<'_>],
    partners: &[Vec<(usize, Sense)>],
    tolerance: f64,
    label: &dyn Fn(usize) -> String,
) -> Result<(), SeamFault> {
    for (i, first) in candidates.iter().enumerate() {
        for (j, _) in &partners[i] {
            let second = &candidates[*j];
            let (a, b) = (first.border.patch, second.border.patch);
            if a >= b {
                continue;
            }
            let of_first = || (0..candidates.len()).filter(|k| candidates[*k].border.patch == a);
            let all_shared =
                of_first().all(|k| partners[k].iter().any(|(other, _)| candidates[*other].border.patch == b));
            if all_shared && is_same_surface(first.patch, second.patch, tolerance) {
                return Err(SeamFault::Duplicate { first: label(a), second: label(b) });
            }
        }
    }
    Ok(())
}

/// Whether two patches with the same borders are the same, turned or mirrored in their parameters or not.
fn is_same_surface(first: &NurbsPatch, second: &NurbsPatch, tolerance: f64) -> bool {
    // Of a grid that has no symmetry but those of the square.
    const INSIDE: [f64; 4] = [0.2, 0.37, 0.5, 0.81];
    let point = |patch: &NurbsPatch, u: f64, v: f64| Jet::of(patch, u, v).point;
    (0..8).any(|symmetry| {
        let image = |u: f64, v: f64| {
            let [u, v] = if symmetry & 4 == 0 { [u, v] } else { [v, u] };
            [if symmetry & 1 == 0 { u } else { 1.0 - u }, if symmetry & 2 == 0 { v } else { 1.0 - v }]
        };
        INSIDE.iter().flat_map(|u| INSIDE.iter().map(move |v| (*u, *v))).all(|(u, v)| {
            let [s, t] = image(u, v);
            point(first, u, v).distance(point(second, s, t)) <= tolerance
        })
    })
}

/// Refuses neighbours whose outward normals disagree.
pub(super) fn check_orientation(matched: &Matched<'_>, label: &dyn Fn(usize) -> String) -> Result<(), SeamFault> {
    let leftward = |index: usize| {
        let candidate = &matched.candidates[index];
        candidate.border.runs_with_patch_on_left(candidate.patch.flip)
    };
    let agrees = |i: usize, j: usize, sense: Sense| (leftward(i) != leftward(j)) == (sense == Sense::Same);
    let joined = || matched.pairs.iter().filter_map(|(i, partner)| partner.map(|(j, sense)| (*i, j, sense)));
    let Some((i, j, _)) = joined().find(|(i, j, sense)| !agrees(*i, *j, *sense)) else { return Ok(()) };
    let patch = |index: usize| matched.candidates[index].border.patch;
    let name = |index: usize| format!("side {} of patch {}", matched.candidates[index].border, label(patch(index)));
    // Of the two, the one that more of its neighbours disagree with.
    let disagreements = |of: usize| {
        joined().filter(|(i, j, sense)| (patch(*i) == of || patch(*j) == of) && !agrees(*i, *j, *sense)).count()
    };
    let suspect = if disagreements(patch(i)) > disagreements(patch(j)) { patch(i) } else { patch(j) };
    Err(SeamFault::Orientation { first: name(i), second: name(j), suspect: label(suspect) })
}

/// How the faces of a pair meet.
pub(super) fn kind_of(patches: &[NurbsPatch], owner: Border, partner: Option<(Border, Sense)>) -> EdgeKind {
    partner.map_or(EdgeKind::Open, |(other, sense)| edge_kind(patches, [owner, other], sense))
}

// Which borders are one curve.
//
// Two borders are one edge if they are the same *parametrised* curve, or the same run the other way: then the
// parameter of one is the parameter of the other, and the edge needs one curve. The same curve with another
// parametrisation is an error with a name of its own, see `super::partial`.

/// Points a span at which borders are compared. A span of a border is rational of degree 5 at most; two that agree at
/// 11 parameters agree everywhere, 16 leave some for conditioning.
const SAMPLES: usize = 16;

/// How two borders run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// The same way.
    Same,
    /// Against each other.
    Reversed,
}

impl Sense {
    /// The parameter of the second border at `t` of the first.
    pub const fn apply(self, t: f64) -> f64 {
        match self {
            Self::Same => t,
            Self::Reversed => 1.0 - t,
        }
    }
}

/// A border with what comparing needs at once.
#[derive(Clone, Debug)]
pub struct Candidate<'a> {
    /// Which.
    pub border: Border,
    /// Its patch.
    pub patch: &'a NurbsPatch,
    /// Its ends.
    pub ends: [DVec3; 2],
    /// Points at `k / (count − 1)`.
    pub points: Vec<DVec3>,
}

impl<'a> Candidate<'a> {
    /// Samples a border.
    pub fn new(border: Border, patch: &'a NurbsPatch) -> Self {
        let axis = border.axis();
        let spans = patch.knots[axis].windows(2).filter(|pair| pair[0] < pair[1]).count();
        let intervals = SAMPLES * spans;
        let points: Vec<_> = (0..=intervals).map(|k| border.point(patch, k as f64 / intervals as f64)).collect();
        Self { border, patch, ends: [points[0], points[intervals]], points }
    }

    /// Whether it is one point, within the tolerance.
    pub fn is_pole(&self, tolerance: f64) -> bool {
        self.points.iter().all(|point| point.distance(self.points[0]) <= tolerance)
    }

    /// Length of the polyline through its samples.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// Whether another border is the same curve, and how it runs.
    pub fn sense_of(&self, other: &Self, tolerance: f64) -> Option<Sense> {
        [Sense::Same, Sense::Reversed].into_iter().find(|sense| {
            let ends = if *sense == Sense::Same { other.ends } else { [other.ends[1], other.ends[0]] };
            let ends_agree = self.ends.iter().zip(&ends).all(|(a, b)| a.distance(*b) <= tolerance);
            ends_agree && (self.controls_agree(other, *sense, tolerance) || self.deviation(other, *sense) <= tolerance)
        })
    }

    /// The maximum distance at equal parameters, on the finer of both grids.
    pub fn deviation(&self, other: &Self, sense: Sense) -> f64 {
        let (fine, coarse) = if self.points.len() >= other.points.len() { (self, other) } else { (other, self) };
        let intervals = (fine.points.len() - 1) as f64;
        let at = |(k, point): (usize, &DVec3)| {
            point.distance(coarse.border.point(coarse.patch, sense.apply(k as f64 / intervals)))
        };
        fine.points.iter().enumerate().map(at).fold(0.0, f64::max)
    }

    /// Whether knots and weights agree and all control points do: then the curves do everywhere, for a point is a mean
    /// of control points.
    fn controls_agree(&self, other: &Self, sense: Sense, tolerance: f64) -> bool {
        let (axis, axis_other) = (self.border.axis(), other.border.axis());
        if self.patch.degree[axis] != other.patch.degree[axis_other] {
            return false;
        }
        let (Some(own), Some(mut others)) = (self.border.controls(self.patch), other.border.controls(other.patch))
        else {
            return false;
        };
        let mut knots: Vec<f64> = other.patch.knots[axis_other].clone();
        if sense == Sense::Reversed {
            others.reverse();
            knots = knots.iter().rev().map(|knot| 1.0 - knot).collect();
        }
        let knots_agree = knots.len() == self.patch.knots[axis].len()
            && knots.iter().zip(&self.patch.knots[axis]).all(|(a, b)| (a - b).abs() <= f64::EPSILON);
        // Weights count up to a common factor.
        let factor = own[0].1 / others[0].1;
        let agree = |((a, v), (b, w)): (&(DVec3, f64), &(DVec3, f64))| {
            (v - factor * w).abs() <= 4.0 * f64::EPSILON * v && a.distance(*b) <= tolerance
        };
        knots_agree && own.iter().zip(&others).all(agree)
    }
}

// Borders that are nearly one edge: what a modeller meant to join, and did not.

/// Points along a border that are tried against another. Three of them in a row on it are no crossing and no touch:
/// curves that touch part by more than the tolerance a 64th further on, unless they agree to second order.
const PARTIAL_SAMPLES: usize = 64;
const IN_A_ROW: usize = 3;
/// Unmatched borders that nowhere are farther apart than this, in sizes, are a crack and no gap that is meant.
const CRACK: f64 = 1e-3;
/// Nor are those that share both ends and part by less than this share of their length between them.
const SLIT: f64 = 0.05;

/// Looks for a fault between an unmatched border and another one that is not the same edge.
pub fn check_partial(
    open: &Candidate<'_>,
    other: &Candidate<'_>,
    other_is_open: bool,
    tolerance: f64,
    name: &dyn Fn(&Candidate<'_>) -> String,
) -> Result<(), SeamFault> {
    let size = tolerance / crate::patch::TOLERANCE;
    if !boxes_meet(open, other, CRACK * size) {
        return Ok(());
    }
    let common = common_part(open, other, tolerance);
    let common_other = common_part(other, open, tolerance);
    let whole = |range: &Option<[f64; 2]>| *range == Some([0.0, 1.0]);
    let deviation = || [Sense::Same, Sense::Reversed].map(|sense| open.deviation(other, sense)).into_iter();
    if whole(&common) && whole(&common_other) {
        let deviation = deviation().fold(f64::INFINITY, f64::min);
        return Err(SeamFault::Parametrisation { first: name(open), second: name(other), deviation });
    }
    for (first, second, range) in [(open, other, common), (other, open, common_other)] {
        if let Some([from, to]) = range {
            return Err(SeamFault::Partial { first: name(first), second: name(second), from, to });
        }
    }
    if other_is_open && open.border < other.border {
        for sense in [Sense::Same, Sense::Reversed] {
            let deviation = open.deviation(other, sense);
            let ends = [0, 1].map(|end| {
                let across = if sense == Sense::Same { end } else { 1 - end };
                open.ends[end].distance(other.ends[across]) <= tolerance
            });
            let slit = ends == [true; 2] && deviation <= SLIT * open.length().max(other.length());
            if slit || deviation <= CRACK * size {
                return Err(SeamFault::Gap { first: name(open), second: name(other), deviation, tolerance });
            }
        }
    }
    Ok(())
}

/// The first stretch of a border, of its parameter, that lies on another: at least [`IN_A_ROW`] samples of it.
fn common_part(of: &Candidate<'_>, on: &Candidate<'_>, tolerance: f64) -> Option<[f64; 2]> {
    let lies_on =
        |k: usize| distance(on, of.border.point(of.patch, k as f64 / PARTIAL_SAMPLES as f64), tolerance) <= tolerance;
    let mut start = None;
    for k in 0..=PARTIAL_SAMPLES + 1 {
        let on = k <= PARTIAL_SAMPLES && lies_on(k);
        match start {
            None if on => start = Some(k),
            Some(first) if !on => {
                if k - first >= IN_A_ROW {
                    return Some([first as f64 / PARTIAL_SAMPLES as f64, (k - 1) as f64 / PARTIAL_SAMPLES as f64]);
                }
                start = None;
            }
            _ => {}
        }
    }
    None
}

/// The distance of a point from a border: Newton's method from the nearest sample, or the nearest sample's where that
/// is far.
fn distance(on: &Candidate<'_>, point: DVec3, tolerance: f64) -> f64 {
    let intervals = on.points.len() - 1;
    let far = on.points.iter().enumerate().map(|(k, sample)| (sample.distance(point), k));
    let (mut least, nearest) = far.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0));
    let mut t = nearest as f64 / intervals as f64;
    for _ in 0..20 {
        if least <= tolerance {
            break;
        }
        let at = on.border.at(on.patch, t);
        let off = at.point - point;
        // Gauss and Newton: near a point that lies on the curve it is Newton's step.
        let step = off.dot(at.tangent) / at.tangent.length_squared();
        if !step.is_finite() || step.abs() < 1e-15 {
            break;
        }
        t = (t - step).clamp(0.0, 1.0);
        least = least.min(on.border.point(on.patch, t).distance(point));
    }
    least
}

fn boxes_meet(a: &Candidate<'_>, b: &Candidate<'_>, margin: f64) -> bool {
    let extent = |candidate: &Candidate<'_>| {
        let points = candidate.points.iter();
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| (low.min(*point), high.max(*point)))
    };
    let ((low_a, high_a), (low_b, high_b)) = (extent(a), extent(b));
    // Between samples a curve may bulge out of their box; a part in common has samples of either on it.
    low_a.cmple(high_b + margin).all() && low_b.cmple(high_a + margin).all()
}

// How the faces of an edge stand to each other.
//
// Seen from outside, an edge is a ridge where a face's plane has the other face below it: `N_A · m_B > 0`, with `N_A`
// the outward normal of one face and `m_B` the conormal of the other that points out of *it*. The sine of the angle by
// which the normals turn is that number, in absolute value. It is sampled, not proved.

/// Normals that turn by less than this (radians) count as equal. The distance to an edge that is taken for smooth is
/// wrong by at most the square of it times half the distance, 5e-9 of it: less than `f32` resolves. Coordinates of nine
/// digits turn normals by some 1e-8.
pub const SMOOTH_ANGLE: f64 = 1e-4;

/// Where an edge is looked at: the middles of this many intervals, never its ends, which may be poles.
const KINDS_SAMPLES: usize = 64;

/// The edge_kind of an edge with two faces.
pub fn edge_kind(patches: &[NurbsPatch], faces: [Border; 2], sense: Sense) -> EdgeKind {
    let (mut ridge, mut valley, mut fold) = (false, false, false);
    for k in 0..KINDS_SAMPLES {
        let t = (k as f64 + 0.5) / KINDS_SAMPLES as f64;
        let [a, b] = [(faces[0], t), (faces[1], sense.apply(t))].map(|(face, t)| face.at(&patches[face.patch], t));
        match turn(&a, &b) {
            Turn::Ridge => ridge = true,
            Turn::Valley => valley = true,
            Turn::Fold => fold = true,
            Turn::None => {}
        }
    }
    match (ridge, valley, fold) {
        (_, _, true) | (true, true, _) => EdgeKind::Mixed,
        (true, false, _) => EdgeKind::Convex,
        (false, true, _) => EdgeKind::Reflex,
        (false, false, false) => EdgeKind::Smooth,
    }
}

enum Turn {
    None,
    Ridge,
    Valley,
    /// The faces lie on each other: a knife's edge or the bottom of a crack, this point alone cannot say.
    Fold,
}

fn turn(a: &BorderPoint, b: &BorderPoint) -> Turn {
    let sine = a.normal.dot(b.conormal());
    if sine > SMOOTH_ANGLE {
        Turn::Ridge
    } else if sine < -SMOOTH_ANGLE {
        Turn::Valley
    } else if a.normal.dot(b.normal) < 0.0 {
        Turn::Fold
    } else {
        Turn::None
    }
}
