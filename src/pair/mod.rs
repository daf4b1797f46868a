//! A tool with a shape against a body: the closest pair of their points.
//!
//! A [`Tool`] is a convex core and a radius. The witness points of body and core move in one *joint* step of second
//! order, with one certificate: the distance between them is the Lyapunov function of both, and of both automata that
//! switch faces (theory §14). [`Body::locate_tool`] finds the pair without history, [`Body::step_tool`] follows it.
//! [`Proxy`] holds the drawn tool outside the body, in six degrees of freedom, and gives the wrench on the hand.
//!
//! A tick: a joint step for the pair, and for those parts that may be near (the core's corners and edges, the borders of
//! the body's face, the rivals), each followed by the switch to the next face; then the nearest becomes the pair; then,
//! on bodies that are not convex, some cells of the audit.

mod cells;
mod common_normal;
mod contact;
mod coupling;
mod hand_over;
mod location;
mod parts;
mod press;
mod proxy;
mod quadratic;
mod scene;
mod step;
mod surface;
mod tool;
mod tracker;

#[cfg(doc)]
use crate::body::Body;
pub use contact::{MAX_CONTACTS, Manifold, ToolContact};
pub use coupling::ToolCoupling;
pub use proxy::{Proxy, ProxyError};
pub use step::{Foot, Pair};
pub use surface::{HeldTool, ToolSurface};
pub use tool::{Core, Tool, ToolError};
pub use tracker::{Closest, DEFAULT_CELLS, MAX_CELLS, ToolStatus, ToolWitness};
