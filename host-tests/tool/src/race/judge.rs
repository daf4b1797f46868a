//! Judging answers: by how much the distance to them differs from the distance to the closest point.

use super::program::{Counted, Kind, Line, Run};
use super::scene::{Query, Scene, Task};
use crate::spread::Spread;
use glam::DVec3;
use palpate_bake::NurbsPatch;
use palpate_truth::oracle::OraclePoint;

/// A distance that is wrong by more, relative to the patch's size, is a miss.
pub const MISS: f64 = 1e-4;

/// How a contestant did on a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// The model.
    pub model: String,
    /// The task.
    pub task: Task,
    /// The contestant.
    pub contestant: String,
    /// Queries.
    pub queries: usize,
    /// Instructions a query, the call included.
    pub instructions: Spread<u64>,
    /// Nanoseconds a query.
    pub nanoseconds: Spread<u64>,
    /// Error of the distance, relative to the patch's size, of the queries that were answered.
    pub error: Spread<f64>,
    /// Distances wrong by more than `MISS`, and queries not answered.
    pub misses: usize,
    /// Queries not answered.
    pub unanswered: usize,
}

/// Judges one run.
pub(super) fn score(scene: &Scene, run: &Run, counted: &Counted) -> Score {
    let size = scene.patch.size();
    let errors: Vec<Option<f64>> = scene
        .queries
        .iter()
        .zip(&run.answers)
        .map(|(query, answer)| error(&scene.patch, query, answer).map(|error| error / size))
        .collect();
    let answered: Vec<f64> = errors.iter().copied().flatten().collect();
    let unanswered = errors.len() - answered.len();
    let nanoseconds: Vec<u64> = run.answers.iter().filter_map(|answer| answer.nanoseconds).collect();
    let nothing = Spread { median: f64::NAN, most: f64::NAN, worst: f64::NAN };
    let zero = Spread { median: 0, most: 0, worst: 0 };
    Score {
        model: scene.model.clone(),
        task: scene.task,
        contestant: run.contestant.clone(),
        queries: scene.queries.len(),
        instructions: Spread::of(&counted.instructions).unwrap_or(zero),
        nanoseconds: Spread::of(&nanoseconds).unwrap_or(zero),
        misses: unanswered + answered.iter().filter(|error| **error > MISS).count(),
        error: Spread::of(&answered).unwrap_or(nothing),
        unanswered,
    }
}

/// Error of the distance, metres; `None` without an answer. Parameters off the patch count as the nearest on it.
fn error(patch: &NurbsPatch, query: &Query, answer: &Line) -> Option<f64> {
    let (a, b) = (answer.a?, answer.b?);
    let point = match answer.kind {
        Kind::None => return None,
        Kind::Parameters => OraclePoint::evaluate(patch, a.clamp(0.0, 1.0), b.clamp(0.0, 1.0)).point,
        Kind::Point => DVec3::new(a, b, answer.c?),
    };
    let error = (point.distance(query.probe) - query.distance).abs();
    error.is_finite().then_some(error)
}
