//! The patch that a figure is about, in all the forms it is needed in.

use crate::models;
use anyhow::Context as _;
use glam::DVec3;
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate_bake::{BakedPatch, NurbsPatch};
use palpate_truth::oracle::{ClosestPoint, Oracle, OraclePoint};
use std::path::Path;

/// The first patch of a model.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Name in files and headings.
    pub name: String,
    /// In double precision, for the oracle and the baselines.
    pub surface: NurbsPatch,
    /// As the firmware has it.
    pub patch: SplinePatch<'static>,
    /// The largest side of its bounding box, metres.
    pub size: f64,
}

impl Subject {
    /// Reads a model and bakes its first patch.
    ///
    /// # Errors
    /// The reason why the model is refused.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let mut model = models::read(path)?;
        let surface = model.patches.swap_remove(0);
        let patch = BakedPatch::new(&surface).with_context(|| path.display().to_string())?.to_patch()?;
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let name = if model.name.is_empty() { stem.unwrap_or_default() } else { model.name };
        Ok(Self { name, size: surface.size(), surface, patch })
    }

    /// The oracle of the patch.
    pub fn oracle(&self) -> Oracle<'_> {
        Oracle::new(&self.surface)
    }

    /// The surface at `(u, v)` and its outward unit normal.
    pub fn at(&self, [u, v]: [f64; 2]) -> (OraclePoint, DVec3) {
        let surface = OraclePoint::evaluate(&self.surface, u, v);
        let across = surface.tangent_u.cross(surface.tangent_v).normalize_or_zero();
        (surface, if self.surface.flip { -across } else { across })
    }

    /// A probe straight out from `foot`, at the position the firmware can hold, with its closest point; `None` where
    /// some other point of the patch is nearer than the foot.
    pub fn probe_over(&self, oracle: &Oracle<'_>, foot: [f64; 2], distance: f64) -> Option<(Vec3, ClosestPoint)> {
        let (surface, normal) = self.at(foot);
        let probe = (surface.point + normal * distance).as_vec3();
        let closest = oracle.closest(probe.as_dvec3());
        // Rounding the probe to f32 moves its closest point by some 1e-7 of the coordinates; a rival is far away.
        (closest.point.distance(surface.point) < 1e-4 * self.size).then_some((probe, closest))
    }
}

/// The centre of a polyline's cells: `count` parameters spread evenly over `(0, 1)`, none on the border.
pub(super) fn cell_centres(count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |index| (index as f64 + 0.5) / count as f64)
}
