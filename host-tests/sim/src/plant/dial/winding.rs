//! Three windings in a star on three half-bridges.

use std::f64::consts::TAU;

/// A motor with three phases and a sine-shaped back-EMF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreePhaseMotor {
    /// North poles.
    pub pole_pairs: f64,
    /// Of a phase, Ω.
    pub resistance: f64,
    /// Of a phase, with what the others couple into it, H.
    pub inductance: f64,
    /// The speed at which it gives a volt, amplitude, between two wires.
    pub rpm_per_volt: f64,
}

impl ThreePhaseMotor {
    /// Amplitude of a phase's back-EMF per rad/s, V·s/rad.
    fn phase_constant(&self) -> f64 {
        60.0 / (TAU * self.rpm_per_volt) / 3_f64.sqrt()
    }

    /// The shapes of the three back-EMFs at an angle of the shaft: the first phase's magnet axis is at zero.
    fn shapes(&self, angle: f64) -> [f64; 3] {
        [0.0, 1.0, 2.0].map(|phase: f64| -(self.pole_pairs * angle - phase * TAU / 3.0).sin())
    }
}

/// Three half-bridges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inverter {
    /// V.
    pub supply: f64,
    /// Dead time times frequency.
    pub dead_share: f64,
    /// Half of the current's ripple, A: below it dead time takes less.
    pub ripple: f64,
    /// A phase that is not connected.
    pub lost: Option<usize>,
}

/// The currents.
#[derive(Clone, Copy, Debug, Default)]
pub struct Windings {
    currents: [f64; 3],
}

impl Windings {
    pub fn currents(&self) -> [f64; 3] {
        self.currents
    }

    /// A step of `period` s at a shaft's angle (rad) and rate (rad/s); the torque, N·m. Without widths the stage is
    /// disabled: the diodes take the current to zero within a step.
    pub fn step(
        &mut self,
        motor: &ThreePhaseMotor,
        inverter: &Inverter,
        widths: Option<[f64; 3]>,
        angle: f64,
        rate: f64,
        period: f64,
    ) -> f64 {
        let Some(widths) = widths else {
            self.currents = [0.0; 3];
            return 0.0;
        };
        let constant = motor.phase_constant();
        let shapes = motor.shapes(angle);
        let connected = [0, 1, 2].map(|phase| inverter.lost != Some(phase));
        // What drives each phase's current, seen from its own end: the leg, less its back-EMF.
        let driving: [f64; 3] = core::array::from_fn(|phase| {
            let sign = (self.currents[phase] / inverter.ripple).clamp(-1.0, 1.0);
            let width = widths[phase] - inverter.dead_share * sign;
            width.clamp(0.0, 1.0) * inverter.supply - constant * rate * shapes[phase]
        });
        // The star point is where the currents of the connected phases still add up to zero.
        let count = connected.iter().filter(|is| **is).count() as f64;
        let star = (0..3).filter(|phase| connected[*phase]).map(|phase| driving[phase]).sum::<f64>() / count;
        let before = self.currents;
        for phase in 0..3 {
            // The trapezoidal rule for L i' = v − R i.
            let inert = 2.0 * motor.inductance / period;
            let next = (before[phase] * (inert - motor.resistance) + 2.0 * (driving[phase] - star))
                / (inert + motor.resistance);
            self.currents[phase] = if connected[phase] { next } else { 0.0 };
        }
        // The power that goes into the back-EMF, over the rate.
        (0..3).map(|phase| 0.5 * (before[phase] + self.currents[phase]) * constant * shapes[phase]).sum()
    }
}
