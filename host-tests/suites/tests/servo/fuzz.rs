//! Arbitrary sensors: no panic, no bad output. A million ticks in every run; ten million with `-- --ignored`.

use crate::surfaces::{Cap, WALL};
use crate::traces::SETTINGS;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Counts, Device, Duty, Motor, SerialArm, VelocityMethod};
use palpate::math::{Vec3, vec3};
use palpate::render::{Coupling, Friction, Passivity, Texture, TextureShape, grating};
use palpate::servo::{
    Config, Event, Input, OnePatch, Phase, Rendering, ResetReason, SafeOutput, Safety, Servo, Settings, StuckLimits,
    Surface,
};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// Motors that give NaN, whatever the torque.
const BROKEN: Device<SerialArm, 3> = Device {
    motors: [
        Motor { torque_at_full_n_m: 0.0 },
        Motor { torque_at_full_n_m: f32::NAN },
        Motor { torque_at_full_n_m: 1e-38 },
    ],
    ..WOODEN_HAPTICS_2016
};

fn renderings() -> Vec<Rendering> {
    let friction = Friction {
        stiffness_n_per_m: 800.0,
        damping_n_s_per_m: 1.0,
        static_coefficient: 0.6,
        dynamic_coefficient: 0.4,
    };
    let wild = |touch: &palpate::render::Touch| vec3(1.0 / touch.velocity.x, touch.push * 1e30, f32::NAN);
    let passivity = Passivity {
        device_damping_n_s_per_m: 0.1,
        device_friction_n: 0.01,
        max_damping_n_s_per_m: 8.0,
        resolution_m: 1e-4,
    };
    vec![
        Rendering::PLAIN,
        Rendering {
            friction: Some(friction),
            texture: Some(Texture {
                shape: TextureShape::Custom(|touch| grating(touch, 100.0, 0.3)),
                max_fraction: 0.2,
            }),
            max_slew_n_per_s: 200.0,
            ..Rendering::PLAIN
        },
        Rendering {
            velocity: VelocityMethod::BetweenCounts,
            texture: Some(Texture { shape: TextureShape::Custom(wild), max_fraction: 0.5 }),
            coupling: Some(Coupling { stiffness_n_per_m: 500.0, damping_n_s_per_m: 3.0, mass_kg: 0.02 }),
            friction: Some(friction),
            passivity: Some(passivity),
            ..Rendering::PLAIN
        },
        Rendering { passivity: Some(passivity), ..Rendering::PLAIN },
        Rendering { friction: Some(friction), passivity: Some(passivity), ..Rendering::SMOOTH },
    ]
}

#[derive(Default, Debug)]
struct Tally {
    running: u64,
    driven: u64,
    touching: u64,
    stopped: u64,
}

fn fuzz<S: Surface>(
    device: &Device<SerialArm, 3>,
    surface: &S,
    rendering: Rendering,
    output: SafeOutput,
    ticks: u64,
    seed: u64,
) -> Tally {
    // The wall lies where counts of zero put the probe, so that a walk about zero touches it: height 285 mm less 80 mm,
    // reach 245 mm less 220.
    let settings = Settings { body_origin_m: vec3(0.025, 0.0, 0.205), ..SETTINGS };
    let stuck = Some(StuckLimits { load: 1.0, travel_m: 0.02 });
    let safety = Safety { output, stuck, ..Safety::DEFAULT };
    let config = Config { settings, rendering, safety, ..Config::DEFAULT };
    // A sound device has passed the check: only what comes to stand in RAM later can be broken.
    let servo = Servo::try_new(&WOODEN_HAPTICS_2016, surface, config).unwrap().calibrated(device);
    let mut random = Pcg64::seed_from_u64(seed);
    let mut state = servo.start();
    let mut counts = [0_i32; 3];
    let mut drift = [0_i32; 3];
    let mut tally = Tally::default();
    let mut stopped_for = 0;
    for _ in 0..ticks {
        let bits = random.next_u64();
        let input = match bits % 1_024 {
            0 => Input::Lost,
            1 => Input::Damaged,
            // Anything at all.
            2 => Input::Sensors {
                counts: [bits >> 10, bits >> 20, bits >> 32].map(|word| Counts(word as i32)),
                enable: true,
            },
            // A walk that a device could make, drawn back to where the wall is.
            _ => {
                for (joint, count) in counts.iter_mut().enumerate() {
                    if bits >> (50 + joint) & 63 == 0 {
                        drift[joint] = (bits >> (20 + 5 * joint) & 7) as i32 - 3;
                    }
                    let pull = if *count > 300 {
                        -4
                    } else if *count < -300 {
                        4
                    } else {
                        0
                    };
                    *count += drift[joint] + pull + (bits >> (12 + joint) & 1) as i32;
                }
                Input::Sensors { counts: counts.map(Counts), enable: bits >> 40 & 255 != 0 }
            }
        };
        if bits >> 30 & 4_095 == 0 {
            let events = [
                Event::LinkAlive,
                Event::Homed,
                Event::Overrun,
                Event::DriveFault,
                Event::HomingRefused,
                Event::Stop,
                Event::CalibrationRefused,
            ];
            servo.note(&mut state, events[(bits >> 44) as usize % events.len()]);
        }
        let before = state.fault();
        let _ = servo.tick(&mut state, input);

        assert!(state.duties().iter().all(|duty| duty.0 != i16::MIN), "{state:?}");
        // Rounding of the length.
        assert!(state.force().is_finite() && state.force().length() <= 5.0 * (1.0 + 1e-6), "{state:?}");
        assert!(state.rates().iter().all(|rate| rate.is_finite()) && state.energy().stored.is_finite());
        assert_eq!(state.phase() == Phase::Fault, state.fault().is_some());
        assert!(before.is_none() || state.fault() == before, "a fault came loose");
        let drives = state.phase() == Phase::Running || state.phase() == Phase::Fault && output != SafeOutput::Zero;
        assert!(drives || state.duties() == [Duty::ZERO; 3] && state.force() == Vec3::ZERO, "{state:?}");

        tally.running += u64::from(state.phase() == Phase::Running);
        tally.driven += u64::from(state.duties() != [Duty::ZERO; 3]);
        tally.touching += u64::from(state.contact() == palpate::track::Contact::Touching);
        tally.stopped += u64::from(state.phase() == Phase::Fault);
        stopped_for = if state.phase() == Phase::Fault { stopped_for + 1 } else { 0 };
        if stopped_for == 20 {
            let reasons = [ResetReason::PowerOn, ResetReason::Pin, ResetReason::Software, ResetReason::Unknown];
            state = servo.start_after(if bits & 15 == 0 {
                ResetReason::Watchdog
            } else {
                reasons[(bits >> 8) as usize % 4]
            });
            stopped_for = 0;
        }
    }
    tally
}

#[test]
fn ten_million_ticks_of_arbitrary_sensors_give_no_bad_output() {
    let ticks = 10_000_000;
    let renderings = renderings();
    let cases = renderings.len() as u64 * 4;
    for (index, rendering) in renderings.into_iter().enumerate() {
        for (other, output) in [SafeOutput::Zero, SafeOutput::Damping(5.0)].into_iter().enumerate() {
            let seed = (index * 10 + other) as u64;
            for tally in [
                fuzz(&WOODEN_HAPTICS_2016, &WALL, rendering, output, ticks / cases, seed),
                fuzz(&WOODEN_HAPTICS_2016, &OnePatch(Cap { radius: 0.05 }), rendering, output, ticks / cases, seed + 5),
            ] {
                println!("{index} {output:?}: {tally:?}");
                // It was alive: it ran, it stopped, and it drove the motors.
                let part = ticks / cases / 100;
                assert!(tally.running > part && tally.stopped > part && tally.driven > part, "{tally:?}");
            }
        }
        let tally = fuzz(&BROKEN, &WALL, rendering, SafeOutput::Damping(5.0), 20_000, 99);
        assert_eq!(tally.driven, 0, "motors without a torque are a fault, not a duty");
    }
}
