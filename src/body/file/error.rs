//! Why a body's file is refused.

use super::super::table::BodyError;
use crate::patch::TableError;
use core::fmt;
use thiserror::Error;

/// The parts of a file, in the order in which they lie there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// The hash of the model.
    Source,
    /// What there is one of.
    Body,
    /// Span borders.
    Borders,
    /// Coefficients of patches and curves.
    Coefficients,
    /// Faces.
    Faces,
    /// Edges.
    Edges,
    /// Vertices.
    Vertices,
    /// Spokes.
    Spokes,
    /// The locator's nodes.
    Nodes,
    /// The locator's entries.
    Entries,
    /// What a host says of the body to people.
    Notes,
}

impl Section {
    /// All, in their order.
    pub const ALL: [Self; 11] = [
        Self::Source,
        Self::Body,
        Self::Borders,
        Self::Coefficients,
        Self::Faces,
        Self::Edges,
        Self::Vertices,
        Self::Spokes,
        Self::Nodes,
        Self::Entries,
        Self::Notes,
    ];

    /// The four letters it begins with.
    pub const fn letters(self) -> &'static str {
        match self {
            Self::Source => "SOUR",
            Self::Body => "BODY",
            Self::Borders => "BORD",
            Self::Coefficients => "COEF",
            Self::Faces => "FACE",
            Self::Edges => "EDGE",
            Self::Vertices => "VERT",
            Self::Spokes => "SPOK",
            Self::Nodes => "NODE",
            Self::Entries => "ENTR",
            Self::Notes => "NOTE",
        }
    }

    /// The same as a word.
    pub(super) const fn word(self) -> u32 {
        match self.letters().as_bytes().first_chunk() {
            Some(letters) => u32::from_le_bytes(*letters),
            None => 0,
        }
    }
}

impl fmt::Display for Section {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.letters())
    }
}

/// Why a file is refused: the first thing wrong with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum FileError {
    /// The bytes do not begin at a multiple of four: nothing could be read in place.
    #[error("the file must lie at an address that is a multiple of 4")]
    Unaligned,
    /// It does not begin as such a file does.
    #[error("not a body file: it does not start with PALP")]
    Magic,
    /// It is of another version.
    #[error("the file has version {found}, this library reads {wanted}; bake it again")]
    Version {
        /// Its version.
        found: u32,
        /// What this library reads.
        wanted: u32,
    },
    /// There are more or fewer bytes than it says, or so few that there is no file at all.
    #[error("the file states {stated} bytes and has {given}")]
    Length {
        /// What it says.
        stated: u32,
        /// What is there.
        given: u32,
    },
    /// It is not what was written.
    #[error("the file is damaged: its CRC-32 is {found:08x}, stated is {stated:08x}")]
    Damaged {
        /// What it says.
        stated: u32,
        /// What its bytes give.
        found: u32,
    },
    /// A section is missing or out of order, has another length than its records need, or runs past the end.
    #[error("section {section} is not where it should be, or its length does not fit its records or the file")]
    Section {
        /// Which.
        section: Section,
    },
    /// A span border or coefficient is not finite.
    #[error("number {index} of section {section} is not finite")]
    Number {
        /// Borders or coefficients.
        section: Section,
        /// Which number.
        index: u32,
    },
    /// A kind, a flag or a byte that must be 0 has a value that means nothing.
    #[error("record {record} of section {section} has an unknown kind or flag")]
    Code {
        /// Of what.
        section: Section,
        /// Which.
        record: u32,
    },
    /// A record needs borders or coefficients that are not there.
    #[error("record {record} of section {section} needs borders or coefficients that the file does not have")]
    Missing {
        /// Of what.
        section: Section,
        /// Which.
        record: u32,
    },
    /// There are coefficients that no record needs.
    #[error("section COEF has {numbers} unused numbers")]
    LeftOver {
        /// How many.
        numbers: u32,
    },
    /// The room is too small.
    #[error("the file needs memory for {faces} faces and {edges} edges")]
    BufferTooSmall {
        /// Faces.
        faces: u32,
        /// Edges.
        edges: u32,
    },
    /// A patch is not one.
    #[error("face {face}: {error}")]
    Patch {
        /// The face.
        face: u16,
        /// What is wrong with it.
        error: TableError,
    },
    /// The body is not one.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// The numbers are not those that were baked.
    #[error("the CRC-32 of the tables is {found:08x}, and {stated:08x} was baked")]
    Tables {
        /// What was baked.
        stated: u32,
        /// What is there.
        found: u32,
    },
}
