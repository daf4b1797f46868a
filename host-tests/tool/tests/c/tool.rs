//! A tool with a shape in C beside the same tool in Rust, tick by tick: lowered on the capped box and turned there, by each
//! way to tell its orientation. And against plane geometry in double precision: a wall's force on a plane face.

use crate::example::cannot_panic;
use crate::running::{capped_box, file, is_wanted, library, run, with_capped_box};
use palpate::body::Body;
use palpate::device::presets::{WOODEN_HAPTICS_2016 as ARM, WOODEN_HAPTICS_2016_PROTECTION};
use palpate::device::{
    Counts, Encoder, Kinematics as _, Mount as _, Protection, SerialArm, Wrist, WristError, WristState,
};
use palpate::math::{Vec3, vec3};
use palpate::pair::{Core, ProxyError, Tool, ToolSurface};
use palpate::servo::recommended::{Recommended, WOODEN_HAPTICS_2016 as FEEL};
use palpate::servo::{Config, Event, Guard, Input, Servo, Settings};
use palpate_sim::devices::{DEVICES, c_preset};
use palpate_tool::in_c;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// As in `tests/tool.c`.
const GIMBAL: Wrist = Wrist {
    axes: [Vec3::Z, Vec3::Y, Vec3::X],
    encoders: [
        Encoder::new(std::f32::consts::TAU / 4_096.0, 0.01),
        Encoder::new(std::f32::consts::TAU / 4_096.0, -0.02),
        Encoder::new(std::f32::consts::TAU / 4_096.0, 0.03),
    ],
    range_rad: [[-2.5, 2.5], [-1.2, 1.2], [-2.6, 2.6]],
    max_rate_rad_per_s: 40.0,
};

/// How the orientation is told before a tick.
#[derive(Clone, Copy)]
enum Told {
    Nothing,
    Quaternion([f32; 4]),
    Wrist(Option<[i32; 3]>),
    Rigid,
}

/// The counts of a tick, and the orientation before it.
type Tick = ([i32; 3], Told);

/// A tool as the header has it, and where the body lies.
#[derive(Clone, Copy)]
struct Held {
    half: [f32; 3],
    radius: f32,
    friction: f32,
    origin: Vec3,
}

/// What a run comes to: the lines of C, and after each tick the force, the probe in the body's frame, and why contact was
/// given up.
struct Run {
    lines: String,
    ticks: Vec<(Vec3, Vec3, Option<ProxyError>)>,
}

impl Held {
    fn settings(&self) -> Settings {
        Settings { body_origin_m: self.origin, ..FEEL.settings }
    }

    fn in_rust(&self, body: &Body<'_>, script: &[Tick], is_protected: bool) -> Run {
        let core = match self.half {
            [0.0, 0.0, 0.0] => Core::Point,
            [0.0, 0.0, half] => Core::Segment { half },
            half => Core::Box { half },
        };
        let tool = Tool::new(core, self.radius).expect("a tool");
        let surface = ToolSurface::new(body, tool, &self.settings()).expect("thick enough");
        let surface =
            if self.friction > 0.0 { surface.with_friction(self.friction).expect("friction") } else { surface };
        let Recommended { rendering, .. } = FEEL;
        let config = Config { settings: self.settings(), rendering, ..Config::DEFAULT };
        if is_protected {
            let protection = Protection { polarity: None, ..WOODEN_HAPTICS_2016_PROTECTION };
            looped(&Servo::try_protected(&ARM, &surface, protection, config).expect("a loop"), script)
        } else {
            looped(&Servo::try_new(&ARM, &surface, config).expect("a loop"), script)
        }
    }

    /// The same in C must print the same; its last line is the force.
    fn compare(&self, program: &Path, folder: &Path, script: &[Tick], is_protected: bool) -> Run {
        let rust = with_capped_box(|body| self.in_rust(body, script, is_protected));
        let mut stream = [&self.half[..], &[self.radius, self.friction], &self.origin.to_array()].concat();
        for (tick, (counts, told)) in script.iter().enumerate() {
            let words = |three: [i32; 3]| three.map(|word| f32::from_bits(word as u32));
            let (way, quaternion, wrist) = match *told {
                Told::Nothing => (0, [0.0; 4], [0; 3]),
                Told::Quaternion(quaternion) => (1, quaternion, [0; 3]),
                Told::Wrist(Some(counts)) => (2, [0.0; 4], counts),
                Told::Wrist(None) => (3, [0.0; 4], [0; 3]),
                Told::Rigid => (4, [0.0; 4], [0; 3]),
            };
            stream.extend(words(*counts));
            stream.extend([u32::from(is_enabled(tick)), way].map(f32::from_bits));
            stream.extend(quaternion);
            stream.extend(words(wrist));
        }
        fs::write(folder.join("stream"), bytemuck::cast_slice::<f32, u8>(&stream)).expect("a stream");
        let mut in_c = Command::new(program);
        in_c.arg(capped_box()).arg(folder.join("stream")).arg(if is_protected { "protected" } else { "plain" });
        let in_c = run(&mut in_c);
        for (index, (said, expected)) in in_c.lines().zip(rust.lines.lines()).enumerate() {
            assert!(same_numbers(said, expected), "line {index}:\nC    {said}\nRust {expected}");
        }
        assert_eq!(in_c.lines().count(), rust.lines.lines().count());
        rust
    }
}

/// Whether two lines are the same, but for how a number is written.
fn same_numbers(said: &str, expected: &str) -> bool {
    let words = |line: &str| -> Vec<String> {
        line.split(' ').map(|word| word.parse::<f32>().map_or(word.to_owned(), |x| x.to_bits().to_string())).collect()
    };
    // A hash is no number, though it may look like one.
    said.split(' ').next() == expected.split(' ').next() && words(said)[1..] == words(expected)[1..]
}

const fn is_enabled(tick: usize) -> bool {
    tick >= 200
}

fn looped<G: Guard<3>>(servo: &Servo<'_, ToolSurface<'_>, SerialArm, 3, G>, script: &[Tick]) -> Run {
    let (mut state, mut wrist) = (servo.start(), WristState::default());
    let mut run = Run { lines: String::new(), ticks: Vec::new() };
    for (tick, (counts, told)) in script.iter().enumerate() {
        let counts = counts.map(Counts);
        let mut said = "done";
        match *told {
            Told::Nothing => {}
            Told::Quaternion(quaternion) => servo.note(&mut state, Event::Oriented { quaternion }),
            Told::Wrist(None) => wrist = WristState::default(),
            Told::Wrist(Some(turned)) => {
                match servo.orient(&mut state, &GIMBAL, &mut wrist, counts, turned.map(Counts)) {
                    Ok(()) => {}
                    Err(WristError::Jump(_)) => said = "an axis of the wrist has jumped: check its encoder and wiring",
                    Err(_) => said = "an axis of the wrist is out of its range: check its encoder and zero",
                }
            }
            Told::Rigid => {
                let zeros = state.angles_at_zero();
                let angle = |joint: usize| {
                    Encoder { angle_at_zero_rad: zeros[joint], ..ARM.encoders[joint] }.angle(counts[joint])
                };
                let link = ARM.kinematics.last_link(core::array::from_fn(angle)).expect("within reach");
                servo.note(&mut state, Event::Oriented { quaternion: link });
            }
        }
        let _ = servo.tick(&mut state, Input::Sensors { counts, enable: is_enabled(tick) });
        let held = state.witness();
        let given_up = held.given_up();
        let reason = match given_up {
            None => 0,
            Some(ProxyError::Intersects) => 1,
            Some(_) => 2,
        };
        let [x, y, z, w] = held.orientation();
        let located = u32::from(held.is_located());
        let _ = writeln!(run.lines, "{:08x} {located} {reason} {x} {y} {z} {w} {said}", state.digest());
        run.ticks.push((state.force(), state.probe(), given_up));
    }
    assert_eq!(state.fault(), None);
    let Vec3 { x, y, z } = state.force();
    let _ = writeln!(run.lines, "force {x} {y} {z} none");
    run
}

fn program(folder: &Path) -> PathBuf {
    let device = DEVICES.iter().find(|device| device.name == "woodenhaptics-2016").expect("the device");
    fs::write(folder.join("device.h"), c_preset(device)).expect("a header");
    let made = folder.join("tool");
    let mut gcc = in_c::compiler(in_c::Core::Host, "gcc").expect("in the repository");
    gcc.arg("-std=c11").arg("-I").arg(folder).arg(file("tests/tool.c")).arg(library(in_c::Core::Host));
    run(gcc.args(["-lm", "-o"]).arg(&made));
    made
}

/// Yaw, pitch, roll, radians: the rotation as every textbook has it, and its quaternion, in double precision.
fn turned(yaw: f64, pitch: f64, roll: f64) -> ([[f64; 3]; 3], [f32; 4]) {
    let [(sy, cy), (sp, cp), (sr, cr)] = [yaw, pitch, roll].map(f64::sin_cos);
    let rotation = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ];
    let [(sy, cy), (sp, cp), (sr, cr)] = [yaw, pitch, roll].map(|angle| (0.5 * angle).sin_cos());
    let quaternion = [
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    ];
    (rotation, quaternion.map(|number| number as f32))
}

#[test]
fn a_finger_that_is_lowered_and_turned_has_the_bits_of_rust() {
    if !is_wanted("a tool with a shape in C") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let program = program(folder.path());
    let finger = Held { half: [0.0, 0.0, 0.009], radius: 0.003, friction: 0.0, origin: vec3(0.0, -0.02, 0.152) };
    // Lowered for 2,000 ticks, held there, and turned meanwhile.
    let lowered = |tick: i32| [0, 0, (tick / 10).min(200)];
    let swing = |tick: i32, size: f64| size * (1e-3 * f64::from(tick)).sin();
    let by_sensor = |tick: i32| {
        let quaternion = turned(swing(tick, 0.4), swing(tick, -0.3), swing(tick, 0.25)).1;
        // Every 10 ms; after 3,500 ticks never again.
        let told = if tick % 40 == 0 && tick <= 3_480 { Told::Quaternion(quaternion) } else { Told::Nothing };
        (lowered(tick), told)
    };
    let by_wrist = |tick: i32| {
        let mut counts = [260.0, -200.0, 150.0].map(|size| swing(tick, size) as i32);
        // A glitch, a range, and a cable that is out for a while: the next counts are believed.
        counts[0] += if tick == 1_000 { 90 } else { 0 };
        counts[1] += if tick == 1_200 { 3_000 } else { 0 };
        counts[2] += if tick > 2_400 { 40 } else { 0 };
        (lowered(tick), Told::Wrist((!(2_395..=2_402).contains(&tick)).then_some(counts)))
    };
    let rigid = |tick: i32| (lowered(tick), Told::Rigid);
    let scripts: [(&str, Vec<Tick>); 3] = [
        ("sensor", (0..4_000).map(by_sensor).collect()),
        ("wrist", (0..4_000).map(by_wrist).collect()),
        ("rigid", (0..4_000).map(rigid).collect()),
    ];
    for (name, script) in &scripts {
        for (friction, is_protected) in [(0.0, false), (0.4, true)] {
            let rust = Held { friction, ..finger }.compare(&program, folder.path(), script, is_protected);
            let most = |ticks: &[(Vec3, Vec3, _)]| ticks.iter().fold(0.0, |most: f32, tick| most.max(tick.0.length()));
            let (pressed, last) = (most(&rust.ticks[..3_500]), most(&rust.ticks[3_900..]));
            println!("{name}, friction {friction}: {pressed} N, {last} N at the end, in C and in Rust");
            assert!(pressed > 1.0, "{name}: {pressed} N");
            // 80 ticks are 20 ms, and the force fades.
            let is_old = *name == "sensor";
            assert_eq!(is_old, last == 0.0, "{name}: {last} N");
            let refused = ["jumped", "out of its range"].map(|word| rust.lines.matches(word).count());
            assert_eq!(refused, if *name == "wrist" { [1, 1] } else { [0, 0] });
            assert_eq!(is_old, rust.ticks[3_999].2 == Some(ProxyError::Lost), "{name}");
        }
    }
}

/// The body's bottom is a plane, `z = 0`: how far a tool reaches beyond it, times the stiffness, is the force.
#[test]
fn a_tool_on_a_plane_face_is_pushed_by_stiffness_times_depth() {
    if !is_wanted("a tool on a plane face in C") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let program = program(folder.path());
    let zero = core::array::from_fn(|joint| ARM.encoders[joint].angle(Counts(0)));
    let start = ARM.kinematics.pose(zero).expect("within reach").position;
    let (rotation, quaternion) = turned(0.9, 0.5, 0.35);
    for half in [[0.0; 3], [0.0, 0.0, 0.009], [0.009, 0.004, 0.006]] {
        let radius = 0.003_f32;
        let core: f64 = half.iter().zip(rotation[2]).map(|(half, up)| f64::from(*half) * up.abs()).sum();
        let reach = core + f64::from(radius);
        let origin = start + vec3(-0.03, -0.02, reach as f32 + 0.011);
        let script: Vec<Tick> =
            (0..4_000).map(|tick: i32| ([0, 0, -(tick / 10).min(200)], Told::Quaternion(quaternion))).collect();
        let held = Held { half, radius, friction: 0.0, origin };
        let rust = held.compare(&program, folder.path(), &script, false);
        let (force, probe, _) = rust.ticks[3_999];
        let depth = f64::from(probe.z) + reach;
        let expected = -f64::from(FEEL.settings.stiffness_n_per_m) * depth;
        println!("{half:?}: {} mm deep, {} N, {expected} N by geometry", 1e3 * depth, force.z);
        assert!(depth > 1e-3, "{depth}");
        // The stiffness times some micrometres of rounding in coordinates of decimetres.
        assert!((f64::from(force.z) - expected).abs() < 1e-3, "{half:?}: {} N, {expected} N", force.z);
        assert!(force.x.hypot(force.y) < 1e-3, "{half:?}: {force}");
    }
}

/// As much as links a tool's loop.
const LINKED: &str = "#include <palpate.h>
int main(void)
{
    static palpate_tool_servo room;
    static const palpate_linkage_arm arm;
    static const palpate_device device;
    static const palpate_body body;
    static const palpate_tool tool;
    static const palpate_settings settings;
    static const palpate_protection protection;
    static const palpate_wrist wrist;
    palpate_servo *servo = &room.servo;
    palpate_held held = {0};
    palpate_output output = {0};
    palpate_servo_start_linkage_arm_tool_protected(servo, sizeof room, &arm, &device, &body, &tool, &settings,
                                                   &protection, 0);
    palpate_servo_orient_wrist(servo, &wrist, output.duties, output.duties);
    palpate_servo_orient(servo, held.orientation);
    palpate_servo_tick(servo, output.duties, 3, 1, &output);
    return palpate_servo_held(servo, &held);
}
";

#[test]
fn the_image_of_a_tool_cannot_panic() {
    if !is_wanted("the image of a tool in C") {
        return;
    }
    cannot_panic(LINKED, "ToolSurface");
}
