//! Entities that could not be read: those that the shape needs are refused by number.

use super::statements::Statement;
use crate::error::ImportError;
use std::collections::HashMap;
use step_io::{DropKind, Report};

/// Types, or parts of types' names, of which no shape can do without one.
const NEEDED: [&str; 22] = [
    "FACE",
    "LOOP",
    "EDGE",
    "VERTEX",
    "CARTESIAN_POINT",
    "DIRECTION",
    "VECTOR",
    "AXIS",
    "LINE",
    "CIRCLE",
    "ELLIPSE",
    "CONIC",
    "CURVE",
    "SURFACE",
    "PLANE",
    "SHELL",
    "BREP",
    "SHAPE_REPRESENTATION",
    "NEXT_ASSEMBLY_USAGE",
    "ITEM_DEFINED_TRANSFORMATION",
    "MAPPED_ITEM",
    "LENGTH_UNIT",
];
/// What bears such a name and is only looks, dimensions or a flat picture of the shape.
const LOOKS: [&str; 10] =
    ["STYLE", "COLOUR", "PCURVE", "DIMENSION", "TOLERANCE", "ANNOTATION", "CALLOUT", "DRAUGHTING", "ASPECT", "CAMERA"];

/// Refuses a file of which the reader dropped what the shape needs.
pub fn check(statements: &[Statement<'_>], report: &Report, file: &str) -> Result<(), ImportError> {
    if report.dropped.is_empty() {
        return Ok(());
    }
    let types: HashMap<u64, &str> = statements.iter().map(|of| (of.id, of.kind.as_str())).collect();
    let name = |id: u64| types.get(&id).map_or_else(|| "of no type".to_owned(), |name| (*name).to_owned());
    let is_needed = |id: u64| {
        let name = name(id);
        NEEDED.iter().any(|needed| name.contains(needed)) && !LOOKS.iter().any(|looks| name.contains(looks))
    };
    let of_the_shape = || report.dropped.iter().filter(|(id, _)| is_needed(*id));
    // The first that is bad by itself says more than those that only refer to it.
    let first = of_the_shape().find(|(_, reason)| reason.kind != DropKind::Cascade).or_else(|| of_the_shape().next());
    let Some((id, reason)) = first else { return Ok(()) };
    let reason = if reason.detail == "via-dangling" {
        "it refers to an entity that the file does not have, or goes round in a circle".to_owned()
    } else {
        reason.to_string()
    };
    Err(ImportError::Entity { file: file.to_owned(), id: *id, kind: name(*id), reason })
}
