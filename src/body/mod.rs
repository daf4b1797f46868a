//! The top level: bodies of several patches.
//!
//! *Features* are faces (patches), edges (border curves) and vertices. The space around a body falls into their Voronoi
//! regions: a feature's region is where it owns the closest point. Membership depends on the probe alone (theory §9).
//! [`Body`] holds the tables that the host has baked, as statics or from a file ([`Body::from_bytes`]); [`Locator`]
//! gives a global start in bounded time (theory §10).

mod along;
mod audit;
mod beside;
mod curve;
mod enter;
mod feature;
mod file;
mod locator;
mod meet;
mod minimise;
mod outside;
mod over_border;
mod pole;
mod quadratic;
mod search;
mod switch;
mod table;
mod tracker;
mod words;

pub use curve::{CurvePoint, MAX_CURVE_DEGREE, SplineCurve};
pub use feature::{Edge, EdgeFace, EdgeKind, Face, Feature, Separator, Side, Spoke, Vertex};
pub use file::{Aligned, FILE_VERSION, FileError, FileHead, Room, Section};
pub use locator::{Candidate, GRID, LEAF, Locator, MAX_DEPTH, MAX_FACES};
pub use minimise::{Descending, Judgement, MAX_EVALUATIONS_PER_CANDIDATE, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX};
pub use search::{Located, MAX_EVALUATIONS, MAX_EVALUATIONS_CONVEX, Search};
pub use table::{Body, BodyError};
pub use tracker::{BodyStep, BodyWitness};
pub use words::TableCursor;
