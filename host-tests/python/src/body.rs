//! Bodies: baked or loaded.

use crate::model::{Made, Source};
use crate::refusal::Refusal;
use glam::DVec3;
use palpate::math::Vec3;
use palpate_bake::{BakedBody, Model};
use pyo3::prelude::*;

/// A body. Its tables stay in memory until the process ends.
#[pyclass(frozen, module = "palpate")]
pub struct Body {
    /// As the firmware has it.
    pub tables: &'static palpate::body::Body<'static>,
    /// As the baker has it.
    pub baked: BakedBody,
    /// Its model, as far as it is known.
    pub model: Model,
    /// Its file.
    pub bytes: Vec<u8>,
}

impl Body {
    /// Bakes it, if it is not baked already.
    ///
    /// # Errors
    /// A fault of it.
    pub fn of(source: Source) -> Result<Self, Refusal> {
        let Made { model, baked, bytes } = source.made()?;
        let tables = baked.to_body().map_err(|fault| Refusal::Model(format!("{}: {fault}", model.name)))?;
        Ok(Self { tables: Box::leak(Box::new(tables)), baked, model, bytes })
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

    /// Whether it has an inside.
    pub fn has_inside(&self) -> bool {
        self.baked.topology.is_closed()
    }
}
