//! The loops in a function.

use super::Function;
use std::collections::{BTreeMap, BTreeSet};

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
