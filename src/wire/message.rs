//! Messages in each direction. Arrays hold three joints; a device with fewer leaves the rest zero.

use serde::{Deserialize, Serialize};

/// To the device: its simulated sensors at this tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sensors {
    /// Which tick this answers, counted from 0. A frame for another tick is late or lost.
    pub tick: u32,
    /// Encoder counts.
    pub counts: [i32; 3],
    /// Whether the enable input is held. The loop leaves standby only while it is true.
    pub enable: bool,
}

/// To a device with a wrist: its simulated sensors at this tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct WristSensors {
    /// Those of the arm.
    pub arm: Sensors,
    /// Encoder counts of the wrist's axes, from the arm to the handle.
    pub wrist: [i32; 3],
}

/// From the device, at the end of a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Report {
    /// The tick this reports.
    pub tick: u32,
    /// Motor duties now applied, full scale ±32 767.
    pub duties: [i16; 3],
    /// [`crate::servo::Phase`] as its number.
    pub phase: u8,
    /// [`crate::servo::Fault`] as its code, 0 for none. Latched.
    pub fault: u8,
    /// The tick at which the fault was seen.
    pub fault_tick: u32,
    /// [`crate::device::Refusal`] as its code, 0 for none: why homing was refused.
    pub refusal: u8,
    /// [`crate::servo::ResetReason`] as its number: the reason for the chip's last reset.
    pub reset: u8,
    /// Ticks that overran so far.
    pub overruns: u32,
    /// [`crate::body::Feature`] as its code; 0 for a surface of one patch.
    pub feature: u16,
    /// [`crate::track::BoundaryMode`] as its number.
    pub mode: u8,
    /// [`crate::track::Contact`] as its number.
    pub contact: u8,
    /// Workspace margin, percent: below 100 the force fades out.
    pub room: u8,
    /// The witness point's parameters.
    pub parameters: [f32; 2],
    /// Probe in the body frame, metres.
    pub probe: [f32; 3],
    /// Signed distance along the outward normal, metres; negative while penetrating.
    pub gap: f32,
    /// Force at the probe, N.
    pub force: [f32; 3],
    /// Frames lost, late or damaged so far.
    pub frames_lost: u32,
    /// How often the controller undid a step that brought the witness point no nearer.
    pub rejected_steps: u32,
    /// Instructions of the servo tick, from the counter of the board; 0 where there is none.
    pub instructions: u32,
    /// [`crate::servo::ServoState::digest`] after this tick: the same on host and target, bit for bit.
    pub digest: u32,
}

/// From the device, as telemetry: the loop at a tick, and its timing since the record before. The board's counter runs
/// freely and wraps at 32 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Record {
    /// The tick this records.
    pub tick: u32,
    /// Which record this is, counted from 0: a gap is records that were lost on the line.
    pub number: u32,
    /// Counts of the board's counter in a second, Hz.
    pub clock: u32,
    /// The counter at the tick's interrupt.
    pub began: u32,
    /// The shortest period between two interrupts since the record before, counts.
    pub shortest: u32,
    /// The longest.
    pub longest: u32,
    /// The longest that a tick took since the record before, from its interrupt to its end, counts.
    pub took: u32,
    /// Records dropped so far because the queue was full.
    pub dropped: u32,
    /// [`crate::servo::Phase`] as its number.
    pub phase: u8,
    /// [`crate::servo::Fault`] as its code, 0 for none. Latched.
    pub fault: u8,
    /// The tick at which the fault was seen.
    pub fault_tick: u32,
    /// [`crate::servo::ResetReason`] as its number.
    pub reset: u8,
    /// Ticks that overran so far.
    pub overruns: u32,
    /// Bad sensor frames bridged so far ([`crate::servo::FrameBridge`]).
    pub bridged: u32,
    /// Rate of bad sensor frames, in 10,000; above [`crate::servo::FrameBridge::MAX_RATE`] the next one is a fault.
    pub bad_frames: u16,
    /// Automatic gain of each magnetic sensor, 255 in a weak field; 0 of one without.
    pub gains: [u8; 3],
    /// External reasons that keep the motors off, as bits ([`hold`]).
    pub hold: u8,
    /// [`crate::body::Feature`] as its code; 0 for a surface of one patch.
    pub feature: u16,
    /// [`crate::track::BoundaryMode`] as its number.
    pub mode: u8,
    /// [`crate::track::Contact`] as its number.
    pub contact: u8,
    /// Signed distance along the outward normal, metres; negative while penetrating.
    pub gap: f32,
    /// Probe in the body frame, metres.
    pub probe: [f32; 3],
    /// Force at the probe, N.
    pub force: [f32; 3],
    /// Motor duties now applied, full scale ±32 767.
    pub duties: [i16; 3],
}

/// The bits of [`Record::hold`]: external reasons that keep the motors off without a fault of the loop.
pub mod hold {
    /// The stop input is pressed, its wire is broken, or it has still to be pressed once since the reset, where the board
    /// asks for that.
    pub const STOP: u8 = 1 << 0;
    /// An amplifier is not ready, has no supply, or its wire is broken.
    pub const NOT_READY: u8 = 1 << 1;
    /// The motors' supply is out of its range.
    pub const SUPPLY: u8 = 1 << 2;
    /// The enable input has to be seen released first.
    pub const RELEASE_FIRST: u8 = 1 << 3;
    /// A body is being written into flash.
    pub const WRITING: u8 = 1 << 4;
    /// The loop watches its link ([`crate::servo::Safety::link_timeout_s`]), and no host was heard yet.
    pub const NO_HOST: u8 = 1 << 5;
    /// The host asks for something that a person must confirm: hold the enable button for half a second, then release
    /// it.
    pub const CONFIRM: u8 = 1 << 6;
    /// The two channels of the enable input differed for too long: both have to be seen released.
    pub const ENABLE: u8 = 1 << 7;

    /// The reason of each of these holds, for a person.
    pub fn reasons(holds: u8) -> impl Iterator<Item = &'static str> {
        const REASONS: [(u8, &str); 8] = [
            (STOP, "stop is pressed, or has still to be pressed once"),
            (NOT_READY, "an amplifier is not ready"),
            (SUPPLY, "the supply is out of its range"),
            (RELEASE_FIRST, "enable has to be released first"),
            (WRITING, "flash is being written"),
            (NO_HOST, "no host was heard yet"),
            (CONFIRM, "hold the enable button for half a second, then release it"),
            (ENABLE, "the two contacts of the enable button differ: release it; one that stays closed is broken"),
        ];
        REASONS.into_iter().filter(move |(bit, _)| holds & bit != 0).map(|(_, reason)| reason)
    }
}

/// To a device that runs by itself. Until a [`Self::Hello`] in its version has come it takes [`Self::Stop`] alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum HostMessage {
    /// The host is there: [`crate::servo::Event::LinkAlive`].
    Alive,
    /// Stop: [`crate::servo::Event::Stop`], latched.
    Stop,
    /// Go on after a reset by the watchdog or a brown-out: [`crate::servo::Event::Acknowledged`]. A person must confirm
    /// it ([`hold::CONFIRM`]).
    Acknowledge,
    /// Let go of the servo until the next reset, and be set up: [`crate::commission`]. Taken only while nothing is
    /// driven and the enable input is released. A person must confirm it ([`hold::CONFIRM`]).
    SetUp,
    /// One motor, while a key is held; taken only by a device that is being set up.
    Jog(crate::commission::Jog),
    /// Starts a session in this version ([`super::PROTOCOL`]). The device answers with [`super::Hello`]; it takes
    /// commands and uploads only from a host of its own version.
    Hello {
        /// The host's.
        protocol: u16,
    },
    /// Changes the scene between two ticks. Answered by its number ([`super::Answer`]).
    Command {
        /// The next higher one, wrapping.
        number: u16,
        /// The command.
        command: crate::scene::Command,
    },
    /// A part of a body on its way into the device's memory. Answered by its number ([`super::Answer`]).
    Upload {
        /// As an order's.
        number: u16,
        /// Which part.
        part: super::upload::Upload,
    },
    /// Stores the results of commissioning in the device's flash, or clears them; used from the next reset on. Only in
    /// commissioning mode, while no motor is driven and the enable input is released, and once a person has confirmed it
    /// ([`hold::CONFIRM`]). Answered by its number ([`super::Answer`]).
    Calibrate {
        /// As an order's.
        number: u16,
        /// The values of each joint; a device with fewer takes the first. `None` clears the stored calibration.
        joints: Option<[crate::commission::JointCalibration; 3]>,
    },
    /// Stores the feel of a knob that was set since its last reset in the device's flash, or clears the stored one; used
    /// from the next reset on. Only while no motor is driven and the enable input is released, and once a person has
    /// confirmed it ([`hold::CONFIRM`]). Answered by its number ([`super::Answer`]).
    KeepFeel {
        /// As an order's.
        number: u16,
        /// Whether it is stored; otherwise cleared.
        keeps: bool,
    },
}

/// From a device in commissioning mode: its readings and its motors' duties.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    /// Ticks so far.
    pub tick: u32,
    /// The number of the last [`crate::commission::Jog`] that was taken.
    pub number: u32,
    /// Encoder counts, by the board's inputs; those of the last tick whose sensors answered. Where the field of a motor
    /// with three phases is led round, the last is how far, 65,536ths of an electrical turn: such a device has no third
    /// joint.
    pub counts: [i32; 3],
    /// Motor duties now applied, by the board's outputs, full scale ±32 767.
    pub duties: [i16; 3],
    /// Whether a motor is being driven.
    pub live: bool,
    /// Whether the enable input is held, and was seen released before.
    pub enable: bool,
    /// [`crate::commission::JogRefusal`] as its code, 0 for none.
    pub refusal: u8,
    /// External reasons that keep the motors off, as bits ([`hold`]).
    pub hold: u8,
}
