//! The equation of motion `M q̈ + h(q, q̇) = τ_motor + τ_gravity − d q̇ + f + Jᵀ F_hand`, a step at a time.
//!
//! Classical Runge–Kutta of fourth order for the smooth terms; the dry friction `f` is computed once a step (see
//! `friction`) and held over it, so that a sticking joint does not creep. Only +, −, ×, ÷, √ and trigonometry: the same
//! platform gives the same bits.

use super::friction::dry_friction;
use super::mechanism::{Dynamics, Mechanism};
use super::vector::{Matrix, Vector, add_scaled, dot, inverse, times};

/// The moving parts: the mechanism, its friction and its state.
#[derive(Debug)]
pub struct Mechanics {
    /// The mechanism.
    pub mechanism: Box<dyn Mechanism>,
    /// Viscous friction at each joint, N·m·s.
    pub viscous: Vector,
    /// Dry friction at each joint, N·m.
    pub coulomb: Vector,
    /// End stops of each joint, rad.
    pub stops: [[f64; 2]; 3],
    /// Joint angles, rad.
    pub angles: Vector,
    /// Joint rates, rad/s.
    pub rates: Vector,
}

/// Stiffness and damping of an end stop at the joint, N·m/rad and N·m·s: assumed, hard rubber. 0.1 N·m press it in by
/// half a count.
const STOP: [f64; 2] = [1_000.0, 1.0];

/// An end stop's torque, N·m: it pushes back, and never pulls.
fn stop_torque([least, most]: [f64; 2], angle: f64, rate: f64) -> f64 {
    let [stiffness, damping] = STOP;
    if angle > most {
        (stiffness * (most - angle) - damping * rate).min(0.0)
    } else if angle < least {
        (stiffness * (least - angle) - damping * rate).max(0.0)
    } else {
        0.0
    }
}

/// The response of the joints at one place and speed.
struct Response {
    /// The inverse of the mass matrix.
    mobility: Matrix,
    /// N·m.
    smooth_torques: Vector,
}

impl Response {
    /// Under torques that are constant over a step, N·m.
    fn acceleration(&self, constant: Vector) -> Vector {
        times(&self.mobility, add_scaled(self.smooth_torques, constant, 1.0))
    }
}

impl Mechanics {
    /// One step of `period` s under constant motor torques, N·m. `hand(half_steps, position, velocity)` is the force on
    /// the probe, N, `half_steps` (0, 1, 2) half steps into the step.
    pub fn step(&mut self, period: f64, motor_torques: Vector, hand: impl Fn(usize, Vector, Vector) -> Vector) {
        let at = |half_steps, angles, rates| self.responds(half_steps, angles, rates, &hand);
        let (q, v) = (self.angles, self.rates);

        let first = at(0, q, v);
        let mut constant = motor_torques;
        if self.coulomb != [0.0; 3] {
            let mobility = first.mobility.map(|row| row.map(|entry| entry * period));
            let free_rates = add_scaled(v, first.acceleration(motor_torques), period);
            constant = add_scaled(constant, dry_friction(free_rates, &mobility, self.coulomb), 1.0);
        }

        let half = 0.5 * period;
        let a1 = first.acceleration(constant);
        let v2 = add_scaled(v, a1, half);
        let a2 = at(1, add_scaled(q, v, half), v2).acceleration(constant);
        let v3 = add_scaled(v, a2, half);
        let a3 = at(1, add_scaled(q, v2, half), v3).acceleration(constant);
        let v4 = add_scaled(v, a3, period);
        let a4 = at(2, add_scaled(q, v3, period), v4).acceleration(constant);
        let mean = |k: [Vector; 4]| -> Vector {
            core::array::from_fn(|i| (k[0][i] + 2.0 * (k[1][i] + k[2][i]) + k[3][i]) / 6.0)
        };
        self.angles = add_scaled(q, mean([v, v2, v3, v4]), period);
        self.rates = add_scaled(v, mean([a1, a2, a3, a4]), period);
    }

    /// The response of the joints: all torques but the motors' and the dry friction, with the velocity
    /// torques taken to the right.
    fn responds(
        &self,
        half_steps: usize,
        angles: Vector,
        rates: Vector,
        hand: impl Fn(usize, Vector, Vector) -> Vector,
    ) -> Response {
        let Dynamics { position, jacobian, mass_matrix, velocity_torques, gravity_torques } =
            self.mechanism.dynamics(angles, rates);
        let force = hand(half_steps, position, times(&jacobian, rates));
        let smooth_torques = core::array::from_fn(|joint| {
            let column = [jacobian[0][joint], jacobian[1][joint], jacobian[2][joint]];
            dot(column, force) + gravity_torques[joint] - velocity_torques[joint] - self.viscous[joint] * rates[joint]
                + stop_torque(self.stops[joint], angles[joint], rates[joint])
        });
        Response { mobility: inverse(&mass_matrix), smooth_torques }
    }

    /// The probe's position, m from the workspace centre.
    pub fn position(&self) -> Vector {
        self.mechanism.position(self.angles)
    }

    /// The probe's velocity, m/s.
    pub fn velocity(&self) -> Vector {
        times(&self.mechanism.jacobian(self.angles), self.rates)
    }

    /// Kinetic energy and energy of height, J.
    pub fn energy(&self) -> f64 {
        self.mechanism.kinetic_energy(self.angles, self.rates) + self.mechanism.height_energy(self.angles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::{Arm, PlantSettings};
    use std::f64::consts::{PI, TAU};

    /// A sub-step of the 4 kHz plant.
    const STEP: f64 = 1.0 / 80_000.0;

    fn free(_: usize, _: Vector, _: Vector) -> Vector {
        [0.0; 3]
    }

    fn arm() -> Arm {
        PlantSettings::wooden_haptics_2016().arm(0.0)
    }

    fn without_friction(mechanism: Box<dyn Mechanism>) -> Mechanics {
        Mechanics {
            mechanism,
            viscous: [0.0; 3],
            coulomb: [0.0; 3],
            stops: [[f64::NEG_INFINITY, f64::INFINITY]; 3],
            angles: [0.0; 3],
            rates: [0.0; 3],
        }
    }

    #[test]
    fn energy_is_kept_without_friction_motors_and_hand() {
        let mut body = without_friction(Box::new(arm()));
        (body.angles, body.rates) = ([0.2, 0.5, 0.6], [6.0, -3.0, 4.0]);
        let start = body.energy();
        let (mut drift, mut swing) = (0.0_f64, 0.0_f64);
        for _ in 0..160_000 {
            body.step(STEP, [0.0; 3], free);
            drift = drift.max((body.energy() - start).abs());
            swing = swing.max((body.mechanism.height_energy(body.angles) - start).abs());
        }
        // 160,000 steps of a few roundings each, of energies near 0.5 J: 1e-16 × 160,000 × 4. The rule itself errs by
        // (ω h)⁵ a step, 1e-17 at 40 rad/s.
        assert!(drift < 1e-10, "{drift:e} J");
        assert!(swing > 0.1, "the test must exchange energy: {swing} J");
    }

    #[test]
    fn energy_is_kept_by_every_mechanism() {
        // From the workspace centre outward, short enough to stay clear of singularities, for nothing stops them.
        for (settings, rates, ticks) in [
            (PlantSettings::phantom_premium(), [3.0, -2.0, 2.0], 16_000),
            (PlantSettings::polhem_v2(), [3.0, 1.0, -1.5], 8_000),
            (PlantSettings::hapkit(), [2.0, 0.0, 0.0], 16_000),
            (PlantSettings::haply_2diy_v3(), [4.0, -3.0, 0.0], 6_000),
            (PlantSettings::haply_kit_v1(), [4.0, -3.0, 0.0], 6_000),
            (PlantSettings::novint_falcon(), [6.0, -5.0, 4.0], 6_000),
        ] {
            let mut body = without_friction(settings.mechanism(0.05));
            body.angles = body.mechanism.angles([0.0; 3]).unwrap();
            body.rates = rates;
            let start = body.energy();
            let kinetic = body.mechanism.kinetic_energy(body.angles, body.rates);
            let (mut drift, mut change) = (0.0_f64, 0.0_f64);
            for _ in 0..ticks {
                body.step(STEP, [0.0; 3], free);
                drift = drift.max((body.energy() - start).abs());
                let rates = body.rates.into_iter().zip(rates).map(|(now, then)| (now - then).abs());
                change = change.max(rates.fold(0.0, f64::max));
            }
            // The differences of the Jacobian err by 1e-10 of it, and the rule by less.
            assert!(drift < 1e-8 * kinetic.max(0.01), "{settings:?}: {drift:e} J of {kinetic} J");
            assert!(change > 0.02, "the test must change the motion: {change}");
        }
    }

    #[test]
    fn an_end_stop_holds_a_joint_to_its_deflection() {
        let mut body = without_friction(Box::new(Arm { gravity: 0.0, ..arm() }));
        body.stops[0] = [-0.3, 0.2];
        for (torque, stop) in [(0.1, 0.2), (-0.1, -0.3)] {
            for _ in 0..160_000 {
                body.step(STEP, [torque, 0.0, 0.0], free);
            }
            // The spring's 1,000 N·m/rad.
            assert!((body.angles[0] - stop - torque / 1_000.0).abs() < 1e-9, "{}", body.angles[0]);
        }
    }

    #[test]
    fn first_link_swings_as_a_physical_pendulum() {
        let mut arm = arm();
        (arm.second.mass, arm.second.inertia) = (0.0, 0.0);
        let mut body = without_friction(Box::new(arm));
        let amplitude = 0.02;
        body.angles = [0.0, PI + amplitude, 0.0];
        let link = arm.first;
        let inertia = arm.joint_inertia[1] + link.mass * link.centre * link.centre + link.inertia;
        let stiffness = link.mass * arm.gravity * link.centre;
        // Small swings last 2π√(I/mgl), larger ones longer by 1 + θ²/16 to the next order, θ⁴ · 11/3072.
        let period = TAU * (inertia / stiffness).sqrt() * (1.0 + amplitude * amplitude / 16.0);

        // Four periods between crossings of the lowest point in one direction, found by linear interpolation.
        let (mut crossings, mut time) = (Vec::new(), 0.0);
        while crossings.len() < 5 {
            let before = body.angles[1] - PI;
            body.step(STEP, [0.0; 3], free);
            let after = body.angles[1] - PI;
            if before < 0.0 && after >= 0.0 {
                crossings.push(time - STEP * before / (after - before));
            }
            time += STEP;
        }
        let measured = (crossings[4] - crossings[0]) / 4.0;
        // The neglected term of the series is 6e-10; the interpolation is better still.
        assert!((measured / period - 1.0).abs() < 2e-9, "{measured} s, expected {period} s");
    }

    #[test]
    fn turntable_spins_down_as_the_closed_form_and_stays() {
        // Without links nothing couples the joints.
        let mut arm = arm();
        for link in [&mut arm.first, &mut arm.second] {
            (link.mass, link.inertia) = (0.0, 0.0);
        }
        let mut body = without_friction(Box::new(arm));
        let (viscous, coulomb, start) = (2e-3, 0.01, 10.0);
        (body.viscous, body.coulomb, body.rates) = ([viscous; 3], [coulomb; 3], [start, 0.0, 0.0]);
        let inertia = arm.joint_inertia[0];
        let stop = inertia / viscous * (1.0 + start * viscous / coulomb).ln();
        let mut stopped = None;
        for index in 1..160_000 {
            body.step(STEP, [0.0; 3], free);
            let time = f64::from(index) * STEP;
            let decay = (-viscous * time / inertia).exp();
            let expected = ((start + coulomb / viscous) * decay - coulomb / viscous).max(0.0);
            // In the one step in which it stops, the friction's mean over the step is all that is known: f h / I =
            // 4e-5. Elsewhere friction is constant and the rest exact to rounding.
            let bound = if (time - stop).abs() < 2.0 * STEP { coulomb * STEP / inertia } else { 1e-11 };
            assert!((body.rates[0] - expected).abs() < bound, "{time} s: {} {expected}", body.rates[0]);
            if stopped.is_none() && body.rates[0].abs() < 1e-11 {
                stopped = Some(time);
            }
        }
        let stopped = stopped.expect("it stops");
        assert!((stopped - stop).abs() <= 2.0 * STEP, "{stopped} s, expected {stop} s");
    }

    #[test]
    fn a_joint_below_its_dry_friction_does_not_move_and_above_it_does() {
        for (share, moves) in [(0.99, false), (1.01, true)] {
            let mut body = without_friction(Box::new(Arm { gravity: 0.0, ..arm() }));
            (body.angles, body.coulomb) = ([0.3, 0.4, 0.5], [0.02, 0.015, 0.01]);
            let start = body.angles;
            for _ in 0..80_000 {
                body.step(STEP, [0.02 * share, -0.015 * share, 0.01 * share], free);
            }
            for (angle, before) in body.angles.into_iter().zip(start) {
                let moved = (angle - before).abs();
                // A second of creep at the rounding of the torques, 1e-18 N·m over 2e-3 kg·m²; against, at 1 % above
                // the limit, an acceleration of 0.02 rad/s² or more.
                if moves { assert!(moved > 1e-3, "{moved}") } else { assert!(moved < 1e-12, "{moved}") }
            }
        }
    }
}
