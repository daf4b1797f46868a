//! The list of loops that a tick may have, each with the reason why it ends.

use super::{Lines, Tree};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

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
    /// What is wrong with the file.
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
