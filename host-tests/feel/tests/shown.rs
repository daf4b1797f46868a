//! What the smooth rendering is for, on the four devices that feel a surface in space: no step, no buzz, an edge that
//! is an edge. Simulated, at 4 kHz and the stiffness that is recommended there.

use palpate::body::Body;
use palpate::device::presets::{NOVINT_FALCON, PHANTOM_PREMIUM, POLHEM_V2, WOODEN_HAPTICS_2016};
use palpate::device::{Device, Encoder, Kinematics};
use palpate::math::{Vec3, vec3};
use palpate::servo::{Rendering, Servo, Settings};
use palpate::track::Controller;
use palpate_feel::{Deed, Figures, Recording, Script, Stage, Threshold, Tick, over_edges, record, wall};
use palpate_plant::{HandSettings, PlantSettings, Vector};

mod capped_box {
    include!("../../../boards/bodies/capped_box.rs");
}

/// Its middle, below which the dome begins.
const CAPPED_BOX_AT: Vec3 = vec3(-0.03, -0.02, -0.016);

const SETTINGS: Settings = Settings {
    rate: 4_000.0,
    stiffness: 500.0,
    damping: 2.0,
    max_force: 5.0,
    velocity_corner: 80.0,
    soft_start: 0.1,
    body_origin: Vec3::ZERO,
};

/// What no step may exceed, N: 200 N/s at 4 kHz. Above it lies what a subtraction of forces of up to 5 N
/// rounds.
const STEP: f64 = 0.05 + 1e-6;
/// Up to this speed, m/s.
const BOUND_SPEED: f64 = 0.3;

/// What a device is, and what it may.
struct Bench<'a, K> {
    device: &'a Device<K, 3>,
    plant: PlantSettings,
    /// Its dry friction along z, N, which the hand overcomes, as `palpate zwidth` has it.
    dry: f64,
    /// How much finer its encoders are than those it ships with.
    finer: f64,
}

impl<K: Kinematics<3> + Copy> Bench<'_, K> {
    /// With encoders so much finer.
    fn finer(&self, factor: f64) -> (Device<K, 3>, PlantSettings) {
        let mut plant = self.plant;
        plant.joints.iter_mut().for_each(|joint| joint.counts_per_turn *= factor);
        let encoders = self.device.encoders.map(|Encoder { radians_per_count, angle_at_zero }| {
            Encoder::new(radians_per_count / factor as f32, angle_at_zero - 0.5 * radians_per_count)
        });
        (Device { encoders, ..*self.device }, plant)
    }

    /// Runs all scripts but those of free air, which are of the device alone.
    fn felt(&self, rendering: Rendering, mut look: impl FnMut(&Script, &Figures, &Recording)) {
        let (device, plant) = self.finer(self.finer);
        let body: &Body<'_> = &capped_box::BODY;
        let stage =
            Stage { joints: 3, stiffness: f64::from(SETTINGS.stiffness), hand: 300.0, dry: self.dry, max_force: 5.0 };
        let on_body = Settings { body_origin: CAPPED_BOX_AT, ..SETTINGS };
        let threshold = Threshold::approximate();
        let flat = Servo::try_new(&device, wall(3), Controller::SECOND_ORDER, SETTINGS).unwrap();
        let edged = Servo::try_new(&device, body, Controller::SECOND_ORDER, on_body).unwrap();
        let (flat, edged) = (flat.try_rendering(rendering).unwrap(), edged.try_rendering(rendering).unwrap());
        for script in stage.on_the_wall().into_iter().filter(|script| script.deed != Deed::Air) {
            let recording = record(&flat, &plant, HandSettings::default(), &script).unwrap();
            look(&script, &recording.figures(script.looked_at, &threshold), &recording);
        }
        for script in over_edges(body, CAPPED_BOX_AT, &stage) {
            let recording = record(&edged, &plant, HandSettings::default(), &script).unwrap();
            look(&script, &recording.figures(script.looked_at, &threshold), &recording);
        }
    }

    /// Asserts what a smooth force is for. Slides are to be below the threshold; whether the force turns at the edge is
    /// returned, for a hand that dry friction holds may not get round it.
    fn is_smooth(&self) -> bool {
        let mut turns = false;
        self.felt(Rendering::SMOOTH, |script, figures, recording| {
            let Figures { steps, sensation, .. } = figures;
            println!(
                "{:<22} contact {:5.1} release {:5.1} any {:5.1} mN, {:6.1} dB, after {:3.1} ms",
                script.name,
                steps.contact * 1e3,
                steps.release * 1e3,
                steps.any * 1e3,
                sensation.level,
                figures.afterglow * 1e3
            );
            match script.deed {
                Deed::Approach(speed) if speed > BOUND_SPEED => {}
                Deed::Approach(_) => assert_eq!(beyond(recording), None, "{}", script.name),
                _ => assert!(steps.any <= STEP, "{}: {steps:?}", script.name),
            }
            // The hand presses with 0.7 N and some of what friction takes, 1.1 N in all: at 200 N/s.
            assert!(figures.afterglow <= 1.1 / 200.0, "{}: {}", script.name, figures.afterglow);
            match script.deed {
                Deed::Rest | Deed::Slide => {
                    assert!(sensation.is_below(), "{}: {sensation:?}", script.name);
                    // Of the depth that the loop believes. While it slides its force lags the ripple that is left.
                    let asked = f64::from(SETTINGS.stiffness) * figures.depth;
                    assert!((figures.force / asked - 1.0).abs() < 0.02, "{}: {figures:?}", script.name);
                }
                Deed::Hover => assert!(recording.ticks.iter().all(|tick| tick.force == [0.0; 3]), "{}", script.name),
                Deed::Across(Some(normals)) => {
                    if let Some(turn) = recording.turn(normals, script.looked_at) {
                        println!("turns over {:.2} mm", turn * 1e3);
                        assert!(turn < 0.5e-3, "{turn}");
                        turns = true;
                    }
                }
                Deed::Approach(_) | Deed::Verge | Deed::Air | Deed::Off(_) | Deed::Across(None) => {}
            }
        });
        turns
    }
}

/// The first step that is too large, N, of a probe that comes to a wall, and the probe's speed, m/s. The Falcon's third
/// of a kilogram swings ahead of the hand that draws it at 0.3 m/s, and arrives at 0.41: the spring alone then makes
/// more than 50 mN of it, and on counts, between which the observer's motion ripples by a twentieth, a little more.
fn beyond(recording: &Recording) -> Option<[f64; 2]> {
    recording.ticks.windows(2).find_map(|pair| {
        let apart = |of: fn(&Tick) -> Vector| {
            let [before, now] = [of(&pair[0]), of(&pair[1])];
            (0..3).map(|axis| (now[axis] - before[axis]).powi(2)).sum::<f64>().sqrt()
        };
        let (step, speed) = (apart(|tick| tick.force), apart(|tick| tick.probe) * recording.rate);
        let own = if speed > BOUND_SPEED { 1.05 * f64::from(SETTINGS.stiffness) * speed / recording.rate } else { 0.0 };
        (step > STEP.max(own)).then_some([step, speed])
    })
}

#[test]
fn on_the_wooden_haptics_nothing_steps_and_nothing_buzzes() {
    let plant = PlantSettings::wooden_haptics_2016();
    assert!(Bench { device: &WOODEN_HAPTICS_2016, plant, dry: 0.076, finer: 1.0 }.is_smooth());
}

#[test]
fn on_the_polhem_nothing_steps_and_nothing_buzzes() {
    assert!(Bench { device: &POLHEM_V2, plant: PlantSettings::polhem_v2(), dry: 0.158, finer: 1.0 }.is_smooth());
}

/// Its own friction is too little to hide its counts of 29 µm: with them a slide is felt, by a few hundredths of a
/// decibel.
#[test]
fn on_a_phantom_with_encoders_twice_as_fine_nothing_steps_and_nothing_buzzes() {
    assert!(
        Bench { device: &PHANTOM_PREMIUM, plant: PlantSettings::phantom_premium(), dry: 0.048, finer: 2.0 }.is_smooth()
    );
}

/// Friction of a newton and a half holds the hand before it has got round the edge.
#[test]
fn on_the_falcon_nothing_steps_and_nothing_buzzes() {
    assert!(
        !Bench { device: &NOVINT_FALCON, plant: PlantSettings::novint_falcon(), dry: 1.992, finer: 1.0 }.is_smooth()
    );
}
