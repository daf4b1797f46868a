//! Tables of bytes in a page: `| at | bytes | field | kind | value |`.

use crate::pages::cells;
use std::fmt::Write as _;

const HEADER: &str = "| at | bytes | field | kind | value |\n|---|---|---|---|---|\n";

/// One field of a record or message.
#[derive(Clone)]
pub struct Row {
    pub bytes: Vec<u8>,
    pub name: String,
    pub kind: String,
    pub value: String,
}

/// The table of a section: the page before it, its rows, and the rest of its section.
pub fn table<'a>(page: &'a str, title: &str) -> (&'a str, Vec<Row>, &'a str, &'a str) {
    let heading = format!("## {title}\n");
    let start = page.find(&heading).unwrap_or_else(|| panic!("the page has no section {title}")) + heading.len();
    let end = page[start..].find("\n## ").map_or(page.len(), |at| start + at);
    let table = start + page[start..end].find(HEADER).unwrap_or_else(|| panic!("section {title} has no table"));
    let rows = &page[table + HEADER.len()..end];
    let rest = rows.find("\n\n").map_or(end, |at| end - rows.len() + at + 1);
    let rows = page[table + HEADER.len()..rest].lines().map(row).collect();
    (&page[..table], rows, &page[rest..end], &page[end..])
}

fn row(line: &str) -> Row {
    let [_, bytes, name, kind, value] = cells(line).and_then(|cells| cells.try_into().ok()).expect("five cells");
    let bytes = bytes.trim_matches('`').split(' ').map(|byte| u8::from_str_radix(byte, 16).expect("hexadecimal"));
    Row { bytes: bytes.collect(), name: name.to_owned(), kind: kind.to_owned(), value: value.to_owned() }
}

/// The table of these rows, the first at the offset `at`.
pub fn written(rows: &[Row], mut at: usize) -> String {
    let mut text = String::from(HEADER);
    for Row { bytes, name, kind, value } in rows {
        let _ = writeln!(text, "| {at} | `{}` | {name} | {kind} | {value} |", hexadecimal(bytes));
        at += bytes.len();
    }
    text
}

pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().join(" ")
}

/// The numbers of a field as the page shows them; none of a kind that is not shown as numbers.
pub fn numbers(kind: &str, mut bytes: &[u8]) -> Option<String> {
    let mut shown = Vec::new();
    while !bytes.is_empty() {
        let (number, rest) = match kind.rsplit(' ').next()? {
            "u8" | "flag" => next::<u8>(bytes),
            "u16" => (u16::from_le_bytes(*bytes.first_chunk()?).to_string(), &bytes[2..]),
            "u32" => (u32::from_le_bytes(*bytes.first_chunk()?).to_string(), &bytes[4..]),
            "f32" => next::<f32>(bytes),
            "f64" => next::<f64>(bytes),
            "var" => next::<u32>(bytes),
            "zig-zag" => next::<i32>(bytes),
            _ => return None,
        };
        shown.push(number);
        bytes = rest;
    }
    Some(shown.join(", "))
}

fn next<'a, T: serde::de::Deserialize<'a> + ToString>(bytes: &'a [u8]) -> (String, &'a [u8]) {
    let (number, rest) = postcard::take_from_bytes::<T>(bytes).expect("a number");
    (number.to_string(), rest)
}
