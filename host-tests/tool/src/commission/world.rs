//! The simulated device on a simulated bench, and the hands at it.

use super::{Hands, Planted, RATE};
use palpate_sim::plant::{HandPath, HandSettings, Plant, Vector};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Of the spring whose far end is what pulls, N/m: so soft that the probe's own motion changes the force by nothing.
const SOFT: f64 = 1e-3;

/// What the pins of a simulated board are wired to.
pub struct World {
    plant: Plant,
    planted: Planted,
    /// The enable button is pressed.
    pub enable: bool,
    /// The inputs' counts where the board began to count.
    began: [i32; 3],
    /// Where each joint's mark was passed since somebody asked, in its encoder's counts.
    passed: [Option<i32>; 3],
    /// Where the far end of the soft spring is.
    far: Shared<Vector>,
}

/// What two share.
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
    /// A device at rest in the middle of its workspace, which somebody holds there.
    ///
    /// # Errors
    /// What the plant refuses.
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

    /// The board is reset: its counters begin at zero where the joints stand. Before that they are zero in the pose in
    /// which the device is homed, as those of sensors are that know it.
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

    /// The counts at which the inputs' marks were passed since this was asked last.
    pub fn take_marks(&mut self) -> [Option<i32>; 3] {
        let passed = std::mem::take(&mut self.passed);
        core::array::from_fn(|input| {
            passed[self.planted.mark_on[input]].map(|mark| mark.wrapping_sub(self.began[input]))
        })
    }

    /// Joints that stood at these counts have moved: past which marks.
    fn pass_marks(&mut self, before: [i32; 3]) {
        for (joint, (now, before)) in self.plant.counts().into_iter().zip(before).enumerate() {
            let Some(mark) = self.planted.marks[joint] else { continue };
            let turn = self.planted.plant.joints[joint].counts_per_turn;
            // Which turn of its shaft it is in, before and now; the mark that it passed last begins one of them.
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

    /// The simulated joints' stops close in on these angles.
    fn place(&mut self, angles: Vector) {
        for (joint, angle) in angles.into_iter().enumerate() {
            self.plant.move_stops(joint, [angle, angle]);
        }
    }
}

/// Hands that do as they are told.
pub struct SimulatedHands {
    world: Arc<Mutex<World>>,
    /// Where the joints are held, rad.
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

    fn pull(&mut self, force: [f64; 3]) -> anyhow::Result<f64> {
        *lock(&lock(&self.world).far) = force.map(|part| part / SOFT);
        Ok(force.iter().map(|part| part * part).sum::<f64>().sqrt())
    }

    fn enable(&mut self, pressed: bool) -> anyhow::Result<()> {
        lock(&self.world).enable = pressed;
        Ok(())
    }
}
