//! Proofs about an image from its machine code alone, independent of the compiler's treatment of the source.
//!
//! They read the whole call tree of a function: each instruction, branch and call. Code that cannot be followed (a call
//! through a pointer, a jump into the middle of another function, a stack pointer set from a register) is itself a
//! finding and is never skipped.

mod decode;
mod flow;
mod image;
mod tree;

use crate::repository;
pub use decode::{Flow, Instruction};
pub use flow::Loop;
pub use flow::{Lines, Place};
pub use image::{Code, CodeError, Function};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
pub use tree::{Finding, Tree, is_double_routine};
pub use tree::{StackError, deepest};

// What takes how much flash.

/// Bytes of code by part of the project; each instruction belongs to the innermost function outside the core library,
/// even when inlined. `flash` is the size of the whole image; the bytes that are not code count as `tables and
/// constants`.
pub fn flash_by_part(code: &Code, lines: &Lines, flash: u64) -> Vec<(String, u64)> {
    let mut parts: BTreeMap<String, u64> = BTreeMap::new();
    for function in code.functions() {
        let mut instructions = 0;
        for instruction in function.instructions.values() {
            let place = lines.places(instruction.address).into_iter().find(|place| !place.is_core());
            *parts.entry(place.as_ref().map_or_else(|| "core library".to_owned(), part)).or_default() +=
                instruction.length;
            instructions += instruction.length;
        }
        *parts.entry("literals among code".to_owned()).or_default() += function.size - instructions;
    }
    let code: u64 = parts.values().sum();
    parts.insert("tables and constants".to_owned(), flash.saturating_sub(code));
    let mut parts: Vec<(String, u64)> = parts.into_iter().filter(|(_, bytes)| *bytes > 0).collect();
    parts.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
    parts
}

fn part(place: &Place) -> String {
    if let Some(Ok(file)) = repository::root().ok().map(|root| place.file.strip_prefix(root)) {
        let mut folders = file.components().map(|part| part.as_os_str().to_string_lossy());
        return match (folders.next().as_deref(), folders.next()) {
            (Some("src"), Some(folder)) => folder.trim_end_matches(".rs").to_owned(),
            _ => "board and link".to_owned(),
        };
    }
    let file = place.file.to_string_lossy();
    // A dependency, by the folder of its version.
    let package = file.split_once("/registry/src/").and_then(|(_, rest)| rest.split('/').nth(1));
    match package.and_then(|package| package.rsplit_once('-')) {
        Some((name, _)) => name.to_owned(),
        None => "compiler's routines".to_owned(),
    }
}

// The list of loops that a tick may have, each with the reason why it ends.

/// The loops of one function of the source.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoopEntry {
    /// The function.
    pub function: String,
    /// How many loops it has in an image at most.
    pub loops: usize,
    /// How often each goes round at most, whatever the input.
    pub rounds: u32,
    /// Why.
    pub because: String,
}

/// The list.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoopList {
    /// One entry a function.
    #[serde(rename = "loop")]
    pub entries: Vec<LoopEntry>,
}

impl LoopList {
    /// Reads the list.
    ///
    /// # Errors
    /// An unreadable or malformed file.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        use anyhow::Context;
        let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
        toml::from_str(&text).with_context(|| path.display().to_string())
    }

    /// The loops of a call tree that are not in the list: in which function of the source, and how many.
    pub fn missing(&self, tree: &Tree<'_>, lines: &Lines) -> Vec<String> {
        let mut homes: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
        for (function, found) in tree.loops() {
            *homes.entry(lines.home(function, &found)).or_default().entry(function.name.clone()).or_default() += 1;
        }
        let mut missing = Vec::new();
        for (home, of_functions) in homes {
            let listed = self.entries.iter().find(|entry| entry.function == home).map_or(0, |entry| entry.loops);
            // A function of the source may be inlined in several places: it is the loops of each copy that are counted.
            for (function, count) in of_functions.into_iter().filter(|(_, count)| *count > listed) {
                missing.push(format!("{count} loops of {home:?} in {function}, {listed} are listed"));
            }
        }
        missing
    }
}
