//! The global start: the candidates of the probe's cell, half an evaluation at a time.
//!
//! A servo tick carries half an evaluation: the search runs beside the tracker until it ends, and starts again in the
//! cell where the probe then is. [`Body::locate`] runs the same search in one call.

use super::candidate_search::{
    CandidateSearch, CandidateStatus, MAX_EVALUATIONS_PER_CANDIDATE, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX,
};
use super::feature::Face;
use super::locator::{Candidate, GRID};
use super::table::Body;
use crate::math::{Vec3, sqrt};
use crate::patch::{Patch as _, SplinePatch};

/// Maximum evaluations of a search.
pub const MAX_EVALUATIONS: u16 = 512;
/// Maximum evaluations of a search on a convex body.
pub const MAX_EVALUATIONS_CONVEX: u16 = 32;

/// A search between two evaluations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Search {
    descending: CandidateSearch,
    /// Index of the candidate's entry.
    entry: u16,
    evaluations: u16,
    best: Best,
    /// In the audit: the probe and the distance to beat at the start of the candidate. A minimum that moved with the
    /// probe would never be found.
    asked: Option<(Vec3, f32)>,
    /// Whether a candidate ended before its minimum.
    exhausted: bool,
    /// Once the search has ended: whether every candidate was searched to its end.
    ended: Option<bool>,
}

/// The nearest point so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Best {
    pub face: u16,
    pub parameters: [f32; 2],
    pub half_squared: f32,
}

/// The tracker's point, for which the audit looks for a nearer one.
#[derive(Clone, Copy)]
pub(super) struct Rival {
    /// Bound of `½ ‖P − Q‖²` for a nearer point, m².
    pub half_squared: f32,
    /// The faces that hold it, with `(u, v)`: two on an edge.
    pub places: [Option<(u16, [f32; 2])>; 2],
}

impl Rival {
    /// Whether the tracker's point is the nearest of a candidate: `φ` has one minimum there, and the tracker goes to
    /// it.
    #[inline]
    fn holds(&self, candidate: &Candidate) -> bool {
        let [lower, upper] = candidate.rectangle();
        let is_within = |[u, v]: [f32; 2]| lower[0] <= u && u <= upper[0] && lower[1] <= v && v <= upper[1];
        let is_its = |place: &Option<(u16, [f32; 2])>| {
            place.is_some_and(|(face, parameters)| face == candidate.face && is_within(parameters))
        };
        candidate.convex && self.places.iter().any(is_its)
    }
}

/// The closest point of a body to a probe, from a query without history ([`Body::locate`]).
///
/// ```
/// # use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face};
/// # use palpate::math::vec3;
/// # static FILE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/boards/bodies/capped_box.palp")));
/// # let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
/// # let body = Body::from_bytes(&FILE.0, BodyBuffer { faces: &mut faces, edges: &mut edges })?;
/// // 10 mm beside a box of 60 mm × 40 mm.
/// let located = body.locate(vec3(-0.01, 0.02, 0.01));
/// assert!(located.complete && (located.distance() - 0.01).abs() < 1e-7);
/// assert_eq!(located.point.x, 0.0);
/// # Ok::<(), palpate::body::FileError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located {
    /// Index of the face.
    pub face: u16,
    /// `(u, v)` on it.
    pub parameters: [f32; 2],
    /// The point, metres, in the frame of the body's tables.
    pub point: Vec3,
    /// Evaluations of patches that the search needed.
    pub evaluations: u16,
    /// Whether the search reached the end of every candidate. Otherwise it used up its evaluations, and another point
    /// may be nearer.
    pub complete: bool,
    distance_squared: f32,
}

impl Located {
    /// Distance from the probe to the point, metres; not negative, inside a body neither.
    pub fn distance(&self) -> f32 {
        sqrt(self.distance_squared)
    }
}

impl Search {
    /// A search in the cell of a probe, before its first evaluation.
    pub fn new(body: &Body, probe: Vec3) -> Self {
        let entry = body.locator.list(probe);
        Self {
            descending: body.descending(entry),
            entry: entry as u16,
            evaluations: 0,
            best: Best { face: 0, parameters: [0.5; 2], half_squared: f32::INFINITY },
            asked: None,
            exhausted: false,
            ended: None,
        }
    }

    /// Whether the last half step was an evaluation.
    pub const fn has_evaluated(&self) -> bool {
        self.descending.has_evaluated()
    }

    /// Half a step: one evaluation, or the choice of the next parameters. The probe may move a little between two
    /// calls. Does nothing once the search has ended.
    #[inline]
    pub fn advance(&mut self, body: &Body, probe: Vec3) {
        self.advance_against(body, probe, None);
    }

    /// The same for the audit, which ends at the first point that is nearer than the `rival`. Candidates that are
    /// certain to hold none are skipped.
    #[inline(always)]
    pub(super) fn advance_against(&mut self, body: &Body, probe: Vec3, rival: Option<&Rival>) {
        if self.ended.is_some() {
            return;
        }
        let Candidate { face, .. } = self.descending.candidate;
        let Some(Face { patch, .. }) = body.faces.get(usize::from(face)) else {
            self.ended = Some(false);
            return;
        };
        if !self.descending.has_evaluated() {
            if let Some(rival) = rival
                && self.descending.is_fresh()
            {
                if rival.holds(&self.descending.candidate) {
                    self.go_on(body, CandidateStatus::Beaten);
                    return;
                }
                self.asked = Some((probe, rival.half_squared));
            }
            let asked = rival.and(self.asked);
            self.descending.evaluate(patch, asked.map_or(probe, |(probe, _)| probe));
            self.evaluations += 1;
            if let Some((_, known)) = asked
                && let Some((parameters, half_squared)) = self.descending.seen()
                && half_squared < known
            {
                self.best = Best { face, parameters, half_squared };
                self.ended = Some(true);
            }
            return;
        }
        let asked = rival.and(self.asked);
        let known = asked.map_or(self.best.half_squared, |(_, known)| known);
        let progress = if body.has_poles {
            self.descending.judge_near_pole(patch, body.poles_of(face), known, body.size)
        } else {
            self.descending.judge(patch, known, body.size)
        };
        if progress == CandidateStatus::Exhausted {
            self.exhausted = true;
        }
        let CandidateSearch { parameters, half_squared, .. } = self.descending;
        if half_squared < self.best.half_squared {
            self.best = Best { face, parameters, half_squared };
        }
        if asked.is_some() && half_squared < known {
            self.ended = Some(true);
        } else {
            self.go_on(body, progress);
        }
    }

    /// Continues with the next candidate, after one whose point is not nearer.
    pub(super) fn resume(&mut self, body: &Body) {
        (self.ended, self.best.half_squared) = (None, f32::INFINITY);
        self.go_on(body, CandidateStatus::Beaten);
    }

    /// Continues with the next evaluation or candidate, or ends.
    #[inline]
    fn go_on(&mut self, body: &Body, progress: CandidateStatus) {
        let most = if body.is_convex() { MAX_EVALUATIONS_CONVEX } else { MAX_EVALUATIONS };
        let falls = progress == CandidateStatus::Falling;
        if !falls && !self.descending.candidate.more {
            self.ended = Some(!self.exhausted);
        } else if self.evaluations >= most {
            self.ended = Some(false);
        } else if !falls {
            self.entry += 1;
            self.descending = body.descending(usize::from(self.entry));
        }
    }

    /// The nearest point, once the search has ended.
    #[inline]
    pub fn found(&self) -> Option<Best> {
        self.ended.map(|_| self.best)
    }
}

/// Whether one of two parameters may be on a line of the grid of the rectangles: a quick test that most pass.
#[inline(always)]
fn is_on_grid(parameters: [f32; 2]) -> bool {
    /// Added to a small number it rounds that to a whole one.
    const WHOLE: f32 = 1.5 * (1 << 23) as f32;
    /// Some roundings of a number of steps, times half a step, which the other may be off by.
    const NEAR: f32 = 4.0 * GRID as f32 * f32::EPSILON;
    let [u, v] = parameters.map(|parameter| {
        let steps = parameter * GRID as f32;
        steps - ((steps + WHOLE) - WHOLE)
    });
    (u * v).abs() < NEAR
}

impl Body<'_> {
    /// The closest point of the body to a probe, without history. At most [`MAX_EVALUATIONS`] of patches, on a convex
    /// body [`MAX_EVALUATIONS_CONVEX`], and [`MAX_EVALUATIONS_PER_CANDIDATE`] if the list turns out not to hold it;
    /// then one for the point.
    pub fn locate(&self, probe: Vec3) -> Located {
        let mut search = Search::new(self, probe);
        // Two halves an evaluation.
        for _ in 0..2 * MAX_EVALUATIONS {
            search.advance(self, probe);
            if search.ended.is_some() {
                break;
            }
        }
        if is_on_grid(search.best.parameters) {
            self.go_beyond_rectangle(&mut search, probe);
        }
        let Best { face, parameters, .. } = search.best;
        let patch = self.faces.get(usize::from(face)).map_or(&SplinePatch::VACANT, |face| &face.patch);
        let point = patch.evaluate(parameters[0], parameters[1]).point;
        let distance_squared = (point - probe).length_squared();
        let Search { evaluations, ended, .. } = search;
        Located { face, parameters, point, evaluations, complete: ended.unwrap_or(false), distance_squared }
    }

    /// A minimum on the border of a rectangle is not one of the face: the list is incomplete, as it may be beyond the
    /// root cube and in a cell without proof. The search continues over the whole face.
    #[inline(never)]
    fn go_beyond_rectangle(&self, search: &mut Search, probe: Vec3) {
        let Best { face: index, parameters, half_squared } = search.best;
        let list = self.locator.entries.get(self.locator.list(probe)..).unwrap_or(&[]);
        let mut is_cut = false;
        for candidate in list.iter().map(|entry| Candidate::unpack(*entry)) {
            is_cut |= candidate.face == index && candidate.cuts(parameters);
            if !candidate.more {
                break;
            }
        }
        if !is_cut {
            return;
        }
        let Some(Face { patch, .. }) = self.faces.get(usize::from(index)) else { return };
        let most = MAX_EVALUATIONS_PER_CANDIDATE;
        let mut descending = CandidateSearch::from(Candidate::whole(index), parameters, most).with_last_evaluation();
        for _ in 0..most {
            search.evaluations += 1;
            if descending.step(patch, self.poles_of(index), probe, f32::INFINITY, self.size) != CandidateStatus::Falling
            {
                break;
            }
        }
        if descending.half_squared < half_squared {
            let CandidateSearch { parameters, half_squared, .. } = descending;
            search.best = Best { face: index, parameters, half_squared };
        }
    }

    /// A search from the middle of the candidate at an index.
    fn descending(&self, entry: usize) -> CandidateSearch {
        let candidate = self.candidate(entry);
        // A convex body's lists are short, and no audit follows.
        if self.is_convex() {
            CandidateSearch::new(candidate, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX).with_last_evaluation()
        } else {
            CandidateSearch::new(candidate, MAX_EVALUATIONS_PER_CANDIDATE)
        }
    }

    fn poles_of(&self, face: u16) -> u8 {
        self.faces.get(usize::from(face)).map_or(0, Face::poles)
    }

    /// The candidate at an index; the constructor checked that lists end.
    fn candidate(&self, entry: usize) -> Candidate {
        self.locator.candidate(entry).unwrap_or(Candidate::whole(0))
    }
}
