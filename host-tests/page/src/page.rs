//! The stage: a body, the loop on three slides, and the hand.

use alloc::boxed::Box;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;
use palpate::device::{Counts, Device};
use palpate::math::Vec3;
use palpate::render::Friction;
use palpate::servo::{Event, Guard, Input, Rendering, Servo, ServoState, Settings, Unguarded};
use palpate::track::{Controller, FirstOrder};

use crate::felt::{Felt, FeltWitness};
use crate::hand::{Grip, Hand};
use crate::loaded::Loaded;
use crate::sight::Sighted as _;
use crate::slides::{self, Slides};
use crate::view;

/// What the reader may change while the loop runs.
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
            0 => Controller::SECOND_ORDER,
            1 => Controller::FirstOrder(FirstOrder::CERTIFIED),
            _ => Controller::FirstOrder(FirstOrder::COVARIANT),
        }
    }
}

type Loop = Servo<'static, Felt, Slides, 3>;
type State = ServoState<3, FeltWitness, <Unguarded as Guard<3>>::State>;

/// A body that is felt.
pub struct Stage {
    /// What is felt.
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
    /// What the loop refuses, in a sentence.
    pub fn new(loaded: Loaded, place: Vec3) -> Result<Self, String> {
        let device: &'static _ = Box::leak(Box::new(slides::slides(loaded.body.size())));
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
        self.servo = servo(self.device, self.loaded.felt, &choices)?;
        self.choices = choices;
        Ok(())
    }

    /// Begins anew with the hand at a place, as after power-on.
    pub fn restart(&mut self, place: Vec3) {
        self.state = self.servo.start();
        self.hand = Hand { position: place, velocity: Vec3::ZERO };
        self.target = place;
    }

    /// So many ticks, in which the pointer moves straight to a place. A yielding hand is pushed back by the device; a
    /// rigid one is where the pointer is.
    pub fn run(&mut self, ticks: u32, to: Vec3, yields: bool) {
        let (from, period) = (self.target, 1.0 / self.choices.rate);
        let controller = self.choices.controller();
        self.errors.clear();
        for tick in 0..ticks {
            let at = |tick: u32| from + (to - from) * (tick as f32 / ticks as f32);
            let way = [at(tick), at(tick + 1)];
            if yields {
                let force = slides::force_of(self.device, self.state.duties().map(|duty| duty.fraction()));
                self.hand.advance(&Grip::LIGHT, way, force, period);
            } else {
                self.hand = Hand { position: way[1], velocity: Vec3::ZERO };
            }
            let counts = slides::counts_at(self.device, self.hand.position).map(Counts);
            self.servo.note(&mut self.state, Event::LinkAlive);
            self.servo.tick(&mut self.state, Input::Sensors { counts, enable: true });
            let [_, error] =
                view::next_step(&self.loaded.felt.sight(self.state.witness()), &controller, self.state.probe());
            self.errors.push(error);
        }
        self.target = to;
    }

    /// Only the ticks, for their time.
    pub fn tick_only(&mut self, ticks: u32) {
        let counts = slides::counts_at(self.device, self.hand.position).map(Counts);
        for _ in 0..ticks {
            self.servo.tick(&mut self.state, Input::Sensors { counts, enable: true });
        }
    }

    /// What there is to see.
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
    let servo = Servo::try_new(device, felt, choices.controller(), settings).map_err(|error| error.to_string())?;
    servo.try_rendering(Rendering { friction, ..Rendering::PLAIN }).map_err(|error| error.to_string())
}
