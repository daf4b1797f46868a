#![no_std]
#![doc = include_str!("../docs/crate.md")]

pub mod body;
pub mod commission;
pub mod device;
pub mod field;
pub mod math;
mod message;
pub mod pair;
pub mod patch;
pub mod render;
pub mod scene;
pub mod servo;
pub mod tally;
#[doc = include_str!("theory.md")]
pub mod theory {}
pub mod track;
#[cfg(feature = "wire")]
pub mod wire;
