//! Detection of a sensor whose reading never changes.

/// Tells a frozen sensor from a joint that is held still.
///
/// A magnetic sensor's last bits always carry noise: an AS5047P's is 0.068° (data sheet, 1 σ), three of its counts. A
/// reading that does not change by a single count for hundreds of ticks is no measurement any more, even if the frame's
/// parity is correct. On a device with one joint there is no other joint to compare it with. Do not use it with an
/// encoder that counts lines, which may well stand still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frozen {
    most: u32,
    last: Option<u32>,
    same: u32,
}

impl Frozen {
    /// For an AS5047P: 1,000 equal readings, a quarter of a second at 4 kHz.
    pub const AS5047P: Self = Self::after(1_000);

    /// A detector that accepts up to `most` equal readings in a row.
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
