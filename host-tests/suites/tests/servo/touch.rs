//! Pressing on surfaces with every device of three joints: steady force, no limit cycle; and no kick.

use crate::surfaces::{Cap, WALL, table1c};
use palpate::device::presets::{NOVINT_FALCON, PHANTOM_PREMIUM, POLHEM_V2, WOODEN_HAPTICS_2016};
use palpate::device::{Counts, Device, Kinematics, SerialArm};
use palpate::math::{Vec3, vec3};
use palpate::patch::Patch;
use palpate::render::{Coupling, Friction};
use palpate::servo::{Config, Input, OnePatch, PatchWitness, Phase, Rendering, Servo, ServoState, Settings, Surface};
use palpate::track::{Contact, Controller, Probe, Witness};
use palpate_sim::plant::{HandPath, HandSettings, Plant, PlantSettings, Vector};

const RATE: f64 = 4_000.0;

/// Comes down along a normal in 0.4 s, from 4 mm above, and holds.
pub struct Press {
    pub point: Vector,
    pub normal: Vector,
    pub depth: f64,
}

impl Press {
    fn height(&self, time: f64) -> (f64, f64) {
        let share = (time / 0.4).clamp(0.0, 1.0);
        let (bend, slope) = (share * share * (3.0 - 2.0 * share), 6.0 * share * (1.0 - share) / 0.4);
        let way = 0.004 + self.depth;
        (0.004 - way * bend, -way * slope)
    }
}

impl HandPath for Press {
    fn target(&self, time: f64) -> Vector {
        core::array::from_fn(|axis| self.point[axis] + self.normal[axis] * self.height(time).0)
    }
    fn velocity(&self, time: f64) -> Vector {
        self.normal.map(|entry| entry * self.height(time).1)
    }
}

fn wide(vector: Vec3) -> Vector {
    vector.to_array().map(f64::from)
}

/// Solves `Jᵀ F = τ` by Cramer's rule.
fn force_of(jacobian: [[f64; 3]; 3], torques: Vector) -> Vector {
    let column = |joint: usize| [jacobian[0][joint], jacobian[1][joint], jacobian[2][joint]];
    let cross =
        |a: Vector, b: Vector| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let [a, b, c] = [column(0), column(1), column(2)];
    let determinant: f64 = (0..3).map(|i| a[i] * cross(b, c)[i]).sum();
    let parts = [cross(b, c), cross(c, a), cross(a, b)];
    core::array::from_fn(|i| (0..3).map(|joint| torques[joint] * parts[joint][i]).sum::<f64>() / determinant)
}

struct Held {
    /// Mean motor force along the normal over stiffness × mean depth.
    ratio: f64,
    /// The widest swing of a joint, counts.
    swing: i32,
    depth: f64,
    force: f64,
}

/// A device beside its plant.
struct Bench<K: 'static> {
    name: &'static str,
    device: &'static Device<K, 3>,
    plant: PlantSettings,
    /// What the hand presses with, N, about: so deep that a count is well below 2 % of it.
    push: f64,
}

const WOODEN_HAPTICS: Bench<SerialArm> = Bench {
    name: "WoodenHaptics 2016",
    device: &WOODEN_HAPTICS_2016,
    plant: PlantSettings::wooden_haptics_2016(),
    push: 3.2,
};

/// Presses at a place of a patch for 1.6 s and looks at the last 0.4 s.
fn press<S: Surface<Witness = PatchWitness>, K: Kinematics<3>>(
    bench: &Bench<K>,
    surface: &S,
    patch: &impl Patch,
    settings: Settings,
    rendering: Rendering,
    [u, v]: [f32; 2],
    aim: f64,
) -> Held {
    let servo = Servo::new(bench.device, surface, Config { settings, rendering, ..Config::DEFAULT });
    let witness = Witness::at(patch, u, v);
    let normal = witness.normal(patch).unwrap();
    let origin = settings.body_origin_m;
    let path = Press { point: wide(witness.surface.point + origin), normal: wide(normal), depth: aim };
    // Two fifths of the plant's own; a long run takes more.
    let device = bench.plant.in_sub_steps(4);
    let mut plant = Plant::new(&device, HandSettings::default(), Box::new(path), RATE).unwrap();
    let mut state = servo.start();
    let (mut lowest, mut highest) = ([i32::MAX; 3], [i32::MIN; 3]);
    let (mut force, mut depth, mut oracle) = (0.0, 0.0, witness);
    const TICKS: usize = 6_400;
    const LAST: usize = 1_600;
    for tick in 0..TICKS {
        let counts = plant.counts();
        let _ = servo.tick(&mut state, Input::Sensors { counts: counts.map(Counts), enable: true });
        assert_eq!(state.fault(), None);
        plant.advance(state.duties().map(|duty| duty.0));
        if tick < TICKS - LAST {
            continue;
        }
        assert_eq!((state.phase(), state.contact()), (Phase::Running, Contact::Touching));
        for joint in 0..3 {
            lowest[joint] = lowest[joint].min(counts[joint]);
            highest[joint] = highest[joint].max(counts[joint]);
        }
        // From the plant's own currents, weight and Jacobian, and the true place of the probe: what the motors give
        // beyond the weight they carry is the surface's.
        let angles = plant.angles();
        let motors = device.motors();
        let weight = plant.mechanism().gravity_torques(angles);
        let torques =
            core::array::from_fn(|joint| plant.currents()[joint] * motors[joint].torque_per_ampere + weight[joint]);
        let motor_force = force_of(plant.mechanism().jacobian(angles), torques);
        let place = plant.position().map(|entry| entry as f32);
        let place = vec3(place[0], place[1], place[2]) - origin;
        for _ in 0..30 {
            Controller::SecondOrder.step(patch, &mut oracle, Probe::at(place), 0.0);
        }
        let normal = oracle.normal(patch).unwrap();
        force += (0..3).map(|axis| motor_force[axis] * wide(normal)[axis]).sum::<f64>() / LAST as f64;
        depth += f64::from((oracle.surface.point - place).dot(normal)) / LAST as f64;
    }
    let swing = (0..3).map(|joint| highest[joint] - lowest[joint]).max().unwrap();
    Held { ratio: force / (f64::from(settings.stiffness_n_per_m) * depth), swing, depth, force }
}

/// Presses on a wall, a cap and table1c at [`PLACES`], with the stiffness and damping that the preset recommends at
/// most, and with softer ones in the middle.
fn touches_cleanly<K: Kinematics<3>>(bench: &Bench<K>, softer: &[(f32, f32)]) {
    let recommended = (bench.device.max_stiffness_n_per_m, bench.device.max_damping_n_s_per_m);
    let presses =
        PLACES.iter().map(|place| (*place, recommended)).chain(softer.iter().map(|gains| (PLACES[0], *gains)));
    let table = table1c();
    let cap = Cap { radius: 0.06 };
    let base = Settings {
        rate_hz: RATE as f32,
        stiffness_n_per_m: 0.0,
        damping_n_s_per_m: 0.0,
        max_force_n: f32::MAX,
        velocity_corner_hz: 200.0,
        soft_start_s: 0.1,
        body_origin_m: Vec3::ZERO,
    };
    // The middle of table1c, 8 cm by 10 cm by 6.5 cm, at the middle of the workspace.
    let middle = Settings { body_origin_m: vec3(-0.05, -0.05, -0.065), ..base };
    let mut worst: f64 = 0.0;
    println!(
        "{}\n{:<10}{:>10}{:>10}{:>12}{:>12}{:>10}{:>8}",
        bench.name, "surface", "K, N/m", "B, N·s/m", "depth, mm", "force, N", "ratio", "swing"
    );
    for (place, (stiffness, damping)) in presses {
        {
            // What the wall yields and what the hand does.
            let aim = bench.push / f64::from(stiffness) + bench.push / HandSettings::default().stiffness;
            let gains = |settings| Settings { stiffness_n_per_m: stiffness, damping_n_s_per_m: damping, ..settings };
            for (name, held) in [
                ("wall", press(bench, &WALL, &WALL, gains(base), Rendering::PLAIN, place, aim)),
                ("cap", press(bench, &OnePatch(cap), &cap, gains(base), Rendering::PLAIN, place, aim)),
                ("table1c", press(bench, &table, &table, gains(middle), Rendering::PLAIN, place, aim)),
            ] {
                println!(
                    "{name:<10}{stiffness:>10}{damping:>10}{:>12.3}{:>12.3}{:>10.4}{:>8}",
                    held.depth * 1e3,
                    held.force,
                    held.ratio,
                    held.swing
                );
                worst = worst.max((held.ratio - 1.0).abs());
                assert!((held.ratio - 1.0).abs() < 0.02, "{name} {place:?}: {}", held.ratio);
                assert!(held.swing <= 2, "{name} {place:?}: {} counts", held.swing);
            }
        }
    }
    println!("worst deviation {:.2} %", worst * 100.0);
}

/// Places on each surface.
const PLACES: [[f32; 2]; 4] = [[0.5, 0.5], [0.3, 0.6], [0.7, 0.4], [0.4, 0.3]];

#[test]
fn wooden_haptics_presses_with_stiffness_times_depth_and_no_limit_cycle() {
    touches_cleanly(&WOODEN_HAPTICS, &[(600.0, 2.0), (1_000.0, 2.0)]);
}

#[test]
fn polhem_presses_with_stiffness_times_depth_and_no_limit_cycle() {
    let bench = Bench { name: "Polhem v2", device: &POLHEM_V2, plant: PlantSettings::polhem_v2(), push: 4.0 };
    touches_cleanly(&bench, &[(1_000.0, 2.0)]);
}

#[test]
fn phantom_presses_with_stiffness_times_depth_and_no_limit_cycle() {
    let plant = PlantSettings::phantom_premium();
    let bench = Bench { name: "Phantom Premium", device: &PHANTOM_PREMIUM, plant, push: 4.0 };
    touches_cleanly(&bench, &[(500.0, 2.0)]);
}

#[test]
fn falcon_presses_with_stiffness_times_depth_and_no_limit_cycle() {
    // Friction takes 1 to 3 N of the hand's push.
    let bench =
        Bench { name: "Novint Falcon", device: &NOVINT_FALCON, plant: PlantSettings::novint_falcon(), push: 8.0 };
    touches_cleanly(&bench, &[(1_000.0, 2.0)]);
}

#[test]
fn through_a_virtual_coupling_both_springs_share_the_depth() {
    let settings = Settings { stiffness_n_per_m: 1_000.0, ..crate::traces::SETTINGS };
    let coupling = Coupling { stiffness_n_per_m: 1_500.0, damping_n_s_per_m: 3.0, mass_kg: 0.02 };
    let friction = Friction {
        stiffness_n_per_m: 500.0,
        damping_n_s_per_m: 1.0,
        static_coefficient: 0.4,
        dynamic_coefficient: 0.3,
    };
    for friction in [None, Some(friction)] {
        let rendering = Rendering { coupling: Some(coupling), friction, ..Rendering::PLAIN };
        let held = press(&WOODEN_HAPTICS, &WALL, &WALL, settings, rendering, [0.5, 0.5], 0.016);
        println!("depth {:.3} mm, force {:.3} N, {} counts", held.depth * 1e3, held.force, held.swing);
        // In series: 1,500 / 2,500 of the wall's stiffness, to the 2 % that hold without a coupling.
        assert!((held.ratio / 0.6 - 1.0).abs() < 0.02 && held.swing <= 2, "{} {}", held.ratio, held.swing);
    }
}

/// The greatest speed of the probe, m/s, and the greatest growth of the force in a tick, N, once force is asked for 5
/// mm inside the wall.
fn enabled_inside(soft_start: f32) -> (f64, f32) {
    let settings = Settings {
        rate_hz: RATE as f32,
        stiffness_n_per_m: 1_000.0,
        damping_n_s_per_m: 2.0,
        max_force_n: 5.0,
        velocity_corner_hz: 200.0,
        soft_start_s: soft_start,
        body_origin_m: Vec3::ZERO,
    };
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings, ..Config::DEFAULT });
    let path = Press { point: [0.0; 3], normal: [0.0, 0.0, 1.0], depth: 0.004 };
    let device = PlantSettings::wooden_haptics_2016();
    let mut plant = Plant::new(&device, HandSettings::default(), Box::new(path), RATE).unwrap();
    let mut state = servo.start();
    let (mut speed, mut growth, mut last) = (0.0_f64, 0.0_f32, 0.0);
    for tick in 0..6_000 {
        let enable = tick >= 3_000;
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable });
        plant.advance(state.duties().map(|duty| duty.0));
        if enable {
            assert!(tick > 3_000 || state.gap() < -0.003, "the probe is inside: {}", state.gap());
            speed = speed.max(plant.velocity().iter().map(|v| v * v).sum::<f64>().sqrt());
            let force = state.force().length();
            growth = growth.max(force - last);
            last = force;
        }
    }
    assert!(last > 0.5, "it pushes in the end: {last} N");
    (speed, growth)
}

#[test]
fn force_asked_for_inside_the_wall_does_not_kick() {
    let (soft_speed, soft_growth) = enabled_inside(0.2);
    let (hard_speed, hard_growth) = enabled_inside(0.0);
    println!(
        "soft start: {soft_speed:.3} m/s, {soft_growth:.4} N a tick; none: {hard_speed:.3} m/s, {hard_growth:.2} N a tick"
    );
    // 5 N over 800 ticks, and what one count at 1,000 N/m and 2 N·s/m of filtered velocity adds: 0.06 + 0.11 N.
    assert!(soft_growth < 5.0 / 800.0 + 0.17, "{soft_growth}");
    // The hand's 300 N/m yield as the force grows, 5 N in 0.2 s, and with it what carries the links, up to 0.6 N at the
    // probe, and no faster: 93 mm/s.
    assert!(soft_speed < 0.093, "{soft_speed}");
    assert!(hard_growth > 3.0 && hard_speed > 3.0 * soft_speed, "the test sees a kick");
}

/// A probe that begins inside feels nothing until it has been in front, whatever the settings.
#[test]
fn a_start_inside_the_wall_gives_no_force() {
    let settings = Settings { soft_start_s: 0.0, ..crate::traces::SETTINGS };
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings, ..Config::DEFAULT });
    let mut state: ServoState<3> = servo.start();
    // 6 mm under the wall at the middle of the workspace.
    for _ in 0..100 {
        let _ = servo.tick(
            &mut state,
            Input::Sensors { counts: [Counts(0), Counts(-1_314), Counts(3_465 + 160)], enable: true },
        );
    }
    assert!(state.gap() < -0.004 && state.phase() == Phase::Running, "{state:?}");
    assert_eq!(state.force(), Vec3::ZERO);
}

#[test]
fn the_state_is_small() {
    // What a board has to keep in RAM; most of it is the witness point, what the estimators remember, homing and the
    // watch over stuck sensors. 36 bytes of it are the second derivatives at the witness point: with them each step is
    // of second order at one evaluation. 8 are a word of the tables on its way into their CRC: with it no tick has to
    // both read and reckon.
    println!("{} bytes", size_of::<ServoState<3>>());
    assert!(size_of::<ServoState<3>>() <= 684);
}
