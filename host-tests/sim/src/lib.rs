//! Simulated haptic devices and the hands that hold them, apart from the tool and from the boards.
//!
//! - [`plant`]: the device in a hand, in f64 and independent of the library;
//! - [`devices`]: device files, as the library's constant and as a plant;
//! - [`scene`]: scene files;
//! - [`recorded`]: devices and scenes as plain numbers, also without a standard library;
//! - [`feel`]: scripted hands, and the force that they get as figures;
//! - [`simulated`]: the boards' loop and a simulated arm as a line to talk with (feature `boards`).

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

#[cfg(feature = "std")]
pub mod devices;
#[cfg(feature = "std")]
pub mod feel;
#[cfg(feature = "std")]
pub mod plant;
pub mod recorded;
#[cfg(feature = "std")]
pub mod scene;
#[cfg(feature = "boards")]
pub mod simulated;
