//! One angle places the dial, its detents and the parts of its feel, and nothing jumps without motion.

use palpate::device::presets::GIMBAL_KNOB;
use palpate::device::{Counts, Dial};
use palpate::render::{Ends, Feel, FeelPart, Notch, Spring, Wave};
use palpate::scene::Command;
use palpate::servo::{Config, DialState, Event, Fault, Input, Knob, KnobWitness, Phase, Servo, ServoState, Settings};
use palpate_sim::knob::{HostKnob, LET_GO, SETTINGS};
use palpate_sim::plant::{DialSettings, Fingers};
use std::f64::consts::TAU;

/// Of no whole number of detents a turn.
const UNEVEN: Wave = Wave { pitch_rad: 0.25, torque_n_m: 0.01, centre_rad: 0.1 };
const SPRING: Spring = Spring { stiffness_n_m_per_rad: 0.02, rest_rad: 0.0, max_torque_n_m: 0.02 };
const DAMPED: Feel = Feel { damping_n_m_s_per_rad: 6e-4, ..Feel::FREE };
static FEELS: [Feel; 4] = [
    Feel { detents: Some(UNEVEN), ..DAMPED },
    Feel { detents: Some(UNEVEN), spring: Some(SPRING), ..DAMPED },
    Feel {
        ends: Some(Ends { between_rad: [-1.0, 1.0], stiffness_n_m_per_rad: 0.1, damping_n_m_s_per_rad: 1e-3 }),
        ..DAMPED
    },
    Feel { notch: Some(Notch { at_rad: 0.5, width_rad: 0.6, torque_n_m: 0.01 }), ..DAMPED },
];
static KNOB: Knob = Knob::new(&GIMBAL_KNOB, &FEELS, LET_GO);
static SERVO: Servo<'static, Knob, Dial, 1> = Servo::new(
    &GIMBAL_KNOB,
    &KNOB,
    Config { settings: Settings { soft_start_s: 0.01, ..SETTINGS }, ..Config::DEFAULT },
);

/// A dial in a hand that it cannot move.
struct Held {
    state: ServoState<1, KnobWitness, ()>,
    counts: i64,
    enable: bool,
    last: (DialState, i64),
}

impl Held {
    fn at(counts: i64) -> Self {
        let mut held = Self { state: SERVO.start(), counts, enable: true, last: (DialState::default(), i64::MAX) };
        held.rest();
        held
    }

    fn dial(&self) -> DialState {
        SERVO.dial(&self.state).expect("a knob")
    }

    /// One tick. The two numbers are where the dial is, the detent is the one there, and at rest the torque has no step.
    fn tick(&mut self) {
        let rests = self.state.rates()[0].abs() < 1e-3;
        let _ =
            SERVO.tick(&mut self.state, Input::Sensors { counts: [Counts(self.counts as i32)], enable: self.enable });
        let (dial, (before, counts)) = (self.dial(), self.last);
        let [angle, exact] = [f64::from(dial.angle_rad), (self.counts as f64 + 0.5) / 16_384.0 * TAU];
        // Roundings of 50 rad, and of the whole angle and its turns.
        let rounded = 8e-6 + angle.abs() * 2_f64.powi(-22);
        assert!((f64::from(dial.turns) * TAU + angle - exact).abs() < rounded, "{dial:?} at {exact}");
        if let Some(wave) = self.active().detents {
            let pitches = (angle - f64::from(wave.centre_rad)) / f64::from(wave.pitch_rad);
            assert!((f64::from(dial.detent) - pitches).abs() < 0.5 + 1e-3, "{dial:?}: {pitches} pitches");
        }
        if rests && counts == self.counts && before.torque_n_m != 0.0 && self.state.phase() == Phase::Running {
            let step = (dial.torque_n_m - before.torque_n_m).abs();
            assert!(step < LET_GO / SETTINGS.rate_hz + 1e-6, "{before:?} {dial:?}");
        }
        self.last = (dial, self.counts);
    }

    fn rest(&mut self) {
        (0..400).for_each(|_| self.tick());
    }

    /// Turned to a count at 107 rad/s; its torque is then the feel's own at the angle that is reported.
    fn turn(&mut self, counts: i64) {
        while self.counts != counts {
            self.counts += (counts - self.counts).clamp(-70, 70);
            self.tick();
        }
        self.rest();
        self.has_its_torque();
    }

    fn has_its_torque(&self) {
        if !self.enable {
            return;
        }
        let (dial, feel) = (self.dial(), self.active());
        let asked = asked(&feel, f64::from(dial.angle_rad)).clamp(-0.056, 0.056);
        // Roundings of the angle by 0.3 N·m/rad.
        let rounded = 4e-6 + 0.3 * f64::from(dial.angle_rad.abs()) * 2_f64.powi(-22);
        assert!((f64::from(dial.torque_n_m) - asked).abs() < rounded, "{dial:?}: {asked} N·m by {feel:?}");
    }

    fn active(&self) -> Feel {
        let witness = self.state.witness();
        FEELS.get(usize::from(witness.feel())).or(witness.own()).copied().expect("one is active")
    }

    /// Released and pressed: without motion only whole turns pass from the angle to the turns.
    fn press(&mut self) -> i32 {
        let before = self.dial();
        self.enable = false;
        self.rest();
        assert_eq!(DialState { torque_n_m: before.torque_n_m, ..self.dial() }, before);
        self.enable = true;
        self.rest();
        self.has_its_torque();
        self.dial().turns - before.turns
    }

    fn set(&mut self, part: FeelPart) {
        SERVO.apply(&mut self.state, &Command::Feel(part)).expect("near the dial");
        self.rest();
        self.has_its_torque();
    }

    fn choose(&mut self, index: u8) {
        SERVO.note(&mut self.state, Event::Chosen { index });
        self.rest();
        self.has_its_torque();
    }

    /// A spring a tenth of a radian before the angle that is read pulls by that, and one too far is refused.
    fn takes_the_angle_that_it_reports(&mut self) {
        let angle_rad = self.dial().angle_rad;
        self.set(FeelPart::Spring(Some(Spring { rest_rad: angle_rad + 0.1, ..SPRING })));
        let far = Spring { rest_rad: angle_rad - 0.8, ..SPRING };
        assert!(SERVO.apply(&mut self.state, &Command::Feel(FeelPart::Spring(Some(far)))).is_err());
        self.set(FeelPart::Spring(None));
    }
}

/// By its own formula, at rest, without clicks.
fn asked(feel: &Feel, angle: f64) -> f64 {
    let number = f64::from;
    let wave = |pitch: f32, torque: f32, from: f64| -number(torque) * (TAU * from / number(pitch)).sin();
    let mut sum = feel.detents.map_or(0.0, |of| wave(of.pitch_rad, of.torque_n_m, angle - number(of.centre_rad)));
    sum += feel.spring.map_or(0.0, |of| {
        let most = number(of.max_torque_n_m);
        (number(of.stiffness_n_m_per_rad) * (number(of.rest_rad) - angle)).clamp(-most, most)
    });
    sum += feel.ends.map_or(0.0, |of| {
        let [least, most] = of.between_rad.map(number);
        number(of.stiffness_n_m_per_rad) * (angle.clamp(least, most) - angle)
    });
    let notch = feel.notch.filter(|of| (angle - number(of.at_rad)).abs() < 0.5 * number(of.width_rad));
    sum + notch.map_or(0.0, |of| wave(of.width_rad, of.torque_n_m, angle - number(of.at_rad)))
}

/// 2.18 turns.
const FAR: i64 = 35_717;

#[test]
fn a_feel_of_the_table_moves_to_the_dial_by_turns_that_are_reported_and_only_where_it_is_nearer_then() {
    for way in [1, -1] {
        let mut held = Held::at(0);
        held.turn(way * FAR);
        // Detents are in every turn.
        assert_eq!(held.press(), 0);
        for feel in 1..4 {
            held.choose(0);
            held.turn(0);
            held.choose(feel);
            assert_eq!(held.dial().turns, 0, "{feel}");
            held.turn(way * FAR);
            assert_eq!((i64::from(held.press()), held.press()), (2 * way, 0), "{feel}");
            held.takes_the_angle_that_it_reports();
        }
        // Half a turn away from the spring's rest: as near the other way.
        held.choose(0);
        held.turn(way * 2 * 16_384 + 8_100);
        held.choose(1);
        assert_eq!((i64::from(held.dial().turns), held.press()), (2 * way, 0));
    }
}

#[test]
fn a_host_sets_by_the_angle_that_it_reads_and_its_feel_stays_where_it_was() {
    for from in [0, 17_731, -17_731, 160_000] {
        let mut held = Held::at(from);
        assert!(held.dial().angle_rad.abs() < 3.2, "{:?}", held.dial());
        held.set(FeelPart::Detents(Some(UNEVEN)));
        held.turn(from + FAR);
        assert_eq!(held.press(), 0);
        held.takes_the_angle_that_it_reports();
        held.enable = false;
        held.turn(from + 3 * FAR);
        held.takes_the_angle_that_it_reports();
        held.enable = true;
        held.rest();
        let angle = held.dial().angle_rad;
        held.set(FeelPart::Ends(Some(Ends {
            between_rad: [angle - 0.5, angle + 0.5],
            stiffness_n_m_per_rad: 0.1,
            damping_n_m_s_per_rad: 1e-3,
        })));
        let own = held.state.witness().own().copied();
        // A feel of the table that is brought to the dial elsewhere takes nothing of it along.
        let at = held.dial();
        held.choose(2);
        held.turn(from + FAR);
        assert_ne!(held.press(), 0);
        held.turn(from + 3 * FAR);
        held.choose(4);
        assert_eq!((held.dial().turns, held.state.witness().own().copied()), (at.turns, own));
    }
}

#[test]
fn after_hundreds_of_turns_under_force_the_angle_is_as_precise_and_the_host_s_feel_where_it_was() {
    for way in [1, -1] {
        let mut held = Held::at(0);
        held.set(FeelPart::Detents(Some(UNEVEN)));
        held.set(FeelPart::Notch(FEELS[3].notch));
        held.turn(way * 300 * 16_384);
        let dial = held.dial();
        assert!(f64::from(dial.angle_rad.abs()) < 264.0 * TAU && dial.turns != 0, "{dial:?}");
        held.takes_the_angle_that_it_reports();
        let notch = held.state.witness().own().and_then(|own| own.notch).expect("set above");
        let at = f64::from(dial.turns) * TAU + f64::from(notch.at_rad);
        assert!((at - 0.5).abs() < 3e-4, "{at}");
    }
}

#[test]
fn a_stopped_knob_and_one_that_is_not_aligned_yet_say_where_the_dial_is() {
    let mut held = Held::at(0);
    held.set(FeelPart::Damping(1e-3));
    SERVO.note(&mut held.state, Event::Stop);
    held.enable = false;
    for counts in [FAR, -FAR] {
        while held.counts != counts {
            held.counts += (counts - held.counts).clamp(-70, 70);
            held.tick();
        }
        held.takes_the_angle_that_it_reports();
    }
    assert_eq!(held.state.fault().map(|(fault, _)| fault), Some(Fault::Stopped));

    let mut knob = HostKnob::at(DialSettings::gimbal_knob(), None);
    knob.enable = false;
    knob.dial.hold(Fingers { stiffness: 0.0, damping: 5e-3, aim: 0.0, rate: 9.0 });
    for _ in 0..20 {
        knob.ticks(400);
        let dial = knob.servo().dial(knob.state()).expect("a knob");
        let place = f64::from(dial.turns) * TAU + f64::from(dial.angle_rad);
        // The sensor's zero is at 0.7 rad of the simulated shaft; 0.4 degrees, and a tick of 9 rad/s.
        assert!((place + 0.7 - knob.dial.angle()).abs() < 0.01, "{dial:?} at {}", knob.dial.angle());
    }
    assert!(!knob.state().homed() && knob.dial.angle() > 10.0);
}
