//! The model file: TOML, any of three units, one `[[patch]]` a patch.
//!
//! ```toml
//! name = "tile"
//! unit = "mm"                          # m | cm | mm
//! [[patch]]
//! name = "top"
//! degree = [1, 1]                      # along u, along v
//! knots_u = [0, 0, 1, 1]               # optional: without knots a Bézier patch
//! points = [ [[0, 0, 0], [0, 9, 0]], [[9, 0, 0], [9, 9, 1]] ]     # points[i][j] = [x, y, z] or [x, y, z, w]
//! flip = false                         # true: the outward normal is -(f_u × f_v)
//! ```

use super::check::RawPatch;
use super::error::ModelError;
use super::frame;
use super::patch::NurbsPatch;
use super::syntax;
use glam::DVec3;
use serde::Deserialize;
use std::path::Path;

/// What the numbers of a model file are in. Inside the library everything is in metres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Metres.
    Metre,
    /// Centimetres.
    Centimetre,
    /// Millimetres.
    Millimetre,
}

impl Unit {
    /// How many of this unit make a metre. A whole number, so that dividing by it rounds once.
    pub const fn per_metre(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 100.0,
            Self::Millimetre => 1000.0,
        }
    }

    /// Its sign.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
        }
    }
}

/// A model: patches in metres, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Its name.
    pub name: String,
    /// What the file is in; `closest` answers in it.
    pub unit: Unit,
    /// Where the origin of the patches' frame, the tables', lies in the file, metres: zero unless the body lies far
    /// from the file's own origin. A place of the file less this is one of the tables.
    pub centre: DVec3,
    /// Its patches, in metres, in a frame near the body; at least one.
    pub patches: Vec<NurbsPatch>,
}

impl Model {
    /// Reads and checks a model file.
    ///
    /// # Errors
    /// The first thing wrong with it.
    pub fn read(path: &Path) -> Result<Self, ModelError> {
        let file = path.display().to_string();
        match std::fs::read_to_string(path) {
            Ok(text) => Self::parse(&text, &file),
            Err(cause) => Err(ModelError::Read { file, cause }),
        }
    }

    /// Checks the text of a model file; `file` is what messages call it.
    ///
    /// # Errors
    /// The first thing wrong with it.
    pub fn parse(text: &str, file: &str) -> Result<Self, ModelError> {
        let file = || file.to_owned();
        let raw: RawModel = toml::from_str(text)
            .map_err(|error| ModelError::Syntax { file: file(), message: syntax::message(text, &error) })?;
        let unit = match raw.unit.as_str() {
            "m" => Unit::Metre,
            "cm" => Unit::Centimetre,
            "mm" => Unit::Millimetre,
            _ => return Err(ModelError::Unit { file: file(), unit: raw.unit }),
        };
        if raw.patch.is_empty() {
            return Err(ModelError::Empty { file: file() });
        }
        for (second, patch) in raw.patch.iter().enumerate() {
            let Some(name) = &patch.name else { continue };
            if let Some(first) = raw.patch[..second].iter().position(|other| other.name.as_ref() == Some(name)) {
                return Err(ModelError::DuplicateName { file: file(), name: name.clone(), first, second });
            }
        }
        let check = |(index, patch): (usize, RawPatch)| {
            let label = patch.name.as_ref().map_or_else(|| index.to_string(), |name| format!("\"{name}\""));
            patch.check(unit.per_metre()).map_err(|fault| ModelError::Patch { file: file(), patch: label, fault })
        };
        let mut patches: Vec<_> = raw.patch.into_iter().enumerate().map(check).collect::<Result<_, _>>()?;
        let centre = frame::centred(&mut patches, file)?;
        Ok(Self { name: raw.name, unit, centre, patches })
    }

    /// What a patch goes by: its name, or its index if it has none.
    pub fn patch_label(&self, index: usize) -> String {
        self.patches.get(index).and_then(|patch| patch.name.clone()).unwrap_or_else(|| index.to_string())
    }
}

/// The file as it stands.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawModel {
    #[serde(default)]
    name: String,
    unit: String,
    #[serde(default)]
    patch: Vec<RawPatch>,
}
