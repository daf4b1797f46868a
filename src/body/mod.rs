//! The top level: bodies of several patches.
//!
//! *Features* are faces (patches), edges (border curves) and vertices. The space around a body falls into their Voronoi
//! regions: a feature's region is where it owns the closest point. Membership depends on the probe alone (theory §9).
//! [`Body`] holds the tables that the host has baked, as statics or from a file ([`Body::from_bytes`]); [`Locator`]
//! gives a global start in bounded time (theory §10).

mod audit;
mod border_release;
mod candidate_search;
mod contact;
mod curve;
mod deformed;
mod edge_step;
mod face_entry;
mod feature;
mod feature_switch;
mod file;
mod glance;
mod inside_test;
mod locator;
mod pole;
mod pole_step;
mod quadratic_model;
mod search;
mod soft;
mod table;
mod table_words;
mod tick_bound;
pub mod tick_cost;
mod tracker;

pub use candidate_search::{
    CandidateSearch, CandidateStatus, MAX_EVALUATIONS_PER_CANDIDATE, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX,
};
pub use curve::{CurvePoint, MAX_CURVE_DEGREE, SplineCurve};
pub use feature::{Edge, EdgeFace, EdgeKind, Face, Feature, Separator, Side, Spoke, Vertex};
pub use file::{Aligned, BodyBuffer, FILE_VERSION, FileError, FileHead, Section};
pub use locator::{Candidate, GRID, Lists, Locator, MAX_CHILDREN, MAX_DEPTH, MAX_FACES, MAX_LIST};
pub use search::{Located, MAX_EVALUATIONS, MAX_EVALUATIONS_CONVEX};
pub use soft::{Soft, SoftError, SoftStep, SoftWitness};
pub use table::{Body, BodyError, BodyTables};
pub use table_words::TableCursor;
pub use tick_bound::{Effort, MAX_SPOKES, TickLimit, WorstTick};
pub use tracker::{BodyStep, BodyWitness};

pub use crate::tally::TickWork;
