//! The loops in a function.

use super::Function;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A loop: instructions each of which can be reached from each other without leaving them.
#[derive(Clone, Debug)]
pub struct Loop {
    /// Where it is entered: in one place mostly; in several, where the compiler took the first round apart; in none,
    /// where nothing leads.
    pub heads: BTreeSet<u64>,
    /// Its instructions.
    pub body: BTreeSet<u64>,
    /// How many loops it is in.
    pub depth: usize,
}

/// Every loop of a function, the outer before the inner. An inner loop is what still goes round when the outer one's
/// head is taken away.
pub fn loops(function: &Function) -> Vec<Loop> {
    let all: BTreeSet<u64> = function.instructions.keys().copied().collect();
    let mut found = Vec::new();
    collect(function, &all, 0, &mut found);
    found
}

fn collect(function: &Function, within: &BTreeSet<u64>, depth: usize, found: &mut Vec<Loop>) {
    let edges: BTreeMap<u64, Vec<u64>> = within
        .iter()
        .map(|address| {
            let (mut next, _) = function.successors(&function.instructions[address]);
            next.retain(|target| within.contains(target));
            (*address, next)
        })
        .collect();
    for body in components(&edges) {
        let alone = body.len() == 1;
        if alone && body.iter().all(|address| !edges[address].contains(address)) {
            continue;
        }
        let outside = function.instructions.values().filter(|instruction| !body.contains(&instruction.address));
        let mut heads: BTreeSet<u64> =
            outside.flat_map(|instruction| function.successors(instruction).0).filter(|to| body.contains(to)).collect();
        if body.contains(&function.address) {
            heads.insert(function.address);
        }
        let inner: BTreeSet<u64> = body.difference(&heads).copied().collect();
        let entered = !heads.is_empty();
        found.push(Loop { heads, body, depth });
        if entered {
            collect(function, &inner, depth + 1, found);
        }
    }
}

/// Strongly connected components, by two passes (Kosaraju).
fn components(edges: &BTreeMap<u64, Vec<u64>>) -> Vec<BTreeSet<u64>> {
    let mut order = Vec::new();
    let mut seen = BTreeSet::new();
    for start in edges.keys() {
        // The second time a node comes up, all behind it is done.
        let mut stack = vec![(*start, false)];
        while let Some((node, done)) = stack.pop() {
            if done {
                order.push(node);
            } else if seen.insert(node) {
                stack.push((node, true));
                stack.extend(edges[&node].iter().map(|next| (*next, false)));
            }
        }
    }
    let mut back: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
    for (from, targets) in edges {
        for to in targets {
            back.entry(*to).or_default().push(*from);
        }
    }
    let mut assigned = BTreeSet::new();
    let mut found = Vec::new();
    for root in order.into_iter().rev() {
        let mut component = BTreeSet::new();
        let mut stack = vec![root];
        while let Some(node) = stack.pop() {
            if assigned.insert(node) {
                component.insert(node);
                stack.extend(back.get(&node).into_iter().flatten());
            }
        }
        if !component.is_empty() {
            found.push(component);
        }
    }
    found
}

// From an address to the source.

/// A line of the source that an instruction came from.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// The file.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: u32,
    /// The function it stands in.
    pub function: String,
}

/// The line tables of an image.
pub struct Lines(addr2line::Loader);

impl Lines {
    /// Of an image.
    ///
    /// # Errors
    /// If there are none.
    pub fn read(path: &Path) -> Result<Self, Box<dyn std::error::Error>> {
        Ok(Self(addr2line::Loader::new(path)?))
    }

    /// The lines an instruction came from, the innermost first: a function that was inlined, then where it was called,
    /// and so on.
    pub fn places(&self, address: u64) -> Vec<Place> {
        let mut places = Vec::new();
        let Ok(mut frames) = self.0.find_frames(address) else { return places };
        while let Ok(Some(frame)) = frames.next() {
            let Some(location) = frame.location else { continue };
            let function = frame.function.and_then(|name| name.raw_name().ok().map(|name| name.into_owned()));
            let function = function.map_or_else(String::new, |name| format!("{:#}", rustc_demangle::demangle(&name)));
            let (Some(file), Some(line)) = (location.file, location.line) else { continue };
            places.push(Place { file: PathBuf::from(file), line, function });
        }
        places
    }

    /// The function of the source that a loop is in: the innermost that its ways back have in common, apart from the
    /// core library's iterators. Empty if that is not known.
    pub fn home(&self, function: &Function, found: &Loop) -> String {
        let goes_back = |address: &&u64| {
            let (next, _) = function.successors(&function.instructions[*address]);
            next.iter().any(|target| found.heads.contains(target))
        };
        let mut chains = found.body.iter().filter(goes_back).map(|address| {
            let mut chain = self.places(*address);
            chain.reverse();
            chain
        });
        let mut common = chains.next().unwrap_or_default();
        for chain in chains {
            let same = common.iter().zip(&chain).take_while(|(one, other)| one.function == other.function).count();
            common.truncate(same);
        }
        while common.last().is_some_and(Place::is_core) {
            common.pop();
        }
        common.pop().map(|place| place.function).unwrap_or_default()
    }
}

impl Place {
    /// Whether it is in the core library.
    pub fn is_core(&self) -> bool {
        self.file.to_string_lossy().contains("/library/core/")
    }
}
