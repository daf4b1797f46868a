//! The octree that a search leaves behind.

use super::list::Entry;
use super::unique::Minima;
use glam::DVec3;

/// Where a cell lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The surface may pass through it, or it is inside within the depth that counts.
    Near,
    /// All of it is outside.
    Outside,
    /// All of it is deeper inside than `LocatorOptions::inside`.
    Deep,
}

/// A leaf of the octree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub centre: DVec3,
    /// Half of the cell's side, metres.
    pub half: f64,
    pub depth: usize,
    pub kind: Kind,
    /// The worst of its entries.
    pub minima: Minima,
    pub proved: bool,
}

/// The tree: inner nodes in order of depth, leaves with their lists.
pub(super) struct Octree {
    pub nodes: Vec<[Child; 8]>,
    pub leaves: Vec<(Leaf, Vec<Entry>)>,
}

/// A child of a node, by index.
#[derive(Clone, Copy, Debug)]
pub(super) enum Child {
    Node(usize),
    Leaf(usize),
}
