//! No line of a comment is longer than the column limit: rustfmt breaks code, not comments.

use palpate_tool::repository;
use std::fs;
use std::path::Path;
use std::process::Command;

/// As in `rustfmt.toml`.
const MAX_COLUMNS: usize = 120;

/// Lines of comments above the limit. A row of a table cannot be broken, nor a line that is one word.
fn too_long(text: &str) -> Vec<usize> {
    let is_long = |line: &str| {
        let comment = line.trim_start();
        let is_comment = comment.starts_with("//") || comment.starts_with("# ");
        let words = comment.trim_start_matches(['/', '!', '#', ' ']);
        is_comment && line.chars().count() > MAX_COLUMNS && !words.starts_with('|') && words.contains(' ')
    };
    text.lines().enumerate().filter(|(_, line)| is_long(line)).map(|(index, _)| index + 1).collect()
}

#[test]
fn comments_keep_to_the_column_limit() {
    let root = repository::root().expect("tests run in it");
    let listed = Command::new("git").args(["ls-files", "*.rs", "*.toml", ".ci"]).current_dir(&root).output();
    let listed = String::from_utf8(listed.expect("git").stdout).expect("names in UTF-8");
    // What is written by the tool is as long as its numbers, and a model's header is data.
    let is_own = |file: &&str| !file.starts_with("boards/bodies/") && !file.starts_with("host-tests/models/");
    let mut bad = Vec::new();
    for file in listed.lines().filter(is_own) {
        let Ok(text) = fs::read_to_string(Path::new(&root).join(file)) else { continue };
        bad.extend(too_long(&text).into_iter().map(|line| format!("{file}:{line}")));
    }
    assert!(listed.lines().count() > 300, "git lists {} files", listed.lines().count());
    assert!(bad.is_empty(), "{} comments of more than {MAX_COLUMNS} columns:\n{}", bad.len(), bad.join("\n"));
}

#[test]
fn what_is_too_long_is_found() {
    let long = format!("    /// {}", "word ".repeat(30));
    let row = format!("/// | {} |", "word ".repeat(30));
    let link = format!("// {}", "word".repeat(40));
    assert_eq!(too_long(&format!("fn f() {{}}\n{long}\n{row}\n{link}\n")), [2]);
}
