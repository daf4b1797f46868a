//! Passivity observer and controller: what the surface gives out is never more than it took in.

use crate::math::{Vec3, saturate};

/// Time-domain passivity control of the port between probe and surface (B. Hannaford and J.-H. Ryu, *Time-domain passivity control of haptic
/// interfaces*, IEEE Trans. Robotics and Automation 18(1), 2002).
///
/// The observer sums the energy the surface took, `E += −F·Δx + b ‖Δx‖²/T`, with the force that was held over the period and the
/// probe's move in it. The controller looks a period ahead, at the present velocity; where `E` would fall below half a quantum of debt it
/// brakes with `α v`, `α = deficit/(T ‖v‖²)`. It sees the port at the ticks: what the actuator's delay adds lies beyond.
///
/// The *quantum* is the work of the greatest force over one encoder count: no observer of counts can see less.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passivity {
    /// `b`: the device's own damping, N·s/m, which the sampled surface may spend. 0 is the careful choice.
    pub device_damping: f32,
    /// The greatest `α`, N·s/m: more damping than the device bears does harm.
    pub greatest_damping: f32,
    /// The quantum, J.
    pub quantum: f32,
}

/// What the observer remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Energy the surface holds, J; negative is a debt.
    pub stored: f32,
    /// `α` of this tick, N·s/m; 0 while idle.
    pub damping: f32,
}

impl Passivity {
    /// The energy after the probe moved by `moved` (m) under the force held since the last tick (N).
    #[inline]
    pub fn observe(&self, energy: &mut Energy, held: Vec3, moved: Vec3, rate: f32) {
        let taken = self.device_damping * moved.length_squared() * rate - held.dot(moved);
        energy.stored = saturate(energy.stored + taken, -f32::MAX, f32::MAX);
    }

    /// The force to give, N, in place of `force`. `touching` says whether the surface is felt: out of contact a surplus is
    /// forgotten, so that it cannot be spent later; a debt stays.
    #[inline]
    pub fn control(&self, energy: &mut Energy, force: Vec3, moved: Vec3, rate: f32, touching: bool) -> Vec3 {
        energy.damping = 0.0;
        if !touching {
            energy.stored = saturate(energy.stored, -f32::MAX, 0.0);
            return force;
        }
        let squared = moved.length_squared();
        let ahead = energy.stored + self.device_damping * squared * rate - force.dot(moved);
        let deficit = -0.5 * self.quantum - ahead;
        if deficit > 0.0 && squared > 0.0 {
            energy.damping = saturate(deficit / (squared * rate), 0.0, self.greatest_damping);
            return force - moved * (energy.damping * rate);
        }
        force
    }

    /// Whether all three are finite and not negative.
    pub const fn is_valid(&self) -> bool {
        let Self { device_damping, greatest_damping, quantum } = *self;
        let finite = device_damping < f32::INFINITY && greatest_damping < f32::INFINITY && quantum < f32::INFINITY;
        finite && device_damping >= 0.0 && greatest_damping >= 0.0 && quantum >= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONTROL: Passivity = Passivity { device_damping: 0.0, greatest_damping: 50.0, quantum: 1e-4 };
    const RATE: f32 = 1_000.0;

    #[test]
    fn work_done_on_the_surface_is_stored_and_given_back() {
        let mut energy = Energy::default();
        CONTROL.observe(&mut energy, Vec3::Z * 2.0, Vec3::Z * -0.001, RATE);
        assert!((energy.stored - 2e-3).abs() < 1e-9);
        CONTROL.observe(&mut energy, Vec3::Z * 3.0, Vec3::Z * 0.001, RATE);
        assert!((energy.stored + 1e-3).abs() < 1e-9);
    }

    #[test]
    fn a_debt_is_braked_to_half_a_quantum_in_one_period() {
        // A stored 1 mJ, and the surface is about to give 3 mJ.
        let mut energy = Energy { stored: 1e-3, damping: 0.0 };
        let moved = Vec3::Z * 0.001;
        let force = CONTROL.control(&mut energy, Vec3::Z * 3.0, moved, RATE, true);
        CONTROL.observe(&mut energy, force, moved, RATE);
        assert!((energy.stored + 0.5 * CONTROL.quantum).abs() < 1e-8, "{energy:?}");
        assert!(energy.damping > 0.0);
    }

    #[test]
    fn it_is_idle_within_its_means_and_forgets_a_surplus_when_it_lets_go() {
        let mut energy = Energy { stored: 4e-3, damping: 0.0 };
        let force = Vec3::Z * 3.0;
        assert_eq!(CONTROL.control(&mut energy, force, Vec3::Z * 0.001, RATE, true), force);
        CONTROL.control(&mut energy, Vec3::ZERO, Vec3::ZERO, RATE, false);
        assert_eq!(energy.stored, 0.0);
        energy.stored = -2e-3;
        CONTROL.control(&mut energy, Vec3::ZERO, Vec3::ZERO, RATE, false);
        assert_eq!(energy.stored, -2e-3);
    }
}
