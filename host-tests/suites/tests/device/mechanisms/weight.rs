//! The torques that carry the links, and the resolution at the probe.

use super::case::{cases, distance};
use palpate_sim::plant::{HandSettings, Plant, StillHand};

#[test]
fn holding_torques_balance_the_simulated_weight_where_masses_are_known() {
    let mut checked = 0;
    for case in cases() {
        // The Falcon's are assumed, and the same on both sides.
        let known = matches!(case.name, "WoodenHaptics 2016" | "Polhem v2" | "Phantom Premium" | "Novint Falcon");
        let mechanism = case.mechanism();
        let mut heaviest: f64 = 0.0;
        for (single, double) in case.workspace() {
            let (holding, weight) = ((case.holding)(single), mechanism.gravity_torques(double));
            if !known {
                assert_eq!(holding, [0.0; 3], "{}: what is not known is not made up", case.name);
                continue;
            }
            heaviest = heaviest.max(distance(weight, [0.0; 3]));
            // Roundings of torques under 1 N·m, and those of the linkage's Jacobian: 3e-6 m/rad under 4 N.
            assert!(distance(holding, weight.map(|torque| -torque)) < 1.2e-5, "{}: {holding:?} {weight:?}", case.name);
        }
        checked += usize::from(known);
        // There is something to carry.
        assert!(!known || heaviest > 0.02, "{}: {heaviest}", case.name);
    }
    assert_eq!(checked, 4);
}

#[test]
fn encoders_tell_the_probe_s_place_to_a_count() {
    for case in cases() {
        for share in [[0.0, 0.0, 0.0], [0.5, -0.4, 0.3], [-0.6, 0.3, -0.2]] {
            let place = core::array::from_fn(|axis| if axis < case.joints { case.radius * share[axis] } else { 0.0 });
            let plant = Plant::new(&case.plant, HandSettings::NONE, Box::new(StillHand(place)), 4_000.0).unwrap();
            let tick = (case.sense)(plant.counts());
            let pose = (case.pose)(tick.angles).unwrap();
            let lag = distance(pose.position, place);
            // Each joint is off by half a count at most, and the probe by that times its lever.
            let bound: f64 = (0..case.joints)
                .map(|joint| 0.5 * distance(pose.columns[joint], [0.0; 3]) / case.counts_per_radian[joint].abs())
                .sum();
            assert!(lag < 1.02 * bound, "{} {place:?}: {lag} m of {bound} m", case.name);
        }
    }
}

#[test]
fn readings_lean_neither_way() {
    const PLACES: u32 = 4_000;
    for case in cases() {
        let encoders = case.plant.encoders();
        for joint in 0..case.joints {
            let (mut sum, mut worst) = (0.0, 0.0_f64);
            for n in 0..PLACES {
                // Golden sections of a radian: evenly spread over the counts.
                let angle = f64::from(n) * 0.618_033_988_749_895 % 1.0;
                let mut counts = [0; 3];
                counts[joint] = encoders[joint].counts(angle);
                let off = (f64::from((case.sense)(counts).angles[joint]) - angle) * case.counts_per_radian[joint];
                sum += off;
                worst = worst.max(off.abs());
            }
            let mean = sum / f64::from(PLACES);
            println!("{} joint {joint}: mean {mean:.4} counts, worst {worst:.3}", case.name);
            // Places at random would give 0.29/√4000 = 0.005; read at the line the mean would be a half. A count is
            // 2e-4 rad or more, and f32 rounds an angle of a radian or two to 1.2e-7: a thousandth of it.
            assert!(mean.abs() < 0.01 && worst < 0.505, "{} joint {joint}: {mean} {worst}", case.name);
        }
    }
}
