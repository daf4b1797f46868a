//! The messages of a standalone device, and its answers to a host.

use super::message::{Reading, Record};
use super::upload::UploadError;
use crate::commission::CalibrationError;
use crate::field::MAX_MODES;
use crate::math::Vec3;
use crate::scene::SceneError;
use crate::servo::{Remembered, ServoState, Tracked};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The version of these messages: another one may mean something else by them.
pub const PROTOCOL: u16 = 5;

/// From a device that runs by itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum DeviceMessage {
    /// The first frame, and the answer to a host's [`super::HostMessage::Hello`].
    Hello(Hello),
    /// The loop at a tick, and its timing.
    Record(Record),
    /// From a device that is being set up, in the place of records.
    Reading(Reading),
    /// To an order, or a part of an upload.
    Answer(Answer),
    /// To a host that has sent a hello: the loop's state, as often as the line can carry it.
    View(View),
    /// After each hello, by a device that can keep a calibration in flash: which one it uses.
    Calibrated(Calibrated),
    /// From a device that is being set up, whose inputs have index marks: where they were passed.
    Marked(Marked),
    /// From a knob, to a host that has sent a hello, [`DIALS_HZ`] times a second.
    Dial(Dial),
    /// From a device whose surface deforms, to a host that has sent a hello, [`MODES_HZ`] times a second.
    Modes(Modes),
}

/// How often a device tells of the modes of a body that deforms, Hz.
pub const MODES_HZ: u32 = 100;

/// The modes of the foremost body, if it deforms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Modes {
    /// The tick.
    pub tick: u32,
    /// The body, by its index in the scene.
    pub body: u8,
    /// `q` of each mode, metres; of those that it has not, 0.
    pub q: [f32; MAX_MODES],
}

impl Modes {
    /// Of the loop after a tick; none of a rigid surface.
    #[inline]
    pub fn new<const JOINTS: usize, W: Tracked, G: Remembered>(state: &ServoState<JOINTS, W, G>) -> Option<Self> {
        let q = state.witness().modes()?;
        Some(Self { tick: state.ticks().wrapping_sub(1), body: state.witness().body(), q })
    }
}

/// How often a knob tells of its dial, Hz.
pub const DIALS_HZ: u32 = 100;

/// A knob's dial.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Dial {
    /// The tick.
    pub tick: u32,
    /// Whole turns that the angle does not count.
    pub turns: i32,
    /// By which the active feel's parts, and those that a host sets, are placed, radians.
    pub angle: f32,
    /// rad/s.
    pub rate: f32,
    /// Torque of the feel, N·m, before soft start and limits.
    pub torque: f32,
    /// Which feel is active; the host's own is the one after the table's last.
    pub feel: u8,
    /// The nearest detent's number: one that was passed changes it.
    pub detent: i32,
    /// Beyond an end stop: −1 below, 1 above, 0 between them.
    pub end: i8,
    /// The stored feel, as [`KeptFeel`]'s number.
    pub kept: u8,
}

/// The stored feel since the last reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum KeptFeel {
    /// None.
    #[default]
    None = 0,
    /// The knob started with it.
    Used = 1,
    /// It is damaged or beyond this device's limits: the knob started with its table.
    Refused = 2,
}

/// Index marks that were passed while a device is being set up, by the board's inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Marked {
    /// The count at which each input's mark was passed last.
    pub counts: [i32; 3],
    /// How often it was, wrapping; 0 of an input whose mark was not passed yet.
    pub passes: [u16; 3],
}

/// Which calibration a device uses since its last reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Calibrated {
    /// No stored calibration: the compiled-in one is used.
    #[default]
    BuiltIn,
    /// The one that is kept.
    Kept {
        /// The CRC-32 of its record ([`crate::commission::Calibration::crc`]).
        crc: u32,
    },
    /// One is kept that cannot be used: its motors stay off ([`crate::servo::Fault::Calibration`]).
    Refused(CalibrationError),
}

/// Why a calibration or a feel is not kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum KeepError {
    /// No flash was set aside for one.
    #[error("this board has no flash for it: send it again after each reset, or build it in")]
    NoFlash,
    /// The device is not being set up.
    #[error("a calibration is saved only in commissioning mode")]
    NotSetUp,
    /// A motor is driven, or the enable input is held.
    #[error("flash is written only while the motors are off; release the enable input first")]
    Driven,
    /// The calibration cannot belong to this device. The stored one is unchanged.
    #[error("{0}")]
    Calibration(CalibrationError),
    /// The flash did not take it: none is kept now that is whole.
    #[error("flash write error: nothing is saved")]
    Flash,
    /// Nobody held the enable button and released it.
    #[error("not confirmed at the device: hold the enable button for half a second, then release it")]
    NotConfirmed,
    /// Flash was written as often as it may be between two resets.
    #[error("flash was written too often since the last reset; reset the device")]
    Worn,
    /// No part of a feel was set since the last reset.
    #[error("no feel was set since the last reset; set one first")]
    NoFeel,
}

/// The identity and limits of a device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Hello {
    /// [`PROTOCOL`].
    pub protocol: u16,
    /// Servo rate, Hz.
    pub rate: f32,
    /// Maximum force of the device's settings, N; 0 of a knob, which has a torque.
    pub max_force: f32,
    /// Bytes of a body that can be uploaded; 0 where none can.
    pub room: u32,
    /// Faces and edges of such a body at most.
    pub faces: u16,
    /// Edges.
    pub edges: u16,
    /// Bytes of a body that can be kept in flash; 0 where none can.
    pub flash: u32,
    /// The CRC-32 at the end of the file of the body that is kept there; 0 where none is.
    pub kept: u32,
}

/// The result of a command or of a part of an upload.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Answer {
    /// Its number.
    pub number: u16,
    /// Why it was refused; nothing has changed then.
    pub refused: Option<Refused>,
}

/// Why something was refused.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Refused {
    /// No hello in the device's version since the device's start.
    #[error("send a hello with the device's protocol version first")]
    Hello,
    /// An order.
    #[error("{0}")]
    Command(SceneError),
    /// An upload.
    #[error("{0}")]
    Upload(UploadError),
    /// The order before is still on its way.
    #[error("busy: the previous command is pending")]
    Busy,
    /// The device is in commissioning mode: it renders nothing.
    #[error("the device is in commissioning mode")]
    SetUp,
    /// A calibration.
    #[error("{0}")]
    Calibration(KeepError),
    /// A feel.
    #[error("{0}")]
    Feel(KeepError),
}

/// The host's view of the loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct View {
    /// The tick.
    pub tick: u32,
    /// [`crate::servo::Phase`] as its number.
    pub phase: u8,
    /// [`crate::servo::Fault`] as its code, 0 for none. Latched.
    pub fault: u8,
    /// External reasons that keep the motors off, as bits ([`super::hold`]).
    pub hold: u8,
    /// The foremost body, by its index in the scene.
    pub body: u8,
    /// [`crate::track::Contact`] as its number.
    pub contact: u8,
    /// [`crate::body::Feature`] as its code.
    pub feature: u16,
    /// Signed distance along the outward normal, metres.
    pub gap: f32,
    /// Probe in the scene's frame, metres.
    pub position: [f32; 3],
    /// Its velocity, m/s.
    pub velocity: [f32; 3],
    /// Force at the probe, N.
    pub force: [f32; 3],
}

impl View {
    /// Of the loop after a tick, with the probe's velocity (m/s) and the holds.
    pub fn new<const JOINTS: usize, W: Tracked, G: Remembered>(
        state: &ServoState<JOINTS, W, G>,
        velocity: Vec3,
        hold: u8,
    ) -> Self {
        Self {
            tick: state.ticks().wrapping_sub(1),
            phase: state.phase() as u8,
            fault: state.fault().map_or(0, |(fault, _)| fault.code()),
            hold,
            body: state.witness().body(),
            contact: state.contact() as u8,
            feature: state.witness().feature(),
            gap: state.gap(),
            position: state.probe().to_array(),
            velocity: velocity.to_array(),
            force: state.force().to_array(),
        }
    }
}
