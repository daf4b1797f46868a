//! Why homing may end without angles.

use thiserror::Error;

/// Why homing was refused. Latched: start again from [`super::HomingState::default`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[repr(u8)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Refusal {
    /// The time is over and the device never held still long enough.
    #[error("the device was moving")]
    Moving = 1,
    /// The time is over and a joint has not passed its index mark.
    #[error("a joint did not pass its index mark")]
    NoIndex = 2,
    /// A sensor failed.
    #[error("a sensor failed")]
    Sensor = 3,
    /// It held still, but elsewhere than at the reference.
    #[error("a sensor reads something else than at the reference pose")]
    OutOfTolerance = 4,
    /// A joint did not come off from where it stood: something holds it, or it is driven the wrong way into a stop.
    #[error("a joint is jammed")]
    Jammed = 5,
    /// A joint went further than its stop can be.
    #[error("a joint found no stop")]
    NoStop = 6,
    /// A joint moved faster than it was driven: a hand pulls it, or its motor runs away.
    #[error("a joint moved too fast")]
    TooFast = 7,
    /// A joint moved against the way it was driven: encoder or motor is wired the other way, or the load is too heavy.
    #[error("a joint moved the wrong way")]
    WrongDirection = 8,
    /// The time is over.
    #[error("homing took too long")]
    TooLate = 9,
    /// A rotor did not follow its field: another number of pole pairs, a phase without current, a sensor that is stuck
    /// or slips, or a hand that holds on.
    #[error("a rotor did not follow its field")]
    NotFollowed = 10,
}

impl Refusal {
    /// Every refusal, in the order of its code.
    pub const ALL: [Self; 10] = [
        Self::Moving,
        Self::NoIndex,
        Self::Sensor,
        Self::OutOfTolerance,
        Self::Jammed,
        Self::NoStop,
        Self::TooFast,
        Self::WrongDirection,
        Self::TooLate,
        Self::NotFollowed,
    ];

    /// The code in a report, from 1.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The refusal of a code; `None` for 0 and for codes that are not ours.
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|refusal| refusal.code() == code)
    }
}
