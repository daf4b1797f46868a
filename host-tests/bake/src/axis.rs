//! Which parameter.

use std::fmt;

/// One of the two parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// `u`, along the rows.
    U,
    /// `v`, along the columns.
    V,
}

impl fmt::Display for Axis {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::U => "u",
            Self::V => "v",
        })
    }
}
