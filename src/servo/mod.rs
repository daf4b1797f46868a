//! The servo loop: one tick from encoder counts to motor duty.
//!
//! [`Servo`] is the configuration and lives in flash; [`ServoState`] holds everything that changes and is `Copy`;
//! [`Servo::tick`] is a function of the two and the tick's [`Input`]. Follow a tick in `tick.rs` from top to bottom. It
//! cannot fail: it returns duties, and its state reports the [`Phase`] and the [`Fault`].
//!
//! # Faults
//!
//! | cause | detected by | [`Fault`] |
//! |---|---|---|
//! | sensor frame lost, late or damaged | [`Input::Lost`], [`Input::Damaged`] | `FrameLost`, `FrameDamaged` |
//! | magnet loose or gone, sensor frozen | [`Input::Magnet`], [`Input::Frozen`] | `Magnet`, `Frozen` |
//! | encoder absent, glitching | range and maximum joint rate of the [`crate::device::Device`] | `JointOutOfRange`, `JointJumped` |
//! | encoder stuck | [`Safety::stuck`] | `JointStuck` |
//! | repeated implausible contact | [`ContactLimits`] | `ContactLost` |
//! | encoders contradict the mechanism | [`crate::device::Kinematics::pose`] | `Unreachable` |
//! | a force or torque that is NaN or infinite | the gate before the motors | `NotFinite` |
//! | tick overrun; a tick that starts late or early, a counter that stands still | [`Deadline`], [`PeriodWindow`], [`Event::Overrun`] | `Overrun` |
//! | host link lost | [`Safety::link_timeout_s`], [`Event::LinkAlive`] | `LinkLost` |
//! | table corrupted or stale | [`Safety::checks_tables`], at boot and in every tick that withholds no force | `TableCorrupt` |
//! | reset by watchdog or brown-out | [`ResetReason`], [`Servo::start_after`] | `WatchdogReset`, `BrownOut` |
//! | motor driver, homing, stop switch | [`Event`] | `Drive`, `Homing`, `Stopped` |
//! | calibration in flash damaged, or of another device | [`Event`] | `Calibration` |
//! | supply out of range, or not measured | [`crate::device::SupplyRange`], [`Event::Supply`] | `Supply` |
//! | joint or probe too fast under contact force, or a pressed probe let go | [`crate::device::Protection`] | `Overspeed` |
//! | encoder against its motor | [`crate::device::PolarityCheck`] | `WrongPolarity` |
//! | motor too warm | [`Heat`]: its force folds back to the continuous limit | none: a limit |
//! | too much force | scaled as a whole, its direction kept | none: a limit |
//! | force requested inside the wall | faded in | none |
//! | rim of the workspace, singularity | faded out and in again ([`crate::device::Device::workspace_margin`]) | none |
//!
//! A fault is latched with its tick, and the first one stands. From the very tick in which it is detected the motors
//! are safe ([`SafeOutput`]). The one exception is explicit: a [`FrameBridge`] before the tick bridges a few bad frames
//! in a row, and the next one is the fault. The motors get [`ServoState::output`], in every phase.

mod config;
mod contact;
mod fault;
mod force;
mod gate;
mod guard;
mod hertzian;
mod knob;
mod knob_error;
pub mod recommended;
mod sense;
mod settings;
mod soft;
mod state;
mod surface;
mod tick;
mod tunable;
mod watch;

pub use config::{Config, ConfigError, Loop, Servo, State};
pub use contact::ContactLimits;
pub use fault::{Event, Fault, Output, Phase, ResetReason};
pub use guard::{Guard, GuardState, Guarded, Heat, Motion, ProtectionError, Remembered, Unguarded};
pub use hertzian::Hertzian;
pub use knob::{DialState, Knob, KnobWitness};
pub use knob_error::{DAMPING_PER_STIFFNESS_S, KnobError, MAX_RETURN_RAD};
pub use settings::{Rendering, RenderingError, SafeOutput, Safety, SafetyError, Settings, SettingsError, StuckLimits};
pub use soft::{SoftBody, SoftContact};
pub use state::ServoState;
pub(crate) use surface::witness_words;
pub use surface::{BakedTables, Carrier, OnePatch, PatchWitness, Surface, TableCheck, ToolContact, Touched, Tracked};
pub use tick::Input;
pub use tunable::{Tunable, TunableState, Tuning};
pub use watch::{Deadline, FrameBridge, Heartbeat, PeriodWindow, Stillness};
