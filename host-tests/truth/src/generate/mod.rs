//! Convex patches drawn from a seed: caps of ellipsoids and paraboloids, cylinders, planes and quartic graphs, degrees
//! 1 to 5, polynomial and rational, with skewed and unevenly spread parametrisations.
//!
//! Each is an exact NURBS patch of a surface whose convexity needs no computation, so the closest point to a probe
//! straight out from a point of the patch is that point.

pub mod bodies;
pub mod models;
mod shapes;

pub use palpate_bake::Random;
pub use shapes::fit;
pub use shapes::{ConvexPatch, Kind};
