//! The torques that carry the links, and the resolution at the probe.

use super::case::{cases, distance};
use palpate_host::plant::{HandSettings, Plant, StillHand};

#[test]
fn holding_torques_balance_the_simulated_weight_where_masses_are_published() {
    let mut checked = 0;
    for case in cases() {
        let published = matches!(case.name, "WoodenHaptics 2016" | "Polhem v2" | "Phantom Premium");
        let mechanism = case.mechanism();
        let mut heaviest: f64 = 0.0;
        for (single, double) in case.workspace() {
            let (holding, weight) = ((case.holding)(single), mechanism.gravity_torques(double));
            if !published {
                assert_eq!(holding, [0.0; 3], "{}: what is not known is not made up", case.name);
                continue;
            }
            heaviest = heaviest.max(distance(weight, [0.0; 3]));
            // Roundings of torques under 1 N·m, and those of the linkage's Jacobian: 3e-6 m/rad under 4 N.
            assert!(distance(holding, weight.map(|torque| -torque)) < 1.2e-5, "{}: {holding:?} {weight:?}", case.name);
        }
        checked += usize::from(published);
        // There is something to carry.
        assert!(!published || heaviest > 0.02, "{}: {heaviest}", case.name);
    }
    assert_eq!(checked, 3);
}

#[test]
fn encoders_tell_the_probe_s_place_to_a_count() {
    for case in cases() {
        for share in [[0.0, 0.0, 0.0], [0.5, -0.4, 0.3], [-0.6, 0.3, -0.2]] {
            let place = core::array::from_fn(|axis| if axis < case.joints { case.radius * share[axis] } else { 0.0 });
            let plant = Plant::new(&case.plant, HandSettings::NONE, Box::new(StillHand(place)), 4_000.0).unwrap();
            let tick = (case.sense)(plant.counts());
            let pose = (case.pose)(tick.angles);
            let lag = distance(pose.position, place);
            // Each joint lags by less than a count, and the probe by that times its lever.
            let bound: f64 = (0..case.joints)
                .map(|joint| distance(pose.columns[joint], [0.0; 3]) / case.counts_per_radian[joint].abs())
                .sum();
            assert!(lag < 1.01 * bound, "{} {place:?}: {lag} m of {bound} m", case.name);
        }
    }
}
