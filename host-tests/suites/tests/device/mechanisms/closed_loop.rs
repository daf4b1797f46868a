//! A spring rendered by the library pulls the probe home: a wrong direction anywhere drives it away.

use super::case::{Case, cases, distance, narrow};
use palpate::math::Vec3;
use palpate_sim::plant::{HandSettings, Plant, StillHand};

const RATE: f64 = 4_000.0;

/// Runs a spring and damper to the workspace centre for a second; gives where the probe was and is, and its last speed.
fn pulled_home(case: &Case, stiffness: f32, damping: f32) -> (f64, f64, f64) {
    let start = case.force().map(|share| share * case.radius * 0.3);
    let mut plant = Plant::new(&case.plant, HandSettings::NONE, Box::new(StillHand(start)), RATE).unwrap();
    let mut last = (case.sense)(plant.counts());
    let (mut velocity, mut rates) = (Vec3::ZERO, [0.0; 3]);
    for _ in 0..4_000 {
        let tick = (case.sense)(plant.counts());
        // Low-passes of about 100 Hz.
        velocity += 0.15 * ((tick.position - last.position) * RATE as f32 - velocity);
        for ((rate, angle), last) in rates.iter_mut().zip(tick.angles).zip(last.angles) {
            *rate += 0.15 * ((angle - last) * RATE as f32 - *rate);
        }
        let force = tick.position * -stiffness - velocity * damping;
        plant.advance((case.drive)(tick.angles, rates, force));
        last = tick;
    }
    let speed = distance(plant.velocity(), [0.0; 3]);
    (distance(start, [0.0; 3]), distance(plant.position(), [0.0; 3]), speed)
}

#[test]
fn a_spring_pulls_the_probe_of_every_device_home() {
    for case in cases() {
        // Stiffness and damping about half of what is recommended; and how far off weight and dry friction may keep it:
        // the links' weight at the probe, under 1 N (Falcon 1.9 N of plate, shins and thighs), and dry friction over
        // the shortest lever, on the spring.
        let (stiffness, damping, force) = match case.name {
            "WoodenHaptics 2016" => (400.0, 4.0, 1.1),
            "Polhem v2" => (800.0, 4.0, 3.5),
            "Phantom Premium" => (600.0, 3.0, 0.7),
            "Hapkit" => (200.0, 1.0, 0.4),
            "Haply 2diy v3" => (150.0, 1.0, 0.1),
            "Haply kit v1" => (150.0, 1.0, 0.1),
            "Novint Falcon" => (1_000.0, 8.0, 4.5),
            other => panic!("{other}"),
        };
        let (start, end, speed) = pulled_home(&case, stiffness, damping);
        println!("{}: from {:.2} mm to {:.2} mm, {:.1e} m/s", case.name, start * 1e3, end * 1e3, speed);
        let bound = force / f64::from(stiffness);
        assert!(start > 2.0 * bound, "{}: the test must tell home from here: {start} {bound}", case.name);
        assert!(end < bound, "{}: {end} m, bound {bound} m", case.name);
        assert!(speed < 0.01, "{}: it settles: {speed} m/s", case.name);
    }
}

#[test]
fn a_force_accelerates_the_probe_as_the_mass_matrix_says() {
    for case in cases() {
        let mut settings = case.plant;
        settings.gravity = 0.0;
        for joint in &mut settings.joints {
            (joint.viscous_friction, joint.coulomb_friction) = (0.0, 0.0);
        }
        let force = case.force();
        let mut plant = Plant::new(&settings, HandSettings::NONE, Box::new(StillHand([0.0; 3])), RATE).unwrap();
        let mechanism = settings.mechanism(0.0);
        let angles = plant.angles();
        let tick = (case.sense)(plant.counts());
        let command = (case.drive)(tick.angles, [0.0; 3], narrow(force));
        (0..8).for_each(|_| plant.advance(command));

        // Joint momenta `M q̇ = Jᵀ F t`, joint by joint, so that none can hide. Eight periods less the period of delay
        // and the 0.15 ms of the current loop, or the L/R of the winding.
        let lag = match case.name {
            "Hapkit" => 1e-3 / 10.0,
            "Haply 2diy v3" => 1e-3 / 4.0,
            "Haply kit v1" => 1e-3 / 12.0,
            _ => 1.5e-4,
        };
        let time = 7.0 / RATE - lag;
        let (mass, jacobian) = (mechanism.mass_matrix(angles), mechanism.jacobian(angles));
        let largest = (0..case.joints)
            .map(|joint| (0..3).map(|i| jacobian[i][joint].powi(2)).sum::<f64>().sqrt() * time)
            .fold(0.0, f64::max);
        for joint in 0..case.joints {
            let momentum: f64 = (0..3).map(|other| mass[joint][other] * plant.rates()[other]).sum();
            let impulse: f64 = (0..3).map(|i| jacobian[i][joint] * force[i]).sum::<f64>() * time;
            // A millisecond or two of 1 N turns the Jacobian by less than 1 %; on a bridge back-EMF takes a few
            // percent.
            let share = if lag == 1.5e-4 { 0.01 } else { 0.08 };
            assert!(
                (momentum - impulse).abs() < share * largest,
                "{} joint {joint}: {momentum:e} {impulse:e} {largest:e}",
                case.name
            );
        }
    }
}
