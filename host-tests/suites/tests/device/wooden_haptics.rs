//! The library's WoodenHaptics preset, in f32, against the simulated device, in f64 and written apart from it.

use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
use palpate::device::{Counts, Duty, Kinematics, ProbePose};
use palpate::math::{Vec3, vec3};
use palpate_sim::plant::{Arm, HandPath, HandSettings, Plant, PlantSettings, StillHand};

fn arm() -> Arm {
    PlantSettings::wooden_haptics_2016().arm(0.0)
}

fn to_f64(vector: Vec3) -> [f64; 3] {
    [f64::from(vector.x), f64::from(vector.y), f64::from(vector.z)]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt()
}

/// Joint angles over the ball of 100 mm that the driver states as the workspace, as f32 and the very same as f64.
fn workspace() -> impl Iterator<Item = ([f32; 3], [f64; 3])> {
    (0..21 * 21 * 21).filter_map(|n| {
        let place = [n % 21, n / 21 % 21, n / 441].map(|index| (f64::from(index) - 10.0) * 0.01);
        if distance(place, [0.0; 3]) > 0.1 {
            return None;
        }
        let angles = arm().angles(place).expect("the workspace is within reach").map(|angle| angle as f32);
        Some((angles, angles.map(f64::from)))
    })
}

#[test]
fn the_workspace_lies_within_the_joint_range() {
    let mut count = 0;
    for (angles, _) in workspace() {
        for (angle, [least, most]) in angles.into_iter().zip(DEVICE.joint_range_rad) {
            assert!((least..most).contains(&angle), "{angles:?}");
        }
        count += 1;
    }
    // Grid points in a ball of ten steps: 4/3 π 10³.
    assert!((4_000..4_300).contains(&count), "{count}");
}

#[test]
fn forward_map_agrees_with_the_simulated_arm() {
    let mut worst: f64 = 0.0;
    for (single, double) in workspace() {
        worst = worst.max(distance(to_f64(DEVICE.kinematics.pose(single).unwrap().position), arm().position(double)));
    }
    // sin and cos err by 1.2e-7 each: 0.45 m of links twice over gives 1.1e-7 m; five roundings of lengths under 0.5 m
    // 0.8e-7. The finest encoder step is 43 µm.
    assert!(worst < 2e-7, "{worst:e} m");
}

#[test]
fn jacobian_agrees_with_central_differences_of_the_forward_map() {
    let mut worst: f64 = 0.0;
    for (single, double) in workspace() {
        let columns = DEVICE.kinematics.pose(single).unwrap().jacobian;
        for joint in 0..3 {
            let place = |step: f64| {
                let mut angles = double;
                angles[joint] += step;
                arm().position(angles)
            };
            let (ahead, behind) = (place(1e-5), place(-1e-5));
            let slope = core::array::from_fn(|i| (ahead[i] - behind[i]) / 2e-5);
            worst = worst.max(distance(to_f64(columns[joint]), slope));
        }
    }
    // As for the forward map; the difference itself errs by step²/6 × 0.45 m = 1e-11 and rounding 1e-11.
    assert!(worst < 2e-7, "{worst:e} m/rad");
}

#[test]
fn transposed_jacobian_does_the_work_of_the_force() {
    let force = vec3(1.3, -2.1, 0.7);
    for (single, double) in workspace() {
        let torques = DEVICE.kinematics.pose(single).unwrap().torques(force).map(f64::from);
        // A small motion of all joints at once; the probe's displacement from the simulated arm.
        let turn = [0.7e-5, -1.1e-5, 0.4e-5];
        let place = |sign: f64| arm().position(core::array::from_fn(|joint| double[joint] + sign * turn[joint]));
        let (ahead, behind) = (place(0.5), place(-0.5));
        let work: f64 = (0..3).map(|i| to_f64(force)[i] * (ahead[i] - behind[i])).sum();
        let expected: f64 = (0..3).map(|joint| torques[joint] * turn[joint]).sum();
        // Columns err by 2e-7 m/rad, so torques by 2e-7 × 2.6 N and some roundings: 1e-6 N·m over 2.2e-5 rad.
        assert!((work - expected).abs() < 2.2e-11, "{single:?}: {work:e} {expected:e}");
    }
}

#[test]
fn velocity_is_the_jacobian_times_the_rates() {
    let pose: ProbePose<3> = DEVICE.kinematics.pose([0.3, 0.4, 0.9]).unwrap();
    let rates = [1.5, -0.5, 2.0];
    let jacobian = arm().jacobian([0.3_f32, 0.4, 0.9].map(f64::from));
    let expected = jacobian.map(|row| (0..3).map(|joint| row[joint] * f64::from(rates[joint])).sum());
    // 2e-7 m/rad × 4 rad/s and a few roundings of 0.5 m/s.
    assert!(distance(to_f64(pose.velocity(rates)), expected) < 1e-6);
}

/// What the library makes of the simulated encoders.
fn pose(plant: &Plant) -> ProbePose<3> {
    let counts = plant.counts();
    let angles = core::array::from_fn(|joint| DEVICE.encoders[joint].angle(Counts(counts[joint])));
    DEVICE.kinematics.pose(angles).unwrap()
}

/// The library's duties for a force at the probe.
fn duties(pose: &ProbePose<3>, force: Vec3) -> [i16; 3] {
    let torques = pose.torques(force);
    core::array::from_fn(|joint| Duty::from_fraction(DEVICE.motors[joint].fraction(torques[joint])).0)
}

fn plant(settings: &PlantSettings, hand: HandSettings, path: impl HandPath + 'static) -> Plant {
    Plant::new(settings, hand, Box::new(path), 4_000.0).unwrap()
}

fn without_friction_and_gravity() -> PlantSettings {
    let mut settings = PlantSettings { gravity: 0.0, ..PlantSettings::wooden_haptics_2016() };
    for joint in &mut settings.joints {
        (joint.viscous_friction, joint.coulomb_friction) = (0.0, 0.0);
    }
    settings
}

#[test]
fn encoders_tell_the_probe_s_place_to_a_count() {
    for place in [[0.0, 0.0, 0.0], [0.06, 0.05, -0.04], [-0.05, -0.07, 0.03], [0.03, -0.02, -0.08]] {
        let plant = plant(&PlantSettings::wooden_haptics_2016(), HandSettings::NONE, StillHand(place));
        let lag = distance(to_f64(pose(&plant).position), place);
        // Each joint lags by less than a count: reach (0.3 m at most), 0.205 m and 0.245 m per radian.
        let count = std::f64::consts::TAU / 2_000.0;
        assert!(lag < count * (0.3 / 16.0 + 0.205 / 12.0 + 0.245 / 12.0), "{place:?}: {lag} m");
    }
}

#[test]
fn a_commanded_force_accelerates_the_probe_as_the_mass_matrix_says() {
    for place in [[0.0, 0.0, 0.0], [0.04, 0.06, -0.05], [-0.04, -0.06, 0.05]] {
        for axis in 0..6 {
            let sign = if axis < 3 { 1.0 } else { -1.0 };
            let mut force = [0.0_f32; 3];
            force[axis % 3] = sign;
            let force = vec3(force[0], force[1], force[2]);
            let mut plant = plant(&without_friction_and_gravity(), HandSettings::NONE, StillHand(place));
            let angles = plant.angles();
            let command = duties(&pose(&plant), force);
            (0..20).for_each(|_| plant.advance(command));
            assert!(f64::from(sign) * plant.velocity()[axis % 3] > 0.0, "{place:?} {force:?}");

            // Joint rates `q̇ = M⁻¹ Jᵀ F t`, checked as `M q̇ = Jᵀ F t`, joint by joint, so that no joint can hide.
            let (mass, jacobian) = (arm().mass_matrix(angles), arm().jacobian(angles));
            // 20 periods, less the period of delay and the 0.15 ms of the current loop.
            let time = 19.0 / 4_000.0 - 1.5e-4;
            let impulses = [0, 1, 2].map(|joint| {
                let momentum: f64 = (0..3).map(|other| mass[joint][other] * plant.rates()[other]).sum();
                let impulse: f64 = (0..3).map(|i| jacobian[i][joint] * to_f64(force)[i]).sum::<f64>() * time;
                (momentum, impulse)
            });
            for (momentum, impulse) in impulses {
                // In 5 ms, 1 N on some 0.1 kg moves the probe by 0.1 mm and the Jacobian turns by 1e-3; a count and the
                // duty's step are smaller. 1 % of the largest impulse there can be (0.3 m × 1 N × time).
                assert!((momentum - impulse).abs() < 0.01 * 0.3 * time, "{place:?} {force:?}: {impulses:?}");
            }
        }
    }
}

#[test]
fn a_spring_rendered_by_the_library_pulls_the_probe_home() {
    // Everything on: gravity, friction, delay, quantisation. A wrong direction anywhere drives the probe away.
    let mut plant = plant(&PlantSettings::wooden_haptics_2016(), HandSettings::NONE, StillHand([0.006, -0.008, 0.005]));
    let (stiffness, damping) = (400.0, 4.0);
    let mut last = pose(&plant).position;
    let mut velocity = Vec3::ZERO;
    for _ in 0..4_000 {
        let pose = pose(&plant);
        // A low-pass of about 100 Hz.
        velocity += 0.15 * ((pose.position - last) * 4_000.0 - velocity);
        last = pose.position;
        plant.advance(duties(&pose, pose.position * -stiffness - velocity * damping));
    }
    let away = distance(plant.position(), [0.0; 3]);
    // At rest the spring holds the links' weight, under 1 N, and dry friction, 0.01 N·m at 0.2 m or so: 2.6 mm.
    assert!(away < 2.6e-3, "{:?}", plant.position());
    assert!(plant.rates().iter().all(|rate| rate.abs() < 0.05), "it settles: {:?}", plant.rates());
}
