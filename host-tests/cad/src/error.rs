//! The errors of a part, for the person who made it.

use crate::part::Part;
use std::fmt;
use thiserror::Error;

/// The remedy for edges, vertices and faces that do not meet within the tolerance.
pub(crate) const HEAL: &str =
    "repair the shape in the CAD program, or choose a tolerance above that distance (--tolerance)";
/// The remedy for a face that is too much.
const SPLIT: &str = "split the face in the CAD program and export the part again";

/// Why a part was not imported. Faces and edges go by their names or numbers in the part, entities by their numbers in
/// the file.
#[derive(Debug, Error)]
pub enum ImportError {
    /// The file cannot be opened.
    #[error("cannot read {file}: {cause}")]
    Read {
        /// Which.
        file: String,
        /// Why.
        cause: std::io::Error,
    },
    /// Not a STEP file, or one that is cut off.
    #[error("{file} is not a whole STEP file: {message}")]
    Syntax {
        /// Which.
        file: String,
        /// The reader's message, with line and column.
        message: String,
    },
    /// An entity that the shape needs cannot be read.
    #[error("entity #{id} ({kind}) of {file} cannot be used: {reason}")]
    Entity {
        /// Which file.
        file: String,
        /// Its number.
        id: u64,
        /// Its type.
        kind: String,
        /// Why.
        reason: String,
    },
    /// Not a part's file.
    #[error(
        "{file} has the schema \"{schema}\"; parts of AP203, AP214 and AP242 are imported, with one of these in the name: {known}"
    )]
    Schema {
        /// Which file.
        file: String,
        /// The schema in the file.
        schema: String,
        /// Parts of the names of those that are read.
        known: String,
    },
    /// Nothing to feel.
    #[error(
        "{file} has no solid and no shell (its schema is \"{schema}\"); curves, sketches and triangle meshes are not imported"
    )]
    NoShape {
        /// Which file.
        file: String,
        /// Its schema.
        schema: String,
    },
    /// No solid of the name asked for.
    #[error("{file} has no solid \"{name}\"; it has {known}")]
    NoSolid {
        /// Which file.
        file: String,
        /// The requested name.
        name: String,
        /// The known names.
        known: String,
    },
    /// More than is worth trying.
    #[error("{file} has {count} {what}; {limit} at most are imported")]
    TooMany {
        /// Which file.
        file: String,
        /// How many.
        count: usize,
        /// Of what.
        what: &'static str,
        /// How many can be.
        limit: usize,
    },
    /// The product structure does not end.
    #[error("the assembly of {file} contains itself, or is nested more than {limit} deep, at \"{product}\"")]
    Cycle {
        /// Which file.
        file: String,
        /// Where.
        product: String,
        /// How deep it may be.
        limit: usize,
    },
    /// Something about a face.
    #[error("{face}: {reason}")]
    Face {
        /// Its name.
        face: String,
        /// The reason.
        reason: String,
        /// Its place in the part, where dividing it might help.
        index: Option<usize>,
        /// Whether the whole part takes too many patches, and the face the most of them.
        is_too_many: bool,
    },
}

impl ImportError {
    /// About a face.
    pub fn face(face: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::Face { face: face.into(), reason: reason.into(), index: None, is_too_many: false }
    }

    /// About a face that was too much at once: parts of it may not be.
    pub(crate) fn too_much(part: &Part, index: usize, reason: impl fmt::Display) -> Self {
        let face = part.faces[index].label();
        Self::Face { face, reason: format!("{reason}; {SPLIT}"), index: Some(index), is_too_many: false }
    }

    /// About the face with the most patches of a part that takes too many.
    pub(crate) fn too_many(part: &Part, index: usize, reason: impl Into<String>) -> Self {
        let face = part.faces[index].label();
        Self::Face { face, reason: reason.into(), index: Some(index), is_too_many: true }
    }

    /// Where as much was tried as is worth it; `face` is what the most went into.
    pub(crate) fn given_up(self, face: Option<String>) -> Self {
        match (self, face) {
            (Self::Face { face: last, .. }, Some(hardest)) if hardest != last => {
                let reason = "most of the search went into it, which reached its limit without a division of the part into \
                              quads";
                Self::face(hardest, format!("{reason}; {SPLIT}"))
            }
            (Self::Face { face, reason, .. }, _) => {
                Self::face(face, format!("{reason} (the search reached its limit)"))
            }
            (other, _) => other,
        }
    }
}
