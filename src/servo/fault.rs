//! Phases, faults, resets and events of the loop, and its output to the motors.

use super::ServoState;
use crate::device::{Counts, Duty};

/// The phase of the loop, in the order in which it goes through them; at most one step a tick.
///
/// Force comes from [`Phase::Running`] alone. A fault leads from any phase to [`Phase::Fault`], where the motors are at
/// zero or, if [`super::SafeOutput`] says so and the sensors are trusted, damp.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Phase {
    /// Nothing has been sensed yet.
    #[default]
    Reset = 0,
    /// The sensors settle, the device is homed and the tables are checked, as configured in [`super::Safety`].
    Calibrate = 1,
    /// Tracking, with the motors at zero, until force is requested.
    Armed = 2,
    /// Rendering force.
    Running = 3,
    /// Stopped by a fault, which is latched. A new start leaves this phase ([`super::Loop::start`], for which a person
    /// should have asked), and [`Event::Acknowledged`] after a fault of the last reset.
    Fault = 4,
}

impl Phase {
    /// Every phase, in the order of its number.
    pub const ALL: [Self; 5] = [Self::Reset, Self::Calibrate, Self::Armed, Self::Running, Self::Fault];
}

/// The output of a tick to the motors. Boards apply it and nothing else, in every phase: the motors are driven while
/// homing searches for stops, in [`Phase::Running`], and while damping after a fault; otherwise every stage is disabled.
/// Zero duty is not off: it keeps a bridge enabled and braking.
///
/// ```
/// use palpate::device::Duty;
/// use palpate::servo::Output;
///
/// /// The duty of a pulse width, and whether the stage is enabled.
/// fn of_stage(output: Output<1>) -> (Duty, bool) {
///     match output {
///         Output::Off => (Duty::ZERO, false),
///         Output::Drive([duty]) => (duty, true),
///     }
/// }
/// assert_eq!(of_stage(Output::Off), (Duty::ZERO, false));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[must_use = "the motors get nothing else"]
pub enum Output<const JOINTS: usize> {
    /// Nothing: every stage disabled.
    Off,
    /// These duties.
    Drive([Duty; JOINTS]),
}

impl<const JOINTS: usize, W, G> ServoState<JOINTS, W, G> {
    /// The output now: that of the last tick, or off after [`super::Servo::note`] latched a fault.
    #[inline]
    pub const fn output(&self) -> Output<JOINTS> {
        let drives = match self.phase {
            Phase::Running => true,
            Phase::Calibrate | Phase::Fault => self.drive.drives,
            Phase::Reset | Phase::Armed => false,
        };
        if drives { Output::Drive(self.drive.duties) } else { Output::Off }
    }
}

/// The fault that stopped the loop. The number is its code in a report, where 0 means no fault; `Display` gives it in
/// words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Fault {
    /// No sensor frame came for a tick, or one that belongs to another tick.
    #[error("sensor frame lost or late")]
    FrameLost = 1,
    /// A sensor frame came damaged: parity, CRC or the sensor's own error flag.
    #[error("sensor frame damaged")]
    FrameDamaged = 2,
    /// A joint angle is outside the device's range.
    #[error("joint angle out of range")]
    JointOutOfRange = 3,
    /// A joint angle jumped faster than any hand moves.
    #[error("joint angle jumped")]
    JointJumped = 4,
    /// A force or torque came out that is not a finite number.
    #[error("force not finite")]
    NotFinite = 5,
    /// A joint under load did not move by a single count while the others did.
    #[error("joint sensor stuck")]
    JointStuck = 6,
    /// A tick took longer than its period.
    #[error("tick overrun")]
    Overrun = 7,
    /// The host that watches over the device fell silent.
    #[error("host link lost")]
    LinkLost = 8,
    /// The tables in flash are not those that were baked.
    #[error("table corrupted")]
    TableCorrupt = 9,
    /// The watchdog had reset the chip: the program had hung.
    #[error("reset by the watchdog")]
    WatchdogReset = 10,
    /// The supply had broken down: under load it would again.
    #[error("reset by a brown-out")]
    BrownOut = 11,
    /// A motor driver reports a fault of its own.
    #[error("motor driver fault")]
    Drive = 12,
    /// Homing refused to say where the joints are.
    #[error("homing refused")]
    Homing = 13,
    /// Somebody pressed stop.
    #[error("stopped by hand")]
    Stopped = 14,
    /// Joint angles that the mechanism cannot have: a sensor is wrong, or something broke.
    #[error("pose out of the mechanism's reach")]
    Unreachable = 15,
    /// Repeated implausible contact: see [`super::ContactLimits`].
    #[error("contact lost repeatedly")]
    ContactLost = 16,
    /// A joint or the probe moves faster than it may while a contact gives force or within 50 ms after it, or a pressed
    /// probe was released.
    #[error("moving too fast under force")]
    Overspeed = 17,
    /// The motors' supply is out of its range, or not measured.
    #[error("motor supply out of range or not measured")]
    Supply = 18,
    /// A joint moves against its motor's torque: its encoder counts the other way, or its motor is wired so.
    #[error("encoder and motor polarity disagree")]
    WrongPolarity = 19,
    /// The calibration that is kept in flash cannot be used ([`crate::commission::CalibrationError`]).
    #[error("the calibration stored in flash is refused")]
    Calibration = 20,
    /// A magnetic sensor reports a field that is too strong or too weak.
    #[error("sensor magnet too strong or too weak")]
    Magnet = 21,
    /// A sensor whose last bits are never quiet repeats the same reading.
    #[error("sensor reading frozen")]
    Frozen = 22,
    /// The surface was made for a loop of another rate ([`super::Surface::is_for`]).
    #[error("surface made for another rate")]
    OtherRate = 23,
}

impl Fault {
    /// Every fault, in the order of its code.
    pub const ALL: [Self; 23] = [
        Self::FrameLost,
        Self::FrameDamaged,
        Self::JointOutOfRange,
        Self::JointJumped,
        Self::NotFinite,
        Self::JointStuck,
        Self::Overrun,
        Self::LinkLost,
        Self::TableCorrupt,
        Self::WatchdogReset,
        Self::BrownOut,
        Self::Drive,
        Self::Homing,
        Self::Stopped,
        Self::Unreachable,
        Self::ContactLost,
        Self::Overspeed,
        Self::Supply,
        Self::WrongPolarity,
        Self::Calibration,
        Self::Magnet,
        Self::Frozen,
        Self::OtherRate,
    ];

    /// Whether [`super::SafeOutput::Damping`] may follow it. Not where that would drive a motor that has failed or is
    /// wired the wrong way, or may be for all that is known, which it would speed up, nor pump up a supply that is out
    /// of its range.
    pub const fn leaves_damping(self) -> bool {
        !matches!(self, Self::Drive | Self::WrongPolarity | Self::Supply | Self::Calibration)
    }

    /// The code in a report, from 1.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The fault of a code; `None` for 0 and for codes that are not ours.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|fault| fault.code() == code)
    }
}

/// Why the chip was reset, as its registers say. Kept in the state for as long as it runs.
///
/// Many chips raise the brown-out flag at every power-on as well: where both flags are up, say
/// [`ResetReason::PowerOn`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum ResetReason {
    /// Power was switched on.
    #[default]
    PowerOn = 0,
    /// The reset pin, or a debugger.
    Pin = 1,
    /// The program requested it.
    Software = 2,
    /// A watchdog ran out. The loop starts in [`Fault::WatchdogReset`].
    Watchdog = 3,
    /// The supply broke down. The loop starts in [`Fault::BrownOut`].
    BrownOut = 4,
    /// The board cannot tell.
    Unknown = 5,
    /// The program had panicked, and the watchdog reset it: [`Fault::WatchdogReset`].
    Panic = 6,
    /// An exception or a stray interrupt had stopped the program, and the watchdog reset it: [`Fault::WatchdogReset`].
    Exception = 7,
    /// Something outside of the program reset it by way of the watchdog, as a flashing tool does.
    Tool = 8,
}

impl ResetReason {
    /// Every reason, in the order of its number.
    pub const ALL: [Self; 9] = [
        Self::PowerOn,
        Self::Pin,
        Self::Software,
        Self::Watchdog,
        Self::BrownOut,
        Self::Unknown,
        Self::Panic,
        Self::Exception,
        Self::Tool,
    ];

    /// The fault that this reset is.
    pub const fn fault(self) -> Option<Fault> {
        match self {
            Self::Watchdog | Self::Panic | Self::Exception => Some(Fault::WatchdogReset),
            Self::BrownOut => Some(Fault::BrownOut),
            Self::PowerOn | Self::Pin | Self::Software | Self::Unknown | Self::Tool => None,
        }
    }
}

/// An event between two ticks that matters to the loop: see [`super::Servo::note`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Event {
    /// A message of the host arrived: the link is alive.
    LinkAlive,
    /// A tick took longer than its period (see [`super::Deadline`]).
    Overrun,
    /// A motor driver reports a fault.
    DriveFault,
    /// Homing is done elsewhere than in [`super::Config::homing`]: counts are angles now.
    Homed,
    /// A joint passed its index mark at a count.
    IndexPassed {
        /// The joint, from 0.
        joint: usize,
        /// The count that was caught there.
        counts: Counts,
    },
    /// Homing was refused.
    HomingRefused,
    /// The calibration that is kept cannot be used.
    CalibrationRefused,
    /// A stop button or the host's stop: [`Fault::Stopped`], latched.
    Stop,
    /// A person has checked the device after a reset that is a fault: clears [`Fault::WatchdogReset`] and
    /// [`Fault::BrownOut`], and no other fault. The loop starts again.
    Acknowledged,
    /// A person has selected a body or feel, where there is a choice ([`super::Knob`]).
    Chosen {
        /// Which, counted from 0.
        index: u8,
    },
    /// The motors' supply was measured: voltage bridges are commanded by it, and a protected loop watches it.
    Supply {
        /// The measured voltage.
        millivolts: u32,
    },
    /// The handle's orientation was sensed: of a gimbal before every tick, of an inertial sensor as often as it
    /// answers, at least every 20 ms. Matters to a [`crate::pair::ToolSurface`].
    Oriented {
        /// `(x, y, z, w)`, of length 1: takes the tool's frame to the device's.
        quaternion: [f32; 4],
    },
}
