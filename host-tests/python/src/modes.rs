//! Modes of a body that deforms, from a modes file.

use crate::refusal::Refusal;
use palpate::body::{Body, Soft};
use palpate::field::{Modal, Mode};
use palpate::servo::SoftBody;
use palpate_bake::{Model, modes};
use std::fs;
use std::path::Path;

/// The modes of a body, in the frame of its tables. They stay in memory until the process ends.
pub struct Modes {
    /// Their displacements.
    pub fields: &'static [Mode],
    /// How each moves by itself, or which number of that the file has not.
    motion: Result<Vec<Modal>, String>,
}

impl Modes {
    /// Reads the modes of a model and its body.
    ///
    /// # Errors
    /// No such file, or a fault of it.
    pub fn read(path: &Path, model: &Model, body: &Body<'_>) -> Result<Self, Refusal> {
        let label = path.display().to_string();
        let bytes = fs::read(path).map_err(|cause| Refusal::Path(label.clone(), cause))?;
        let text = String::from_utf8(bytes).map_err(|_| Refusal::Model(format!("{label}: is not text in UTF-8")))?;
        let refused = |error: &dyn std::fmt::Display| Refusal::Model(error.to_string());
        let fields = modes::parse(&text, &label, model).map_err(|error| refused(&error))?;
        Soft::new(*body, &fields).map_err(|error| refused(&format!("{label}: {error}")))?;
        let moving = modes::parse_moving(&text, &label, model);
        let motion = moving.map(|modes| modes.into_iter().map(|(_, motion)| motion).collect());
        Ok(Self { fields: fields.leak(), motion: motion.map_err(|error| error.to_string()) })
    }

    /// The maximum of `|q|` of each mode, m.
    pub fn budget(&self) -> f32 {
        self.fields.iter().map(|mode| mode.limit).fold(0.0, f32::max)
    }

    /// A body with these modes as the loop of a rate, Hz, feels it.
    ///
    /// # Errors
    /// A mode that does not say how it moves, or that the loop refuses.
    pub fn moving(&self, body: Body<'static>, rate: f32) -> Result<SoftBody<'static>, Refusal> {
        let motion = self.motion.as_ref().map_err(|says| Refusal::Model(says.clone()))?;
        let soft = Soft::new(body, self.fields).and_then(|soft| SoftBody::new(soft, motion, rate));
        soft.map_err(|error| Refusal::Settings(error.to_string()))
    }
}
