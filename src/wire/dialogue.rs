//! What a device that runs by itself says, and what it makes of what it is told.

use super::{Reading, Record};
use crate::math::Vec3;
use crate::scene::SceneError;
use crate::servo::{Remembered, ServoState, Tracked};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The version of these messages: another one may mean something else by them.
pub const PROTOCOL: u16 = 1;

/// Bytes of a body in one frame.
pub const CHUNK: usize = 64;

/// From a device that runs by itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Told {
    /// The first frame, and the answer to a host's [`super::Command::Hello`].
    Hello(Hello),
    /// The loop at a tick, and its timing.
    Record(Record),
    /// From a device that is being set up, in the place of records.
    Reading(Reading),
    /// To an order, or a part of an upload.
    Answer(Answer),
    /// To a host that has said hello: the loop as it is, as often as the line carries it.
    View(View),
}

/// What a device is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Hello {
    /// [`PROTOCOL`].
    pub protocol: u16,
    /// Servo rate, Hz.
    pub rate: f32,
    /// The greatest force of the device's settings, N.
    pub max_force: f32,
    /// Bytes of a body that can be uploaded; 0 where none can.
    pub room: u32,
    /// Faces and edges of such a body at most.
    pub faces: u16,
    /// Edges.
    pub edges: u16,
}

/// What became of an order or of a part of an upload.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Answer {
    /// Its number.
    pub number: u16,
    /// What was wrong with it; nothing has changed then.
    pub refused: Option<Refused>,
}

/// Why something was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Refused {
    /// The host has not said hello in the device's version since the device began.
    #[error("a host has to say hello first, in the device's version")]
    Hello,
    /// An order.
    #[error("{0}")]
    Order(SceneError),
    /// An upload.
    #[error("{0}")]
    Upload(UploadError),
    /// The order before is still on its way.
    #[error("the order before is not answered yet")]
    Busy,
    /// The device is being set up: nothing is felt.
    #[error("the device is being set up")]
    SetUp,
}

/// Part of a body file ([`crate::body::Body::from_bytes`]), in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Upload {
    /// A file of so many bytes begins; what was uploaded before and not taken is forgotten.
    Begin {
        /// Its length.
        bytes: u32,
    },
    /// Bytes from this one on, a multiple of [`CHUNK`]; those beyond the file's end are zero. The same may come twice.
    Bytes {
        /// The first one's place.
        at: u32,
        /// Sixteen at a time.
        bytes: [[u8; 16]; CHUNK / 16],
    },
    /// All of it has come: it is checked, and ready to be taken ([`crate::scene::Order::Take`]).
    End,
}

/// Why a part of an upload is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum UploadError {
    /// No memory was set aside for bodies.
    #[error("this device has no memory set aside for bodies")]
    NoRoom,
    /// More bytes than there is memory for.
    #[error("the body takes more than the {room} bytes set aside for it")]
    TooLong {
        /// What is there.
        room: u32,
    },
    /// More faces or edges than there is memory for.
    #[error("the body has more faces or edges than memory is set aside for")]
    TooMany,
    /// Both banks are in use: the body uploaded last has just been taken, and the one before is still felt.
    #[error("both banks are in use; try again in a moment")]
    Busy,
    /// A part that does not follow on the one before: the next byte wanted is this.
    #[error("the upload goes on at byte {at}")]
    Order {
        /// The next byte's place.
        at: u32,
    },
    /// Nothing was begun.
    #[error("no upload was begun")]
    NotBegun,
    /// What came is no body: changed on the way, or of another version. The host's own check says what is wrong.
    #[error("what came is no body of this version")]
    NoBody,
}

/// What a host sees of the loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct View {
    /// The tick.
    pub tick: u32,
    /// [`crate::servo::Phase`] as its number.
    pub phase: u8,
    /// [`crate::servo::Fault`] as its code, 0 for none. Latched.
    pub fault: u8,
    /// What of the person's side keeps the motors off, as bits ([`super::hold`]).
    pub hold: u8,
    /// The body that is felt, by its index in the scene.
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
    /// Of the loop after a tick, with the probe's velocity (m/s) and what holds.
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
