//! The hand that holds the probe: a spring and a damper to where the hand wants to be.

use super::vector::{Vector, add_scaled, difference, scaled};

/// Where the hand wants the probe to be.
pub trait HandPath: Send + Sync {
    /// The point aimed at, m from the workspace centre, `time` s after the start.
    fn target(&self, time: f64) -> Vector;
    /// How fast that point moves, m/s.
    fn velocity(&self, time: f64) -> Vector;
}

/// A hand that stays where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StillHand(pub Vector);

impl HandPath for StillHand {
    fn target(&self, _time: f64) -> Vector {
        self.0
    }

    fn velocity(&self, _time: f64) -> Vector {
        [0.0; 3]
    }
}

/// Stiffness, damping and mass of the grip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandSettings {
    /// N/m.
    pub stiffness: f64,
    /// N·s/m.
    pub damping: f64,
    /// Mass of the fingers that moves with the probe, kg. The hand carries it: it adds inertia, not weight.
    pub mass: f64,
}

impl HandSettings {
    /// No hand at all.
    pub const NONE: Self = Self { stiffness: 0.0, damping: 0.0, mass: 0.0 };

    /// The force on the probe, N.
    pub fn force(&self, target: Vector, target_velocity: Vector, position: Vector, velocity: Vector) -> Vector {
        let spring = scaled(difference(target, position), self.stiffness);
        add_scaled(spring, difference(target_velocity, velocity), self.damping)
    }
}

impl Default for HandSettings {
    /// 300 N/m and 5 N·s/m: assumed, a light grip on a stylus. For scale, one fit to a whole arm on a haptic device
    /// gave 135 N/m, 6.5 N·s/m and 0.55 kg (figure 3 of doi 10.1038/srep18004). No mass by default: the lighter the
    /// probe, the faster it meets the surface's stiffness, so a hand without mass is the harder case for the servo.
    fn default() -> Self {
        Self { stiffness: 300.0, damping: 5.0, mass: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hand_pulls_towards_its_target_and_brakes() {
        let hand = HandSettings { stiffness: 300.0, damping: 5.0, mass: 0.0 };
        let force = hand.force([0.01, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0; 3], [0.0, 0.0, 0.1]);
        // 300 N/m × 10 mm, 5 N·s/m × 0.2 m/s, −5 N·s/m × 0.1 m/s; exact but for rounding.
        assert!(super::super::vector::norm(difference(force, [3.0, 1.0, -0.5])) < 1e-12, "{force:?}");
    }
}
