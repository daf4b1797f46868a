//! The rows of `docs/reference/measured.md`, held to the tests that measure them.
//!
//! A row is `| claim | value | unit | printed by |`. The test that measures the number calls [`measured`] with the
//! row's claim, which prints the number and fails if the page has another one. With `PALPATE_WRITE` set, it updates the
//! page instead.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::{env, fs};

/// Variables that make tests longer than by default: then not every number has a row.
const LENGTHS: [&str; 6] =
    ["PALPATE_PAIRS", "PALPATE_PROBES", "PALPATE_SPOILED", "PALPATE_STARTS", "PALPATE_STEPS", "PALPATE_TICKS"];

/// One writer at a time; test binaries run one after the other.
static WRITING: Mutex<()> = Mutex::new(());

/// A row of the page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// The claim.
    pub claim: String,
    /// The number.
    pub value: String,
    /// Its unit.
    pub unit: String,
    /// The command that prints it.
    pub command: String,
}

impl Row {
    fn parse(line: &str) -> Option<Self> {
        let cells: Vec<&str> = line.strip_prefix('|')?.strip_suffix('|')?.split('|').map(str::trim).collect();
        let [claim, value, unit, command] = cells[..] else { return None };
        let is_row = claim != "claim" && !claim.starts_with('-');
        let [claim, value, unit, command] = [claim, value, unit, command].map(str::to_owned);
        is_row.then_some(Self { claim, value, unit, command })
    }

    fn line(&self) -> String {
        format!("| {} | {} | {} | {} |", self.claim, self.value, self.unit, self.command)
    }
}

/// The page.
pub fn page() -> PathBuf {
    let package =
        std::env::var_os("CARGO_MANIFEST_DIR").expect("cargo runs the tests, and says where their package lies");
    Path::new(&package).join("../../docs/reference/measured.md")
}

/// All rows of the page.
///
/// # Panics
/// If the page is not there.
pub fn rows() -> Vec<Row> {
    fs::read_to_string(page()).expect("docs/reference/measured.md").lines().filter_map(Row::parse).collect()
}

/// Prints a number and holds the page's row to it.
///
/// # Panics
/// If the page says another number, or has no such row.
pub fn measured(claim: &str, value: impl Display) {
    compare(claim, &value.to_string());
}

/// As [`measured`], where only some of what a test finds has a row.
///
/// # Panics
/// If the page says another number.
pub fn measured_if_listed(claim: &str, value: impl Display) {
    if rows().iter().any(|row| row.claim == claim) {
        measured(claim, value);
    }
}

/// Errors as a table has them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The 99th percentile.
    pub most: f64,
    /// The 99.9th percentile.
    pub all_but_a_thousandth: f64,
    /// The maximum.
    pub worst: f64,
}

impl Spread {
    /// Of some numbers; 0 of none.
    pub fn of(mut numbers: Vec<f64>) -> Self {
        numbers.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let index = (share * numbers.len() as f64) as usize;
            numbers.get(index.min(numbers.len().saturating_sub(1))).copied().unwrap_or(0.0)
        };
        Self { median: at(0.5), most: at(0.99), all_but_a_thousandth: at(0.999), worst: at(1.0) }
    }
}

/// Prints a table and holds the one with this header on the page to it; the cells of a row are parted by ` | `.
///
/// # Panics
/// If the page has another table, or none with this header.
pub fn measured_table(header: &str, rows: impl IntoIterator<Item = String>) {
    let line = |cells: &str| format!("| {cells} |\n");
    let rule = format!("|{}\n", "---|".repeat(header.split('|').count()));
    let head = line(header) + &rule;
    let body: String = rows.into_iter().map(|row| line(&row)).collect();
    print!("{head}{body}");
    let _one = WRITING.lock().expect("no writer has failed");
    let text = fs::read_to_string(page()).expect("docs/reference/measured.md");
    let (before, rest) =
        text.split_once(&head).unwrap_or_else(|| panic!("docs/reference/measured.md has no table {header:?}"));
    let after = rest.find("\n\n").map_or("", |end| &rest[end + 1..]);
    let anew = format!("{before}{head}{body}{after}");
    if anew != text {
        assert!(
            env::var_os("PALPATE_WRITE").is_some(),
            "docs/reference/measured.md has another table {header:?} (PALPATE_WRITE=1 with the same command updates it)"
        );
        fs::write(page(), anew).expect("the page can be written");
    }
}

/// A whole number with a comma at each thousand, as the page has them.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let comma = |(index, digit): (usize, char)| {
        let before = index > 0 && (digits.len() - index).is_multiple_of(3);
        before.then_some(',').into_iter().chain([digit])
    };
    digits.chars().enumerate().flat_map(comma).collect()
}

fn compare(claim: &str, found: &str) {
    println!("{claim}: {found}");
    let Some(row) = rows().into_iter().find(|row| row.claim == claim) else {
        let is_longer = LENGTHS.iter().any(|variable| env::var_os(variable).is_some());
        assert!(is_longer, "docs/reference/measured.md has no row {claim:?}; the number is {found}");
        return;
    };
    if row.value == found {
        return;
    }
    assert!(
        env::var_os("PALPATE_WRITE").is_some(),
        "docs/reference/measured.md says {claim}: {}, and it is {found} (PALPATE_WRITE=1 with the same command updates it)",
        row.value
    );
    write(&Row { value: found.to_owned(), ..row });
}

fn write(row: &Row) {
    let _one = WRITING.lock().expect("no writer has failed");
    let text = fs::read_to_string(page()).expect("it was just read");
    let with = |line: &str| match Row::parse(line) {
        Some(old) if old.claim == row.claim => row.line(),
        _ => line.to_owned(),
    };
    let lines: Vec<String> = text.lines().map(with).collect();
    fs::write(page(), lines.join("\n") + "\n").expect("the page can be written");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_read_and_written_as_it_stands() {
        let line = "| rejected steps | 0 | | `cargo test` |";
        let row = Row::parse(line).unwrap();
        assert_eq!((row.claim.as_str(), row.value.as_str(), row.unit.as_str()), ("rejected steps", "0", ""));
        assert_eq!(Row::parse(&row.line()), Some(row));
        for other in ["| claim | value | unit | printed by |", "|---|---|---|---|", "| a | b | c |", "text"] {
            assert_eq!(Row::parse(other), None, "{other}");
        }
    }

    #[test]
    fn thousands_are_grouped() {
        let numbers = [0, 999, 1_000, 264_600, 100_000_000].map(grouped);
        assert_eq!(numbers, ["0", "999", "1,000", "264,600", "100,000,000"]);
    }
}
