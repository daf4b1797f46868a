//! A contestant of the race.

use crate::scene::{Probe, Scene};

/// The answer of a contestant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// It gave up.
    Nothing,
    /// `(u, v)` of the closest point.
    Parameters([f64; 2]),
    /// The closest point, metres.
    #[cfg_attr(not(feature = "peers"), expect(dead_code, reason = "only peers say no more"))]
    Point([f64; 3]),
}

/// Finds closest points. One that tracks keeps its state from query to query.
pub trait Contestant {
    /// The answer to one query.
    fn answer(&mut self, probe: &Probe) -> Answer;
}

/// Prepares a contestant for a scene: tables, trees and, where it tracks, the start. Nothing of it is measured.
pub type Enter = fn(&Scene) -> anyhow::Result<Box<dyn Contestant>>;
