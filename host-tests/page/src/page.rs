//! The stage: a body, the loop on the held device, and the hand.

use crate::felt::Loaded;
use crate::felt::{Felt, FeltWitness, Kept, Yielding};
use crate::held::{Grip, Hand, Held, HeldMechanism};
use crate::view;
use crate::view::Sighted as _;
use alloc::boxed::Box;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;
use palpate::body::Located;
use palpate::device::VelocityMethod;
use palpate::field::Displacement as _;
use palpate::math::{Vec3, inverse_sqrt};
use palpate::pair::{HeldTool, Tool, ToolSurface};
use palpate::render::Friction;
use palpate::scene::BodyPose;
use palpate::servo::recommended::Recommended;
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
    /// One of [`RENDERINGS`].
    pub rendering: u32,
}

/// The renderings, in the order of their numbers.
pub const RENDERINGS: [Rendering; 3] = [Rendering::PLAIN, Rendering::EASED, Rendering::SMOOTH];

impl Choices {
    /// 4 kHz and a firm wall.
    pub const DEFAULT: Self =
        Self { rate: 4_000.0, stiffness: 1_000.0, damping: 2.0, friction: 0.0, law: 0, rendering: 0 };

    /// The controller of the law.
    pub const fn controller(&self) -> Controller {
        match self.law {
            0 => Controller::SecondOrder,
            1 => Controller::FirstOrder(FirstOrder::CERTIFIED),
            _ => Controller::FirstOrder(FirstOrder::COVARIANT),
        }
    }
}

type Loop = Servo<'static, Felt, HeldMechanism, 3>;
type State = ServoState<3, FeltWitness, <Unguarded as Guard<3>>::State>;

/// A quaternion `(x, y, z, w)`.
type Orientation = [f32; 4];
const UPRIGHT: Orientation = [0.0, 0.0, 0.0, 1.0];
/// How fast a hand turns a tool, rad/s.
const TURN: f32 = 6.0;

/// A body as a surface.
pub struct Stage {
    /// The surface.
    pub loaded: Loaded,
    held: Held,
    /// Its shape, of another than a point.
    tool: Option<Tool<'static>>,
    /// That of the tool in the hand, and where the hand turns it to.
    orientation: Orientation,
    turned_to: Orientation,
    felt: &'static Felt,
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
        Self::holding(Held::slides(loaded.body.size()), loaded, Choices::DEFAULT, None, place)
    }

    fn holding(
        mut held: Held,
        loaded: Loaded,
        choices: Choices,
        tool: Option<Tool<'static>>,
        place: Vec3,
    ) -> Result<Self, String> {
        let felt = felt(&held, &loaded, &choices, tool)?;
        let servo = servo(&held, felt, &choices)?;
        let hand = Hand { position: held.restart(place), velocity: Vec3::ZERO };
        let (state, errors) = (servo.start(), Vec::new());
        let (orientation, turned_to) = (UPRIGHT, UPRIGHT);
        Ok(Self {
            loaded,
            held,
            tool,
            orientation,
            turned_to,
            felt,
            choices,
            servo,
            state,
            hand,
            target: place,
            errors,
        })
    }

    /// Takes a tool with a shape in the hand, upright, or without one the point.
    ///
    /// # Errors
    /// Why the body is not felt with it, in a sentence; then all stays as it was.
    pub fn take_tool(&mut self, tool: Option<Tool<'static>>) -> Result<(), String> {
        *self = Self::holding(self.held.clone(), self.loaded, self.choices, tool, self.target)?;
        Ok(())
    }

    /// Where the hand turns the tool to, as fast as it does.
    pub fn turn_tool(&mut self, to: Orientation) {
        self.turned_to = to;
    }

    /// The tool as it is drawn, held outside of the body: its origin and orientation; the orientation in the hand; and of
    /// each contact where it is on the tool, the force on the tool, N, and the gap. Nothing for a point.
    pub fn tool(&self, out: &mut Vec<f32>) {
        let (Some(tool), Kept::Tool(held)) = (&self.tool, &self.state.witness().kept) else { return };
        let pose = if held.is_located() { *held.proxy().pose() } else { self.hand_pose(held) };
        out.extend(pose.position);
        out.extend(pose.orientation);
        out.extend(self.orientation);
        for contact in held.proxy().contacts() {
            let at = Vec3::from_array(pose.position) + contact.arm - contact.normal * tool.radius();
            out.extend(at.to_array());
            out.extend(contact.force.to_array());
            out.push(contact.gap);
        }
    }

    fn hand_pose(&self, held: &HeldTool) -> BodyPose {
        BodyPose { position: self.state.probe().to_array(), orientation: held.orientation() }
    }

    /// Takes the device of a file, whose text and name these are, or the slides without a text; the settings are those
    /// recommended for it.
    ///
    /// # Errors
    /// The file's first fault, in a sentence; then all stays as it was.
    pub fn hold(&mut self, text: &str, label: &str) -> Result<(), String> {
        let held = if text.is_empty() { Held::slides(self.loaded.body.size()) } else { Held::of_file(text, label)? };
        let mut choices = Choices::DEFAULT;
        if let Some(Recommended { settings, rendering }) = &held.recommended {
            (choices.rate, choices.stiffness) = (settings.rate_hz, settings.stiffness_n_per_m);
            choices.damping = settings.damping_n_s_per_m;
            choices.rendering = match (rendering.velocity, rendering.ease) {
                (VelocityMethod::BetweenCounts, _) => 2,
                (_, Some(_)) => 1,
                (_, None) => 0,
            };
        }
        *self = Self::holding(held, self.loaded.at_rate(choices.rate)?, choices, self.tool, self.target)?;
        Ok(())
    }

    /// The name of the held device; of its choices stiffness, damping and rendering; and then its own numbers, see
    /// [`Held::describe`].
    pub fn describe(&self, out: &mut Vec<f32>) -> &str {
        let Choices { stiffness, damping, rendering, .. } = self.choices;
        out.extend([stiffness, damping, rendering as f32]);
        self.held.describe(out);
        &self.held.name
    }

    /// Goes on with other choices.
    ///
    /// # Errors
    /// The setting that is refused; then all stays as it was.
    pub fn choose(&mut self, choices: Choices) -> Result<(), String> {
        let loaded = self.loaded.at_rate(choices.rate)?;
        let felt = felt(&self.held, &loaded, &choices, self.tool)?;
        self.servo = servo(&self.held, felt, &choices)?;
        (self.loaded, self.felt, self.choices) = (loaded, felt, choices);
        Ok(())
    }

    /// The body with modes, from their numbers, where it is loaded.
    ///
    /// # Errors
    /// The error in the modes, in a sentence.
    pub fn soften(&mut self, numbers: &[f32]) -> Result<(), String> {
        let loaded = self.loaded.softened(numbers, self.choices.rate)?;
        *self = Self::holding(self.held.clone(), loaded, self.choices, None, self.target)?;
        Ok(())
    }

    /// The body that gives way, if it does.
    pub fn soft(&self) -> Option<&'static Yielding> {
        match self.loaded.felt {
            Felt::Soft(soft) => Some(soft),
            Felt::Body(_) | Felt::Tool(_) | Felt::Patch(_) => None,
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
        self.hand = Hand { position: self.held.restart(place), velocity: Vec3::ZERO };
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
                self.hand.advance(&Grip::LIGHT, way, self.state.force(), period);
            } else {
                self.hand = Hand { position: way[1], velocity: Vec3::ZERO };
            }
            self.hand.stop_at(self.held.reach(self.hand.position, self.held.most_in(period)));
            let counts = self.held.counts();
            self.servo.note(&mut self.state, Event::LinkAlive);
            if self.tool.is_some() {
                self.orientation = turned(self.orientation, self.turned_to, TURN * period);
                self.servo.note(&mut self.state, Event::Oriented { quaternion: self.orientation });
            }
            let _ = self.servo.tick(&mut self.state, Input::Sensors { counts, enable: true });
            let [_, error] = view::next_step(&self.felt.sight(self.state.witness()), &controller, self.state.probe());
            self.errors.push(error);
        }
        self.target = to;
    }

    /// Only the ticks, for their time.
    pub fn tick_only(&mut self, ticks: u32) {
        let counts = self.held.counts();
        for _ in 0..ticks {
            let _ = self.servo.tick(&mut self.state, Input::Sensors { counts, enable: true });
        }
    }

    /// The visible state.
    pub fn view(&self, out: &mut Vec<f32>) {
        view::write(&self.state, self.felt, &self.choices.controller(), self.target, out);
    }

    /// The workspace margin, 0 to 1.
    pub fn workspace_margin(&self) -> f32 {
        self.state.workspace_margin()
    }

    /// A hash of every bit of the loop's state.
    pub fn digest(&self) -> u32 {
        self.state.digest()
    }
}

/// An orientation turned towards another, by an angle at most, radians.
fn turned(from: Orientation, to: Orientation, most: f32) -> Orientation {
    let dot = |a: &Orientation, b: &Orientation| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
    // A quaternion and its negative are one rotation.
    let side = if dot(&from, &to) < 0.0 { -1.0 } else { 1.0 };
    let way: Orientation = core::array::from_fn(|k| side * to[k] - from[k]);
    // Its chord, of half the angle.
    let squared = dot(&way, &way);
    let share = if squared > 0.25 * most * most { 0.5 * most * inverse_sqrt(squared) } else { 1.0 };
    let next: Orientation = core::array::from_fn(|k| from[k] + share * way[k]);
    let scale = inverse_sqrt(dot(&next, &next));
    next.map(|component| component * scale)
}

/// The surface in the loop: the loaded one, or its body under a tool.
fn felt(held: &Held, loaded: &Loaded, choices: &Choices, tool: Option<Tool<'static>>) -> Result<&'static Felt, String> {
    let Some(tool) = tool else { return Ok(loaded.felt) };
    if !matches!(loaded.felt, Felt::Body(_)) {
        return Err("a tool with a shape takes a rigid body of several faces: choose the tip".to_string());
    }
    let surface = ToolSurface::new(loaded.body, tool, &settings(held, choices)).map_err(|error| error.to_string())?;
    let surface = surface.with_friction(choices.friction).map_err(|error| error.to_string())?;
    Ok(Box::leak(Box::new(Felt::Tool(surface))))
}

fn settings(held: &Held, choices: &Choices) -> Settings {
    Settings {
        rate_hz: choices.rate,
        stiffness_n_per_m: choices.stiffness,
        damping_n_s_per_m: choices.damping,
        max_force_n: held.device.max_force_n,
        velocity_corner_hz: held.recommended.map_or(150.0, |recommended| recommended.settings.velocity_corner_hz),
        soft_start_s: 0.1,
        body_origin_m: Vec3::ZERO,
    }
}

fn servo(held: &Held, felt: &'static Felt, choices: &Choices) -> Result<Loop, String> {
    let friction = Friction {
        stiffness_n_per_m: choices.stiffness,
        damping_n_s_per_m: 1.0,
        static_coefficient: choices.friction,
        dynamic_coefficient: 0.75 * choices.friction,
    };
    // That of a tool is its contacts'.
    let friction = (choices.friction > 0.0 && !matches!(felt, Felt::Tool(_))).then_some(friction);
    let rendering = RENDERINGS.get(choices.rendering as usize).copied().unwrap_or(Rendering::PLAIN);
    let rendering = Rendering { friction, ..rendering };
    let settings = settings(held, choices);
    let config = Config { controller: choices.controller(), settings, rendering, ..Config::DEFAULT };
    Servo::try_new(held.device, felt, config).map_err(|error| error.to_string())
}
