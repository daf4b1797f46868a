//! The fault matrix: every fault in every phase at a thousand seeded instants, with both safe outputs.

use crate::harmed::{LINK_TICKS, decayed, device, safety};
use crate::injection::{Bench, STUCK_TICKS, Seen, TICKS_PER_PASS};
use crate::traces::{SETTINGS, Trace, enable};
use palpate::device::Duty;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::servo::{
    Config, ContactLimits, Event, Fault, Input, Phase, SafeOutput, Safety, Servo, ServoState, Settings, StuckLimits,
};
use palpate::track::{Controller, FirstOrder};
use rand::SeedableRng;
use rand_pcg::Pcg64;

const INSTANTS: usize = 1_000;
/// Ticks of good sensors after a fault, in which it must not come loose.
const AFTER: usize = 30;

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
        state.duties()[joint].fraction() * WOODEN_HAPTICS_2016.motors[joint].torque_at_full_n_m * state.rates()[joint]
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
        let servo = Servo::new(
            &device,
            &patch,
            Config {
                controller: Controller::FirstOrder(FirstOrder::CERTIFIED),
                settings: SETTINGS,
                safety: safety(output),
                ..Config::DEFAULT
            },
        );
        let trace = Trace::record(&servo, 7);
        let instants: Vec<usize> = phase_instants(&trace, Phase::Running).into_iter().step_by(50).collect();
        let mut braked = 0;
        for from in &instants {
            let mut state = trace.states[*from];
            servo.note(&mut state, Event::Stop);
            assert_eq!(state.duties(), [Duty::ZERO; 3], "at once");
            for tick in from + 1..from + 4 {
                let _ = servo.tick(&mut state, Input::Sensors { counts: trace.counts[tick], enable: enable(tick) });
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
        let servo =
            Servo::new(&device, &patch, Config { settings: SETTINGS, safety: safety(output), ..Config::DEFAULT });
        let trace = Trace::record(&servo, 7);
        let strict = Servo::new(
            &device,
            &patch,
            Config {
                settings: SETTINGS,
                safety: Safety {
                    stuck: Some(StuckLimits { travel_m: 1e-5, ..StuckLimits::DEFAULT }),
                    ..safety(output)
                },
                ..Config::DEFAULT
            },
        );
        let shallow = Servo::new(
            &device,
            &patch,
            Config {
                settings: Settings { max_force_n: 1e-4, ..SETTINGS },
                safety: Safety {
                    contact: Some(ContactLimits { max_in_a_row: 0, min_depth_m: 0.0, ..ContactLimits::DEFAULT }),
                    ..safety(output)
                },
                ..Config::DEFAULT
            },
        );
        let mut bench =
            Bench { servo, strict, shallow, device: &device, patch: &patch.0, random: Pcg64::seed_from_u64(11) };
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
                        let _ = bench.servo.tick(&mut state, Input::Sensors { counts, enable: later % 3 > 0 });
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
                Fault::Overspeed | Fault::Supply | Fault::WrongPolarity | Fault::OtherRate => true,
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
