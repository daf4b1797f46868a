//! A dial on a motor with three phases, through the same loop as every device.

mod faults;
mod frame;
mod heat;
mod lost_phase;

use palpate::device::drive::{Supply, VoltageFeed};
use palpate::device::{Counts, Duty, Refusal};
use palpate::render::{Feel, Spring, Wave};
use palpate::servo::{Config, Fault, Input, Knob, Output, Phase, Servo, Settings};
use palpate_sim::knob::{
    FEELS, HostKnob, LET_GO, NAMES, PHASE_OHM, RPM_PER_V, SEARCH, SETTINGS, alignment_n_m, device,
};
use palpate_sim::plant::{Dial, DialSettings, Fingers, MagneticFault};
use std::f64::consts::TAU;

const RATE: f64 = SETTINGS.rate_hz as f64;

fn dial(settings: DialSettings) -> Dial {
    Dial::new(settings, RATE)
}

#[test]
fn the_alignment_is_bounded_and_needs_the_button_all_the_time() {
    let settings = DialSettings::gimbal_knob();
    let mut knob = HostKnob::at(settings, None);
    knob.enable = false;
    knob.ticks(1_000);
    assert_eq!((knob.state().output(), knob.state().homed()), (Output::Off, false));
    knob.enable = true;
    knob.ticks(SEARCH.ticks() / 2);
    assert!(matches!(knob.state().output(), Output::Drive(_)));
    // Released in the middle: off in the same tick, and it begins anew.
    knob.enable = false;
    knob.tick();
    assert_eq!((knob.state().output(), knob.state().phase()), (Output::Off, Phase::Calibrate));
    knob.enable = true;
    let mut torque: f64 = 0.0;
    for tick in 0..SEARCH.ticks() {
        assert!(!knob.state().homed(), "aligned after {tick} ticks: not anew");
        knob.tick();
        torque = torque.max((knob.dial.torque() - knob.dial.cogging_torque(knob.dial.angle())).abs());
    }
    knob.ticks(10);
    assert!(knob.state().homed() && knob.state().fault().is_none());
    // Its torque is at most the search's, on a rotor that stands across its field; a tenth for back-EMF.
    assert!(torque > 1e-3 && torque <= 1.1 * f64::from(SEARCH.torque_n_m), "{torque}");
}

#[test]
fn the_alignment_of_a_stronger_motor_detects_an_open_phase_and_none_exceeds_what_motor_and_thumb_bear() {
    let aligned = |ohm: f32, rpm_per_v: f32, continuous_n_m: f32| {
        let feed = VoltageFeed::three_phase(12.0, ohm, rpm_per_v, 0.75);
        let torque = alignment_n_m(&feed, continuous_n_m, 0.45 / ohm);
        let amplitude = f64::from(torque / feed.torque_constant_n_m_per_a) * (2.0_f64 / 3.0).sqrt();
        (f64::from(torque) * 1e3, amplitude >= 0.9 / f64::from(ohm))
    };
    assert_eq!(aligned(PHASE_OHM, RPM_PER_V, 0.041).0, f64::from(SEARCH.torque_n_m) * 1e3);
    for (ohm, rpm_per_v, continuous, expected, detects) in [
        (7.5, 80.0, 0.041, 30.0, true),
        // 0.9 V over 5.6 Ω in a phase is 33.2 mN·m at 169 mN·m/A.
        (5.6, 40.0, 0.083, 34.0, true),
        // 64 mN·m would detect it: a compile error of the boards' file.
        (2.0, 58.0, 0.083, 40.0, false),
        (7.5, 80.0, 0.020, 20.0, true),
    ] {
        let (torque, is_detected) = aligned(ohm, rpm_per_v, continuous);
        assert!((torque - expected).abs() < 1e-5 && is_detected == detects, "{ohm} Ω, {rpm_per_v} rpm/V: {torque}");
    }
}

/// A hand that spins the dial meanwhile: what it adds is its own speed's, and the field stays as weak as it was.
#[test]
fn a_hand_that_spins_the_dial_makes_the_field_that_aligns_it_no_stronger() {
    let feed = device(None).feeds[0];
    let asked = Duty::from_fraction(SEARCH.torque_n_m / device(None).motors[0].torque_at_full_n_m);
    let most = feed.command(asked, 0.0, Supply::UNMEASURED);
    for rate in [50.0, -50.0] {
        let mut knob = HostKnob::at(DialSettings::gimbal_knob(), None);
        knob.dial.hold(Fingers { stiffness: 0.0, damping: 5e-3, aim: 0.0, rate });
        let (mut greatest, mut fastest) = (0, 0.0_f64);
        while knob.state().fault().is_none() {
            knob.tick();
            greatest = greatest.max(knob.state().duties()[0].0.abs());
            fastest = fastest.max(knob.dial.rate().abs());
        }
        println!("spun with up to {fastest:.0} rad/s: a duty of {greatest}, of a rotor at rest {}", most.0);
        assert_eq!(knob.state().fault().map(|(fault, _)| fault), Some(Fault::Homing));
        assert!(fastest > 40.0 && greatest <= most.0, "{greatest} instead of {}", most.0);
    }
}

#[test]
fn any_angle_and_either_way_of_the_sensor_is_aligned_to_three_percent_of_the_torque() {
    for reversed in [false, true] {
        for angle in [0.0, 0.11, 0.25, 0.42, 1.9] {
            let mut settings = DialSettings { angle, ..DialSettings::gimbal_knob() };
            settings.sensor.reversed = reversed;
            let knob = HostKnob::running(settings, None);
            let [aligned] = knob.state().homing().aligned();
            assert_eq!(aligned.reversed, reversed);
            // Electrically, 11 times 0.7 rad at count zero.
            let off = (f64::from(aligned.at_zero.radians()) - 11.0 * 0.7).sin().asin();
            // cos 14° = 0.97.
            assert!(off.abs() < 0.244, "{angle} {reversed}: {off}");
        }
    }
}

#[test]
fn a_sensor_that_has_frozen_is_a_fault_within_a_quarter_of_a_second_and_pulls_no_more_until_then() {
    for (when, ticks) in [("aligning", 3_000), ("running", SEARCH.ticks() + 2_000)] {
        let mut knob = HostKnob::at(DialSettings::gimbal_knob(), None);
        knob.ticks(ticks);
        if when == "running" {
            knob.dial.hold(Fingers::turning(0.7 + 0.06, 0.0));
            knob.ticks(1_000);
        }
        assert_eq!(knob.state().fault(), None, "{when}");
        knob.dial.spoil(Some(MagneticFault::Stuck));
        let mut until = 0;
        while knob.state().fault().is_none() {
            knob.tick();
            until += 1;
            assert!(knob.dial.torque().abs() < 0.04 && until <= 1_001, "{when}: {} N·m", knob.dial.torque());
        }
        let (fault, _) = knob.state().fault().unwrap();
        assert!(matches!(fault, Fault::Frozen | Fault::Homing), "{when}: {fault}");
        assert_eq!(knob.widths(), None);
    }
}

#[test]
fn a_feel_has_its_torque_on_every_supply_within_its_range() {
    // The spring, half a radian from its rest: 30 mN·m. By the constant, 13.8 V would give a seventh more.
    let measured = [10.2, 12.0, 13.8].map(|volts| {
        let mut knob = HostKnob::running(DialSettings::gimbal_knob(), None);
        knob.dial.supply(volts);
        knob.choose(3);
        let angle = DialSettings::gimbal_knob().sensor.angle_at_zero + 0.5;
        knob.held_at(angle) - knob.dial.cogging_torque(angle)
    });
    for torque in measured {
        // 5 %: dead time is compensated for 12 V.
        assert!((torque / measured[1] - 1.0).abs() < 0.05, "{measured:?}");
    }
}

#[test]
fn a_dial_is_as_precise_after_a_million_turns_as_after_one_and_its_detents_stay_where_they_were() {
    // At 20 Hz, within the speed that is believed: 15,000 of 16,384 counts a tick, over several wraps of 32 bits.
    static FEELS: [Feel; 1] = [Feel {
        detents: Some(Wave { pitch_rad: core::f32::consts::TAU / 24.0, torque_n_m: 0.016, centre_rad: 0.0 }),
        damping_n_m_s_per_rad: 2.8e-4,
        ..Feel::FREE
    }];
    let device = device(None);
    let knob = Knob::new(&device, &FEELS, LET_GO);
    let settings = Settings { rate_hz: 20.0, velocity_corner_hz: 2.0, soft_start_s: 0.0, ..SETTINGS };
    let servo = Servo::new(&device, &knob, Config { settings, ..Config::DEFAULT });
    for way in [1, -1] {
        let mut state = servo.start();
        let (mut place, mut worst_angle, mut worst_torque) = (0_i64, 0.0_f64, 0.0_f64);
        while place.abs() < 1_000_000 * 16_384 {
            place += way * 15_000;
            let _ = servo.tick(&mut state, Input::Sensors { counts: [Counts(place as i32)], enable: true });
            // The middle of the count, in real numbers.
            let exact = (place as f64 + 0.5) / 16_384.0 * TAU;
            let whole = f64::from(state.turns()) * TAU;
            worst_angle = worst_angle.max((whole + f64::from(state.angles()[0]) - exact).abs());
            let in_turn = ((place.rem_euclid(16_384)) as f64 + 0.5) / 16_384.0 * TAU;
            let torque = -0.016 * (24.0 * in_turn).sin() - 2.8e-4 * f64::from(state.rates()[0]);
            worst_torque = worst_torque.max((f64::from(state.witness().torque()) - torque).abs());
        }
        assert_eq!((state.fault(), state.phase()), (None, Phase::Running));
        println!("angle off by {worst_angle:.1e} rad, torque by {worst_torque:.1e} N·m");
        // Two roundings of 50 rad, 4e-6 each; those of the pitch, 200 detents of 2⁻²⁴, by 0.38 N·m/rad.
        assert!(worst_angle < 1e-5 && worst_torque < 3e-5, "{worst_angle} {worst_torque}");
        assert_eq!(state.turns() / 8 * 8, state.turns());
    }
}

#[test]
fn a_refused_table_names_the_feel_and_both_numbers() {
    // As the compiler prints it: the panic is the same.
    let refusal = |feel: Feel| {
        let feels: &[Feel] = Box::leak(vec![Feel::FREE; 11].into_iter().chain([feel]).collect());
        let refused = std::panic::catch_unwind(|| Knob::new(&device(None), feels, LET_GO)).unwrap_err();
        refused.downcast_ref::<String>().unwrap().clone()
    };
    let spring = |stiffness: f32, most: f32, damping: f32| Feel {
        spring: Some(Spring { stiffness_n_m_per_rad: stiffness, rest_rad: 0.0, max_torque_n_m: most }),
        damping_n_m_s_per_rad: damping,
        ..Feel::FREE
    };
    for (feel, numbers) in [
        (spring(2.0, 0.02, 3e-3), "(2000.00, maximum 1600.00 mN·m/rad)"),
        (spring(0.1, 0.0605, 1e-3), "(60.50, maximum 56.00 mN·m)"),
        (spring(0.1, 0.02, 9.05e-3), "(9.05, maximum 3.20 mN·m·s/rad)"),
        (spring(1.0, 0.02, 3e-4), "(0.30, minimum 0.70 mN·m·s/rad)"),
    ] {
        let said = refusal(feel);
        assert!(said.starts_with("feel 11 of the table, counted from 0: ") && said.ends_with(numbers), "{said}");
    }
    assert!(refusal(spring(f32::NAN, 0.0, 0.0)).ends_with("finite and not negative"));
}

#[test]
fn a_dial_that_is_turned_on_and_on_has_no_fault_and_no_jerk_released_or_in_force() {
    for enable in [true, false] {
        let mut knob = HostKnob::running(DialSettings::gimbal_knob(), None);
        knob.enable = enable;
        knob.choose(0);
        knob.dial.hold(Fingers { stiffness: 0.0, damping: 5e-3, aim: 0.0, rate: 30.0 });
        knob.ticks(4_000);
        // 300 rad further, at 30 rad/s.
        let (from, mut fastest, mut slowest) = (knob.dial.angle(), 0.0_f32, f32::INFINITY);
        while knob.dial.angle() < from + 300.0 {
            knob.tick();
            assert_eq!(knob.state().fault(), None, "{enable}: after {} rad", knob.dial.angle() - from);
            let [rate] = knob.state().rates();
            (fastest, slowest) = (fastest.max(rate), slowest.min(rate));
        }
        assert!(slowest > 0.0 && fastest < 60.0, "{enable}: {slowest} to {fastest} rad/s");
        assert!(knob.state().turns() >= 40);
    }
}

#[test]
fn an_alignment_that_cannot_be_believed_is_refused_by_name() {
    let settings = DialSettings::gimbal_knob();
    let refusal = |settings: DialSettings, fingers: Fingers| {
        let mut knob = HostKnob::at(settings, None);
        knob.dial.hold(fingers);
        knob.ticks(SEARCH.ticks() + 100);
        assert_eq!(knob.state().fault().map(|(fault, _)| fault), Some(Fault::Homing));
        assert_eq!(knob.widths(), None);
        knob.state().homing().refusal().unwrap()
    };
    let mut poles = settings;
    for pole_pairs in [7.0, 10.0, 12.0, 14.0] {
        poles.motor.pole_pairs = pole_pairs;
        assert_eq!(refusal(poles, Fingers::NONE), Refusal::NotFollowed, "{pole_pairs} pole pairs");
    }
    for phase in 0..3 {
        let mut lost = settings;
        lost.inverter.lost = Some(phase);
        let refusal = refusal(lost, Fingers::NONE);
        assert!(matches!(refusal, Refusal::Jammed | Refusal::NotFollowed), "phase {phase}: {refusal}");
    }
    // A fist.
    assert_eq!(refusal(settings, Fingers::clamp(0.3)), Refusal::Jammed);
}

#[test]
fn a_switch_is_no_step() {
    let mut knob = HostKnob::running(DialSettings::gimbal_knob(), None);
    // In the end stop's spring, where feels differ most.
    knob.held_at(0.7 + 1.02);
    let mut different: f32 = 0.0;
    for from in 0..FEELS.len() as u8 {
        for to in 0..FEELS.len() as u8 {
            knob.choose(from);
            knob.ticks(800);
            let before = knob.state().witness().torque();
            knob.choose(to);
            knob.tick();
            let after = knob.state().witness().torque();
            // What comes later is `servo/knob.rs`'s own test, without the sensor's noise. A rounding; a feel that was
            // felt already has that noise.
            let step = LET_GO / SETTINGS.rate_hz + 1e-6;
            assert!(from == to || (after - before).abs() <= step, "{from} to {to}: {before} {after}");
            assert_eq!(knob.state().witness().feel(), to);
            knob.ticks(800);
            different = different.max((knob.state().witness().torque() - before).abs());
        }
    }
    assert!(different > 0.02, "some of them differ much: {different}");
    // One that is not there changes nothing.
    knob.choose(200);
    knob.tick();
    assert_eq!(usize::from(knob.state().witness().feel()), FEELS.len() - 1);
}

#[test]
fn a_dial_that_is_let_go_of_comes_to_rest_in_every_feel() {
    let settings = DialSettings::gimbal_knob();
    for (index, name) in NAMES.into_iter().enumerate() {
        let mut knob = HostKnob::running(settings, None);
        knob.choose(index as u8);
        knob.dial.hold(Fingers::turning(0.7 + 1.2, 0.0));
        knob.ticks(2_000);
        knob.dial.hold(Fingers::NONE);
        knob.ticks(8_000);
        let fastest = (0..4_000)
            .map(|_| {
                knob.tick();
                knob.dial.rate().abs()
            })
            .fold(0.0, f64::max);
        assert_eq!(knob.state().fault(), None, "{name}");
        // What the sensor's noise stirs.
        assert!(fastest < 0.3, "{name}: {fastest} rad/s");
    }
}
