//! A run as the page takes it: what the sensors said, tick by tick, and how the loop was set. The page feels it
//! anew with the firmware's code and compares the hash.

use crate::report::Summary;
use crate::simulation::Trace;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use palpate::servo::Settings;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A recorded run.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Recording {
    /// `recording`.
    pub palpate: String,
    /// On what it was run.
    pub on: String,
    /// The model's name.
    pub model: String,
    /// The body's file, in base64.
    pub body: String,
    /// The device's name.
    pub device: String,
    /// Rate, stiffness, damping, greatest force, velocity corner, soft start, and the body's origin: SI units.
    pub settings: [f32; 9],
    /// Seconds without a host after which the loop stops.
    pub link_timeout: f32,
    /// Whether the device was protected.
    pub protected: bool,
    /// Ticks.
    pub ticks: usize,
    /// The tick from which force was asked for.
    pub enable_at: u32,
    /// Differences of the three counts from tick to tick, zig-zag and LEB128, in base64.
    pub counts: String,
    /// The state hash of the run.
    pub hash: String,
}

/// Why a run is not recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Cut {
    /// One patch of several was felt.
    #[error("one patch of a model of several is not recorded: leave out --patch")]
    Patch,
    /// The device is one's own.
    #[error("a run on one's own device is not recorded: the page has the devices that ship")]
    Device,
    /// Bodies that move were felt.
    #[error("a run over a scene is not recorded: the page feels one body at rest")]
    Scene,
}

/// How the loop of a run was set.
#[derive(Clone, Copy, Debug)]
pub struct Loop<'a> {
    /// The model's name.
    pub model: &'a str,
    /// The device's name.
    pub device: &'a str,
    /// Its settings.
    pub settings: &'a Settings,
    /// Seconds without a host after which it stops.
    pub link_timeout: f32,
    /// Whether the device was protected.
    pub protected: bool,
    /// The tick from which force was asked for.
    pub enable_at: u32,
}

impl Recording {
    /// Of a run on a body, by its file.
    pub fn new(trace: &Trace, on: &str, body: &[u8], of: &Loop<'_>) -> Self {
        let Settings { rate, stiffness, damping, max_force, velocity_corner, soft_start, body_origin } = *of.settings;
        let [x, y, z] = body_origin.to_array();
        Self {
            palpate: "recording".to_owned(),
            on: on.to_owned(),
            model: of.model.to_owned(),
            body: STANDARD.encode(body),
            device: of.device.to_owned(),
            settings: [rate, stiffness, damping, max_force, velocity_corner, soft_start, x, y, z],
            link_timeout: of.link_timeout,
            protected: of.protected,
            ticks: trace.samples.len(),
            enable_at: of.enable_at,
            counts: STANDARD.encode(differences(trace)),
            hash: format!("{:08x}", Summary::new(trace).state_hash),
        }
    }
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
