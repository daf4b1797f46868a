//! One thing that must hold.

/// How it came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It holds.
    Passed,
    /// It does not.
    Failed,
    /// It cannot be told here.
    NotHere,
}

impl Verdict {
    /// Of a condition.
    pub const fn of(holds: bool) -> Self {
        if holds { Self::Passed } else { Self::Failed }
    }

    /// Its word.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed => "FAILED",
            Self::NotHere => "not here",
        }
    }
}

/// A figure, and what it must be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Check {
    /// Its name.
    pub name: &'static str,
    /// What was found.
    pub found: String,
    /// What it must be.
    pub must: String,
    /// How it came out.
    pub verdict: Verdict,
}

impl Check {
    /// A figure that was found.
    pub fn new(name: &'static str, found: String, must: impl Into<String>, holds: bool) -> Self {
        Self { name, found, must: must.into(), verdict: Verdict::of(holds) }
    }

    /// One that cannot be told here, and why.
    pub fn not_here(name: &'static str, found: impl Into<String>, must: impl Into<String>) -> Self {
        Self { name, found: found.into(), must: must.into(), verdict: Verdict::NotHere }
    }
}
