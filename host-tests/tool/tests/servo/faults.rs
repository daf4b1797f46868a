//! The fault matrix: every fault in every phase at a thousand seeded instants, with both safe outputs.

use crate::harmed::{Decayed, LINK_TICKS, Poisoned, TestServo, decayed, device, safety};
use crate::surfaces::WALL;
use crate::traces::{SETTINGS, Trace, enable};
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Counts, Device, Duty, Kinematics};
use palpate::math::Vec3;
use palpate::servo::{
    ContactLimits, Event, Fault, Input, Phase, ResetReason, SafeOutput, Safety, Servo, ServoState, Settings,
    StuckLimits,
};
use palpate::track::{Contact, Controller};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

const INSTANTS: usize = 1_000;
/// Ticks of good sensors after a fault, in which it must not come loose.
const AFTER: usize = 30;
/// Of the table check: 33 words and two ends.
const TICKS_PER_PASS: u32 = 35;
/// Until a sensor that stands still is called stuck by limits that allow next to no travel: each joint is looked at
/// twice.
const STUCK_TICKS: u32 = 6;

/// What injecting a fault came to.
enum Seen {
    /// A tick was run, or an event noted, in which it must have been seen; whether the sensors of that tick are to be
    /// believed.
    Now { believable: bool },
    /// In this phase it cannot be seen, and why that does no harm.
    Not,
}

struct Bench<'a> {
    servo: TestServo<'a>,
    /// The same, but that any travel of another joint makes a sensor stuck.
    strict: TestServo<'a>,
    /// The same, but that next to no depth is contact lost.
    shallow: TestServo<'a>,
    device: &'a Device<Poisoned, 3>,
    patch: &'a Decayed,
    random: Pcg64,
}

impl Bench<'_> {
    fn below(&mut self, bound: u32) -> u32 {
        (self.random.next_u64() >> 33) as u32 % bound
    }

    /// Brings a fault about in a state whose next good sensors are `counts`.
    fn inject(&mut self, fault: Fault, state: &mut ServoState<3>, counts: [Counts; 3], enable: bool) -> Seen {
        let joint = self.below(3) as usize;
        let sensors = |counts| Input::Sensors { counts, enable };
        match fault {
            Fault::FrameLost => {
                self.servo.tick(state, Input::Lost);
                Seen::Now { believable: false }
            }
            Fault::FrameDamaged => {
                self.servo.tick(state, Input::Damaged);
                Seen::Now { believable: false }
            }
            Fault::JointOutOfRange => {
                // All bits alike, the sign turned, far off.
                let choices = [i32::MIN, i32::MAX, -1_000_000 - self.below(1 << 30) as i32, 1_000_000];
                let mut bad = counts;
                bad[joint] = Counts(choices[self.below(4) as usize]);
                self.servo.tick(state, sensors(bad));
                Seen::Now { believable: false }
            }
            Fault::JointJumped => {
                if state.counts().is_none() {
                    return Seen::Not; // the first word has nothing to have jumped from; the motors are off
                }
                // 25 rad/s at 4 kHz are 32 counts of the turntable and 24 of the links: a jump of 40 to 140.
                let jump = 40 + self.below(100) as i32;
                let mut bad = counts;
                bad[joint].0 += if self.below(2) == 0 { jump } else { -jump };
                self.servo.tick(state, sensors(bad));
                Seen::Now { believable: false }
            }
            Fault::NotFinite => {
                let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][self.below(3) as usize];
                self.device.kinematics.with.set(Some(bad));
                self.servo.tick(state, sensors(counts));
                self.device.kinematics.with.set(None);
                Seen::Now { believable: false }
            }
            Fault::JointStuck => {
                // Five times dry friction is a load; twice that, so that it still is one when this count stays behind.
                let felt = self.device.kinematics.pose(state.angles()).torques(state.force())[joint];
                if felt.abs() < 10.0 * self.device.dry_friction[joint] || state.counts().is_none() {
                    return Seen::Not; // without load a joint may rest
                }
                // The last count again, while the other joints come a count a tick: twice three ticks, for one joint is
                // looked at a tick.
                let mut bad = counts;
                bad[joint] = state.counts().unwrap()[joint];
                for _ in 0..STUCK_TICKS {
                    if state.fault().is_none() {
                        self.strict.tick(state, sensors(bad));
                        bad[(joint + 1) % 3].0 += 1;
                        bad[(joint + 2) % 3].0 += 1;
                    }
                }
                if state.fault().is_none() {
                    return Seen::Not; // the move took the load away
                }
                Seen::Now { believable: false }
            }
            Fault::ContactLost => {
                // Only contact can be lost, and only where there is force does it matter how often.
                let is_deep = state.contact() == Contact::Touching && state.gap() < -5e-4;
                if !(state.phase() == Phase::Running && enable && is_deep) {
                    return Seen::Not;
                }
                self.shallow.tick(state, sensors(counts));
                Seen::Now { believable: true }
            }
            Fault::Unreachable => {
                self.device.kinematics.open.set(true);
                self.servo.tick(state, sensors(counts));
                self.device.kinematics.open.set(false);
                Seen::Now { believable: false }
            }
            // Of a loop that is protected: see `guard.rs`.
            Fault::Overspeed | Fault::Supply | Fault::WrongSign => Seen::Not,
            Fault::Overrun => {
                self.servo.note(state, Event::Overrun);
                Seen::Now { believable: false }
            }
            Fault::LinkLost => {
                for silent in 0..=LINK_TICKS {
                    if silent == 0 || state.fault().is_none() {
                        self.servo.tick(state, sensors(counts));
                    }
                }
                Seen::Now { believable: true }
            }
            Fault::TableCorrupt => {
                self.patch.bit.set(Some(self.below(33 * 32)));
                // The pass under way may have gone by; the next one has not.
                for _ in 0..2 * TICKS_PER_PASS {
                    if state.fault().is_none() {
                        self.servo.note(state, Event::LinkAlive);
                        self.servo.tick(state, sensors(counts));
                    }
                }
                self.patch.bit.set(None);
                Seen::Now { believable: true }
            }
            Fault::WatchdogReset => {
                *state = self.servo.start_after(ResetReason::Watchdog);
                Seen::Now { believable: false }
            }
            Fault::BrownOut => {
                *state = self.servo.start_after(ResetReason::BrownOut);
                Seen::Now { believable: false }
            }
            Fault::Drive => {
                self.servo.note(state, Event::DriveFault);
                Seen::Now { believable: false }
            }
            Fault::Homing => {
                self.servo.note(state, Event::HomingRefused);
                Seen::Now { believable: false }
            }
            Fault::Stopped => {
                self.servo.note(state, Event::Stop);
                Seen::Now { believable: false }
            }
        }
    }
}

fn assert_in_range(state: &ServoState<3>) {
    assert!(state.duties().iter().all(|duty| duty.0 != i16::MIN), "{state:?}");
    assert!(state.force().is_finite() && state.force().length() <= 5.0 * (1.0 + 1e-6), "{state:?}");
}

/// Zero, or a brake: what is given never has the sense of the motion as it is estimated.
fn assert_safe(state: &ServoState<3>, output: SafeOutput, believable: bool) {
    assert_in_range(state);
    if output == SafeOutput::Zero || !believable {
        assert_eq!(state.duties(), [Duty::ZERO; 3], "{state:?}");
        return;
    }
    let torques = [0, 1, 2].map(|joint| {
        state.duties()[joint].fraction() * WOODEN_HAPTICS_2016.motors[joint].torque_at_full * state.rates()[joint]
    });
    let power: f32 = torques.iter().sum();
    // Half a step of duty on each of three joints: 1.5e-5 of 1.24 N·m each, times the rates.
    let rounding: f32 = state.rates().iter().map(|rate| rate.abs() * 1.24 * 1.6e-5).sum();
    assert!(power <= rounding + 1e-9, "{power} W: {state:?}");
}

fn phase_instants(trace: &Trace, phase: Phase) -> Vec<usize> {
    // Not the last ticks: what follows is replayed from the trace.
    (0..trace.states.len() - AFTER - 10).filter(|tick| trace.states[*tick].phase() == phase).collect()
}

/// A stopped loop lets go, or brakes the hand if that was chosen.
#[test]
fn after_a_stop_the_device_is_limp_or_damped() {
    let (device, patch) = (device(), decayed());
    for output in [SafeOutput::Zero, SafeOutput::Damping(4.0)] {
        let servo = Servo::new(&device, &patch, Controller::CERTIFIED, SETTINGS).safety(safety(output));
        let trace = Trace::record(&servo, 7);
        let instants: Vec<usize> = phase_instants(&trace, Phase::Running).into_iter().step_by(50).collect();
        let mut braked = 0;
        for from in &instants {
            let mut state = trace.states[*from];
            servo.note(&mut state, Event::Stop);
            assert_eq!(state.duties(), [Duty::ZERO; 3], "at once");
            for tick in from + 1..from + 4 {
                servo.tick(&mut state, Input::Sensors { counts: trace.counts[tick], enable: enable(tick) });
                assert_safe(&state, output, true);
            }
            braked += usize::from(state.duties() != [Duty::ZERO; 3]);
        }
        println!("{output:?}: braked {braked} of {}", instants.len());
        // A hand at rest asks for nothing.
        let expected = if output == SafeOutput::Zero { 0..=0 } else { instants.len() / 2..=instants.len() };
        assert!(instants.len() > 20 && expected.contains(&braked), "{output:?}: {braked} of {}", instants.len());
    }
}

#[test]
fn every_fault_in_every_phase_is_safe_named_and_latched() {
    let (device, patch) = (device(), decayed());
    let mut seen = [[0_usize; Phase::ALL.len()]; Fault::ALL.len() + 1];
    for output in [SafeOutput::Zero, SafeOutput::Damping(4.0)] {
        let servo = Servo::new(&device, &patch, Controller::SECOND_ORDER, SETTINGS).safety(safety(output));
        let trace = Trace::record(&servo, 7);
        let strict = Servo::new(&device, &patch, Controller::SECOND_ORDER, SETTINGS)
            .safety(Safety { stuck: Some(StuckLimits { travel: 1e-4, ..StuckLimits::DEFAULT }), ..safety(output) });
        let shallow = Servo::new(&device, &patch, Controller::SECOND_ORDER, Settings { max_force: 1e-4, ..SETTINGS })
            .safety(Safety {
                contact: Some(ContactLimits { max_in_a_row: 0, min_depth: 0.0, ..ContactLimits::DEFAULT }),
                ..safety(output)
            });
        let mut bench =
            Bench { servo, strict, shallow, device: &device, patch: &patch, random: Pcg64::seed_from_u64(11) };
        for fault in Fault::ALL {
            for phase in Phase::ALL {
                // The phase of a stopped loop is made from a running one, by hand.
                let instants = phase_instants(&trace, if phase == Phase::Fault { Phase::Running } else { phase });
                assert!(!instants.is_empty(), "{phase:?}");
                for _ in 0..INSTANTS {
                    let tick = instants[bench.below(instants.len() as u32) as usize];
                    let mut state = trace.states[tick];
                    let first = if phase == Phase::Fault {
                        bench.servo.note(&mut state, Event::Stop);
                        Some((Fault::Stopped, state.ticks()))
                    } else {
                        None
                    };
                    let before = state;
                    let believable = match bench.inject(fault, &mut state, trace.counts[tick], enable(tick)) {
                        Seen::Now { believable } => believable,
                        Seen::Not => {
                            assert_in_range(&state);
                            assert!(phase == Phase::Running || state.duties() == [Duty::ZERO; 3]);
                            continue;
                        }
                    };
                    seen[fault.code() as usize][phase as usize] += 1;
                    // In the very tick.
                    assert_safe(&state, output, believable);
                    assert_eq!(state.phase(), Phase::Fault, "{fault:?} in {phase:?}");
                    let reset = matches!(fault, Fault::WatchdogReset | Fault::BrownOut);
                    let (named, at) = state.fault().unwrap();
                    match first {
                        Some(first) if !reset => assert_eq!((named, at), first, "the first one stands"),
                        _ => {
                            assert_eq!(named, fault, "in {phase:?}");
                            let expected = if reset { 0 } else { before.ticks() };
                            let late = match fault {
                                Fault::TableCorrupt => 2 * TICKS_PER_PASS,
                                Fault::LinkLost => LINK_TICKS,
                                Fault::JointStuck => STUCK_TICKS,
                                _ => 0,
                            };
                            assert!((expected..=expected + late).contains(&at), "{fault:?}: {at}, {expected}");
                        }
                    }
                    assert!(!named.to_string().is_empty() && Fault::from_code(named.code()) == Some(named));
                    // And for good.
                    let latched = state.fault();
                    for later in tick + 1..tick + AFTER {
                        let counts = trace.counts[later];
                        bench.servo.note(&mut state, Event::LinkAlive);
                        bench.servo.tick(&mut state, Input::Sensors { counts, enable: later % 3 > 0 });
                        assert_eq!((state.phase(), state.fault()), (Phase::Fault, latched));
                        assert_safe(&state, output, true);
                    }
                }
            }
        }
    }
    // Every cell was filled, but for what cannot be seen there.
    for fault in Fault::ALL {
        for phase in Phase::ALL {
            let count = seen[fault.code() as usize][phase as usize];
            let blind = match fault {
                Fault::JointJumped => phase == Phase::Reset,
                Fault::JointStuck | Fault::ContactLost => phase != Phase::Running,
                Fault::Overspeed | Fault::Supply | Fault::WrongSign => true,
                _ => false,
            };
            let partly = matches!(fault, Fault::JointStuck | Fault::ContactLost);
            assert!(
                if blind { count == 0 } else { count == 2 * INSTANTS || partly && count > 200 },
                "{fault:?} {phase:?} {count}"
            );
        }
    }
}

#[test]
fn a_stuck_encoder_is_found_while_the_others_go_on() {
    // The turntable sweeps over the wall under load while the first link's encoder says the same again and again.
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Controller::SECOND_ORDER, SETTINGS)
        // Half the usual way: the wall ends after 0.4 rad.
        .safety(Safety { stuck: Some(StuckLimits { travel: 0.3, ..StuckLimits::DEFAULT }), ..Safety::DEFAULT });
    let mut state = servo.start();
    let counts = |tick: i32| {
        // At (0.22, 0) over the foot, 3 mm below the wall, sweeping 0.5 rad a second; the second link's count lives on.
        [Counts((f64::from(tick) * 0.5 / 4_000.0 / -1.963e-4) as i32), Counts(-1_314), Counts(3_465 + 80 + tick % 2)]
    };
    // Down from above, so that contact begins in front.
    for step in 0..57 {
        let [a, b, c] = counts(0);
        servo.tick(&mut state, Input::Sensors { counts: [a, b, Counts(c.0 - 280 + step * 5)], enable: true });
    }
    let found = (0..8_000).find(|tick| {
        servo.tick(&mut state, Input::Sensors { counts: counts(*tick), enable: true });
        state.phase() == Phase::Fault
    });
    assert!(
        found.is_some() && state.duties() == [Duty::ZERO; 3] && state.fault().unwrap().0 == Fault::JointStuck,
        "{:?} {state:?}",
        found
    );
}

#[test]
fn overruns_are_counted_and_tolerated_as_allowed() {
    let safety = Safety { max_overruns: 2, ..Safety::DEFAULT };
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Controller::SECOND_ORDER, SETTINGS).safety(safety);
    let mut state = servo.start();
    let good = Input::Sensors { counts: [Counts(0); 3], enable: true };
    for _ in 0..100 {
        servo.tick(&mut state, good);
        servo.note(&mut state, Event::Overrun);
        servo.tick(&mut state, good);
        servo.note(&mut state, Event::Overrun);
        servo.tick(&mut state, good);
        servo.tick(&mut state, good);
    }
    assert_eq!((state.overruns(), state.fault()), (200, None));
    for _ in 0..3 {
        servo.note(&mut state, Event::Overrun);
        servo.tick(&mut state, good);
    }
    assert_eq!(state.fault(), Some((Fault::Overrun, 402)));
}

#[test]
fn the_loop_is_armed_only_when_settled_homed_and_checked() {
    let (device, patch) = (device(), decayed());
    let servo = Servo::new(&device, &patch, Controller::SECOND_ORDER, SETTINGS).safety(safety(SafeOutput::Zero));
    let mut state = servo.start();
    let good = Input::Sensors { counts: [Counts(0); 3], enable: true };
    assert_eq!(state.phase(), Phase::Reset);
    for _ in 0..80 {
        servo.tick(&mut state, good);
        assert_eq!((state.phase(), state.duties()), (Phase::Calibrate, [Duty::ZERO; 3]));
    }
    servo.note(&mut state, Event::LinkAlive);
    servo.note(&mut state, Event::Homed);
    let mut phases = Vec::new();
    for _ in 0..200 {
        servo.note(&mut state, Event::LinkAlive);
        servo.tick(&mut state, good);
        phases.push(state.phase());
    }
    let armed = phases.iter().position(|phase| *phase == Phase::Armed);
    // The first tick is that of reset; 200 of settling after it.
    assert_eq!(armed, Some(120));
    assert!(phases[121..].iter().all(|phase| *phase == Phase::Running));
    // The first one when the loop was started.
    assert_eq!(u64::from(state.table_check().passes), 1 + 280 / u64::from(TICKS_PER_PASS), "{:?}", state.table_check());
    assert_eq!(state.reset(), ResetReason::PowerOn);
    assert_eq!(servo.start_after(ResetReason::Pin).reset(), ResetReason::Pin);
}

#[test]
fn a_stale_table_is_never_armed() {
    let (device, mut patch) = (device(), decayed());
    patch.baked = Some(WALL.table_crc() ^ 1);
    let servo = Servo::new(&device, &patch, Controller::SECOND_ORDER, SETTINGS);
    let mut state = servo.start();
    for _ in 0..10 {
        servo.tick(&mut state, Input::Sensors { counts: [Counts(0); 3], enable: true });
        assert!(matches!(state.phase(), Phase::Calibrate | Phase::Fault));
    }
    assert_eq!(state.fault().map(|(fault, _)| fault), Some(Fault::TableCorrupt));
    assert_eq!(state.force(), Vec3::ZERO);
    // Unless the check was turned off.
    let unchecked = servo.safety(Safety { checks_tables: false, ..Safety::DEFAULT });
    let mut state = unchecked.start();
    for _ in 0..10 {
        unchecked.tick(&mut state, Input::Sensors { counts: [Counts(0); 3], enable: true });
    }
    assert_eq!((state.phase(), state.fault()), (Phase::Running, None));
}
