//! Memory for bodies that come over the line, and flash for a calibration.
//!
//! | type | is |
//! |---|---|
//! | [`Bodies`] | two banks of RAM: main writes and checks a body in one while the tick feels that of the other |
//! | [`Kept`] | flash for one body, which is rendered from the first tick on; written only while the motors are off |
//! | [`Both`] | one and the other for the same slot |
//! | [`KeptCalibration`] | flash for what commissioning found, which the loop is made with after the next reset |
//! | [`KeptFeels`] | flash for a knob's feel, which the knob starts with after the next reset |
//! | [`PretendedFlash`] | RAM with the rules of flash, where there is none to write |
//!
//! A bank goes from hand to hand by one word: main's, while it is written; nobody's, once its body was checked; the
//! tick's, once it was taken; main's again, once the tick has taken another. Nobody waits for anybody.
//!
//! Main and the tick are one each: [`Bodies::main`] and [`Kept::main`] hand out main's end once, and the tick's is for
//! the one [`palpate::scene::Slot`] that has it. This is a crate of its own because it is the only code between main
//! and the tick that the compiler cannot check.

mod bank;
mod bodies;
mod both;
mod calibrations;
mod feels;
mod incoming;
mod kept;
mod pretended;

pub use bodies::{Bodies, Writing};

/// The body store of a board that has plenty of RAM: 48 KB a bank, and faces and edges of some 100 patches. Its flash
/// is where its own program lies, which cannot be read while it is written: no body is kept there.
pub type RamStore = Bodies<12_288, 120, 300>;

pub use both::Both;
pub use calibrations::{Built, Found, KeptCalibration};
pub use feels::KeptFeels;
pub use kept::{Keeping, Kept, Region};
pub use pretended::{Broken, Pretended, PretendedFlash};
