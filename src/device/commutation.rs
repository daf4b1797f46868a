//! Where the rotor of a motor with three phases stands, electrically, and where its field is put.

use super::Counts;

/// An angle of a motor's field or rotor: 65,536ths of an electrical turn, of which a motor of `n` pole pairs has `n` a
/// turn. It wraps by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ElectricalAngle(pub u16);

impl ElectricalAngle {
    /// A quarter of an electrical turn: so far ahead of the rotor a field gives the most torque.
    pub const QUARTER: Self = Self(1 << 14);

    /// Radians, −π to π.
    #[inline]
    pub fn radians(self) -> f32 {
        // The cast to 16 bits with a sign wraps: angles beyond half a turn are negative ones.
        f32::from(self.0 as i16) * (core::f32::consts::PI / 32_768.0)
    }
}

/// How the counts of a sensor on a motor's shaft go with its poles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Commutation {
    /// Counts of the sensor in a turn of the motor. If it is no power of two, the motor must not turn beyond 2³¹ counts:
    /// the count wraps there, between two turns' angles.
    pub counts_per_turn: u32,
    /// North poles of the rotor: half of its magnets.
    pub pole_pairs: u16,
}

/// The result of an alignment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Aligned {
    /// The rotor's electrical angle at count zero.
    pub at_zero: ElectricalAngle,
    /// Whether the sensor counts down where the field turns on: two phases are swapped, or the magnet is on the other
    /// side.
    pub reversed: bool,
}

impl Aligned {
    /// As a mark of homing, which is counts for other ways of it.
    pub(crate) const fn mark(self) -> Counts {
        Counts(self.at_zero.0 as i32 | (self.reversed as i32) << 16)
    }

    /// The inverse of [`Self::mark`].
    pub(crate) const fn of_mark(Counts(mark): Counts) -> Self {
        Self { at_zero: ElectricalAngle(mark as u16), reversed: mark >> 16 & 1 != 0 }
    }
}

impl Commutation {
    /// Whether the numbers make sense: at least 64 counts an electrical turn, which leaves 1 % of the torque for want
    /// of resolution, and a product that fits into 32 bits.
    pub const fn is_valid(&self) -> bool {
        self.pole_pairs > 0
            && self.counts_per_turn <= 1 << 20
            && self.counts_per_turn >= 64 * self.pole_pairs as u32
            && self.pole_pairs <= 1 << 8
    }

    /// Counts of an electrical turn, rounded down.
    pub const fn counts_per_electrical_turn(&self) -> u32 {
        if self.pole_pairs == 0 { 0 } else { self.counts_per_turn / self.pole_pairs as u32 }
    }

    /// The rotor's electrical angle at a count, from its angle at count zero.
    #[inline]
    pub fn rotor(&self, aligned: Aligned, Counts(counts): Counts) -> ElectricalAngle {
        // Nothing here divides by zero or wraps where the numbers are valid; elsewhere it is not to panic.
        let turn = if self.counts_per_turn == 0 { 1 } else { self.counts_per_turn };
        // Below 2²⁰ · 2⁸ = 2²⁸; then the remainder of an electrical turn, below 2²⁰, times 2¹⁶ in 64 bits.
        let in_turn = i64::from(counts).rem_euclid(i64::from(turn)) as u32;
        let in_electrical = in_turn.wrapping_mul(u32::from(self.pole_pairs)) % turn;
        // Of the middle of the count, as the joint's angle is.
        let angle = (((u64::from(in_electrical) << 16) + (u64::from(self.pole_pairs) << 15)) / u64::from(turn)) as u16;
        let turned = if aligned.reversed { angle.wrapping_neg() } else { angle };
        ElectricalAngle(turned.wrapping_add(aligned.at_zero.0))
    }

    /// Where the field is to be, so that a positive duty turns the rotor the way in which the counts rise, with all of
    /// its torque: a quarter of an electrical turn ahead.
    #[inline]
    pub fn field(&self, aligned: Aligned, counts: Counts) -> ElectricalAngle {
        let ElectricalAngle(rotor) = self.rotor(aligned, counts);
        let ElectricalAngle(quarter) = ElectricalAngle::QUARTER;
        ElectricalAngle(if aligned.reversed { rotor.wrapping_sub(quarter) } else { rotor.wrapping_add(quarter) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: Commutation = Commutation { counts_per_turn: 16_384, pole_pairs: 11 };

    /// The electrical angle by real numbers.
    fn exact(motor: &Commutation, counts: i32, sign: f64) -> f64 {
        let turns = (f64::from(counts) + 0.5) / f64::from(motor.counts_per_turn) * f64::from(motor.pole_pairs);
        (sign * turns * 65_536.0).rem_euclid(65_536.0)
    }

    #[test]
    fn the_rotor_s_angle_is_that_of_the_real_numbers_to_a_step_over_all_turns_and_both_ways() {
        for motor in [MOTOR, Commutation { counts_per_turn: 4_000, pole_pairs: 7 }] {
            for reversed in [false, true] {
                let aligned = Aligned { at_zero: ElectricalAngle(0), reversed };
                for counts in (-200_000..200_000).step_by(37).chain([i32::MIN, i32::MAX]) {
                    let ElectricalAngle(found) = motor.rotor(aligned, Counts(counts));
                    let expected = exact(&motor, counts, if reversed { -1.0 } else { 1.0 });
                    let off = (f64::from(found) - expected).rem_euclid(65_536.0);
                    assert!(!(1.001..=65_534.999).contains(&off), "{counts} {reversed}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn the_field_is_a_quarter_turn_ahead_in_the_way_the_counts_rise() {
        for reversed in [false, true] {
            let aligned = Aligned { at_zero: ElectricalAngle(1_000), reversed };
            let rotor = MOTOR.rotor(aligned, Counts(500)).0;
            let ahead = MOTOR.field(aligned, Counts(500)).0.wrapping_sub(rotor);
            assert_eq!(ahead, if reversed { 49_152 } else { 16_384 });
            // Where the rotor goes as the counts rise, the field was ahead.
            let next = MOTOR.rotor(aligned, Counts(600)).0.wrapping_sub(rotor);
            assert_eq!((next as i16 > 0), !reversed);
        }
    }

    #[test]
    fn numbers_that_make_no_sense_are_told_and_do_no_harm() {
        assert!(MOTOR.is_valid());
        for (counts_per_turn, pole_pairs) in [(0, 7), (4_000, 0), (400, 7), (1 << 21, 7), (u32::MAX, u16::MAX)] {
            let motor = Commutation { counts_per_turn, pole_pairs };
            assert!(!motor.is_valid(), "{motor:?}");
            motor.field(Aligned::default(), Counts(i32::MIN));
            motor.counts_per_electrical_turn();
        }
    }
}
