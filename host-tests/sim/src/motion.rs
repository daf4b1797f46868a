//! The loop on a device that moves, with a failure planted: on the project's own plant or on another.

use crate::plant::{HandPath, HandSettings, Plant, Vector};
use palpate::device::{Counts, Kinematics};
use palpate::math::Vec3;
use palpate::servo::{Fault, Guard, Input, Output, Servo, ServoState, Surface, Tracked as _};
use palpate::track::Contact;

/// A device in a hand, a servo period at a time.
pub trait Moving {
    /// The counts of sound encoders.
    fn counts(&self) -> [i32; 3];
    /// The probe, m from the workspace centre.
    fn position(&self) -> Vector;
    /// The probe's velocity, m/s.
    fn velocity(&self) -> Vector;
    /// A period under these duties, in a hand that aims at a point, m, which moves, m/s.
    fn advance(&mut self, duties: [i16; 3], aim: Vector, aim_velocity: Vector, grip: HandSettings);
}

/// Where a hand aims during one period.
struct Aim {
    since: f64,
    at: Vector,
    velocity: Vector,
}

impl HandPath for Aim {
    fn target(&self, time: f64) -> Vector {
        core::array::from_fn(|axis| self.at[axis] + self.velocity[axis] * (time - self.since))
    }

    fn velocity(&self, _: f64) -> Vector {
        self.velocity
    }
}

impl Moving for Plant {
    fn counts(&self) -> [i32; 3] {
        Self::counts(self)
    }

    fn position(&self) -> Vector {
        Self::position(self)
    }

    fn velocity(&self) -> Vector {
        Self::velocity(self)
    }

    fn advance(&mut self, duties: [i16; 3], aim: Vector, aim_velocity: Vector, grip: HandSettings) {
        self.hold(grip);
        self.follow(Box::new(Aim { since: self.time(), at: aim, velocity: aim_velocity }));
        Self::advance(self, duties);
    }
}

/// A failure. The weight of the links is a number of the plant: [`crate::plant::PlantSettings::gravity`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Planted {
    /// None.
    Nothing,
    /// From this time on, s, nobody holds the probe.
    Released(f64),
    /// A joint's count stands still from this time on, s.
    Frozen(usize, f64),
    /// A joint's encoder counts the other way, from its zero.
    Reversed(usize),
}

/// A hand's motion, and a failure in it.
#[derive(Clone, Copy)]
pub struct Script {
    /// Where the hand aims at a time, s.
    pub path: fn(f64) -> Vector,
    /// How it holds the probe.
    pub grip: HandSettings,
    /// The failure.
    pub planted: Planted,
    /// How long, s.
    pub seconds: f64,
}

/// A tick.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// s.
    pub time: f64,
    /// Where the probe is, m.
    pub position: Vector,
    /// Its velocity, m/s.
    pub velocity: Vector,
    /// Where the loop has it, m.
    pub probe: Vec3,
    /// The force of the contact, N.
    pub force: Vec3,
    /// m.
    pub gap: f32,
    /// With the surface.
    pub contact: Contact,
    /// Contacts given up so far.
    pub lost: u32,
    /// Whether a motor is given torque.
    pub is_driven: bool,
    /// The first fault.
    pub fault: Option<Fault>,
}

/// Plays a script in lockstep, a sample a tick; enable is held throughout.
pub fn play<S: Surface, K: Kinematics<3>, G: Guard<3>>(
    servo: &Servo<'_, S, K, 3, G>,
    script: &Script,
    arm: &mut dyn Moving,
    mut look: impl FnMut(&ServoState<3, S::Witness, G::State>),
) -> Vec<Sample> {
    let period = 1.0 / f64::from(servo.settings().rate_hz);
    let mut state = servo.start();
    let mut frozen = None;
    let tick = |tick: u32| {
        let time = f64::from(tick) * period;
        let mut counts = arm.counts();
        match script.planted {
            Planted::Frozen(joint, since) if time >= since => counts[joint] = *frozen.get_or_insert(counts[joint]),
            // A count spans its angle and rounds down.
            Planted::Reversed(joint) => counts[joint] = -1 - counts[joint],
            _ => {}
        }
        let output = servo.tick(&mut state, Input::Sensors { counts: counts.map(Counts), enable: true });
        look(&state);
        let duties = match output {
            Output::Off => [0; 3],
            Output::Drive(duties) => duties.map(|duty| duty.0),
        };
        let [aim, next] = [time, time + period].map(script.path);
        let is_held = !matches!(script.planted, Planted::Released(since) if time >= since);
        let grip = if is_held { script.grip } else { HandSettings::NONE };
        let aim_velocity = core::array::from_fn(|axis| (next[axis] - aim[axis]) / period);
        let sample = Sample {
            time,
            position: arm.position(),
            velocity: arm.velocity(),
            probe: state.probe() + servo.settings().body_origin_m,
            force: state.force(),
            gap: state.witness().gap(),
            contact: state.contact(),
            lost: state.contacts_lost(),
            is_driven: duties != [0; 3],
            fault: state.fault().map(|(fault, _)| fault),
        };
        arm.advance(duties, aim, aim_velocity, grip);
        sample
    };
    (0..(script.seconds / period).round() as u32).map(tick).collect()
}
