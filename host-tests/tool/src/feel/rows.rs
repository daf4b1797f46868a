//! Every script on a device.

use crate::devices::ShippedDevice;
use anyhow::Context;
use palpate::body::Body;
use palpate::device::{Device, Encoder, Kinematics};
use palpate::math::Vec3;
use palpate::render::{Friction, Material};
use palpate::servo::{Config, Rendering, Servo, Settings, SoftBody, Surface};
use palpate_sim::devices::preset::Preset;
use palpate_sim::feel::{Deed, Figures, Script, Sensation, Stage, Threshold, over_edges, record, wall};
use palpate_sim::plant::{HandSettings, PlantSettings};
use palpate_sim::zwidth::Slice;

/// Friction of the wall where the hand pulls on the verge of slipping.
const FRICTION: Friction = Material::WOOD.friction;
/// Factors of finer encoders to try where a slide is perceptible.
const FINER: [f64; 6] = [2.0, 4.0, 8.0, 16.0, 32.0, 64.0];

/// Steps of integration in a second, and at least in a period: the simulated device is the same at every rate.
const SUB_STEPS_A_SECOND: f64 = 80_000.0;
const LEAST_SUB_STEPS: u32 = 8;

/// The wished surface.
#[derive(Clone, Copy, Debug)]
pub struct Wish {
    /// Servo rate, Hz.
    pub rate: f32,
    /// N/m; no more than the device takes.
    pub stiffness: f32,
    /// N·s/m; no more than the device takes.
    pub damping: f32,
    /// Corner of the velocity estimator, Hz.
    pub corner: f32,
    /// Everything else of the force.
    pub rendering: Rendering,
}

impl Wish {
    /// The loop's settings on a device.
    pub fn settings(&self, device: &ShippedDevice) -> Settings {
        let (wished, limits) = (self.wished(device), device.preset.limits());
        Settings {
            stiffness_n_per_m: wished.stiffness_n_per_m.min(limits.stiffness),
            damping_n_s_per_m: wished.damping_n_s_per_m.min(limits.damping),
            ..wished
        }
    }

    /// The same as wished, even beyond the device's limits.
    pub fn wished(&self, device: &ShippedDevice) -> Settings {
        Settings {
            rate_hz: self.rate,
            stiffness_n_per_m: self.stiffness,
            damping_n_s_per_m: self.damping,
            max_force_n: device.preset.limits().force,
            velocity_corner_hz: self.corner,
            soft_start_s: 0.1,
            body_origin_m: Vec3::ZERO,
        }
    }
}

/// A script on a device.
#[derive(Clone, Debug)]
pub struct Row {
    /// The script.
    pub script: Script,
    /// The figures at the hand.
    pub figures: Figures,
    /// By how much the mean force differs from stiffness times depth, as a share of it; of the loop's own depth.
    pub force_error: Option<f64>,
    /// Over how much travel the direction turned, m.
    pub turn: Option<f64>,
    /// For a perceptible slide: the factor by which the encoders must be finer to hide it; infinite if none of the
    /// tried ones is enough.
    pub finer: Option<f64>,
    /// Contacts that the loop released.
    pub contacts_lost: u32,
}

/// A body whose edges are crossed.
#[derive(Clone, Copy, Debug)]
pub struct Crossed<'a> {
    /// At rest.
    pub body: &'a Body<'a>,
    /// With its modes, if it deforms, for a loop of the wished rate.
    pub soft: Option<&'a SoftBody<'a>>,
    /// Where it lies, metres.
    pub origin: Vec3,
}

/// All scripts on a device; on a body only with three joints.
///
/// # Errors
/// Settings that are refused, a start out of reach, a fault of the loop.
pub fn rows(
    device: &ShippedDevice,
    body: Option<Crossed<'_>>,
    wish: &Wish,
    threshold: &Threshold,
) -> anyhow::Result<Vec<Row>> {
    let bench = Bench { shipped: device, wish, threshold, settings: wish.settings(device) };
    let rows = match device.preset {
        Preset::SerialArm(arm) => bench.in_space(arm, body),
        Preset::LinkageArm(arm) => bench.in_space(arm, body),
        Preset::Delta(delta) => bench.in_space(delta, body),
        Preset::FiveBar(five_bar) => bench.on_the_wall(five_bar),
        Preset::Paddle(paddle) => bench.on_the_wall(paddle),
    };
    rows.with_context(|| device.name.to_owned())
}

/// The perception of a firm slide on a wall of the wished stiffness, even beyond the device's recommendation, with
/// encoders finer than its own by a factor. With one joint there is no slide, and no perception of it.
///
/// # Errors
/// Settings that are refused, a start out of reach, a fault of the loop.
pub fn slide(device: &ShippedDevice, wish: &Wish, finer: f64, threshold: &Threshold) -> anyhow::Result<Sensation> {
    let settings = Settings { stiffness_n_per_m: wish.stiffness, ..wish.settings(device) };
    let bench = Bench { shipped: device, wish, threshold, settings };
    match device.preset {
        Preset::SerialArm(arm) => bench.slide(arm, finer),
        Preset::LinkageArm(arm) => bench.slide(arm, finer),
        Preset::Delta(delta) => bench.slide(delta, finer),
        Preset::FiveBar(five_bar) => bench.slide(five_bar, finer),
        Preset::Paddle(paddle) => bench.slide(paddle, finer),
    }
}

/// A device and its simulated other half with encoders finer by a factor.
fn with_finer<K: Kinematics<JOINTS> + Copy, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    plant: &PlantSettings,
    factor: f64,
) -> (Device<K, JOINTS>, PlantSettings) {
    let mut plant = *plant;
    plant.joints.iter_mut().for_each(|joint| joint.counts_per_turn *= factor);
    let encoders = device.encoders.map(|Encoder { radians_per_count, angle_at_zero_rad: angle_at_zero }| {
        Encoder::new(radians_per_count / factor as f32, angle_at_zero - 0.5 * radians_per_count)
    });
    (Device { encoders, ..*device }, plant)
}

struct Bench<'a> {
    shipped: &'a ShippedDevice,
    wish: &'a Wish,
    threshold: &'a Threshold,
    settings: Settings,
}

impl Bench<'_> {
    fn stage(&self, joints: usize) -> Stage {
        Stage {
            joints,
            stiffness: f64::from(self.settings.stiffness_n_per_m),
            hand: HandSettings::default().stiffness,
            dry: Slice::of(self.shipped).coulomb,
            max_force: f64::from(self.settings.max_force_n),
        }
    }

    fn in_space<K: Kinematics<3> + Copy>(
        &self,
        device: &Device<K, 3>,
        body: Option<Crossed<'_>>,
    ) -> anyhow::Result<Vec<Row>> {
        let mut rows = self.on_the_wall(device)?;
        if let Some(Crossed { body, soft, origin }) = body {
            let (plant, settings) = (&self.shipped.plant, Settings { body_origin_m: origin, ..self.settings });
            for script in over_edges(body, origin, &self.stage(3)) {
                rows.push(match soft {
                    Some(soft) => self.row(device, plant, soft, settings, script)?,
                    None => self.row(device, plant, body, settings, script)?,
                });
            }
        }
        Ok(rows)
    }

    fn on_the_wall<K: Kinematics<JOINTS> + Copy, const JOINTS: usize>(
        &self,
        device: &Device<K, JOINTS>,
    ) -> anyhow::Result<Vec<Row>> {
        let mut rows = Vec::new();
        for script in self.stage(JOINTS).on_the_wall() {
            let mut row = self.row(device, &self.shipped.plant, wall(JOINTS), self.settings, script)?;
            if row.script.deed == Deed::Slide && !row.figures.sensation.is_below() {
                row.finer = Some(self.finer(device, &row.script)?);
            }
            rows.push(row);
        }
        Ok(rows)
    }

    fn row<S: Surface, K: Kinematics<JOINTS> + Copy, const JOINTS: usize>(
        &self,
        device: &Device<K, JOINTS>,
        plant: &PlantSettings,
        surface: &S,
        settings: Settings,
        script: Script,
    ) -> anyhow::Result<Row> {
        let friction = (script.deed == Deed::Verge).then_some(FRICTION);
        let servo = Servo::try_new(
            device,
            surface,
            Config { settings, rendering: Rendering { friction, ..self.wish.rendering }, ..Config::DEFAULT },
        )?;
        let sub_steps = (SUB_STEPS_A_SECOND / f64::from(settings.rate_hz)).round() as u32;
        let plant = PlantSettings { sub_steps: sub_steps.max(LEAST_SUB_STEPS), ..*plant };
        let recording = record(&servo, &plant, HandSettings::default(), &script)?;
        let figures = recording.figures(script.looked_at, self.threshold);
        let steady = matches!(script.deed, Deed::Rest | Deed::Slide | Deed::Approach(_)) && figures.depth > 0.0;
        let asked = f64::from(settings.stiffness_n_per_m) * figures.depth;
        let turn = match script.deed {
            Deed::Across(Some(normals)) => recording.turn(normals, script.looked_at),
            _ => None,
        };
        Ok(Row {
            force_error: steady.then(|| figures.force / asked - 1.0),
            turn,
            finer: None,
            contacts_lost: recording.contacts_lost,
            figures,
            script,
        })
    }

    fn slide<K: Kinematics<JOINTS> + Copy, const JOINTS: usize>(
        &self,
        device: &Device<K, JOINTS>,
        finer: f64,
    ) -> anyhow::Result<Sensation> {
        let (device, plant) = with_finer(device, &self.shipped.plant, finer);
        let device = Device { max_stiffness_n_per_m: f32::MAX, ..device };
        let scripts = self.stage(JOINTS).on_the_wall();
        let Some(script) = scripts.into_iter().rfind(|script| script.deed == Deed::Slide) else {
            return Ok(Sensation::NONE);
        };
        let row = self.row(&device, &plant, wall(JOINTS), self.settings, script)?;
        Ok(row.figures.sensation)
    }

    /// The factor by which the encoders must be finer to hide a script from the hand.
    fn finer<K: Kinematics<JOINTS> + Copy, const JOINTS: usize>(
        &self,
        device: &Device<K, JOINTS>,
        script: &Script,
    ) -> anyhow::Result<f64> {
        for factor in FINER {
            let (device, plant) = with_finer(device, &self.shipped.plant, factor);
            let row = self.row(&device, &plant, wall(JOINTS), self.settings, script.clone())?;
            if row.figures.sensation.is_below() {
                return Ok(factor);
            }
        }
        Ok(f64::INFINITY)
    }
}
