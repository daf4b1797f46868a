//! Every number of the simulated device.

use super::arm::{Arm, Link};
use super::encoder::Encoder;
use super::motor::Motor;
use super::vector::Vector;

/// Which way an encoder or a motor is mounted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Positive with the joint.
    With,
    /// Positive against the joint.
    Against,
}

impl Direction {
    /// +1 or −1.
    pub const fn sign(self) -> f64 {
        match self {
            Self::With => 1.0,
            Self::Against => -1.0,
        }
    }
}

/// One joint's transmission, encoder, motor and friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointSettings {
    /// Turns of the motor for one of the joint.
    pub ratio: f64,
    /// Encoder counts per turn of the motor, after quadrature.
    pub counts_per_turn: f64,
    /// Which way the encoder counts.
    pub encoder_direction: Direction,
    /// Which way the motor turns the joint.
    pub motor_direction: Direction,
    /// N·m/A at the motor.
    pub torque_constant: f64,
    /// Motor current at full duty, A.
    pub current_at_full: f64,
    /// The most the amplifier gives, A.
    pub current_limit: f64,
    /// Inertia of the rotor, kg·m²; at the joint it counts ratio² times.
    pub rotor_inertia: f64,
    /// Viscous friction at the joint, N·m·s.
    pub viscous_friction: f64,
    /// Dry friction at the joint, N·m.
    pub coulomb_friction: f64,
}

/// The simulated device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantSettings {
    /// Height of the first link's axis over the foot, m.
    pub base_height: f64,
    /// The link that is upright at zero.
    pub first_link: Link,
    /// The link that is level at zero.
    pub second_link: Link,
    /// Origin of the device frame, m from the foot of the turntable.
    pub workspace_centre: Vector,
    /// Inertia of the turntable with all it carries but the links, kg·m².
    pub turntable_inertia: f64,
    /// Acceleration of free fall, m/s²; 0 switches gravity off.
    pub gravity: f64,
    /// Turntable, first link, second link.
    pub joints: [JointSettings; 3],
    /// Time constant of the current loop, s; 0 means at once.
    pub current_time_constant: f64,
    /// From the instant the counts are read to the instant the duty computed from them reaches the amplifier, in servo
    /// periods; rounded to whole sub-steps.
    pub delay_periods: f64,
    /// Integration steps in a servo period.
    pub sub_steps: u32,
}

impl PlantSettings {
    /// WoodenHaptics as published in 2016.
    ///
    /// | number | value | where from |
    /// |---|---|---|
    /// | lengths, workspace centre, ratios, counts, torque constant, currents | | the project's CHAI3D driver (woody-experimental, `cWoodenDevice`) |
    /// | link masses 0.170, 0.110 kg; centres 51, 91 mm | | the same; its gravity compensation |
    /// | directions of encoders and motors | | the same, its USB variant: the turntable's encoder counts against its motor |
    /// | link inertias | `m L²/12` | assumed: thin rods |
    /// | turntable | 2.0e-3 kg·m² | assumed: two motors of 0.24 kg at 50 mm, a disc of 0.25 kg and 160 mm |
    /// | rotor | 33.5 g·cm² | assumed: a Maxon RE 30 of 60 W has about this; not checked against its data sheet |
    /// | friction | 5e-4 N·m·s, 0.01 N·m | assumed: published for a Phantom Premium (Çavuşoğlu 2001), the same kind of arm; none is published for this one, and too little is the safe side, for friction hides limit cycles |
    /// | current loop | 0.15 ms | assumed: about 1 kHz |
    /// | delay | 1 period | assumed: a tick's duty takes effect at the next tick |
    pub const fn wooden_haptics_2016() -> Self {
        const MOTOR: JointSettings = JointSettings {
            ratio: 12.0,
            counts_per_turn: 2_000.0,
            encoder_direction: Direction::With,
            motor_direction: Direction::With,
            torque_constant: 0.0259,
            current_at_full: 3.0,
            current_limit: 3.0,
            rotor_inertia: 33.5e-7,
            viscous_friction: 5e-4,
            coulomb_friction: 0.01,
        };
        Self {
            base_height: 0.080,
            first_link: Link::rod(0.205, 0.170, 0.051),
            second_link: Link::rod(0.245, 0.110, 0.091),
            workspace_centre: [0.220, 0.0, 0.080],
            turntable_inertia: 2.0e-3,
            gravity: 9.81,
            joints: [
                JointSettings { ratio: 16.0, encoder_direction: Direction::Against, ..MOTOR },
                JointSettings { encoder_direction: Direction::Against, motor_direction: Direction::Against, ..MOTOR },
                MOTOR,
            ],
            current_time_constant: 1.5e-4,
            delay_periods: 1.0,
            sub_steps: 20,
        }
    }

    /// The mechanism, with a hand of `hand_mass` kg at its tip.
    pub fn arm(&self, hand_mass: f64) -> Arm {
        let mut joint_inertia = self.joints.map(|joint| joint.rotor_inertia * joint.ratio * joint.ratio);
        joint_inertia[0] += self.turntable_inertia;
        Arm {
            base_height: self.base_height,
            first: self.first_link,
            second: self.second_link,
            workspace_centre: self.workspace_centre,
            joint_inertia,
            tip_mass: hand_mass,
            gravity: self.gravity,
        }
    }

    /// The encoders.
    pub fn encoders(&self) -> [Encoder; 3] {
        self.joints.map(|joint| Encoder::geared(joint.counts_per_turn, joint.ratio, joint.encoder_direction.sign()))
    }

    /// The motors, seen at the joints.
    pub fn motors(&self) -> [Motor; 3] {
        self.joints.map(|joint| Motor {
            current_at_full: joint.current_at_full,
            current_limit: joint.current_limit,
            torque_per_ampere: joint.motor_direction.sign() * joint.torque_constant * joint.ratio,
        })
    }
}
