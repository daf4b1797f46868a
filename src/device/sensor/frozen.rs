//! A sensor that says the very same again and again.

/// Tells a sensor that has frozen from a joint that is held still.
///
/// A magnetic sensor's last bits are never quiet: an AS5047P's noise is 0.068° (data sheet, 1 σ), three of its counts.
/// A reading that does not change by a single count for hundreds of ticks is no measurement any more, whatever the
/// frame's parity says. Where one joint alone is felt nothing else can tell: there is no other joint to compare it
/// with. Do not use it with an encoder that counts lines, which may well stand still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frozen {
    most: u32,
    last: Option<u32>,
    same: u32,
}

impl Frozen {
    /// A watch that bears so many readings in a row that are all the same.
    pub const fn after(most: u32) -> Self {
        Self { most, last: None, same: 0 }
    }

    /// Takes note of a reading; whether it has been the same for too long.
    #[inline]
    pub fn is_frozen(&mut self, reading: u32) -> bool {
        self.same = if self.last == Some(reading) { self.same.saturating_add(1) } else { 0 };
        self.last = Some(reading);
        self.same >= self.most
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reading_that_is_the_same_for_too_long_is_told_and_one_count_is_enough_to_begin_anew() {
        let mut frozen = Frozen::after(3);
        let told: [bool; 10] = [7, 7, 7, 8, 8, 8, 8, 8, 7, 7].map(|reading| frozen.is_frozen(reading));
        assert_eq!(told, [false, false, false, false, false, false, true, true, false, false]);
    }
}
