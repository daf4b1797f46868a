//! The octree: cells are divided until their lists are short and proved.
//!
//! First all lists, then samples of those that are not proved: samples take most of the time, and of lists that do not
//! fit the tables' indices none is taken.

use super::faces::Rectangle;
use super::faces::{Faces, Query, Reference, Region};
use super::list::{Child, Kind, Leaf, Octree};
use super::list::{Entry, Lister};
use super::options::LocatorOptions;
use super::piece::{Piece, Probes};
use super::sampled::{self, Fault, Sampler, Sampling};
use super::tables::{StoredLists, list};
use super::unique::{Subject, nearest};
use glam::DVec3;
use palpate::body::{MAX_CHILDREN, MAX_EVALUATIONS, MAX_EVALUATIONS_CONVEX};
use rayon::prelude::*;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// The result of a cell.
enum Outcome<'a> {
    Leaf(Box<Listed<'a>>),
    Inner(Inherited<'a>),
}

/// The inputs that a cell passes to its children.
struct Inherited<'a> {
    /// The regions that can own the closest point.
    regions: Vec<Region<'a>>,
    /// Where half the squared distance is convex.
    convex: Vec<(u16, Rectangle)>,
}

/// A cell whose list is good enough, or is as deep as cells are.
struct Listed<'a> {
    probes: Probes,
    depth: usize,
    kind: Kind,
    entries: Vec<Entry>,
    /// Nothing if the list is proved.
    unproved: Option<Unproved<'a>>,
}

/// The inputs of sampling a list.
struct Unproved<'a> {
    inherited: Inherited<'a>,
    is_loose: bool,
}

/// A cell with all that came of it.
enum Grown<L> {
    Leaf(L),
    Inner(Vec<Grown<L>>),
}

/// A leaf with its list.
type Done = (Leaf, Vec<Entry>);

/// An entry without a proof, and the regions in it that remain.
type Doubt<'a> = (Entry, Vec<Region<'a>>);

/// Maximum divisions of a face's remaining part where the proof fails.
const DIVISIONS: usize = 2;

/// Maximum loss of a rectangle, in sizes, before it is sampled more densely.
const LOOSE: f64 = 0.01;
/// Factor of the denser sampling.
const CLOSER: usize = 4;

/// How often a cell is parted for the proof of its list.
const PARTED: usize = 2;

/// How often a list that samples show to fail is mended by dividing a rectangle.
const REPAIRS: usize = 24;

/// The inputs of a search.
pub(super) struct Search<'a> {
    pub faces: &'a Faces,
    pub options: &'a LocatorOptions,
    /// Metres.
    pub size: f64,
    pub farthest: f64,
    /// If given, only cells that hold one of these probes are searched.
    pub wanted: Option<&'a [DVec3]>,
}

impl<'a> Search<'a> {
    /// Divides the root cube; `progress` gets the finished and the total number: each of the smallest cells once for
    /// its list and once for its samples.
    ///
    /// A cell is finished before its neighbours start: they read the same parts of faces.
    ///
    /// # Errors
    /// The number of entries, as soon as it exceeds the range of indices.
    pub(super) fn run(&self, root: Probes, progress: &(dyn Fn(usize, usize) + Sync)) -> Result<Octree, usize> {
        let done = AtomicUsize::new(0);
        let cells = cells_at(self.options.depth + self.options.deeper);
        let told = |depth: usize| {
            let share = cells / cells_at(depth);
            progress(done.fetch_add(share, Ordering::Relaxed) + share, 2 * cells);
        };
        let stored = Mutex::new(StoredLists::default());
        let keep = |listed: &Listed<'_>| {
            told(listed.depth);
            // A thread that panicked ends the bake.
            let mut stored = stored.lock().unwrap_or_else(PoisonError::into_inner);
            stored.add(&list(&listed.entries));
            stored.entries() < MAX_CHILDREN
        };
        let whole = Inherited { regions: self.faces.regions(), convex: Vec::new() };
        match self.children(&root, &whole, 1, &keep) {
            Some(children) => Ok(flattened(self.sampled(children, &told))),
            None => Err(stored.lock().unwrap_or_else(PoisonError::into_inner).entries()),
        }
    }

    /// The children of a cell, by as many threads as there are; in their order, whatever thread was first. `None` once
    /// `keep` says that they are too many.
    fn children(
        &self,
        parent: &Probes,
        inherited: &Inherited<'a>,
        depth: usize,
        keep: &(dyn Fn(&Listed<'_>) -> bool + Sync),
    ) -> Option<Vec<Grown<Box<Listed<'a>>>>> {
        let half = 0.5 * parent.half;
        let quarter = Probes { centre: parent.centre, half };
        // Points of the body for the corners of all children, which share them.
        let step = |index: usize, axis: usize| (index / 3_usize.pow(axis as u32) % 3) as f64 - 1.0;
        let place =
            |index: usize| parent.centre + parent.half * DVec3::from_array([0, 1, 2].map(|axis| step(index, axis)));
        let lattice: Vec<_> = (0..27).map(|index| self.faces.reference(place(index))).collect();
        let child = |index: usize| {
            let probes = Probes { centre: quarter.corner(index), half };
            let bits = |of: usize| [of & 1, of >> 1 & 1, of >> 2];
            let corner = |corner: usize| {
                let ([a, b, c], [x, y, z]) = (bits(index), bits(corner));
                lattice[a + x + 3 * (b + y) + 9 * (c + z)]
            };
            Some(match self.cell(probes, (0..8).map(corner), inherited, depth) {
                Outcome::Leaf(listed) => Grown::Leaf(keep(&listed).then_some(listed)?),
                Outcome::Inner(left) => Grown::Inner(self.children(&probes, &left, depth + 1, keep)?),
            })
        };
        (0..8).into_par_iter().map(child).collect()
    }

    /// The same cells sampled where nothing is proved; some are divided for it.
    fn sampled(&self, cells: Vec<Grown<Box<Listed<'a>>>>, told: &(dyn Fn(usize) + Sync)) -> Vec<Grown<Done>> {
        let sampled = |cell| match cell {
            Grown::Inner(children) => Grown::Inner(self.sampled(children, told)),
            Grown::Leaf(listed) => {
                let (probes, depth) = (listed.probes, listed.depth);
                match self.sample(*listed) {
                    Ok(done) => {
                        told(depth);
                        Grown::Leaf(done)
                    }
                    Err(left) => {
                        let children = self.children(&probes, &left, depth + 1, &|_| true);
                        Grown::Inner(self.sampled(children.unwrap_or_default(), told))
                    }
                }
            }
        };
        cells.into_par_iter().map(sampled).collect()
    }

    /// Whether anybody asks for a cell; its walls belong to it.
    fn is_wanted(&self, probes: &Probes) -> bool {
        self.wanted.is_none_or(|wanted| wanted.iter().any(|probe| probes.holds(*probe)))
    }

    /// `corners` are points of the body near its corners.
    fn cell(
        &self,
        probes: Probes,
        corners: impl Iterator<Item = Option<Reference>>,
        inherited: &Inherited<'a>,
        depth: usize,
    ) -> Outcome<'a> {
        if !self.is_wanted(&probes) {
            return unwanted(&probes, depth);
        }
        let last = depth >= self.options.depth;
        let centre = std::iter::once_with(|| self.faces.reference(probes.centre));
        let references: Vec<Reference> = centre.chain(corners).flatten().collect();
        let query = Query {
            probes,
            references: &references,
            seam: self.options.seam * self.size,
            farthest: self.farthest,
            convex: &inherited.convex,
            in_plane: true,
        };
        let left = self.survivors(&inherited.regions, &query);
        let kind = self.kind(&left, &query);
        let mut held: Vec<u16> = left.iter().map(|region| region.face(self.faces)).collect();
        held.sort_unstable();
        held.dedup();
        let most = self.options.entries;
        if held.len() > most && !last && kind != Kind::Deep {
            return Outcome::Inner(Inherited { regions: left, convex: inherited.convex.clone() });
        }
        let tolerance = self.options.tolerance * self.size;
        let mut lister =
            Lister { faces: self.faces, query: &query, tolerance, divisions: DIVISIONS, known: RefCell::default() };
        let mut entries = lister.entries(&left);
        let proved = entries.iter().all(|entry| lister.is_proved(entry.minima));
        let is_enough = match kind {
            Kind::Outside if self.options.convex => entries.len() <= most,
            Kind::Deep => entries.len() <= self.options.deep_entries,
            _ => false,
        };
        let is_short = entries.len() <= most && proved;
        if !(last || is_enough || is_short) {
            return Outcome::Inner(Inherited { regions: left, convex: lister.convex() });
        }
        while entries.len() > self.options.longest && lister.divisions > 0 {
            lister.divisions -= 1;
            entries = lister.entries(&left);
        }
        let proved = entries.iter().all(|entry| lister.is_proved(entry.minima));
        if !proved && !self.options.convex {
            lister.add_open_borders(&left, &mut entries);
        }
        let is_loose = entries.iter().any(|entry| !entry.minima.is_proved(LOOSE * self.size));
        let convex = lister.convex();
        let unproved = (!proved).then_some(Unproved { inherited: Inherited { regions: left, convex }, is_loose });
        Outcome::Leaf(Box::new(Listed { probes, depth, kind, entries, unproved }))
    }

    /// A leaf whose list passed all samples, or was mended where it failed, or cannot be divided; else what its
    /// children inherit.
    fn sample(&self, listed: Listed<'a>) -> Result<Done, Inherited<'a>> {
        let Listed { probes, depth, kind, mut entries, unproved } = listed;
        let proved = unproved.is_none();
        if let Some(Unproved { inherited, is_loose }) = unproved {
            // Where much could be lost it is looked for harder.
            let count = self.options.samples * if is_loose && kind != Kind::Deep { CLOSER } else { 1 };
            let evaluations = if self.options.convex { MAX_EVALUATIONS_CONVEX } else { MAX_EVALUATIONS };
            let (proved, size) = (self.options.tolerance * self.size, self.size as f32);
            let sampling = Sampling { count, evaluations, proved, tolerance: (0.2 * proved) as f32, size };
            let in_reach = sampling.reaches(&entries);
            let parts = || self.open_parts(&probes, &entries, &inherited.regions, &inherited.convex);
            let open = if in_reach { parts() } else { None };
            let is_open = open.as_ref().is_none_or(|parts| !parts.is_empty());
            let sampler = || Sampler::new(self.faces, probes, &inherited.regions, &entries, sampling, open);
            let mut sampler = is_open.then(sampler);
            for repair in 1..=REPAIRS {
                let Some(fault) = sampler.as_mut().and_then(|sampler| sampler.fault(&entries)) else { break };
                let is_mended = match fault {
                    Fault::Nearer(point) => repair < REPAIRS && sampled::divide(&mut entries, point),
                    Fault::Spent => false,
                };
                if !is_mended {
                    if depth < self.options.depth + self.options.deeper {
                        return Err(inherited);
                    }
                    break;
                }
            }
        }
        let minima = entries.iter().map(|entry| entry.minima).fold(super::unique::Minima::Convex, |a, b| {
            if a.partial_cmp(&b) == Some(std::cmp::Ordering::Less) { b } else { a }
        });
        let leaf = Leaf { centre: probes.centre, half: probes.half.x, depth, kind, minima, proved };
        Ok((leaf, entries))
    }

    /// The parts of a cell for which a list is not proved: an entry needs no proof for probes whose closest point lies
    /// elsewhere. `None` unless all entries without a proof are of plane faces: on others searches are slow near a
    /// centre of curvature, and few are proved.
    pub(super) fn open_parts(
        &self,
        cell: &Probes,
        entries: &[Entry],
        regions: &[Region<'a>],
        convex: &[(u16, Rectangle)],
    ) -> Option<Vec<Probes>> {
        let tolerance = self.options.tolerance * self.size;
        let unproved = || entries.iter().filter(|entry| !entry.minima.is_proved(tolerance));
        let is_plane = |piece: &Piece| piece.curvature * self.farthest < 1.0;
        if !unproved().all(|entry| self.faces.spans[usize::from(entry.face)].iter().all(is_plane)) {
            return None;
        }
        let doubt = |entry: &Entry| {
            let is_held = |region: &&Region<'a>| {
                let around = || Rectangle::around(region.rectangle(self.faces));
                region.face(self.faces) == entry.face && entry.rectangle.holds(&around())
            };
            (*entry, regions.iter().filter(is_held).copied().collect())
        };
        let doubts: Vec<Doubt<'a>> = unproved().map(doubt).collect();
        let near: Vec<_> = (0..8).filter_map(|corner| self.faces.reference(cell.corner(corner))).collect();
        let mut open = Vec::new();
        self.add_open_parts(cell, &doubts, &near, convex, 1, &mut open);
        Some(open)
    }

    fn add_open_parts(
        &self,
        cell: &Probes,
        doubts: &[Doubt<'a>],
        near: &[Reference],
        convex: &[(u16, Rectangle)],
        depth: usize,
        open: &mut Vec<Probes>,
    ) {
        let half = 0.5 * cell.half;
        let quarter = Probes { centre: cell.centre, half };
        for probes in (0..8).map(|index| Probes { centre: quarter.corner(index), half }) {
            let own = self.faces.reference(probes.centre);
            let references: Vec<_> = own.into_iter().chain(near.iter().copied()).collect();
            let (seam, farthest) = (self.options.seam * self.size, self.farthest);
            let query = Query { probes, references: &references, seam, farthest, convex, in_plane: true };
            let is_open = |(entry, regions): &&Doubt<'a>| {
                let Entry { face, rectangle, .. } = *entry;
                regions.iter().any(|region| self.survives(region, &query))
                    && !Subject { faces: self.faces, face, rectangle, query: &query }.is_unique()
            };
            if depth == PARTED {
                if doubts.iter().any(|doubt| is_open(&doubt)) {
                    open.push(probes);
                }
                continue;
            }
            let left: Vec<Doubt<'a>> = (doubts.iter().filter(is_open))
                .map(|(entry, regions)| {
                    let left = regions.iter().filter(|region| self.survives(region, &query));
                    (*entry, left.copied().collect())
                })
                .collect();
            if !left.is_empty() {
                self.add_open_parts(&probes, &left, &references, convex, depth + 1, open);
            }
        }
    }

    /// Whether some part of a region remains.
    fn survives(&self, region: &Region<'a>, query: &Query<'_>) -> bool {
        if query.excludes(region, self.faces) {
            return false;
        }
        let is_large = region.diameter() > self.options.fineness * query.probes.radius();
        let divided = if is_large { region.divided() } else { None };
        divided.is_none_or(|parts| parts.iter().any(|part| self.survives(part, query)))
    }

    /// The remaining parts of some regions, divided to a depth that suits the cell.
    fn survivors(&self, regions: &[Region<'a>], query: &Query<'_>) -> Vec<Region<'a>> {
        let fine = self.options.fineness * query.probes.radius();
        let mut open: Vec<_> = regions.iter().rev().copied().collect();
        let mut left = Vec::new();
        while let Some(region) = open.pop() {
            if query.excludes(&region, self.faces) {
                continue;
            }
            let divided = if region.diameter() > fine { region.divided() } else { None };
            match divided {
                Some(parts) => open.extend(parts.into_iter().rev()),
                None => left.push(region),
            }
        }
        left
    }

    /// Where the cell lies. Sound for a closed body: its centre's closest point says on which side it is, and no probe
    /// is farther from the centre than the surface is.
    fn kind(&self, left: &[Region<'_>], query: &Query<'_>) -> Kind {
        let Some(reference) = query.references.first() else { return Kind::Near };
        let away = left.iter().map(|region| nearest(region, query, self.faces)).fold(f64::INFINITY, f64::min);
        if away <= 0.0 {
            return Kind::Near;
        }
        let face = usize::from(reference.face);
        let here = self.faces.surfaces[face].evaluate(reference.parameters);
        let normal = here.first[0].cross(here.first[1]) * self.faces.turns[face];
        let height = normal.normalize_or_zero().dot(query.probes.centre - reference.point);
        let border = reference.parameters.iter().any(|x| *x == 0.0 || *x == 1.0);
        if height >= 0.0 {
            Kind::Outside
        } else if away > self.options.inside * self.size && (!border || height < -0.99 * reference.distance) {
            Kind::Deep
        } else {
            Kind::Near
        }
    }
}

/// A cell that is not looked into: any list will do.
fn unwanted<'a>(probes: &Probes, depth: usize) -> Outcome<'a> {
    let minima = super::unique::Minima::Unknown;
    let rectangle = Rectangle::around([[0.0; 2], [1.0; 2]]);
    let entries = vec![Entry { face: 0, rectangle, minima, distance: 0.0 }];
    Outcome::Leaf(Box::new(Listed { probes: *probes, depth, kind: Kind::Deep, entries, unproved: None }))
}

/// How many cells of a depth there are.
fn cells_at(depth: usize) -> usize {
    1 << (3 * depth)
}

/// The tree in order of depth.
fn flattened(root: Vec<Grown<Done>>) -> Octree {
    let mut tree = Octree { nodes: vec![[Child::Leaf(0); 8]], leaves: Vec::new() };
    let mut open = VecDeque::from([(0, root)]);
    while let Some((node, children)) = open.pop_front() {
        for (index, child) in children.into_iter().enumerate() {
            tree.nodes[node][index] = match child {
                Grown::Leaf(done) => {
                    tree.leaves.push(done);
                    Child::Leaf(tree.leaves.len() - 1)
                }
                Grown::Inner(children) => {
                    tree.nodes.push([Child::Leaf(0); 8]);
                    open.push_back((tree.nodes.len() - 1, children));
                    Child::Node(tree.nodes.len() - 1)
                }
            };
        }
    }
    tree
}
