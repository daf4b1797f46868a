//! What is wrong with a simulated device that is to be commissioned.

use palpate_sim::plant::{Direction, PlantSettings};
use std::str::FromStr;

/// Where marks happen to be.
const MARKS: [Option<i32>; 3] = [Some(137), Some(-421), Some(300)];

/// How a planted device differs from its file.
#[derive(Clone, Copy, Debug)]
pub struct Planted {
    /// The device as it is.
    pub plant: PlantSettings,
    /// The joint whose encoder is on each input.
    pub encoder_on: [usize; 3],
    /// The joint whose motor is on each output.
    pub motor_on: [usize; 3],
    /// The count of each joint's encoder at which its index mark is, once in each turn of its shaft; `None` without.
    pub marks: [Option<i32>; 3],
    /// The joint whose mark is on each input.
    pub mark_on: [usize; 3],
    /// So many counts further off a mark is when it is passed downwards: one that is loose.
    pub mark_play: i32,
}

/// A fault to plant: what, in which joint, and by how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlantedFault {
    /// The encoder counts the other way.
    EncoderSign(usize),
    /// The motor turns the other way.
    MotorSign(usize),
    /// The encoder has so many times the counts.
    Ratio(usize, f64),
    /// The encoder's zero lies elsewhere by so many radians.
    Zero(usize, f64),
    /// The motor gives so many times the torque.
    Torque(usize, f64),
    /// The joint has so many times the friction.
    Friction(usize, f64),
    /// Two encoders are plugged into each other's inputs.
    Encoders(usize, usize),
    /// Two motors are on each other's outputs.
    Motors(usize, usize),
}

impl Planted {
    /// A device that is as it should be.
    pub const fn sound(plant: PlantSettings) -> Self {
        Self { plant, encoder_on: [0, 1, 2], motor_on: [0, 1, 2], marks: MARKS, mark_on: [0, 1, 2], mark_play: 0 }
    }

    /// The same with a fault in it.
    pub fn with(mut self, fault: PlantedFault) -> Self {
        fn turn(direction: &mut Direction) {
            *direction = if *direction == Direction::With { Direction::Against } else { Direction::With };
        }
        let joints = &mut self.plant.joints;
        match fault {
            PlantedFault::EncoderSign(joint) => turn(&mut joints[joint].encoder_direction),
            PlantedFault::MotorSign(joint) => turn(&mut joints[joint].motor_direction),
            PlantedFault::Ratio(joint, times) => joints[joint].counts_per_turn *= times,
            PlantedFault::Zero(joint, radians) => joints[joint].angle_at_zero += radians,
            PlantedFault::Torque(joint, times) => joints[joint].torque_constant *= times,
            PlantedFault::Friction(joint, times) => joints[joint].coulomb_friction *= times,
            PlantedFault::Encoders(a, b) => {
                self.encoder_on.swap(a, b);
                self.mark_on.swap(a, b);
            }
            PlantedFault::Motors(a, b) => self.motor_on.swap(a, b),
        }
        self
    }
}

impl FromStr for PlantedFault {
    type Err = String;

    /// `encoder-sign:0`, `motor-sign:2`, `ratio:0=1.25`, `zero:1=0.2`, `torque:2=0.8`, `friction:0=2`, `encoders:0-1`,
    /// `motors:1-2`.
    fn from_str(text: &str) -> Result<Self, String> {
        let refusal = || {
            format!(
                "{text}: it must be encoder-sign:J, motor-sign:J, ratio:J=TIMES, zero:J=RADIANS, torque:J=TIMES, \
                 friction:J=TIMES, encoders:J-K or motors:J-K, with joints from 0 to 2"
            )
        };
        let joint = |text: &str| text.parse::<usize>().ok().filter(|joint| *joint < 3).ok_or_else(refusal);
        let (what, rest) = text.split_once(':').ok_or_else(refusal)?;
        let number = || -> Result<_, String> {
            let (which, by) = rest.split_once('=').ok_or_else(refusal)?;
            let by = by.parse::<f64>().ok().filter(|by| by.is_finite()).ok_or_else(refusal)?;
            let is_factor = what != "zero";
            if is_factor && by <= 0.0 { Err(refusal()) } else { Ok((joint(which)?, by)) }
        };
        let pair = || -> Result<_, String> {
            let (a, b) = rest.split_once('-').ok_or_else(refusal)?;
            Ok((joint(a)?, joint(b)?))
        };
        Ok(match what {
            "encoder-sign" => Self::EncoderSign(joint(rest)?),
            "motor-sign" => Self::MotorSign(joint(rest)?),
            "ratio" => number().map(|(joint, by)| Self::Ratio(joint, by))?,
            "zero" => number().map(|(joint, by)| Self::Zero(joint, by))?,
            "torque" => number().map(|(joint, by)| Self::Torque(joint, by))?,
            "friction" => number().map(|(joint, by)| Self::Friction(joint, by))?,
            "encoders" => pair().map(|(a, b)| Self::Encoders(a, b))?,
            "motors" => pair().map(|(a, b)| Self::Motors(a, b))?,
            _ => return Err(refusal()),
        })
    }
}
