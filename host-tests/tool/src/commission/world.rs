//! The simulated device on a simulated bench, and the hands at it.

use super::{Hands, RATE};
use palpate_sim::devices::DeviceFile;
use palpate_sim::plant::{Direction, HandPath, HandSettings, Plant, PlantSettings, Vector};
use std::str::FromStr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Stiffness of the pulling spring, N/m: so soft that the probe's own motion does not change the force.
const SOFT: f64 = 1e-3;

/// Everything that the pins of a simulated board are wired to.
pub struct World {
    plant: Plant,
    planted: Planted,
    /// Whether the enable button is pressed.
    pub enable: bool,
    /// The inputs' counts at the start of the board's counters.
    began: [i32; 3],
    /// Counts of each joint's encoder at which its mark was passed since the last query.
    passed: [Option<i32>; 3],
    /// Position of the soft spring's far end.
    far: Shared<Vector>,
}

/// State shared by two owners.
type Shared<T> = Arc<Mutex<T>>;

fn lock<T>(shared: &Shared<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

struct Far(Shared<Vector>);

impl HandPath for Far {
    fn target(&self, _time: f64) -> Vector {
        *lock(&self.0)
    }
    fn velocity(&self, _time: f64) -> Vector {
        [0.0; 3]
    }
}

impl World {
    /// A device at rest in the middle of its workspace, held there.
    ///
    /// # Errors
    /// An error of the plant.
    pub fn new(planted: Planted) -> anyhow::Result<Self> {
        let far = Arc::new(Mutex::new([0.0; 3]));
        let hand = HandSettings { stiffness: SOFT, damping: 0.0, mass: 0.0 };
        let plant = Plant::new(&planted.plant, hand, Box::new(Far(Arc::clone(&far))), f64::from(RATE))?;
        let mut world = Self { plant, planted, enable: false, began: [0; 3], passed: [None; 3], far };
        world.place(world.plant.angles());
        Ok(world)
    }

    /// The same, for a board and for the hands at it.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn shared(planted: Planted) -> anyhow::Result<Arc<Mutex<Self>>> {
        Ok(Arc::new(Mutex::new(Self::new(planted)?)))
    }

    /// Resets the board: its counters start at zero in the joints' current position. Before that, they are zero in the
    /// homing pose, as with absolute sensors.
    pub fn begin_to_count(&mut self) {
        self.began = self.at_inputs();
    }

    /// The counts at the board's inputs.
    pub fn counts(&self) -> [i32; 3] {
        let now = self.at_inputs();
        core::array::from_fn(|input| now[input].wrapping_sub(self.began[input]))
    }

    fn at_inputs(&self) -> [i32; 3] {
        let joints = self.plant.counts();
        self.planted.encoder_on.map(|joint| joints[joint])
    }

    /// The counts at which the inputs' marks were passed since the last query.
    pub fn take_marks(&mut self) -> [Option<i32>; 3] {
        let passed = std::mem::take(&mut self.passed);
        core::array::from_fn(|input| {
            passed[self.planted.mark_on[input]].map(|mark| mark.wrapping_sub(self.began[input]))
        })
    }

    /// Records the marks that the joints passed since they had these counts.
    fn pass_marks(&mut self, before: [i32; 3]) {
        for (joint, (now, before)) in self.plant.counts().into_iter().zip(before).enumerate() {
            let Some(mark) = self.planted.marks[joint] else { continue };
            let turn = self.planted.plant.joints[joint].counts_per_turn;
            // The turn of its shaft, before and now: the last mark is the start of the current turn if the count rose,
            // of the next turn if it fell.
            let [from, to] = [before, now].map(|count| (f64::from(count - mark) / turn).floor());
            if from != to {
                let last = if to > from { to } else { to + 1.0 };
                let play = if to > from { 0 } else { self.planted.mark_play };
                self.passed[joint] = Some(mark + (last * turn).round() as i32 + play);
            }
        }
    }

    /// A period under these duties of the board's outputs.
    pub fn advance(&mut self, duties: [i16; 3]) {
        let mut at_joints = [0; 3];
        for (duty, joint) in duties.iter().zip(self.planted.motor_on) {
            at_joints[joint] = *duty;
        }
        let before = self.plant.counts();
        self.plant.advance(at_joints);
        self.pass_marks(before);
    }

    /// Closes the stops of the simulated joints on these angles.
    fn place(&mut self, angles: Vector) {
        for (joint, angle) in angles.into_iter().enumerate() {
            self.plant.move_stops(joint, [angle, angle]);
        }
    }
}

/// Simulated hands that follow every instruction.
pub struct SimulatedHands {
    world: Arc<Mutex<World>>,
    /// Angles at which the joints are held, rad.
    held: Vector,
}

impl SimulatedHands {
    /// At this bench.
    pub fn new(world: &Arc<Mutex<World>>) -> Self {
        Self { world: Arc::clone(world), held: lock(world).plant.angles() }
    }
}

impl Hands for SimulatedHands {
    fn place(&mut self, angles: [f64; 3]) -> anyhow::Result<()> {
        self.held = angles;
        lock(&self.world).place(angles);
        Ok(())
    }

    fn pose(&mut self, _: [f64; 3]) -> anyhow::Result<()> {
        // Wherever the file has it.
        let pose = lock(&self.world).planted.plant.joints.map(|joint| joint.angle_at_zero);
        self.place(pose)
    }

    fn pass(&mut self, _: usize, angles: [f64; 3]) -> anyhow::Result<()> {
        self.place(angles)
    }

    fn rest(&mut self, joint: usize, towards: f64) -> anyhow::Result<()> {
        let mut world = lock(&self.world);
        let [least, most] = world.planted.plant.joints[joint].stops;
        let at = self.held[joint];
        world.plant.move_stops(joint, if towards > 0.0 { [at, most.max(at)] } else { [least.min(at), at] });
        Ok(())
    }

    fn carry(&mut self, output: u8) -> anyhow::Result<()> {
        let mut world = lock(&self.world);
        let joint = world.planted.motor_on[usize::from(output)];
        let stops = world.planted.plant.joints[joint].stops;
        world.plant.move_stops(joint, stops);
        Ok(())
    }

    fn pull(&mut self, force: [f64; 3]) -> anyhow::Result<f64> {
        *lock(&lock(&self.world).far) = force.map(|part| part / SOFT);
        Ok(force.iter().map(|part| part * part).sum::<f64>().sqrt())
    }

    fn enable(&mut self, pressed: bool) -> anyhow::Result<()> {
        lock(&self.world).enable = pressed;
        Ok(())
    }
}

// Faults of a simulated device that is to be commissioned.

/// Arbitrary positions of the marks.
const MARKS: [Option<i32>; 3] = [Some(137), Some(-421), Some(300)];

/// How a planted device differs from its file.
#[derive(Clone, Copy, Debug)]
pub struct Planted {
    /// The device with its true numbers.
    pub plant: PlantSettings,
    /// The joint whose encoder is on each input.
    pub encoder_on: [usize; 3],
    /// The joint whose motor is on each output.
    pub motor_on: [usize; 3],
    /// The count of each joint's encoder at its index mark, which comes once in each turn of its shaft; `None` without
    /// a mark.
    pub marks: [Option<i32>; 3],
    /// The joint whose mark is on each input.
    pub mark_on: [usize; 3],
    /// Displacement of a loose mark, counts, when it is passed downwards.
    pub mark_play: i32,
}

/// A fault to plant: kind, joint and size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlantedFault {
    /// The encoder counts in the opposite direction.
    EncoderSign(usize),
    /// The motor turns in the opposite direction.
    MotorSign(usize),
    /// The encoder's counts are multiplied by this factor.
    Ratio(usize, f64),
    /// The encoder's zero is displaced by this angle, radians.
    Zero(usize, f64),
    /// The motor's torque is multiplied by this factor.
    Torque(usize, f64),
    /// The joint's friction is multiplied by this factor.
    Friction(usize, f64),
    /// The encoders of two joints are swapped.
    Encoders(usize, usize),
    /// The motors of two joints are swapped.
    Motors(usize, usize),
    /// The links' weight is multiplied by this factor.
    Weight(f64),
}

impl Planted {
    /// A device without faults.
    pub const fn sound(plant: PlantSettings) -> Self {
        Self { plant, encoder_on: [0, 1, 2], motor_on: [0, 1, 2], marks: MARKS, mark_on: [0, 1, 2], mark_play: 0 }
    }

    /// The same, wired as its file says.
    #[must_use]
    pub fn wired(mut self, file: &DeviceFile) -> Self {
        for (joint, entry) in file.joint.iter().enumerate() {
            let (input, output) = (entry.encoder.channel, entry.motor.channel);
            (self.encoder_on[input], self.mark_on[input], self.motor_on[output]) = (joint, joint, joint);
        }
        self
    }

    /// The same with an arm whose weight somebody carries.
    #[must_use]
    pub fn carried(mut self) -> Self {
        self.plant.gravity = 0.0;
        self
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
            PlantedFault::Weight(times) => self.plant.gravity *= times,
        }
        self
    }
}

impl FromStr for PlantedFault {
    type Err = String;

    /// `encoder-sign:0`, `motor-sign:2`, `ratio:0=1.25`, `zero:1=0.2`, `torque:2=0.8`, `friction:0=2`, `encoders:0-1`,
    /// `motors:1-2`, `weight:1.1`.
    fn from_str(text: &str) -> Result<Self, String> {
        let refusal = || {
            format!(
                "{text}: it must be encoder-sign:J, motor-sign:J, ratio:J=TIMES, zero:J=RADIANS, torque:J=TIMES, \
                 friction:J=TIMES, encoders:J-K, motors:J-K or weight:TIMES, with joints from 0 to 2"
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
            "weight" => {
                let times = rest.parse().ok().filter(|times| (0.0..=10.0).contains(times));
                Self::Weight(times.ok_or_else(refusal)?)
            }
            _ => return Err(refusal()),
        })
    }
}
