//! What the smooth rendering is for, on the four devices that feel a surface in space: no step, no buzz, an edge that
//! is an edge. Simulated, with what is recommended for each.

use palpate::body::Body;
use palpate::device::presets::{NOVINT_FALCON, PHANTOM_PREMIUM, POLHEM_V2, WOODEN_HAPTICS_2016};
use palpate::device::{Device, Kinematics};
use palpate::math::{Vec3, vec3};
use palpate::servo::recommended::{self, Recommended};
use palpate::servo::{Config, Servo, Settings};
use palpate_sim::feel::{Deed, Figures, Recording, Script, Stage, Threshold, over_edges, record, wall};
use palpate_sim::plant::{HandSettings, PlantSettings};

mod capped_box {
    include!("../../../../boards/bodies/capped_box.rs");
}

/// Its middle, below which the dome begins.
const CAPPED_BOX_AT: Vec3 = vec3(-0.03, -0.02, -0.016);

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
    touch: Recommended,
}

impl<K: Kinematics<3> + Copy> Bench<'_, K> {
    /// Runs all scripts but those of free air, which are of the device alone.
    fn felt(&self, mut look: impl FnMut(&Script, &Figures, &Recording)) {
        // Two fifths of the plant's own; a long run takes more.
        let (device, plant) = (self.device, self.plant.in_sub_steps(4));
        let Recommended { settings, rendering } = self.touch;
        let body: &Body<'_> = &capped_box::BODY;
        let stage = Stage {
            joints: 3,
            stiffness: f64::from(settings.stiffness_n_per_m),
            hand: 300.0,
            dry: self.dry,
            max_force: f64::from(settings.max_force_n),
        };
        let on_body = Settings { body_origin_m: CAPPED_BOX_AT, ..settings };
        let threshold = Threshold::approximate();
        let flat = Servo::try_new(device, wall(3), Config { settings, ..Config::DEFAULT }).unwrap();
        let edged = Servo::try_new(device, body, Config { settings: on_body, ..Config::DEFAULT }).unwrap();
        let (flat, edged) = (
            Servo::try_new(flat.device(), flat.surface(), Config { rendering, ..flat.config() }).unwrap(),
            Servo::try_new(edged.device(), edged.surface(), Config { rendering, ..edged.config() }).unwrap(),
        );
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
        self.felt(|script, figures, recording| {
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
                _ => assert!(steps.any <= STEP, "{}: {steps:?}", script.name),
            }
            // The hand presses with 0.7 N and some of what friction takes, 1.1 N in all: at 200 N/s.
            assert!(figures.afterglow <= 1.1 / 200.0, "{}: {}", script.name, figures.afterglow);
            match script.deed {
                Deed::Rest | Deed::Slide => {
                    assert!(sensation.is_below(), "{}: {sensation:?}", script.name);
                    // Of the depth that the loop believes. While it slides its force lags the ripple that is left.
                    let asked = f64::from(self.touch.settings.stiffness_n_per_m) * figures.depth;
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

#[test]
fn on_the_wooden_haptics_nothing_steps_and_nothing_buzzes() {
    let (plant, touch) = (PlantSettings::wooden_haptics_2016(), recommended::WOODEN_HAPTICS_2016);
    assert!(Bench { device: &WOODEN_HAPTICS_2016, plant, dry: 0.076, touch }.is_smooth());
}

#[test]
fn on_the_polhem_nothing_steps_and_nothing_buzzes() {
    let (plant, touch) = (PlantSettings::polhem_v2(), recommended::POLHEM_V2);
    assert!(Bench { device: &POLHEM_V2, plant, dry: 0.158, touch }.is_smooth());
}

#[test]
fn on_the_phantom_nothing_steps_and_nothing_buzzes() {
    let (plant, touch) = (PlantSettings::phantom_premium(), recommended::PHANTOM_PREMIUM);
    assert!(Bench { device: &PHANTOM_PREMIUM, plant, dry: 0.048, touch }.is_smooth());
}

/// Friction of a newton and a half holds the hand before it has got round the edge.
#[test]
fn on_the_falcon_nothing_steps_and_nothing_buzzes() {
    let (plant, touch) = (PlantSettings::novint_falcon(), recommended::NOVINT_FALCON);
    assert!(!Bench { device: &NOVINT_FALCON, plant, dry: 1.992, touch }.is_smooth());
}
