//! A loop that is protected: motors that stay cool enough, joints and probes that are not let run, supplies.

use crate::protected::{Bench, FALCON, PHANTOM, POLHEM, RATE, WOODEN_HAPTICS, settings};
use crate::surfaces::WALL;
use palpate::device::presets::{
    PHANTOM_PREMIUM, PHANTOM_PREMIUM_PROTECTION, WOODEN_HAPTICS_2016, WOODEN_HAPTICS_2016_PROTECTION,
};
use palpate::device::{Counts, Device, Duty, Kinematics, Motor, Protection, SupplyRange};
use palpate::math::Vec3;
use palpate::servo::{Config, Event, Fault, Input, Phase, Servo, Settings};
use palpate_sim::plant::{HandPath, HandSettings, Plant, PlantSettings, Thermal, Vector};

/// Comes straight down at a constant speed.
struct Down {
    speed: f64,
    from: f64,
}

impl HandPath for Down {
    fn target(&self, time: f64) -> Vector {
        [0.0, 0.0, self.from - self.speed * time]
    }
    fn velocity(&self, _time: f64) -> Vector {
        [0.0, 0.0, -self.speed]
    }
}

/// A hand that holds the probe in a wall, as deep as its greatest force reaches, for 25 s.
fn stays_cool<K: Kinematics<3>>(bench: &Bench<K>) {
    let servo = Servo::protected(
        bench.device,
        &WALL,
        Protection { polarity: None, ..bench.protection },
        Config { settings: settings(bench.device, Vec3::ZERO), ..Config::DEFAULT },
    );
    let hand = HandSettings { stiffness: 20_000.0, damping: 100.0, mass: 0.0 };
    // Deeper than its greatest force is, and not so deep that contact is lost.
    let deep = 1.3 * f64::from(bench.device.max_force_n / bench.device.max_stiffness_n_per_m);
    let path = Down { speed: 0.01, from: 0.002 };
    // Windings take seconds: four steps a tick follow a hand of 20,000 N/m.
    let settings = bench.plant.in_sub_steps(4);
    let mut plant = Plant::new(&settings, hand, Box::new(Hold(path, deep)), RATE).unwrap();
    let mut motors = bench.heat.map(Thermal::cold);
    let mut state = servo.start();
    // Cold, as after a rest of 100 s: the harder case, for the motors are then given all they have.
    for _ in 0..400_000 {
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: false });
    }
    assert!(!servo.guard().folds(state.guard()));
    let (mut step, mut last, mut hottest, mut greatest) = (0.0_f32, 0.0_f32, [0.0_f64; 3], 0.0_f32);
    for tick in 0..100_000 {
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
        assert_eq!(state.fault(), None);
        plant.advance(state.duties().map(|duty| duty.0));
        for ((motor, current), hottest) in motors.iter_mut().zip(plant.currents()).zip(&mut hottest) {
            motor.step(current, 1.0 / RATE);
            *hottest = hottest.max(motor.winding);
        }
        let force = state.force().length();
        greatest = greatest.max(force);
        // Where the hand holds still, all that moves the force is what folds back.
        if tick > 12_000 {
            step = step.max((force - last).abs());
        }
        last = force;
    }
    println!(
        "{:<20} pressed with {greatest:.1} N, {last:.1} N after 25 s, largest step {:.5} N; windings up to {hottest:.0?} °C",
        bench.name, step
    );
    for (hottest, heat) in hottest.iter().zip(bench.heat) {
        assert!(*hottest < heat.greatest, "{hottest} °C");
    }
    assert!(step < 0.05, "{step} N in a tick");
}

/// A path that stops so deep.
struct Hold(Down, f64);

impl HandPath for Hold {
    fn target(&self, time: f64) -> Vector {
        self.0.target(time.min((self.1 + self.0.from) / self.0.speed))
    }
    fn velocity(&self, time: f64) -> Vector {
        if time < (self.1 + self.0.from) / self.0.speed { self.0.velocity(time) } else { [0.0; 3] }
    }
}

/// Of the law alone, Hz.
const LAW_RATE: f64 = 500.0;

/// A motor that is asked for all it has, again and again, with rests between that let it be given more; and resets,
/// after which nothing is known of it.
fn never_burns<K: Kinematics<3>>(bench: &Bench<K>) {
    for (joint, heat) in bench.heat.iter().enumerate() {
        let current_at_full = bench.plant.joints[joint].current_at_full;
        for (on, off, reset) in
            [(1e9, 0.0, false), (3.0, 3.0, false), (10.0, 20.0, false), (20.0, 0.1, true), (2.0, 2.0, true)]
        {
            let servo = Servo::protected(
                bench.device,
                &WALL,
                bench.protection,
                Config {
                    settings: Settings { rate_hz: LAW_RATE as f32, ..settings(bench.device, Vec3::ZERO) },
                    ..Config::DEFAULT
                },
            );
            // The law alone, for hours: the loop's own state, told what the motors were given.
            let mut worn = palpate::servo::Guard::<3>::start(servo.guard());
            let mut motor = Thermal::cold(*heat);
            let (mut hottest, mut last_on) = (0.0_f64, true);
            for tick in 0..(3_600.0 * LAW_RATE) as u32 {
                let time = f64::from(tick) / LAW_RATE;
                let is_on = time % (on + off) < on;
                if reset && is_on && !last_on {
                    worn = palpate::servo::Guard::<3>::start(servo.guard());
                }
                last_on = is_on;
                let bound = worn.limits()[joint] / bench.device.motors[joint].torque_at_full_n_m.abs();
                let mut duties = [Duty::ZERO; 3];
                duties[joint] = Duty::from_fraction(if is_on { bound } else { 0.0 });
                palpate::servo::Guard::<3>::record_output(servo.guard(), &mut worn, &duties);
                motor.step(f64::from(duties[joint].fraction()) * current_at_full, 1.0 / LAW_RATE);
                hottest = hottest.max(motor.winding);
            }
            println!(
                "{:<20} motor {joint}, {on} s on, {off} s off, reset {reset}: {hottest:.0} of {} °C",
                bench.name, heat.greatest
            );
            assert!(hottest < heat.greatest, "{hottest} °C");
        }
    }
}

/// One motor's turn comes every third tick: duties that beat with it must count as fully as any others.
#[test]
fn a_motor_warms_by_what_it_is_given_in_every_tick_and_not_only_in_its_turn() {
    let servo = Servo::protected(
        &PHANTOM_PREMIUM,
        &WALL,
        Protection { polarity: None, ..PHANTOM_PREMIUM_PROTECTION },
        Config { settings: settings(&PHANTOM_PREMIUM, Vec3::ZERO), ..Config::DEFAULT },
    );
    let endurance = PHANTOM_PREMIUM_PROTECTION.motors[0];
    for phase in 0..3 {
        let mut state = palpate::servo::Guard::<3>::start(servo.guard());
        let mut warmth = [f64::from(endurance.continuous).powi(2); 3];
        for tick in 0..200_000_u32 {
            let duties = [0, 1, 2].map(|joint| Duty(if tick % 3 == (phase + joint) % 3 { 20_000 } else { 100 }));
            palpate::servo::Guard::<3>::record_output(servo.guard(), &mut state, &duties);
            for (warmth, duty) in warmth.iter_mut().zip(duties) {
                let square = (f64::from(duty.0) / 32_767.0).powi(2);
                *warmth += (square - *warmth) / (f64::from(endurance.time_constant_s) * RATE);
            }
        }
        for (heat, expected) in state.heat().into_iter().zip(warmth) {
            // Rounding down by 2⁻³⁰ at each turn, over a memory of 16,000 turns: 1.5e-5 of 0.125.
            assert!((f64::from(heat.fraction()) - expected).abs() < 3e-5, "{phase}: {heat:?} {expected}");
        }
    }
}

#[test]
fn a_stalled_motor_stays_cool_whatever_is_asked_for() {
    never_burns(&WOODEN_HAPTICS);
    never_burns(&POLHEM);
    never_burns(&PHANTOM);
    never_burns(&FALCON);
}

#[test]
fn a_motor_that_warms_up_is_felt_as_less_force_and_not_as_a_step() {
    stays_cool(&WOODEN_HAPTICS);
    stays_cool(&POLHEM);
    stays_cool(&PHANTOM);
    stays_cool(&FALCON);
}

#[test]
fn a_device_that_is_let_go_under_force_is_stopped_by_its_speed() {
    let servo = Servo::new(
        &WOODEN_HAPTICS_2016,
        &WALL,
        Config { settings: settings(&WOODEN_HAPTICS_2016, Vec3::ZERO), ..Config::DEFAULT },
    );
    let slow = Protection { max_probe_speed_m_per_s: 0.3, polarity: None, ..WOODEN_HAPTICS_2016_PROTECTION };
    let slow_joints = Protection { max_joint_rates_rad_per_s: [2.0; 3], max_probe_speed_m_per_s: 10.0, ..slow };
    for (servo, is_fast) in [
        (Servo::protected(servo.device(), servo.surface(), slow, servo.config()), 0),
        (Servo::protected(servo.device(), servo.surface(), slow_joints, servo.config()), 1),
    ] {
        let path = Hold(Down { speed: 0.05, from: 0.002 }, 0.008);
        let mut plant = Plant::new(
            &PlantSettings::wooden_haptics_2016(),
            HandSettings { stiffness: 3_000.0, damping: 20.0, mass: 0.0 },
            Box::new(path),
            RATE,
        )
        .unwrap();
        let mut state = servo.start();
        for tick in 0..4_000 {
            if tick == 2_000 {
                plant.hold(HandSettings::NONE);
            }
            let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
            assert!(tick > 2_000 || state.fault().is_none(), "{tick} {:?}", state.fault());
            plant.advance(state.duties().map(|duty| duty.0));
        }
        assert_eq!(state.fault().map(|(fault, _)| fault), Some(Fault::Overspeed), "{is_fast}");
    }
    // Without force a hand may move it as fast as it likes.
    let servo = Servo::protected(
        servo.device(),
        servo.surface(),
        Protection { max_probe_speed_m_per_s: 1e-3, max_joint_rates_rad_per_s: [1e-3; 3], ..slow },
        servo.config(),
    );
    let mut plant = Plant::new(
        &PlantSettings::wooden_haptics_2016(),
        HandSettings::default(),
        Box::new(Down { speed: 0.2, from: 0.04 }),
        RATE,
    )
    .unwrap();
    let mut state = servo.start();
    for _ in 0..1_000 {
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: false });
        plant.advance(state.duties().map(|duty| duty.0));
    }
    assert_eq!((state.phase(), state.fault()), (Phase::Armed, None));
}

#[test]
fn a_supply_out_of_range_or_that_nobody_measures_is_a_fault() {
    let servo = Servo::new(
        &WOODEN_HAPTICS_2016,
        &WALL,
        Config { settings: settings(&WOODEN_HAPTICS_2016, Vec3::ZERO), ..Config::DEFAULT },
    );
    let range = Some(SupplyRange { min_mv: 20_000, max_mv: 28_000 });
    let servo = Servo::protected(
        servo.device(),
        servo.surface(),
        Protection { supply: range, ..WOODEN_HAPTICS_2016_PROTECTION },
        servo.config(),
    );
    let ends = |measured: &dyn Fn(u32) -> Option<u32>| {
        let mut state = servo.start();
        for tick in 0..2_000 {
            if let Some(millivolts) = measured(tick) {
                servo.note(&mut state, Event::Supply { millivolts });
            }
            let _ = servo.tick(&mut state, Input::Sensors { counts: [Counts(0); 3], enable: true });
        }
        state.fault()
    };
    assert_eq!(ends(&|tick| tick.is_multiple_of(100).then_some(24_000)), None);
    for bad in [19_999, 28_001, 0, u32::MAX] {
        assert_eq!(ends(&|tick| Some(if tick == 700 { bad } else { 24_000 })), Some((Fault::Supply, 700)), "{bad}");
    }
    // A tenth of a second after the last measurement, at 4 kHz.
    assert_eq!(ends(&|tick| (tick <= 500).then_some(24_000)), Some((Fault::Supply, 900)));
    assert_eq!(ends(&|_| None), Some((Fault::Supply, 400)));
}

/// What a motor may be given is counted in torque: of a weaker one it is less.
#[test]
fn a_motor_that_was_found_weaker_is_bounded_by_its_own_torque() {
    let servo = Servo::protected(
        &WOODEN_HAPTICS_2016,
        &WALL,
        WOODEN_HAPTICS_2016_PROTECTION,
        Config { settings: settings(&WOODEN_HAPTICS_2016, Vec3::ZERO), ..Config::DEFAULT },
    );
    let weaker = WOODEN_HAPTICS_2016.motors.map(|motor| Motor { torque_at_full_n_m: -0.5 * motor.torque_at_full_n_m });
    let device = Device { motors: weaker, ..WOODEN_HAPTICS_2016 };
    let limits = servo.calibrated(&device).start().guard().limits();
    assert_eq!(limits, weaker.map(|motor| motor.torque_at_full_n_m.abs()));
    assert_eq!(servo.start().guard().limits(), WOODEN_HAPTICS_2016.motors.map(|motor| motor.torque_at_full_n_m.abs()));
}
