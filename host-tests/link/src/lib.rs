#![doc = include_str!("../README.md")]

mod device;
mod dial;
mod error;
mod line;
mod orders;
mod port;
mod read;
mod stopping;
mod upload;

pub use device::{ALIVE, Device};
pub use dial::{clicks, ends};
pub use error::Error;
pub use line::Line;
pub use orders::{ANSWER, TRIES};
pub use palpate::render::{DialFriction, Ends, FeelPart, Friction, Notch, Spring, Wave};
pub use palpate::scene::{BodyPose, Command, SceneError};
pub use palpate::servo::{Fault, Phase};
pub use palpate::track::Contact;
pub use palpate::wire::{
    Calibrated, DIALS_HZ, Dial, Hello, KeptFeel, MODES_HZ, Modes, PROTOCOL, Record, Refused, UploadError, View,
};
pub use port::Port;
pub use read::SILENCE;
