//! How warm a motor gets: two bodies, winding and housing, after a motor's data sheet.
//!
//! `C_w Ṫ_w = R(T_w) i² − (T_w − T_h)/R_wh` and `C_h Ṫ_h = (T_w − T_h)/R_wh − (T_h − T_a)/R_ha`, with the heat
//! capacities from the sheet's time constants (`C_w = θ_w/R_wh`, `C_h = θ_h/R_ha`) and copper's resistance, which
//! grows by 0.39 % a kelvin. A stalled motor: nothing but the current warms it, and nothing but still air cools it.

/// Thermal data of the motor, from its data sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThermalSettings {
    /// Resistance of the winding at 25 °C, ohms.
    pub resistance: f64,
    /// Thermal resistance from winding to housing, K/W.
    pub winding_to_housing: f64,
    /// Thermal resistance from housing to air, K/W.
    pub housing_to_air: f64,
    /// Time constant of the winding, s.
    pub winding_time_constant: f64,
    /// Time constant of the housing, s.
    pub housing_time_constant: f64,
    /// Maximum temperature of the winding, °C.
    pub greatest: f64,
}

/// Temperature coefficient of copper, 1/K.
const COPPER: f64 = 0.0039;
/// Temperature of still air, °C.
pub const AIR: f64 = 25.0;

/// A motor's temperatures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thermal {
    settings: ThermalSettings,
    /// Temperature of the winding, °C.
    pub winding: f64,
    /// Temperature of the housing, °C.
    pub housing: f64,
}

impl ThermalSettings {
    /// The current, A, that finally warms the winding to its maximum temperature, in air of 25 °C.
    pub fn continuous_current(&self) -> f64 {
        let power = (self.greatest - AIR) / (self.winding_to_housing + self.housing_to_air);
        (power / self.resistance_at(self.greatest)).sqrt()
    }

    pub(crate) fn resistance_at(&self, temperature: f64) -> f64 {
        self.resistance * (1.0 + COPPER * (temperature - 25.0))
    }
}

impl Thermal {
    /// A motor as warm as the air.
    pub const fn cold(settings: ThermalSettings) -> Self {
        Self { settings, winding: AIR, housing: AIR }
    }

    /// `period` s under a current, A; far shorter than the winding's time constant.
    pub fn step(&mut self, current: f64, period: f64) {
        let ThermalSettings {
            winding_to_housing, housing_to_air, winding_time_constant, housing_time_constant, ..
        } = self.settings;
        let warming = self.settings.resistance_at(self.winding) * current * current;
        let across = (self.winding - self.housing) / winding_to_housing;
        let away = (self.housing - AIR) / housing_to_air;
        self.winding += (warming - across) * period * winding_to_housing / winding_time_constant;
        self.housing += (across - away) * period * housing_to_air / housing_time_constant;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: ThermalSettings = ThermalSettings {
        resistance: 2.5,
        winding_to_housing: 1.7,
        housing_to_air: 6.0,
        winding_time_constant: 16.0,
        housing_time_constant: 700.0,
        greatest: 125.0,
    };

    #[test]
    fn the_continuous_current_ends_at_the_greatest_temperature() {
        let mut motor = Thermal::cold(MOTOR);
        // Two hours are ten time constants of the housing, which hot copper makes half as long again.
        for _ in 0..720_000 {
            motor.step(MOTOR.continuous_current(), 0.01);
        }
        assert!((motor.winding - 125.0).abs() < 0.1, "{motor:?}");
    }

    #[test]
    fn a_short_pulse_warms_the_winding_by_its_own_time_constant() {
        let (mut motor, current, period) = (Thermal::cold(MOTOR), 4.0_f64, 1e-3);
        for _ in 0..1_000 {
            motor.step(current, period);
        }
        // In one second of sixteen: R i² R_wh (1 − e^(−1/16)), and up to 4 % for copper that is warmer by 4 K.
        let rise = 2.5 * current * current * 1.7 * (1.0 - (-1.0_f64 / 16.0).exp());
        assert!((motor.winding - AIR) / rise > 0.99 && (motor.winding - AIR) / rise < 1.04, "{motor:?} {rise}");
    }
}
