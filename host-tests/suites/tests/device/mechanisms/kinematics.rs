//! Forward maps, Jacobians, workspaces and singularities.

use super::case::{Triple, cases, distance};
use palpate::device::presets::{HAPLY_2DIY_V3, NOVINT_FALCON, POLHEM_V2};
use palpate::device::{Kinematics, ProbePose};
use palpate::math::vec3;
use std::f32::consts::PI;

/// One joint turned by a step.
fn turned(angles: Triple, joint: usize, step: f64) -> Triple {
    let mut turned = angles;
    turned[joint] += step;
    turned
}

#[test]
fn every_place_of_the_workspace_is_in_it_and_clear_of_singularities() {
    for case in cases() {
        let workspace = case.workspace();
        // A stretch, a disc and a ball of the grid: 21, π/4 · 21², π/6 · 11³, at least nine tenths of it.
        assert!(workspace.len() >= [21, 310, 500][case.joints - 1], "{}: {}", case.name, workspace.len());
        for (angles, _) in workspace {
            assert!((case.in_workspace)(angles), "{}: {angles:?}", case.name);
        }
    }
}

#[test]
fn forward_map_agrees_with_the_simulated_mechanism() {
    for case in cases() {
        let mechanism = case.mechanism();
        let worst = case
            .workspace()
            .into_iter()
            .map(|(single, double)| distance((case.pose)(single).unwrap().position, mechanism.position(double)))
            .fold(0.0, f64::max);
        println!("{}: forward map to {worst:.1e} m", case.name);
        // sin and cos err by 1.2e-7 each, on links that sum to 0.45 m at most, and some ten roundings follow; a closed
        // chain stretches that by what its Jacobian does. The finest count at a probe is 15 µm.
        assert!(worst < 4e-7, "{}: {worst:e} m", case.name);
    }
}

#[test]
fn wherever_a_device_says_it_is_in_its_workspace_the_forward_map_holds() {
    for case in cases() {
        let mechanism = case.mechanism();
        let (mut worst, mut inside) = (0.0_f64, 0);
        // Joint angles over a turn and more, as they come: most are outside.
        for n in 0..60_u32.pow(case.joints as u32) {
            let angle = |joint: u32| -2.2 + 6.6 * ((n / 60_u32.pow(joint) % 60) as f32 + 0.37) / 60.0;
            let angles: [f32; 3] =
                core::array::from_fn(|joint| if joint < case.joints { angle(joint as u32) } else { 0.0 });
            if (case.in_workspace)(angles) {
                let off = distance((case.pose)(angles).unwrap().position, mechanism.position(angles.map(f64::from)));
                (worst, inside) = (worst.max(off), inside + 1);
            }
        }
        println!("{}: forward map to {worst:.1e} m over all of the workspace, {inside} poses", case.name);
        assert!(inside >= [10, 200, 2_000][case.joints - 1], "{}: {inside}", case.name);
        // As over the workspace that is spoken of.
        assert!(worst < 4e-7, "{}: {worst:e} m", case.name);
    }
}

#[test]
fn jacobian_agrees_with_differences_of_both_forward_maps() {
    for case in cases() {
        let mechanism = case.mechanism();
        let (mut worst_oracle, mut worst_own, mut worst_plant) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (single, double) in case.workspace() {
            let columns = (case.pose)(single).unwrap().columns;
            let rows = mechanism.jacobian(double);
            for joint in 0..case.joints {
                let slope = |step: f64, place: &dyn Fn(Triple) -> Triple| -> Triple {
                    let [ahead, behind] = [step, -step].map(|h| place(turned(double, joint, h)));
                    core::array::from_fn(|i| (ahead[i] - behind[i]) / (2.0 * step))
                };
                let oracle = slope(1e-5, &|angles| mechanism.position(angles));
                // In f32 the step is as large as 4e-3 rad, a power of two, lest the place's rounding drown it: 3e-8 m
                // over twice that is 4e-6 m/rad; and one more power of it, extrapolated, takes the truncation away.
                let own = |step| {
                    slope(step, &|angles: Triple| (case.pose)(angles.map(|angle| angle as f32)).unwrap().position)
                };
                let (coarse, fine) = (own(1.0 / 128.0), own(1.0 / 256.0));
                let own: Triple = core::array::from_fn(|i| (4.0 * fine[i] - coarse[i]) / 3.0);
                worst_oracle = worst_oracle.max(distance(columns[joint], oracle));
                worst_own = worst_own.max(distance(columns[joint], own));
                worst_plant = worst_plant.max(distance(rows.map(|row| row[joint]), oracle));
            }
        }
        println!(
            "{}: Jacobian to {worst_oracle:.1e} m/rad of the plant's differences, {worst_own:.1e} of its own; the plant's own to {worst_plant:.1e}",
            case.name
        );
        // What is asked for is 1e-4; roundings leave ten to a hundred times less.
        assert!(worst_oracle < 3e-6 && worst_own < 1e-4, "{}: {worst_oracle:e} {worst_own:e}", case.name);
        // Steps of 1e-5 truncate at 1e-10 of the third derivative, and round at 1e-16 / 1e-5.
        assert!(worst_plant < 1e-8, "{}: {worst_plant:e}", case.name);
    }
}

#[test]
fn transposed_jacobian_does_the_work_of_the_force() {
    for case in cases() {
        let mechanism = case.mechanism();
        let force = case.force();
        for (single, double) in case.workspace() {
            let columns = (case.pose)(single).unwrap().columns;
            // A small motion of all joints at once; the probe's displacement from the simulated mechanism.
            let turn: Triple = [0.7e-5, -1.1e-5, 0.4e-5];
            let joints = |joint: usize| if joint < case.joints { turn[joint] } else { 0.0 };
            let place = |sign: f64| mechanism.position(core::array::from_fn(|j| double[j] + sign * joints(j)));
            let (ahead, behind) = (place(0.5), place(-0.5));
            let work: f64 = (0..3).map(|i| force[i] * (ahead[i] - behind[i])).sum();
            let torque = |joint: usize| (0..3).map(|i| columns[joint][i] * force[i]).sum::<f64>();
            let expected: f64 = (0..case.joints).map(|joint| torque(joint) * joints(joint)).sum();
            // The columns err by 3e-6 m/rad at most, over 2.2e-5 rad and 1 N.
            assert!((work - expected).abs() < 6.6e-11, "{} {single:?}: {work:e} {expected:e}", case.name);
        }
    }
}

/// The least singular value, by a search over unit joint rates, and so from above.
fn least_singular_value(columns: [Triple; 3], joints: usize) -> f64 {
    let mut least = f64::INFINITY;
    for n in 0..20_000 {
        let (turn, tilt) = (f64::from(n) * 2.399_963, 1.0 - 2.0 * (f64::from(n) + 0.5) / 20_000.0);
        let across = (1.0 - tilt * tilt).sqrt();
        let rates = match joints {
            1 => [1.0, 0.0, 0.0],
            2 => [turn.cos(), turn.sin(), 0.0],
            _ => [across * turn.cos(), across * turn.sin(), tilt],
        };
        let speed = (0..3).map(|i| (0..3).map(|j| columns[j][i] * rates[j]).sum::<f64>().powi(2)).sum::<f64>();
        least = least.min(speed.sqrt());
    }
    least
}

#[test]
fn margin_bounds_the_least_singular_value_from_below() {
    for case in cases() {
        let mut ratio: (f64, f64) = (1.0, 0.0);
        for (single, _) in case.workspace().into_iter().step_by(17) {
            let pose = (case.pose)(single).unwrap();
            let least = least_singular_value(pose.columns, case.joints);
            assert!(pose.margin <= least * (1.0 + 1e-6), "{} {single:?}: {} {least}", case.name, pose.margin);
            ratio = (ratio.0.min(pose.margin / least), ratio.1.max(pose.margin / least));
        }
        println!("{}: margin is {:.2} to {:.2} of the least singular value", case.name, ratio.0, ratio.1);
        // The bound is a third of it where one singular value is very large, all of it where all are alike.
        assert!(ratio.0 > 0.3, "{}: {ratio:?}", case.name);
    }
}

#[test]
fn what_cannot_be_closed_or_is_stretched_out_is_outside() {
    // The rod to the crank is 190 mm, the elbow and its other end 136 mm apart, and the short rod 34 mm.
    assert!(POLHEM_V2.kinematics.pose([0.0, 2.4, 1.0]).is_none());
    assert!(!POLHEM_V2.in_workspace([0.0, 2.4, 1.0]));
    // Cranks in line with the pivots, rods all but in line: 178 mm between elbows, 180 mm of rods. It closes, but
    // barely moves.
    assert!(HAPLY_2DIY_V3.kinematics.pose([PI, 0.0]).unwrap().position.is_finite());
    assert!(!HAPLY_2DIY_V3.in_workspace([PI, 0.0]));
    // One knee out, two in: no plate fits.
    assert!(NOVINT_FALCON.kinematics.pose([-1.5, 3.0, 3.0]).is_none());
    for case in cases() {
        for joint in 0..case.joints {
            for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 9.0] {
                let (mut angles, _) = case.workspace()[0];
                angles[joint] = bad;
                assert!(!(case.in_workspace)(angles), "{} {angles:?}", case.name);
            }
        }
    }
}

#[test]
fn no_angles_make_a_map_panic_and_all_or_nothing_is_finite() {
    let values = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e9, -1e9, 0.0, -0.0, 1.5, -3.0, 6.0];
    for case in cases() {
        for n in 0..values.len().pow(3) {
            let pick = |power: u32| values[n / values.len().pow(power) % values.len()];
            let Some(pose) = (case.pose)([pick(0), pick(1), pick(2)]) else { continue };
            let finite = pose.position.iter().chain(pose.columns.iter().flatten()).all(|entry| entry.is_finite());
            assert!(finite || pose.margin == 0.0, "{}", case.name);
        }
    }
}

#[test]
fn the_delta_s_inverse_undoes_its_forward_map_to_rounding() {
    let delta = NOVINT_FALCON.kinematics;
    let (mut worst, mut count) = (0.0_f32, 0);
    for n in 0..21 * 21 * 21 {
        let place = [n % 21, n / 21 % 21, n / 441].map(|index| (index as f32 - 10.0) * 0.005);
        let place = vec3(place[0], place[1], place[2]);
        if place.length() > 0.05 {
            continue;
        }
        let pose: ProbePose<3> = delta.pose(delta.angles(place).expect("within reach")).unwrap();
        worst = worst.max((pose.position - place).length());
        count += 1;
    }
    println!("Novint Falcon: forward undoes inverse to {worst:.1e} m at {count} places");
    // Angles err by 3e-7 rad and by roundings of a ratio, stretched by up to 0.1 m/rad; lengths of 0.17 m round at
    // 1.5e-8.
    assert!(count > 4_000 && worst < 3e-7, "{worst:e} m at {count} places");
    assert_eq!(delta.angles(vec3(0.0, 0.0, 0.2)), None);
    assert_eq!(delta.angles(vec3(f32::NAN, 0.0, 0.0)), None);
}
