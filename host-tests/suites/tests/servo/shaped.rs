//! A tool with a shape in the closed loop: the simulated WoodenHaptics with a gimbal that a hand turns, on the capped box.
//! The drawn tool's gap is judged by the exact distance of two boxes, in double precision.

use glam::{DQuat, DVec3};
use palpate::body::Body;
use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
use palpate::device::{Counts, Encoder, SerialArm, Wrist, WristState};
use palpate::math::Vec3;
use palpate::pair::{Core, ProxyError, Tool, ToolSurface};
use palpate::render::Friction;
use palpate::servo::{
    Config, ConfigError, Event, Fault, Input, Phase, RenderingError, Safety, Servo, ServoState, Settings, Tracked as _,
    recommended::WOODEN_HAPTICS_2016 as FEEL,
};
use palpate::track::Contact;
use palpate_bake::file::BakedFile;
use palpate_sim::plant::{HandPath, HandSettings, Plant, PlantSettings, Vector};
use palpate_suites::{between_boxes, repository};
use std::f64::consts::{PI, TAU};

const RATE: f64 = 4_000.0;
const TICKS: u32 = 8_000;
const RADIUS_M: f64 = 0.003;
/// The box below the dome, in the model's frame.
const HIGH: DVec3 = DVec3::new(0.06, 0.04, 0.02);

/// Yaw, pitch and roll, 4,096 counts a turn.
const GIMBAL: Wrist = Wrist {
    axes: [Vec3::Z, Vec3::Y, Vec3::X],
    encoders: [Encoder::geared(4_096.0, 1.0, 0.0); 3],
    range_rad: [[-2.5, 2.5], [-1.2, 1.2], [-2.6, 2.6]],
    max_rate_rad_per_s: 30.0,
};

type Loop<'a> = Servo<'a, ToolSurface<'a>, SerialArm, 3>;
type State = ServoState<3, palpate::pair::HeldTool, ()>;

fn capped_box() -> (Body<'static>, DVec3) {
    let bytes = std::fs::read(repository("boards/bodies/capped_box.palp")).expect("it is there");
    let file = BakedFile::read(&bytes).expect("it is a body");
    (file.body.to_body().expect("its tables fit"), file.model.centre)
}

/// The place of the model that lies at the device's origin.
fn settings(centre: DVec3, at_origin: DVec3) -> Settings {
    Settings { rate_hz: RATE as f32, body_origin_m: (centre - at_origin).as_vec3(), ..FEEL.settings }
}

/// A hand that presses along `inward` by `depth` and back, strokes across and turns the handle.
#[derive(Clone, Copy)]
struct Presses {
    start: DVec3,
    inward: DVec3,
    depth: f64,
    rad_per_s: f64,
}

impl Presses {
    fn at(&self, time: f64) -> DVec3 {
        let (along, across) = self.inward.any_orthonormal_pair();
        let share = (PI * time / (f64::from(TICKS) / RATE)).sin().powi(2);
        let stroke = along * (0.005 * (30.0 * time).sin()) + across * (0.004 * (19.0 * time).sin());
        self.start + self.inward * (self.depth * share) + stroke
    }

    /// Of the gimbal's axes, radians.
    fn turned(&self, time: f64) -> [f64; 3] {
        [0.3, 0.25, 0.4].map(|size| size * (self.rad_per_s / 3.0_f64.sqrt() / size * time).sin())
    }
}

impl HandPath for Presses {
    fn target(&self, time: f64) -> Vector {
        self.at(time).to_array()
    }

    fn velocity(&self, time: f64) -> Vector {
        ((self.at(time + 1e-6) - self.at(time - 1e-6)) / 2e-6).to_array()
    }
}

/// What one tick's sensors say.
fn sense(servo: &Loop, state: &mut State, wrist: &mut WristState, counts: [Counts; 3], turned: [f64; 3]) {
    let gimbal = turned.map(|angle| Counts((angle * 4_096.0 / TAU).floor() as i32));
    servo.note(state, Event::LinkAlive);
    servo.note(state, Event::Homed);
    servo.orient(state, &GIMBAL, wrist, counts, gimbal).expect("a hand turns no faster");
}

#[test]
fn a_tool_in_the_loop_stays_outside_and_its_force_does_not_step() {
    let (body, centre) = capped_box();
    for (name, half, reach) in
        [("capsule", DVec3::new(0.0, 0.0, 0.009), 0.009), ("box", DVec3::new(0.009, 0.006, 0.003), 0.011)]
    {
        let core = if half.x > 0.0 {
            Core::Box { half: half.as_vec3().to_array() }
        } else {
            Core::Segment { half: half.z as f32 }
        };
        let tool = Tool::new(core, RADIUS_M as f32).expect("a tool");
        for (scene, at, inward) in [
            ("flat side", DVec3::new(0.06, 0.02, 0.006), DVec3::NEG_X),
            ("over the rim", DVec3::new(0.06, 0.02, 0.0), DVec3::new(-1.0, 0.0, 1.0).normalize()),
            ("on the corner", DVec3::new(0.06, 0.0, 0.0), DVec3::new(-1.0, 1.0, 1.0).normalize()),
        ] {
            for (rad_per_s, friction) in [(1.5, 0.0), (6.0, 0.0), (6.0, 0.4)] {
                let settings = settings(centre, at);
                let surface = ToolSurface::new(&body, tool, &settings).expect("a thick tool");
                let surface = surface.with_friction(friction).expect("a coefficient");
                let config = Config { settings, rendering: FEEL.rendering, safety: Safety::DEFAULT, ..Config::DEFAULT };
                let servo: Loop = Servo::try_new(&DEVICE, &surface, config).expect("within the device's limits");
                let start = -inward * (RADIUS_M + reach + 0.006);
                let path = Presses { start, inward, depth: reach + 0.02, rad_per_s };
                let plant = PlantSettings::wooden_haptics_2016();
                let mut plant = Plant::new(&plant, HandSettings::default(), Box::new(path), RATE).expect("in reach");
                let (mut state, mut wrist) = (servo.start(), WristState::default());
                let (mut gap, mut step, mut most, mut touched) = (f64::INFINITY, 0.0_f32, 0.0_f32, 0);
                let (mut holds_from, mut last) = (None, Vec3::ZERO);
                for tick in 0..TICKS {
                    let counts = plant.counts().map(Counts);
                    sense(&servo, &mut state, &mut wrist, counts, path.turned(f64::from(tick) / RATE));
                    let _ = servo.tick(&mut state, Input::Sensors { counts, enable: tick > 400 });
                    assert_eq!(state.fault(), None, "{name} {scene}, tick {tick}");
                    let held = state.witness();
                    let force = state.force();
                    if !held.proxy().is_holding() {
                        assert_eq!(force, Vec3::ZERO, "{name} {scene}, tick {tick}");
                    } else {
                        holds_from = holds_from.or(Some(tick));
                        let [x, y, z, w] = held.proxy().pose().orientation.map(f64::from);
                        let origin = Vec3::from_array(held.proxy().pose().position).as_dvec3() + centre;
                        let turn = DQuat::from_xyzw(x, y, z, w).normalize();
                        if origin.z + reach < 0.019 {
                            gap = gap.min(between_boxes(DVec3::ZERO, HIGH, half, turn, origin) - RADIUS_M);
                        }
                    }
                    step = step.max((force - last).length());
                    most = most.max(force.length());
                    touched += u32::from(held.contact() == Contact::Touching && state.phase() == Phase::Running);
                    last = force;
                    plant.advance(state.duties().map(|duty| duty.0));
                }
                println!(
                    "{name}, {scene}, {rad_per_s} rad/s, friction {friction}: holds from tick {}, {touched} ticks in contact, gap {:.2} µm, up \
                     to {most:.2} N, {:.1} mN a tick, {} lost",
                    holds_from.map_or(-1, i64::from),
                    gap * 1e6,
                    step * 1e3,
                    state.contacts_lost(),
                );
                assert!(holds_from.is_some_and(|tick| tick < 600), "{name} {scene}: {holds_from:?}");
                assert!(touched > TICKS / 4 && most > 1.0, "{name} {scene}: {touched} ticks, {most} N");
                assert!(gap >= -1e-6, "{name} {scene}: {gap:e}");
                // The slew limit of the rendering, and roundings.
                assert!(step <= 0.050_01, "{name} {scene}: {step} N");
                assert_eq!(state.contacts_lost(), 0, "{name} {scene}");
            }
        }
    }
}

/// A probe that is held at a place, by counts alone: the tool is a finger that presses 3 mm into the side of the box.
struct Pressed<'a> {
    servo: Loop<'a>,
    state: State,
    depth: f64,
}

impl<'a> Pressed<'a> {
    /// At a depth beyond touch, metres.
    fn counts(depth: f64) -> [Counts; 3] {
        let at = [-(depth - RADIUS_M), 0.0, 0.0];
        let path = Box::new(palpate_sim::plant::StillHand(at));
        let plant = PlantSettings::wooden_haptics_2016();
        Plant::new(&plant, HandSettings::default(), path, RATE).expect("in reach").counts().map(Counts)
    }

    /// The loop with the tool in front, from which it goes in by as much, held upright, until the force has risen.
    fn by(surface: &'a ToolSurface<'a>, settings: Settings, depth: f64) -> Self {
        let config = Config { settings, rendering: FEEL.rendering, safety: Safety::DEFAULT, ..Config::DEFAULT };
        let servo: Loop = Servo::try_new(&DEVICE, surface, config).expect("within the device's limits");
        let state = servo.start();
        let mut pressed = Self { servo, state, depth: -0.002 };
        pressed.ticks(1_000, Some(UPRIGHT));
        pressed.moves_to(depth);
        pressed.ticks(1_000, Some(UPRIGHT));
        pressed
    }

    /// At 0.04 m/s.
    fn moves_to(&mut self, depth: f64) -> f32 {
        let (from, ticks) = (self.depth, ((depth - self.depth).abs() / 10e-6) as u32);
        (1..=ticks).fold(0.0, |most: f32, tick| {
            self.depth = from + (depth - from) * f64::from(tick) / f64::from(ticks);
            most.max(self.ticks(1, Some(UPRIGHT)))
        })
    }

    /// The largest change of the force in a tick, N.
    fn ticks(&mut self, ticks: u32, quaternion: Option<[f32; 4]>) -> f32 {
        let mut most = 0.0_f32;
        let counts = Self::counts(self.depth);
        for _ in 0..ticks {
            let before = self.state.force();
            self.servo.note(&mut self.state, Event::LinkAlive);
            self.servo.note(&mut self.state, Event::Homed);
            if let Some(quaternion) = quaternion {
                self.servo.note(&mut self.state, Event::Oriented { quaternion });
            }
            let _ = self.servo.tick(&mut self.state, Input::Sensors { counts, enable: true });
            most = most.max((self.state.force() - before).length());
        }
        most
    }
}

const UPRIGHT: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

fn finger() -> Tool<'static> {
    Tool::new(Core::Segment { half: 0.006 }, RADIUS_M as f32).expect("a tool")
}

#[test]
fn an_orientation_that_is_late_or_leaps_or_is_none_ends_contact_without_a_step() {
    let (body, centre) = capped_box();
    let settings = settings(centre, DVec3::new(0.06, 0.02, 0.008));
    let surface = ToolSurface::new(&body, finger(), &settings).expect("a thick tool");
    let half_turn = |angle: f32| [0.0, 0.0, (0.5 * angle).sin(), (0.5 * angle).cos()];
    for (name, bad) in [
        ("late", None),
        // 40 rad/s are 0.01 rad a tick.
        ("leaps", Some(half_turn(0.05))),
        ("no number", Some([f32::NAN; 4])),
        ("no rotation", Some([0.0, 0.0, 0.0, 0.5])),
    ] {
        let mut pressed = Pressed::by(&surface, settings, 0.003);
        // 3 mm less half a count, at the stiffness of the wall.
        let expected = 0.003 * settings.stiffness_n_per_m;
        assert!((pressed.state.force().x - expected).abs() < 0.03 * expected, "{name}: {}", pressed.state.force());
        assert_eq!(pressed.state.witness().contact(), Contact::Touching);
        // 20 ms are 80 ticks; the force falls within another 5 ms.
        let fades = pressed.ticks(1, bad).max(pressed.ticks(120, bad));
        assert_eq!(pressed.state.force(), Vec3::ZERO, "{name}");
        assert_eq!(pressed.state.contacts_lost(), 1, "{name}");
        assert!(fades <= expected / 20.0 * 1.02, "{name}: {fades}");
        // Inside of the body there is none, however long it is held there.
        pressed.ticks(2_000, Some(UPRIGHT));
        assert_eq!(pressed.state.force(), Vec3::ZERO, "{name}");
        assert_eq!(pressed.state.fault(), None, "{name}");
        // Out and in again.
        pressed.moves_to(-0.002);
        pressed.ticks(400, Some(UPRIGHT));
        assert!(pressed.state.witness().proxy().is_holding(), "{name}: {:?}", pressed.state.witness().given_up());
        pressed.moves_to(0.001);
        pressed.ticks(400, Some(UPRIGHT));
        assert!(pressed.state.force().x > 0.3, "{name}: {}", pressed.state.force());
    }
}

#[test]
fn a_tool_that_starts_in_the_body_gives_no_force_until_it_was_out() {
    let (body, centre) = capped_box();
    let settings = settings(centre, DVec3::new(0.06, 0.02, 0.008));
    let surface = ToolSurface::new(&body, finger(), &settings).expect("a thick tool");
    let config = Config { settings, rendering: FEEL.rendering, safety: Safety::DEFAULT, ..Config::DEFAULT };
    let servo: Loop = Servo::try_new(&DEVICE, &surface, config).expect("within the device's limits");
    let state = servo.start();
    // The core itself is in, and only the ball around it.
    for depth in [0.008, 0.002] {
        let mut pressed = Pressed { servo, state, depth };
        for _ in 0..400 {
            assert_eq!(pressed.ticks(5, Some(UPRIGHT)), 0.0);
            // Nobody who reads the state is left in the dark.
            let why = pressed.state.witness().given_up();
            assert!(why == Some(ProxyError::Intersects) || pressed.state.ticks() < 450, "{depth}: {why:?}");
        }
        assert_eq!(pressed.moves_to(-0.001), 0.0);
        assert_eq!(pressed.ticks(400, Some(UPRIGHT)), 0.0);
        pressed.moves_to(0.001);
        pressed.ticks(400, Some(UPRIGHT));
        assert!(pressed.state.force().x > 0.3, "{depth}: {}", pressed.state.force());
    }
    // And none at all without an orientation.
    let mut pressed = Pressed { servo, state, depth: -0.001 };
    pressed.ticks(400, None);
    assert_eq!(pressed.state.witness().given_up(), Some(ProxyError::Lost));
}

#[test]
fn what_is_of_a_point_is_refused_with_a_shaped_tool() {
    let (body, centre) = capped_box();
    let settings = settings(centre, DVec3::ZERO);
    let surface = ToolSurface::new(&body, finger(), &settings).expect("a thick tool");
    let with = |rendering| {
        let config = Config { settings, rendering, ..Config::DEFAULT };
        let servo: Result<Loop, _> = Servo::try_new(&DEVICE, &surface, config);
        servo.err()
    };
    let plain = palpate::servo::Rendering::PLAIN;
    let friction = Friction {
        static_coefficient: 0.3,
        dynamic_coefficient: 0.2,
        stiffness_n_per_m: 200.0,
        damping_n_s_per_m: 1.0,
    };
    assert_eq!(with(plain), None);
    let refused = Some(ConfigError::Rendering(RenderingError::ShapedTool));
    assert_eq!(with(palpate::servo::Rendering { friction: Some(friction), ..plain }), refused);
    for coefficient in [-0.1, 2.1, f32::NAN] {
        assert_eq!(surface.with_friction(coefficient).err(), Some(ProxyError::Friction));
    }
    // A thin tool, and settings of another rate.
    let thin = Tool::new(Core::Segment { half: 0.02 }, 0.000_1).expect("a tool");
    assert_eq!(ToolSurface::new(&body, thin, &settings).err(), Some(ProxyError::Thin));
    let slower = ToolSurface::new(&body, finger(), &Settings { rate_hz: 1_000.0, ..settings }).expect("a thick tool");
    let servo: Loop = Servo::try_new(&DEVICE, &slower, Config { settings, ..Config::DEFAULT }).expect("a loop");
    assert_eq!(servo.start().fault(), Some((Fault::OtherRate, 0)));
}
