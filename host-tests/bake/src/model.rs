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

use crate::check::RawPatch;
use crate::error::{ModelError, PatchFault};
use crate::patch::{Axis, NurbsPatch, TOLERANCE};
use glam::DVec3;
use serde::Deserialize;
use std::path::Path;

/// Unit of the numbers in a model file. Inside the library everything is in metres.
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
    /// Unit of the file; `closest` answers in it.
    pub unit: Unit,
    /// Origin of the patches' frame, which is the tables' frame, in the file's frame, metres: zero unless the body lies
    /// far from the file's origin. Subtract it from a point of the file to get a point of the tables.
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
        if text.trim_start().starts_with("ISO-10303-21;") {
            return Err(ModelError::Step { file: file() });
        }
        let raw: RawModel = toml::from_str(text)
            .map_err(|error| ModelError::Syntax { file: file(), message: message(text, &error) })?;
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
        let centre = centred(&mut patches, file)?;
        Ok(Self { name: raw.name, unit, centre, patches })
    }

    /// Label of a patch: its name, or its index if it has none.
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

// What a parser of TOML says, with the line wherever there is one to name, and no line of a file in full that fills
// the screen.

/// Letters of a line that are shown.
const SHOWN: usize = 120;

/// The parser's words about a text.
pub(super) fn message(text: &str, error: &toml::de::Error) -> String {
    if error.span().is_none()
        && let Some(line) = deepest_key(text)
    {
        return format!("TOML parse error at line {line}, column 1\nkeys nested too deeply: {}", error.message());
    }
    let clipped = |line: &str| match line.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", line[..end].trim_end()),
        None => line.to_owned(),
    };
    error.to_string().lines().map(clipped).collect::<Vec<_>>().join("\n")
}

/// The line whose key has the most parts: of all that nests, only a key has no place in the parser's error.
fn deepest_key(text: &str) -> Option<usize> {
    let dots = |line: &str| line.split('=').next().map_or(0, |key| key.matches('.').count());
    // The first of those that are alike.
    text.lines().zip(1..).max_by_key(|(line, number)| (dots(line), usize::MAX - number)).map(|(_, number)| number)
}

// The frame of the tables: near the body, wherever that lies in its file.
//
// Single precision knows a coordinate to 6e-8 of itself, so that a body far from its origin would lose digits. Its
// centre is taken off in double precision before anything is rounded, and is kept: what asks in the file's frame takes
// it off too.

/// A body with no coordinate beyond this many of its sizes stays in the frame of its file: the step of `f32` there is
/// at most 1.8e-7 of the size.
const NEAR: f64 = 1.5;

/// Beyond this many sizes the nine digits that an answer in the file's frame has leave 5e-6 of the size, and the file's
/// own digits hardly more.
const FARTHEST: f64 = 1e3;

/// The centre is a multiple of at most this share of the size. It then has a dozen bits: it is exact in `f32`, and
/// taking it off rounds nothing.
const GRAIN: f64 = 0.125;

/// A patch smaller than this share of the body is lost between the steps of `f32`, 3e-8 of it, and the tolerance at
/// which borders are one, 1e-6.
const LEAST_SHARE: f64 = 1e-5;

/// Takes the body's centre off its patches, where it lies far from the origin, and says where it was, metres.
pub(super) fn centred(patches: &mut [NurbsPatch], file: impl Fn() -> String) -> Result<DVec3, ModelError> {
    let points = || patches.iter().flat_map(|patch| &patch.points);
    let low = points().fold(DVec3::INFINITY, |low, point| low.min(*point));
    let high = points().fold(DVec3::NEG_INFINITY, |high, point| high.max(*point));
    let size = (high - low).max_element();
    for (index, patch) in patches.iter().enumerate() {
        if let Err(fault) = check_beside(patch, size) {
            let patch = patch.name.as_ref().map_or_else(|| index.to_string(), |name| format!("\"{name}\""));
            return Err(ModelError::Patch { file: file(), patch, fault });
        }
    }
    let farthest = low.abs().max(high.abs()).max_element();
    if farthest > FARTHEST * size {
        return Err(ModelError::FarAway { file: file(), distance: farthest, size, limit: FARTHEST });
    }
    if farthest <= NEAR * size {
        return Ok(DVec3::ZERO);
    }
    let grain = (GRAIN * size).log2().floor().exp2();
    // The sum makes 0 of -0.
    let centre = (0.5 * (low + high) / grain).round() * grain + DVec3::ZERO;
    patches.iter_mut().flat_map(|patch| &mut patch.points).for_each(|point| *point -= centre);
    Ok(centre)
}

/// Checks that a patch is not negligibly small beside a body of this size.
fn check_beside(patch: &NurbsPatch, body: f64) -> Result<(), PatchFault> {
    let size = patch.size();
    if size < LEAST_SHARE * body {
        return Err(PatchFault::Tiny { size, body, share: LEAST_SHARE });
    }
    let tolerance = TOLERANCE * body;
    for axis in [Axis::U, Axis::V] {
        let width = longest_polygon(patch, axis);
        if width <= tolerance {
            return Err(PatchFault::Sliver { axis, width, tolerance });
        }
    }
    Ok(())
}

/// No curve of a patch along a parameter is longer than the longest of its control polygons.
fn longest_polygon(patch: &NurbsPatch, axis: Axis) -> f64 {
    let (rows, columns) = (patch.counts[0], patch.counts[1]);
    let (lines, count) = if axis == Axis::U { (columns, rows) } else { (rows, columns) };
    let at =
        |line: usize, k: usize| patch.points[if axis == Axis::U { k * columns + line } else { line * columns + k }];
    let length = |line: usize| (1..count).map(|k| at(line, k).distance(at(line, k - 1))).sum::<f64>();
    (0..lines).map(length).fold(0.0, f64::max)
}
