//! Why a knob refuses its feels: two limits of its own, the error, and its text at run time and as a compile error.

use crate::render::FeelError;
use core::f32::consts::TAU;
use core::fmt;

/// The damping that a feel needs for each N·m/rad of its stiffness, N·m·s/rad: how late a gimbal motor's torque comes at
/// 4 kHz, by sensor, winding, computation and hold, and a fifth more. So damped, the simulated dial rests
/// even without friction, and where the motor's limit cuts the damping off. A lower servo rate needs more.
pub const DAMPING_PER_STIFFNESS_S: f32 = 7e-4;

/// How far a part of a feel that a host sets may take the dial, radians: an eighth of a turn.
pub const MAX_RETURN_RAD: f32 = TAU / 8.0;

/// Which number of a knob is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum KnobError {
    /// The table is empty, or has more than 255 entries.
    Feels,
    /// A feel makes no sense by itself.
    Feel(FeelError),
    /// The parts of a feel are together stiffer than the device's limit.
    Stiffness {
        /// The sum of the parts.
        asked_n_m_per_rad: f32,
        /// Of the device.
        limit_n_m_per_rad: f32,
    },
    /// They damp more than the device's limit.
    Damping {
        /// The sum of the parts.
        asked_n_m_s_per_rad: f32,
        /// Of the device.
        limit_n_m_s_per_rad: f32,
    },
    /// They have more torque than the device's maximum force at the dial's rim.
    Torque {
        /// The sum of the parts.
        asked_n_m: f32,
        /// Of the device.
        limit_n_m: f32,
    },
    /// The release rate is not positive and finite.
    LetGo,
    /// A part of the host's would take the dial further than [`MAX_RETURN_RAD`].
    Far {
        /// How far.
        asked_rad: f32,
    },
    /// A stored feel is restored before the first tick only.
    Late,
    /// A feel is chosen that does not exist.
    Missing {
        /// Its index.
        asked: u8,
        /// The last index that exists.
        last: u8,
    },
    /// The parts are too stiff for their damping ([`DAMPING_PER_STIFFNESS_S`]): a dial that is let go of would ring, driven
    /// by the motor.
    Undamped {
        /// Damping everywhere that they have.
        asked_n_m_s_per_rad: f32,
        /// That they need.
        needed_n_m_s_per_rad: f32,
    },
    /// The device's minimum margin is above 0.8 of the dial's radius, which is its margin everywhere: it would never have
    /// its whole force.
    Margin,
    /// They have more torque than the motor at full duty, which is less than the device's maximum force allows.
    Motor {
        /// The sum of the parts.
        asked_n_m: f32,
        /// Of the motor.
        limit_n_m: f32,
    },
}

impl KnobError {
    /// The refusal without its numbers, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Feels => "a knob has 1 to 255 feels",
            Self::Feel(error) => error.message(),
            Self::Stiffness { .. } => "a feel is stiffer than the device's maximum stiffness times its radius squared",
            Self::Damping { .. } => "a feel damps more than the device's maximum damping times its radius squared",
            Self::Torque { .. } => "a feel requests more torque than the device's maximum force times its radius",
            Self::Motor { .. } => "a feel requests more torque than the motor's torque at full duty",
            Self::LetGo => "the torque released per second must be positive and finite",
            Self::Far { .. } => "a part would turn the dial by more than an eighth of a turn",
            Self::Late => "a stored feel is restored before the first tick only",
            Self::Missing { .. } => "there is no such feel",
            Self::Margin => "the device's minimum margin must be at most 0.8 of the dial's radius",
            Self::Undamped { .. } => "a feel is too stiff for its damping: a dial that is let go of would ring",
        }
    }
}

impl fmt::Display for KnobError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The number of the device that is the limit, to be looked up or raised.
        let (whose, number) = match self {
            Self::Motor { .. } => ("motor", ""),
            Self::Stiffness { .. } => ("device", " (max_stiffness_n_per_m)"),
            Self::Damping { .. } => ("device", " (max_damping_n_s_per_m)"),
            _ => ("device", " (max_force_n)"),
        };
        let mut beyond = |does: &str, [asked, limit]: [f32; 2], unit: &str| {
            let [asked, limit] = [1e3 * asked, 1e3 * limit];
            write!(
                formatter,
                "with it the feel {does} {asked:.2} {unit}, and the {whose}'s limit is {limit:.2} {unit}{number}: "
            )?;
            formatter.write_str("weaken it or another part, or take one away")
        };
        match *self {
            Self::Stiffness { asked_n_m_per_rad: asked, limit_n_m_per_rad: limit } => {
                beyond("is as stiff as", [asked, limit], "mN·m/rad")
            }
            Self::Damping { asked_n_m_s_per_rad: asked, limit_n_m_s_per_rad: limit } => {
                beyond("damps by", [asked, limit], "mN·m·s/rad")?;
                formatter.write_str("; friction damps by its torque over its rate")
            }
            Self::Torque { asked_n_m: asked, limit_n_m: limit }
            | Self::Motor { asked_n_m: asked, limit_n_m: limit } => beyond("has up to", [asked, limit], "mN·m"),
            Self::Far { asked_rad: asked } => write!(
                formatter,
                "it would turn the dial by {asked:.2} rad ({:.0}°), and the limit is an eighth of a turn, \
                 {MAX_RETURN_RAD:.2} rad: turn the dial there first, or give a nearer position",
                asked.to_degrees()
            ),
            Self::Undamped { asked_n_m_s_per_rad: asked, needed_n_m_s_per_rad: needed } => write!(
                formatter,
                "with it a dial that is let go of would ring: the feel is damped by {:.2} mN·m·s/rad and stiff enough to \
                 need {:.2}; raise the damping first, or weaken a part",
                1e3 * asked,
                // Rounded up: as much is enough. The cast saturates.
                ((1e5 * needed + 0.9999) as u32) as f32 / 100.0
            ),
            Self::Missing { asked, last } => write!(formatter, "there is no feel {asked}: choose 0 to {last}"),
            _ => formatter.write_str(self.message()),
        }
    }
}

impl core::error::Error for KnobError {}

/// A refusal of a feel of the table: a panic at compile time formats nothing but one `&str`.
pub(super) struct Sentence {
    bytes: [u8; 256],
    length: usize,
}

impl Sentence {
    pub(super) const fn of(error: KnobError, index: usize) -> Self {
        let start = Self { bytes: [0; 256], length: 0 };
        let feel = start.with("feel ").with_number(index as u32, 1).with(" of the table, counted from 0: ");
        let feel = feel.with(error.message());
        match error {
            KnobError::Stiffness { asked_n_m_per_rad: asked, limit_n_m_per_rad: limit } => {
                feel.with_both(asked, ", maximum ", limit, " mN·m/rad")
            }
            KnobError::Damping { asked_n_m_s_per_rad: asked, limit_n_m_s_per_rad: limit } => {
                feel.with_both(asked, ", maximum ", limit, " mN·m·s/rad")
            }
            KnobError::Torque { asked_n_m: asked, limit_n_m: limit }
            | KnobError::Motor { asked_n_m: asked, limit_n_m: limit } => {
                feel.with_both(asked, ", maximum ", limit, " mN·m")
            }
            KnobError::Undamped { asked_n_m_s_per_rad: asked, needed_n_m_s_per_rad: needed } => {
                feel.with_both(asked, ", minimum ", needed, " mN·m·s/rad")
            }
            _ => feel,
        }
    }

    /// Two numbers in thousandths of their unit, to two digits.
    const fn with_both(self, asked: f32, between: &str, limit: f32, unit: &str) -> Self {
        // The casts saturate.
        let [asked, limit] = [(1e5 * asked + 0.5) as u32, (1e5 * limit + 0.5) as u32];
        let asked = self.with(" (").with_hundredths(asked).with(between);
        asked.with_hundredths(limit).with(unit).with(")")
    }

    const fn with_hundredths(self, number: u32) -> Self {
        self.with_number(number / 100, 1).with(".").with_number(number % 100, 2)
    }

    const fn with_number(self, number: u32, digits: u32) -> Self {
        let mut text = self;
        let mut place = 1_000_000_000;
        let mut left = 10;
        while left > 0 {
            if left <= digits || number >= place {
                text = text.with_byte(b'0' + (number / place % 10) as u8);
            }
            (place, left) = (if left > 1 { place / 10 } else { 1 }, left - 1);
        }
        text
    }

    const fn with(self, words: &str) -> Self {
        let mut text = self;
        let mut at = 0;
        while at < words.len() {
            text = text.with_byte(words.as_bytes()[at]);
            at += 1;
        }
        text
    }

    const fn with_byte(mut self, byte: u8) -> Self {
        if self.length < self.bytes.len() {
            self.bytes[self.length] = byte;
            self.length += 1;
        }
        self
    }

    pub(super) const fn as_str(&self) -> &str {
        match core::str::from_utf8(self.bytes.split_at(self.length).0) {
            Ok(text) => text,
            Err(_) => "a feel of the table",
        }
    }
}
