//! From a duty and the angle of the field to the pulse widths of three phases.

use super::Field;
use crate::device::Duty;
use crate::math::{saturate, sin_cos};

/// Full duty, as amplitude of a phase in shares of the supply: `1/√3`, the most that a sine can have where the star
/// point may move.
const FULL: f32 = 0.577_350_3;
const HALF_ROOT_THREE: f32 = 0.866_025_4;

/// How the voltages of three phases are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Modulation {
    /// The fraction of a pulse-width period in which neither switch of a leg conducts, at each change: dead time times
    /// frequency. The current then flows through a diode, and the phase loses that fraction of the supply, against its
    /// current; the modulation compensates it. Zero if it is not known.
    pub dead_fraction: f32,
    /// The phase voltage, as a share of the supply, whose current is as large as half of its ripple. Below it the
    /// current has both signs within a period, and less and less of the dead time shows.
    ///
    /// `R / (8 L f)` with a phase's resistance and inductance, half of those between two wires, at a pulse frequency
    /// `f`: a leg at half width drives a ripple of `V / (4 L f)` against a star point at half of the supply `V`. Legs
    /// that switch together drive less. A value that is too large compensates less at small currents.
    pub ripple_fraction: f32,
}

impl Modulation {
    /// Switches without dead time.
    pub const IDEAL: Self = Self { dead_fraction: 0.0, ripple_fraction: 1.0 };

    /// The pulse widths, shares of a period, 0 to 1.
    ///
    /// Sines about a common middle that moves so that the highest and the lowest are equally far from the rails: the
    /// widths of space-vector modulation (J. Holtz, *Pulsewidth modulation for electronic power conversion*, Proc. IEEE
    /// 82, 1994), whose full duty is `1/√3` of the supply in place of ½.
    ///
    /// The dead time's share goes with each phase's current: with the part of its voltage that does not meet back-EMF.
    /// By the whole voltage's sign a dial without torque would be driven on by the compensation of its own back-EMF.
    #[inline]
    pub fn widths(&self, field: Field, duty: Duty) -> [f32; 3] {
        let (sine, cosine) = sin_cos(field.angle.radians());
        let across = sine * HALF_ROOT_THREE;
        let unit = [cosine, across - 0.5 * cosine, -across - 0.5 * cosine];
        let amplitude = duty.fraction() * FULL;
        let phases = unit.map(|share| amplitude * share);
        let mut lowest = phases[0];
        let mut highest = phases[0];
        for phase in phases {
            lowest = if phase < lowest { phase } else { lowest };
            highest = if phase > highest { phase } else { highest };
        }
        let middle = 0.5 - 0.5 * (lowest + highest);
        let driving = (duty.fraction() - field.back_emf.fraction()) * FULL / self.ripple_fraction;
        unit.map(|share| {
            let made_up = self.dead_fraction * saturate(driving * share, -1.0, 1.0);
            saturate(amplitude * share + middle + made_up, 0.0, 1.0)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::{Duty, ElectricalAngle};

    /// Clarke's transformation of the widths: the field's vector, in shares of full duty.
    fn vector([a, b, c]: [f32; 3]) -> [f64; 2] {
        let [a, b, c] = [a, b, c].map(f64::from);
        [(2.0 * a - b - c) / 3.0 * 3_f64.sqrt(), (b - c)]
    }

    #[test]
    fn the_widths_are_those_of_the_field_and_reach_the_rails_at_full_duty() {
        let (mut lowest, mut highest) = (1.0_f32, 0.0_f32);
        for duty in [Duty::FULL, Duty(-32_767), Duty(1_234), Duty::ZERO] {
            for angle in (0..=u16::MAX).step_by(17) {
                let widths = Modulation::IDEAL.widths(Field::at_rest(ElectricalAngle(angle)), duty);
                let [x, y] = vector(widths);
                let (sine, cosine) = (f64::from(angle) / 65_536.0 * core::f64::consts::TAU).sin_cos();
                let size = f64::from(duty.fraction());
                // A few roundings of 1.
                assert!((x - size * cosine).abs() < 1e-6 && (y - size * sine).abs() < 1e-6, "{duty:?} {angle}");
                for width in widths {
                    (lowest, highest) = (lowest.min(width), highest.max(width));
                }
            }
        }
        assert!(lowest < 1e-4 && highest > 1.0 - 1e-4, "{lowest} {highest}");
        assert_eq!(Modulation::IDEAL.widths(Field::default(), Duty::ZERO), [0.5; 3]);
    }

    #[test]
    fn dead_time_is_made_up_for_with_the_sign_of_each_current() {
        const DEAD: Modulation = Modulation { dead_fraction: 0.01, ripple_fraction: 0.02 };
        // Volts of 8,000, and the signs that the current of the first phase and of the others then has: more volts than
        // the back-EMF, the same, and fewer.
        for (back_emf, signs) in [(0, [1.0, -1.0, -1.0]), (8_000, [0.0; 3]), (16_000, [-1.0, 1.0, 1.0])] {
            let field = Field { angle: ElectricalAngle(0), back_emf: Duty(back_emf) };
            let plain = Modulation::IDEAL.widths(field, Duty(8_000));
            let made_up = DEAD.widths(field, Duty(8_000));
            for (phase, sign) in signs.into_iter().enumerate() {
                assert!((made_up[phase] - plain[phase] - sign * 0.01).abs() < 1e-6, "{back_emf} {phase}");
            }
        }
        assert_eq!(DEAD.widths(Field::default(), Duty::ZERO), [0.5; 3]);
    }
}
