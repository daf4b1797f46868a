//! Which velocity estimator: noise against delay on quantised motion, and what each does for the stiffest wall.

use palpate::device::{VelocityEstimator, VelocityMethod};
use palpate_sim::devices::named;
use palpate_sim::zwidth::{Loop, Slice, max_stiffness};
use std::f64::consts::TAU;

const RATE: f64 = 4_000.0;
const COUNT: f64 = 57.6e-6;

/// A hand's motion: three sines below 8 Hz, with this greatest speed, m/s. Position and velocity.
fn motion(time: f64, speed: f64) -> (f64, f64) {
    let parts = [(1.1, 0.4, 0.3), (3.3, 0.35, 1.9), (7.7, 0.25, 4.2)];
    parts.iter().fold((0.0, 0.0), |(x, v), (frequency, share, phase)| {
        let omega = TAU * frequency;
        let angle = omega * time + phase;
        (x + speed * share / omega * angle.sin(), v + speed * share * angle.cos())
    })
}

/// (delay in s, noise in mm/s): the shift at which the estimate differs least from the truth, and that difference.
fn measure(method: VelocityMethod, corner: f64, speed: f64) -> (f64, f64) {
    let estimator = VelocityEstimator::new(method, corner as f32, RATE as f32, COUNT as f32);
    let mut state = estimator.start();
    let read = |time: f64| ((motion(time, speed).0 / COUNT).floor() * COUNT) as f32;
    let mut last = read(0.0);
    let mut estimates = Vec::new();
    for tick in 1..40_000 {
        let now = read(f64::from(tick) / RATE);
        estimates.push((f64::from(tick) / RATE, f64::from(estimator.next(&mut state, now - last))));
        last = now;
    }
    let difference = |delay: f64| {
        let squares = estimates.iter().skip(400).map(|(time, found)| (found - motion(time - delay, speed).1).powi(2));
        (squares.sum::<f64>() / (estimates.len() - 400) as f64).sqrt()
    };
    // Down to a tenth of a period.
    (0..300)
        .map(|step| f64::from(step) * 0.1 / RATE)
        .map(|delay| (delay, difference(delay) * 1e3))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap()
}

#[test]
fn the_default_is_chosen_by_what_is_printed_here() {
    println!("4 kHz, 57.6 µm a count; the stiffest wall at B = 8 N·s/m behind one period, for the WoodenHaptics slice");
    println!("{:<28}{:>22}{:>22}{:>14}", "estimator", "slow, 20 mm/s", "fast, 300 mm/s", "stiffest");
    let mut rows = Vec::new();
    for (method, corner) in [
        (VelocityMethod::LowPass, 50.0),
        (VelocityMethod::LowPass, 100.0),
        (VelocityMethod::LowPass, 200.0),
        (VelocityMethod::LowPass, 400.0),
        (VelocityMethod::BetweenCounts, 80.0),
        (VelocityMethod::BetweenCounts, 200.0),
    ] {
        let (slow, fast) = (measure(method, corner, 0.02), measure(method, corner, 0.3));
        let servo = Loop { rate: RATE, delay_periods: 1.0, velocity: method, corner, ease: None };
        let stiffest = max_stiffness(&Slice::of(named("woodenhaptics-2016").unwrap()), 8.0, &servo);
        let cell = |(delay, noise): (f64, f64)| format!("{:.2} ms, {noise:.1} mm/s", delay * 1e3);
        println!("{:<28}{:>22}{:>22}{:>10.0} N/m", format!("{method:?} {corner} Hz"), cell(slow), cell(fast), stiffest);
        rows.push((method, corner, slow, fast, stiffest));
    }
    let row = |method, corner| *rows.iter().find(|row| row.0 == method && row.1 == corner).unwrap();
    let low_pass = row(VelocityMethod::LowPass, 200.0);
    let between = row(VelocityMethod::BetweenCounts, 200.0);
    // The delay decides how stiff a wall may be: the play and the position's delay cost the wall, for half the noise.
    assert!((low_pass.2.0 - 1.0 / (TAU * 200.0)).abs() < 1e-4, "the corner sets the delay");
    assert!(between.3.0 < low_pass.3.0 + 2e-4 && between.3.1 < 0.5 * low_pass.3.1);
    assert!(between.2.0 > low_pass.2.0 && between.4 < low_pass.4);
}
