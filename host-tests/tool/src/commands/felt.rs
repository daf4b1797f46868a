//! The surface of a run: one patch of a model, or the whole body.

use super::felt_scene::FeltScene;
use super::progress;
use crate::models::ModelFile;
use crate::plot::View;
use anyhow::{Context, ensure};
use glam::DVec3;
use palpate::body::{Body, Edge, EdgeFace, Effort, Soft};
use palpate::field::{FieldBounds, Modal, Mode, Quadratic};
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use palpate::scene::Limits;
use palpate::servo::SoftBody;
use palpate_bake::source::{Origin, body_source, modes_source, rust_source};
use palpate_bake::split::Provenance;
use palpate_bake::{BakedBody, BakedPatch, Model, NurbsPatch, modes};
use palpate_sim::plant::{middle, place_around};
use palpate_sim::zwidth::SoftWall;
use palpate_truth::oracle::OraclePoint;
use std::path::Path;

/// The surface of the servo. It lives as long as the program: a servo keeps its surface in flash.
#[derive(Debug)]
pub enum Felt {
    /// One patch.
    Patch {
        /// In double precision.
        surface: NurbsPatch,
        /// Its table.
        baked: Box<BakedPatch>,
        /// As the servo sees it.
        patch: &'static SplinePatch<'static>,
    },
    /// All patches of a model, joined.
    Body {
        /// Its tables.
        baked: Box<BakedBody>,
        /// The names of its faces.
        labels: Vec<String>,
        /// As the servo sees it.
        body: &'static Body<'static>,
        /// The model's name.
        name: String,
        /// Its modes, where it deforms.
        soft: Option<SoftModes>,
    },
    /// Bodies that stand and move.
    Scene(FeltScene),
}

/// The modes of a body that deforms.
#[derive(Debug, Default)]
pub struct SoftModes {
    modes: &'static [Mode],
    motion: Vec<Modal>,
}

impl SoftModes {
    /// Of a modes file.
    ///
    /// # Errors
    /// The first thing wrong with it.
    pub fn read(path: &Path, model: &Model) -> anyhow::Result<Self> {
        let label = path.display().to_string();
        let text = std::fs::read_to_string(path).with_context(|| format!("{label}: cannot be read"))?;
        let (modes, motion): (Vec<_>, _) = modes::parse_moving(&text, &label, model)?.into_iter().unzip();
        Ok(Self { modes: modes.leak(), motion })
    }

    /// How far they move the surface of a body at most, metres.
    pub(super) fn motion(&self) -> f64 {
        self.modes.iter().map(|mode| f64::from(mode.limit * mode.bounds.motion)).sum()
    }

    /// As Rust source.
    ///
    /// # Errors
    /// A number that is not finite.
    pub(super) fn tables(&self) -> anyhow::Result<String> {
        let modes: Vec<_> = self.modes.iter().copied().zip(self.motion.iter().copied()).collect();
        Ok(modes_source(&modes)?)
    }

    /// A body with these modes, for a loop of this rate, Hz.
    ///
    /// # Errors
    /// A mode that the library refuses.
    pub fn on(&self, body: &Body<'static>, rate_hz: f32) -> anyhow::Result<&'static SoftBody<'static>> {
        let soft = Soft::new(*body, self.modes)?;
        Ok(Box::leak(Box::new(SoftBody::new(soft, &self.motion, rate_hz)?)))
    }

    /// Their numbers, as the page reads them.
    pub fn numbers(&self) -> Vec<f32> {
        let each = self.modes.iter().zip(&self.motion).flat_map(|(mode, modal)| {
            let Quadratic { constant, linear, quadratic } = mode.field;
            let (direction, at, radius) =
                mode.bump.map_or((Vec3::ZERO, Vec3::ZERO, 0.0), |b| (b.direction, b.at, b.radius));
            let vectors = [constant].into_iter().chain(linear).chain(quadratic).chain([direction, at]);
            let FieldBounds { motion, stretch, bend, twist } = mode.bounds;
            let Modal { mass_kg, damping_n_s_per_m, stiffness_n_per_m } = *modal;
            let others =
                [radius, mode.limit, motion, stretch, bend, twist, mass_kg, damping_n_s_per_m, stiffness_n_per_m];
            vectors.flat_map(|vector| vector.to_array()).chain(others)
        });
        each.collect()
    }

    /// The source of a body that deforms, from that of the body.
    fn source(&self, body: &str, rate_hz: f32) -> anyhow::Result<String> {
        let modes = self.tables()?;
        Ok(format!(
            "mod rest {{\n{body}{modes}}}\n#[allow(unused_imports)]\npub use rest::{{CENTRE, TABLE_CRC}};\n\
             /// The type of the surface.\npub type Surface = palpate::servo::SoftBody<'static>;\n\
             /// The body with another effort in each tick.\n\
             pub const fn with_effort(effort: palpate::body::Effort) -> Surface {{\n    \
             let Ok(soft) = palpate::body::Soft::new(rest::BODY.with_effort(effort).fitted(palpate::body::TickLimit::BENCH), &rest::MODES) else {{ panic!(\"modes\") }};\n    \
             let Ok(surface) = palpate::servo::SoftBody::new(soft, &rest::MOTION, {rate_hz:?}) else {{ panic!(\"motion\") }};\n    \
             surface\n}}\n"
        ))
    }
}

impl Felt {
    /// The patch of this name or number; without one, the body, or the only patch.
    ///
    /// # Errors
    /// A fault of the model, or no such patch.
    pub fn read(
        model: &Model,
        from: &ModelFile,
        file: &Path,
        patch: Option<&str>,
        modes: Option<&Path>,
    ) -> anyhow::Result<Self> {
        let soft = modes.map(|modes| SoftModes::read(modes, model)).transpose()?;
        let index = match patch {
            Some(wanted) => Some(patch_index(model, file, wanted)?),
            // A patch that was cut into faces is one no more in a file of tables.
            None => (from.baked().map_or(model.patches.len(), |body| body.faces.len()) == 1).then_some(0),
        };
        if let Some(index) = index {
            ensure!(soft.is_none(), "{}: --modes applies to bodies, and this is one patch", from.label);
            let baked = only_patch(model, from, index)?;
            let patch: &'static SplinePatch<'static> = Box::leak(Box::new(baked.to_patch()?));
            return Ok(Self::Patch { surface: model.patches[index].clone(), baked: Box::new(baked), patch });
        }
        let baked = from.body(model)?;
        let options = baked.locator_options();
        let bar = progress::work();
        let progress = |done, all| bar.tell("cells of space", done, all);
        let baked = from.located(baked, &options, None, &progress)?;
        drop(bar);
        // That of the emulated boards, whose loop this is.
        let body: &'static Body<'static> = Box::leak(Box::new(baked.to_body()?.with_effort(Effort::ONE)));
        Ok(Self::Body { labels: baked.labels(model), baked: Box::new(baked), body, name: model.name.clone(), soft })
    }

    /// A body that deforms by a file of modes, as walls for loops of these rates, Hz, hit from above.
    ///
    /// # Errors
    /// A fault of the model or of the modes.
    pub fn soft_walls(model: &Path, modes: &Path, rates: &[f64]) -> anyhow::Result<Vec<SoftWall>> {
        let file = ModelFile::read(model)?;
        let felt = Self::read(&file.model()?, &file, model, None, Some(modes))?;
        let Self::Body { body, soft: Some(soft), .. } = &felt else { anyhow::bail!("{}: not a body", file.label) };
        let (from, deforms) = (felt.middle() + Vec3::Z * body.size(), Soft::new(**body, soft.modes)?);
        let wall = |rate: &f64| {
            let wall = SoftWall::new(deforms, &soft.motion, *rate as f32, from);
            wall.with_context(|| format!("{} at {rate} Hz", modes.display()))
        };
        rates.iter().map(wall).collect()
    }

    /// The body that a tool with a shape touches.
    ///
    /// # Errors
    /// A surface that is no rigid body.
    pub fn rigid_body(&self) -> anyhow::Result<&'static Body<'static>> {
        match self {
            Self::Body { body, soft: None, .. } => Ok(body),
            _ => anyhow::bail!("--tool touches rigid bodies: no single patch (--patch), no scene and no --modes"),
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::Patch { surface, .. } => surface.name.as_deref().unwrap_or("a patch"),
            Self::Body { name, .. } => name,
            Self::Scene(scene) => scene.name(),
        }
    }

    /// Its patches.
    pub fn patches(&self) -> Vec<&'static SplinePatch<'static>> {
        match self {
            Self::Patch { patch, .. } => vec![patch],
            Self::Body { body, .. } => body.faces().iter().map(|face| &face.patch).collect(),
            // Each in a frame of its own.
            Self::Scene(_) => Vec::new(),
        }
    }

    /// It as a net of lines, for a report; a scene's at a servo rate, Hz.
    pub fn net(&self, rate: f32) -> Vec<Vec<(f64, f64)>> {
        match self {
            Self::Scene(scene) => scene.nets(rate),
            _ => self.patches().into_iter().flat_map(|patch| View::FRONT_RIGHT.net(patch)).collect(),
        }
    }

    /// A feature by the names of its faces, from its code.
    pub fn feature_name(&self, code: u16) -> String {
        let index = code & 0x3fff;
        let Self::Body { body, labels, .. } = self else {
            let kind = ["face", "edge"].get(usize::from(code >> 14)).unwrap_or(&"vertex");
            return if matches!(self, Self::Patch { .. }) { self.name().to_owned() } else { format!("{kind} {index}") };
        };
        let name = |face: u16| {
            labels.get(usize::from(face)).map_or_else(|| face.to_string(), |name| name.trim_matches('"').to_owned())
        };
        let on = |edge: &Edge<'_>| edge.faces.into_iter().filter(|side| *side != EdgeFace::NONE).map(|side| side.face);
        let mut faces: Vec<u16> = match code >> 14 {
            0 => return name(index),
            1 => body.edges().get(usize::from(index)).into_iter().flat_map(on).collect(),
            _ => body.edges().iter().filter(|edge| edge.ends.contains(&index)).flat_map(on).collect(),
        };
        faces.sort_unstable();
        faces.dedup();
        faces.into_iter().map(name).collect::<Vec<_>>().join(" | ")
    }

    /// Its tables as Rust source; a scene's with these limits, a soft body's for a loop of this rate, Hz.
    ///
    /// # Errors
    /// A bug of the baker.
    pub fn source(&self, origin: &Origin<'_>, limits: Limits, rate_hz: f32) -> anyhow::Result<String> {
        Ok(match self {
            Self::Scene(scene) => scene.source(limits)?,
            Self::Patch { baked, .. } => rust_source(origin, std::slice::from_ref(&**baked))?,
            Self::Body { baked, labels, soft, .. } => {
                let source = body_source(origin, baked, labels)?;
                soft.as_ref().map_or(Ok(source.clone()), |soft| soft.source(&source, rate_hz))?
            }
        })
    }

    /// The middle of its bounding box, from a grid of points.
    pub fn middle(&self) -> Vec3 {
        if let Self::Scene(scene) = self {
            return scene.middle();
        }
        middle(self.patches().into_iter())
    }

    /// Where a hand may touch: a point and the outward normal for each `(u, v)` in `[0, 1]²`. On a patch its own
    /// parameters; on a body the direction from its middle, `(½, ½)` upwards, to a place outside, and the body's
    /// closest point to that place: continuous around a convex body, edges and corners included.
    pub fn places(&self) -> Box<dyn Fn(f64, f64) -> (DVec3, DVec3)> {
        match self {
            Self::Patch { surface, .. } => {
                let surface = surface.clone();
                Box::new(move |u, v| OraclePoint::place(&surface, u, v))
            }
            Self::Body { body, .. } => {
                let (body, middle) = (*body, self.middle());
                Box::new(move |u, v| place_around(body, middle, u, v))
            }
            Self::Scene(scene) => Box::new(scene.places()),
        }
    }
}

/// The table of one patch of a model.
fn only_patch(model: &Model, from: &ModelFile, index: usize) -> anyhow::Result<BakedPatch> {
    let Some(body) = from.baked() else { return Ok(BakedPatch::all(model, &from.label)?.swap_remove(index)) };
    let whole = Provenance::whole(index);
    let face = body.faces.iter().find(|face| face.source == whole);
    let name = || format!("{}: patch {} is in pieces there: take the model file", from.label, model.patch_label(index));
    Ok(face.with_context(name)?.patch.clone())
}

fn patch_index(model: &Model, file: &Path, wanted: &str) -> anyhow::Result<usize> {
    let by_name = model.patches.iter().position(|patch| patch.name.as_deref() == Some(wanted));
    let by_number = || wanted.parse().ok().filter(|index| *index < model.patches.len());
    by_name
        .or_else(by_number)
        .with_context(|| format!("{}: no patch {wanted:?} among {}", file.display(), model.patches.len()))
}
