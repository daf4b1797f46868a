//! The README: short, its output today's, its figures those of `docs/reference/measured.md`.

use crate::pages::{blocks, cells, palpate, text};
use palpate_truth::measured;

/// What a stranger reads before leaving.
const WORDS: usize = 600;

#[test]
fn the_readme_has_at_most_600_words() {
    let words = text("README.md").split_whitespace().count();
    println!("README.md: {words} words");
    assert!(words <= WORDS, "README.md has {words} words, {WORDS} at most");
}

#[test]
fn the_demo_prints_what_the_readme_shows() {
    let folder = tempfile::tempdir().expect("a folder");
    let report = folder.path().join("demo.html").to_string_lossy().into_owned();
    let printed = palpate(&["demo", "--host", "--report", &report]);
    let page = text("README.md");
    let shown = blocks(&page, "text").into_iter().find(|block| block.starts_with("palpate demo")).expect("the output");
    // On the host nothing is counted and there is no image: of the whole output, what does not hang on the compiler.
    let counted = ["instructions", "flash", "RAM,", "report", "…"];
    let rows: Vec<&str> = shown
        .lines()
        .skip(1)
        .filter(|line| !counted.contains(&line.split_whitespace().next().unwrap_or_default()))
        .collect();
    assert!(rows.iter().any(|row| row.contains("state hash")), "{shown}");
    for row in rows {
        assert!(printed.contains(row), "README.md shows\n{row}\nand the demo prints\n{printed}");
    }
}

/// What the README calls each headline figure, and the claim that it is.
const HEADLINES: [[&str; 2]; 6] = [
    ["rejected steps of 2·10⁶ on generated patches", "2,000,000 steps over generated patches: rejected steps"],
    [
        "error of a cold closest point of Table I, worst",
        "cold, 2,000 golden probes of Table I and its companion: maximum error",
    ],
    ["tracking the closest point of a body, worst", "Cortex-M4F: closest point of the capped box, any, worst"],
    ["a whole servo tick, worst", "Cortex-M4F: servo tick, worst"],
    ["flash of the capped box's tables", "flash of the tables of `capped_box`"],
    ["RAM of the loop's whole state", "RAM of the state of a loop of three joints on a body"],
];

#[test]
fn the_headline_figures_are_measured_ones() {
    let measured = measured::rows();
    let page = text("README.md");
    let rows = page.lines().skip_while(|line| !line.starts_with("| figure |")).skip(2).map_while(cells);
    let wanted = HEADLINES.iter().map(|[title, claim]| {
        let row = measured.iter().find(|row| row.claim == *claim);
        let row = row.unwrap_or_else(|| panic!("docs/reference/measured.md has no row {claim:?}"));
        vec![*title, &row.value, &row.unit]
    });
    assert_eq!(
        rows.collect::<Vec<_>>(),
        wanted.collect::<Vec<_>>(),
        "left: README.md, right: docs/reference/measured.md"
    );
}
