//! The stage: a body, the loop on three slides, and the hand.

use crate::felt::Loaded;
use crate::felt::{Felt, FeltWitness, Yielding};
use crate::view;
use crate::view::Sighted as _;
use alloc::boxed::Box;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;
use palpate::body::Located;
use palpate::device::drive::Feed;
use palpate::device::{Counts, Device, Encoder, Kinematics, Motor, ProbePose};
use palpate::field::Displacement as _;
use palpate::math::{Vec3, vec3};
use palpate::render::Friction;
use palpate::servo::{Config, Event, Guard, Input, Rendering, Servo, ServoState, Settings, Unguarded};
use palpate::track::{Controller, FirstOrder};

/// The reader's choices, which may change while the loop runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choices {
    /// Hz.
    pub rate: f32,
    /// N/m.
    pub stiffness: f32,
    /// N·s/m.
    pub damping: f32,
    /// `μ_s`; slipping holds three quarters of it.
    pub friction: f32,
    /// 0: second order, 1: the paper's law, 2: the projected gradient.
    pub law: u32,
}

impl Choices {
    /// 4 kHz and a firm wall.
    pub const DEFAULT: Self = Self { rate: 4_000.0, stiffness: 1_000.0, damping: 2.0, friction: 0.0, law: 0 };

    /// The controller of the law.
    pub const fn controller(&self) -> Controller {
        match self.law {
            0 => Controller::SecondOrder,
            1 => Controller::FirstOrder(FirstOrder::CERTIFIED),
            _ => Controller::FirstOrder(FirstOrder::COVARIANT),
        }
    }
}

type Loop = Servo<'static, Felt, Slides, 3>;
type State = ServoState<3, FeltWitness, <Unguarded as Guard<3>>::State>;

/// A body as a surface.
pub struct Stage {
    /// The surface.
    pub loaded: Loaded,
    device: &'static Device<Slides, 3>,
    choices: Choices,
    servo: Loop,
    state: State,
    hand: Hand,
    target: Vec3,
    /// The projection error after each tick of the last run, metres.
    pub errors: Vec<f32>,
}

impl Stage {
    /// The stage of a body, its hand at a place in the frame of the tables, metres.
    ///
    /// # Errors
    /// The loop's refusal, in a sentence.
    pub fn new(loaded: Loaded, place: Vec3) -> Result<Self, String> {
        let device: &'static _ = Box::leak(Box::new(slides(loaded.body.size())));
        let choices = Choices::DEFAULT;
        let servo = servo(device, loaded.felt, &choices)?;
        let hand = Hand { position: place, velocity: Vec3::ZERO };
        Ok(Self { loaded, device, choices, servo, state: servo.start(), hand, target: place, errors: Vec::new() })
    }

    /// Goes on with other choices.
    ///
    /// # Errors
    /// The setting that is refused; then all stays as it was.
    pub fn choose(&mut self, choices: Choices) -> Result<(), String> {
        let loaded = self.loaded.at_rate(choices.rate)?;
        self.servo = servo(self.device, loaded.felt, &choices)?;
        (self.loaded, self.choices) = (loaded, choices);
        Ok(())
    }

    /// The body with modes, from their numbers, where it is loaded.
    ///
    /// # Errors
    /// The error in the modes, in a sentence.
    pub fn soften(&mut self, numbers: &[f32]) -> Result<(), String> {
        *self = Self::new(self.loaded.softened(numbers, Choices::DEFAULT.rate)?, self.target)?;
        Ok(())
    }

    /// The body that gives way, if it does.
    pub fn soft(&self) -> Option<&'static Yielding> {
        match self.loaded.felt {
            Felt::Soft(soft) => Some(soft),
            Felt::Body(_) | Felt::Patch(_) => None,
        }
    }

    /// Writes of each mode its number, see [`Yielding::view`].
    pub fn modes(&self, out: &mut Vec<f32>) {
        if let Some(soft) = self.soft() {
            soft.view(self.state.witness(), out);
        }
    }

    /// The closest point from a standing start, of the body as it is now.
    pub fn closest(&self, probe: Vec3) -> Located {
        match self.soft() {
            Some(soft) => soft.body.soft().locate(probe, &self.state.witness().q()),
            None => self.loaded.body.locate(probe),
        }
    }

    /// Takes points with vectors along the normal there, `vectors` of them after each point, along with the body as it
    /// is now.
    pub fn displace(&self, out: &mut [f32], vectors: usize) {
        let Some(soft) = self.soft() else { return };
        let field = soft.body.soft().field(&self.state.witness().q());
        for numbers in out.chunks_exact_mut(3 * (1 + vectors)) {
            let (at, normals) = numbers.as_chunks_mut::<3>().0.split_at_mut(1);
            let [at] = at else { return };
            let rest = Vec3::from_array(*at);
            *at = (&field).point(rest).to_array();
            for normal in normals {
                let turned = (&field).normal(rest, Vec3::from_array(*normal));
                *normal = turned.normalize().to_array();
            }
        }
    }

    /// Restarts with the hand at a place, as after power-on.
    pub fn restart(&mut self, place: Vec3) {
        self.state = self.servo.start();
        self.hand = Hand { position: place, velocity: Vec3::ZERO };
        self.target = place;
    }

    /// Runs a number of ticks, in which the pointer moves straight to a place. A yielding hand is pushed back by the
    /// device; a rigid one is where the pointer is.
    pub fn run(&mut self, ticks: u32, to: Vec3, yields: bool) {
        let (from, period) = (self.target, 1.0 / self.choices.rate);
        let controller = self.choices.controller();
        self.errors.clear();
        for tick in 0..ticks {
            let at = |tick: u32| from + (to - from) * (tick as f32 / ticks as f32);
            let way = [at(tick), at(tick + 1)];
            if yields {
                let force = force_of(self.device, self.state.duties().map(|duty| duty.fraction()));
                self.hand.advance(&Grip::LIGHT, way, force, period);
            } else {
                self.hand = Hand { position: way[1], velocity: Vec3::ZERO };
            }
            let counts = counts_at(self.device, self.hand.position).map(Counts);
            self.servo.note(&mut self.state, Event::LinkAlive);
            let _ = self.servo.tick(&mut self.state, Input::Sensors { counts, enable: true });
            let [_, error] =
                view::next_step(&self.loaded.felt.sight(self.state.witness()), &controller, self.state.probe());
            self.errors.push(error);
        }
        self.target = to;
    }

    /// Only the ticks, for their time.
    pub fn tick_only(&mut self, ticks: u32) {
        let counts = counts_at(self.device, self.hand.position).map(Counts);
        for _ in 0..ticks {
            let _ = self.servo.tick(&mut self.state, Input::Sensors { counts, enable: true });
        }
    }

    /// The visible state.
    pub fn view(&self, out: &mut Vec<f32>) {
        view::write(&self.state, self.loaded.felt, &self.choices.controller(), self.target, out);
    }

    /// A hash of every bit of the loop's state.
    pub fn digest(&self) -> u32 {
        self.state.digest()
    }
}

fn servo(device: &'static Device<Slides, 3>, felt: &'static Felt, choices: &Choices) -> Result<Loop, String> {
    let settings = Settings {
        rate_hz: choices.rate,
        stiffness_n_per_m: choices.stiffness,
        damping_n_s_per_m: choices.damping,
        max_force_n: device.max_force_n,
        velocity_corner_hz: 150.0,
        soft_start_s: 0.1,
        body_origin_m: Vec3::ZERO,
    };
    let friction = Friction {
        stiffness_n_per_m: choices.stiffness,
        damping_n_s_per_m: 1.0,
        static_coefficient: choices.friction,
        dynamic_coefficient: 0.75 * choices.friction,
    };
    let friction = (choices.friction > 0.0).then_some(friction);
    let rendering = Rendering { friction, ..Rendering::PLAIN };
    let config = Config { controller: choices.controller(), settings, rendering, ..Config::DEFAULT };
    Servo::try_new(device, felt, config).map_err(|error| error.to_string())
}

// The device in the page's hand: three slides for the mouse.

/// Three slides at right angles: a joint angle of a radian is a metre.
#[derive(Clone, Copy, Debug)]
pub struct Slides;

impl Kinematics<3> for Slides {
    fn pose(&self, angles: [f32; 3]) -> Option<ProbePose<3>> {
        Some(ProbePose { position: Vec3::from_array(angles), jacobian: [Vec3::X, Vec3::Y, Vec3::Z] })
    }
}

/// Maximum force of the slides' motors, N.
const GREATEST_FORCE: f32 = 20.0;

/// The slides for a body of this size, metres. An encoder resolves the 2⁻¹⁸th part of the size: a quarter of a
/// micrometre of 6 cm.
pub fn slides(size: f32) -> Device<Slides, 3> {
    let reach = 16.0 * size;
    Device {
        kinematics: Slides,
        // The pose at count zero is exact: there is no line to be in the middle of.
        encoders: [Encoder { radians_per_count: size / 262_144.0, angle_at_zero_rad: 0.0 }; 3],
        motors: [Motor { torque_at_full_n_m: GREATEST_FORCE }; 3],
        feeds: [Feed::Current; 3],
        dry_friction_n_m: [0.0; 3],
        // The rim of 0.05 is one of radians: the slides have none.
        joint_range_rad: [[-reach - 1.0, reach + 1.0]; 3],
        min_margin_m_per_rad: 0.01,
        // A mouse jumps.
        max_joint_rate_rad_per_s: f32::MAX,
        max_force_n: GREATEST_FORCE,
        max_stiffness_n_per_m: 10_000.0,
        max_damping_n_s_per_m: 50.0,
    }
}

/// The counts at which the slides are nearest to a place, metres.
pub fn counts_at(device: &Device<Slides, 3>, place: Vec3) -> [i32; 3] {
    let place = place.to_array();
    core::array::from_fn(|joint| {
        let count = place[joint] / device.encoders[joint].radians_per_count;
        // The cast truncates.
        (count + if count < 0.0 { -0.5 } else { 0.5 }) as i32
    })
}

/// The force that duties give on the slides, N.
pub fn force_of(device: &Device<Slides, 3>, duties: [f32; 3]) -> Vec3 {
    let [x, y, z] = core::array::from_fn(|joint| duties[joint] * device.motors[joint].torque_at_full_n_m);
    vec3(x, y, z)
}

// The hand that holds the device: it wants to be where the pointer is, and the device pushes back.

/// How a hand holds a handle.
#[derive(Clone, Copy, Debug)]
pub struct Grip {
    /// Mass of hand and handle, kg.
    pub mass: f32,
    /// N/m.
    pub stiffness: f32,
    /// N·s/m.
    pub damping: f32,
}

impl Grip {
    /// A light grip: 50 g, pulled to the pointer by 400 N/m and critically damped, `2 √(k m)`.
    pub const LIGHT: Self = Self { mass: 0.05, stiffness: 400.0, damping: 8.944_272 };
}

/// Where the handle is, and how fast.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hand {
    /// Metres.
    pub position: Vec3,
    /// m/s.
    pub velocity: Vec3,
}

/// The longest step of the integration, s.
const STEP: f32 = 1.25e-4;

impl Hand {
    /// Moves on by a period, s, towards a place that itself moves on to `to`, under the device's force, N, which it
    /// holds for so long. Semi-implicit Euler.
    pub fn advance(&mut self, grip: &Grip, [from, to]: [Vec3; 2], force: Vec3, period: f32) {
        let steps = (period / STEP) as u32 + 1;
        let step = period / steps as f32;
        let wanted = (to - from) / period;
        for index in 0..steps {
            let place = from + (to - from) * ((index + 1) as f32 / steps as f32);
            let pull = (place - self.position) * grip.stiffness + (wanted - self.velocity) * grip.damping;
            self.velocity += (pull + force) * (step / grip.mass);
            self.position += self.velocity * step;
        }
    }
}
