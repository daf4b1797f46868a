//! Regions into quads.
//!
//! A region with four corners and as many cuts on opposite sides becomes a grid ([`grid`]); any other is tiled by a
//! search among all quads between its corners and a few points inside ([`tiling`]), behind a ring of quads if need be
//! ([`ring`]). Before that, cuts are handed on
//! from side to side ([`balance`]) and made even in number ([`parity`]).

mod candidates;
pub mod corners;
pub mod parity;
mod plane;
pub mod tiling;

pub use candidates::{Manner, Turning};

use crate::error::ImportError;
use crate::mesh::{Mesh, Quad, Side};
use corners::Shape;

/// Divides every region.
///
/// # Errors
/// All faces that no quads were found for.
pub fn divide(mesh: &mut Mesh<'_>, manner: Manner) -> Result<(), Vec<ImportError>> {
    let mut errors = Vec::new();
    for face in 0..mesh.regions.len() {
        close_triangle(mesh, face);
        let quads = match Shape::of(mesh, face) {
            Shape::Grid(starts) if corners::is_even(&mesh.regions[face].loops[0], starts) => {
                corners::quads(mesh, face, starts)
            }
            _ => None,
        };
        let quads = match quads {
            Some(quads) => quads,
            None => tiled(mesh, face, manner).unwrap_or_else(|error| {
                errors.push(error);
                Vec::new()
            }),
        };
        mesh.regions[face].quads = quads;
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

fn tiled(mesh: &mut Mesh<'_>, face: usize, manner: Manner) -> Result<Vec<Quad>, ImportError> {
    let (effort, label) = (&mesh.part.effort, mesh.part.faces[face].label());
    effort.on(&label, || tiling::quads(mesh, face, manner))
}

/// A region of three sides, or two, gets a side of no length at its sharpest corners.
fn close_triangle(mesh: &mut Mesh<'_>, face: usize) {
    while mesh.regions[face].loops.len() == 1 && (2..4).contains(&mesh.regions[face].loops[0].len()) {
        let all = mesh.regions[face].loops[0].iter().all(|side| side.wire.is_some());
        if all && mesh.regions[face].loops[0].len() == 3 && !corners::is_triangle(mesh, face) {
            return;
        }
        let angles = corners::angles(mesh, face);
        let sides = &mut mesh.regions[face].loops[0];
        let is_pole = |k: usize| sides[k].wire.is_none() || sides[(k + sides.len() - 1) % sides.len()].wire.is_none();
        let corners = (0..sides.len()).filter(|k| !is_pole(*k));
        let Some(sharpest) = corners.min_by(|a, b| angles[*a].total_cmp(&angles[*b])) else { return };
        let (node, uv) = (sides[sharpest].ends[0], sides[sharpest].path.start());
        sides.insert(sharpest, Side::pole(node, uv, uv));
    }
}
