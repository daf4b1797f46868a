//! Two channels a quarter period apart, decoded by hand where no timer does it.

use super::EdgeMissed;
use crate::device::Counts;

/// A software quadrature decoder, four counts a line. Call it more often than edges come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Quadrature {
    phase: Option<i32>,
    counts: i32,
    missed: bool,
}

impl Quadrature {
    /// The count after the channels were read. It rises while A leads B: 00, 10, 11, 01.
    ///
    /// # Errors
    /// [`EdgeMissed`] if both channels changed, and from then on: counts were lost, so the position is unknown until
    /// the joint is homed with a new decoder.
    pub fn count(&mut self, a: bool, b: bool) -> Result<Counts, EdgeMissed> {
        // The Gray code's place in the cycle.
        let phase = match (a, b) {
            (false, false) => 0,
            (true, false) => 1,
            (true, true) => 2,
            (false, true) => 3,
        };
        let step = match self.phase.map(|last| (phase - last) & 3) {
            None | Some(0) => 0,
            Some(1) => 1,
            Some(3) => -1,
            Some(_) => {
                self.missed = true;
                0
            }
        };
        if self.missed {
            return Err(EdgeMissed);
        }
        self.phase = Some(phase);
        self.counts = self.counts.wrapping_add(step);
        Ok(Counts(self.counts))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_four_counts_either_way() {
        let cycle = [(false, false), (true, false), (true, true), (false, true)];
        let mut decoder = Quadrature::default();
        for place in (0_i32..=40).chain((-40..40).rev()) {
            let (a, b) = cycle[place.rem_euclid(4) as usize];
            assert_eq!(decoder.count(a, b), Ok(Counts(place)));
            assert_eq!(decoder.count(a, b), Ok(Counts(place)), "standing still");
        }
    }

    #[test]
    fn after_a_missed_edge_no_count_is_believed() {
        let mut decoder = Quadrature::default();
        assert_eq!(decoder.count(false, true), Ok(Counts(0)));
        assert_eq!(decoder.count(true, false), Err(EdgeMissed));
        assert_eq!(decoder.count(true, true), Err(EdgeMissed));
        assert_eq!(decoder.count(false, true), Err(EdgeMissed));
    }
}
