//! A simulated device on a simulated bench, in which something is wrong.

use super::{LIMITS, Lab, RATE};
use palpate::commission::{Jog, JogState, Jogging, KEY};
use palpate::device::Counts;
use palpate::wire::Reading;
use palpate_plant::{HandPath, HandSettings, Plant, PlantSettings, Vector};
use std::sync::{Arc, Mutex, PoisonError};

/// How a planted device differs from its file.
#[derive(Clone, Copy, Debug)]
pub struct Planted {
    /// The device as it is.
    pub plant: PlantSettings,
    /// The joint whose encoder is on each input.
    pub encoder_on: [usize; 3],
    /// The joint whose motor is on each output.
    pub motor_on: [usize; 3],
}

/// The bench.
pub struct SimulatedLab {
    plant: Plant,
    planted: Planted,
    jogging: Jogging<3>,
    state: JogState<3>,
    number: u32,
    tick: u32,
    /// Where the far end of a very soft spring is: its force is what pulls.
    far: Arc<Mutex<Vector>>,
}

/// Of the spring, N/m: so soft that the probe's own motion changes the force by nothing.
const SOFT: f64 = 1e-3;
/// Ticks of a fiftieth of a second.
const TICKS: u32 = 80;
/// Ticks in which a hand puts the joints somewhere.
const PLACING: u32 = 400;

struct Far(Arc<Mutex<Vector>>);

impl HandPath for Far {
    fn target(&self, _time: f64) -> Vector {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
    fn velocity(&self, _time: f64) -> Vector {
        [0.0; 3]
    }
}

impl SimulatedLab {
    /// A device at rest in the middle of its workspace.
    ///
    /// # Errors
    /// What the plant or the limits refuse.
    pub fn new(planted: Planted) -> anyhow::Result<Self> {
        let far = Arc::new(Mutex::new([0.0; 3]));
        let hand = HandSettings { stiffness: SOFT, damping: 0.0, mass: 0.0 };
        let plant = Plant::new(&planted.plant, hand, Box::new(Far(Arc::clone(&far))), f64::from(RATE))?;
        let jogging = Jogging::try_new(LIMITS, RATE)?;
        Ok(Self { plant, planted, jogging, state: JogState::default(), number: 0, tick: 0, far })
    }

    /// A tick of device and plant.
    fn tick(&mut self) -> Reading {
        let joints = self.plant.counts();
        let counts = self.planted.encoder_on.map(|joint| joints[joint]);
        self.jogging.tick(&mut self.state, Some(counts.map(Counts)), true);
        let duties = self.state.duties().map(|duty| duty.0);
        let mut at_joints = [0; 3];
        for (duty, joint) in duties.iter().zip(self.planted.motor_on) {
            at_joints[joint] = *duty;
        }
        self.plant.advance(at_joints);
        self.tick += 1;
        Reading {
            tick: self.tick,
            number: self.state.number(),
            counts,
            duties,
            live: self.state.is_live(),
            refusal: self.state.refusal().map_or(0, |refusal| refusal.code()),
        }
    }
}

impl Lab for SimulatedLab {
    fn step(&mut self, jog: Option<(u8, i16)>) -> anyhow::Result<Reading> {
        self.number += 1;
        let (key, (motor, duty)) = (if jog.is_some() { KEY } else { 0 }, jog.unwrap_or_default());
        self.jogging.command(&mut self.state, Jog { number: self.number, key, motor, duty });
        let mut reading = Reading::default();
        for _ in 0..TICKS {
            reading = self.tick();
        }
        Ok(reading)
    }

    fn place(&mut self, angles: [f64; 3]) -> anyhow::Result<()> {
        // The hand takes hold: the key is let go, and the stops of the simulated joints close in on the angle.
        self.step(None)?;
        for (joint, angle) in angles.into_iter().enumerate() {
            self.plant.move_stops(joint, [angle, angle]);
        }
        for _ in 0..PLACING {
            self.tick();
        }
        Ok(())
    }

    fn let_go(&mut self, joint: usize) -> anyhow::Result<()> {
        self.plant.move_stops(joint, self.planted.plant.joints[joint].stops);
        Ok(())
    }

    fn pull(&mut self, force: [f64; 3]) -> anyhow::Result<()> {
        *self.far.lock().unwrap_or_else(PoisonError::into_inner) = force.map(|part| part / SOFT);
        Ok(())
    }
}
