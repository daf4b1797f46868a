//! Tables of the target from the octree: lists that are equal, or the end of another, are stored once, and so are
//! equal parts of the tree.

use super::list::{Child, Kind, Octree};
use super::options::{LocatorError, LocatorOptions};
use super::packed::PackedLists;
use super::unique::Minima;
use palpate::body::{Locator, MAX_CHILDREN};
use palpate::math::Vec3;
use std::collections::{HashMap, HashSet};
use std::fmt;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// A locator's tables.
#[derive(Clone, Debug, PartialEq)]
pub struct BakedLocator {
    /// The lower corner of the root cube, metres.
    pub corner: Vec3,
    /// Its side, metres.
    pub side: f32,
    /// Inner nodes.
    pub nodes: Vec<[u16; 8]>,
    /// Lists of candidates, each as [`palpate::body::Candidate::pack`] makes it.
    pub entries: Vec<u32>,
    /// The report on them.
    pub report: LocatorReport,
}

/// The sizes and proofs of a locator's tables.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LocatorReport {
    /// Leaves.
    pub leaves: usize,
    /// Entries of all leaves, shared ones counted for each.
    pub listed: usize,
    /// Entries of the longest list.
    pub longest: usize,
    /// Entries of the longest list of a cell that does not lie deeper inside than it needs to be located.
    pub longest_near: usize,
    /// Leaves by the depth of the octree.
    pub by_depth: Vec<usize>,
    /// Share of the root cube's volume with lists of rectangles that have one minimum each.
    pub proved: f64,
    /// Share with some that may have several, within the tolerance of the best.
    pub within: f64,
    /// Share with some that may have several, within a known bound of the best, [`Self::loosest`] at most.
    pub loose: f64,
    /// The maximum of these bounds, metres: the worst-case error of the distance.
    pub loosest: f64,
    /// Share with some of which nothing is proved: only samples speak for them.
    pub sampled: f64,
    /// Share that lies outside a convex body, with rectangles that are not proved by themselves.
    pub convex: f64,
    /// Leaves by the evidence for them.
    pub leaves_by: LeafCounts,
    /// Bytes in flash.
    pub bytes: usize,
}

/// Leaves of the octree by the evidence for their lists. Every list is proved to hold the closest point of every probe
/// of its cell; these count the evidence for the way to it, from the middle of a rectangle to its minimum distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeafCounts {
    /// Every rectangle is proved to have one minimum, or none that loses more than [`LocatorOptions::tolerance`].
    pub proved: usize,
    /// Wholly outside a convex body, where no point that faces the probe is a nearest one but the closest. Sampled as
    /// well.
    pub convex: usize,
    /// Not proved: random probes of the cell found nothing wrong.
    pub sampled: usize,
    /// The same, wholly deeper inside than [`LocatorOptions::inside`].
    pub deep: usize,
}

impl fmt::Display for LocatorReport {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mean = self.listed as f64 / self.leaves as f64;
        write!(
            formatter,
            "{} leaves {:?}, entries a leaf {mean:.2} in the mean, {} at most ({} not deep inside), {} bytes; \
             of the volume {:.3} % proved, {:.3} % within tolerance, {:.3} % within {:.3} mm, {:.3} % sampled, {:.3} % outside of what is convex",
            self.leaves,
            self.by_depth,
            self.longest,
            self.longest_near,
            self.bytes,
            100.0 * self.proved,
            100.0 * self.within,
            100.0 * self.loose,
            1e3 * self.loosest,
            100.0 * self.sampled,
            100.0 * self.convex,
        )
    }
}

impl BakedLocator {
    /// The locator as the firmware has it; its tables stay allocated for good.
    pub fn to_locator(&self) -> Locator<'static> {
        Locator {
            corner: self.corner,
            side: self.side,
            nodes: self.nodes.clone().leak(),
            lists: PackedLists::of(&self.entries).to_lists(),
        }
    }
}

pub(super) fn pack(
    tree: &Octree,
    corner: Vec3,
    side: f32,
    options: &LocatorOptions,
) -> Result<BakedLocator, LocatorError> {
    if let Some((leaf, _)) = tree.leaves.iter().find(|(_, entries)| entries.is_empty()) {
        return Err(LocatorError::Nothing { centre: leaf.centre.to_array() });
    }
    let lists: Vec<Vec<u32>> = tree.leaves.iter().map(|(_, entries)| list(entries)).collect();
    // Long ones first: a short one may be the end of a long one.
    let mut order: Vec<usize> = (0..lists.len()).collect();
    order.sort_by(|a, b| lists[*b].len().cmp(&lists[*a].len()).then(lists[*a].cmp(&lists[*b])));
    let mut entries = Vec::new();
    let mut starts: HashMap<&[u32], usize> = HashMap::new();
    for leaf in order {
        let list = lists[leaf].as_slice();
        if !starts.contains_key(list) {
            for skipped in 0..list.len() {
                starts.entry(&list[skipped..]).or_insert(entries.len() + skipped);
            }
            entries.extend_from_slice(list);
        }
    }
    let nodes = nodes(tree, |leaf| starts[lists[leaf].as_slice()]);
    if nodes.len() + entries.len() > MAX_CHILDREN || entries.len() >= MAX_CHILDREN - 1 {
        return Err(LocatorError::TooLarge { nodes: nodes.len(), entries: entries.len() });
    }
    let code = |child: &Child| match child {
        Child::Node(node) => *node as u16,
        Child::Leaf(start) => (nodes.len() + start) as u16,
    };
    let nodes: Vec<[u16; 8]> = nodes.iter().map(|children| children.each_ref().map(code)).collect();
    let report = report(tree, &nodes, &entries, f64::from(side), options);
    Ok(BakedLocator { corner, side, nodes, entries, report })
}

/// The nodes of a tree, of equal parts only one: each before its children, with the starts of lists for leaves.
fn nodes(tree: &Octree, start: impl Fn(usize) -> usize) -> Vec<[Child; 8]> {
    let mut known: HashMap<[Child; 8], usize> = HashMap::new();
    let mut distinct: Vec<([Child; 8], usize)> = Vec::new();
    let mut of = vec![0; tree.nodes.len()];
    // Children come after their parents there.
    for (node, children) in tree.nodes.iter().enumerate().rev() {
        let own = children.each_ref().map(|child| match child {
            Child::Node(node) => Child::Node(of[*node]),
            Child::Leaf(leaf) => Child::Leaf(start(*leaf)),
        });
        let height = |child: &Child| if let Child::Node(node) = child { distinct[*node].1 + 1 } else { 0 };
        let above = own.iter().map(height).max().unwrap_or(0);
        of[node] = *known.entry(own).or_insert_with(|| {
            distinct.push((own, above));
            distinct.len() - 1
        });
    }
    // By falling height, so that a node shared by several comes after all of them.
    let mut order: Vec<usize> = (0..distinct.len()).rev().collect();
    order.sort_by_key(|node| std::cmp::Reverse(distinct[*node].1));
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(at, node)| place[*node] = at);
    let placed = |child: Child| if let Child::Node(node) = child { Child::Node(place[node]) } else { child };
    order.iter().map(|node| distinct[*node].0.map(placed)).collect()
}

/// How many entries lists take, one that is equal to another or its end none of its own: whatever their order, as many
/// as [`pack`] stores.
#[derive(Default)]
pub(super) struct StoredLists {
    /// Ends of all lists, whole ones included, by their hashes: of two that are taken for one, one is not counted.
    ends: HashSet<u64>,
    /// Lists that are no end of another, with their lengths.
    whole: HashMap<u64, usize>,
    entries: usize,
}

impl StoredLists {
    /// Adds one.
    pub(super) fn add(&mut self, list: &[u32]) {
        let hash = |end: &[u32]| {
            let mut hasher = DefaultHasher::new();
            end.hash(&mut hasher);
            hasher.finish()
        };
        if !self.ends.insert(hash(list)) {
            return;
        }
        self.whole.insert(hash(list), list.len());
        self.entries += list.len();
        for skipped in 1..list.len() {
            let end = hash(&list[skipped..]);
            self.ends.insert(end);
            // One that is stored as the end of this one needs no place of its own.
            self.entries -= self.whole.remove(&end).unwrap_or(0);
        }
    }

    /// Of all that were added.
    pub(super) const fn entries(&self) -> usize {
        self.entries
    }
}

/// The likeliest first, the others in an order that lets lists share their ends.
pub(super) fn list(entries: &[super::list::Entry]) -> Vec<u32> {
    let count = entries.len();
    let mut codes: Vec<u32> = entries.iter().map(|entry| entry.pack(false)).collect();
    if let Some(rest) = codes.get_mut(1..) {
        rest.sort_unstable();
    }
    codes.iter().enumerate().map(|(index, code)| if index + 1 < count { code | MORE } else { *code }).collect()
}

/// The bit of an entry that says that more follow.
const MORE: u32 = 1 << 31;

fn report(tree: &Octree, nodes: &[[u16; 8]], entries: &[u32], side: f64, options: &LocatorOptions) -> LocatorReport {
    let mut report =
        LocatorReport { by_depth: vec![0; options.depth + options.deeper + 1], ..LocatorReport::default() };
    for (leaf, list) in &tree.leaves {
        let share = (2.0 * leaf.half / side) * (2.0 * leaf.half / side) * (2.0 * leaf.half / side);
        report.leaves += 1;
        report.listed += list.len();
        report.longest = report.longest.max(list.len());
        if leaf.kind != Kind::Deep {
            report.longest_near = report.longest_near.max(list.len());
        }
        report.by_depth[leaf.depth] += 1;
        let counts = &mut report.leaves_by;
        let count = match leaf.kind {
            _ if leaf.proved => &mut counts.proved,
            Kind::Outside if options.convex => &mut counts.convex,
            Kind::Deep => &mut counts.deep,
            Kind::Near | Kind::Outside => &mut counts.sampled,
        };
        *count += 1;
        if options.convex && leaf.kind == Kind::Outside {
            // The body's convexity proves what the rectangles do not.
            report.convex += if leaf.proved { 0.0 } else { share };
            report.proved += if leaf.proved { share } else { 0.0 };
            continue;
        }
        match leaf.minima {
            Minima::Convex | Minima::One => report.proved += share,
            Minima::Within(_) if leaf.proved => report.within += share,
            Minima::Within(loss) => {
                report.loose += share;
                report.loosest = report.loosest.max(loss);
            }
            Minima::Unknown => report.sampled += share,
        }
    }
    report.bytes = size_of_val(nodes) + PackedLists::of(entries).bytes();
    report
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Short lists of few numbers, so that many are the ends of others; against what all pairs say.
    #[test]
    fn stored_lists_are_counted_in_any_order() {
        let mut random = Random::new(3);
        let mut number = |below: f64| random.between(0.0, below) as usize;
        for _ in 0..50 {
            let lists: Vec<Vec<u32>> =
                (0..40).map(|_| (0..1 + number(5.0)).map(|_| number(2.0) as u32).collect()).collect();
            let is_end_of = |end: &Vec<u32>, other: &Vec<u32>| other.len() > end.len() && other.ends_with(end);
            let whole: HashSet<&Vec<u32>> =
                lists.iter().filter(|list| !lists.iter().any(|other| is_end_of(list, other))).collect();
            let mut stored = StoredLists::default();
            let mut before = 0;
            for list in &lists {
                stored.add(list);
                // So that what is too much of some lists is too much of all.
                assert!(stored.entries() >= before);
                before = stored.entries();
            }
            assert_eq!(stored.entries(), whole.into_iter().map(Vec::len).sum::<usize>());
        }
    }
}
