//! A stretch of a servo's life with the simulated device, to inject faults into: what the sensors said, and the state
//! before each tick.

use palpate::device::{Counts, Kinematics};
use palpate::servo::{Event, Input, PatchWitness, Servo, ServoState, Settings, Surface};
use palpate_sim::plant::{HandSettings, Plant, PlantSettings, TouchingPath, TouchingSettings};

pub const RATE: f64 = 4_000.0;

pub const SETTINGS: Settings = Settings {
    rate_hz: RATE as f32,
    stiffness_n_per_m: 600.0,
    damping_n_s_per_m: 2.0,
    max_force_n: 5.0,
    velocity_corner_hz: 200.0,
    soft_start_s: 0.05,
    body_origin_m: palpate::math::vec3(0.0, 0.0, 0.0),
};

/// Force is asked for in the middle of the second.
pub fn enable(tick: usize) -> bool {
    (1_000..3_500).contains(&tick)
}

pub struct Trace {
    pub counts: Vec<[Counts; 3]>,
    pub states: Vec<ServoState<3>>,
}

impl Trace {
    /// A second of touching a level wall.
    pub fn record<S: Surface<Witness = PatchWitness>, K: Kinematics<3>>(servo: &Servo<'_, S, K, 3>, seed: u64) -> Self {
        let level = |u: f64, v: f64| ([0.12 * (u - 0.5), 0.12 * (v - 0.5), 0.0], [0.0, 0.0, 1.0]);
        let settings = TouchingSettings { duration: 1.0, touches: 3, ..TouchingSettings::default() };
        let path = TouchingPath::new(level, settings, seed).unwrap();
        let plant = &PlantSettings::wooden_haptics_2016();
        let mut plant = Plant::new(plant, HandSettings::default(), Box::new(path), RATE).unwrap();
        let mut state = servo.start();
        let mut trace = Self { counts: Vec::new(), states: Vec::new() };
        for tick in 0..4_000 {
            let counts = plant.counts().map(Counts);
            trace.counts.push(counts);
            trace.states.push(state);
            // The host is heard every 50 ticks, homing is done at the 100th.
            if tick % 50 == 0 {
                servo.note(&mut state, Event::LinkAlive);
            }
            if tick == 100 {
                servo.note(&mut state, Event::Homed);
            }
            let _ = servo.tick(&mut state, Input::Sensors { counts, enable: enable(tick) });
            plant.advance(state.duties().map(|duty| duty.0));
        }
        trace
    }
}
