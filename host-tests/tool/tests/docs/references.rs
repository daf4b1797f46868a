//! What the text refers to is there: sections of the theory, equations, files, and the tests that back a statement.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The top of the repository.
fn top() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().find(|folder| folder.join("src/theory.md").is_file()).unwrap().to_path_buf()
}

/// Every file below a folder, but for what is built or fetched.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            if name != "target" && name != ".git" {
                files(&path, found);
            }
        } else {
            found.push(path);
        }
    }
}

/// All text in which somebody may refer to something, with its path from the top.
struct Text {
    all: Vec<String>,
    read: Vec<(String, String)>,
}

fn text() -> Text {
    let top = top();
    let mut found = Vec::new();
    files(&top, &mut found);
    let all: Vec<_> =
        found.iter().map(|path| path.strip_prefix(&top).unwrap().to_string_lossy().replace('\\', "/")).collect();
    let is_text = |path: &&String| [".rs", ".md", ".toml"].iter().any(|end| path.ends_with(end));
    let read =
        all.iter().filter(is_text).map(|path| (path.clone(), fs::read_to_string(top.join(path)).unwrap())).collect();
    Text { all, read }
}

/// What follows each occurrence of a mark.
fn after<'a>(text: &'a str, mark: &'a str) -> impl Iterator<Item = &'a str> {
    text.match_indices(mark).map(move |(at, _)| &text[at + mark.len()..])
}

/// The number that a text begins with.
fn number(text: &str) -> Option<u32> {
    let digits = text.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(text.len());
    text[..digits].parse().ok()
}

#[test]
fn every_section_and_equation_that_is_cited_stands_in_the_theory() {
    let text = text();
    let (_, theory) = text.read.iter().find(|(path, _)| path == "src/theory.md").unwrap();
    let sections: BTreeSet<_> = theory.lines().filter_map(|line| number(line.strip_prefix("# §")?)).collect();
    let equations: BTreeSet<_> = after(theory, "Eq. (").filter_map(number).collect();
    assert!(sections.len() >= 11 && equations.len() >= 3, "{sections:?} {equations:?}");
    let mut cited = 0;
    for (path, words) in &text.read {
        let marks = ["theory §", "theory.md §"].into_iter().flat_map(|mark| after(words, mark)).filter_map(number);
        // In the theory itself every § is one of its own.
        let own = after(words, "§").filter_map(number).filter(|_| path == "src/theory.md");
        for section in marks.chain(own) {
            assert!(sections.contains(&section), "{path} cites theory §{section}, which is not there");
            cited += 1;
        }
        for equation in after(words, "Eq. (").filter_map(number) {
            assert!(equations.contains(&equation), "{path} cites Eq. ({equation}), of which the theory says nothing");
        }
    }
    assert!(cited >= 8, "only {cited} citations found");
}

/// Letters of a path.
fn is_of_path(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || "/._-".contains(letter)
}

#[test]
fn every_file_that_is_named_is_there() {
    let text = text();
    let mut named = 0;
    let mut missing = Vec::new();
    for (path, words) in &text.read {
        let is_prose = path.ends_with(".md");
        for line in words.lines() {
            // In code only comments refer to files of the repository; a model has its comments too.
            let said = match (is_prose, path.ends_with(".toml")) {
                (true, _) => line,
                (false, true) => line.split_once('#').map_or("", |(_, comment)| comment),
                (false, false) => line.split_once("//").map_or("", |(_, comment)| comment),
            };
            for word in said.split(|letter| !is_of_path(letter)) {
                let word = word.trim_end_matches(['.', '/']);
                let in_folder =
                    ["src/", "boards/", "host-tests/", "docs/", "examples/"].iter().any(|of| word.starts_with(of));
                let file = word.ends_with(".rs") && word.len() > 3 && !word.contains("//");
                if !in_folder && !file {
                    continue;
                }
                named += 1;
                let beside = path.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/{word}"));
                let there = |of: &String| {
                    of == word
                        || *of == beside
                        || of.starts_with(&format!("{word}/"))
                        || of.ends_with(&format!("/{word}"))
                };
                if !text.all.iter().any(there) && !MADE.contains(&word) {
                    missing.push(format!("{path}: {word}"));
                }
            }
        }
    }
    assert!(named > 50, "only {named} files named");
    assert!(missing.is_empty(), "named and not there:\n{}", missing.join("\n"));
}

/// Stand for files that a user makes, or for any.
const MADE: [&str; 11] = [
    "arch.rs",
    "/arch.rs",
    "/wall.rs",
    "origin.rs",
    "FILE.rs",
    "B.rs",
    "D.rs",
    "src/part.rs",
    "/part.rs",
    "x.rs",
    "x/mod.rs",
];

#[test]
fn every_test_that_backs_a_statement_of_the_theory_is_there() {
    let text = text();
    let (_, theory) = text.read.iter().find(|(path, _)| path == "src/theory.md").unwrap();
    let mut named = 0;
    for name in theory.split('`').skip(1).step_by(2) {
        let is_test =
            name.matches('_').count() >= 3 && name.chars().all(|letter| letter.is_ascii_lowercase() || letter == '_');
        if is_test {
            named += 1;
            let function = format!("fn {name}(");
            assert!(text.read.iter().any(|(_, words)| words.contains(&function)), "no test is called {name}");
        }
    }
    assert!(named >= 2, "only {named} tests named");
}
