//! The statements of a STEP file as they stand there: numbers, types, fields, references.

use crate::remarks::{pieces, references};
use std::collections::HashMap;

/// The parts of a statement: each a type and its fields, unparsed. All but complex entities have one.
pub(super) type Record<'t> = Vec<(&'t str, &'t str)>;

/// All statements by their numbers.
pub(super) struct Records<'t> {
    by_number: HashMap<u64, Record<'t>>,
}

impl<'t> Records<'t> {
    /// The statements of a text without remarks.
    pub fn new(text: &'t str) -> Self {
        let by_number = pieces(text).filter_map(record).collect();
        Self { by_number }
    }

    pub fn get(&self, id: u64) -> Option<&Record<'t>> {
        self.by_number.get(&id)
    }

    /// The fields of the part of a type.
    pub fn part(&self, id: u64, kind: &str) -> Option<Vec<&'t str>> {
        let of = self.get(id)?.iter().find(|(own, _)| *own == kind)?;
        Some(fields(of.1))
    }

    /// Whether a statement has a part of a type.
    pub fn is(&self, id: u64, kind: &str) -> bool {
        self.get(id).is_some_and(|record| record.iter().any(|(own, _)| *own == kind))
    }

    /// All with a part of a type, in the order of their numbers.
    pub fn all(&self, kind: &str) -> Vec<u64> {
        let mut all: Vec<u64> = self.by_number.keys().copied().filter(|id| self.is(*id, kind)).collect();
        all.sort_unstable();
        all
    }

    /// The statements that a statement refers to, in all its parts.
    pub fn references(&self, id: u64) -> Vec<u64> {
        let parts = self.get(id).map_or(&[][..], Vec::as_slice);
        parts.iter().flat_map(|(_, fields)| references(fields)).collect()
    }
}

fn record(statement: &str) -> Option<(u64, Record<'_>)> {
    let (id, rest) = statement.trim().strip_prefix('#')?.split_once('=')?;
    let rest = rest.trim();
    let mut rest = rest.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(rest);
    let mut parts = Vec::new();
    while let Some(open) = rest.find('(') {
        let kind = rest[..open].trim();
        let length = enclosed(&rest[open..])?;
        parts.push((kind, &rest[open + 1..open + length - 1]));
        rest = &rest[open + length..];
    }
    Some((id.trim().parse().ok()?, parts))
}

/// The length of a text in parentheses, with both.
fn enclosed(text: &str) -> Option<usize> {
    let (mut depth, mut is_name) = (0, false);
    for (at, c) in text.bytes().enumerate() {
        is_name ^= c == b'\'';
        depth += match c {
            b'(' if !is_name => 1,
            b')' if !is_name => -1,
            _ => 0,
        };
        if depth == 0 {
            return Some(at + 1);
        }
    }
    None
}

/// Fields between commas, outside names and lists.
pub(super) fn fields(text: &str) -> Vec<&str> {
    let (mut depth, mut is_name, mut start) = (0, false, 0);
    let mut all = Vec::new();
    for (at, c) in text.bytes().enumerate() {
        is_name ^= c == b'\'';
        match c {
            b'(' if !is_name => depth += 1,
            b')' if !is_name => depth -= 1,
            b',' if !is_name && depth == 0 => {
                all.push(text[start..at].trim());
                start = at + 1;
            }
            _ => (),
        }
    }
    all.push(text[start..].trim());
    all
}

/// The number behind `#`.
pub(super) fn reference(field: &str) -> Option<u64> {
    field.strip_prefix('#')?.trim().parse().ok()
}

/// A number, or that in a typed field such as `LENGTH_MEASURE(25.4)`.
pub(super) fn number(field: &str) -> Option<f64> {
    let inner = field.rsplit_once('(').map_or(field, |(_, inner)| inner.trim_end_matches(')'));
    inner.trim().parse().ok()
}

/// The numbers of a list such as `(1.,2.,3.)`.
pub(super) fn numbers(field: &str) -> Vec<f64> {
    field.trim_matches(['(', ')']).split(',').filter_map(|number| number.trim().parse().ok()).collect()
}
