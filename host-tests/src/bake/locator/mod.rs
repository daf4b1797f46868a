//! The locator's bake: which parts of which faces can own the closest point of a probe, proved cell by cell.
//!
//! # Why it is a proof
//! The closest point of a probe lies inside a face, inside an edge or at a vertex ([`Region`](faces::Region)); those that several faces share
//! belong to the first of them. A region is left out of a cell's list if for every probe of the cell
//! - some point of the body is nearer than all of it (the difference of two squared distances is affine in the probe), or
//! - the distance falls in one direction all over it, so that no point of it is even a local minimum: along the face for its inside, along the
//!   edge or into one of its faces for an edge, into one of its faces for a vertex.
//!
//! All bounds are of the stored `f32` coefficients, over boxes of probes and rectangles of parameters, with the rounding of `f64` added
//! ([`field`]). Faces meet, and poles are points, up to the rounding of the tables: comparisons count beyond [`LocatorOptions::seam`] only.
//! What is left is gathered into rectangles, and [`unique`] proves that each has one minimum. Where that fails at the
//! greatest depth the leaf is counted as *loose*, with a bound of what may be lost, or as *sampled*.

mod faces;
pub(in crate::bake) mod field;
mod list;
mod octree;
mod piece;
mod sampled;
mod seams;
mod stored;
mod tables;
mod territory;
mod unique;

pub use seams::{BorderCorner, BorderSide, Seams};
pub use stored::{Minimum, StoredPoint, StoredSurface};
pub use tables::{BakedLocator, LeafCounts, LocatorReport};
pub(in crate::bake) use territory::Territory;

use super::BakedPatch;
use faces::Faces;
use field::Probes;
use glam::DVec3;
use octree::{Octree, Search};
use palpate::body::MAX_DEPTH;
use thiserror::Error;
use unique::Minima;

/// How a locator is baked. Lengths are relative to the body's size, the largest side of its bounding box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocatorOptions {
    /// How far the root cube reaches beyond the bounding box on every side.
    pub margin: f64,
    /// Entries of a list at most, unless the depth is used up.
    pub entries: usize,
    /// Depth of the octree.
    pub depth: usize,
    /// How much deeper it may go where a list that is not proved fails for a sampled probe and dividing its rectangles does not mend it.
    pub deeper: usize,
    /// Probes sampled in each cell whose list is not proved; eight times as many where much could be lost.
    pub samples: usize,
    /// A rectangle with several minima is good enough if they differ by no more than this in distance.
    pub tolerance: f64,
    /// Probes that are deeper inside are located coarsely.
    pub inside: f64,
    /// Entries of such a list at most.
    pub deep_entries: usize,
    /// Entries of a list at most where the depth is used up: what is not proved is divided less to stay below, as far as that goes.
    pub longest: usize,
    /// Whether the body is proved convex: a probe outside then has no nearest point but the closest, so that cells that are wholly
    /// outside need no proof of one minimum.
    pub convex: bool,
    /// How far apart faces that meet, and the points of a pole, may be.
    pub seam: f64,
    /// Parts of faces are divided until they are this small beside the radius of the cell.
    pub fineness: f64,
}

impl Default for LocatorOptions {
    fn default() -> Self {
        Self {
            margin: 0.5,
            entries: 4,
            depth: 5,
            deeper: 1,
            samples: 512,
            tolerance: 1e-4,
            inside: 0.2,
            deep_entries: 6,
            longest: 40,
            convex: false,
            seam: 1e-6,
            fineness: 0.5,
        }
    }
}

impl LocatorOptions {
    /// For one patch: it is small beside a device's workspace, and has few faces to list.
    pub fn one_patch() -> Self {
        Self { margin: 1.0, samples: 64, ..Self::default() }
    }

    /// With a root cube that reaches at least so far beyond the bounding box, in sizes, at the same resolution: each doubling of its
    /// side is a level more. What the firmware's descent has no rounds for stays outside.
    pub fn reaching(mut self, margin: f64) -> Self {
        while self.margin < margin && self.depth + self.deeper < MAX_DEPTH {
            self.margin = 2.0 * self.margin + 0.5;
            self.depth += 1;
        }
        self
    }

    /// For a body that is proved convex: short lists everywhere, so that a cold query is short.
    pub fn convex() -> Self {
        Self { tolerance: 1e-5, longest: 6, convex: true, samples: 256, ..Self::default() }
    }
}

/// Why there is no locator.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LocatorError {
    /// A weight is not proved positive: nothing that [`BakedPatch::new`] gives.
    #[error("a weight is not proved to be positive")]
    Weight,
    /// The indices have 15 bits.
    #[error(
        "the locator has {nodes} nodes and {entries} entries, more than the 32768 that its indices can name; lower its depth"
    )]
    TooLarge {
        /// Inner nodes.
        nodes: usize,
        /// Entries of all lists.
        entries: usize,
    },
    /// A cell without candidates: the seams that were given are not those of the patches.
    #[error("no part of the body is closest to the probes around {centre:?} m: its seams do not fit its patches")]
    Nothing {
        /// The cell's centre, metres.
        centre: [f64; 3],
    },
}

/// Where a cell lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The surface may pass through it, or it is inside within the depth that counts.
    Near,
    /// All of it is outside.
    Outside,
    /// All of it is deeper inside than [`LocatorOptions::inside`].
    Deep,
}

/// A leaf of the octree.
#[derive(Clone, Copy, Debug)]
pub(in crate::bake) struct Leaf {
    pub centre: DVec3,
    /// Half of the cell's side, metres.
    pub half: f64,
    pub depth: usize,
    pub kind: Kind,
    /// The worst of its entries.
    pub minima: Minima,
    pub proved: bool,
}

/// Bakes the locator of a body. `creases` holds for each face the parameters, along `u` and `v`, at which it is only C⁰. `progress`
/// is told the depth that begins and the number of its cells. With `wanted`, only the lists of these probes' cells are good, and they are those of
/// the whole tables. The same input gives the same tables on any number of threads.
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
    let search =
        Search { faces: &faces, options, size, farthest: f64::from(side) * 3.0_f64.sqrt(), wanted: wanted.as_deref() };
    let tree: Octree = search.run(root, progress);
    tables::pack(&tree, corner, side, options)
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
