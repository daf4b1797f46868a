//! Contact of the probe with a surface.

use super::BoundaryMode;

/// Contact as a state: the sign of the gap alone does not distinguish a probe in the wall from one that went round the
/// rim.
///
/// Contact starts when the probe crosses the surface from the front, over the face. It ends when the probe comes out
/// or slides over the rim. A probe that starts inside, or comes from behind, gets no force until it has been in front.
/// The variants are in rising order towards a force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Contact {
    /// Behind the surface without having crossed it: no force. The start state.
    #[default]
    Behind = 0,
    /// In front of the surface.
    InFront = 1,
    /// Pressed through the surface from the front.
    Touching = 2,
}

impl Contact {
    /// Every contact, in the order of its number.
    pub const ALL: [Self; 3] = [Self::Behind, Self::InFront, Self::Touching];

    /// The next state, from the signed gap (metres, negative behind the surface) and the witness point's mode.
    #[inline]
    pub fn next(self, gap: f32, mode: BoundaryMode) -> Self {
        if gap >= 0.0 {
            return Self::InFront;
        }
        // Held at a border means that the probe is beyond the rim.
        match (self, mode) {
            (Self::InFront | Self::Touching, BoundaryMode::Interior) => Self::Touching,
            _ => Self::Behind,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use BoundaryMode::{Interior, LowerU};

    #[test]
    fn contact_begins_only_from_the_front() {
        assert_eq!(Contact::default().next(-0.001, Interior), Contact::Behind);
        assert_eq!(Contact::default().next(0.001, Interior).next(-0.001, Interior), Contact::Touching);
    }

    #[test]
    fn sliding_over_the_rim_releases_until_the_probe_has_been_in_front_again() {
        let released = Contact::Touching.next(-0.001, LowerU);
        assert_eq!(released, Contact::Behind);
        assert_eq!(released.next(-0.001, Interior), Contact::Behind);
        assert_eq!(released.next(0.0, LowerU).next(-0.001, Interior), Contact::Touching);
    }

    #[test]
    fn a_gap_that_is_not_a_number_is_never_contact() {
        assert_eq!(Contact::Behind.next(f32::NAN, Interior), Contact::Behind);
    }
}
