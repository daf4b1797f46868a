//! Result of a call, as a code and as a sentence.

use core::ffi::{CStr, c_char};
use palpate_core::body::{FileError, SoftError};
use palpate_core::device::{DeviceError, HomingError, Refusal, WristError};
use palpate_core::pair::{ProxyError, ToolError};
use palpate_core::render::FeelError;
use palpate_core::servo::{ConfigError, Fault, KnobError, ProtectionError, RenderingError, SafetyError, SettingsError};

/// Result of a call. After any value but `Ok` the call had no effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    Ok = 0,
    Null = 1,
    Misaligned = 2,
    TooSmall = 3,
    NotReady = 4,
    NotFinite = 5,
    OutOfRange = 6,
    FileMagic = 16,
    FileVersion = 17,
    FileLength = 18,
    FileDamaged = 19,
    FileSection = 20,
    FileNumber = 21,
    FileCode = 22,
    FileMissing = 23,
    FileLeftOver = 24,
    FilePatch = 25,
    FileBody = 26,
    FileTables = 27,
    DeviceEncoder = 32,
    DeviceMotor = 33,
    DeviceFriction = 34,
    DeviceRange = 35,
    DeviceLimit = 36,
    DeviceMechanism = 37,
    DeviceCentre = 38,
    DeviceMass = 39,
    DeviceWeight = 40,
    SettingsRate = 48,
    SettingsStiffness = 49,
    SettingsDamping = 50,
    SettingsMaxForce = 51,
    SettingsVelocityCorner = 52,
    SettingsSoftStart = 53,
    SettingsBodyOrigin = 54,
    SettingsFriction = 55,
    SettingsMaxSlew = 56,
    SettingsSafeDamping = 57,
    SettingsLinkTimeout = 58,
    SettingsTexture = 59,
    SettingsCoupling = 60,
    SettingsPassivity = 61,
    SettingsEase = 62,
    ProtectionContinuous = 64,
    ProtectionTimeConstant = 65,
    ProtectionSpeed = 66,
    ProtectionSupply = 67,
    ProtectionInertia = 68,
    HomingAngle = 72,
    HomingStill = 73,
    HomingStop = 74,
    HomingTimeout = 75,
    HomingStarted = 76,
    SoftModes = 80,
    SoftMode = 81,
    SoftMotion = 82,
    SoftRate = 83,
    SoftNone = 84,
    KnobNone = 88,
    KnobDetents = 89,
    KnobClicks = 90,
    KnobTexture = 91,
    KnobSpring = 92,
    KnobEnds = 93,
    KnobDamping = 94,
    KnobFriction = 95,
    KnobNotch = 96,
    KnobMaxStiffness = 97,
    KnobMaxDamping = 98,
    KnobMaxTorque = 99,
    KnobReleaseRate = 100,
    KnobFar = 101,
    KnobUndamped = 102,
    KnobMargin = 103,
    ToolNone = 104,
    ToolMemory = 105,
    ToolHalf = 106,
    ToolRadius = 107,
    ToolThin = 108,
    ToolFriction = 109,
    ToolStiffness = 110,
    ToolPointFriction = 111,
    ToolTexture = 112,
    ToolCoupling = 113,
    ToolRotation = 114,
    WristNumbers = 115,
    WristRange = 116,
    WristJump = 117,
    KnobMotor = 118,
}

impl Status {
    const fn text(self) -> &'static CStr {
        match self {
            Self::Ok => c"done",
            Self::Null => c"a pointer is null",
            Self::Misaligned => c"a pointer is not aligned for what it points to",
            Self::TooSmall => c"the memory given is too small",
            Self::NotReady => c"the handle was not made here, was moved, or its body was loaded again",
            Self::NotFinite => c"a number is not finite",
            Self::OutOfRange => c"an index, a count or a code is out of its range",
            Self::FileMagic => c"not a body file: it does not start with PALP",
            Self::FileVersion => c"the file has another version; bake it again",
            Self::FileLength => c"the file has more or fewer bytes than it says",
            Self::FileDamaged => c"the file is damaged: its CRC-32 is not the one it says",
            Self::FileSection => c"a section of the file is not where it should be, or its length does not fit",
            Self::FileNumber => c"a number in the file is not finite",
            Self::FileCode => c"a record of the file has a kind or flag that there is not",
            Self::FileMissing => c"a record needs numbers that the file does not have",
            Self::FileLeftOver => c"the file has unused numbers",
            Self::FilePatch => c"a face of the file is not one",
            Self::FileBody => c"the body of the file is not one",
            Self::FileTables => c"the CRC-32 of the file's tables is not the one that was baked",
            Self::DeviceEncoder => c"an encoder's radians a count must be finite and not zero, its zero finite",
            Self::DeviceMotor => c"torque_at_full must not be 0, at most 200 Nm either way; a feed is all 0, or its supply and resistance are positive, its back_emf_share 0 to 1",
            Self::DeviceFriction => c"dry_friction must be 0 to its motor's torque_at_full, Nm",
            Self::DeviceRange => {
                c"a joint's minimum angle must be below its maximum, both within two turns (20 of an only joint); or both infinite of an only joint, with 4 to 16777216 counts a turn"
            }
            Self::DeviceLimit => c"min_margin must be above 0, at most 10 m/rad, max_force above 0, at most 1000 N; max_joint_rate, max_stiffness, max_damping positive and finite",
            Self::DeviceMechanism => c"the mechanism needs lengths of 0.001 to 2 m, offsets within 2 m, a side of 1 or -1, and directions of length 1",
            Self::DeviceCentre => c"the workspace's centre is out of the mechanism's reach: it is in metres",
            Self::DeviceMass => c"a mass of the mechanism must be finite and not negative",
            Self::DeviceWeight => c"a motor cannot hold the links' weight: check masses in kg, torque_at_full, and the protection's continuous share",
            Self::SettingsRate => c"the servo rate is in Hz and must be between 20 Hz and 100 kHz",
            Self::SettingsStiffness => c"the stiffness must be between 0 and the device's maximum",
            Self::SettingsDamping => c"the damping must be between 0 and the device's maximum",
            Self::SettingsMaxForce => c"the maximum force must be finite and not negative",
            Self::SettingsVelocityCorner => c"the velocity corner must be positive and finite",
            Self::SettingsSoftStart => c"the soft start must be finite and not negative",
            Self::SettingsBodyOrigin => c"the body's origin must be finite",
            Self::SettingsFriction => c"friction must be finite and not negative, dynamic not above static",
            Self::SettingsMaxSlew => c"the slew limit must be positive; INFINITY for none",
            Self::SettingsSafeDamping => c"the safe damping must be between 0 and the device's maximum",
            Self::SettingsLinkTimeout => c"the link's timeout must be positive; INFINITY for none",
            Self::SettingsTexture => c"a texture needs its function, and a share between 0 and 1",
            Self::SettingsCoupling => c"the virtual tool is too light: stiffness + coupling_stiffness must be below 2 * coupling_mass * rate^2, coupling_stiffness positive, coupling_damping not negative",
            Self::SettingsPassivity => c"passivity control's numbers must be finite and not negative, its resolution positive",
            Self::SettingsEase => c"easing's onset must be finite and not negative, its change finite and positive",
            Self::ProtectionContinuous => c"a motor's continuous torque must be a positive share of full duty",
            Self::ProtectionTimeConstant => {
                c"a winding's time constant must be between 100 and 2,400,000 ticks, and at most ten minutes"
            }
            Self::ProtectionSpeed => c"the maximum speeds must be positive, of the probe at most 10 m/s, of a joint at most 500 rad/s",
            Self::ProtectionSupply => c"the supply's minimum voltage must be below its maximum",
            Self::ProtectionInertia => c"the joints' inertias must be positive and finite",
            Self::HomingAngle => c"a reference angle must be finite",
            Self::HomingStill => c"homing must hold still for at least a tick",
            Self::HomingStop => c"a stop needs an angle, a speed not 0, and a positive torque, clearance and travel, all finite",
            Self::HomingTimeout => c"homing must be given more time than it is to hold still",
            Self::HomingStarted => c"homing must be set before the first tick",
            Self::SoftModes => c"a body that gives way has one to eight modes",
            Self::SoftMode => c"a mode's limit and bounds must not be negative, nor its bump's radius",
            Self::SoftMotion => {
                c"a mode needs a positive stiffness, no negative mass or damping, and at most 256 radians a tick"
            }
            Self::SoftRate => c"the rate of the modes must be a positive number of Hz",
            Self::SoftNone => c"the loop's body has no modes",
            Self::KnobNone => c"the loop renders no dial: start it with palpate_servo_start_dial",
            Self::KnobDetents => c"detents need a pitch from 1e-4 rad to half a turn, a centre within a turn, and no negative torque",
            Self::KnobClicks => c"clicks need a pitch from 1e-4 rad to half a turn, a snap from 0.5 to 1, no negative force, first <= last",
            Self::KnobTexture => c"a texture needs a pitch from 1e-4 rad to half a turn, a centre within a turn, and no negative torque",
            Self::KnobSpring => c"a spring needs a finite rest, and a stiffness and maximum torque that are finite and not negative",
            Self::KnobEnds => c"end stops must be in order, with a stiffness and a damping that are finite and not negative",
            Self::KnobDamping => c"the feel's damping must be finite and not negative",
            Self::KnobFriction => c"friction needs a torque that is finite and not negative, and a rate that is positive",
            Self::KnobNotch => c"a notch needs a finite place, a width from 1e-4 rad to half a turn, and no negative torque",
            Self::KnobMaxStiffness => c"the feel is stiffer than max_stiffness times radius squared: lower a stiffness or a torque, or widen a pitch",
            Self::KnobMaxDamping => c"the feel damps more than max_damping times radius squared: lower damping or friction",
            Self::KnobMaxTorque => c"the feel's torques add up to more than max_force times radius: lower one",
            Self::KnobMotor => c"the feel's torques add up to more than the motor's torque_at_full: lower one",
            Self::KnobReleaseRate => c"the dial's release rate must be positive and finite",
            Self::KnobFar => c"the dial is more than an eighth of a turn from there: turn it there first, or give a nearer position",
            Self::KnobMargin => c"min_margin of a dial must be at most 0.8 of its radius, or its force would never be whole",
            Self::ToolNone => c"the loop has no tool with a shape: start it with palpate_servo_start_serial_arm_tool or the like",
            Self::ToolMemory => c"a loop with a tool needs more memory: a palpate_tool_servo, of which pass the member servo and the whole size",
            Self::ToolHalf => c"the tool's half lengths must be 0 to 1e6 m",
            Self::ToolRadius => c"the tool's radius must be 0 to 1e6 m",
            Self::ToolThin => c"the tool's radius must be positive, and at least a hundredth of its largest half length",
            Self::ToolFriction => c"the tool's friction must be 0 to 2",
            Self::ToolStiffness => c"a tool with a shape needs settings whose stiffness and rate are positive and finite",
            Self::ToolPointFriction => c"friction_static and friction_dynamic are a point's: leave them 0, and set the tool's friction",
            Self::ToolTexture => c"texture_share is a point's: leave it 0 with a tool that has a shape",
            Self::ToolCoupling => c"coupling_mass is a point's: leave it 0 with a tool that has a shape, which has its own coupling",
            Self::ToolRotation => c"the orientation is no rotation: it needs a quaternion x, y, z, w of length 1",
            Self::WristNumbers => c"a wrist needs axes of length 1, none along the one before, radians a count not 0, rising ranges and a positive rate",
            Self::WristRange => c"an axis of the wrist is out of its range: check its encoder and zero",
            Self::WristJump => c"an axis of the wrist has jumped: check its encoder and wiring",
            Self::KnobUndamped => c"the feel is too stiff for its damping, a dial that is let go of would ring: raise the damping first, or weaken a part",
        }
    }

    const ALL: [Self; 89] = [
        Self::Ok,
        Self::Null,
        Self::Misaligned,
        Self::TooSmall,
        Self::NotReady,
        Self::NotFinite,
        Self::OutOfRange,
        Self::FileMagic,
        Self::FileVersion,
        Self::FileLength,
        Self::FileDamaged,
        Self::FileSection,
        Self::FileNumber,
        Self::FileCode,
        Self::FileMissing,
        Self::FileLeftOver,
        Self::FilePatch,
        Self::FileBody,
        Self::FileTables,
        Self::DeviceEncoder,
        Self::DeviceMotor,
        Self::DeviceFriction,
        Self::DeviceRange,
        Self::DeviceLimit,
        Self::DeviceMechanism,
        Self::DeviceCentre,
        Self::DeviceMass,
        Self::DeviceWeight,
        Self::SettingsRate,
        Self::SettingsStiffness,
        Self::SettingsDamping,
        Self::SettingsMaxForce,
        Self::SettingsVelocityCorner,
        Self::SettingsSoftStart,
        Self::SettingsBodyOrigin,
        Self::SettingsFriction,
        Self::SettingsMaxSlew,
        Self::SettingsSafeDamping,
        Self::SettingsLinkTimeout,
        Self::SettingsTexture,
        Self::SettingsCoupling,
        Self::SettingsPassivity,
        Self::SettingsEase,
        Self::ProtectionContinuous,
        Self::ProtectionTimeConstant,
        Self::ProtectionSpeed,
        Self::ProtectionSupply,
        Self::ProtectionInertia,
        Self::HomingAngle,
        Self::HomingStill,
        Self::HomingStop,
        Self::HomingTimeout,
        Self::HomingStarted,
        Self::SoftModes,
        Self::SoftMode,
        Self::SoftMotion,
        Self::SoftRate,
        Self::SoftNone,
        Self::KnobNone,
        Self::KnobDetents,
        Self::KnobClicks,
        Self::KnobTexture,
        Self::KnobSpring,
        Self::KnobEnds,
        Self::KnobDamping,
        Self::KnobFriction,
        Self::KnobNotch,
        Self::KnobMaxStiffness,
        Self::KnobMaxDamping,
        Self::KnobMaxTorque,
        Self::KnobReleaseRate,
        Self::KnobFar,
        Self::KnobUndamped,
        Self::KnobMargin,
        Self::ToolNone,
        Self::ToolMemory,
        Self::ToolHalf,
        Self::ToolRadius,
        Self::ToolThin,
        Self::ToolFriction,
        Self::ToolStiffness,
        Self::ToolPointFriction,
        Self::ToolTexture,
        Self::ToolCoupling,
        Self::ToolRotation,
        Self::WristNumbers,
        Self::WristRange,
        Self::WristJump,
        Self::KnobMotor,
    ];
}

/// For the last line of each call.
pub fn code<T>(done: Result<T, Status>) -> Status {
    match done {
        Ok(_) => Status::Ok,
        Err(status) => status,
    }
}

impl From<FileError> for Status {
    fn from(error: FileError) -> Self {
        match error {
            FileError::Unaligned => Self::Misaligned,
            FileError::Magic => Self::FileMagic,
            FileError::Version { .. } => Self::FileVersion,
            FileError::Length { .. } => Self::FileLength,
            FileError::Damaged { .. } => Self::FileDamaged,
            FileError::Section { .. } => Self::FileSection,
            FileError::Number { .. } => Self::FileNumber,
            FileError::Code { .. } => Self::FileCode,
            FileError::Missing { .. } => Self::FileMissing,
            FileError::UnusedCoefficients { .. } => Self::FileLeftOver,
            FileError::BufferTooSmall { .. } => Self::TooSmall,
            FileError::Patch { .. } => Self::FilePatch,
            FileError::Body(_) => Self::FileBody,
            FileError::Tables { .. } => Self::FileTables,
            // A later version of the library may find more.
            _ => Self::FileSection,
        }
    }
}

impl From<DeviceError> for Status {
    fn from(error: DeviceError) -> Self {
        match error {
            DeviceError::Encoder(_) => Self::DeviceEncoder,
            DeviceError::Motor(_) => Self::DeviceMotor,
            DeviceError::Friction(_) => Self::DeviceFriction,
            DeviceError::Range(_) | DeviceError::Endless(_) => Self::DeviceRange,
            DeviceError::Limit => Self::DeviceLimit,
            DeviceError::Mechanism(_) => Self::DeviceMechanism,
            DeviceError::Centre => Self::DeviceCentre,
            DeviceError::Mass(_) => Self::DeviceMass,
            DeviceError::Weight { .. } => Self::DeviceWeight,
        }
    }
}

impl From<ConfigError> for Status {
    fn from(error: ConfigError) -> Self {
        match error {
            ConfigError::Device(error) => error.into(),
            ConfigError::Settings(error) => error.into(),
            ConfigError::Rendering(error) => error.into(),
            ConfigError::Safety(error) => error.into(),
            ConfigError::Protection(error) => error.into(),
            _ => Self::OutOfRange,
        }
    }
}

impl From<SettingsError> for Status {
    fn from(error: SettingsError) -> Self {
        match error {
            SettingsError::Rate => Self::SettingsRate,
            SettingsError::Stiffness => Self::SettingsStiffness,
            SettingsError::Damping => Self::SettingsDamping,
            SettingsError::MaxForce => Self::SettingsMaxForce,
            SettingsError::VelocityCorner => Self::SettingsVelocityCorner,
            SettingsError::SoftStart => Self::SettingsSoftStart,
            SettingsError::BodyOrigin => Self::SettingsBodyOrigin,
            _ => Self::OutOfRange,
        }
    }
}

impl From<RenderingError> for Status {
    fn from(error: RenderingError) -> Self {
        match error {
            RenderingError::Friction => Self::SettingsFriction,
            RenderingError::Slew => Self::SettingsMaxSlew,
            RenderingError::Texture => Self::SettingsTexture,
            RenderingError::Coupling => Self::SettingsCoupling,
            RenderingError::Passivity => Self::SettingsPassivity,
            RenderingError::Ease => Self::SettingsEase,
            // A later version of the library may have more.
            _ => Self::OutOfRange,
        }
    }
}

impl From<SafetyError> for Status {
    fn from(error: SafetyError) -> Self {
        match error {
            SafetyError::Damping => Self::SettingsSafeDamping,
            SafetyError::LinkTimeout => Self::SettingsLinkTimeout,
            // Limits that a C caller cannot choose.
            _ => Self::OutOfRange,
        }
    }
}

impl From<ProtectionError> for Status {
    fn from(error: ProtectionError) -> Self {
        match error {
            ProtectionError::Continuous => Self::ProtectionContinuous,
            ProtectionError::TimeConstant => Self::ProtectionTimeConstant,
            ProtectionError::Speed => Self::ProtectionSpeed,
            ProtectionError::Supply => Self::ProtectionSupply,
            ProtectionError::Inertia => Self::ProtectionInertia,
            _ => Self::OutOfRange,
        }
    }
}

impl From<HomingError> for Status {
    fn from(error: HomingError) -> Self {
        match error {
            HomingError::Angle => Self::HomingAngle,
            HomingError::StillTicks => Self::HomingStill,
            HomingError::Stop => Self::HomingStop,
            HomingError::TimeoutTicks => Self::HomingTimeout,
            // No loop of this library looks for a field.
            HomingError::Field | HomingError::PolePairs => Self::OutOfRange,
        }
    }
}

impl From<SoftError> for Status {
    fn from(error: SoftError) -> Self {
        match error {
            SoftError::Modes => Self::SoftModes,
            SoftError::Mode { .. } => Self::SoftMode,
            SoftError::Motion { .. } => Self::SoftMotion,
            SoftError::Rate => Self::SoftRate,
            // Each mode has its motion.
            _ => Self::OutOfRange,
        }
    }
}

impl From<KnobError> for Status {
    fn from(error: KnobError) -> Self {
        match error {
            KnobError::Feel(FeelError::Detents) => Self::KnobDetents,
            KnobError::Feel(FeelError::Clicks) => Self::KnobClicks,
            KnobError::Feel(FeelError::Texture) => Self::KnobTexture,
            KnobError::Feel(FeelError::Spring) => Self::KnobSpring,
            KnobError::Feel(FeelError::Ends) => Self::KnobEnds,
            KnobError::Feel(FeelError::Damping) => Self::KnobDamping,
            KnobError::Feel(FeelError::Friction) => Self::KnobFriction,
            KnobError::Feel(FeelError::Notch) => Self::KnobNotch,
            KnobError::Stiffness { .. } => Self::KnobMaxStiffness,
            KnobError::Damping { .. } => Self::KnobMaxDamping,
            KnobError::Torque { .. } => Self::KnobMaxTorque,
            KnobError::Motor { .. } => Self::KnobMotor,
            KnobError::LetGo => Self::KnobReleaseRate,
            KnobError::Far { .. } => Self::KnobFar,
            KnobError::Undamped { .. } => Self::KnobUndamped,
            KnobError::Margin => Self::KnobMargin,
            // The table is this library's.
            _ => Self::OutOfRange,
        }
    }
}

impl From<ToolError> for Status {
    fn from(error: ToolError) -> Self {
        match error {
            ToolError::Half => Self::ToolHalf,
            ToolError::Radius => Self::ToolRadius,
            // No core of this library is a body.
            _ => Self::OutOfRange,
        }
    }
}

impl From<ProxyError> for Status {
    fn from(error: ProxyError) -> Self {
        match error {
            ProxyError::Thin => Self::ToolThin,
            ProxyError::Coupling => Self::ToolStiffness,
            ProxyError::Friction => Self::ToolFriction,
            // Those of a tick refuse no tool.
            _ => Self::OutOfRange,
        }
    }
}

impl From<WristError> for Status {
    fn from(error: WristError) -> Self {
        match error {
            WristError::Range(_) => Self::WristRange,
            WristError::Jump(_) => Self::WristJump,
            _ => Self::OutOfRange,
        }
    }
}

/// A status in words, a static string; "unknown" for an unknown code.
#[unsafe(no_mangle)]
pub extern "C" fn palpate_status_text(status: i32) -> *const c_char {
    let known = Status::ALL.into_iter().find(|known| *known as i32 == status);
    known.map_or(c"unknown", Status::text).as_ptr()
}

/// A fault in words, a static string; "none" for 0, "unknown" for an unknown code.
#[unsafe(no_mangle)]
pub extern "C" fn palpate_fault_text(fault: u32) -> *const c_char {
    let text = match u8::try_from(fault).ok().and_then(Fault::from_code) {
        None if fault == 0 => c"none",
        None => c"unknown",
        Some(Fault::FrameLost) => c"sensor frame lost or late",
        Some(Fault::FrameDamaged) => c"sensor frame damaged",
        Some(Fault::JointOutOfRange) => c"joint angle out of range",
        Some(Fault::JointJumped) => c"joint angle jumped",
        Some(Fault::NotFinite) => c"force not finite",
        Some(Fault::JointStuck) => c"joint sensor stuck",
        Some(Fault::Overrun) => c"tick overrun",
        Some(Fault::LinkLost) => c"host link lost",
        Some(Fault::TableCorrupt) => c"table corrupted",
        Some(Fault::WatchdogReset) => c"reset by the watchdog",
        Some(Fault::BrownOut) => c"reset by a brown-out",
        Some(Fault::Drive) => c"motor driver fault",
        Some(Fault::Homing) => c"homing refused",
        Some(Fault::Stopped) => c"stopped by hand",
        Some(Fault::Unreachable) => c"pose out of the mechanism's reach",
        Some(Fault::ContactLost) => c"contact lost repeatedly",
        Some(Fault::Overspeed) => c"moving too fast under force",
        Some(Fault::Supply) => c"motor supply out of range or not measured",
        Some(Fault::WrongPolarity) => c"encoder and motor polarity disagree",
        Some(Fault::Calibration) => c"the calibration stored in flash is refused",
        Some(Fault::Magnet) => c"sensor magnet too strong or too weak",
        Some(Fault::Frozen) => c"sensor reading frozen",
        Some(Fault::OtherRate) => c"surface made for another rate",
    };
    text.as_ptr()
}

/// A refusal of homing in words, a static string; "none" for 0, "unknown" for an unknown code.
#[unsafe(no_mangle)]
pub extern "C" fn palpate_refusal_text(refusal: u32) -> *const c_char {
    let known = Refusal::ALL.into_iter().find(|known| u32::from(known.code()) == refusal);
    let text = match known {
        None if refusal == 0 => c"none",
        None => c"unknown",
        Some(Refusal::Moving) => c"the device was moving",
        Some(Refusal::NoIndex) => c"a joint did not pass its index mark",
        Some(Refusal::Sensor) => c"a sensor failed",
        Some(Refusal::OutOfTolerance) => c"a sensor reads something else than at the reference pose",
        Some(Refusal::Jammed) => c"a joint is jammed",
        Some(Refusal::NoStop) => c"a joint found no stop",
        Some(Refusal::TooFast) => c"a joint moved too fast",
        Some(Refusal::WrongDirection) => c"a joint moved the wrong way",
        Some(Refusal::TooLate) => c"homing took too long",
        Some(Refusal::NotFollowed) => c"a rotor did not follow its field",
    };
    text.as_ptr()
}
