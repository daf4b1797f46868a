//! `CONTRIBUTING.md` has every environment variable, and no other.

use crate::pages::{cells, files, sources, text};
use std::collections::BTreeSet;

const MARK: &str = "PALPATE_";

/// The variables that a text names.
fn named(text: &str) -> BTreeSet<String> {
    let tail = |rest: &str| rest.chars().take_while(|letter| letter.is_ascii_uppercase() || *letter == '_').collect();
    let names = text.split(MARK).skip(1).map(tail).filter(|name: &String| !name.is_empty());
    names.map(|name| format!("{MARK}{name}")).collect()
}

#[test]
fn every_environment_variable_is_in_the_table() {
    let rust = ["src", "host-tests", "boards", "examples"].iter().flat_map(|folder| sources(folder));
    let python = files("host-tests/registers", "py");
    let used: BTreeSet<String> = rust.chain(python).flat_map(|file| named(&text(&file))).collect();
    let page = text("CONTRIBUTING.md");
    let listed: BTreeSet<String> = page
        .lines()
        .filter_map(cells)
        .filter_map(|row| Some(row.first()?.trim_matches('`').to_owned()))
        .filter(|first| first.starts_with(MARK))
        .collect();
    assert!(used.len() > 10, "{used:?}");
    assert_eq!(listed, used, "left: the table of CONTRIBUTING.md, right: the sources");
}
