//! The limit that the one-mass slice predicts, against the three-dimensional arm.

use crate::surfaces::WALL;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Counts, Device, SerialArm, VelocityMethod};
use palpate::math::Vec3;
use palpate::render::{Ease, Material};
use palpate::servo::{Config, Input, Rendering, Servo, Settings};
use palpate_sim::devices::{DEVICES, named};
use palpate_sim::plant::{HandPath, HandSettings, Plant, PlantSettings, Vector};
use palpate_sim::zwidth::{Loop, Slice, max_stiffness};

const FREE: Device<SerialArm, 3> =
    Device { max_stiffness_n_per_m: 1e6, max_damping_n_s_per_m: 1e3, ..WOODEN_HAPTICS_2016 };

/// Comes down at 50 mm/s from 2 mm above to 20 mm below, and stays.
struct Hit;

impl HandPath for Hit {
    fn target(&self, time: f64) -> Vector {
        [0.0, 0.0, (0.002 - 0.05 * time).max(-0.02)]
    }
    fn velocity(&self, time: f64) -> Vector {
        [0.0, 0.0, if self.target(time)[2] > -0.02 { -0.05 } else { 0.0 }]
    }
}

/// The swing of the probe's height at the end, in counts along the vertical, of a wall pressed by a soft hand that
/// hardly damps.
fn swing(stiffness: f32, damping: f32, rate: f64) -> f64 {
    let settings = Settings {
        rate_hz: rate as f32,
        stiffness_n_per_m: stiffness,
        damping_n_s_per_m: damping,
        max_force_n: 5.0,
        velocity_corner_hz: 200.0,
        soft_start_s: 0.0,
        body_origin_m: Vec3::ZERO,
    };
    // 40 N/m and 20 mm: 0.8 N. The links' weight helps: it is not carried.
    let servo = Servo::new(
        &FREE,
        &WALL,
        Config { settings, rendering: Rendering { compensates_gravity: false, ..Rendering::PLAIN }, ..Config::DEFAULT },
    );
    let hand = HandSettings { stiffness: 40.0, damping: 0.1, mass: 0.0 };
    let mut plant = Plant::new(&PlantSettings::wooden_haptics_2016(), hand, Box::new(Hit), rate).unwrap();
    let mut state = servo.start();
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    let ticks = (2.4 * rate) as usize;
    for tick in 0..ticks {
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
        assert_eq!(state.fault(), None);
        plant.advance(state.duties().map(|duty| duty.0));
        if tick > ticks * 7 / 8 {
            lowest = lowest.min(plant.position()[2]);
            highest = highest.max(plant.position()[2]);
        }
    }
    (highest - lowest) / Slice::of(named("woodenhaptics-2016").unwrap()).resolution
}

#[test]
fn the_arm_holds_below_the_slice_s_limit_and_swings_above_it() {
    for (rate, damping) in [(1_000.0, 0.0), (1_000.0, 2.0), (4_000.0, 0.0), (4_000.0, 4.0)] {
        let servo = Loop { rate, delay_periods: 1.0, velocity: VelocityMethod::LowPass, corner: 200.0, ease: None };
        let limit = max_stiffness(&Slice::of(named("woodenhaptics-2016").unwrap()), damping, &servo);
        let swings = [0.5, 0.7, 1.0, 1.4, 2.0, 3.0].map(|share| swing((limit * share) as f32, damping as f32, rate));
        println!(
            "{rate} Hz, {damping} N·s/m: the slice's limit {limit:.0} N/m; swings at 0.5 to 3 times it {swings:.1?} counts"
        );
        // Friction couples the joints in three dimensions and the mass depends on the pose: half and three times.
        assert!(swings[0] <= 2.0, "{swings:?}");
        assert!(swings[5] > 2.0, "{swings:?}");
    }
}

/// A loop whose force is smooth, at 4 kHz or another rate.
fn smooth(rate: f64) -> Loop {
    Loop { rate, delay_periods: 1.0, velocity: VelocityMethod::BetweenCounts, corner: 80.0, ease: Some(Ease::SMOOTH) }
}

/// One whose force is eased alone, or not even that.
fn eased(rate: f64, ease: Option<Ease>) -> Loop {
    Loop { rate, delay_periods: 1.0, velocity: VelocityMethod::LowPass, corner: 200.0, ease }
}

#[test]
fn a_smooth_wall_holds_wherever_its_bound_says_so() {
    let viscous = Slice { viscous: 2.0, coulomb: 0.5, ..Slice::of(named("woodenhaptics-2016").unwrap()) };
    let light = Slice { mass: 0.02, viscous: 0.5, coulomb: 0.2, resolution: 10e-6, ..viscous };
    for slice in DEVICES.iter().map(Slice::of).chain([viscous, light]) {
        for (servo, damping) in [1_000.0, 4_000.0]
            .into_iter()
            .flat_map(|rate| [smooth(rate), eased(rate, Some(Ease::SMOOTH))])
            .flat_map(|servo| [(servo, 0.0), (servo, 0.5)])
        {
            let (passive, simulated) =
                (servo.passive_stiffness(&slice, damping), max_stiffness(&slice, damping, &servo));
            // The search stops within 1.8 % of the limit.
            assert!(simulated >= passive * 0.98, "{} {servo:?} {damping}: {simulated} < {passive}", slice.name);
        }
    }
}

#[test]
fn a_smooth_wall_of_what_is_recommended_comes_to_rest_on_every_device() {
    for device in &DEVICES {
        let limits = device.preset.limits();
        let stiffness = f64::from(Material::WOOD.stiffness_n_per_m.min(limits.stiffness));
        let damping = f64::from(Material::WOOD.damping_n_s_per_m.min(limits.damping));
        let limit = max_stiffness(&Slice::of(device), damping, &smooth(4_000.0));
        println!("{}: {stiffness} N/m and {damping} N·s/m, and holds to {limit:.0} N/m", device.name);
        // As above: the mass depends on the pose, and what the slice holds the arm holds to a half.
        assert!(limit >= 2.0 * stiffness, "{}: {limit}", device.name);
    }
}

#[test]
fn easing_takes_little_of_the_stiffest_wall() {
    for device in &DEVICES {
        let slice = Slice::of(device);
        // The dampings with which walls are stiffest.
        let stiffest = |ease: Option<Ease>| {
            [8.0, 16.0, 32.0]
                .map(|damping| max_stiffness(&slice, damping, &eased(4_000.0, ease)))
                .into_iter()
                .fold(0.0, f64::max)
        };
        let [plain, with] = [None, Some(Ease::SMOOTH)].map(stiffest);
        println!("{}: {plain:.0} N/m plain, {with:.0} N/m eased", device.name);
        // What is lost is what the damper lacks below a newton of push: more than a third nowhere that was measured.
        assert!(with >= 0.6 * plain, "{}: {plain} {with}", device.name);
    }
}
