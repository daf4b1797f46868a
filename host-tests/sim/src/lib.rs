//! Simulated haptic devices and the hands that hold them, apart from the tool and from the boards.
//!
//! - [`plant`]: the device in a hand, in f64 and independent of the library;
//! - [`motion`]: the loop on a device that moves, with a failure planted, on any plant;
//! - [`devices`]: device files, as the library's constant and as a plant;
//! - [`scene`]: scene files;
//! - [`recorded`]: devices and scenes as plain numbers, also without a standard library, as [`devices`] reads its files;
//! - [`feel`]: scripted hands, and the force that they get as figures;
//! - [`zwidth`]: the maximum stiffness of a wall on a device;
//! - [`magnetic`]: magnetic angle sensors at a board's bus (feature `boards`);
//! - [`rig`]: the boards' loop at simulated pins, and [`knob`], its loop of one joint (feature `boards`);
//! - [`simulated`]: the boards' loop and a simulated arm as a line to talk with (feature `link`).

#![cfg_attr(not(feature = "std"), no_std)]

extern crate alloc;

#[cfg(feature = "device-files")]
pub mod devices;
#[cfg(feature = "feel")]
pub mod feel;
#[cfg(feature = "boards")]
pub mod knob;
#[cfg(feature = "boards")]
pub mod magnetic;
#[cfg(feature = "std")]
pub mod motion;
#[cfg(feature = "std")]
pub mod plant;
pub mod recorded;
#[cfg(feature = "boards")]
pub mod rig;
#[cfg(feature = "std")]
pub mod scene;
#[cfg(feature = "link")]
pub mod simulated;
pub mod wall;
#[cfg(feature = "std")]
pub mod zwidth;
