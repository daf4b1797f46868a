//! The global start: the candidates of the probe's cell, one evaluation at a time.
//!
//! A servo tick carries a few evaluations ([`super::Effort`]), until the search ends. [`Body::locate`] runs the same
//! search in one call.

use super::candidate_search::{
    CandidateSearch, CandidateStatus, MAX_EVALUATIONS_PER_CANDIDATE, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX,
};
use super::feature::Face;
use super::glance;
use super::locator::{Candidate, GRID};
use super::quadratic_model::DistanceDerivatives;
use super::table::Body;
use crate::field::Displacement;
use crate::math::{Vec3, sqrt, sqrt_from_above};
use crate::patch::{Patch as _, SplinePatch};

/// Maximum evaluations of a search.
pub const MAX_EVALUATIONS: u16 = 512;
/// Maximum evaluations of a search on a convex body.
pub const MAX_EVALUATIONS_CONVEX: u16 = 32;

/// Faces from which on lists are long.
const LARGE: usize = 64;

/// Glances in the time of an evaluation.
const GLANCES: usize = 5;

/// A search between two evaluations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Search {
    pub(super) descending: CandidateSearch,
    /// Index of the candidate's entry.
    pub(super) entry: u16,
    evaluations: u16,
    best: Best,
    /// Whether the candidate, not evaluated yet, may be nearer for all that a glance tells.
    is_seen: bool,
    /// Whether a candidate ended before its minimum.
    exhausted: bool,
    /// Once the search has ended: whether every candidate was searched to its end.
    pub(super) ended: Option<bool>,
}

/// The nearest point so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Best {
    pub face: u16,
    pub parameters: [f32; 2],
    pub half_squared: f32,
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
    #[inline(always)]
    pub fn new<D: Displacement>(body: &Body<'_, D>, probe: Vec3) -> Self {
        let entry = body.locator.list(body.at_rest(probe));
        Self {
            descending: body.descending(body.candidate(entry)),
            entry: entry as u16,
            is_seen: false,
            evaluations: 0,
            best: Best { face: 0, parameters: [0.5; 2], half_squared: f32::INFINITY },
            exhausted: false,
            ended: None,
        }
    }

    /// One evaluation. The probe may move a little between two calls. Does nothing once the search has ended. `TO_REST` as
    /// of [`CandidateSearch::step_on`].
    #[inline(never)]
    pub fn advance<D: Displacement, const TO_REST: bool>(&mut self, body: &Body<'_, D>, probe: Vec3) {
        if self.ended.is_some() {
            return;
        }
        // Elsewhere lists are too short for it to pay.
        if !body.is_convex()
            && body.faces.len() >= LARGE
            && self.descending.is_fresh()
            && !self.is_seen
            && self.passes_over(body, probe)
        {
            return;
        }
        self.is_seen = false;
        let Candidate { face, .. } = self.descending.candidate;
        let Some(progress) = body.search_on::<TO_REST>(&mut self.descending, probe, self.best.half_squared) else {
            self.ended = Some(false);
            return;
        };
        self.evaluations += 1;
        if progress == CandidateStatus::Exhausted {
            self.exhausted = true;
        }
        let CandidateSearch { parameters, half_squared, .. } = self.descending;
        if half_squared < self.best.half_squared {
            self.best = Best { face, parameters, half_squared };
        }
        self.go_on(body, progress);
    }

    /// Passes over candidates that are farther than the best point at a glance, as many as take the time of an
    /// evaluation; whether there were any.
    #[inline]
    fn passes_over<D: Displacement>(&mut self, body: &Body<'_, D>, probe: Vec3) -> bool {
        if self.best.half_squared == f32::INFINITY {
            return false;
        }
        let (before, mut candidate) = (self.evaluations, self.descending.candidate);
        let distance = sqrt_from_above(2.0 * self.best.half_squared);
        // Hidden from the compiler, which would unroll every round.
        for _ in 0..core::hint::black_box(GLANCES) {
            self.is_seen = !body.is_farther(&candidate, probe, distance);
            if self.is_seen {
                break;
            }
            self.evaluations += 1;
            if !candidate.more || self.evaluations >= MAX_EVALUATIONS {
                self.ended = Some(!candidate.more && !self.exhausted);
                return true;
            }
            self.entry += 1;
            candidate = body.candidate(usize::from(self.entry));
        }
        if self.evaluations == before {
            return false;
        }
        self.descending = body.descending(candidate);
        true
    }

    /// Continues with the next evaluation or candidate, or ends.
    #[inline]
    fn go_on<D: Displacement>(&mut self, body: &Body<'_, D>, progress: CandidateStatus) {
        let most = if body.is_convex() { MAX_EVALUATIONS_CONVEX } else { MAX_EVALUATIONS };
        let falls = progress == CandidateStatus::Falling;
        if !falls && !self.descending.candidate.more {
            self.ended = Some(!self.exhausted);
        } else if self.evaluations >= most {
            self.ended = Some(false);
        } else if !falls {
            self.entry += 1;
            self.descending = body.descending(body.candidate(usize::from(self.entry)));
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

impl<D: Displacement> Body<'_, D> {
    /// The closest point of the body to a probe, without history. At most [`MAX_EVALUATIONS`] of patches, on a convex
    /// body [`MAX_EVALUATIONS_CONVEX`], and [`MAX_EVALUATIONS_PER_CANDIDATE`] if the list turns out not to hold it;
    /// then one for the point.
    pub fn locate(&self, probe: Vec3) -> Located {
        let mut search = Search::new(self, probe);
        for _ in 0..MAX_EVALUATIONS {
            search.advance::<D, true>(self, probe);
            if search.ended.is_some() {
                break;
            }
        }
        if is_on_grid(search.best.parameters) {
            self.go_beyond_rectangle(&mut search, probe);
        }
        let Best { face, parameters, .. } = search.best;
        let patch = self.faces.get(usize::from(face)).map_or(&SplinePatch::VACANT, |face| &face.patch);
        let point = self.by.point(patch.evaluate(parameters[0], parameters[1]).point);
        let distance_squared = (point - probe).length_squared();
        let Search { evaluations, ended, .. } = search;
        Located { face, parameters, point, evaluations, complete: ended.unwrap_or(false), distance_squared }
    }

    /// A minimum on the border of a rectangle is not one of the face: the list is incomplete, as it may be beyond the
    /// root cube and in a cell without proof. The search continues over the whole face.
    #[inline(never)]
    fn go_beyond_rectangle(&self, search: &mut Search, probe: Vec3) {
        let Best { face: index, parameters, half_squared } = search.best;
        let mut entry = self.locator.list(self.at_rest(probe));
        let mut is_cut = false;
        while let Some(candidate) = self.locator.candidate(entry) {
            is_cut |= candidate.face == index && candidate.cuts(parameters);
            if !candidate.more {
                break;
            }
            entry += 1;
        }
        if !is_cut {
            return;
        }
        let Some(patch) = self.faces.get(usize::from(index)).map(|face| self.patch(face)) else { return };
        let most = MAX_EVALUATIONS_PER_CANDIDATE;
        let mut descending = CandidateSearch::from(Candidate::whole(index), parameters, most).with_last_evaluation();
        for _ in 0..most {
            search.evaluations += 1;
            if descending.step_on::<D, true>(patch, self.poles_of(index), probe, f32::INFINITY, self.size)
                != CandidateStatus::Falling
            {
                break;
            }
        }
        if descending.half_squared < half_squared {
            let CandidateSearch { parameters, half_squared, .. } = descending;
            search.best = Best { face: index, parameters, half_squared };
        }
    }

    /// One evaluation in a candidate; `None` if its face does not exist.
    #[inline]
    pub(super) fn search_on<const TO_REST: bool>(
        &self,
        search: &mut CandidateSearch,
        probe: Vec3,
        known: f32,
    ) -> Option<CandidateStatus> {
        let seen = self.see(search, probe)?;
        self.judge::<TO_REST>(search, &seen, known)
    }

    /// The evaluation alone.
    #[inline]
    pub(super) fn see(&self, search: &CandidateSearch, probe: Vec3) -> Option<DistanceDerivatives> {
        let on = self.faces.get(usize::from(search.candidate.face))?;
        Some(search.see(self.patch(on), probe))
    }

    /// The rest of that step.
    #[inline]
    pub(super) fn judge<const TO_REST: bool>(
        &self,
        search: &mut CandidateSearch,
        seen: &DistanceDerivatives,
        known: f32,
    ) -> Option<CandidateStatus> {
        let on = self.faces.get(usize::from(search.candidate.face))?;
        let poles = if self.has_poles { on.poles() } else { 0 };
        Some(search.judge::<D, TO_REST>(self.patch(on), poles, seen, known, self.size))
    }

    /// A search from the middle of a candidate.
    #[inline(always)]
    fn descending(&self, candidate: Candidate) -> CandidateSearch {
        // A convex body's lists are short, and no audit follows.
        if self.is_convex() {
            CandidateSearch::new(candidate, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX).with_last_evaluation()
        } else {
            CandidateSearch::new(candidate, MAX_EVALUATIONS_PER_CANDIDATE)
        }
    }

    /// Whether a candidate is farther than a distance, at a glance.
    #[inline(always)]
    fn is_farther(&self, candidate: &Candidate, probe: Vec3, distance: f32) -> bool {
        let face = self.faces.get(usize::from(candidate.face));
        self.by.is_rest() && face.is_some_and(|face| glance::is_farther(&face.patch, candidate, probe, distance))
    }

    fn poles_of(&self, face: u16) -> u8 {
        self.faces.get(usize::from(face)).map_or(0, Face::poles)
    }

    /// The candidate at an index; the constructor checked that lists end.
    pub(super) fn candidate(&self, entry: usize) -> Candidate {
        let mut candidate = self.locator.candidate(entry).unwrap_or(Candidate::whole(0));
        // Proved at rest only.
        candidate.convex &= self.by.is_rest();
        candidate
    }
}
