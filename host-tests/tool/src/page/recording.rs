//! A run as the page reads it: the sensors' values, tick by tick, and the settings of the loop. The page renders it
//! again with the firmware's code and compares the hash.

use crate::report::Summary;
use crate::simulation::Trace;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use palpate::servo::Settings;
use palpate_sim::recorded::{Recorded, SceneNumbers};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A recorded run.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Recording {
    /// `recording`.
    pub palpate: String,
    /// The board or machine of the run.
    pub on: String,
    /// The name of the model, or of the scene.
    pub model: String,
    /// The bodies; each body of a scene once.
    pub bodies: Vec<RecordedBody>,
    /// The scene's numbers, in the format of `palpate_sim::recorded`, in base64; `None` for a single body.
    pub scene: Option<RecordedScene>,
    /// The device's name.
    pub device: String,
    /// Its numbers, in the format of `palpate_sim::recorded`, in base64, with those of its protection.
    pub device_numbers: String,
    /// Hash of these, see `hash_of`: a recording whose device or body was exchanged says which.
    pub device_hash: String,
    /// Rate, stiffness, damping, maximum force, velocity corner, soft start, and the body's origin: SI units.
    pub settings: [f32; 9],
    /// The rendering's name: smooth, eased or plain.
    #[serde(default = "plain")]
    pub rendering: String,
    /// Seconds without a host after which the loop stops.
    pub link_timeout: f32,
    /// Ticks.
    pub ticks: usize,
    /// The tick from which force is requested.
    pub enable_at: u32,
    /// Differences of the three counts from tick to tick, zig-zag and LEB128, in base64.
    pub counts: String,
    /// The state hash of the run.
    pub hash: String,
}

/// A body of a recorded run.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct RecordedBody {
    /// Its model's name.
    pub name: String,
    /// Its file, in base64.
    pub file: String,
    /// Hash of the file.
    pub hash: String,
}

/// A scene of a recorded run.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct RecordedScene {
    /// Name of each part, and index of its body among the recorded ones.
    pub parts: Vec<(String, u32)>,
    /// Its numbers, in the format of `palpate_sim::recorded`, in base64.
    pub numbers: String,
}

/// Recordings without an entry are of a time when all runs were plain.
fn plain() -> String {
    "plain".to_owned()
}

impl RecordedBody {
    /// A body of a name, from its file.
    pub fn new(name: &str, file: &[u8]) -> Self {
        let file = STANDARD.encode(file);
        Self { name: name.to_owned(), hash: hash_of(&file), file }
    }
}

impl RecordedScene {
    /// A scene with what its parts are called, in their order.
    pub fn new(scene: &SceneNumbers, names: impl Iterator<Item = String>) -> Self {
        let parts = names.zip(scene.entries.iter().map(|entry| entry.body)).collect();
        Self { parts, numbers: in_base64(&scene.numbers()) }
    }
}

/// Why a run is not recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Cut {
    /// The run rendered a single patch, which a body's file would split into several pieces.
    #[error("this patch is not recorded: a body's file has it in {0} pieces, and the run felt it in one")]
    Pieces(usize),
    /// A device with fewer joints.
    #[error("{0} has too few joints to feel a surface in space")]
    Joints(&'static str),
    /// The run rendered a body that deforms, which the page has none of.
    #[error("a body that deforms is not recorded: the page shows rigid ones")]
    Soft,
    /// The run's tool had a shape, which the page has none of.
    #[error("a tool with a shape is not recorded: the page touches with a point")]
    Tool,
}

/// How the loop of a run was set.
#[derive(Clone, Debug)]
pub struct Loop<'a> {
    /// The name of the model, or of the scene.
    pub model: &'a str,
    /// The rendered bodies.
    pub bodies: Vec<RecordedBody>,
    /// As a scene, if it was one.
    pub scene: Option<RecordedScene>,
    /// The device's name.
    pub device: &'a str,
    /// The device.
    pub numbers: &'a Recorded,
    /// Its settings.
    pub settings: &'a Settings,
    /// The rendering's name.
    pub rendering: &'a str,
    /// Seconds without a host after which it stops.
    pub link_timeout: f32,
    /// The tick from which force was asked for.
    pub enable_at: u32,
}

impl Recording {
    /// Of a run.
    pub fn new(trace: &Trace, on: &str, of: Loop<'_>) -> Self {
        let Settings {
            rate_hz: rate,
            stiffness_n_per_m: stiffness,
            damping_n_s_per_m: damping,
            max_force_n: max_force,
            velocity_corner_hz: velocity_corner,
            soft_start_s: soft_start,
            body_origin_m: body_origin,
        } = *of.settings;
        let [x, y, z] = body_origin.to_array();
        let device_numbers = in_base64(&of.numbers.numbers());
        Self {
            palpate: "recording".to_owned(),
            on: on.to_owned(),
            model: of.model.to_owned(),
            bodies: of.bodies,
            scene: of.scene,
            device: of.device.to_owned(),
            device_hash: hash_of(&device_numbers),
            device_numbers,
            settings: [rate, stiffness, damping, max_force, velocity_corner, soft_start, x, y, z],
            rendering: of.rendering.to_owned(),
            link_timeout: of.link_timeout,
            ticks: trace.samples.len(),
            enable_at: of.enable_at,
            counts: STANDARD.encode(differences(trace)),
            hash: format!("{:08x}", Summary::new(trace).state_hash),
        }
    }
}

/// FNV-1a over the letters, as the page computes it.
fn hash_of(text: &str) -> String {
    let hash = text.bytes().fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    format!("{hash:08x}")
}

/// Numbers with all their bits, which decimals in JSON have only where they are finite.
pub(super) fn in_base64(numbers: &[f32]) -> String {
    STANDARD.encode(numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>())
}

fn differences(trace: &Trace) -> Vec<u8> {
    let (mut bytes, mut last) = (Vec::new(), [0_i32; 3]);
    for sample in &trace.samples {
        for (count, last) in sample.sensors.counts.into_iter().zip(&mut last) {
            let difference = count.wrapping_sub(*last);
            *last = count;
            let mut number = (difference.wrapping_shl(1) ^ (difference >> 31)) as u32;
            while number > 127 {
                bytes.push(number as u8 | 128);
                number >>= 7;
            }
            bytes.push(number as u8);
        }
    }
    bytes
}
