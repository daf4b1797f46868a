//! What takes how much flash.

use super::{Code, Lines, Place};
use crate::repository;
use std::collections::BTreeMap;

/// Bytes of code by part of the project; each instruction belongs to the innermost function that is not the core
/// library's, whatever it was inlined into. `flash` is what the image takes in all; what is no code is `tables and
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
