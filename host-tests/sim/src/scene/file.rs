//! The file, as it is written. Lengths are in millimetres, angles in degrees, all else in SI units.

use palpate::render::{EffectError, EffectField};
use serde::Deserialize;
use thiserror::Error;

/// The most bodies of a file: an image and a loop are made for each number of them.
pub const MAX_BODIES: usize = 8;

/// A scene file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Its name.
    pub name: String,
    /// Rate at which the force is released after a switch, N/s.
    pub let_go: Option<f32>,
    /// The bodies.
    pub body: Vec<BodyEntry>,
}

/// A body.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyEntry {
    /// Its name.
    pub name: String,
    /// Its model: a file, relative to the scene file's folder, or a shipped model.
    pub model: String,
    /// The modes by which it deforms: a file, relative to the scene file's folder.
    pub modes: Option<String>,
    /// Position of its model's origin, mm.
    #[serde(default)]
    pub at: [f64; 3],
    /// Its orientation.
    pub turned: Option<Turned>,
    /// The group it belongs to.
    #[serde(default)]
    pub group: u8,
    /// N/m.
    pub stiffness: f32,
    /// N·s/m.
    pub damping: f32,
    /// Dry friction.
    pub friction: Option<FrictionEntry>,
    /// Texture along its surface.
    pub texture: Option<TextureEntry>,
    /// Pull toward its surface.
    pub magnet: Option<MagnetEntry>,
    /// Viscous layer around it.
    pub viscosity: Option<ViscosityEntry>,
    /// Its maximum force, N; the device's, if not given.
    pub max_force: Option<f32>,
    /// Its continuous rotation.
    pub turns: Option<Turn>,
    /// Its continuous oscillation.
    pub sways: Option<Sway>,
    /// Its mass and joint, if it is free.
    pub free: Option<Free>,
}

/// A rotation.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Turned {
    /// Any length but zero.
    pub axis: [f64; 3],
    /// Degrees.
    pub by: f64,
}

/// As [`palpate::render::Friction`].
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrictionEntry {
    /// N/m.
    pub stiffness: f32,
    /// N·s/m.
    pub damping: f32,
    /// `μ_s`.
    #[serde(rename = "static")]
    pub static_coefficient: f32,
    /// `μ_d`.
    #[serde(rename = "dynamic")]
    pub dynamic_coefficient: f32,
}

/// As [`palpate::render::Texture`]: a named shape, and `share`, its force as a share of the normal force.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(tag = "shape", rename_all = "lowercase", deny_unknown_fields)]
pub enum TextureEntry {
    /// Ridges across a direction.
    Ridges {
        /// Any length but zero, in the model's axes.
        across: [f64; 3],
        /// mm.
        pitch: f64,
        /// 0 to 1.
        share: f32,
    },
    /// Bumps, across all three axes of the model.
    Bumps {
        /// mm.
        pitch: f64,
        /// 0 to 1.
        share: f32,
    },
}

/// As [`palpate::render::Magnet`].
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MagnetEntry {
    /// N.
    pub force: f32,
    /// mm.
    pub reach: f64,
}

/// As [`palpate::render::Viscosity`].
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViscosityEntry {
    /// N·s/m.
    pub damping: f32,
    /// mm.
    pub reach: f64,
}

/// A turn about an axis.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// Any length but zero.
    pub axis: [f64; 3],
    /// A point of it, mm.
    pub about: [f64; 3],
    /// Degrees a second.
    pub rate: f64,
}

/// To and fro along a line.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sway {
    /// As far to either side, mm.
    pub by: [f64; 3],
    /// How often a second.
    pub often: f64,
}

/// A free body.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Free {
    /// kg.
    pub mass: f32,
    /// kg·m²; that of a block as large as its bounding box, if not given.
    pub inertia: Option<[f32; 3]>,
    /// m/s².
    #[serde(default)]
    pub gravity: [f32; 3],
    /// N·s/m.
    #[serde(default)]
    pub damping: f32,
    /// N·m·s/rad.
    #[serde(default)]
    pub angular_damping: f32,
    /// N·m/rad.
    #[serde(default)]
    pub angular_stiffness: f32,
    /// From the middle of the body to where that is at the start.
    pub spring: Option<Spring>,
    /// How it may move; every way, if not given.
    pub joint: Option<JointEntry>,
}

/// A spring from the body's middle to where that starts.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spring {
    /// N/m.
    pub stiffness: f32,
    /// N·s/m.
    #[serde(default)]
    pub damping: f32,
    /// How far it is slack to either side, mm.
    #[serde(default)]
    pub slack: [f64; 3],
}

/// Joint that holds a body.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum JointEntry {
    /// It cannot move.
    Fixed,
    /// Along an axis.
    Slider {
        /// Any length but zero.
        axis: [f64; 3],
    },
    /// About an axis.
    Hinge {
        /// Any length but zero.
        axis: [f64; 3],
        /// A point of it, mm.
        about: [f64; 3],
    },
}

/// Why a scene file is refused.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SceneFileError {
    /// It is no TOML, or has other fields.
    #[error("{0}")]
    Syntax(String),
    /// Too few or too many bodies.
    #[error("a scene file has 1 to {most} bodies, this one {found}")]
    Bodies {
        /// How many it has.
        found: usize,
        /// How many it may have.
        most: usize,
    },
    /// An axis without a direction.
    #[error("body {body:?}: an axis has no direction")]
    Axis {
        /// Its name.
        body: String,
    },
    /// A body that is free and on a path.
    #[error("body {body:?} is free and on a path: one of the two")]
    Both {
        /// Its name.
        body: String,
    },
    /// Two bodies of one name.
    #[error("two bodies are called {body:?}")]
    Twice {
        /// The name.
        body: String,
    },
    /// A number of an effect is out of range.
    #[error("body {body:?}: {}", out_of_range(.error, *.value))]
    Effect {
        /// Its name.
        body: String,
        /// The field and its range, in SI units.
        error: EffectError,
        /// The number, in SI units.
        value: f32,
    },
    /// An error of the library.
    #[error("{}{error}", .body.as_ref().map(|name| format!("{name:?}, ")).unwrap_or_default())]
    Scene {
        /// The body's name, if it is one's.
        body: Option<String>,
        /// Why.
        error: palpate::scene::SceneError,
    },
}

/// The field as the file names it, the number, the range, and the remedy.
fn out_of_range(EffectError { field, range: [min, max] }: &EffectError, value: f32) -> String {
    let (name, unit, remedy) = match field {
        EffectField::MaxForce => ("max_force", "N", "set a force in this range, or leave it out for the device's"),
        EffectField::TextureFraction => ("texture.share", "", "set a share in this range"),
        EffectField::TexturePitch => ("texture.pitch", "mm", "a smaller share or max_force allows a shorter pitch"),
        EffectField::TextureAcross => ("texture.across", "", "set a unit vector"),
        EffectField::MagnetForce => ("magnet.force", "N", "set a smaller force, or a greater max_force"),
        EffectField::MagnetReach => ("magnet.reach", "mm", "a smaller force allows a shorter reach"),
        EffectField::ViscosityDamping => {
            ("viscosity.damping", "N·s/m", "set a smaller one, or a smaller damping of the body")
        }
        EffectField::ViscosityReach => ("viscosity.reach", "mm", "set a reach in this range"),
    };
    // Three digits, rounded into the range; f32 has no more than seven.
    let scale = if unit == "mm" { 1e3 } else { 1.0 };
    let [value, min, max] = [value, min * 1.000_5, *max].map(|number| (number * scale * 1e3).round() / 1e3);
    format!("{name} is {value} {unit}; allowed are {min} to {max} {unit}: {remedy}")
        .replace(" ;", ";")
        .replace(" :", ":")
}

impl SceneFile {
    /// Reads and checks a file's text.
    ///
    /// # Errors
    /// The first fault, with the body's name or the line.
    pub fn read(text: &str) -> Result<Self, SceneFileError> {
        let file: Self = toml::from_str(text).map_err(|error| SceneFileError::Syntax(error.to_string()))?;
        let (found, most) = (file.body.len(), MAX_BODIES);
        if !(1..=most).contains(&found) {
            return Err(SceneFileError::Bodies { found, most });
        }
        for (index, entry) in file.body.iter().enumerate() {
            let body = || entry.name.clone();
            if file.body.iter().take(index).any(|other| other.name == entry.name) {
                return Err(SceneFileError::Twice { body: body() });
            }
            if entry.free.is_some() && (entry.turns.is_some() || entry.sways.is_some()) {
                return Err(SceneFileError::Both { body: body() });
            }
            let joint = entry.free.and_then(|free| free.joint).and_then(|joint| match joint {
                JointEntry::Fixed => None,
                JointEntry::Slider { axis } | JointEntry::Hinge { axis, .. } => Some(axis),
            });
            let across = match entry.texture {
                Some(TextureEntry::Ridges { across, .. }) => Some(across),
                _ => None,
            };
            let axes = [entry.turned.map(|turned| turned.axis), entry.turns.map(|turn| turn.axis), joint, across];
            if axes.into_iter().flatten().any(|axis| glam::DVec3::from_array(axis).try_normalize().is_none()) {
                return Err(SceneFileError::Axis { body: body() });
            }
        }
        Ok(file)
    }

    /// Whether a text is meant for a scene file and not for a model: it has bodies.
    pub fn is_one(text: &str) -> bool {
        toml::from_str::<toml::Table>(text)
            .is_ok_and(|table| table.contains_key("body") && !table.contains_key("patch"))
    }
}
