//! Edges of every kind on a body of flat faces, and the force that an edge gives back late.

use palpate::body::Body;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::math::{Vec3, vec3};
use palpate::render::Ease;
use palpate::servo::recommended::{self, Recommended};
use palpate::servo::{Config, Rendering, Servo, Settings, Surface};
use palpate_bake::{BakedBody, Model};
use palpate_sim::feel::{Deed, Recording, Script, Stage, Threshold, Tick, over_edges, record};
use palpate_sim::plant::{HandSettings, PlantSettings, Vector};
use std::path::Path;

/// The middle of the block.
const AT: Vec3 = vec3(-0.03, -0.02, -0.016);
const TOUCH: Recommended = recommended::WOODEN_HAPTICS_2016;
const STAGE: Stage = Stage { joints: 3, stiffness: 500.0, hand: 300.0, dry: 0.076, max_force: 5.0 };
/// 200 N/s at 4 kHz, N; and above it what a subtraction of forces of up to 5 N rounds.
const STEP: f64 = 0.05 + 1e-6;

fn step_block() -> BakedBody {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../suites/data/step_block.toml");
    let baked = BakedBody::new(&Model::read(&file).unwrap(), "step_block").unwrap();
    let options = baked.locator_options();
    baked.located(&options, &|_, _| ()).unwrap().0
}

fn felt<S: Surface>(surface: &S, origin: Vec3, ease: Ease, script: &Script) -> Recording {
    let settings = Settings { body_origin_m: origin, ..TOUCH.settings };
    let servo = Servo::try_new(&WOODEN_HAPTICS_2016, surface, Config { settings, ..Config::DEFAULT }).unwrap();
    let servo = Servo::try_new(
        servo.device(),
        servo.surface(),
        Config { rendering: Rendering { ease: Some(ease), ..TOUCH.rendering }, ..servo.config() },
    )
    .unwrap();
    record(&servo, &PlantSettings::wooden_haptics_2016(), HandSettings::default(), script).unwrap()
}

fn length(vector: Vector) -> f64 {
    vector.iter().map(|coordinate| coordinate * coordinate).sum::<f64>().sqrt()
}

#[test]
fn no_edge_of_a_stepped_block_makes_a_step_and_its_seams_are_not_felt() {
    let baked = step_block();
    let body: &Body<'_> = &baked.to_body().unwrap();
    let threshold = Threshold::approximate();
    let scripts = over_edges(body, AT, &STAGE);
    let has = |name: &str| scripts.iter().any(|script| script.name.starts_with(name));
    for kind in ["off an edge", "round a convex edge", "into a concave edge", "over a smooth seam", "off a corner"] {
        assert!(has(kind), "{kind}");
    }
    for script in &scripts {
        let recording = felt(body, AT, Ease::SMOOTH, script);
        let figures = recording.figures(script.looked_at, &threshold);
        println!("{:<22} {:.1} mN, {:.1} dB", script.name, figures.steps.any * 1e3, figures.sensation.level);
        assert!(figures.steps.any <= STEP, "{}: {:?}", script.name, figures.steps);
        assert!(script.deed != Deed::Across(None) || figures.sensation.is_below(), "{:?}", figures.sensation);
        late(script, &recording);
    }
}

/// What an edge lets go of late. The force on a probe that touches nothing falls by `R` a second from the `F` that
/// there was: it gives at most `v F²/(2R)`. The spring that the edge threw away held `F²/(2K)`, so that up to `v = R/K`
/// no more comes back than was put in.
fn late(script: &Script, recording: &Recording) {
    let change = f64::from(Ease::SMOOTH.change_n_per_s);
    let (mut held, mut given, mut fastest) = (0.0, 0.0, 0.0_f64);
    for pair in recording.ticks.windows(2) {
        let [now, next]: [Tick; 2] = [pair[0], pair[1]];
        if now.is_touching || length(now.force) == 0.0 {
            (held, given, fastest) = (length(now.force), 0.0, 0.0);
            continue;
        }
        let moved: Vector = core::array::from_fn(|axis| next.probe[axis] - now.probe[axis]);
        fastest = fastest.max(length(moved) * recording.rate);
        given += (0..3).map(|axis| now.force[axis] * moved[axis]).sum::<f64>();
        // Rounding of forces.
        assert!(given <= fastest * held * held / (2.0 * change) + 1e-9, "{}: {given} of {held} N", script.name);
        let stored = held * held / (2.0 * STAGE.stiffness);
        assert!(fastest > change / STAGE.stiffness || given <= stored + 1e-9, "{}: {given} {stored}", script.name);
    }
}
