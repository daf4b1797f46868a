//! A three-dimensional device touches a patch: the loop as a firmware runs it, with your sensors and motors where `Arm`
//! is. `cargo run --example surface`

use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
use palpate::device::{Counts, Duty, SerialArm};
use palpate::math::vec3;
use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};
use palpate::render::Friction;
use palpate::servo::{Config, Event, Input, Output, Phase, Rendering, SafeOutput, Safety, Servo, Settings, State};

/// A shallow bowl, 10 cm square: z = 2 (x² + y²) in metres. `cargo palpate bake` writes such tables from your model.
static BOWL: [[f32; 3]; 9] = [
    [0.0, 0.0, 0.0],
    [0.0, 0.1, 0.0],
    [0.0, 0.0, 0.02],
    [0.1, 0.0, 0.0],
    [0.0; 3],
    [0.0; 3],
    [0.0, 0.0, 0.02],
    [0.0; 3],
    [0.0; 3],
];
static PATCH: SplinePatch = SplineTable {
    degree: [2, 2],
    breaks_u: &[0.0, 1.0],
    breaks_v: &[0.0, 1.0],
    coefficients: Coefficients::Polynomial(&BOWL),
    shape: ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.04, uv: 0.0, vv: 0.04 }),
    orientation: Orientation::Outward,
    size_m: 0.1,
    crc: None,
}
.checked();

/// The loop's type, named once.
type App = Servo<'static, SplinePatch<'static>, SerialArm, 3>;

/// Checked at compile time; in flash.
static SERVO: App = Servo::new(
    &DEVICE,
    &PATCH,
    Config {
        settings: Settings {
            rate_hz: 4_000.0,
            stiffness_n_per_m: 800.0,
            damping_n_s_per_m: 2.0,
            max_force_n: 4.0,
            velocity_corner_hz: 200.0,
            soft_start_s: 0.2,
            body_origin_m: vec3(0.0, 0.0, 0.0),
        },
        rendering: Rendering { friction: Some(FRICTION), ..Rendering::PLAIN },
        safety: Safety { output: SafeOutput::Damping(2.0), ..Safety::DEFAULT },
        ..Config::DEFAULT
    },
);
const FRICTION: Friction =
    Friction { stiffness_n_per_m: 500.0, damping_n_s_per_m: 1.0, static_coefficient: 0.4, dynamic_coefficient: 0.3 };

fn main() {
    let mut state: State<App> = SERVO.start();
    let mut arm = Arm { counts: [0.0, -1_314.0, 3_300.0] };
    for tick in 0..6_000 {
        // On a board: read the encoders, or report that they did not answer.
        let counts = arm.counts.map(|count| Counts(count as i32));
        let input = if tick < 5_000 { Input::Sensors { counts, enable: true } } else { Input::Lost };
        // On a board: disable every stage, or write the duties to the PWM and enable them.
        match SERVO.tick(&mut state, input) {
            Output::Off => arm.release(),
            Output::Drive(duties) => arm.drive(duties),
        }
        if tick == 4_999 {
            SERVO.note(&mut state, Event::LinkAlive);
        }
        if tick % 500 == 499 {
            let force = state.force();
            println!(
                "{:.3} s {:?}: gap {:6.3} mm, force {force:.3} N",
                f64::from(tick + 1) / 4e3,
                state.phase(),
                state.gap() * 1e3
            );
        }
    }
    if let (Phase::Fault, Some((fault, tick))) = (state.phase(), state.fault()) {
        println!("stopped: fault {}, {fault}, at tick {tick}; {:?}", fault.code(), state.output());
    }
}

/// The simulated stand-in for your hardware: a hand that lowers the probe and slides it, come what may.
struct Arm {
    counts: [f32; 3],
}

impl Arm {
    fn drive(&mut self, _duties: [Duty; 3]) {
        self.counts[0] += 0.02;
        self.counts[2] += if self.counts[2] < 3_520.0 { 0.1 } else { 0.0 };
    }

    fn release(&mut self) {
        self.drive([Duty::ZERO; 3]);
    }
}
