//! What a higher rate is good for: a stiffer wall that is clean, as far as counts let it. Of WoodenHaptics; `palpate
//! feel --clean` looks for the stiffest of every device.

use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Device, Encoder, VelocityMethod};
use palpate::math::Vec3;
use palpate::servo::{Config, Rendering, Servo, Settings};
use palpate_sim::feel::{Deed, Sensation, Stage, Threshold, record, wall};
use palpate_sim::plant::{HandSettings, PlantSettings};

/// The estimators that can be had at a rate, Hz: the observer's corner goes up to a twenty-fifth of it.
fn estimators(rate: f32) -> Vec<(VelocityMethod, f32)> {
    let between = [39.0, 60.0, 79.0, 120.0, 159.0, 318.0].into_iter().filter(|corner| *corner < rate / 25.0);
    let counted = [80.0, 320.0].map(|corner| (VelocityMethod::LowPass, corner));
    between.map(|corner| (VelocityMethod::BetweenCounts, corner)).chain(counted).collect()
}

/// What is felt of a firm slide, with encoders so many times as fine.
fn slide(rate: f32, stiffness: f32, finer: f64, (velocity, corner): (VelocityMethod, f32)) -> Sensation {
    let mut plant = PlantSettings::wooden_haptics_2016();
    plant.joints.iter_mut().for_each(|joint| joint.counts_per_turn *= finer);
    // The same steps of integration at every rate.
    plant.sub_steps = (80_000.0 / f64::from(rate)).round() as u32;
    let encoders =
        WOODEN_HAPTICS_2016.encoders.map(|Encoder { radians_per_count, angle_at_zero_rad: angle_at_zero }| {
            Encoder::new(radians_per_count / finer as f32, angle_at_zero - 0.5 * radians_per_count)
        });
    let device = Device { encoders, max_stiffness_n_per_m: f32::MAX, ..WOODEN_HAPTICS_2016 };
    let settings = Settings {
        rate_hz: rate,
        stiffness_n_per_m: stiffness,
        damping_n_s_per_m: 2.0,
        max_force_n: 5.0,
        velocity_corner_hz: corner,
        soft_start_s: 0.1,
        body_origin_m: Vec3::ZERO,
    };
    let stage = Stage { joints: 3, stiffness: f64::from(stiffness), hand: 300.0, dry: 0.076, max_force: 5.0 };
    let servo = Servo::try_new(&device, wall(3), Config { settings, ..Config::DEFAULT }).unwrap();
    let servo = Servo::try_new(
        servo.device(),
        servo.surface(),
        Config { rendering: Rendering { velocity, ..Rendering::SMOOTH }, ..servo.config() },
    )
    .unwrap();
    let script = stage.on_the_wall().into_iter().rfind(|script| script.deed == Deed::Slide).unwrap();
    // A wall that shakes the device until its loop stops is felt.
    record(&servo, &plant, HandSettings::default(), &script)
        .map_or(Sensation { level: f64::INFINITY, frequency: 0.0 }, |recording| {
            recording.figures(script.looked_at, &Threshold::approximate()).sensation
        })
}

/// Whether any estimator makes it clean, with its level, dB.
fn best(rate: f32, stiffness: f32, finer: f64) -> f64 {
    let levels = estimators(rate).into_iter().map(|estimator| slide(rate, stiffness, finer, estimator).level);
    let best = levels.fold(f64::INFINITY, f64::min);
    println!("{rate} Hz, {stiffness} N/m, counts 1/{finer}: {best:.1} dB");
    best
}

#[test]
fn where_counts_are_fine_a_wall_that_is_felt_at_one_rate_is_clean_at_the_next() {
    assert!(best(1_000.0, 5_000.0, 4.0) > 0.0 && best(2_000.0, 5_000.0, 4.0) < 0.0);
    assert!(best(2_000.0, 8_500.0, 4.0) > 0.0 && best(4_000.0, 8_500.0, 4.0) < 0.0);
}

#[test]
fn the_device_s_own_counts_are_felt_at_any_rate_and_finer_ones_are_not() {
    assert!(best(1_000.0, 1_000.0, 1.0) > 0.0 && best(4_000.0, 1_000.0, 1.0) < 0.0, "below the counts' floor");
    assert!([4_000.0, 8_000.0].into_iter().all(|rate| best(rate, 2_000.0, 1.0) > 0.0));
    assert!(best(4_000.0, 2_000.0, 4.0) < 0.0);
}
