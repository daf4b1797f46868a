//! The modes file of a body that deforms (TOML), and the bounds of each mode over the body.
//!
//! ```toml
//! budget = 0.004                       # metres, the maximum of |q| of each mode
//! [[mode]]
//! name = "bend"
//! centre = [0.0, 0.0, 0.0]             # metres, in the model's own frame
//! half = 0.03                          # metres
//! # Displacement, metres per metre of q: the sum of poly[k] times monomial k of r = (X - centre)/half,
//! # 1 x y z xx xy xz yy yz zz
//! poly = [[0, 0, -0.4], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 1.4], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]
//! bump = [0, 0, 1]                     # optional: plus bump (1 - |X - at|²/radius²)³ within the radius
//! at = [0.0, 0.0, 0.02]
//! radius = 0.02
//! frequency = 12.0                     # Hz; needed where the body moves by itself, as are the next two
//! mass = 0.05                          # kg, where the most moved point has the displacement 1
//! damping = 0.1                        # ratio, 1 is critical
//! ```

use crate::model::{Model, message};
use glam::{DMat3, DVec3};
use palpate::field::{Bump, FieldBounds, MAX_MODES, Modal, Mode, Quadratic};
use serde::Deserialize;
use std::path::Path;
use thiserror::Error;

/// A fault of a modes file.
#[derive(Debug, Error)]
pub enum ModesError {
    /// It cannot be read.
    #[error("{file}: cannot be read: {cause}")]
    Read {
        /// The file.
        file: String,
        /// Why.
        cause: std::io::Error,
    },
    /// It is not TOML, or a key is missing or of the wrong kind.
    #[error("{file}: {message}")]
    Syntax {
        /// The file.
        file: String,
        /// Where and what.
        message: String,
    },
    /// No modes, or too many.
    #[error("{file}: {count} modes: a body has 1 to {MAX_MODES}; add a [[mode]], or leave the stiffest out")]
    Count {
        /// The file.
        file: String,
        /// How many.
        count: usize,
    },
    /// A number outside of its range.
    #[error("{file}: {name}: {key} is {value}: must be {range}")]
    Number {
        /// The file.
        file: String,
        /// The mode, or the file's head.
        name: String,
        /// Which number.
        key: &'static str,
        /// Its value.
        value: f64,
        /// The range.
        range: &'static str,
    },
    /// Numbers whose bounds are beyond single precision.
    #[error(
        "{file}: {name}: budget, poly, half and radius give a displacement that is too large; check their units: metres"
    )]
    TooLarge {
        /// The file.
        file: String,
        /// The mode.
        name: String,
    },
    /// No displacement of space.
    #[error("{file}: {name}: no poly: {remedy}")]
    NoField {
        /// The file.
        file: String,
        /// The mode.
        name: String,
        /// The remedy.
        remedy: &'static str,
    },
    /// A mode that does not say how it moves.
    #[error("{file}: {name}: no {key}: a body that moves by itself needs frequency, mass and damping of each mode")]
    NoMotion {
        /// The file.
        file: String,
        /// The mode.
        name: String,
        /// Which number.
        key: &'static str,
    },
    /// Not ten vectors.
    #[error("{file}: {name}: poly has {count} entries: 10, for 1 x y z xx xy xz yy yz zz")]
    Monomials {
        /// The file.
        file: String,
        /// The mode.
        name: String,
        /// How many.
        count: usize,
    },
}

#[derive(Deserialize)]
struct RawModes {
    budget: f64,
    #[serde(default)]
    mode: Vec<RawMode>,
}

#[derive(Deserialize)]
struct RawMode {
    name: Option<String>,
    #[serde(default)]
    centre: [f64; 3],
    half: Option<f64>,
    poly: Option<Vec<[f64; 3]>>,
    #[serde(default)]
    bump: [f64; 3],
    #[serde(default)]
    at: [f64; 3],
    #[serde(default)]
    radius: f64,
    frequency: Option<f64>,
    mass: Option<f64>,
    damping: Option<f64>,
    patch: Option<toml::Value>,
}

/// Reads the modes of a model, in the frame of its tables.
///
/// # Errors
/// The first thing wrong with the file.
pub fn read(path: &Path, model: &Model) -> Result<Vec<Mode>, ModesError> {
    let file = path.display().to_string();
    match std::fs::read_to_string(path) {
        Ok(text) => parse(&text, &file, model),
        Err(cause) => Err(ModesError::Read { file, cause }),
    }
}

/// The modes of a text; `file` is what messages call it.
///
/// # Errors
/// The first thing wrong with it.
pub fn parse(text: &str, file: &str, model: &Model) -> Result<Vec<Mode>, ModesError> {
    Ok(parse_all(text, file, model)?.into_iter().map(|(mode, _)| mode).collect())
}

/// The modes of a text, each with its motion.
///
/// # Errors
/// The first thing wrong with it.
pub fn parse_moving(text: &str, file: &str, model: &Model) -> Result<Vec<(Mode, Modal)>, ModesError> {
    let moving = |(mode, motion): (Mode, Motion)| {
        let need = |key, value: Option<f64>| {
            let missing = || ModesError::NoMotion { file: file.to_owned(), name: motion.name.clone(), key };
            value.filter(|value| key != "frequency" || *value > 0.0).ok_or_else(missing)
        };
        let [frequency, mass, damping] =
            [need("frequency", motion.frequency)?, need("mass", motion.mass)?, need("damping", motion.damping)?];
        Ok((mode, Modal::new(frequency as f32, mass as f32, damping as f32)))
    };
    parse_all(text, file, model)?.into_iter().map(moving).collect()
}

struct Motion {
    name: String,
    frequency: Option<f64>,
    mass: Option<f64>,
    damping: Option<f64>,
}

fn parse_all(text: &str, file: &str, model: &Model) -> Result<Vec<(Mode, Motion)>, ModesError> {
    let owned = || file.to_owned();
    let raw: RawModes =
        toml::from_str(text).map_err(|error| ModesError::Syntax { file: owned(), message: message(text, &error) })?;
    let within = |name: &str, key, value: f64, is_within: bool, range| {
        let fault = || ModesError::Number { file: owned(), name: name.into(), key, value, range };
        if is_within && value.is_finite() { Ok(()) } else { Err(fault()) }
    };
    within("the file", "budget", raw.budget, raw.budget > 0.0, "above 0 and finite")?;
    if raw.mode.is_empty() || raw.mode.len() > MAX_MODES {
        return Err(ModesError::Count { file: owned(), count: raw.mode.len() });
    }
    let modes = raw.mode.into_iter().enumerate().map(|(index, mode)| {
        let name = mode.name.map_or_else(|| format!("mode {index}"), |name| format!("mode \"{name}\""));
        let Some(poly) = mode.poly else {
            let remedy = match mode.patch {
                Some(_) => {
                    "displacements of control points are not supported; give 30 numbers of a displacement of space"
                }
                None => "give 10 vectors, for 1 x y z xx xy xz yy yz zz",
            };
            return Err(ModesError::NoField { file: owned(), name, remedy });
        };
        let poly: [[f64; 3]; 10] = match poly.try_into() {
            Ok(poly) => poly,
            Err(poly) => return Err(ModesError::Monomials { file: owned(), name, count: poly.len() }),
        };
        let half = mode.half.unwrap_or(1.0);
        within(&name, "half", half, half > 0.0, "above 0 and finite")?;
        let vectors = [("centre", mode.centre), ("bump", mode.bump), ("at", mode.at)];
        let vectors = vectors.into_iter().chain(poly.map(|entry| ("poly", entry)));
        for (key, value) in vectors.flat_map(|(key, vector)| vector.map(|value| (key, value))) {
            within(&name, key, value, true, "finite")?;
        }
        let has_bump = mode.bump != [0.0; 3];
        within(
            &name,
            "radius",
            mode.radius,
            !has_bump || mode.radius > 0.0,
            "above 0 and finite where there is a bump",
        )?;
        for (key, value) in [("frequency", mode.frequency), ("mass", mode.mass), ("damping", mode.damping)] {
            let value = value.unwrap_or(1.0);
            within(&name, key, value, value > 0.0 || (key != "mass" && value == 0.0), "above 0 and finite")?;
        }
        let bump =
            has_bump.then(|| (DVec3::from_array(mode.bump), DVec3::from_array(mode.at) - model.centre, mode.radius));
        let field = Field::new(poly.map(DVec3::from_array), DVec3::from_array(mode.centre) - model.centre, half);
        let motion = Motion { name, frequency: mode.frequency, mass: mode.mass, damping: mode.damping };
        let baked = field.baked(bump, raw.budget, hull(model));
        let fault = || ModesError::TooLarge { file: owned(), name: motion.name.clone() };
        baked.is_valid().then_some(()).ok_or_else(fault)?;
        Ok((baked, motion))
    });
    modes.collect()
}

/// A box that holds the body: that of its control points.
fn hull(model: &Model) -> [DVec3; 2] {
    let points = || model.patches.iter().flat_map(|patch| &patch.points);
    [
        points().fold(DVec3::INFINITY, |low, at| low.min(*at)),
        points().fold(DVec3::NEG_INFINITY, |high, at| high.max(*at)),
    ]
}

/// A quadratic displacement on `1 x y z xx xy xz yy yz zz`, in metres.
struct Field([DVec3; 10]);

impl Field {
    /// From one on `r = (X − centre)/half`.
    fn new(p: [DVec3; 10], centre: DVec3, half: f64) -> Self {
        let [one, x, y, z, xx, xy, xz, yy, yz, zz] = p;
        let [x, y, z] = [x, y, z].map(|entry| entry / half);
        let [xx, xy, xz, yy, yz, zz] = [xx, xy, xz, yy, yz, zz].map(|entry| entry / (half * half));
        let c = centre;
        let pure = xx * (c.x * c.x) + yy * (c.y * c.y) + zz * (c.z * c.z);
        let mixed = xy * (c.x * c.y) + xz * (c.x * c.z) + yz * (c.y * c.z);
        let one = one - (x * c.x + y * c.y + z * c.z) + pure + mixed;
        let x = x - (xx * (2.0 * c.x) + xy * c.y + xz * c.z);
        let y = y - (xy * c.x + yy * (2.0 * c.y) + yz * c.z);
        let z = z - (xz * c.x + yz * c.y + zz * (2.0 * c.z));
        Self([one, x, y, z, xx, xy, xz, yy, yz, zz])
    }

    fn at(&self, p: DVec3) -> DVec3 {
        let [one, x, y, z, xx, xy, xz, yy, yz, zz] = self.0;
        let quadratic = xx * (p.x * p.x) + xy * (p.x * p.y) + xz * (p.x * p.z) + yy * (p.y * p.y) + yz * (p.y * p.z);
        one + x * p.x + y * p.y + z * p.z + quadratic + zz * (p.z * p.z)
    }

    /// `Dψ`, by its columns.
    fn slope(&self, p: DVec3) -> DMat3 {
        let [_, x, y, z, xx, xy, xz, yy, yz, zz] = self.0;
        DMat3::from_cols(
            x + xx * (2.0 * p.x) + xy * p.y + xz * p.z,
            y + xy * p.x + yy * (2.0 * p.y) + yz * p.z,
            z + xz * p.x + yz * p.y + zz * (2.0 * p.z),
        )
    }

    /// `sup ‖D²ψ‖`: of a unit vector `n`, `n · D²ψ` is at most the root of the sum of the squares of its components'.
    fn bend(&self) -> f64 {
        let [_, _, _, _, xx, xy, xz, yy, yz, zz] = self.0;
        let component = |k: usize| {
            let rows = [[2.0 * xx[k], xy[k], xz[k]], [xy[k], 2.0 * yy[k], yz[k]], [xz[k], yz[k], 2.0 * zz[k]]];
            norm(DMat3::from_cols_array_2d(&rows))
        };
        component(0).hypot(component(1)).hypot(component(2))
    }

    /// The mode, with bounds that are proved over a box.
    fn baked(&self, bump: Option<(DVec3, DVec3, f64)>, limit: f64, [low, high]: [DVec3; 2]) -> Mode {
        /// The rounding to `f32` of the numbers above, and of the target's sums of ten terms.
        const ROUNDED: f64 = 1.0 + 1e-5;
        let corners = |low: DVec3, high: DVec3| {
            (0..8).map(move |corner| {
                let pick = |axis: usize| if corner >> axis & 1 == 1 { high[axis] } else { low[axis] };
                DVec3::new(pick(0), pick(1), pick(2))
            })
        };
        // A norm of an affine function is largest in a corner.
        let slope = |low, high| corners(low, high).map(|at| norm(self.slope(at))).fold(0.0, f64::max);
        /// Cells along each side of the box, over each of which the displacement is bounded by its slope.
        const CELLS: usize = 8;
        let step = (high - low) / CELLS as f64;
        let cells = (0..CELLS * CELLS * CELLS).map(|cell| {
            let index = DVec3::new((cell % CELLS) as f64, (cell / CELLS % CELLS) as f64, (cell / CELLS / CELLS) as f64);
            let (low, high) = (low + index * step, low + (index + DVec3::ONE) * step);
            self.at(0.5 * (low + high)).length() + slope(low, high) * 0.5 * step.length()
        });
        let mut bounds = [cells.fold(0.0, f64::max), slope(low, high), self.bend(), 0.0];
        if let Some((direction, _, radius)) = bump {
            // Of (1 − s)³, s = r²/ρ²: 6 √s (1 − s)²/ρ at s = 1/5; 6/ρ² in the middle; 48/ρ³ at the rim.
            let size = direction.length();
            let most = [1.0, 1.72 / radius, 6.0 / (radius * radius), 48.0 / (radius * radius * radius)];
            bounds.iter_mut().zip(most).for_each(|(bound, most)| *bound += size * most);
        }
        let [motion, stretch, bend, twist] = bounds.map(|bound| (bound * ROUNDED) as f32);
        let [constant, x, y, z, quadratic @ ..] = self.0.map(|entry| entry.as_vec3());
        let bump = bump.map(|(direction, at, radius)| Bump {
            direction: direction.as_vec3(),
            at: at.as_vec3(),
            radius: radius as f32,
        });
        Mode {
            field: Quadratic { constant, linear: [x, y, z], quadratic },
            bump,
            limit: limit as f32,
            bounds: FieldBounds { motion, stretch, bend, twist },
        }
    }
}

/// The largest singular value of a matrix, from above.
fn norm(matrix: DMat3) -> f64 {
    // The 2n-th root of the trace of the n-th power of MᵀM is above it, by at most the 2n-th root of 3.
    let scale = matrix.to_cols_array().iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    if scale == 0.0 {
        return 0.0;
    }
    let mut power = (matrix.transpose() * matrix) * (1.0 / (scale * scale));
    for _ in 0..6 {
        power *= power;
    }
    let trace = power.x_axis.x + power.y_axis.y + power.z_axis.z;
    scale * trace.powf(1.0 / 128.0)
}
