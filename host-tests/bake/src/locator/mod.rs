//! The locator's bake: which parts of which faces can own the closest point of a probe, proved cell by cell.
//!
//! # Why it is a proof
//! The closest point of a probe lies inside a face, inside an edge or at a vertex (`Region`); those that several faces
//! share belong to the first of them. A region is left out of a cell's list if for every probe of the cell
//! - some point of the body is nearer than all of it (the difference of two squared distances is affine in the probe),
//!   or
//! - the distance falls in one direction all over it, so that no point of it is even a local minimum: along the face
//!   for its inside, along the edge or into one of its faces for an edge, into one of its faces for a vertex.
//!
//! All bounds are of the stored `f32` coefficients, over boxes of probes and rectangles of parameters, with the
//! rounding of `f64` added (`field`). Faces meet, and poles are points, up to the rounding of the tables: comparisons
//! count only beyond [`LocatorOptions::seam`]. The remaining parts are gathered into rectangles, and `unique` proves
//! that each has one minimum. Where that fails at the maximum depth, the leaf counts as *loose*, with a worst-case
//! error bound, or as *sampled*.

mod faces;
mod list;
mod octree;
mod options;
mod osculating;
mod packed;
mod piece;
mod sampled;
mod stored;
mod tables;
mod territory;
mod unique;

pub use list::Kind;
pub use options::{LocatorError, LocatorOptions};
pub use packed::PackedLists;
pub use stored::{BorderCorner, BorderSide, Seams};
pub use stored::{Minimum, StoredPoint, StoredSurface};
pub use tables::{BakedLocator, LeafCounts, LocatorReport};
pub(crate) use territory::Territory;

use super::BakedPatch;
use faces::Faces;
use glam::DVec3;
use octree::Search;
use piece::Probes;

/// An octree is not made coarser than this to fit its indices.
const LEAST_DEPTH: usize = 3;

/// Bakes the locator of a body. `creases` holds for each face the parameters, along `u` and `v`, at which it is only
/// C⁰. `progress` receives the finished and the total volume, in smallest cells. With `wanted`, only the lists of these
/// probes' cells are valid, and they equal those of the whole tables. The same input gives the same tables on any
/// number of threads. Tables that would not fit their indices are made coarser, until they do.
///
/// # Errors
/// Where the octree is too large for its indices, see [`LocatorError`].
pub fn bake(
    patches: &[BakedPatch],
    seams: Seams,
    creases: &[[Vec<f64>; 2]],
    options: &LocatorOptions,
    wanted: Option<&[DVec3]>,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<BakedLocator, LocatorError> {
    let surfaces: Vec<_> = patches.iter().map(StoredSurface::new).collect();
    let [low, high] = extent(&surfaces);
    let size = (high - low).max_element();
    // The cube as the target has it: f32 corner and side, halves of which are exact.
    let side = (size * (1.0 + 2.0 * options.margin)) as f32;
    let corner = (0.5 * (low + high) - 0.5 * f64::from(side)).as_vec3();
    let root = Probes::cube(corner.as_dvec3() + 0.5 * f64::from(side), 0.5 * f64::from(side));
    let reach = root.centre.abs().max_element() + root.half.x;
    let faces = Faces::new(patches, seams, creases, reach).ok_or(LocatorError::Weight)?;
    // A probe beyond the cube takes the list of the nearest cell.
    let (least, most) = (root.centre - root.half, root.centre + root.half);
    let wanted: Option<Vec<_>> = wanted.map(|probes| probes.iter().map(|probe| probe.clamp(least, most)).collect());
    let mut options = *options;
    loop {
        let (farthest, wanted) = (f64::from(side) * 3.0_f64.sqrt(), wanted.as_deref());
        let search = Search { faces: &faces, options: &options, size, farthest, wanted };
        // What is not even listed to the end has more nodes and entries than this.
        let grown = search.run(root, progress).map_err(|entries| LocatorError::TooLarge { nodes: 0, entries });
        match grown.and_then(|tree| tables::pack(&tree, corner, side, &options)) {
            Err(LocatorError::TooLarge { .. }) if options.depth > LEAST_DEPTH => options.depth -= 1,
            done => return done,
        }
    }
}

/// The bounding box, as two corners, of a grid on every face.
pub fn extent(surfaces: &[StoredSurface]) -> [DVec3; 2] {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for surface in surfaces {
        for index in 0..33 * 33 {
            let point = surface.evaluate([index / 33, index % 33].map(|k| f64::from(k) / 32.0)).point;
            (low, high) = (low.min(point), high.max(point));
        }
    }
    [low, high]
}
