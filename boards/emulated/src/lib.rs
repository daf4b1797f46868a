//! palpate on the emulated boards: mps2-an386 (Cortex-M4F), mps2-an500 (Cortex-M7), mps2-an505 (Cortex-M33), mps2-an385
//! (a Cortex-M3 that runs the code of a Cortex-M0, without floats) and virt (RISC-V).
//!
//! Where a real device has encoders and motors, these boards have a link to a host: one frame with the sensors in, one
//! with the report out, a tick. The programs in `programs/` are the same on each; where a board differs is
//! [`board::BOARD`], its memory map, what its `.toml` file tells the compiler, and [`processor`].
//!
//! To bring palpate to a board of your own, start from a bench board; from this crate it needs
//! - [`servo_loop`]: read the encoders instead of a frame, write the duties to the PWM;
//! - [`processor`]: the chip's timer that sets the servo's pace;
//! - [`panic`]: what stops the motors when all else fails.

#![no_std]

#[cfg(all(target_arch = "arm", not(any(feature = "protected", feature = "wrist"))))]
pub mod accepted;
#[cfg(target_arch = "arm")]
pub mod arm;
pub mod board;
pub mod body;
pub mod budget;
#[cfg(not(any(feature = "protected", feature = "wrist")))]
pub mod flash;
#[cfg(feature = "knob")]
pub mod knob;
pub mod link;
pub mod link_semihosting;
pub mod link_uart;
#[cfg(not(any(feature = "protected", feature = "wrist")))]
pub mod measured;
pub mod panic;
#[cfg(not(any(feature = "protected", feature = "wrist")))]
pub mod pins;
mod planted;
#[cfg(feature = "race")]
pub mod race;
#[cfg(target_arch = "arm")]
pub mod recorded;
pub mod reset;
#[cfg(target_arch = "riscv32")]
pub mod riscv;
pub mod servo_loop;
pub mod timer;
#[cfg(target_arch = "arm")]
pub mod vectors;

#[cfg(target_arch = "arm")]
pub use arm as processor;
#[cfg(target_arch = "riscv32")]
pub use riscv as processor;
