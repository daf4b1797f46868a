//! A CAD part as patches: STEP in, palpate's model file out.
//!
//! The way of the data: [`read`] gives faces, loops, edges and vertices as exact NURBS, placed, in millimetres;
//! [`sew`] joins what the file counts as one, [`heal`] takes out seams, [`pinch`] refuses outlines that touch
//! themselves and [`turn`] turns faces that lie the wrong way round; [`trace`] finds where each edge runs in the
//! parameters of its faces, [`circles`] and [`outline`] make every
//! outline close there, and [`wires`] cuts it into pieces; [`divide`] cuts regions into quads without a side that ends
//! on another's middle, or [`split`] makes less of a face first; [`patches`] gives each wire one curve, shared by both
//! its faces, and each quad one polynomial patch ([`fit`], [`strips`], [`proof`]); [`measure`] compares the result with
//! the part, both ways; [`check`] refuses a result that is no solid, and [`reread`] one that the file's text contradicts;
//! [`emit`] writes the model.

mod bezier;
mod check;
mod circles;
mod divide;
mod effort;
mod emit;
mod error;
mod fit;
mod heal;
mod import;
mod measure;
mod mesh;
mod nurbs;
mod outline;
mod part;
mod patches;
mod path;
mod pinch;
mod project;
mod proof;
mod read;
mod remarks;
mod report;
mod reread;
mod sew;
mod spheres;
mod split;
mod strips;
mod trace;
mod turn;
mod wires;

pub use bezier::Bezier;
pub use effort::show_progress;
pub use error::ImportError;
pub use import::{Imported, Options, Patch, import};
