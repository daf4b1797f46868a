//! One motor, driven by hand.

use crate::device::{Counts, Duty};
use thiserror::Error;

/// The value that a frame must carry while the key is held: not a number that a faulty host would send by accident.
pub const KEY: u32 = 0x6865_6c64;
/// Seconds in which a duty grows to its limit.
const RAMP: f32 = 0.1;
/// Motion that is accepted at once, in seconds at maximum speed: counts are whole numbers, so one count in a tick is
/// not excess speed.
const SLACK: f32 = 0.02;

/// A command, as it comes over the link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Jog {
    /// Higher than that of the frame before, wrapping: a frame that comes twice holds no key.
    pub number: u32,
    /// [`KEY`] while the key is held.
    pub key: u32,
    /// The motor, from 0.
    pub motor: u8,
    /// The requested duty; the device's limit applies.
    pub duty: i16,
}

/// The device's limits for jogging. Constant, in its flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JogLimits<const JOINTS: usize> {
    /// Maximum duty of each motor: above dry friction and the links' weight, below a force that hurts.
    pub max_duty: [Duty; JOINTS],
    /// Maximum speed of each encoder, counts/s.
    pub max_speed_counts_per_s: f32,
    /// How far any encoder may be driven from where it was when the enable input was pressed, counts, however often the
    /// key is released and held again meanwhile.
    pub max_travel_counts: u32,
    /// Seconds without a frame after which a jog ends ([`JogRefusal::Silent`]).
    pub patience_s: f32,
}

/// Which limit is refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum JogLimitsError {
    /// A duty is negative or above half of full scale.
    #[error("a motor may be jogged with half of its full duty at most")]
    Duty,
    /// The speed is not positive and finite.
    #[error("the maximum speed must be positive and finite")]
    Speed,
    /// The patience is not between a tick and half a second.
    #[error("a silent key must count as let go after a tick at least and half a second at most")]
    Patience,
}

/// Why a jog ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum JogRefusal {
    /// A sensor did not answer.
    #[error("a sensor failed")]
    Sensor = 1,
    /// An encoder moved faster than it may.
    #[error("moved too fast")]
    TooFast = 2,
    /// An encoder was driven further than it may be. Another travel starts once the enable input was released.
    #[error("moved too far; release the enable button before going on")]
    TooFar = 3,
    /// There is no such motor.
    #[error("there is no such motor")]
    NoMotor = 4,
    /// Another motor was requested while the key was held.
    #[error("let the key go before another motor")]
    OtherMotor = 5,
    /// A drive did not apply its duty, or its amplifier is no longer ready.
    #[error("a drive does not respond")]
    Drive = 6,
    /// The tick took too long.
    #[error("the device was too slow")]
    Late = 7,
    /// No frame came for too long while the key was held.
    #[error("the key's frames stopped; release the key first")]
    Silent = 8,
}

impl JogRefusal {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Sensor,
        Self::TooFast,
        Self::TooFar,
        Self::NoMotor,
        Self::OtherMotor,
        Self::Drive,
        Self::Late,
        Self::Silent,
    ];

    /// The code in a reading, from 1.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The refusal with this code.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|refusal| refusal.code() == code)
    }
}

/// The limits, ready to run.
///
/// ```
/// use palpate::commission::{Jog, JogLimits, JogState, Jogging, KEY};
/// use palpate::device::{Counts, Duty};
///
/// let limits = JogLimits {
///     max_duty: [Duty(6_000)],
///     max_speed_counts_per_s: 20_000.0,
///     max_travel_counts: 4_000,
///     patience_s: 0.2,
/// };
/// let jogging = Jogging::try_new(limits, 4_000.0)?;
/// let mut state = JogState::default();
/// jogging.tick(&mut state, Some([Counts(0)]), true);
/// jogging.command(&mut state, Jog { number: 1, key: KEY, motor: 0, duty: 5_000 });
/// jogging.tick(&mut state, Some([Counts(0)]), true);
/// assert!(state.is_live() && state.duties()[0].0 > 0, "the duty rises");
/// // Enable is released: off in the same tick.
/// jogging.tick(&mut state, Some([Counts(1)]), false);
/// assert_eq!(state.duties(), [Duty::ZERO]);
/// # Ok::<(), palpate::commission::JogLimitsError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Jogging<const JOINTS: usize> {
    limits: JogLimits<JOINTS>,
    patience_ticks: u32,
    counts_a_tick: f32,
    slack: f32,
    /// By how much a duty grows in a tick, as a share of its limit, in 2⁻¹⁵.
    ramp: i32,
}

/// The state that changes from tick to tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JogState<const JOINTS: usize> {
    /// The last frame's number; `None` before the first.
    number: Option<u32>,
    /// Requested motor and duty, while the key is held.
    held: Option<(usize, i16)>,
    /// Ticks since a frame held the key.
    silent: u32,
    /// The last counts.
    counts: Option<[Counts; JOINTS]>,
    /// How far each encoder has been driven since the enable input was pressed, less what went back since, counts.
    driven: [i32; JOINTS],
    /// How much faster than allowed each encoder has been, counts.
    haste: [f32; JOINTS],
    refusal: Option<JogRefusal>,
    duties: [Duty; JOINTS],
}

impl<const JOINTS: usize> Default for JogState<JOINTS> {
    fn default() -> Self {
        Self {
            number: None,
            held: None,
            silent: 0,
            counts: None,
            driven: [0; JOINTS],
            haste: [0.0; JOINTS],
            refusal: None,
            duties: [Duty::ZERO; JOINTS],
        }
    }
}

impl<const JOINTS: usize> JogState<JOINTS> {
    /// The duties of the motors now.
    pub const fn duties(&self) -> [Duty; JOINTS] {
        self.duties
    }

    /// Why the last jog ended; latched until the key is released.
    pub const fn refusal(&self) -> Option<JogRefusal> {
        self.refusal
    }

    /// The last counts; `None` before the first, and while a sensor fails.
    pub const fn counts(&self) -> Option<[Counts; JOINTS]> {
        self.counts
    }

    /// Whether a motor is being driven.
    pub const fn is_live(&self) -> bool {
        self.held.is_some()
    }

    /// The last frame's number.
    pub const fn number(&self) -> u32 {
        match self.number {
            Some(number) => number,
            None => 0,
        }
    }
}

impl<const JOINTS: usize> Jogging<JOINTS> {
    /// Jogging in a loop of `rate`, Hz.
    ///
    /// # Errors
    /// The limit that is refused.
    pub const fn try_new(limits: JogLimits<JOINTS>, rate: f32) -> Result<Self, JogLimitsError> {
        let mut joint = 0;
        while joint < JOINTS {
            if limits.max_duty[joint].0 < 0 || limits.max_duty[joint].0 > Duty::FULL.0 / 2 {
                return Err(JogLimitsError::Duty);
            }
            joint += 1;
        }
        let moves = limits.max_speed_counts_per_s > 0.0 && limits.max_speed_counts_per_s < f32::INFINITY;
        if !moves {
            return Err(JogLimitsError::Speed);
        }
        let waits = limits.patience_s * rate >= 1.0 && limits.patience_s <= 0.5;
        if !waits {
            return Err(JogLimitsError::Patience);
        }
        let ramp = (32_768.0 / (RAMP * rate)) as i32;
        Ok(Self {
            limits,
            patience_ticks: (limits.patience_s * rate) as u32,
            counts_a_tick: limits.max_speed_counts_per_s / rate,
            slack: limits.max_speed_counts_per_s * SLACK + 2.0,
            ramp: if ramp > 1 { ramp } else { 1 },
        })
    }

    /// Takes a command, between two ticks.
    pub fn command(&self, state: &mut JogState<JOINTS>, jog: Jog) {
        let is_new = state.number.is_none_or(|last| (jog.number.wrapping_sub(last) as i32) > 0);
        if !is_new {
            return;
        }
        state.number = Some(jog.number);
        if jog.key != KEY {
            (state.held, state.refusal) = (None, None);
            state.duties = [Duty::ZERO; JOINTS];
            return;
        }
        if state.refusal.is_some() {
            return;
        }
        let motor = usize::from(jog.motor);
        match state.held {
            _ if motor >= JOINTS => self.refuse(state, JogRefusal::NoMotor),
            Some((held, _)) if held != motor => self.refuse(state, JogRefusal::OtherMotor),
            // Not a count further, however often the key is held again.
            None if state.driven.iter().any(|driven| self.is_far(*driven)) => self.refuse(state, JogRefusal::TooFar),
            // Without counts there is nothing to measure a motion from yet.
            None if state.counts.is_none() => {}
            None => {
                state.haste = [0.0; JOINTS];
                (state.held, state.silent) = (Some((motor, jog.duty)), 0);
            }
            Some(_) => (state.held, state.silent) = (Some((motor, jog.duty)), 0),
        }
    }

    /// One tick; the duties to apply are in the state when it returns. `counts` is `None` where a sensor failed.
    pub fn tick(&self, state: &mut JogState<JOINTS>, counts: Option<[Counts; JOINTS]>, enable: bool) {
        self.sense(state, counts);
        state.silent = state.silent.saturating_add(1);
        if !enable {
            (state.held, state.driven) = (None, [0; JOINTS]);
        } else if state.held.is_some() && state.silent > self.patience_ticks {
            self.refuse(state, JogRefusal::Silent);
        }
        let Some((motor, asked)) = state.held else {
            state.duties = [Duty::ZERO; JOINTS];
            return;
        };
        for (joint, (duty, most)) in state.duties.iter_mut().zip(self.limits.max_duty).enumerate() {
            let most = i32::from(most.0);
            let wanted = if joint == motor { i32::from(asked).clamp(-most, most) } else { 0 };
            let step = (most * self.ramp / 32_768).max(1);
            let now = i32::from(duty.0);
            // Off at once, on by and by. The clamp keeps it in an `i16`.
            let next = if joint == motor { wanted.clamp(now - step, now + step) } else { 0 };
            *duty = Duty(next.clamp(-most, most) as i16);
        }
    }

    const fn is_far(&self, driven: i32) -> bool {
        driven.unsigned_abs() > self.limits.max_travel_counts
    }

    /// Looks at where everything is.
    fn sense(&self, state: &mut JogState<JOINTS>, counts: Option<[Counts; JOINTS]>) {
        let Some(counts) = counts else {
            state.counts = None;
            self.refuse(state, JogRefusal::Sensor);
            return;
        };
        let before = state.counts.replace(counts).unwrap_or(counts);
        let is_held = state.held.is_some();
        let (mut fast, mut far) = (false, false);
        for joint in 0..JOINTS {
            let step = counts[joint].0.wrapping_sub(before[joint].0);
            let driven = &mut state.driven[joint];
            let next = driven.saturating_add(step);
            // A joint that falls back undoes what the motor did; a hand that moves it on does not add to it.
            *driven = match (is_held, *driven > 0) {
                (true, _) => next,
                (false, true) => next.clamp(0, *driven),
                (false, false) => next.clamp(*driven, 0),
            };
            if !is_held {
                continue;
            }
            let moved = counts[joint].0.abs_diff(before[joint].0) as f32 - self.counts_a_tick;
            let haste = state.haste[joint] + moved;
            state.haste[joint] = if haste > 0.0 { haste } else { 0.0 };
            fast |= haste > self.slack;
            far |= self.is_far(*driven);
        }
        if fast {
            self.refuse(state, JogRefusal::TooFast);
        } else if far {
            self.refuse(state, JogRefusal::TooFar);
        }
    }

    /// Ends a jog, if there is one, for a reason that the loop around it has detected. The first refusal is latched
    /// until the key is released.
    pub fn refuse(&self, state: &mut JogState<JOINTS>, refusal: JogRefusal) {
        state.held = None;
        state.refusal = state.refusal.or(Some(refusal));
        state.duties = [Duty::ZERO; JOINTS];
    }
}
