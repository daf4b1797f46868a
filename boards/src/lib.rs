//! One loop for every board on the bench.
//!
//! A board's own files are its clocks, pins and memory. The code that uses them is here, once, and runs on the host
//! too: with mocks of pins and buses, and with the simulated devices.
//!
//! # The way of the data
//!
//! ```text
//!  interrupt, a tick                                              main, whenever it has time
//!  Board::panel ── Hold ── Interlock ── enable ──┐
//!  Board::read ─── FrameBridge ─────── counts ── Servo::tick ── state.output() ── Board::drive or Board::release
//!                                                │                                Deadline, once more
//!        Mailbox: commands, orders ◄─────────────┼── ticks ──► Idle: watchdog, records out, commands in
//! ```
//!
//! | type | is |
//! |---|---|
//! | [`Board`] | what the loop reaches of the world; [`Parts`] makes one of embedded-hal's pins and buses |
//! | [`Passive`] | the same without a way to drive a motor |
//! | [`Felt`] | the servo, and where it lies |
//! | [`Panel`] | what the person's side says: enable, stop, ready, supply |
//! | [`Hold`] | what keeps the motors off although nothing is wrong: stop, an amplifier not ready, the supply |
//! | [`Interlock`] | force only once enable has been seen released: after a reset, after a hold, after homing |
//! | [`Bench`] | the tick |
//! | [`Idle`] | what runs below it |
//! | [`ClockCheck`] | the loop's clock against another of the chip's |
//! | [`accept`] | another image: a board shows what it can, and drives no motor |
//! | [`Calibrations`] | flash for what commissioning found |
//! | [`Feels`] | flash for a knob's feel |
//! | [`Uploads`] | memory for bodies that come over the line: RAM, and flash |
//! | [`JogSettings`] | what may be jogged once a host sets the device up, in the servo's place |
//! | [`arm!`] | the servo of a board with three joints and all its protection |
//! | [`knob`] | the knob: its device, how its rotor is aligned, what it feels like |
//! | [`store`] | memory for bodies that come over the line |
//! | [`exercise`] | a long seeded run of the servo, the same on a board and on the host |
//! | `cortex` | what a Cortex-M needs beside: stopping, handing over, counting (feature `cortex`) |
//! | `usb` | the line over a board's own USB plug (feature `usb`) |
//!
//! # What keeps a thumb safe
//!
//! - No board looks at the phase: it does what [`palpate::servo::ServoState::output`] says.
//! - An enable button that is held, stuck or shorted at reset moves nothing, and until it was seen released nothing is
//!   driven, not even to damp.
//! - Broken wires stop: stop is a closed contact, ready is a level that the amplifier has to give.
//! - While a hold lasts nothing is driven, not even to damp. After it, force comes by the soft start, and only once
//!   enable has been seen released.
//! - Before a hello in its version a device takes a stop and nothing else. Set-up, an acknowledge and each write of
//!   flash wait until a person has held the enable button for half a second and released it.
//! - An enable line that reads as on after its release is a fault of the drives; a word of the program in RAM that
//!   differs from its image stops the program.
//! - A host sets the device up only while nothing is driven and enable is released. The servo is then stopped for good,
//!   and a motor moves only while enable is held, after it was seen released, *and* the host's key is held, as frames
//!   that must keep coming say. Only a reset leads back.
//! - Flash is written only while nothing is driven and enable is released, and the motors are held off until it is
//!   done, or no part of it has come for a while. A calibration is written only while the device is set up.
//! - A calibration that is damaged, or cannot be this device's, is a fault that nothing ends but another calibration
//!   and a reset.
//! - A loop that watches its link holds the motors off until a host was heard; one that falls silent then is a fault.
//! - A reset by the watchdog or a brown-out stays a fault until somebody acknowledges it: stop pressed and let go, with
//!   enable released, or the host's command.

#![no_std]
#![deny(unsafe_code)]

pub mod accept;
mod acknowledging;
mod arm;
mod bench_loop;
mod board;
mod calibrations;
mod chopper;
mod clock_check;
mod confirming;
#[cfg(feature = "cortex")]
#[allow(unsafe_code)]
pub mod cortex;
mod currents;
mod delay;
mod drives;
pub mod exercise;
mod feels;
mod hold;
mod idle;
mod interlock;
pub mod knob;
mod led;
mod letter;
mod light;
mod lines;
mod mailbox;
mod option_bytes;
mod outbox;
mod parts;
mod program_check;
mod rate;
mod reset;
pub mod sensors;
mod set_up;
mod settings;
#[allow(unsafe_code)]
pub mod store;
mod taking;
mod uploads;
#[cfg(feature = "usb")]
pub mod usb;
mod writing;

pub use arm::{ArmServo, OneSlot, arm_servo, check_feeds, check_supply, one_slot};
pub(crate) use bench_loop::State;
pub use bench_loop::{Bench, Felt};
pub use board::{Board, NotObeyed, Panel, Passive};
pub use calibrations::Calibrations;
pub use chopper::{Chopped, Chopper, ChopperSettings};
pub use clock_check::{ClockCheck, ClocksDisagree};
pub use currents::{CurrentFault, CurrentLimits, CurrentWatch, CurrentWatched, PhaseCurrents};
pub use delay::{Counter, CycleDelay};
pub use drives::{Breakable, Drives, ReadBack, Switched};
pub use feels::Feels;
pub use hold::{Hold, Verdict};
pub use idle::{Idle, Offers, Port, WINDOW_MS, Watchdog, heartbeat};
pub use interlock::Interlock;
pub use lines::{Divider, EnableInput, Lines, NoSupply, OneChannel, Pressed, Supply, TwoChannels};
pub use mailbox::Mailbox;
pub use option_bytes::OptionBytes;
pub use parts::{Parts, Timer};
pub use program_check::{Copied, ProgramChanged, ProgramCheck};
pub use rate::{RECORDS_HZ, dwell, effort, tick_counts};
pub use reset::{Cause, Memo, ResetFlags};
pub use set_up::JogSettings;
pub use settings::Settings;
pub use uploads::Uploads;
