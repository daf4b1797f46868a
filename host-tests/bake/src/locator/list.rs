//! The list of a cell: the remaining parts of the body, in rectangles that have one minimum each.

use super::faces::{Faces, Query, Rectangle, Region};
use super::unique::{Minima, Proof, Subject, nearest};
use glam::DVec3;
use palpate::body::Candidate;
use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};

/// An entry with its proof.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub face: u16,
    pub rectangle: Rectangle,
    pub minima: Minima,
    /// From the cell's centre to the minimum, metres.
    pub distance: f64,
}

impl Entry {
    pub(super) fn pack(&self, more: bool) -> u32 {
        let Rectangle { lower, upper } = self.rectangle;
        Candidate { face: self.face, lower, upper, convex: self.minima == Minima::Convex, more }.pack()
    }
}

/// The maker of lists.
pub(super) struct Lister<'a> {
    pub faces: &'a Faces,
    pub query: &'a Query<'a>,
    /// A rectangle that loses no more is good enough, metres.
    pub tolerance: f64,
    /// Maximum divisions of a face's remaining part where the proof fails.
    pub divisions: usize,
    /// Proofs of rectangles of faces, and the distance of their minimum from the cell's centre: they are needed again.
    pub known: RefCell<HashMap<(u16, Rectangle), (Proof, f64)>>,
}

impl Lister<'_> {
    pub(super) fn is_proved(&self, minima: Minima) -> bool {
        minima.is_proved(self.tolerance)
    }

    /// The entries of the regions that are left, the likeliest first.
    pub(super) fn entries(&self, regions: &[Region<'_>]) -> Vec<Entry> {
        let mut entries = Vec::new();
        for (face, regions) in by_face(regions, self.faces) {
            let whole = self.entry(face, &regions);
            if self.is_proved(whole.minima) {
                entries.push(whole);
                continue;
            }
            for component in components(regions, self.faces) {
                self.divide(face, &component, self.divisions, &mut entries);
            }
        }
        sort(&mut entries);
        entries
    }

    /// Adds the remaining open borders to entries that are not all proved, as entries of their own: a descent that
    /// starts inside a face can end there and miss a minimum at its border, where no other face has a start for it.
    pub(super) fn add_open_borders(&self, regions: &[Region<'_>], entries: &mut Vec<Entry>) {
        let mut borders: BTreeMap<(u16, u8), Vec<Region<'_>>> = BTreeMap::new();
        for region in regions {
            let Some(side) = region.open_side(self.faces) else { continue };
            let face = region.face(self.faces);
            let around = Rectangle::around(region.rectangle(self.faces));
            let is_held = |entry: &Entry| {
                entry.face == face && self.is_proved(entry.minima) && entry.rectangle.hull(&around) == entry.rectangle
            };
            if !entries.iter().any(is_held) {
                borders.entry((face, side)).or_default().push(*region);
            }
        }
        for ((face, _), regions) in borders {
            for component in components(regions, self.faces) {
                self.divide(face, &component, self.divisions, entries);
            }
        }
        sort(entries);
    }

    /// Rectangles of faces that are proved to be convex.
    pub(super) fn convex(&self) -> Vec<(u16, Rectangle)> {
        let known = self.known.borrow();
        let convex = known.iter().filter(|(_, (proof, _))| matches!(proof, Proof::Minima(Minima::Convex)));
        convex.map(|(rectangle, _)| *rectangle).collect()
    }

    fn divide(&self, face: u16, regions: &[Region<'_>], divisions: usize, entries: &mut Vec<Entry>) {
        let whole = self.entry(face, regions);
        if self.is_proved(whole.minima) || divisions == 0 || regions.len() < 2 {
            entries.push(whole);
            return;
        }
        let [low, high] = whole.rectangle.parameters();
        let middle = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
        let tangents = self.faces.surfaces[usize::from(face)].evaluate(middle).first;
        let long = [0, 1].map(|axis| (high[axis] - low[axis]) * tangents[axis].length());
        let axis = usize::from(long[1] > long[0]);
        let is_low = |region: &&Region<'_>| {
            let [low, high] = region.rectangle(self.faces);
            0.5 * (low[axis] + high[axis]) < middle[axis]
        };
        let (lower, upper): (Vec<_>, Vec<_>) = regions.iter().partition(is_low);
        if lower.is_empty() || upper.is_empty() {
            entries.push(whole);
            return;
        }
        self.divide(face, &lower, divisions - 1, entries);
        self.divide(face, &upper, divisions - 1, entries);
    }

    fn entry(&self, face: u16, regions: &[Region<'_>]) -> Entry {
        let rectangles = regions.iter().map(|region| Rectangle::around(region.rectangle(self.faces)));
        let rectangle = rectangles.reduce(|a, b| a.hull(&b)).unwrap_or(Rectangle { lower: [0; 2], upper: [0; 2] });
        let least = regions.iter().map(|region| nearest(region, self.query, self.faces)).fold(f64::INFINITY, f64::min);
        let known = self.known.borrow().get(&(face, rectangle)).copied();
        let (proof, distance) = known.unwrap_or_else(|| self.look(face, rectangle));
        Entry { face, rectangle, minima: proof.minima(least), distance }
    }

    fn look(&self, face: u16, rectangle: Rectangle) -> (Proof, f64) {
        let proof = Subject { faces: self.faces, face, rectangle, query: self.query }.proof();
        let [low, high] = rectangle.parameters();
        let start = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
        let minimum = self.faces.surfaces[usize::from(face)].descend(self.query.probes.centre, start, [low, high]);
        self.known.borrow_mut().insert((face, rectangle), (proof, minimum.distance));
        (proof, minimum.distance)
    }
}

/// The likeliest first.
fn sort(entries: &mut [Entry]) {
    entries.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.pack(false).cmp(&b.pack(false))));
}

/// The regions of each face, by rising index.
fn by_face<'a>(regions: &[Region<'a>], faces: &Faces) -> Vec<(u16, Vec<Region<'a>>)> {
    let mut groups: BTreeMap<u16, Vec<Region<'a>>> = BTreeMap::new();
    for region in regions {
        groups.entry(region.face(faces)).or_default().push(*region);
    }
    groups.into_iter().collect()
}

/// Regions that hang together, in their order.
fn components<'a>(regions: Vec<Region<'a>>, faces: &Faces) -> Vec<Vec<Region<'a>>> {
    let rectangles: Vec<_> = regions.iter().map(|region| region.rectangle(faces)).collect();
    // By rising u: those that begin beyond the end of one touch neither it nor what ends before.
    let mut order: Vec<usize> = (0..regions.len()).collect();
    order.sort_by(|a, b| rectangles[*a][0][0].total_cmp(&rectangles[*b][0][0]));
    // Each leads to an earlier one that it hangs together with, or to itself.
    let mut leads: Vec<usize> = (0..regions.len()).collect();
    for (place, a) in order.iter().enumerate() {
        let [a_low, a_high] = rectangles[*a];
        for b in &order[place + 1..] {
            let [b_low, b_high] = rectangles[*b];
            if b_low[0] > a_high[0] {
                break;
            }
            if a_low[1] <= b_high[1] && b_low[1] <= a_high[1] {
                let [first, second] = [*a, *b].map(|index| first(&mut leads, index));
                leads[first.max(second)] = first.min(second);
            }
        }
    }
    let mut groups: BTreeMap<usize, Vec<Region<'a>>> = BTreeMap::new();
    for (index, region) in regions.into_iter().enumerate() {
        groups.entry(first(&mut leads, index)).or_default().push(region);
    }
    groups.into_values().collect()
}

/// The first that one leads to; the way there gets shorter.
fn first(leads: &mut [usize], mut index: usize) -> usize {
    while leads[index] != index {
        leads[index] = leads[leads[index]];
        index = leads[index];
    }
    index
}

// The octree that a search leaves behind.

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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Child {
    Node(usize),
    Leaf(usize),
}
