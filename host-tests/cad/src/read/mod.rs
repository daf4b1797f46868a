//! STEP in: which solids and shells, where they are placed, and their faces.

mod offset;
mod shape;
mod statements;

use crate::error::ImportError;
use crate::part::{Part, Sweep};
use crate::remarks::without_remarks;
use glam::{DAffine3, DMat3, DVec3};
use shape::Gather;
use statements::Numbers;
use std::collections::HashSet;
use std::fs;
use std::path::Path;
use step_io::scene::{ProductDef, Shell, Solid, SurfaceModel, Transform};
use step_io::{EntityKey, StepModel};

/// Assemblies in assemblies.
const DEEPEST: usize = 64;
/// More than a body can have by far; they would be read for minutes and refused in the end.
const MOST_FACES: usize = 20_000;
/// Bytes: a file of some ten million entities.
const LARGEST_FILE: u64 = 1 << 30;

/// Parts of the names of the application protocols whose shapes are read, of all editions: AP203, AP214, AP242.
const SCHEMAS: [&str; 6] =
    ["CONFIG_CONTROL_DESIGN", "CONFIGURATION_CONTROL_3D_DESIGN", "AP203", "AUTOMOTIVE_DESIGN", "AP214", "AP242"];

/// Solids and shells with their placements.
struct Placed<'m> {
    name: String,
    solid: Option<EntityKey>,
    shells: Vec<(Shell<'m>, bool)>,
    placement: DAffine3,
}

/// Reads a part; all its solids, or those of one name.
///
/// # Errors
/// A fault of the file, or a file without solids.
pub fn read(path: &Path, only: Option<&str>, tolerance: f64, sweep: Sweep) -> Result<Part, ImportError> {
    let file = path.display().to_string();
    let cannot = |cause| ImportError::Read { file: file.clone(), cause };
    let length = fs::metadata(path).map_err(cannot)?.len();
    if length > LARGEST_FILE {
        let count = usize::try_from(length).unwrap_or(usize::MAX);
        return Err(ImportError::TooMany { file, count, what: "bytes", limit: LARGEST_FILE as usize });
    }
    let bytes = fs::read(path).map_err(cannot)?;
    let text = String::from_utf8_lossy(&bytes);
    let text = without_remarks(&text);
    let text = statements::with_directions(&text);
    let (text, offsets) = statements::without_offsets(&text);
    // The reader says it does not panic; a part is not worth the tool's life if it does.
    let read = std::panic::catch_unwind(|| step_io::read(text.as_bytes()));
    let (model, report) = match read {
        Ok(Ok(read)) => read,
        Ok(Err(error)) => return Err(ImportError::Syntax { file, message: statements::message(&text, &error) }),
        Err(_) => return Err(ImportError::Syntax { file, message: "the reader gave up".to_owned() }),
    };
    let schema = model.header().schema.raw.join(", ");
    if !SCHEMAS.iter().any(|known| schema.to_ascii_uppercase().contains(known)) {
        let known = SCHEMAS.join(", ");
        return Err(ImportError::Schema { file, schema, known });
    }
    let statements = statements::statements(&text);
    statements::check(&statements, &report, &file)?;
    if let Some(statements::Nonsense { id, kind, reason }) = statements::find(&statements) {
        return Err(ImportError::Entity { file, id, kind, reason });
    }
    let numbers = Numbers::new(&statements, offsets);
    let gathered = std::panic::catch_unwind(|| gather(&model, &file, only, &numbers, tolerance, sweep));
    let mut part = gathered.unwrap_or_else(|_| {
        Err(ImportError::Syntax { file: file.clone(), message: "its entities do not fit together".to_owned() })
    })?;
    let stem = path.file_stem().map_or_else(|| "part".to_owned(), |stem| stem.to_string_lossy().into_owned());
    part.name = stem;
    Ok(part)
}

fn gather(
    model: &StepModel,
    file: &str,
    only: Option<&str>,
    numbers: &Numbers,
    tolerance: f64,
    sweep: Sweep,
) -> Result<Part, ImportError> {
    let scene = model.scene();
    let mut placed = Vec::new();
    for root in scene.root_definitions() {
        walk(&root, DAffine3::IDENTITY, 0, file, numbers, &mut placed)?;
    }
    if placed.is_empty() {
        // Shapes that no product owns.
        for instance in scene.all_mapped_instances() {
            let placement = affine(instance.transform());
            placed.extend(instance.solids().map(|solid| of_solid(&solid, placement, None)));
            placed.extend(instance.surface_models().map(|shells| of_shells(&shells, placement, None)));
        }
    }
    if placed.is_empty() {
        placed.extend(scene.all_solids().map(|solid| of_solid(&solid, DAffine3::IDENTITY, None)));
        placed.extend(scene.all_surface_models().map(|shells| of_shells(&shells, DAffine3::IDENTITY, None)));
    }
    if placed.is_empty() {
        let schema = model.header().schema.raw.join(", ");
        return Err(ImportError::NoShape { file: file.to_owned(), schema });
    }
    let reached: HashSet<_> = placed.iter().filter_map(|shape| shape.solid).collect();
    if let Some(lost) = scene.all_solids().find(|solid| !reached.contains(&solid.key()))
        && only.is_none()
    {
        let reason = format!("no product of the assembly has the solid \"{}\"", lost.name());
        return Err(entity(file, numbers, lost.key(), &reason));
    }
    if let Some(name) = only {
        let mut known: Vec<_> = placed.iter().map(|shape| format!("\"{}\"", shape.name)).collect();
        known.dedup();
        placed.retain(|shape| shape.name == name);
        if placed.is_empty() {
            let known = known.join(", ");
            return Err(ImportError::NoSolid { file: file.to_owned(), name: name.to_owned(), known });
        }
    }
    let count = placed.iter().flat_map(|shape| &shape.shells).map(|(shell, _)| shell.faces().count()).sum();
    if count > MOST_FACES {
        return Err(ImportError::TooMany { file: file.to_owned(), count, what: "faces", limit: MOST_FACES });
    }
    let units = scene.units();
    let mut part = Part { sweep, ..Part::default() };
    let scale = match &units.length {
        Some(unit) if unit.to_si > 0.0 && unit.to_si.is_finite() => unit.to_si * 1e3,
        _ => {
            part.remarks.push("the file gives no unit of length; millimetres are taken".to_owned());
            1.0
        }
    };
    part.precision = units.precision.unwrap_or(0.0) * scale;
    let mut gather = Gather::new(&mut part, scale, numbers, tolerance);
    for shape in &placed {
        gather.begin(&shape.name, shape.solid.is_some(), shape.placement);
        for (index, (shell, turned)) in shape.shells.iter().enumerate() {
            // A solid's first shell is its outer one.
            gather.shell(shell, *turned, shape.solid.is_some() && index > 0)?;
        }
    }
    Ok(part)
}

/// The solids of a product and of all it is made of.
fn walk<'m>(
    product: &ProductDef<'m>,
    placement: DAffine3,
    depth: usize,
    file: &str,
    numbers: &Numbers,
    placed: &mut Vec<Placed<'m>>,
) -> Result<(), ImportError> {
    let name = product.product().map_or_else(String::new, |product| product.name().to_owned());
    if depth > DEEPEST || placed.len() > MOST_FACES {
        return Err(ImportError::Cycle { file: file.to_owned(), product: name, limit: DEEPEST });
    }
    placed.extend(product.solids().map(|solid| of_solid(&solid, placement, Some(&name))));
    placed.extend(product.surface_models().map(|shells| of_shells(&shells, placement, Some(&name))));
    for occurrence in product.occurrences() {
        let Some(child) = occurrence.definition() else { continue };
        let (transform, before) = (occurrence.transform(), placed.len());
        let is_placed = transform.as_ref().is_some_and(|transform| transform.matrix().is_some());
        walk(&child, placement * affine(transform), depth + 1, file, numbers, placed)?;
        if !is_placed && placed.len() > before {
            return Err(entity(file, numbers, occurrence.key(), "the file does not say where this product lies"));
        }
    }
    Ok(())
}

fn of_solid<'m>(solid: &Solid<'m>, placement: DAffine3, product: Option<&str>) -> Placed<'m> {
    let shells = solid.outer().into_iter().chain(solid.voids());
    let shells = shells.map(|(shell, orientation)| (shell, orientation == step_io::Orientation::Reversed)).collect();
    Placed { name: named(solid.name(), product), solid: Some(solid.key()), shells, placement }
}

fn of_shells<'m>(model: &SurfaceModel<'m>, placement: DAffine3, product: Option<&str>) -> Placed<'m> {
    let shells = model.shells().map(|(shell, orientation)| (shell, orientation == step_io::Orientation::Reversed));
    Placed { name: named(model.name(), product), solid: None, shells: shells.collect(), placement }
}

/// About an entity, by its number where that is known.
fn entity(file: &str, numbers: &Numbers, key: EntityKey, reason: &str) -> ImportError {
    let (id, kind) = numbers.of(key).unwrap_or((0, "of a kind without a number"));
    ImportError::Entity { file: file.to_owned(), id, kind: kind.to_owned(), reason: reason.to_owned() }
}

/// The solid's own name, or its product's.
fn named(own: &str, product: Option<&str>) -> String {
    let name = if own.is_empty() || own == "NONE" { product.unwrap_or("") } else { own };
    if name.is_empty() { "solid".to_owned() } else { name.to_owned() }
}

/// A placement in the file's unit of length.
fn affine(transform: Option<Transform>) -> DAffine3 {
    let Some(m) = transform.and_then(|transform| transform.matrix()) else { return DAffine3::IDENTITY };
    let column = |k: usize| DVec3::new(m[0][k], m[1][k], m[2][k]);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}
