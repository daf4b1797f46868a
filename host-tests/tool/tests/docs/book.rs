//! The book: short, complete, and with a section for every fault.

use crate::pages::{BOOK, files, text};
use palpate::servo::Fault;

/// Words of all pages together, without generated blocks.
const MAX_WORDS: usize = 25_000;

/// The words of a page. A generated block runs from a line `<!-- generated: … -->` to `<!-- end -->` or to the next
/// heading.
fn words(page: &str) -> usize {
    let mut is_generated = false;
    let mut count = 0;
    for line in page.lines() {
        // `#include` is no heading.
        let is_heading = line.starts_with('#') && line.trim_start_matches('#').starts_with(' ');
        is_generated = (is_generated && !is_heading) || line.starts_with("<!-- generated");
        if !is_generated {
            count += line.split_whitespace().count();
        }
        is_generated &= !line.starts_with("<!-- end -->");
    }
    count
}

#[test]
fn a_generated_block_is_not_counted() {
    let page = "one two\n<!-- generated: x -->\n\nthree\n#include four\n\n<!-- end -->\nfour\n<!-- generated: y -->\nfive\n## six\n";
    assert_eq!(words(page), 2 + 1 + 2);
}

#[test]
fn the_book_is_short() {
    let pages: Vec<String> = BOOK.iter().flat_map(|folder| files(folder, "md")).collect();
    let count: usize = pages.iter().map(|page| words(&text(page))).sum();
    println!("{count} words in {} pages", pages.len());
    assert!(count <= MAX_WORDS, "docs/ has {count} words without generated blocks, {MAX_WORDS} at most");
}

#[test]
fn the_table_of_contents_has_every_page() {
    let contents = text("docs/SUMMARY.md");
    // The front page of the crate's documentation is no chapter.
    for page in BOOK.iter().flat_map(|folder| files(folder, "md")) {
        let path = page.trim_start_matches("docs/");
        let is_apart = matches!(path, "SUMMARY.md" | "crate.md");
        assert!(is_apart || contents.contains(&format!("]({path})")), "docs/SUMMARY.md does not list {path}");
    }
}

#[test]
fn every_fault_has_a_section() {
    let page = text("docs/troubleshooting.md");
    let written: Vec<&str> = page.lines().filter_map(|line| line.strip_prefix("### ")).collect();
    let wanted: Vec<String> = Fault::ALL.iter().map(|fault| format!("{}: {fault}", fault.code())).collect();
    assert_eq!(written, wanted, "left: docs/troubleshooting.md, right: palpate::servo::Fault");
}
