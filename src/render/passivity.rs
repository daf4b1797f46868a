//! Passivity observer and controller: the surface never gives out more energy than it took in.

use super::limit::saturated;
use crate::math::{Vec3, saturate, sqrt};

/// Time-domain passivity control of the port between probe and surface (B. Hannaford and J.-H. Ryu, *Time-domain
/// passivity control of haptic interfaces*, IEEE Trans. Robotics and Automation 18(1), 2002).
///
/// The *observer* sums the energy that the surface took: `E += −F·Δx + b ‖Δx‖²/T + f_c ‖Δx‖`, with the force held over
/// the period, the probe's move in it, and the device's own friction, which pays for some of the energy that sampling
/// generates.
///
/// The *controller* predicts a period ahead at the present velocity. Where `E` would fall below half a quantum of debt
/// it brakes with `α v`, `α = deficit/(T ‖v‖²)`. At a crawl the velocity is too coarse for braking: so the force is
/// also kept below `(E + quantum)/(‖Δx‖ + Δ)`, which a next move of at most a count more than this one cannot overdraw
/// (in the manner of J.-P. Kim and J. Ryu's energy-bounding algorithm, Int. J. Robotics Research 29(6), 2010).
///
/// The *quantum* is the work of the maximum force over one encoder count `Δ`: no observer of counts can resolve less.
/// The energy that the actuator's delay adds lies beyond the port and is not observed.
///
/// ```
/// use palpate::render::Passivity;
/// use palpate::servo::Rendering;
///
/// let passivity = Passivity {
///     device_damping_n_s_per_m: 0.0,
///     device_friction_n: 0.0,
///     max_damping_n_s_per_m: 8.0,
///     resolution_m: 40e-6,
/// };
/// let rendering = Rendering { passivity: Some(passivity), ..Rendering::PLAIN };
/// assert_eq!(rendering.check(1_000.0, 1.0 / 4_000.0), Ok(()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passivity {
    /// `b`: viscous friction the device has at least, N·s/m. 0 is the careful choice.
    pub device_damping_n_s_per_m: f32,
    /// `f_c`: dry friction the device has at least, N. 0 is the careful choice.
    pub device_friction_n: f32,
    /// Maximum `α`, N·s/m: damping beyond the device's limit destabilises it.
    pub max_damping_n_s_per_m: f32,
    /// `Δ`: how far the probe seems to move when every encoder counts one, m.
    pub resolution_m: f32,
}

/// The state of observer and controller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Energy the surface holds, J; negative is a debt, of at most a quantum.
    pub stored: f32,
    /// `α` of this tick, N·s/m; 0 while idle.
    pub damping: f32,
    /// Whether the force was cut back in this tick.
    pub cut: bool,
}

impl Energy {
    /// Whether the controller did anything in this tick.
    pub fn is_active(&self) -> bool {
        self.cut || self.damping > 0.0
    }
}

/// How the probe moves, as control sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// How far it moved in this period, m.
    pub moved: Vec3,
    /// Its velocity as estimated, m/s.
    pub velocity: Vec3,
    /// Servo rate, Hz.
    pub rate: f32,
}

impl Passivity {
    /// The quantum, J, of a surface with this maximum force, N.
    pub const fn quantum(&self, max_force: f32) -> f32 {
        max_force * self.resolution_m
    }

    /// Books the move of the last period under the force that was held in it, N.
    #[inline]
    pub fn observe(&self, energy: &mut Energy, held: Vec3, motion: &Moved) {
        let squared = motion.moved.length_squared();
        let friction = self.device_damping_n_s_per_m * squared * motion.rate + self.device_friction_n * sqrt(squared);
        energy.stored = saturate(energy.stored + friction - held.dot(motion.moved), -f32::MAX, f32::MAX);
    }

    /// The force to give in place of `force`, N, at most `max_force`. `touching`: whether the surface is in contact.
    /// Out of contact a surplus is cleared, so that it cannot be spent later; a debt stays.
    #[inline]
    pub fn control(&self, energy: &mut Energy, force: Vec3, motion: &Moved, touching: bool, max_force: f32) -> Vec3 {
        (energy.damping, energy.cut) = (0.0, false);
        if !touching {
            energy.stored = saturate(energy.stored, -f32::MAX, 0.0);
            return force;
        }
        let quantum = self.quantum(max_force);
        let mut passive = force;
        let squared = motion.velocity.length_squared();
        let power = force.dot(motion.velocity) - self.device_damping_n_s_per_m * squared;
        let deficit = -0.5 * quantum - energy.stored + power / motion.rate;
        if deficit > 0.0 && squared > 0.0 {
            energy.damping = saturate(deficit * motion.rate / squared, 0.0, self.max_damping_n_s_per_m);
            passive -= motion.velocity * energy.damping;
        }
        let reach = sqrt(motion.moved.length_squared()) + self.resolution_m;
        let most = saturate((energy.stored + quantum) / reach, 0.0, max_force);
        energy.cut = passive.length_squared() > most * most && most < max_force;
        saturated(passive, most)
    }

    /// Whether all four are finite and not negative, and the resolution is above zero.
    pub const fn is_valid(&self) -> bool {
        let Self {
            device_damping_n_s_per_m: device_damping,
            device_friction_n: device_friction,
            max_damping_n_s_per_m: max_damping,
            resolution_m: resolution,
        } = *self;
        let finite = device_damping < f32::INFINITY && device_friction < f32::INFINITY;
        let bounded = max_damping < f32::INFINITY && resolution < f32::INFINITY;
        let signs = device_damping >= 0.0 && device_friction >= 0.0 && max_damping >= 0.0 && resolution > 0.0;
        finite && bounded && signs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONTROL: Passivity = Passivity {
        device_damping_n_s_per_m: 0.0,
        device_friction_n: 0.0,
        max_damping_n_s_per_m: 50.0,
        resolution_m: 2e-5,
    };
    const GREATEST: f32 = 5.0;

    fn motion(moved: f32) -> Moved {
        Moved { moved: Vec3::Z * moved, velocity: Vec3::Z * (moved * 1_000.0), rate: 1_000.0 }
    }

    #[test]
    fn work_done_on_the_surface_is_stored_and_given_back() {
        let mut energy = Energy::default();
        CONTROL.observe(&mut energy, Vec3::Z * 2.0, &motion(-0.001));
        assert!((energy.stored - 2e-3).abs() < 1e-9);
        CONTROL.observe(&mut energy, Vec3::Z * 3.0, &motion(0.001));
        assert!((energy.stored + 1e-3).abs() < 1e-9);
        let rough = Passivity { device_damping_n_s_per_m: 0.5, device_friction_n: 0.2, ..CONTROL };
        rough.observe(&mut energy, Vec3::ZERO, &motion(0.001));
        // 0.5 N·s/m at 1 m/s over 1 mm, and 0.2 N over it.
        assert!((energy.stored + 0.3e-3).abs() < 1e-9);
    }

    #[test]
    fn a_debt_is_braked_to_half_a_quantum_in_one_period() {
        // It holds 1 mJ, and is about to give 3 mJ.
        let mut energy = Energy { stored: 1e-3, ..Energy::default() };
        let force = CONTROL.control(&mut energy, Vec3::Z * 3.0, &motion(0.001), true, GREATEST);
        assert!(energy.is_active() && energy.damping > 0.0);
        CONTROL.observe(&mut energy, force, &motion(0.001));
        assert!(energy.stored >= -0.5 * CONTROL.quantum(GREATEST) - 1e-8 && energy.stored < 1e-4, "{energy:?}");
    }

    #[test]
    fn at_a_crawl_the_force_is_cut_so_that_no_count_overdraws() {
        let quantum = CONTROL.quantum(GREATEST);
        for debt in [0.0, 0.3, 0.6, 0.9, 1.0] {
            let mut energy = Energy { stored: -debt * quantum, ..Energy::default() };
            let force = CONTROL.control(&mut energy, Vec3::Z * 5.0, &motion(0.0), true, GREATEST);
            CONTROL.observe(&mut energy, force, &motion(CONTROL.resolution_m));
            // Rounding of 1e-4 J.
            assert!(energy.stored >= -quantum * (1.0 + 1e-6), "{debt}: {energy:?}");
            assert_eq!(energy.cut, debt > 0.0);
        }
    }

    #[test]
    fn it_is_idle_within_its_means_and_forgets_a_surplus_when_it_lets_go() {
        let mut energy = Energy { stored: 6e-3, ..Energy::default() };
        let force = Vec3::Z * 3.0;
        assert_eq!(CONTROL.control(&mut energy, force, &motion(0.001), true, GREATEST), force);
        assert!(!energy.is_active());
        CONTROL.control(&mut energy, Vec3::ZERO, &motion(0.0), false, GREATEST);
        assert_eq!(energy.stored, 0.0);
        energy.stored = -2e-3;
        CONTROL.control(&mut energy, Vec3::ZERO, &motion(0.0), false, GREATEST);
        assert_eq!(energy.stored, -2e-3);
    }

    #[test]
    fn what_the_greatest_force_alone_limits_is_not_cut() {
        // So much is stored that the most that may be given is the greatest force.
        let mut energy = Energy { stored: 1.0, ..Energy::default() };
        let force = CONTROL.control(&mut energy, Vec3::Z * 9.0, &motion(-0.001), true, GREATEST);
        assert!((force.length() - GREATEST).abs() < 1e-5 && !energy.is_active());
    }
}
