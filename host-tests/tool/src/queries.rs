//! Query points from a CSV file.

use anyhow::{Context as _, bail, ensure};
use glam::DVec3;
use palpate::math::Vec3;
use palpate_bake::Model;
use std::path::Path;

/// A query point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Query {
    /// As given, in the file's unit.
    pub given: DVec3,
    /// As the firmware gets it, metres, in the frame of the tables.
    pub probe: Vec3,
}

/// Maximum coordinate: its square, the largest number that the controller forms of it, is far below the maximum of
/// `f32`, 3e38.
const FARTHEST: f64 = 1e9;

/// Reads the columns `qx`, `qy`, `qz`, in the unit and the frame of a model. Lines that start with `#` are comments.
///
/// # Errors
/// The first fault, with file and line.
pub fn read(path: &Path, model: &Model) -> anyhow::Result<Vec<Query>> {
    let file = path.display();
    let per_metre = model.unit.per_metre();
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(path)
        .with_context(|| format!("{file}: cannot be read"))?;
    let header = reader.headers().with_context(|| format!("{file}: cannot be read"))?.clone();
    ensure!(!header.is_empty(), "{file}: empty: a header with qx, qy, qz is needed");
    let mut columns = [0; 3];
    for (column, name) in columns.iter_mut().zip(["qx", "qy", "qz"]) {
        let mut positions = header.iter().enumerate().filter(|(_, field)| *field == name).map(|(index, _)| index);
        *column = positions.next().with_context(|| format!("{file}: {}", missing(name, &header)))?;
        ensure!(positions.next().is_none(), "{file}: column {name} stands twice in the header");
    }
    let mut queries = Vec::new();
    for record in reader.records() {
        // The reader names the line itself.
        let record = record.with_context(|| file.to_string())?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut coordinates = [0.0; 3];
        for (coordinate, (column, name)) in coordinates.iter_mut().zip(columns.iter().zip(["qx", "qy", "qz"])) {
            let field = record.get(*column).unwrap_or_default();
            *coordinate = field
                .parse::<f64>()
                .ok()
                .with_context(|| format!("{file}:{line}: {name} is \"{field}\", not a number"))?;
            if !coordinate.is_finite() {
                bail!("{file}:{line}: {name} is {coordinate}");
            }
            ensure!(coordinate.abs() <= FARTHEST * per_metre, "{file}:{line}: {name} is beyond {FARTHEST:e} m");
        }
        let given = DVec3::from_array(coordinates);
        queries.push(Query { given, probe: (given / per_metre - model.centre).as_vec3() });
    }
    Ok(queries)
}

/// Why a column is not there, as far as the header tells.
fn missing(name: &str, header: &csv::StringRecord) -> String {
    let other = [(';', "semicolons"), ('\t', "tabs"), ('|', "bars")];
    let parted = other.iter().find(|(sign, _)| header.iter().any(|field| field.split(*sign).any(|part| part == name)));
    if let Some((_, signs)) = parted {
        return format!(
            "no column {name} in the header: it is parted by {signs}; columns are parted by commas, and decimals have a point"
        );
    }
    match header.iter().find(|field| field.eq_ignore_ascii_case(name)) {
        Some(alike) => format!("no column {name} in the header, only {alike}: names are in small letters"),
        None => format!("no column {name} in the header"),
    }
}
