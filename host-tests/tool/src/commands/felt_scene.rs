//! A scene file as a surface: its bodies, baked, in their places.

use super::felt::SoftModes;
use super::options::has_room;
use super::progress;
use crate::devices::ShippedDevice;
use crate::models::ModelFile;
use crate::page::{RecordedBody, RecordedScene};
use crate::plot::View;
use anyhow::Context;
use glam::DVec3;
use palpate::body::{Body, Effort, TickLimit};
use palpate::math::Vec3;
use palpate::patch::Patch as _;
use palpate::scene::{Limits, Motion, Scene};
use palpate::servo::SoftBody;
use palpate::track::Placement;
use palpate_bake::source::{Origin, body_source};
use palpate_bake::{BakedBody, Model};
use palpate_sim::devices::preset::Limits as DeviceLimits;
use palpate_sim::scene::{SceneFile, Shape, source};
use std::path::Path;

/// Points of a face along either parameter, from which its box is taken.
const GRID: usize = 24;
/// Seconds at which a body on a path is drawn, beside the start.
const DRAWN_AT: [f32; 2] = [1.0, 2.0];
/// The same where it is only asked whether a hand reaches the body.
const COARSE: usize = 8;
/// How often a second a body on a path is looked at, and how many times.
const LOOK_RATE: f32 = 13.0;
/// See [`LOOK_RATE`].
const LOOKS: u32 = 260;
/// By how much two boxes overlap at least, metres: bodies may lie side by side.
const APART: f64 = 1e-4;
/// How far into the highest top the hand's level is, metres: it reaches for the tops of all.
const REACH: f64 = 0.004;

/// A scene as a surface. It lives as long as the program, as other surfaces do.
#[derive(Debug)]
pub struct FeltScene {
    file: SceneFile,
    bodies: Vec<(&'static Body<'static>, Shape)>,
    /// Of each body; none of a rigid one.
    modes: Vec<SoftModes>,
    tables: Vec<String>,
    sources: Vec<Source>,
}

/// The source of a body, and the baked result.
#[derive(Debug)]
struct Source {
    digest: [u8; 32],
    model: Model,
    baked: BakedBody,
}

impl FeltScene {
    /// Reads a scene file, and bakes its bodies.
    ///
    /// # Errors
    /// A fault of the file, or of one of its models.
    pub fn read(from: &ModelFile, path: &Path) -> anyhow::Result<Self> {
        let file = SceneFile::read(&from.text).with_context(|| from.label.clone())?;
        let (mut bodies, mut modes, mut tables, mut sources) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let folder = path.parent().unwrap_or(Path::new(""));
        for entry in &file.body {
            // From the scene's own folder, or one that ships.
            let beside = folder.join(&entry.model);
            let named = if beside.is_file() { beside } else { entry.model.clone().into() };
            let of_body = || format!("{}: body {:?}", from.label, entry.name);
            let model_file = ModelFile::read(&named).with_context(of_body)?;
            let model = model_file.model()?;
            let deforms = entry.modes.as_ref().map(|modes| SoftModes::read(&folder.join(modes), &model));
            let deforms = deforms.transpose().with_context(of_body)?.unwrap_or_default();
            let baked: BakedBody = model_file.body(&model)?;
            let options = baked.locator_options();
            let bar = progress::work();
            let progress = |done, all| bar.tell("cells of space", done, all);
            let baked = model_file.located(baked, &options, None, &progress)?;
            drop(bar);
            let origin = Origin {
                model_file: &model_file.name,
                out_file: "body.rs",
                model: model_file.bytes(),
                centre: model.centre,
                limit: TickLimit::BENCH,
            };
            let mut table = body_source(&origin, &baked, &baked.labels(&model))?;
            if entry.modes.is_some() {
                table += &deforms.tables()?;
            }
            tables.push(table);
            // That of the emulated boards, whose loop this is.
            let body: &'static Body<'static> = Box::leak(Box::new(baked.to_body()?.with_effort(Effort::ONE)));
            bodies.push((body, shape(body, model.centre, deforms.motion())));
            modes.push(deforms);
            sources.push(Source { digest: model_file.digest(), model, baked });
        }
        Ok(Self { file, bodies, modes, tables, sources })
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.file.name
    }

    /// How many bodies it has.
    pub fn count(&self) -> usize {
        self.bodies.len()
    }

    /// The limits of the scene on a device, at a servo rate, Hz.
    pub fn limits(device: DeviceLimits, max_force: f32, rate: f32) -> Limits {
        let DeviceLimits { force, stiffness, damping } = device;
        let max_force = if max_force < force { max_force } else { force };
        Limits {
            max_stiffness_n_per_m: stiffness,
            max_damping_n_s_per_m: damping,
            max_force_n: max_force,
            release_n_per_s: 20.0 * max_force,
            rate_hz: rate,
            max_speed_m_per_s: 2.0,
        }
    }

    /// Whether a body of it deforms.
    pub fn is_soft(&self) -> bool {
        self.file.is_soft()
    }

    /// The scene, of `N` bodies that deform or have no modes.
    ///
    /// # Errors
    /// The library's refusal.
    pub fn soft_scene<const N: usize>(
        &self,
        limits: Limits,
    ) -> anyhow::Result<&'static Scene<'static, SoftBody<'static>, N>> {
        let each = self.bodies.iter().zip(&self.modes).zip(&self.file.body);
        let soft = each.map(|(((body, shape), modes), entry)| {
            let body = modes.on(body, limits.rate_hz).with_context(|| format!("body {:?}", entry.name))?;
            anyhow::Ok((body, *shape))
        });
        Ok(Box::leak(Box::new(self.file.scene(limits, &soft.collect::<anyhow::Result<Vec<_>>>()?)?)))
    }

    /// The scene, of `N` rigid bodies.
    ///
    /// # Errors
    /// The library's refusal.
    pub fn scene<const N: usize>(&self, limits: Limits) -> anyhow::Result<&'static Scene<'static, Body<'static>, N>> {
        Ok(Box::leak(Box::new(self.file.scene(limits, &self.bodies)?)))
    }

    /// As Rust source.
    ///
    /// # Errors
    /// The refusal that the library would give at compile time.
    pub fn source(&self, limits: Limits) -> anyhow::Result<String> {
        Ok(source(&self.file, limits, &self.bodies, &self.tables))
    }

    /// Its part of a recording: each body once, and the scene of them.
    ///
    /// # Errors
    /// A bug of the baker.
    pub fn recorded(&self, limits: Limits) -> anyhow::Result<(Vec<RecordedBody>, Option<RecordedScene>)> {
        let (mut bodies, mut which) = (Vec::<RecordedBody>::new(), Vec::new());
        for Source { digest, model, baked } in &self.sources {
            let body = RecordedBody::new(&model.name, &palpate_bake::file::write(*digest, model, baked)?);
            let index = bodies.iter().position(|other| *other == body).unwrap_or(bodies.len());
            if index == bodies.len() {
                bodies.push(body);
            }
            which.push(index as u32);
        }
        let numbers = self.file.numbers(limits, &self.bodies, &which);
        let names = self.file.body.iter().map(|entry| entry.name.clone());
        Ok((bodies, Some(RecordedScene::new(&numbers, names))))
    }

    /// The bodies as nets of lines: where they start, and on their way.
    pub fn nets(&self, rate: f32) -> Vec<Vec<(f64, f64)>> {
        let parts = self.file.parts(rate, &self.bodies);
        let mut nets = Vec::new();
        for (part, (entry, (body, shape))) in parts.iter().zip(self.file.body.iter().zip(&self.bodies)) {
            let mut places = vec![entry.placement(shape)];
            if let Motion::Prescribed(path) = &part.motion {
                places.extend(DRAWN_AT.map(|seconds| path.at((seconds * rate) as u32)));
            }
            for place in places {
                let point = |patch: usize, u, v| place.point_to_a(body.faces()[patch].patch.evaluate(u, v).point);
                let faces = 0..body.faces().len();
                nets.extend(faces.flat_map(|face| View::FRONT_RIGHT.net_of(|u, v| point(face, u, v).as_dvec3())));
            }
        }
        nets
    }

    /// Stiffness and damping of each body, in words.
    pub fn walls(&self) -> impl Iterator<Item = String> {
        self.file.body.iter().map(|entry| {
            let most = entry.max_force.map_or_else(String::new, |force| format!(", {force} N at most"));
            format!("{}: {} N/m, {} N·s/m{most}", entry.name, entry.stiffness, entry.damping)
        })
    }

    /// Bodies that no hand reaches on a device, in any of the places where they are looked at, and bodies that overlap
    /// where they start. `origin` is that of the scene in the workspace, metres.
    pub fn remarks(&self, device: &ShippedDevice, origin: DVec3) -> Vec<String> {
        let has_room = has_room(device);
        let mut remarks = Vec::new();
        let parts = self.file.parts(LOOK_RATE, &self.bodies);
        let placed = || self.file.body.iter().zip(&self.bodies);
        for ((entry, (body, shape)), part) in placed().zip(&parts) {
            let reaches =
                |place: Placement| points(body, &place, COARSE).any(|point| has_room((point + origin).to_array()));
            let is_reached = match &part.motion {
                Motion::Prescribed(path) => (0..LOOKS).any(|look| reaches(path.at(look))),
                _ => reaches(entry.placement(shape)),
            };
            if !is_reached {
                remarks.push(format!(
                    "body {:?} is out of the workspace of {}, nobody feels it: change its `at`, or --at of the scene",
                    entry.name, device.name
                ));
            }
        }
        let boxes: Vec<_> = placed().map(|(entry, (body, shape))| bounds(body, &entry.placement(shape))).collect();
        for (index, (low, high)) in boxes.iter().enumerate() {
            for (other, (from, to)) in boxes.iter().enumerate().skip(index + 1) {
                if low.max(*from).cmplt(high.min(*to) - APART).all() {
                    let [one, two] = [index, other].map(|index| &self.file.body[index].name);
                    remarks.push(format!("the boxes around bodies {one:?} and {two:?} overlap: bodies do not collide"));
                }
            }
        }
        remarks
    }

    /// The middle of the box that holds all bodies where they start.
    pub fn middle(&self) -> Vec3 {
        let (low, high) = self.bounds();
        (0.5 * (low + high)).as_vec3()
    }

    /// Where a hand may touch: a level just under the highest top, over all bodies.
    pub fn places(&self) -> impl Fn(f64, f64) -> (DVec3, DVec3) + use<> {
        let (low, high) = self.bounds();
        let size = high - low;
        move |u, v| {
            let at = DVec3::new(low.x + u * size.x, low.y + v * size.y, high.z - REACH);
            (at, DVec3::Z)
        }
    }

    fn bounds(&self) -> (DVec3, DVec3) {
        let placed = self.file.body.iter().zip(&self.bodies);
        placed.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (entry, (body, shape))| {
            let (a, b) = bounds(body, &entry.placement(shape));
            (low.min(a), high.max(b))
        })
    }
}

fn shape(body: &Body<'_>, centre: DVec3, motion: f64) -> Shape {
    let (low, high) = bounds(body, &Placement::IDENTITY);
    Shape { centre, low, high, motion }
}

/// The box of a grid of points on each face.
fn bounds(body: &Body<'_>, place: &Placement) -> (DVec3, DVec3) {
    points(body, place, GRID)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)))
}

/// A grid of points on each face.
fn points(body: &Body<'_>, place: &Placement, grid: usize) -> impl Iterator<Item = DVec3> {
    let at = move |index: usize| index as f32 / grid as f32;
    let each = move || (0..=grid).flat_map(move |i| (0..=grid).map(move |j| (at(i), at(j))));
    body.faces()
        .iter()
        .flat_map(move |face| each().map(move |(u, v)| place.point_to_a(face.patch.evaluate(u, v).point).as_dvec3()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate_sim::devices::named;

    #[test]
    fn a_body_out_of_reach_and_two_at_one_place_are_remarked_on() {
        let device = named("woodenhaptics-2016").expect("it ships");
        let remarks = |text: &str| {
            let file = ModelFile::imported(Path::new("scene.toml"), text.to_owned());
            let scene = FeltScene::read(&file, Path::new("scene.toml")).expect("a scene");
            scene.remarks(device, DVec3::ZERO)
        };
        let body = |name: &str, x: f64| {
            format!(
                "[[body]]\nname = {name:?}\nmodel = \"capped_box\"\nat = [{x:?}, 0, 0]\nstiffness = 400\ndamping = 1\n"
            )
        };
        let scene = |bodies: &[(&str, f64)]| {
            let bodies = bodies.iter().map(|(name, x)| body(name, *x));
            remarks(&format!("name = \"a scene\"\n{}", bodies.collect::<String>()))
        };
        assert_eq!(scene(&[("near", -30.0), ("beside", 60.0)]), [""; 0]);
        let [far] = &scene(&[("near", 0.0), ("far", 900.0)])[..] else { panic!("one remark") };
        assert!(far.contains("\"far\" is out of the workspace"), "{far}");
        let [twice] = &scene(&[("one", 0.0), ("other", 0.0)])[..] else { panic!("one remark") };
        assert!(twice.contains("\"one\" and \"other\" overlap"), "{twice}");
    }
}
