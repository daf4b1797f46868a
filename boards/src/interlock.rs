//! Force only once the enable input has been seen released, and then pressed.

/// Seconds of unbroken release that open the interlock: the contacts of a button bounce for less (6 ms in the worst of
/// Ganssle's measurements but one), and noise is shorter.
const RELEASE_S: f32 = 0.025;
/// Seconds of a press before it asks for force, two ticks at least: one sample may be a spike.
const PRESS_S: f32 = 0.000_5;

/// Between the enable input and the loop. It starts locked.
///
/// A button that is held while the board starts, a wire that is shorted, a person who leans on it through a stop: none
/// of them asks for force *now*, however the contact chatters. Letting go counts at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interlock {
    is_open: bool,
    was_open: bool,
    /// Ticks in a row in which the input was pressed, and released.
    pressed: u32,
    released: u32,
    /// Ticks in a row in which it was released and nothing held.
    free: u32,
    press_ticks: u32,
    release_ticks: u32,
}

/// Ticks of a time in a loop of `rate` Hz, two at least.
pub(crate) const fn ticks(seconds: f32, rate: f32) -> u32 {
    // The cast saturates.
    let ticks = (seconds * rate) as u32;
    if ticks > 2 { ticks } else { 2 }
}

impl Interlock {
    /// Locked, in a loop of `rate` Hz.
    pub const fn new(rate: f32) -> Self {
        Self {
            is_open: false,
            was_open: false,
            pressed: 0,
            released: 0,
            free: 0,
            press_ticks: ticks(PRESS_S, rate),
            release_ticks: ticks(RELEASE_S, rate),
        }
    }

    /// Whether force is asked for. A tick that is `held` locks it, whatever the input says then.
    #[inline]
    pub const fn next(&mut self, pressed: bool, held: bool) -> bool {
        if pressed {
            (self.pressed, self.released, self.free) = (self.pressed.saturating_add(1), 0, 0);
        } else {
            (self.pressed, self.released, self.free) =
                (0, self.released.saturating_add(1), self.free.saturating_add(1));
        }
        if held {
            (self.is_open, self.free) = (false, 0);
        } else if self.free >= self.release_ticks {
            (self.is_open, self.was_open) = (true, true);
        }
        self.is_open && self.pressed >= self.press_ticks
    }

    /// From now on the input has to be released first.
    pub const fn lock(&mut self) {
        (self.is_open, self.free) = (false, 0);
    }

    /// Whether the input has been seen released since the reset.
    pub const fn was_open(&self) -> bool {
        self.was_open
    }

    /// Whether the input has to be released first.
    pub const fn is_locked(&self) -> bool {
        !self.is_open
    }

    /// Ticks in a row in which the input was pressed.
    pub(crate) const fn pressed(&self) -> u32 {
        self.pressed
    }

    /// Whether the input has been released without a break for as long as opens the interlock.
    pub const fn is_released(&self) -> bool {
        self.released >= self.release_ticks
    }
}
