//! Golden points: CSV files of values computed elsewhere, in double precision. Lengths stay in the files' own unit.

use anyhow::Context as _;
use glam::DVec3;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// A point with both tangents.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct EvaluationRow {
    /// Parameter.
    pub u: f64,
    /// Parameter.
    pub v: f64,
    x: f64,
    y: f64,
    z: f64,
    xu: f64,
    yu: f64,
    zu: f64,
    xv: f64,
    yv: f64,
    zv: f64,
}

impl EvaluationRow {
    /// `f(u, v)`.
    pub fn point(&self) -> DVec3 {
        DVec3::new(self.x, self.y, self.z)
    }

    /// `f_u(u, v)`.
    pub fn tangent_u(&self) -> DVec3 {
        DVec3::new(self.xu, self.yu, self.zu)
    }

    /// `f_v(u, v)`.
    pub fn tangent_v(&self) -> DVec3 {
        DVec3::new(self.xv, self.yv, self.zv)
    }
}

/// A query with the closest point of a patch or body.
#[derive(Clone, Debug, Deserialize)]
pub struct ClosestRow {
    qx: f64,
    qy: f64,
    qz: f64,
    /// The patch, by index, where the file has that column.
    pub patch: Option<String>,
    /// Parameter.
    pub u: f64,
    /// Parameter.
    pub v: f64,
    px: f64,
    py: f64,
    pz: f64,
    /// Distance from the query to the closest point.
    #[serde(rename = "dist")]
    pub distance: f64,
    /// 1 where the query is inside the body, where the file has that column.
    pub inside: Option<u8>,
}

impl ClosestRow {
    /// The query.
    pub fn query(&self) -> DVec3 {
        DVec3::new(self.qx, self.qy, self.qz)
    }

    /// The closest point.
    pub fn point(&self) -> DVec3 {
        DVec3::new(self.px, self.py, self.pz)
    }
}

/// Reads a golden file.
///
/// # Errors
/// Where the file cannot be read or a row is not as expected.
pub fn read<Row: DeserializeOwned>(path: &Path) -> anyhow::Result<Vec<Row>> {
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path)?;
    reader.deserialize().collect::<Result<_, _>>().with_context(|| path.display().to_string())
}
