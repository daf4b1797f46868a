//! The loop against a simulated device in a scripted hand.

use super::script::Script;
use crate::plant::{HandSettings, Plant, PlantError, PlantSettings, Vector};
use palpate::device::{Counts, Kinematics};
use palpate::servo::{Fault, Input, Output, Servo, Surface};
use palpate::track::Contact;
use thiserror::Error;

/// Time of the request for force, s: the witness point has converged by then, and the hand does not move yet.
const ENABLED_AT: f64 = 0.05;

/// One tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tick {
    /// True position of the probe, m in the device's frame.
    pub probe: Vector,
    /// The force that the loop renders, N.
    pub force: Vector,
    /// The hand's force, N.
    pub hand: Vector,
    /// Signed gap in the loop's view, m.
    pub gap: f64,
    /// Whether the surface is touched.
    pub is_touching: bool,
}

/// A run of a script.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Servo rate, Hz.
    pub rate: f64,
    /// Its ticks, in order.
    pub ticks: Vec<Tick>,
    /// The device's name, where the recording has it.
    pub device: Option<String>,
    /// The same of the model or scene.
    pub model: Option<String>,
    /// Contacts released, [`palpate::servo::ServoState::contacts_lost`]; 0 of one that was read from a file.
    pub contacts_lost: u32,
}

/// Why a run gives no recording.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RunError {
    /// The simulated device does not start.
    #[error("the simulated device cannot start where the hand does: {0}")]
    Plant(#[from] PlantError),
    /// The loop stopped.
    #[error("the loop stopped {time:.3} s into \"{script}\": {fault:?}")]
    Fault {
        /// The script.
        script: String,
        /// When, s.
        time: f64,
        /// Why.
        fault: Fault,
    },
}

/// Runs a script to its end.
///
/// # Errors
/// A start out of reach, or a fault of the loop.
pub fn record<S: Surface, K: Kinematics<JOINTS>, const JOINTS: usize>(
    servo: &Servo<'_, S, K, JOINTS>,
    plant: &PlantSettings,
    hand: HandSettings,
    script: &Script,
) -> Result<Recording, RunError> {
    let rate = f64::from(servo.settings().rate_hz);
    let mut plant = Plant::new(plant, hand, Box::new(script.path.clone()), rate)?;
    let mut state = servo.start();
    let count = (script.path.end() * rate).ceil() as usize;
    let mut ticks = Vec::with_capacity(count);
    for _ in 0..count {
        let all = plant.counts();
        let counts = core::array::from_fn(|joint| Counts(all[joint]));
        let (probe, hand) = (plant.position(), plant.hand_force());
        let _ = servo.tick(&mut state, Input::Sensors { counts, enable: plant.time() >= ENABLED_AT });
        if let Some((fault, _)) = state.fault() {
            return Err(RunError::Fault { script: script.name.clone(), time: plant.time(), fault });
        }
        ticks.push(Tick {
            probe,
            force: state.force().to_array().map(f64::from),
            hand,
            gap: f64::from(state.gap()),
            is_touching: state.contact() == Contact::Touching,
        });
        let mut duties = [0; 3];
        if let Output::Drive(given) = state.output() {
            duties.iter_mut().zip(given).for_each(|(duty, given)| *duty = given.0);
        }
        plant.advance(duties);
    }
    Ok(Recording { rate, ticks, device: None, model: None, contacts_lost: state.contacts_lost() })
}
