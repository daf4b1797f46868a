//! How a locator is baked, and why it may not be.

use palpate::body::MAX_DEPTH;
use thiserror::Error;

/// How a locator is baked. Lengths are relative to the body's size, the largest side of its bounding box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocatorOptions {
    /// How far the root cube reaches beyond the bounding box on every side.
    pub margin: f64,
    /// Entries of a list at most, unless the depth is used up.
    pub entries: usize,
    /// Depth of the octree.
    pub depth: usize,
    /// How much deeper it may go where a list that is not proved fails for a sampled probe and dividing its rectangles
    /// does not mend it.
    pub deeper: usize,
    /// Probes sampled in each cell whose list is not proved; four times as many where much could be lost.
    pub samples: usize,
    /// A rectangle with several minima is good enough if they differ by no more than this in distance.
    pub tolerance: f64,
    /// Deeper inside, a short list is good enough without a proof.
    pub inside: f64,
    /// Entries of such a list at most.
    pub deep_entries: usize,
    /// Maximum entries of a list where the depth is used up: unproved parts are divided less to stay below, if
    /// possible.
    pub longest: usize,
    /// Whether the body is proved convex: a probe outside then has no nearest point but the closest, so that cells that
    /// are wholly outside need no proof of one minimum.
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
    /// For one patch: it is small beside a device's workspace, and has few faces to list. Firmware holds no lists of
    /// it: more samples cost the host's queries a moment.
    pub fn one_patch() -> Self {
        Self { margin: 1.0, samples: 1024, ..Self::default() }
    }

    /// With a root cube that reaches at least so far beyond the bounding box, in sizes, at the same resolution: each
    /// doubling of its side is a level more. Levels beyond the rounds of the firmware's descent are left out.
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
    /// A weight is not proved positive: nothing that `BakedPatch::new` gives.
    #[error("a weight is not proved to be positive")]
    Weight,
    /// The indices have 16 bits.
    #[error(
        "the locator has {nodes} nodes and {entries} entries, together more than the 65536 that its indices can name; lower its depth"
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
