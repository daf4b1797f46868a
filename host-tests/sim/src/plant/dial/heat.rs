//! How warm each of three phases gets: three windings on one housing.
//!
//! Each as in [`crate::plant::Thermal`], with its own share of the teeth between it and the housing. Nothing passes from one
//! phase to the next but by the housing, which is the harder case for a phase that has more current than the others.

use crate::plant::thermal::{AIR, ThermalSettings};

/// The temperatures of a motor with three phases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseHeat {
    /// Of one phase; from the housing on, of the motor.
    settings: ThermalSettings,
    /// Of each winding, °C.
    pub windings: [f64; 3],
    /// Of the housing, °C.
    pub housing: f64,
}

impl PhaseHeat {
    /// Heat of the motor of [`super::DialSettings::gimbal_knob`]. Everything but the resistance is assumed: a housing
    /// of 63 mm by 24 mm in still air at 10 W/(m² K), 190 g of it, 13 g of copper a phase at 12 K/W; 80 °C, above which
    /// its magnets lose their strength.
    pub const GIMBAL_MOTOR: ThermalSettings = ThermalSettings {
        resistance: 7.5,
        winding_to_housing: 12.0,
        housing_to_air: 9.0,
        winding_time_constant: 60.0,
        housing_time_constant: 850.0,
        greatest: 80.0,
    };

    /// A motor as warm as the air.
    pub const fn cold(settings: ThermalSettings) -> Self {
        Self { settings, windings: [AIR; 3], housing: AIR }
    }

    /// `period` s under these currents, A; far shorter than a winding's time constant.
    pub fn step(&mut self, currents: [f64; 3], period: f64) {
        let ThermalSettings {
            winding_to_housing, housing_to_air, winding_time_constant, housing_time_constant, ..
        } = self.settings;
        let mut into_housing = 0.0;
        for (winding, current) in self.windings.iter_mut().zip(currents) {
            let warming = self.settings.resistance_at(*winding) * current * current;
            let across = (*winding - self.housing) / winding_to_housing;
            *winding += (warming - across) * period * winding_to_housing / winding_time_constant;
            into_housing += across;
        }
        let away = (self.housing - AIR) / housing_to_air;
        self.housing += (into_housing - away) * period * housing_to_air / housing_time_constant;
    }

    /// The warmest winding, °C.
    pub fn hottest(&self) -> f64 {
        self.windings.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_comes_to_the_balance_of_its_powers() {
        let (mut motor, currents) = (PhaseHeat::cold(PhaseHeat::GIMBAL_MOTOR), [0.4, -0.2, -0.2]);
        // Three hours: windings on a housing that is warming come to rest with 1,070 s, not with the housing's own 850.
        (0..1_080_000).for_each(|_| motor.step(currents, 0.01));
        let power = |phase: usize| 7.5 * (1.0 + 0.0039 * (motor.windings[phase] - 25.0)) * currents[phase].powi(2);
        let housing = AIR + 9.0 * (power(0) + power(1) + power(2));
        // e⁻¹⁰ of 18 K is 0.001; half of it again for what is not of one time constant.
        assert!((motor.housing - housing).abs() < 0.0015, "{motor:?} {housing}");
        for phase in 0..3 {
            assert!((motor.windings[phase] - housing - 12.0 * power(phase)).abs() < 0.0015, "{motor:?}");
        }
        assert_eq!(motor.hottest(), motor.windings[0]);
    }
}
