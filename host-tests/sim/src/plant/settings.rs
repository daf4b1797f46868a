//! Every number of the simulated device.

use super::arm::{Arm, Link};
use super::delta::DeltaSettings;
use super::encoder::Encoder;
use super::five_bar::{FiveBarSettings, LinkageArmSettings};
use super::lumped::{Geometry, Lumped};
use super::mechanism::Mechanism;
use super::motor::{Amplifier, Motor};
use super::paddle::PaddleSettings;
use super::vector::{Vector, scaled};

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
    /// Direction in which the encoder counts.
    pub encoder_direction: Direction,
    /// Joint angle at zero counts, rad.
    pub angle_at_zero: f64,
    /// The amplifier of the motor.
    pub amplifier: Amplifier,
    /// Direction in which the motor turns the joint.
    pub motor_direction: Direction,
    /// N·m/A at the motor, and V·s/rad.
    pub torque_constant: f64,
    /// Motor current at full duty, A; on a bridge full duty is the supply's voltage instead.
    pub current_at_full: f64,
    /// Maximum current of the amplifier, A.
    pub current_limit: f64,
    /// Inertia of the rotor, kg·m²; at the joint it is ratio² times as large.
    pub rotor_inertia: f64,
    /// Viscous friction at the joint, N·m·s.
    pub viscous_friction: f64,
    /// Dry friction at the joint, N·m.
    pub coulomb_friction: f64,
    /// Joint angles of the end stops, rad.
    pub stops: [f64; 2],
}

impl JointSettings {
    /// A joint that is not there: no counts, no torque, no friction.
    pub const NONE: Self = Self {
        ratio: 1.0,
        counts_per_turn: 1.0,
        encoder_direction: Direction::With,
        angle_at_zero: 0.0,
        amplifier: Amplifier::Current,
        motor_direction: Direction::With,
        torque_constant: 0.0,
        current_at_full: 0.0,
        current_limit: 0.0,
        rotor_inertia: 1.0,
        viscous_friction: 0.0,
        coulomb_friction: 0.0,
        stops: [f64::NEG_INFINITY, f64::INFINITY],
    };
}

/// A turntable with two links.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmSettings {
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
    /// Moment that counterweights and drums add to each link, kg·m.
    pub balance: [f64; 2],
    /// Their inertia about the links' axes, kg·m².
    pub balance_inertia: [f64; 2],
}

/// Which mechanism it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MechanismSettings {
    /// Three joints: a turntable with two links.
    Arm(ArmSettings),
    /// One joint.
    Paddle(PaddleSettings),
    /// Two joints: a five-bar flat on a table, so that gravity does not load it.
    FiveBar(FiveBarSettings),
    /// Three joints: a five-bar upright on a turntable.
    LinkageArm(LinkageArmSettings),
    /// Three joints: a delta standing on its side, y up.
    Delta(DeltaSettings),
}

/// The simulated device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantSettings {
    /// The mechanism.
    pub mechanism: MechanismSettings,
    /// Acceleration of free fall, m/s²; 0 switches gravity off.
    pub gravity: f64,
    /// Its joints; for a turntable with two links turntable, first link, second link.
    pub joints: [JointSettings; 3],
    /// Time constant of the current loops, s; 0 means at once.
    pub current_time_constant: f64,
    /// From the instant the counts are read to the instant the duty computed from them reaches the amplifier, in servo
    /// periods; rounded to whole sub-steps.
    pub delay_periods: f64,
    /// Integration steps in a servo period.
    pub sub_steps: u32,
}

impl PlantSettings {
    /// The numbers of a mechanism of three joints for a plant of another make, as JSON: SI units, rotors at the joint with
    /// all that turns with it alone. `None` with fewer joints.
    pub fn numbers(&self) -> Option<String> {
        let joints = &self.joints;
        let mut rotors = joints.map(|joint| joint.rotor_inertia * joint.ratio * joint.ratio);
        let link = |link: Link| [link.length, link.mass, link.centre, link.inertia];
        let mut rows: Vec<(&str, String)> = match self.mechanism {
            MechanismSettings::Arm(arm) => {
                rotors[0] += arm.turntable_inertia;
                rotors[1] += arm.balance_inertia[0];
                rotors[2] += arm.balance_inertia[1];
                vec![
                    ("balance", format!("{:?}", arm.balance)),
                    ("first", format!("{:?}", link(arm.first_link))),
                    ("second", format!("{:?}", link(arm.second_link))),
                    ("base_height", format!("{:?}", arm.base_height)),
                    ("centre", format!("{:?}", arm.workspace_centre)),
                ]
            }
            MechanismSettings::Delta(delta) => {
                rotors = rotors.map(|rotor| rotor + delta.thigh_inertia);
                let DeltaSettings { a, b, c, d, e, f, r, s, .. } = delta;
                vec![
                    ("lengths", format!("{:?}", [a, b, c, d, e, f, r, s])),
                    ("legs", format!("{:?}", delta.legs)),
                    ("depth", format!("{:?}", delta.workspace_depth)),
                    ("thigh", format!("{:?}", [delta.thigh_mass, delta.thigh_centre])),
                    ("shin", format!("{:?}", delta.shin_mass)),
                    ("plate", format!("{:?}", delta.plate_mass)),
                ]
            }
            MechanismSettings::LinkageArm(arm) => {
                rotors[0] += arm.turntable_inertia;
                let FiveBarSettings { second_pivot, cranks, rods, tool, side, links, .. } = arm.linkage;
                vec![
                    ("pivots", format!("{:?}", [arm.pivot_reach, second_pivot])),
                    ("lengths", format!("{:?}", [cranks[0], cranks[1], rods[0], rods[1], tool])),
                    ("side", format!("{side:?}")),
                    ("links", format!("{:?}", links.map(|link| [link.mass, link.along, link.across, link.inertia]))),
                    ("centre", format!("{:?}", arm.workspace_centre)),
                ]
            }
            MechanismSettings::FiveBar(_) | MechanismSettings::Paddle(_) => return None,
        };
        let time_constants = joints.map(|joint| match joint.amplifier {
            Amplifier::Voltage(winding) => winding.inductance / winding.resistance,
            Amplifier::Current | Amplifier::CurrentOn(_) => self.current_time_constant,
        });
        rows.extend([
            ("gravity", format!("{:?}", self.gravity)),
            ("time_constant", format!("{time_constants:?}")),
            ("rotors", format!("{rotors:?}")),
            ("viscous", format!("{:?}", joints.map(|joint| joint.viscous_friction))),
            ("coulomb", format!("{:?}", joints.map(|joint| joint.coulomb_friction))),
            ("stops", format!("{:?}", joints.map(|joint| joint.stops))),
        ]);
        let rows: Vec<String> = rows.iter().map(|(name, value)| format!("{name:?}: {value}")).collect();
        Some(format!("{{{}}}", rows.join(", ")))
    }

    /// The same in as many sub-steps as a test needs, or in those of the environment's `PALPATE_SUB_STEPS`.
    ///
    /// # Panics
    /// If that is no number.
    #[must_use]
    pub fn in_sub_steps(self, enough: u32) -> Self {
        let asked = std::env::var("PALPATE_SUB_STEPS").ok();
        Self { sub_steps: asked.map_or(enough, |count| count.parse().expect("PALPATE_SUB_STEPS")), ..self }
    }

    /// The mechanism, with a hand of `hand_mass` kg on the probe.
    pub fn mechanism(&self, hand_mass: f64) -> Box<dyn Mechanism> {
        let along = |direction: Vector| scaled(direction, self.gravity);
        let (down, flat, sideways) = ([0.0, 0.0, -1.0], [0.0; 3], [0.0, -1.0, 0.0]);
        match self.mechanism {
            MechanismSettings::Arm(settings) => Box::new(self.arm_of(&settings, hand_mass)),
            MechanismSettings::Paddle(settings) => {
                self.lumped(settings, [settings.inertia, 0.0, 0.0], hand_mass, along(down))
            }
            MechanismSettings::FiveBar(settings) => self.lumped(settings, [0.0; 3], hand_mass, along(flat)),
            MechanismSettings::LinkageArm(settings) => {
                self.lumped(settings, [settings.turntable_inertia, 0.0, 0.0], hand_mass, along(down))
            }
            MechanismSettings::Delta(settings) => {
                let knee = 0.5 * settings.shin_mass * settings.a * settings.a;
                self.lumped(settings, [settings.thigh_inertia + knee; 3], hand_mass, along(sideways))
            }
        }
    }

    fn lumped<G: Geometry + 'static>(
        &self,
        geometry: G,
        added_inertia: Vector,
        hand_mass: f64,
        gravity: Vector,
    ) -> Box<dyn Mechanism> {
        let rotors = self.rotor_inertia();
        let joint_inertia = core::array::from_fn(|joint| rotors[joint] + added_inertia[joint]);
        Box::new(Lumped { geometry, joint_inertia, hand_mass, gravity })
    }

    /// The rotors' inertia seen at the joints, kg·m².
    fn rotor_inertia(&self) -> Vector {
        self.joints.map(|joint| joint.rotor_inertia * joint.ratio * joint.ratio)
    }

    fn arm_of(&self, settings: &ArmSettings, hand_mass: f64) -> Arm {
        let mut joint_inertia = self.rotor_inertia();
        joint_inertia[0] += settings.turntable_inertia;
        joint_inertia[1] += settings.balance_inertia[0];
        joint_inertia[2] += settings.balance_inertia[1];
        Arm {
            base_height: settings.base_height,
            first: settings.first_link,
            second: settings.second_link,
            workspace_centre: settings.workspace_centre,
            balance: settings.balance,
            joint_inertia,
            tip_mass: hand_mass,
            gravity: self.gravity,
        }
    }

    /// The mechanism as an arm.
    ///
    /// # Panics
    /// If it is another.
    pub fn arm(&self, hand_mass: f64) -> Arm {
        match &self.mechanism {
            MechanismSettings::Arm(settings) => self.arm_of(settings, hand_mass),
            other => panic!("not an arm: {other:?}"),
        }
    }

    /// The encoders.
    pub fn encoders(&self) -> [Encoder; 3] {
        self.joints.map(|joint| {
            let direction = joint.encoder_direction.sign();
            Encoder::geared(joint.counts_per_turn, joint.ratio, direction, joint.angle_at_zero)
        })
    }

    /// The motors, seen at the joints.
    pub fn motors(&self) -> [Motor; 3] {
        self.joints.map(|joint| Motor {
            amplifier: joint.amplifier,
            current_at_full: joint.current_at_full,
            current_limit: joint.current_limit,
            torque_per_ampere: joint.motor_direction.sign() * joint.torque_constant * joint.ratio,
        })
    }
}
