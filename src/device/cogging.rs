//! Cogging: the torque with which a motor's magnets hold to the teeth of its iron, and the map that cancels it.

use crate::math::saturate;

/// The torque that cancels a joint's cogging, all around a turn. Recorded once ([`crate::device`] says how), a table in
/// flash.
///
/// Cogging comes from a potential, like weight: its compensation returns the energy that it took. So it is part of
/// gravity compensation ([`super::Kinematics::held_pose`]): given first, no part of the force, and zero without
/// [`crate::servo::Phase::Running`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoggingMap {
    /// N·m of a step of the table.
    step: f32,
    table: &'static [i8],
}

impl CoggingMap {
    /// A map from torques at evenly spaced angles, the first at joint angle zero, in steps of `step` N·m.
    ///
    /// # Panics
    /// At compile time, for a table of fewer than 16 or more than 16,384 entries, and for a step that is negative or
    /// not finite.
    pub const fn new(step: f32, table: &'static [i8]) -> Self {
        assert!(step >= 0.0 && step < f32::INFINITY, "a cogging map's step must be finite and not negative");
        assert!(table.len() >= 16 && table.len() <= 16_384, "a cogging map has 16 to 16,384 entries");
        Self { step, table }
    }

    /// The torque that cancels the cogging at a joint angle, radians, between the entries by a straight line. Zero for
    /// an angle that is not finite.
    #[inline]
    pub fn torque(&self, angle: f32) -> f32 {
        let turns = angle * (1.0 / core::f32::consts::TAU);
        // The cast saturates and turns NaN into 0; the fraction of a number that is not finite stays not finite.
        let whole = turns as i32 as f32;
        let fraction = turns - whole;
        let entries = self.table.len() as f32;
        let place = saturate((if fraction < 0.0 { fraction + 1.0 } else { fraction }) * entries, 0.0, entries);
        let index = place as usize;
        let share = place - index as f32;
        let (Some(here), Some(next)) = (self.table.get(index).or(self.table.first()), self.next(index)) else {
            return 0.0;
        };
        let (here, next) = (f32::from(*here), f32::from(*next));
        self.step * (here + (next - here) * share)
    }

    fn next(&self, index: usize) -> Option<&i8> {
        self.table.get(index + 1).or(self.table.first())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::TAU;

    static TABLE: [i8; 16] = [0, 10, 20, 30, 40, 30, 20, 10, 0, -10, -20, -30, -40, -30, -20, -10];
    const MAP: CoggingMap = CoggingMap::new(1e-3, &TABLE);

    #[test]
    fn between_its_entries_it_is_a_straight_line_and_it_goes_round() {
        for (sixteenths, expected) in [
            (0.0, 0.0),
            (1.0, 10e-3),
            (1.5, 15e-3),
            (4.0, 40e-3),
            (15.5, -5e-3),
            (-0.5, -5e-3),
            (-12.0, 40e-3),
            (36.0, 40e-3),
        ] {
            let found = MAP.torque(sixteenths / 16.0 * TAU);
            // Roundings of two turns by a slope of 160 steps a turn.
            assert!((found - expected).abs() < 1e-7, "{sixteenths}: {found} {expected}");
        }
    }

    #[test]
    fn whatever_the_angle_the_torque_is_finite() {
        for angle in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e9, -1e9, -1e-30] {
            let torque = MAP.torque(angle);
            assert!(torque.abs() <= 40e-3, "{angle}: {torque}");
        }
    }
}
