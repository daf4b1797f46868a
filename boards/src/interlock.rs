//! Force only once the enable input has been seen released.

/// Between the enable input and the loop. It starts locked.
///
/// A button that is held while the board starts, a wire that is shorted, a person who leans on it through a stop: none
/// of them asks for force *now*.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Interlock {
    is_open: bool,
    was_open: bool,
}

impl Interlock {
    /// Whether force is asked for. A tick that is `held` locks it, whatever the input says then.
    #[inline]
    pub const fn next(&mut self, pressed: bool, held: bool) -> bool {
        if held {
            self.is_open = false;
        } else if !pressed {
            (self.is_open, self.was_open) = (true, true);
        }
        pressed && self.is_open
    }

    /// From now on the input has to be released first.
    pub const fn lock(&mut self) {
        self.is_open = false;
    }

    /// Whether the input has been seen released since the reset.
    pub const fn was_open(&self) -> bool {
        self.was_open
    }

    /// Whether the input has to be released first.
    pub const fn is_locked(&self) -> bool {
        !self.is_open
    }
}
