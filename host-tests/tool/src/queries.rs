//! Query points from a CSV file.

use anyhow::{Context as _, bail, ensure};
use glam::{DQuat, DVec3};
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
    let per_metre = model.unit.per_metre();
    let rows = columns(path, ["qx", "qy", "qz"], |_| FARTHEST * per_metre)?;
    let query = |(_, given)| {
        let given = DVec3::from_array(given);
        Query { given, probe: (given / per_metre - model.centre).as_vec3() }
    };
    Ok(rows.into_iter().map(query).collect())
}

/// Reads the columns `qw`, `qx`, `qy`, `qz`, a unit quaternion, and `px`, `py`, `pz` in the unit of a model, metres
/// when returned: the poses of a tool in the model's own frame.
///
/// # Errors
/// The first fault, with file and line.
pub fn read_poses(path: &Path, model: &Model) -> anyhow::Result<Vec<(DQuat, DVec3)>> {
    /// The last digits of a printed quaternion.
    const ROUNDED: f64 = 1e-3;
    let per_metre = model.unit.per_metre();
    let names = ["qw", "qx", "qy", "qz", "px", "py", "pz"];
    let rows = columns(path, names, |column| if column < 4 { 1.0 + ROUNDED } else { FARTHEST * per_metre })?;
    let pose = |(line, [w, x, y, z, px, py, pz]): (u64, [f64; 7])| {
        let (turn, length) = (DQuat::from_xyzw(x, y, z, w), DQuat::from_xyzw(x, y, z, w).length());
        let file = path.display();
        ensure!((length - 1.0).abs() <= ROUNDED, "{file}:{line}: qw, qx, qy, qz has length {length}, not 1");
        Ok((turn.normalize(), DVec3::new(px, py, pz) / per_metre))
    };
    rows.into_iter().map(pose).collect()
}

/// The numbers of some columns, with the line of each row. A number is at most `farthest` of its column.
fn columns<const N: usize>(
    path: &Path,
    names: [&str; N],
    farthest: impl Fn(usize) -> f64,
) -> anyhow::Result<Vec<(u64, [f64; N])>> {
    let file = path.display();
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(path)
        .with_context(|| format!("{file}: cannot be read"))?;
    let header = reader.headers().with_context(|| format!("{file}: cannot be read"))?.clone();
    ensure!(!header.is_empty(), "{file}: empty: a header with {} is needed", names.join(", "));
    let mut places = [0; N];
    for (place, name) in places.iter_mut().zip(names) {
        let mut positions = header.iter().enumerate().filter(|(_, field)| *field == name).map(|(index, _)| index);
        *place = positions.next().with_context(|| format!("{file}: {}", missing(name, &header)))?;
        ensure!(positions.next().is_none(), "{file}: column {name} stands twice in the header");
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        // The reader names the line itself.
        let record = record.with_context(|| file.to_string())?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut numbers = [0.0; N];
        for (index, number) in numbers.iter_mut().enumerate() {
            let (name, field) = (names[index], record.get(places[index]).unwrap_or_default());
            *number = field
                .parse::<f64>()
                .ok()
                .with_context(|| format!("{file}:{line}: {name} is \"{field}\", not a number"))?;
            if !number.is_finite() {
                bail!("{file}:{line}: {name} is {number}");
            }
            let most = farthest(index);
            ensure!(number.abs() <= most, "{file}:{line}: {name} is beyond {most:e}");
        }
        rows.push((line, numbers));
    }
    Ok(rows)
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
