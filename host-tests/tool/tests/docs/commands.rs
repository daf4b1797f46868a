//! `docs/reference/commands.md` lists every command with its options, as the tool's own help has them.

use crate::pages::{blocks, compare, palpate, text};
use std::fmt::Write as _;

const PAGE: &str = "docs/reference/commands.md";
const HEADER: &str = "| option | default | what it does |\n|---|---|---|\n";

/// The commands that the tool has.
fn commands() -> Vec<String> {
    let help = palpate(&["-h"]);
    let list = help.split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("a list of commands");
    let names = list.lines().filter_map(|line| line.split_whitespace().next().map(str::to_owned));
    names.filter(|name| name != "help").collect()
}

/// What stands in brackets after a word of the help, and the text without it.
fn take(text: &str, word: &str) -> (String, Option<String>) {
    let mark = format!("[{word}: ");
    let Some((before, rest)) = text.split_once(&mark) else { return (text.to_owned(), None) };
    let (inside, after) = rest.split_once(']').expect("a closing bracket");
    (format!("{}{after}", before.trim_end()), Some(inside.to_owned()))
}

/// The table of a command's arguments and options.
fn table(command: &str) -> Option<String> {
    let help = palpate(&[command, "-h"]);
    let mut entries: Vec<String> = Vec::new();
    let lines = help.lines().skip_while(|line| !matches!(*line, "Arguments:" | "Options:"));
    for line in lines.filter(|line| line.starts_with("  ")) {
        let begins = !line.starts_with("        ") && line.trim_start().starts_with(['-', '<', '[']);
        match entries.last_mut() {
            Some(last) if !begins => {
                last.push_str("  ");
                last.push_str(line.trim());
            }
            _ => entries.push(line.trim().to_owned()),
        }
    }
    let mut rows = String::new();
    for entry in entries.iter().filter(|entry| !entry.starts_with("-h,")) {
        let (option, meaning) = entry.split_once("  ").unwrap_or((entry, ""));
        let (meaning, default) = take(meaning.trim(), "default");
        let (mut meaning, values) = take(&meaning, "possible values");
        if let Some(values) = values {
            let values: Vec<String> = values.split(", ").map(|value| format!("`{value}`")).collect();
            meaning = format!("{meaning} ({})", values.join(", "));
        }
        let default = default.map(|default| format!("`{default}`")).unwrap_or_default();
        let _ = writeln!(rows, "| `{option}` | {default} | {meaning} |");
    }
    (!rows.is_empty()).then(|| format!("{HEADER}{rows}"))
}

#[test]
fn the_device_file_of_the_page_is_the_one_that_the_tool_writes() {
    const PAGE: &str = "docs/reference/device-format.md";
    let file = tempfile::Builder::new().suffix(".toml").tempfile().expect("a file");
    palpate(&["device", "woodenhaptics-2016", "--out", &file.path().to_string_lossy()]);
    let written = std::fs::read_to_string(file.path()).expect("it was written");
    let first = written.find("name").expect("a name");
    let second = written.match_indices("[[joint]]").nth(1).expect("three joints").0;
    let page = text(PAGE);
    let shown = blocks(&page, "toml")[0];
    compare(PAGE, &page.replace(shown, &written[first..second]));
}

#[test]
fn every_command_and_option_is_listed_as_the_help_has_it() {
    let page = text(PAGE);
    let (head, _) = page.split_once("\n## ").expect("sections");
    let sections: Vec<(&str, &str)> =
        page.split("\n## ").skip(1).map(|section| section.split_once('\n').expect("a title and a text")).collect();
    let commands = commands();
    for command in &commands {
        assert!(sections.iter().any(|(title, _)| title == command), "{PAGE} has no section on `{command}`");
    }
    let mut wanted = head.to_owned();
    for (title, body) in sections {
        assert!(commands.iter().any(|command| command == title), "{PAGE}: there is no command `{title}`");
        let written = body.split(HEADER).next().expect("a text").trim_end();
        let _ = write!(wanted, "\n## {title}\n{written}\n");
        if let Some(table) = table(title) {
            let _ = write!(wanted, "\n{table}");
        }
    }
    compare(PAGE, &wanted);
}
