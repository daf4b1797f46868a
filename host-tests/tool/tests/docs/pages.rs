//! The pages, and the tool whose words they repeat.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The repository.
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A file of the repository.
pub fn text(path: &str) -> String {
    fs::read_to_string(repository().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The folders of the book.
pub const BOOK: [&str; 6] =
    ["docs", "docs/tutorial", "docs/howto", "docs/reference", "docs/explanation", "docs/figures"];

/// Every page, by its path in the repository.
pub fn all() -> Vec<String> {
    let mut pages = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(str::to_owned).to_vec();
    pages.extend(BOOK.iter().flat_map(|folder| files(folder, "md")));
    pages.extend(files("boards", "md"));
    pages.extend(["stm32g4", "pico2", "teensy41"].map(|board| format!("boards/{board}/README.md")));
    pages
}

/// The files of a folder with an extension, by their paths in the repository, in order.
pub fn files(folder: &str, extension: &str) -> Vec<String> {
    let entries = fs::read_dir(repository().join(folder)).unwrap_or_else(|error| panic!("{folder}: {error}"));
    let names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut files: Vec<_> =
        names.filter(|name| name.ends_with(&format!(".{extension}"))).map(|name| format!("{folder}/{name}")).collect();
    files.sort();
    files
}

/// Every Rust source of the repository but what is generated, below a folder.
pub fn sources(folder: &str) -> Vec<String> {
    let mut found = files(folder, "rs");
    for entry in fs::read_dir(repository().join(folder)).expect("the folder is there").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() && name != "target" && !name.starts_with('.') {
            found.extend(sources(&format!("{folder}/{name}")));
        }
    }
    found
}

/// The fenced blocks of a language.
pub fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    page.split(fence.as_str()).skip(1).map(|rest| rest.split("```").next().unwrap_or_default()).collect()
}

/// The cells of a table's row, in order; none of any other line.
pub fn cells(line: &str) -> Option<Vec<&str>> {
    Some(line.strip_prefix("| ")?.strip_suffix('|')?.split(" |").map(str::trim).collect())
}

/// Compares a page with what it should be, or writes it.
pub fn compare(path: &str, wanted: &str) {
    if text(path) == wanted {
        return;
    }
    if env::var_os("PALPATE_WRITE").is_some() {
        fs::write(repository().join(path), wanted).expect("the page can be written");
        return;
    }
    let differs = text(path)
        .lines()
        .zip(wanted.lines())
        .find(|(old, new)| old != new)
        .map(|(old, new)| format!("it says\n  {old}\nand should say\n  {new}"));
    panic!("{path} is older than the code: {}", differs.unwrap_or_else(|| "lines are missing".to_owned()));
}

/// What the tool prints.
pub fn palpate(arguments: &[&str]) -> String {
    let run = Command::new(env!("CARGO_BIN_EXE_palpate")).args(arguments).output().expect("it starts");
    let error = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.code().is_some_and(|code| code < 2), "palpate {}: {error}", arguments.join(" "));
    String::from_utf8(run.stdout).expect("it prints UTF-8")
}
