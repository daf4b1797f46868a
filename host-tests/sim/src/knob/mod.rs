//! The boards' knob on the host: its loop at the simulated dial.

mod hosted;
#[cfg(feature = "link")]
mod simulated;

use crate::plant::{DialSettings, Inverter, ThreePhaseMotor};

pub use hosted::HostKnob;
pub use palpate_bench::knob::*;
#[cfg(feature = "link")]
pub use simulated::{KnobFlash, KnobWorld, SharedKnob, SimulatedKnob};

/// Angle of the simulated dial at which its sensor starts to count, radians.
pub const DIAL_ZERO: f64 = 0.7;

/// The simulated dial with the motor of the boards' file. Cogging, friction, inertia and inductance, which no data sheet
/// states, are those of the gimbal motor.
pub fn dial() -> DialSettings {
    let gimbal = DialSettings::gimbal_knob();
    DialSettings {
        motor: ThreePhaseMotor {
            pole_pairs: f64::from(COMMUTATION.pole_pairs),
            resistance: f64::from(PHASE_OHM),
            rpm_per_volt: f64::from(RPM_PER_V),
            ..gimbal.motor
        },
        inverter: Inverter { supply: f64::from(SUPPLY_V), ..gimbal.inverter },
        ..gimbal
    }
}

/// The recorded cogging of the simulated dial's motor, as in the image.
pub mod recorded {
    include!("../../../../boards/emulated/knob_cogging.rs");
}

/// The widths of a report; `None` for a stage that is disabled.
pub fn widths_of(report: &palpate::wire::Report) -> Option<[f64; 3]> {
    (report.duties != [i16::MIN; 3]).then(|| report.duties.map(|duty| f64::from(duty) / 65_534.0 + 0.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gimbal_motor_of_the_file_is_the_simulations() {
        assert_eq!(dial(), DialSettings::gimbal_knob());
    }
}
