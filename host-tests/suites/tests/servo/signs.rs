//! Signs that are wrong are found and signs that are right are not called wrong, whoever holds the device.

use crate::protected::{Bench, FALCON, PHANTOM, POLHEM, RATE, WOODEN_HAPTICS, settings};
use crate::surfaces::{WALL, table1c};
use palpate::device::drive::{Feed, VoltageFeed};
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Counts, Device, Duty, Kinematics, SerialArm};
use palpate::math::{Vec3, vec3};
use palpate::servo::recommended::{self, Recommended};
use palpate::servo::{Config, Fault, Input, Servo};
use palpate::track::Witness;
use palpate_sim::plant::{
    Amplifier, Direction, HandPath, HandSettings, Plant, PlantSettings, TouchingPath, TouchingSettings, Vector, Winding,
};
use rand::{Rng as _, SeedableRng as _};

/// From the beginning of one approach to the next, s.
const APPROACH: f64 = 0.8;
/// How high an approach begins, m.
const HEIGHT: f64 = 0.01;
/// How deep it aims, m.
const DEPTH: f64 = 0.01;

/// Comes straight down, presses, goes back, and again.
struct Approaches {
    speed: f64,
}

impl Approaches {
    fn phase(&self, time: f64) -> (f64, f64) {
        let (time, down) = (time % APPROACH, (HEIGHT + DEPTH) / self.speed);
        if time < down {
            (HEIGHT - self.speed * time, -self.speed)
        } else if time < APPROACH - 0.2 {
            (-DEPTH, 0.0)
        } else {
            let back = (HEIGHT + DEPTH) / 0.2;
            (-DEPTH + back * (time - (APPROACH - 0.2)), back)
        }
    }
}

impl HandPath for Approaches {
    fn target(&self, time: f64) -> Vector {
        [0.0, 0.0, self.phase(time).0]
    }
    fn velocity(&self, time: f64) -> Vector {
        [0.0, 0.0, self.phase(time).1]
    }
}

fn difference(from: Vector, to: Vector) -> Vector {
    [0, 1, 2].map(|axis| to[axis] - from[axis])
}

fn length(vector: Vector) -> f64 {
    vector.iter().map(|each| each.powi(2)).sum::<f64>().sqrt()
}

/// A plant with the motors of some joints turned round. Eight steps a tick: knocks take milliseconds.
fn turned(plant: &PlantSettings, wrong: &[bool; 3]) -> PlantSettings {
    let mut plant = plant.in_sub_steps(4);
    for (joint, wrong) in plant.joints.iter_mut().zip(wrong) {
        if *wrong {
            let way = &mut joint.motor_direction;
            *way = if *way == Direction::With { Direction::Against } else { Direction::With };
        }
    }
    plant
}

/// What wrong motors did until they were given nothing more.
#[derive(Clone, Copy, Debug, Default)]
struct Harm {
    /// The longest time that a wrong motor was driven without a stop, ms.
    time: f64,
    /// How far the probe was moved by all motors meanwhile, mm.
    way: f64,
    /// How far it was ever moved by them, mm.
    in_all: f64,
    /// In which approach it was told.
    told: Option<usize>,
}

/// The force at a probe that is held, N, of these duties: `F` with `Jᵀ F = τ`, by Cramer's rule.
fn pressed<K: Kinematics<3>>(bench: &Bench<K>, angles: [f32; 3], duties: [Duty; 3]) -> f64 {
    let columns = bench.device.kinematics.pose(angles).unwrap().jacobian.map(|column| column.to_array().map(f64::from));
    let torque = |joint: usize| f64::from(duties[joint].fraction() * bench.device.motors[joint].torque_at_full_n_m);
    let cross = |[a, b, c]: Vector, [x, y, z]: Vector| [b * z - c * y, c * x - a * z, a * y - b * x];
    let [a, b, c] = columns;
    let normals = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant: f64 = (0..3).map(|axis| a[axis] * normals[0][axis]).sum();
    length([0, 1, 2].map(|axis| (0..3).map(|joint| torque(joint) * normals[joint][axis]).sum::<f64>() / determinant))
}

/// Signs that are turned round in the plant, and a hand that comes twice. The links are carried, as they are by
/// default: by no motor that was not seen to push the right way.
fn runs_away<K: Kinematics<3>>(bench: &Bench<K>, wrong: [bool; 3], speed: f64) -> Harm {
    let servo = Servo::protected(
        bench.device,
        &WALL,
        bench.protection,
        Config { settings: settings(bench.device, Vec3::ZERO), ..Config::DEFAULT },
    );
    let plant = turned(&bench.plant, &wrong);
    let [mut plant, mut free] =
        [(); 2].map(|()| Plant::new(&plant, HandSettings::default(), Box::new(Approaches { speed }), RATE).unwrap());
    let mut state = servo.start();
    let mut harm = Harm::default();
    // Since when a wrong motor is driven, and how far the motors had moved the probe by then.
    let mut since: Option<(usize, Vector)> = None;
    for tick in 0..(2.0 * APPROACH * RATE) as usize {
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
        if let Some((fault, _)) = state.fault() {
            assert_eq!(fault, Fault::WrongPolarity, "{} {wrong:?} {speed}", bench.name);
            harm.told = harm.told.or(Some((tick as f64 / RATE / APPROACH) as usize));
            break;
        }
        let most = 0.25 * f64::from(bench.device.max_force_n);
        // The duty of a bridge is a voltage, whose torque goes with the rate.
        let is_torque = matches!(bench.device.feeds[0], Feed::Current);
        let pressed = if is_torque { pressed(bench, state.angles(), state.duties()) } else { 0.0 };
        let told = f64::from(state.force().length());
        assert!(told <= most && pressed <= most, "{} {wrong:?}: {told} N, {pressed} N", bench.name);
        // What the motors have moved the probe by, up to now: the other plant's hand is alone.
        let moved = difference(free.position(), plant.position());
        let is_driven = state.duties().iter().zip(wrong).any(|(duty, wrong)| wrong && duty.0 != 0);
        if let Some((first, before)) = since {
            harm.time = harm.time.max((tick - first) as f64 / RATE * 1e3);
            harm.way = harm.way.max(length(difference(before, moved)) * 1e3);
        }
        since = if is_driven { since.or(Some((tick, moved))) } else { None };
        harm.in_all = harm.in_all.max(length(moved) * 1e3);
        plant.advance(state.duties().map(|duty| duty.0));
        free.advance([0; 3]);
    }
    harm
}

/// WoodenHaptics with its motors on bridges, which give a voltage: of a joint that is wrong the back-EMF that is made up
/// for would brake the pulses.
fn on_bridges() -> Bench<SerialArm> {
    let mut device = *WOODEN_HAPTICS.device;
    let mut plant = WOODEN_HAPTICS.plant;
    for (joint, ratio) in [16.0, -12.0, 12.0].into_iter().enumerate() {
        let torque_constant = plant.joints[joint].torque_constant;
        assert_eq!(plant.joints[joint].ratio, f64::from(ratio).abs(), "the ratios of the plant");
        device.feeds[joint] = Feed::Voltage(VoltageFeed {
            supply_v: 24.0,
            full_fraction: 1.0,
            resistance_ohm: 0.61,
            torque_constant_n_m_per_a: torque_constant as f32,
            current_at_full_a: 3.0,
            ratio,
            back_emf_fraction: 0.8,
        });
        plant.joints[joint].amplifier =
            Amplifier::Voltage(Winding { supply: 24.0, resistance: 0.61, inductance: 1e-4 });
    }
    Bench { name: "on bridges", device: Box::leak(Box::new(device)), plant, ..WOODEN_HAPTICS }
}

fn every_wrong_sign<K: Kinematics<3>>(bench: &Bench<K>) -> Vec<Harm> {
    let mut all = Vec::new();
    for wrong in 1..8_u32 {
        let wrong = [0, 1, 2].map(|joint| wrong >> joint & 1 == 1);
        for speed in [0.05, 0.2] {
            let harm = runs_away(bench, wrong, speed);
            println!("{:<20} wrong {wrong:?}, met at {speed} m/s: {harm:.2?}", bench.name);
            // What must be: 10 ms, and 1 mm of the probe's way.
            assert!(harm.time <= 10.0 && harm.way <= 1.0, "{harm:?}");
            all.push(harm);
        }
    }
    all
}

#[test]
fn a_wrong_sign_is_stopped_within_ten_milliseconds_and_a_millimetre() {
    let all = [
        every_wrong_sign(&WOODEN_HAPTICS),
        every_wrong_sign(&POLHEM),
        every_wrong_sign(&PHANTOM),
        every_wrong_sign(&FALCON),
        every_wrong_sign(&on_bridges()),
    ]
    .concat();
    let most = |figure: fn(&Harm) -> f64| all.iter().map(figure).fold(0.0, f64::max);
    let told = [0, 1].map(|approach| all.iter().filter(|harm| harm.told == Some(approach)).count());
    println!(
        "{} wrong signs: driven for at most {:.2} ms, moved by {:.2} mm meanwhile, by {:.2} mm in all; told in the \
         first, second contact: {told:?}",
        all.len(),
        most(|harm| harm.time),
        most(|harm| harm.way),
        most(|harm| harm.in_all)
    );
    // None is only withheld, and all together stay below what nine knocks, three of each joint, come to.
    assert_eq!(told[0] + told[1], all.len());
    assert!(most(|harm| harm.in_all) < 3.0);
}

/// A hand that comes three times to a device as it is recommended: a force is felt, and the links are carried, neither
/// before all joints were seen.
fn as_recommended<K: Kinematics<3>>(bench: &Bench<K>, Recommended { settings, rendering }: Recommended) {
    let servo =
        Servo::protected(bench.device, &WALL, bench.protection, Config { settings, rendering, ..Config::DEFAULT });
    let path = Box::new(Approaches { speed: 0.1 });
    let mut plant = Plant::new(&bench.plant.in_sub_steps(4), HandSettings::default(), path, RATE).unwrap();
    let mut state = servo.start();
    let (mut most, mut carried) = (0.0_f32, [false; 2]);
    for _ in 0..(3.0 * APPROACH * RATE) as usize {
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
        assert_eq!(state.fault(), None, "{}", bench.name);
        let seen = state.guard().joints_seen() == [true; 3];
        most = most.max(state.force().length());
        carried[usize::from(seen)] |=
            state.force() == Vec3::ZERO && state.duties().iter().any(|duty| *duty != Duty::ZERO);
        plant.advance(state.duties().map(|duty| duty.0));
    }
    println!(
        "{:<20} as recommended: {most:.2} N, carries its links before and after it was seen: {carried:?}",
        bench.name
    );
    assert!(most > 0.5, "{}: {most} N", bench.name);
    let has_weight = bench.device.kinematics.held_pose(state.angles()).unwrap().1 != [0.0; 3];
    assert_eq!(carried, [false, has_weight], "{}", bench.name);
}

#[test]
fn a_force_that_is_eased_comes_too_once_all_joints_were_seen_and_so_does_the_weight() {
    as_recommended(&WOODEN_HAPTICS, recommended::WOODEN_HAPTICS_2016);
    as_recommended(&POLHEM, recommended::POLHEM_V2);
    as_recommended(&PHANTOM, recommended::PHANTOM_PREMIUM);
    as_recommended(&FALCON, recommended::NOVINT_FALCON);
}

/// A hand drawn from a seed.
struct Somebody {
    hand: HandSettings,
    touching: TouchingSettings,
    seed: u64,
}

fn somebody(seed: u64, stiffest: f64) -> Somebody {
    let mut random = rand_pcg::Pcg64::seed_from_u64(seed);
    let mut between = |low: f64, high: f64| low + (high - low) * (f64::from(random.next_u32()) / 4_294_967_296.0);
    let stiffness = 100.0 * (stiffest / 100.0).powf(between(0.0, 1.0));
    let mass = between(0.0, 0.25);
    // From a third of critical to critical, with a device of 0.1 kg.
    let damping = between(0.33, 1.0) * 2.0 * (stiffness * (mass + 0.1)).sqrt();
    let duration = between(3.0, 6.0);
    let touching = TouchingSettings {
        duration,
        touches: (duration * between(0.8, 1.4)) as u32,
        greatest_speed: 1.0,
        press_depth: [between(0.003, 0.008), between(0.008, 0.015)],
        pressed_reach: between(0.0, 1.0),
        ..TouchingSettings::default()
    };
    Somebody { hand: HandSettings { stiffness, damping, mass }, touching, seed }
}

/// What a touch of a curved patch by somebody comes to, with the share of ticks in contact before all joints were seen.
fn is_touched<K: Kinematics<3>>(bench: &Bench<K>, who: &Somebody, wrong: [bool; 3]) -> (Option<Fault>, [bool; 3], f64) {
    let table = table1c();
    let at = vec3(-0.05, -0.05, -0.065);
    let servo = Servo::protected(
        bench.device,
        &table,
        bench.protection,
        Config { settings: settings(bench.device, at), ..Config::DEFAULT },
    );
    let place = |u: f64, v: f64| {
        let witness = Witness::at(&table, (0.25 + 0.5 * u) as f32, (0.25 + 0.5 * v) as f32);
        let normal = witness.normal(&table).unwrap();
        ((witness.surface.point + at).to_array().map(f64::from), normal.to_array().map(f64::from))
    };
    let path = TouchingPath::new(place, who.touching, who.seed).unwrap();
    let mut plant = Plant::new(&turned(&bench.plant, &wrong), who.hand, Box::new(path), RATE).unwrap();
    let mut state = servo.start();
    let mut withheld = 0;
    for _ in 0..(who.touching.duration * RATE) as usize {
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
        let seen = state.guard().joints_seen();
        let touches = state.contact() == palpate::track::Contact::Touching;
        withheld += usize::from(touches && seen != [true; 3]);
        if let Some((fault, _)) = state.fault() {
            return (Some(fault), seen, withheld as f64 / RATE);
        }
        plant.advance(state.duties().map(|duty| duty.0));
    }
    (None, state.guard().joints_seen(), withheld as f64 / RATE)
}

/// How many of so many hands were called wrong, how many devices were never wholly seen, and the times until they were.
fn hands<K: Kinematics<3>>(bench: &Bench<K>, count: u64, stiffest: f64) {
    let (mut called, mut unseen, mut times) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 0..count {
        let who = somebody(seed, stiffest);
        let (fault, seen, withheld) = is_touched(bench, &who, [false; 3]);
        match fault {
            Some(Fault::WrongPolarity) => called.push(seed),
            Some(fault) => panic!("{} hand {seed} {:?}: {fault:?}", bench.name, who.hand),
            None if seen == [true; 3] => times.push(withheld),
            None => unseen.push(seed),
        }
    }
    times.sort_by(f64::total_cmp);
    println!(
        "{:<20} {count} hands up to {stiffest} N/m: called wrong {called:?}; not wholly seen {unseen:?}; force after \
         {:.0} ms of contact in the median, {:.0} at most",
        bench.name,
        times.get(times.len() / 2).unwrap_or(&0.0) * 1e3,
        times.last().unwrap_or(&0.0) * 1e3
    );
    assert!(called.is_empty(), "{called:?}");
    // In a grip that is firm, knocks move something. A soft one before the heavy plate of a Falcon, whose knocks are
    // felt as two newtons, is pushed off before all were seen: the next touches show the rest.
    let most = if stiffest > FIRM || bench.name.contains("Falcon") { count as usize / 2 } else { 0 };
    assert!(unseen.len() <= most, "{}: no force for {unseen:?}", bench.name);
}

/// Whoever touches a device with a motor turned round: that joint is never taken for right.
fn wrong_hands<K: Kinematics<3>>(bench: &Bench<K>, count: u64, stiffest: f64) {
    let (mut told, mut withheld) = (0, 0);
    for seed in 0..count {
        let joint = (seed % 3) as usize;
        let mut wrong = [false; 3];
        wrong[joint] = true;
        let (fault, seen, _) = is_touched(bench, &somebody(seed, stiffest), wrong);
        assert!(!seen[joint], "{} hand {seed}: joint {joint}, {fault:?}", bench.name);
        match fault {
            Some(Fault::WrongPolarity) => told += 1,
            _ => withheld += 1,
        }
    }
    println!("{:<20} {count} hands, a motor wrong: {told} told, {withheld} withheld", bench.name);
}

/// Of each device.
const FEW: u64 = 4;
/// N/m: a firm grip of a stylus. A grip so stiff that no knock moves it tells nothing of signs, and the force stays
/// withheld.
const FIRM: f64 = 1_000.0;

#[test]
fn no_hand_that_touches_is_called_wrong() {
    hands(&WOODEN_HAPTICS, FEW, FIRM);
    hands(&POLHEM, FEW, FIRM);
    hands(&PHANTOM, FEW, FIRM);
    hands(&FALCON, FEW, FIRM);
}

#[test]
fn no_wrong_joint_is_taken_for_right_by_whoever_touches() {
    wrong_hands(&WOODEN_HAPTICS, FEW, FIRM);
    wrong_hands(&POLHEM, FEW, FIRM);
    wrong_hands(&PHANTOM, FEW, FIRM);
    wrong_hands(&FALCON, FEW, FIRM);
}

#[test]
fn a_maximum_force_whose_pulses_are_too_weak_gives_no_force_and_takes_no_wrong_joint_for_right() {
    static WEAK: Device<SerialArm, 3> = Device {
        max_force_n: 0.2 * WOODEN_HAPTICS_2016.max_force_n,
        max_stiffness_n_per_m: 0.1 * WOODEN_HAPTICS_2016.max_stiffness_n_per_m,
        ..WOODEN_HAPTICS_2016
    };
    let check = WOODEN_HAPTICS.protection.polarity.unwrap();
    let needed = check.min_force_n(&WEAK, RATE as f32, [0.0, 0.5, 0.2]).unwrap();
    println!("needed {needed:?} N");
    assert!(
        needed.iter().any(|force| *force > WEAK.max_force_n)
            && needed.iter().all(|force| *force < WOODEN_HAPTICS_2016.max_force_n)
    );
    wrong_hands(&Bench { device: &WEAK, ..WOODEN_HAPTICS }, 24, FIRM);
}

#[test]
#[ignore = "minutes a hundred hands: PALPATE_HANDS says how many, of each device"]
fn thousands_of_hands() {
    let count = std::env::var("PALPATE_HANDS").map_or(100, |count| count.parse().expect("a number"));
    for stiffest in [FIRM, 10.0 * FIRM] {
        hands(&WOODEN_HAPTICS, count, stiffest);
        hands(&POLHEM, count, stiffest);
        hands(&PHANTOM, count, stiffest);
        wrong_hands(&WOODEN_HAPTICS, count, stiffest);
        wrong_hands(&POLHEM, count, stiffest);
        wrong_hands(&PHANTOM, count, stiffest);
    }
    hands(&FALCON, count, FIRM);
    wrong_hands(&FALCON, count, FIRM);
}
