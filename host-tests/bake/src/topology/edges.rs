//! Edges from borders: each border is a pole, or on one edge.

use super::border::Border;
use super::fault::SeamFault;
use super::kinds;
use super::matching::{Candidate, Sense};
use super::partial;
use crate::NurbsPatch;
use crate::jet::Jet;
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

/// What a border is.
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

/// Finds which borders are one curve, and refuses what is nearly so.
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
            let [first, second, third] = [i, second, third].map(|index| name(&candidates[index]));
            return Err(SeamFault::ThreeFaces { first, second, third });
        }
    }
    for (i, open) in candidates.iter().enumerate().filter(|(i, _)| partners[*i].is_empty()) {
        for (j, other) in candidates.iter().enumerate().filter(|(j, _)| *j != i) {
            partial::check(open, other, partners[j].is_empty(), tolerance, &name)?;
        }
    }
    let is_first = |i: usize| partners[i].first().is_none_or(|(j, _)| i < *j);
    let pairs = (0..candidates.len()).filter(|i| is_first(*i)).map(|i| (i, partners[i].first().copied())).collect();
    Ok(Matched { candidates, pairs, poles })
}

/// Patches all of whose borders agree, and what is between them too.
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
    partner.map_or(EdgeKind::Open, |(other, sense)| kinds::kind(patches, [owner, other], sense))
}
