//! Options shared by `demo` and `sim`: the scene, and its set-up from the command line.

use super::felt::Felt;
use super::felt_scene::FeltScene;
use super::smoothing::Smoothing;
use crate::devices::{self, Chosen, Preset, ShippedDevice};
use crate::firmware::Link;
use crate::models::ModelFile;
use crate::page::{Cut, Loop, RecordedBody, Recording};
use crate::shaped::{self, CoreOf, ShapedTool};
use crate::simulation::{HostLoop, Span, Trace};
use anyhow::{Context, anyhow, bail, ensure};
use clap::Args;
use glam::DVec3;
use palpate::body::TickLimit;
use palpate::device::{Device, Kinematics, Mount, Protection};
use palpate::scene::Limits;
use palpate::servo::{Config, Safety, Servo, Settings, SettingsError, Surface};
use palpate::wire::WristSensors;
use palpate_bake::source::Origin;
use palpate_bake::{BakedBody, Model, NurbsPatch};
use palpate_sim::plant::{HandSettings, PathError, Plant, TouchingPath};
use palpate_sim::recorded::Recorded;
use palpate_sim::scene::SceneFile;
use std::path::PathBuf;

/// Servo rates, Hz: the one that a run has unless asked for another, and those it goes down to where a tick takes
/// longer.
pub const RATES: [f32; 4] = [4_000.0, 3_000.0, 2_000.0, 1_000.0];

/// The limits of a loop with a host at its link, which is gone when it is silent for 100 ms.
const SAFETY: Safety = Safety { link_timeout_s: 0.1, ..Safety::DEFAULT };

/// The scene: which surface, which device, how it is to feel, and the hand.
#[derive(Args, Debug, Clone)]
pub struct SceneOptions {
    /// Model: a file, the name of a shipped model, or a scene file (docs/howto/scenes.md)
    #[arg(long, default_value = "capped_box")]
    pub model: PathBuf,
    /// One patch of the model, by name or index; default: all patches as one body
    #[arg(long)]
    pub patch: Option<String>,
    /// Modes file of a body that deforms, as `palpate bake` writes it
    #[arg(long, value_name = "MODES.toml")]
    pub modes: Option<PathBuf>,
    /// Device: a name, or your own file (my.toml); a surface needs three joints
    #[arg(long, value_parser = devices::parser(), default_value = "woodenhaptics-2016")]
    pub device: Chosen,
    /// Servo rate, Hz; default 4,000, or the highest that the emulated board has time for
    #[arg(long)]
    pub rate: Option<f32>,
    /// Simulated time, s
    #[arg(long, default_value_t = 5.0)]
    pub seconds: f64,
    /// Seed of the hand's path
    #[arg(long, default_value_t = 2)]
    pub seed: u64,
    /// Stiffness of the surface, N/m; default: recommended for the device
    #[arg(long)]
    pub stiffness: Option<f32>,
    /// Damping of the surface, N·s/m; default: recommended for the device
    #[arg(long)]
    pub damping: Option<f32>,
    /// Maximum force, N; default: recommended for the device, whose own limit applies too
    #[arg(long)]
    pub max_force: Option<f32>,
    /// Corner frequency of the velocity filter, Hz; default: recommended for the device
    #[arg(long)]
    pub velocity_corner: Option<f32>,
    /// Smoothing: smooth (hides counts, ticks and edges), eased (all but counts), plain (none)
    #[arg(long, value_enum, default_value_t = Smoothing::Smooth)]
    pub rendering: Smoothing,
    /// Soft start: time over which the force fades in, s
    #[arg(long, default_value_t = 0.1)]
    pub soft_start: f32,
    /// All protection of the device: motor heat, speeds, polarity
    #[arg(long)]
    pub protected: bool,
    /// Origin of the model in the workspace: x,y,z in mm from its centre; default: the model is centred
    #[arg(long, value_name = "X,Y,Z", value_parser = millimetres, allow_hyphen_values = true)]
    pub at: Option<DVec3>,
    /// Tool with a shape on a gimbal: point, capsule, segment:H along z or box:X,Y,Z (half lengths, mm)
    #[arg(long, value_parser = shaped::core)]
    pub tool: Option<CoreOf>,
    /// Radius of the ball around the tool's core, mm
    #[arg(long, requires = "tool", default_value_t = 3.0)]
    pub radius: f32,
    /// Maximum speed at which the hand turns the tool, rad/s
    #[arg(long, requires = "tool", default_value_t = 1.5)]
    pub turn: f64,
    /// Coefficient of dry friction between tool and body, 0 to 2
    #[arg(long, default_value_t = 0.0, requires = "tool", value_name = "COEFFICIENT")]
    pub friction: f32,
}

/// A point from `x,y,z` in mm, as metres.
pub(super) fn millimetres(text: &str) -> Result<DVec3, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    numbers
        .and_then(|numbers| <[f64; 3]>::try_from(numbers).ok())
        .map(|numbers| DVec3::from_array(numbers) * 1e-3)
        .filter(|point| point.is_finite())
        .ok_or_else(|| "not three numbers: x,y,z in mm".to_owned())
}

/// A scene that is ready to run.
pub struct Scene {
    /// The model file.
    file: ModelFile,
    /// Where the frame of its tables lies in the model, metres.
    pub centre: DVec3,
    /// The surface.
    pub felt: Felt,
    /// The device.
    pub device: &'static ShippedDevice,
    /// The loop's settings.
    pub settings: Settings,
    /// How the surface feels.
    pub rendering: Smoothing,
    /// The device's protection, if it was requested.
    pub protection: Option<Protection<3>>,
    /// The tool, if it has a shape.
    pub tool: Option<ShapedTool>,
    /// Ticks to run.
    pub ticks: u32,
    /// The tick at which force is asked for: the witness point has converged by then.
    pub enable_at: u32,
}

impl SceneOptions {
    /// Reads the model and checks every option.
    ///
    /// # Errors
    /// The invalid file or option, by name.
    pub fn scene(&self) -> anyhow::Result<Scene> {
        let file = ModelFile::read(&self.model)?;
        let is_scene = SceneFile::is_one(&file.text);
        let (felt, centre) = if is_scene {
            if self.patch.is_some() {
                bail!("--patch applies to models; {} is a scene", file.label);
            }
            ensure!(
                self.modes.is_none(),
                "--modes applies to models; {} is a scene, whose bodies name theirs",
                file.label
            );
            (Felt::Scene(FeltScene::read(&file, &self.model)?), DVec3::ZERO)
        } else {
            let model = file.model()?;
            (Felt::read(&model, &file, &self.model, self.patch.as_deref(), self.modes.as_deref())?, model.centre)
        };
        let body_origin = self.at.map_or_else(|| -felt.middle(), |at| (at + centre).as_vec3());
        let Chosen::Arm(device) = self.device else {
            bail!(
                "--device knob: this command renders a surface, and a knob has none; use `palpate demo --device knob`, or \
                 `palpate talk --device knob --emulator m4` and there `watch`"
            )
        };
        if device.source.is_none() {
            bail!("{} has too few joints to feel a surface in space; see zwidth", device.name);
        }
        let recommended = device.recommended().settings;
        let settings = Settings {
            rate_hz: self.rate.unwrap_or(RATES[0]),
            stiffness_n_per_m: self.stiffness.unwrap_or(recommended.stiffness_n_per_m),
            damping_n_s_per_m: self.damping.unwrap_or(recommended.damping_n_s_per_m),
            max_force_n: self.max_force.unwrap_or(recommended.max_force_n),
            velocity_corner_hz: self.velocity_corner.unwrap_or(recommended.velocity_corner_hz),
            soft_start_s: self.soft_start,
            body_origin_m: body_origin,
        };
        check(&settings, device)?;
        let [ticks, enable_at] = self.ticks(settings.rate_hz)?;
        let protection = self.protected.then(|| device.protection());
        let tool = self.tool.map(|core| ShapedTool::new(core, self.radius, self.turn, self.friction)).transpose()?;
        if tool.is_some() {
            felt.rigid_body()?;
        }
        if let Felt::Scene(scene) = &felt {
            for remark in scene.remarks(device, body_origin.as_dvec3()) {
                eprintln!("{}: {remark}", file.label);
            }
        }
        if let Some(warning) = protection.and_then(|_| weak_pulses(device, settings.rate_hz, settings.max_force_n)) {
            eprintln!("warning: polarity check: {warning}");
        }
        let rendering = self.rendering;
        Ok(Scene { file, centre, felt, device, settings, rendering, protection, tool, ticks, enable_at })
    }

    /// How many ticks to run at a rate, Hz, and at which of them force is asked for.
    fn ticks(&self, rate: f32) -> anyhow::Result<[u32; 2]> {
        let ticks = self.seconds * f64::from(rate);
        if !(ticks >= 1.0 && ticks <= f64::from(u32::MAX)) {
            bail!("--seconds {} at --rate {rate} is not a number of ticks that can be run", self.seconds);
        }
        // A tenth of a second in standby, in which the witness point converges from the middle of the patch.
        Ok([ticks as u32, (0.1 * rate) as u32])
    }

    /// Takes a scene to another rate, Hz.
    ///
    /// # Errors
    /// If that is no number of ticks that can be run.
    pub fn change_rate(&self, scene: &mut Scene, rate: f32) -> anyhow::Result<()> {
        [scene.ticks, scene.enable_at] = self.ticks(rate)?;
        scene.settings.rate_hz = rate;
        Ok(())
    }

    /// The simulated device with a hand that touches the scene's surface.
    ///
    /// # Errors
    /// The plant's refusal.
    pub fn plant(&self, scene: &Scene) -> anyhow::Result<Plant> {
        let places = scene.felt.places();
        let origin = scene.settings.body_origin_m.as_dvec3();
        let stand_off = scene.tool.map_or(0.0, |tool| tool.stand_off_m());
        let point_and_normal = move |u, v| {
            let (point, normal) = places(u, v);
            ((point + normal * stand_off + origin).to_array(), normal.to_array())
        };
        let path = path_over(scene.device, (point_and_normal, origin - scene.centre), self.seconds, self.seed)?;
        Plant::new(&scene.device.plant, HandSettings::default(), Box::new(path), f64::from(scene.settings.rate_hz))
            .context("the simulated device cannot start here (move the model with --at)")
    }
}

/// Refuses settings beyond a device's limits.
pub(super) fn check(settings: &Settings, device: &ShippedDevice) -> anyhow::Result<()> {
    let (limits, name) = (device.preset.limits(), device.name);
    settings.check(limits.stiffness, limits.damping).map_err(|error| match error {
        SettingsError::Stiffness => {
            anyhow!("--stiffness {}: {name} takes 0 to {} N/m", settings.stiffness_n_per_m, limits.stiffness)
        }
        SettingsError::Damping => {
            anyhow!("--damping {}: {name} takes 0 to {} N·s/m", settings.damping_n_s_per_m, limits.damping)
        }
        error => anyhow!("{name}: {error}"),
    })
}

/// Whether a place, metres, is in the workspace of a device.
pub(super) fn has_room(device: &ShippedDevice) -> impl Fn([f64; 3]) -> bool + use<> {
    let (mechanism, preset) = (device.plant.mechanism(0.0), device.preset);
    move |place| mechanism.angles(place).is_some_and(|angles| preset.room(angles) > 0.0)
}

/// The joints of a protected device whose polarity pulses are too weak at a maximum force, N, and the force that they
/// need, as a warning.
pub(super) fn weak_pulses(device: &ShippedDevice, rate: f32, max_force: f32) -> Option<String> {
    // The loop's force is at most the device's.
    let max_force = max_force.min(device.preset.limits().force);
    let angles = device.plant.mechanism(0.0).angles([0.0; 3])?;
    let needed = device.preset.min_force_n(&device.protection().polarity?, rate, angles)?;
    let each = device.joint_names().into_iter().zip(needed).filter(|(_, needed)| *needed > max_force);
    let each = each.map(|(joint, needed)| {
        if needed.is_finite() {
            format!("joint {joint} needs max_force {:.1} N", (needed * 10.0).ceil() / 10.0)
        } else {
            format!("joint {joint} needs an encoder with more counts")
        }
    });
    let each = each.collect::<Vec<_>>().join(", ");
    (!each.is_empty()).then(|| {
        format!(
            "its pulses, a quarter of max_force, are too weak at {max_force} N: {each} (in the middle of the workspace); \
             the force stays withheld"
        )
    })
}

/// The height of the table, m above the centre of the workspace, under an arm whose file states that of its base.
fn table_height(device: &ShippedDevice) -> Option<f64> {
    let Preset::SerialArm(device) = device.preset else { return None };
    let arm = &device.kinematics;
    (arm.base_height_m > 0.0).then_some(-f64::from(arm.workspace_centre_m.z))
}

/// The path of a hand over a surface that lies in the workspace of a device, as `at` has it: point and normal, metres.
/// Where the surface is larger than the workspace, the hand keeps to the middle of the surface.
///
/// # Errors
/// A surface that the hand does not reach, or that lies below the table: with the nearest place, beside `place`, m,
/// where the hand reaches it.
pub(super) fn path_over(
    device: &ShippedDevice,
    (at, place): (impl Fn(f64, f64) -> ([f64; 3], [f64; 3]), DVec3),
    seconds: f64,
    seed: u64,
) -> anyhow::Result<TouchingPath> {
    let share = |number: u8| f64::from(number % 9) / 8.0;
    let points: Vec<_> = (0..81).map(|number| DVec3::from_array(at(share(number), share(number / 9)).0)).collect();
    let (name, has_room) = (device.name, has_room(device));
    let is_above =
        |by: DVec3| table_height(device).is_none_or(|table| points.iter().any(|point| point.z + by.z >= table));
    let path = |by: DVec3, seconds: f64| {
        let moved = |u, v| {
            let (point, normal) = at(u, v);
            ((DVec3::from_array(point) + by).to_array(), normal)
        };
        TouchingPath::within(moved, seconds, seed, &has_room)
    };
    let refused = if is_above(DVec3::ZERO) {
        match path(DVec3::ZERO, seconds) {
            Ok(path) => return Ok(path),
            Err(PathError::NoRoom) => {
                let inside = points.iter().filter(|point| has_room(point.to_array())).count();
                format!("{}; of the surface itself it holds {} %", PathError::NoRoom, 100 * inside / points.len())
            }
            Err(error) => bail!("{name}: {error}; render one patch (--patch), or try another --seed"),
        }
    } else {
        let table = table_height(device).unwrap_or_default();
        format!("the whole surface lies below the table, {:.0} mm under the centre of the workspace", -1e3 * table)
    };
    let corner = |of: fn(DVec3, DVec3) -> DVec3| points.iter().copied().reduce(of).unwrap_or_default();
    let middle = 0.5 * (corner(DVec3::min) + corner(DVec3::max));
    let nearest = nearest(place, middle, |by, most| is_above(by) && path(by, seconds.min(most)).is_ok());
    let remedy = nearest.map_or_else(
        || "the middle of the workspace is too small for it too; take a smaller model, or".to_owned(),
        |at| {
            let [x, y, z] = (at * 1e3).to_array();
            format!("the nearest place towards the centre is --at {x:.0},{y:.0},{z:.0}; or")
        },
    );
    bail!(
        "{name}: {refused}: {remedy} move the workspace by the device file: `workspace_centre` (of a delta \
         `workspace_depth`), each joint's `range`, or a lower `min_margin`"
    )
}

/// The first place on the way from `place` that takes the surface's middle to that of the workspace, in whole mm, m,
/// whose displacement is accepted for paths of any length, s.
fn nearest(place: DVec3, middle: DVec3, accepts: impl Fn(DVec3, f64) -> bool) -> Option<DVec3> {
    let at = |step: u8| ((place - f64::from(step) / 32.0 * middle) * 1e3).round() * 1e-3 + DVec3::ZERO;
    // By a short path first: a long one takes long to find.
    let (mut refused, mut accepted) = (0, 32);
    while accepted - refused > 1 {
        let between = u8::midpoint(refused, accepted);
        let side = if accepts(at(between) - place, 2.0) { &mut accepted } else { &mut refused };
        *side = between;
    }
    (accepted..=32).map(at).find(|at| accepts(*at - place, f64::INFINITY))
}

impl Scene {
    /// The servo loop of this scene, compiled for the host.
    ///
    /// # Errors
    /// A setting that is refused.
    pub fn host_loop(&self) -> anyhow::Result<Box<dyn Link>> {
        match self.device.preset {
            Preset::SerialArm(device) => self.host_loop_of(device),
            Preset::LinkageArm(device) => self.host_loop_of(device),
            Preset::Delta(device) => self.host_loop_of(device),
            Preset::FiveBar(_) | Preset::Paddle(_) => bail!("{} has too few joints", self.device.name),
        }
    }

    fn host_loop_of<K: Mount<3>>(&self, device: &'static Device<K, 3>) -> anyhow::Result<Box<dyn Link>> {
        if let Some(tool) = self.tool {
            let surface = tool.on(self.felt.rigid_body()?, &self.settings)?;
            let config = self.config();
            return Ok(match self.protection {
                None => Box::new(HostLoop::<_, _, _, WristSensors>::new(Servo::try_new(device, surface, config)?)),
                Some(protection) => Box::new(HostLoop::<_, _, _, WristSensors>::new(Servo::try_protected(
                    device, surface, protection, config,
                )?)),
            });
        }
        match &self.felt {
            Felt::Patch { patch, .. } => self.host_loop_on(device, *patch),
            Felt::Body { body, soft: Some(soft), .. } => {
                self.host_loop_on(device, soft.on(body, self.settings.rate_hz)?)
            }
            Felt::Body { body, soft: None, .. } => self.host_loop_on(device, *body),
            Felt::Scene(scene) => match scene.count() {
                1 => self.host_loop_in::<1, K>(device, scene),
                2 => self.host_loop_in::<2, K>(device, scene),
                3 => self.host_loop_in::<3, K>(device, scene),
                4 => self.host_loop_in::<4, K>(device, scene),
                5 => self.host_loop_in::<5, K>(device, scene),
                6 => self.host_loop_in::<6, K>(device, scene),
                7 => self.host_loop_in::<7, K>(device, scene),
                _ => self.host_loop_in::<{ palpate_sim::scene::MAX_BODIES }, K>(device, scene),
            },
        }
    }

    fn host_loop_in<const N: usize, K: Kinematics<3>>(
        &self,
        device: &'static Device<K, 3>,
        scene: &FeltScene,
    ) -> anyhow::Result<Box<dyn Link>> {
        if scene.is_soft() {
            self.host_loop_on(device, scene.soft_scene::<N>(self.limits())?)
        } else {
            self.host_loop_on(device, scene.scene::<N>(self.limits())?)
        }
    }

    fn host_loop_on<K: Kinematics<3>, S: Surface>(
        &self,
        device: &'static Device<K, 3>,
        surface: &'static S,
    ) -> anyhow::Result<Box<dyn Link>> {
        let config = self.config();
        Ok(match self.protection {
            None => Box::new(HostLoop::<_, _>::new(Servo::try_new(device, surface, config)?)),
            Some(protection) => {
                Box::new(HostLoop::<_, _, _>::new(Servo::try_protected(device, surface, protection, config)?))
            }
        })
    }

    fn config(&self) -> Config<3> {
        let rendering = self.rendering.rendering();
        Config { settings: self.settings, rendering, safety: SAFETY, ..Config::DEFAULT }
    }

    /// How long it runs, and how the hand turns the tool.
    pub fn span(&self) -> Span {
        let rate = f64::from(self.settings.rate_hz);
        Span { rate, ticks: self.ticks, enable_at: self.enable_at, tool: self.tool }
    }

    /// A run of the scene as the page for the browser takes it.
    ///
    /// # Errors
    /// Why the page could not feel it.
    pub fn recording(&self, trace: &Trace, on: &str) -> anyhow::Result<Recording> {
        self.check_recordable()?;
        let (bodies, scene) = match &self.felt {
            Felt::Scene(scene) => scene.recorded(self.limits())?,
            Felt::Body { baked, .. } => (vec![self.recorded_body(&self.file.model()?, baked)?], None),
            Felt::Patch { surface, .. } => (vec![self.recorded_patch(surface)?], None),
        };
        let of = Loop {
            model: self.model_name(),
            bodies,
            scene,
            device: self.device.name,
            numbers: &self.recorded_device()?,
            settings: &self.settings,
            rendering: self.rendering.name(),
            link_timeout: SAFETY.link_timeout_s,
            enable_at: self.enable_at,
        };
        Ok(Recording::new(trace, on, of))
    }

    /// Refuses a recording of a scene before it is run.
    ///
    /// # Errors
    /// Why the page could not feel it.
    pub fn check_recordable(&self) -> anyhow::Result<()> {
        match &self.felt {
            _ if self.tool.is_some() => Err(Cut::Tool.into()),
            Felt::Scene(scene) if scene.is_soft() => Err(Cut::Soft.into()),
            Felt::Body { soft: Some(_), .. } => Err(Cut::Soft.into()),
            Felt::Patch { surface, .. } => self.patch_alone(surface).map(drop),
            _ => Ok(()),
        }
    }

    fn recorded_body(&self, model: &Model, baked: &BakedBody) -> anyhow::Result<RecordedBody> {
        let name = model.name.as_str();
        Ok(RecordedBody::new(name, &palpate_bake::file::write(self.file.digest(), model, baked)?))
    }

    /// The patch as a body of its own.
    fn patch_alone(&self, surface: &NurbsPatch) -> anyhow::Result<(Model, BakedBody)> {
        let whole = self.file.model()?;
        let name = surface.name.clone().filter(|_| whole.patches.len() > 1).unwrap_or_else(|| whole.name.clone());
        let model = Model { patches: vec![surface.clone()], name, ..whole };
        let body = BakedBody::new(&model, &self.file.label)?;
        ensure!(body.faces.len() == 1, Cut::Pieces(body.faces.len()));
        Ok((model, body))
    }

    fn recorded_patch(&self, surface: &NurbsPatch) -> anyhow::Result<RecordedBody> {
        let (model, body) = self.patch_alone(surface)?;
        let options = body.locator_options();
        let (body, _) = body.located(&options, &|_, _| {})?;
        self.recorded_body(&model, &body)
    }

    fn recorded_device(&self) -> anyhow::Result<Recorded> {
        Ok(match self.device.preset {
            Preset::SerialArm(device) => Recorded::new(device, self.protection),
            Preset::LinkageArm(device) => Recorded::new(device, self.protection),
            Preset::Delta(device) => Recorded::new(device, self.protection),
            Preset::FiveBar(_) | Preset::Paddle(_) => return Err(Cut::Joints(self.device.name).into()),
        })
    }

    /// The limits of the bodies of a scene on this device.
    fn limits(&self) -> Limits {
        FeltScene::limits(self.device.preset.limits(), self.settings.max_force_n, self.settings.rate_hz)
    }

    /// The surface as the source file that an image is built with.
    ///
    /// # Errors
    /// The library's refusal, or a bug of the baker.
    pub fn source(&self) -> anyhow::Result<String> {
        // What would not compile is said here.
        self.host_loop()?;
        let body = self.felt.source(&self.origin(), self.limits(), self.settings.rate_hz)?;
        Ok(self.tool.map_or_else(|| body.clone(), |tool| tool.source(&body, &self.settings)))
    }

    /// The middle of the model's box in the frame of its tables, and how far beyond it the path of an image that counts
    /// goes, as source.
    ///
    /// # Errors
    /// A model that cannot be read.
    pub fn around(&self) -> anyhow::Result<String> {
        let model = self.file.model()?;
        let points = || model.patches.iter().flat_map(|patch| &patch.points).map(|point| *point - self.centre);
        let low = points().fold(DVec3::INFINITY, DVec3::min);
        let high = points().fold(DVec3::NEG_INFINITY, DVec3::max);
        let [middle, half] = [(low + high) / 2.0, 1.3 * (high - low) / 2.0].map(|v| v.as_vec3().to_array());
        let vector = |[x, y, z]: [f32; 3]| format!("palpate::math::vec3({x:?}, {y:?}, {z:?})");
        Ok(format!(
            "/// The middle of the path, and how far it goes.\npub const AROUND: [palpate::math::Vec3; 2] = [{}, {}];\n",
            vector(middle),
            vector(half)
        ))
    }

    /// The settings of the surface, or of each body of a scene: names and words.
    pub fn walls(&self) -> Vec<(&'static str, String)> {
        let Settings { stiffness_n_per_m, damping_n_s_per_m, max_force_n, .. } = self.settings;
        let tool = self.tool.map_or_else(String::new, |tool| format!("; {}", tool.name()));
        let all = format!("{max_force_n} N at most, {}{tool}", self.rendering.name());
        match &self.felt {
            Felt::Scene(scene) => scene.walls().map(|wall| ("body", wall)).chain([("all bodies", all)]).collect(),
            _ => vec![("wall", format!("{stiffness_n_per_m} N/m, {damping_n_s_per_m} N·s/m, {all}"))],
        }
    }

    /// The time, s, from which on the polarity check withholds no force of a run; `None` without a check, infinite where
    /// a joint stays unconfirmed.
    pub fn withheld_until(&self, trace: &Trace) -> Option<f64> {
        self.protection?.polarity?;
        let confirmed = trace.confirmed?;
        Some(confirmed.into_iter().map(|when| when.unwrap_or(f64::INFINITY)).fold(0.0, f64::max))
    }

    /// For how long the polarity check withheld the force of a run, and when each joint was confirmed, in words.
    pub fn withheld(&self, trace: &Trace) -> Option<(&'static str, String)> {
        let last = self.withheld_until(trace)?;
        let asked = f64::from(self.enable_at) / trace.rate;
        let each = trace.confirmed?.into_iter().zip(self.device.joint_names()).map(|(when, joint)| match when {
            Some(when) => format!("{joint} confirmed after {:.2} s", when - asked),
            None => format!("{joint} not confirmed"),
        });
        let each = each.collect::<Vec<_>>().join(", ");
        let until = last.min(trace.samples.len() as f64 / trace.rate).max(asked) - asked;
        let weak = weak_pulses(self.device, self.settings.rate_hz, self.settings.max_force_n);
        let remedy = if last.is_finite() {
            ""
        } else if let Some(weak) = &weak {
            &format!(", to the end: {weak}")
        } else {
            ", to the end: a joint is confirmed while the probe presses on the surface, and gravity compensation is \
             withheld too, so the links hang from the hand; a longer run (--seconds), another place (--at), or without \
             --protected"
        };
        Some(("polarity check", format!("{each}; force withheld for {until:.2} s{remedy}")))
    }

    /// The model file's name, without its directory.
    pub fn model_name(&self) -> &str {
        &self.file.name
    }

    /// Where the scene's tables come from.
    pub fn origin(&self) -> Origin<'_> {
        Origin {
            model_file: &self.file.name,
            out_file: "body.rs",
            model: self.file.bytes(),
            centre: self.centre,
            limit: TickLimit::BENCH,
        }
    }

    /// The loop's settings and device as the source file that an image is built with. Every number reads back as the
    /// same `f32`.
    pub fn settings_source(&self) -> String {
        let Settings {
            rate_hz: rate,
            stiffness_n_per_m: stiffness,
            damping_n_s_per_m: damping,
            max_force_n: max_force,
            velocity_corner_hz: velocity_corner,
            soft_start_s: soft_start,
            body_origin_m: body_origin,
        } = self.settings;
        let [x, y, z] = body_origin.to_array();
        let link_timeout = SAFETY.link_timeout_s;
        // A scene has three joints.
        let [mechanism, device] = self.device.source.unwrap_or_default();
        let shipped = format!(
            "pub use palpate::device::{{{mechanism} as Mechanism, presets::{device} as DEVICE, presets::{device}_PROTECTION as PROTECTION}};\n\
             /// Each joint on the input and the output of its number.\n\
             pub const WIRING: palpate::commission::Wiring<3> = palpate::commission::Wiring::STRAIGHT;"
        );
        let constants = self.device.constants.map_or(shipped.as_str(), |(source, ..)| source);
        let wrist = self.tool.map_or_else(String::new, |_| shaped::wrist_source());
        format!(
            "{constants}\n{wrist}/// The loop's settings.\npub const SETTINGS: palpate::servo::Settings = palpate::servo::Settings {{\n    \
             rate_hz: {rate:?},\n    stiffness_n_per_m: {stiffness:?},\n    damping_n_s_per_m: {damping:?},\n    \
             max_force_n: {max_force:?},\n    velocity_corner_hz: {velocity_corner:?},\n    \
             soft_start_s: {soft_start:?},\n    body_origin_m: palpate::math::vec3({x:?}, {y:?}, {z:?}),\n}};\n/// Its limits.\n\
             pub const SAFETY: palpate::servo::Safety =\n    palpate::servo::Safety {{ link_timeout_s: {link_timeout:?}, ..palpate::servo::Safety::DEFAULT }};\n\
             /// How the surface feels.\npub const RENDERING: palpate::servo::Rendering = {};\n",
            self.rendering.source()
        )
    }
}
