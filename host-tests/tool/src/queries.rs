//! Query points from a CSV file.

use anyhow::{Context as _, bail, ensure};
use glam::{DQuat, DVec3};
use palpate::math::Vec3;
use palpate_bake::Model;
use std::path::Path;

/// A query point.
#[derive(Clone, Debug, PartialEq)]
pub struct Query {
    /// As given, in the file's unit.
    pub given: DVec3,
    /// As the firmware gets it, metres, in the frame of the tables.
    pub probe: Vec3,
    /// `q` of each mode, metres.
    pub q: Vec<f32>,
}

/// Maximum coordinate: its square, the largest number that the controller forms of it, is far below the maximum of
/// `f32`, 3e38.
const FARTHEST: f64 = 1e9;

/// Reads the columns `qx`, `qy`, `qz`, in the unit and the frame of a model, and `q0`, `q1`, … of its modes, metres. Lines
/// that start with `#` are comments.
///
/// # Errors
/// The first fault, with file and line.
pub fn read(path: &Path, model: &Model, modes: usize) -> anyhow::Result<Vec<Query>> {
    let per_metre = model.unit.per_metre();
    let own: Vec<_> = (0..modes).map(|mode| format!("q{mode}")).collect();
    let names: Vec<_> = ["qx", "qy", "qz"].into_iter().chain(own.iter().map(String::as_str)).collect();
    let beyond = format!("q{modes}");
    let beyond = (modes > 0).then_some(beyond.as_str());
    let rows = columns(path, &names, beyond, |column| if column < 3 { FARTHEST * per_metre } else { FARTHEST })?;
    let query = |(_, numbers): (u64, Vec<f64>)| {
        let given = DVec3::from_slice(&numbers);
        let q = numbers[3..].iter().map(|q| *q as f32).collect();
        Query { given, probe: (given / per_metre - model.centre).as_vec3(), q }
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
    let rows = columns(path, &names, None, |column| if column < 4 { 1.0 + ROUNDED } else { FARTHEST * per_metre })?;
    let pose = |(line, numbers): (u64, Vec<f64>)| {
        let [w, x, y, z, px, py, pz] = numbers[..] else { bail!("a pose has seven numbers") };
        let (turn, length) = (DQuat::from_xyzw(x, y, z, w), DQuat::from_xyzw(x, y, z, w).length());
        let file = path.display();
        ensure!(
            (length - 1.0).abs() <= ROUNDED,
            "{file}:{line}: qw, qx, qy, qz has length {length}, not 1; give a unit quaternion"
        );
        Ok((turn.normalize(), DVec3::new(px, py, pz) / per_metre))
    };
    rows.into_iter().map(pose).collect()
}

/// The numbers of some columns, with the line of each row. A number is at most `farthest` of its column; the column
/// `beyond` has no mode.
fn columns(
    path: &Path,
    names: &[&str],
    beyond: Option<&str>,
    farthest: impl Fn(usize) -> f64,
) -> anyhow::Result<Vec<(u64, Vec<f64>)>> {
    let file = path.display();
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(path)
        .with_context(|| format!("{file}: cannot be read"))?;
    let header = reader.headers().with_context(|| format!("{file}: cannot be read"))?.clone();
    ensure!(!header.is_empty(), "{file}: empty: a header with {} is needed", names.join(", "));
    let mut places = Vec::new();
    for name in names {
        let mut positions = header.iter().enumerate().filter(|(_, field)| field == name).map(|(index, _)| index);
        places.push(positions.next().with_context(|| format!("{file}: {}", missing(name, &header)))?);
        ensure!(positions.next().is_none(), "{file}: column {name} stands twice in the header");
    }
    if let Some(name) = header.iter().find(|name| Some(*name) == beyond) {
        bail!("{file}: column {name} has no mode in the modes file: add the mode, or remove the column");
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        // The reader names the line itself.
        let record = record.with_context(|| file.to_string())?;
        let line = record.position().map_or(0, csv::Position::line);
        let mut numbers = vec![0.0; names.len()];
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
