//! A dial in C beside the same dial in Rust, tick by tick: while it turns and rests, its feel is changed at random, and
//! what is refused in Rust is not even tried there.

use crate::example::cannot_panic;
use crate::running::{is_wanted, program, run};
use palpate::device::drive::Feed;
use palpate::device::presets::{GIMBAL_KNOB, GIMBAL_KNOB_PROTECTION as PROTECTION};
use palpate::device::{Counts, Device, Dial, Homing, Reference};
use palpate::render::{Detents, DialFriction, Ends, Feel, FeelPart, Notch, Spring, Wave};
use palpate::servo::{Config, Fault, Input, Knob, KnobError, Output, Servo, Settings};
use rand::{Rng, RngExt as _, SeedableRng};
use rand_pcg::Pcg64;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

const TICKS: usize = 20_000;
const RATE: f32 = 4_000.0;
const LET_GO: f32 = 1.2;
/// It turns for 250 ticks, rests for 90, and is changed then.
const SPELL: usize = 400;
const RESTS_AT: usize = 250;
const CHANGED_AT: usize = 340;
/// From here on the sensor lies.
const JUMPS_AT: usize = 19_500;

/// Its driver controls the current.
const DEVICE: Device<Dial, 1> = Device { feeds: [Feed::Current], ..GIMBAL_KNOB };
static FREE: [Feel; 1] = [Feel::FREE];
static KNOB: Knob = Knob::new(&DEVICE, &FREE, LET_GO);

/// Words of the header's structure of a feel, and where in it each part starts.
const WORDS: usize = 27;
const STARTS: [usize; 9] = [0, 0, 3, 11, 14, 17, 21, 22, 24];

/// A part, most of which the device bears: as Rust has it, its code, and the words of the header's structure.
fn any_part(random: &mut Pcg64, near: f32) -> (FeelPart, u32, Vec<u32>) {
    let kind = random.next_u32() % 9;
    let mut some = |least: f32, most: f32| {
        let bad = [-most, f32::NAN, f32::INFINITY, 40.0 * most];
        let spoiled = random.next_u32() % 24;
        bad.get(spoiled as usize).copied().unwrap_or_else(|| random.random_range(least..most))
    };
    let bits = |numbers: &[f32]| numbers.iter().map(|number| number.to_bits()).collect();
    let mut wave = || Wave { pitch_rad: some(0.02, 0.7), torque_n_m: some(1e-3, 0.02), centre_rad: some(-0.3, 0.3) };
    let (part, words) = match kind {
        0 => (FeelPart::Free, Vec::new()),
        1 | 3 => {
            let wave @ Wave { pitch_rad, torque_n_m, centre_rad } = wave();
            let part = if kind == 1 { FeelPart::Detents(Some(wave)) } else { FeelPart::Texture(Some(wave)) };
            (part, bits(&[pitch_rad, torque_n_m, centre_rad]))
        }
        2 => {
            let pitch = some(0.1, 0.5);
            let middle = (near / pitch) as i32;
            let [stiffness, damping, snap] = [some(0.01, 0.1), some(1e-5, 5e-4), some(0.5, 1.0)];
            let [wall_stiffness, max_force] = [some(0.01, 0.4), some(1e-3, 0.02)];
            let [first, last] =
                [middle.saturating_sub(some(1.0, 9.0) as i32), middle.saturating_add(some(1.0, 9.0) as i32)];
            let clicks = Detents { pitch, stiffness, damping, snap, first, last, wall_stiffness, max_force };
            let mut words: Vec<u32> = bits(&[pitch, stiffness, damping, snap]);
            words.extend([first as u32, last as u32, wall_stiffness.to_bits(), max_force.to_bits()]);
            (FeelPart::Clicks(Some(clicks)), words)
        }
        4 => {
            let [stiffness_n_m_per_rad, rest_rad, max_torque_n_m] =
                [some(1e-3, 0.1), near + some(-1.0, 1.0), some(1e-3, 0.02)];
            let part = FeelPart::Spring(Some(Spring { stiffness_n_m_per_rad, rest_rad, max_torque_n_m }));
            (part, bits(&[stiffness_n_m_per_rad, rest_rad, max_torque_n_m]))
        }
        5 => {
            let between_rad = [near - some(0.1, 2.0), near + some(0.1, 2.0)];
            let [stiffness_n_m_per_rad, damping_n_m_s_per_rad] = [some(0.01, 0.5), some(1e-5, 5e-4)];
            let part = FeelPart::Ends(Some(Ends { between_rad, stiffness_n_m_per_rad, damping_n_m_s_per_rad }));
            (part, bits(&[between_rad[0], between_rad[1], stiffness_n_m_per_rad, damping_n_m_s_per_rad]))
        }
        6 => {
            let damping = some(1e-5, 1e-3);
            (FeelPart::Damping(damping), bits(&[damping]))
        }
        7 => {
            let [torque_n_m, whole_at_rad_per_s] = [some(1e-3, 0.01), some(2.0, 20.0)];
            let part = FeelPart::Friction(Some(DialFriction { torque_n_m, whole_at_rad_per_s }));
            (part, bits(&[torque_n_m, whole_at_rad_per_s]))
        }
        _ => {
            let [at_rad, width_rad, torque_n_m] = [near + some(-0.5, 0.5), some(0.05, 1.0), some(1e-3, 0.02)];
            (FeelPart::Notch(Some(Notch { at_rad, width_rad, torque_n_m })), bits(&[at_rad, width_rad, torque_n_m]))
        }
    };
    let mut all = vec![0; STARTS[kind as usize]];
    all.extend(words);
    all.resize(WORDS, 0);
    (part, kind, all)
}

/// What C says of a refusal.
fn in_words(refused: Result<(), KnobError>) -> &'static str {
    match refused {
        Ok(()) => "done",
        Err(KnobError::Feel(error)) => error.message(),
        Err(KnobError::Stiffness { .. }) => "the feel is stiffer than max_stiffness",
        Err(KnobError::Damping { .. }) => "the feel damps more than max_damping",
        Err(KnobError::Torque { .. }) => "the feel's torques add up to more than max_force",
        Err(KnobError::Motor { .. }) => "the feel's torques add up to more than the motor's torque_at_full",
        Err(KnobError::Far { .. }) => "the dial is more than an eighth of a turn from there",
        Err(KnobError::Undamped { .. }) => "the feel is too stiff for its damping",
        Err(other) => panic!("{other}"),
    }
}

/// The number of a refusal and its limit.
fn beyond(refused: Result<(), KnobError>) -> [f32; 2] {
    match refused {
        Err(KnobError::Stiffness { asked_n_m_per_rad: asked, limit_n_m_per_rad: limit })
        | Err(KnobError::Damping { asked_n_m_s_per_rad: asked, limit_n_m_s_per_rad: limit })
        | Err(
            KnobError::Torque { asked_n_m: asked, limit_n_m: limit }
            | KnobError::Motor { asked_n_m: asked, limit_n_m: limit },
        )
        | Err(KnobError::Undamped { asked_n_m_s_per_rad: asked, needed_n_m_s_per_rad: limit }) => [asked, limit],
        Err(KnobError::Far { asked_rad }) => [asked_rad, std::f32::consts::FRAC_PI_4],
        _ => [0.0; 2],
    }
}

/// FNV-1a of the words of the header's structure.
fn sum_of(feel: &Feel) -> u32 {
    let wave = |wave: Option<Wave>| wave.map_or([0.0; 3], |wave| [wave.pitch_rad, wave.torque_n_m, wave.centre_rad]);
    let clicks = feel.clicks.map_or([0; 8], |clicks| {
        let Detents { pitch, stiffness, damping, snap, first, last, wall_stiffness, max_force } = clicks;
        let [first, last] = [first, last].map(|number| f32::from_bits(number as u32));
        [pitch, stiffness, damping, snap, first, last, wall_stiffness, max_force].map(f32::to_bits)
    });
    let spring = feel.spring.map_or([0.0; 3], |it| [it.stiffness_n_m_per_rad, it.rest_rad, it.max_torque_n_m]);
    let ends = feel.ends.map_or([0.0; 4], |it| {
        [it.between_rad[0], it.between_rad[1], it.stiffness_n_m_per_rad, it.damping_n_m_s_per_rad]
    });
    let friction = feel.friction.map_or([0.0; 2], |it| [it.torque_n_m, it.whole_at_rad_per_s]);
    let notch = feel.notch.map_or([0.0; 3], |it| [it.at_rad, it.width_rad, it.torque_n_m]);
    let before = wave(feel.detents).map(f32::to_bits).into_iter().chain(clicks);
    let after = [&wave(feel.texture)[..], &spring, &ends, &[feel.damping_n_m_s_per_rad], &friction, &notch].concat();
    let words = before.chain(after.into_iter().map(f32::to_bits));
    words.fold(2_166_136_261, |hash, word| (hash ^ word).wrapping_mul(16_777_619))
}

#[test]
fn a_dial_whose_feel_is_changed_at_random_has_the_bits_of_rust_and_makes_no_step() {
    if !is_wanted("a dial in C") {
        return;
    }
    let settings = Settings { rate_hz: RATE, max_force_n: DEVICE.max_force_n, ..Settings::DEFAULT };
    let homing = Homing::try_new(DEVICE.encoders, Reference::Pose([0.0]), 40, 2, 4_000).expect("a homing");
    let config = Config { settings, homing: Some(homing), ..Config::DEFAULT };
    let servo = Servo::try_protected(&DEVICE, &KNOB, PROTECTION, config).expect("a loop");
    let mut state = servo.start();
    let spring = Spring { stiffness_n_m_per_rad: 0.05, rest_rad: 0.0, max_torque_n_m: 0.03 };
    let damping = 1e-3_f32;
    KNOB.restore(state.witness_mut(), Feel { spring: Some(spring), damping_n_m_s_per_rad: damping, ..Feel::FREE })
        .expect("within the device");

    let mut stream: Vec<u32> = [
        DEVICE.kinematics.radius_m,
        LET_GO,
        DEVICE.encoders[0].radians_per_count,
        0.0,
        DEVICE.motors[0].torque_at_full_n_m,
        DEVICE.dry_friction_n_m[0],
        f32::NEG_INFINITY,
        f32::INFINITY,
        DEVICE.min_margin_m_per_rad,
        DEVICE.max_joint_rate_rad_per_s,
        DEVICE.max_force_n,
        DEVICE.max_stiffness_n_per_m,
        DEVICE.max_damping_n_s_per_m,
        PROTECTION.motors[0].continuous,
        PROTECTION.motors[0].time_constant_s,
        PROTECTION.max_joint_rates_rad_per_s[0],
        PROTECTION.max_probe_speed_m_per_s,
    ]
    .map(f32::to_bits)
    .into();
    let mut first = [0; WORDS];
    for (place, number) in first[STARTS[4]..].iter_mut().zip([0.05_f32, 0.0, 0.03]) {
        *place = number.to_bits();
    }
    first[STARTS[6]] = damping.to_bits();
    stream.extend(first);

    let random = &mut Pcg64::seed_from_u64(7);
    let (mut counts, mut pace, mut expected, mut said) = (0_i32, 0_i32, String::new(), BTreeMap::new());
    let (mut before, mut step, mut largest) = (0_i32, 0, 0);
    for tick in 0..TICKS {
        let within = tick % SPELL;
        if within == 0 {
            pace = random.random_range(-50..350) * i32::from(tick > 0);
        }
        if within < RESTS_AT {
            counts += pace / 10;
        }
        if tick == JUMPS_AT {
            counts += 4_000;
        }
        let enable = tick >= SPELL && tick / SPELL % 12 != 7;
        stream.extend([counts as u32, u32::from(enable)]);
        // At rest, and a few while it turns.
        if within >= CHANGED_AT && within.is_multiple_of(20) || tick.is_multiple_of(97) {
            let (part, code, words) = any_part(random, state.witness().angle().unwrap_or(0.0));
            let mut tried = *state.witness();
            let done = KNOB.set(&mut tried, part);
            if done.is_ok() {
                *state.witness_mut() = tried;
            }
            let said = said.entry(in_words(done)).or_insert(0);
            *said += 1;
            let [asked, limit] = beyond(done).map(f32::to_bits);
            let sum = state.witness().own().map_or(0, sum_of);
            let _ = writeln!(expected, "{}|{asked:08x} {limit:08x} {sum:08x}", in_words(done));
            stream.push(code);
            stream.extend(words);
        } else {
            stream.push(u32::MAX);
            stream.extend([0; WORDS]);
        }
        let _ = servo.tick(&mut state, Input::Sensors { counts: [Counts(counts)], enable });
        let [duty] = state.duties();
        let (duty, dial) = (i32::from(duty.0), KNOB.dial(state.witness(), state.angles()[0], state.phase()));
        if within >= CHANGED_AT && state.fade() == 1.0 && tick < JUMPS_AT {
            step = step.max((duty - before).abs());
        }
        (before, largest) = (duty, largest.max(duty.abs()));
        let drives = matches!(state.output(), Output::Drive(_));
        let _ = writeln!(
            expected,
            "{} {duty} {:08x} {} {} {} {}",
            i32::from(drives),
            state.digest(),
            dial.turns,
            dial.angle_rad,
            dial.detent,
            dial.end
        );
        assert!(tick < JUMPS_AT || !drives, "it drives after the jump");
    }
    println!("{said:?}, {step} of a step, {largest} at most, {} turns", state.turns());
    assert!(said["done"] > 100 && said.len() > 10, "{said:?}");
    assert!(state.turns().abs() > 0, "{}", state.turns());
    assert_eq!(state.fault().map(|(fault, _)| fault), Some(Fault::JointJumped));
    // At rest nothing but the release moves the torque; and none is above the device's force at the rim.
    let share = |torque: f32| (32_767.0 * torque / DEVICE.motors[0].torque_at_full_n_m).ceil() as i32;
    assert!(step > 0 && step <= share(LET_GO / RATE) + 1, "{step}");
    assert!(largest <= share(DEVICE.max_force_n * DEVICE.kinematics.radius_m), "{largest}");

    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("stream"), bytemuck::cast_slice::<u32, u8>(&stream)).expect("a stream");
    let in_c = run(program("tests/knob.c", folder.path(), &[]).arg(folder.path().join("stream")));
    let mut lines = in_c.lines();
    for (index, expected) in expected.lines().enumerate() {
        let said = lines.next().unwrap_or_default();
        let same = match expected.split_once('|') {
            Some((words, numbers)) => said.starts_with(words) && said.ends_with(numbers),
            None => same_numbers(said, expected),
        };
        assert!(same, "line {index}:\nC    {said}\nRust {expected}");
    }
    assert_eq!(lines.collect::<Vec<_>>(), ["joint angle jumped"]);
}

#[test]
fn a_dial_and_its_feel_are_by_one_angle_and_nothing_jumps_where_it_is_released() {
    if !is_wanted("the angle of a dial in C") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(run(&mut program("tests/frame.c", folder.path(), &[])), "");
}

/// As much as links a dial's loop.
const LINKED: &str = "#include <palpate.h>
int main(void)
{
    static palpate_servo servo;
    static const palpate_dial dial;
    static const palpate_device device;
    static const palpate_feel feel;
    static const palpate_settings settings;
    static const palpate_protection protection;
    palpate_turned turned;
    palpate_output output;
    palpate_servo_start_dial_protected(&servo, sizeof servo, &dial, &device, &feel, &settings, &protection, 0);
    palpate_servo_set_feel(&servo, 2, &feel, 0);
    palpate_feel now;
    palpate_servo_feel(&servo, &now);
    palpate_servo_tick(&servo, &turned.turns, 1, 1, &output);
    return palpate_servo_dial(&servo, &turned);
}
";

#[test]
fn the_image_of_a_dial_cannot_panic() {
    if !is_wanted("the image of a dial in C") {
        return;
    }
    cannot_panic(LINKED, "Knob");
}

/// Whether two rows are the same, but for how an angle is written.
fn same_numbers(said: &str, expected: &str) -> bool {
    let bits = |row: &str| -> Vec<String> {
        let word = |(index, word): (usize, &str)| match (index, word.parse::<f32>()) {
            (4, Ok(angle)) => angle.to_bits().to_string(),
            _ => word.to_owned(),
        };
        row.split(' ').enumerate().map(word).collect()
    };
    bits(said) == bits(expected)
}
