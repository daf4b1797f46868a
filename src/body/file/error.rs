//! Errors in a body's file.

use super::super::table::BodyError;
use crate::patch::TableError;
use core::fmt;
use thiserror::Error;

/// The sections of a file, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Section {
    /// The hash of the model.
    Source,
    /// The numbers of the whole body.
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
    /// The locator's rectangles.
    Rectangles,
    /// The locator's entries.
    Entries,
    /// Notes for people.
    Notes,
}

impl Section {
    /// All sections, in their order.
    pub const ALL: [Self; 12] = [
        Self::Source,
        Self::Body,
        Self::Borders,
        Self::Coefficients,
        Self::Faces,
        Self::Edges,
        Self::Vertices,
        Self::Spokes,
        Self::Nodes,
        Self::Rectangles,
        Self::Entries,
        Self::Notes,
    ];

    /// Its tag: four letters.
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
            Self::Rectangles => "RECT",
            Self::Entries => "ENTR",
            Self::Notes => "NOTE",
        }
    }

    /// The tag as a word.
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

/// The first error in a body's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FileError {
    /// The address of the bytes is not a multiple of 4, so that they cannot be read in place.
    #[error("the file must lie at an address that is a multiple of 4")]
    Unaligned,
    /// The file does not start with `PALP`.
    #[error("not a body file: it does not start with PALP")]
    Magic,
    /// The file has another version.
    #[error("the file has version {found}, this library reads {wanted}; bake it again")]
    Version {
        /// Version of the file.
        found: u32,
        /// Version of this library.
        wanted: u32,
    },
    /// The number of bytes is not that in the head, or too small for a file.
    #[error("the file states {stated} bytes and has {given}")]
    Length {
        /// Stated value.
        stated: u32,
        /// Value found.
        given: u32,
    },
    /// The file's CRC is wrong.
    #[error("the file is damaged: its CRC-32 is {found:08x}, stated is {stated:08x}")]
    Damaged {
        /// Stated value.
        stated: u32,
        /// CRC-32 of its bytes.
        found: u32,
    },
    /// A section is missing or not in its place, has another length than its records need, or runs past the end.
    #[error("section {section} is not in its place, or its length does not fit its records or the file")]
    Section {
        /// Index of the record.
        section: Section,
    },
    /// A span border or coefficient is not finite.
    #[error("number {index} of section {section} is not finite")]
    Number {
        /// Borders or coefficients.
        section: Section,
        /// Index of the number.
        index: u32,
    },
    /// A kind, a flag or a byte that must be 0 has an undefined value.
    #[error("record {record} of section {section} has an unknown kind or flag")]
    Code {
        /// The section.
        section: Section,
        /// Index of the record.
        record: u32,
    },
    /// A record needs borders or coefficients that the file does not have.
    #[error("record {record} of section {section} needs borders or coefficients that the file does not have")]
    Missing {
        /// The section.
        section: Section,
        /// Index of the record.
        record: u32,
    },
    /// No record uses some coefficients.
    #[error("section COEF has {numbers} unused numbers")]
    UnusedCoefficients {
        /// Number of unused coefficients.
        numbers: u32,
    },
    /// The buffer is too small.
    #[error("the file needs memory for {faces} faces and {edges} edges")]
    BufferTooSmall {
        /// Faces.
        faces: u32,
        /// Edges.
        edges: u32,
    },
    /// The table of a patch is wrong.
    #[error("face {face}: {error}")]
    Patch {
        /// The face.
        face: u16,
        /// Error in its table.
        error: TableError,
    },
    /// The tables of the body are wrong.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// A tick may take more evaluations than the application grants.
    #[error("a tick may take {evaluations} evaluations{at}, the limit is {limit}: {remedy}", at = At(.vertex), remedy = REMEDY)]
    Tick {
        /// [`super::super::Body::worst_tick`].
        evaluations: u32,
        /// [`super::super::TickLimit`].
        limit: u32,
        /// The vertex at which it takes them, and the number of its spokes.
        vertex: Option<(u16, u16)>,
    },
    /// A tick may take more cycles than the application grants, even with [`super::super::Effort::ONE`].
    #[error(
        "a tick may take {cycles} modelled cycles, the limit is {limit}: lower the degree of its patches, or raise the limit if the board is fast enough"
    )]
    Cycles {
        /// [`super::super::Body::worst_cycles`].
        cycles: u32,
        /// [`super::super::TickLimit`].
        limit: u32,
    },
    /// The numbers are not those that were baked.
    #[error("the CRC-32 of the tables is {found:08x}, not {stated:08x} as baked")]
    Tables {
        /// CRC-32 when it was baked.
        stated: u32,
        /// Value found.
        found: u32,
    },
}

/// The way to a body with shorter ticks.
const REMEDY: &str = "merge faces that meet there, or raise the limit if the board is fast enough";

/// The vertex of [`FileError::Tick`].
struct At<'a>(&'a Option<(u16, u16)>);

impl fmt::Display for At<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some((vertex, spokes)) => write!(formatter, " at vertex {vertex}, where {spokes} edges end"),
            None => Ok(()),
        }
    }
}
