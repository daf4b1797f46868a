//! Bodies: baked or loaded.

use crate::model::{Made, Source};
use crate::modes::Modes;
use crate::refusal::Refusal;
use glam::DVec3;
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate_bake::{BakedBody, BakedPatch, Model};
use pyo3::prelude::*;
use std::path::Path;

/// A body. Its tables stay in memory until the process ends.
#[pyclass(frozen, module = "palpate")]
pub struct Body {
    /// As the firmware has it.
    pub tables: &'static palpate::body::Body<'static>,
    /// Its only patch, as the firmware has it: a loop renders it by itself, as the commands do.
    pub alone: Option<&'static SplinePatch<'static>>,
    /// As the baker has it.
    pub baked: BakedBody,
    /// Its model, as far as it is known.
    pub model: Model,
    /// Its file.
    pub bytes: Vec<u8>,
    /// Its modes, where it deforms.
    pub modes: Option<Modes>,
}

impl Body {
    /// Bakes it, if it is not baked already.
    ///
    /// # Errors
    /// A fault of it.
    pub fn of(
        source: Source,
        modes: Option<&Path>,
        margin: f64,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<Self, Refusal> {
        let is_file = matches!(source, Source::Tables(..));
        let is_cut = matches!(&source, Source::Tables(file, _) if file.body.faces.len() > file.model.patches.len());
        let Made { model, baked, bytes } = source.made(margin, progress)?;
        if let Some(path) = modes.filter(|_| is_cut) {
            // The modes' bounds are those over the model's control points, and of such a patch the file has not all.
            let says = "modes are bounded over whole patches, and tables with a divided patch lack a part of it";
            return Err(Refusal::Model(format!("{}: {says}: bake the model's own file", path.display())));
        }
        let tables = baked.to_body().map_err(|fault| Refusal::Model(format!("{}: {fault}", model.name)))?;
        let modes = modes.map(|path| Modes::read(path, &model, &tables)).transpose()?;
        let tables: &'static palpate::body::Body<'static> = Box::leak(Box::new(tables));
        let alone = match tables.faces() {
            [face] => Some(&face.patch),
            // Cut into faces, of which a file knows no more.
            _ if model.patches.len() == 1 && !is_file => Some(whole(&model)?),
            _ => None,
        };
        Ok(Self { tables, alone, baked, model, bytes, modes })
    }

    /// A place of the model in the frame of the tables.
    pub fn local(&self, point: [f64; 3]) -> Vec3 {
        (DVec3::from_array(point) - self.model.centre).as_vec3()
    }

    /// A place of the tables in the frame of the model.
    pub fn placed(&self, point: Vec3) -> [f64; 3] {
        (point.as_dvec3() + self.model.centre).to_array()
    }

    /// Where the origin of its tables lies in the model, m.
    pub fn middle(&self) -> DVec3 {
        self.model.centre
    }

    /// A face by its index.
    ///
    /// # Errors
    /// That there is none.
    pub fn face(&self, index: usize) -> Result<&'static palpate::body::Face<'static>, Refusal> {
        let faces = self.tables.faces();
        faces.get(index).ok_or_else(|| Refusal::Index(format!("there is no face {index}; there are {}", faces.len())))
    }

    /// How many modes it has.
    pub fn count(&self) -> usize {
        self.modes.as_ref().map_or(0, |modes| modes.fields.len())
    }

    /// Refuses a body that deforms, for what follows bodies at rest.
    ///
    /// # Errors
    /// That it has modes.
    pub fn at_rest(&self, what: &str) -> Result<(), Refusal> {
        let says = "follows bodies without modes: bake this one without modes=, or use closest or simulate";
        self.modes.as_ref().map_or(Ok(()), |_| Err(Refusal::Settings(format!("{what} {says}"))))
    }

    /// Whether it has an inside.
    pub fn has_inside(&self) -> bool {
        self.baked.topology.is_closed()
    }
}

/// The first patch of a model, uncut.
fn whole(model: &Model) -> Result<&'static SplinePatch<'static>, Refusal> {
    let fault = |fault: &dyn std::fmt::Display| Refusal::Model(format!("{}: {fault}", model.name));
    let baked = BakedPatch::new(&model.patches[0]).map_err(|error| fault(&error))?;
    Ok(Box::leak(Box::new(baked.to_patch().map_err(|error| fault(&error))?)))
}
