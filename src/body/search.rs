//! The global start: the candidates of the probe's cell, one evaluation at a time.
//!
//! One evaluation a call, so that a servo tick can carry it: the search runs beside the tracker until it is done, and begins anew
//! in whatever cell the probe is then. The same search answers a query at one go ([`Body::locate`]).

use super::locator::Candidate;
use super::minimise::{Descending, Progress};
use super::table::Body;
use crate::math::Vec3;

/// Evaluations that a search may cost on any body.
pub const MOST_EVALUATIONS: u16 = 512;
/// Evaluations that a search may cost on a convex body.
pub const MOST_EVALUATIONS_CONVEX: u16 = 32;

/// A search between two evaluations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    descending: Descending,
    /// Index of the entry that is being searched.
    entry: u16,
    evaluations: u16,
    best: Best,
}

/// The nearest so far.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Best {
    face: u16,
    parameters: [f32; 2],
    half_squared: f32,
}

/// The closest point of a body, as the locator found it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Located {
    /// Index of the face.
    pub face: u16,
    /// `(u, v)` on it.
    pub parameters: [f32; 2],
    /// `½ ‖P − Q‖²`, m².
    pub half_squared: f32,
    /// Evaluations spent.
    pub evaluations: u16,
    /// Whether every candidate was searched to its end. Otherwise the evaluations were used up.
    pub complete: bool,
}

impl Search {
    /// Before the first evaluation, in the cell of a probe.
    pub fn new(body: &Body, probe: Vec3) -> Self {
        let entry = body.locator.list(probe);
        Self {
            descending: Descending::new(body.candidate(entry)),
            entry: entry as u16,
            evaluations: 0,
            best: Best { face: 0, parameters: [0.5; 2], half_squared: f32::INFINITY },
        }
    }

    /// One evaluation; `Some` when the search is done. The probe may move a little between two calls.
    #[inline]
    pub fn step(&mut self, body: &Body, probe: Vec3) -> Option<Located> {
        let Candidate { face, more, .. } = self.descending.candidate;
        let Some(patch) = body.faces.get(usize::from(face)).map(|face| &face.patch) else {
            return Some(self.located(false));
        };
        let progress = self.descending.step(patch, probe, self.best.half_squared, body.size);
        self.evaluations += 1;
        let Descending { parameters, half_squared, .. } = self.descending;
        if half_squared < self.best.half_squared {
            self.best = Best { face, parameters, half_squared };
        }
        if progress != Progress::Falling {
            if !more {
                return Some(self.located(true));
            }
            self.entry += 1;
            self.descending = Descending::new(body.candidate(usize::from(self.entry)));
        }
        let most = if body.is_convex { MOST_EVALUATIONS_CONVEX } else { MOST_EVALUATIONS };
        (self.evaluations >= most).then(|| self.located(false))
    }

    fn located(&self, complete: bool) -> Located {
        let Best { face, parameters, half_squared } = self.best;
        Located { face, parameters, half_squared, evaluations: self.evaluations, complete }
    }
}

impl Body {
    /// The closest point of the body from a standing start. At most [`MOST_EVALUATIONS`] of patches, on a convex body
    /// [`MOST_EVALUATIONS_CONVEX`].
    pub fn locate(&self, probe: Vec3) -> Located {
        let mut search = Search::new(self, probe);
        for _ in 0..MOST_EVALUATIONS {
            if let Some(located) = search.step(self, probe) {
                return located;
            }
        }
        search.located(false)
    }

    /// The candidate at an index; the constructor checked that lists end.
    fn candidate(&self, entry: usize) -> Candidate {
        self.locator.candidate(entry).unwrap_or(Candidate {
            face: 0,
            lower: [0; 2],
            upper: [super::locator::GRID as u8; 2],
            convex: false,
            more: false,
        })
    }
}
