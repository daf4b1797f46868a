//! What was found to be other than the file had it.

use std::fmt;

/// A sentence: the joint, what, and by how much.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding(pub String);

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

/// Whether a number is off by more than this share of what the file says.
pub(super) fn differs(found: f64, before: f64, share: f64) -> bool {
    (found - before).abs() > share * before.abs()
}
