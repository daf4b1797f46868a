//! The call tree of a function, and its faults.

use super::{Code, Flow, Function, Loop, flow};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use thiserror::Error;

/// Something in a call tree that must not be there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Finding {
    /// The way to a panic: from the root, by name.
    Panic(Vec<String>),
    /// An instruction that stops the program.
    Trap(String, u64),
    /// A computation in double precision, by an instruction or by a routine.
    Double(String, String),
    /// A call through a pointer, or a jump to one.
    Indirect(String, u64),
    /// A branch to an address where no function starts.
    Astray(String, u64),
    /// The way from a function to itself.
    Recursion(Vec<String>),
}

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panic(way) => write!(formatter, "a panic can be reached: {}", way.join(" → ")),
            Self::Trap(function, address) => write!(formatter, "{function} may stop the program at {address:#x}"),
            Self::Double(function, what) => write!(formatter, "{function} computes in double precision: {what}"),
            Self::Indirect(function, address) => {
                write!(formatter, "{function} calls through a pointer at {address:#x}")
            }
            Self::Astray(function, address) => write!(formatter, "{function} branches to {address:#x}, no function"),
            Self::Recursion(way) => write!(formatter, "recursion: {}", way.join(" → ")),
        }
    }
}

/// A function and all that it calls.
#[derive(Debug)]
pub struct Tree<'a> {
    root: &'a Function,
    functions: BTreeMap<u64, &'a Function>,
    calls: BTreeMap<u64, BTreeSet<u64>>,
    findings: Vec<Finding>,
}

/// Whether a function starts or ends a panic.
fn is_panic(name: &str) -> bool {
    let parts =
        ["panic", "unwrap_failed", "expect_failed", "_index_fail", "_order_fail", "_overflow", "rust_begin_unwind"];
    parts.iter().any(|part| name.contains(part))
}

/// Whether a function is one of the compiler's routines for `f64` (Run-time ABI for the Arm Architecture, §4.1.2; the
/// names of GCC's library otherwise).
pub fn is_double_routine(name: &str) -> bool {
    let short = name.rsplit("::").next().unwrap_or(name);
    if let Some(eabi) = short.strip_prefix("__aeabi_") {
        let from_or_to =
            ["d2", "f2d", "i2d", "ui2d", "l2d", "ul2d", "h2d", "cd", "dadd", "dsub", "drsub", "dmul", "ddiv"];
        return from_or_to.iter().any(|start| eabi.starts_with(start)) || eabi.starts_with("dcmp") || eabi == "dneg";
    }
    short.starts_with("__") && short.contains("df")
}

impl<'a> Tree<'a> {
    /// The tree from `root` down.
    pub fn new(code: &'a Code, root: &'a Function) -> Self {
        let mut tree = Self { root, functions: BTreeMap::new(), calls: BTreeMap::new(), findings: Vec::new() };
        let mut open = vec![root];
        while let Some(function) = open.pop() {
            if tree.functions.insert(function.address, function).is_some() {
                continue;
            }
            for instruction in function.instructions.values() {
                let name = || function.name.clone();
                match instruction.flow {
                    Flow::IndirectCall | Flow::IndirectJump => {
                        tree.findings.push(Finding::Indirect(name(), instruction.address));
                    }
                    Flow::Trap => tree.findings.push(Finding::Trap(name(), instruction.address)),
                    _ => {}
                }
                if instruction.double {
                    tree.findings.push(Finding::Double(name(), instruction.text.clone()));
                }
                let (_, Some(callee)) = function.successors(instruction) else { continue };
                match code.at(callee) {
                    Some(callee) => {
                        tree.calls.entry(function.address).or_default().insert(callee.address);
                        open.push(callee);
                    }
                    None => tree.findings.push(Finding::Astray(name(), callee)),
                }
            }
            if is_double_routine(&function.name) {
                tree.findings.push(Finding::Double(root.name.clone(), function.name.clone()));
            }
        }
        tree.look_for_panics();
        tree.look_for_recursion();
        tree
    }

    /// Every function in it.
    pub fn functions(&self) -> impl Iterator<Item = &'a Function> {
        self.functions.values().copied()
    }

    /// The faults found.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// Every loop, with the function it is in.
    pub fn loops(&self) -> Vec<(&'a Function, Loop)> {
        let of = |function: &'a Function| flow::loops(function).into_iter().map(move |found| (function, found));
        self.functions().flat_map(of).collect()
    }

    fn look_for_panics(&mut self) {
        let ways: Vec<Finding> = self
            .functions()
            .filter(|function| is_panic(&function.name))
            .filter_map(|function| self.way(self.root.address, function.address).map(Finding::Panic))
            .collect();
        self.findings.extend(ways);
    }

    fn look_for_recursion(&mut self) {
        let mut found = Vec::new();
        for function in self.functions() {
            for callee in self.calls.get(&function.address).into_iter().flatten() {
                if let Some(way) = self.way(*callee, function.address) {
                    found.push(Finding::Recursion([vec![function.name.clone()], way].concat()));
                }
            }
        }
        self.findings.extend(found);
    }

    /// The shortest way from a function to another, by name, both included.
    fn way(&self, from: u64, to: u64) -> Option<Vec<String>> {
        let mut came_from = BTreeMap::from([(from, from)]);
        let mut open = std::collections::VecDeque::from([from]);
        while let Some(at) = open.pop_front() {
            if at == to {
                let mut way = vec![self.functions.get(&at)?.name.clone()];
                let mut at = at;
                while at != from {
                    at = came_from[&at];
                    way.push(self.functions.get(&at)?.name.clone());
                }
                way.reverse();
                return Some(way);
            }
            for next in self.calls.get(&at).into_iter().flatten() {
                if !came_from.contains_key(next) {
                    came_from.insert(*next, at);
                    open.push_back(*next);
                }
            }
        }
        None
    }
}

// How deep the stack can get.

/// Why there is no bound.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum StackError {
    /// The stack pointer is set to something that is not known from the code.
    #[error("{function} moves the stack pointer by an unknown amount at {address:#x}: {text}")]
    Unknown {
        /// Where.
        function: String,
        /// Where exactly.
        address: u64,
        /// How.
        text: String,
    },
    /// Two ways to one instruction leave different depths.
    #[error("{function} comes to {address:#x} with different depths of stack")]
    Uneven {
        /// Where.
        function: String,
        /// Where exactly.
        address: u64,
    },
    /// A function calls itself, if by way of others.
    #[error("{function} is recursive")]
    Recursive {
        /// Which.
        function: String,
    },
    /// A call through a pointer or to an address without a function.
    #[error("{function} has an unknown call target at {address:#x}")]
    UnknownCall {
        /// Where.
        function: String,
        /// Where exactly.
        address: u64,
    },
}

/// The most bytes of stack that a function takes with all it calls.
///
/// # Errors
/// Why there is no bound.
pub fn deepest(code: &Code, function: &Function) -> Result<i64, StackError> {
    visit(code, function, &mut BTreeMap::new())
}

/// `known` holds what was found; `None` while it is still being looked for.
fn visit(code: &Code, function: &Function, known: &mut BTreeMap<u64, Option<i64>>) -> Result<i64, StackError> {
    let name = || function.name.clone();
    match known.get(&function.address) {
        Some(Some(depth)) => return Ok(*depth),
        Some(None) => return Err(StackError::Recursive { function: name() }),
        None => known.insert(function.address, None),
    };
    let mut worst = 0;
    let mut depths = BTreeMap::from([(function.address, 0)]);
    let mut open = vec![function.address];
    while let Some(address) = open.pop() {
        let Some(instruction) = function.instructions.get(&address) else { continue };
        let before = depths[&address];
        let grows = instruction.grows.ok_or_else(|| StackError::Unknown {
            function: name(),
            address,
            text: instruction.text.clone(),
        })?;
        let after = before + grows;
        worst = worst.max(after);
        let unknown = || StackError::UnknownCall { function: name(), address };
        if matches!(instruction.flow, crate::proof::Flow::IndirectCall | crate::proof::Flow::IndirectJump) {
            return Err(unknown());
        }
        let (next, outside) = function.successors(instruction);
        if let Some(callee) = outside {
            let callee = code.at(callee).ok_or_else(unknown)?;
            worst = worst.max(after + visit(code, callee, known)?);
        }
        // A return that was not taken has taken nothing off.
        let here = if instruction.flow == crate::proof::Flow::MaybeReturn { before } else { after };
        for target in next {
            match depths.insert(target, here) {
                None => open.push(target),
                Some(depth) if depth == here => {}
                Some(_) => return Err(StackError::Uneven { function: name(), address: target }),
            }
        }
    }
    known.insert(function.address, Some(worst));
    Ok(worst)
}
