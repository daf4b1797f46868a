//! What the emulated boards share. Each has a crate of its own that says where it differs ([`board::Board`]) and builds the
//! programs in `programs/`.
//!
//! To bring palpate to a board of your own, begin with a board for the bench; of what is here, it needs
//! - [`servo_loop`]: read the encoders instead of a frame, write the duties to the PWM;
//! - [`timer`]: the chip's timer that sets the servo's pace;
//! - [`panic`]: what stops the motors when all else fails.

#![no_std]

pub mod board;
pub mod body;
pub mod budget;
pub mod link;
pub mod link_semihosting;
pub mod link_uart;
pub mod panic;
mod planted;
pub mod recorded;
pub mod reset;
pub mod servo_loop;
pub mod timer;
pub mod vectors;
