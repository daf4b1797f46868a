//! palpate on the emulated board mps2-an386, a Cortex-M4F with timers and a UART.
//!
//! Where a real device has encoders and motors, this board has a link to a host: one frame with the sensors in, one
//! with the report out, a tick. To bring palpate to a board of your own, copy this crate and change
//! - [`timer`]: the chip's timer that sets the servo's pace;
//! - [`servo_loop`]: read the encoders instead of a frame, write the duties to the PWM;
//! - [`vectors`]: not needed where the chip has a crate of its own.

#![no_std]

pub mod body;
pub mod budget;
pub mod link;
pub mod link_semihosting;
pub mod link_uart;
mod panic;
pub mod servo_loop;
pub mod timer;
pub mod vectors;
