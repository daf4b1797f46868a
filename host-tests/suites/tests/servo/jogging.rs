//! Commissioning commands, sound and fuzzed: no motor moves unless somebody holds the key.

use palpate::commission::{Jog, JogLimits, JogRefusal, JogState, Jogging, KEY};
use palpate::device::{Counts, Duty};
use palpate::wire::frame::{MAX_FRAME, Received, Receiver, pack};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

const RATE: f32 = 4_000.0;
const MOST: Duty = Duty(6_000);
const LIMITS: JogLimits<3> =
    JogLimits { max_duty: [MOST; 3], max_speed_counts_per_s: 4_000.0, max_travel_counts: 10_000, patience_s: 0.1 };
const STILL: Option<[Counts; 3]> = Some([Counts(0); 3]);

fn jogging() -> Jogging<3> {
    Jogging::try_new(LIMITS, RATE).unwrap()
}

/// A million frames of every kind, none of which holds the key: random bytes, flipped bits of frames that do, numbers
/// out of order, keys that are nearly right.
#[test]
fn no_fuzzed_command_moves_a_motor_without_the_key() {
    let jogging = jogging();
    let (mut state, mut receiver) = (JogState::default(), Receiver::<Jog>::new());
    let mut random = Pcg64::seed_from_u64(5);
    let (mut taken, mut buffer) = (0_u32, [0; MAX_FRAME]);
    for number in 0..1_000_000_u32 {
        let draw = random.next_u64();
        let key = match draw % 4 {
            0 => 0,
            1 => KEY ^ (1 << (draw >> 8 & 31)),
            2 => KEY,
            _ => (draw >> 16) as u32 & !KEY,
        };
        let jog = Jog { number, key, motor: (draw >> 40) as u8 % 5, duty: (draw >> 48) as i16 };
        let mut frame = pack(&jog, &mut buffer).unwrap().to_vec();
        if key == KEY {
            // Changed on the way, by one bit to four: the CRC finds them all.
            for _ in 0..=random.next_u64() % 4 {
                let at = random.next_u64() as usize % (frame.len() - 1);
                frame[at] ^= 1 << (random.next_u64() % 8);
            }
            if frame == pack(&jog, &mut [0; MAX_FRAME]).unwrap() {
                continue;
            }
        } else if draw.is_multiple_of(7) {
            frame = (0..random.next_u64() % 40).map(|_| random.next_u64() as u8).collect();
            frame.push(0);
        }
        for byte in frame {
            if let Some(Received::Message(jog)) = receiver.feed(byte) {
                taken += 1;
                jogging.command(&mut state, jog);
            }
        }
        jogging.tick(&mut state, STILL, true);
        assert_eq!(state.duties(), [Duty::ZERO; 3], "{number}");
        assert!(!state.is_live());
    }
    assert!(taken > 500_000, "most frames without the key are sound: {taken}");
}

/// Holds the key on a motor for so many ticks, a frame every 80 ticks.
fn hold(
    jogging: &Jogging<3>,
    state: &mut JogState<3>,
    number: &mut u32,
    motor: u8,
    ticks: u32,
    counts: impl Fn(u32) -> i32,
) {
    for tick in 0..ticks {
        if tick.is_multiple_of(80) {
            *number += 1;
            jogging.command(state, Jog { number: *number, key: KEY, motor, duty: i16::MAX });
        }
        jogging.tick(state, Some([Counts(counts(tick)); 3]), true);
    }
}

#[test]
fn a_held_key_drives_one_motor_within_its_limit_and_a_silent_or_repeated_one_none() {
    let jogging = jogging();
    let (mut state, mut number) = (JogState::default(), 0);
    jogging.tick(&mut state, STILL, true);
    hold(&jogging, &mut state, &mut number, 1, 800, |_| 0);
    assert_eq!(state.duties(), [Duty::ZERO, MOST, Duty::ZERO]);
    // The last frame over and over is no key.
    for tick in 0..2_000 {
        jogging.command(&mut state, Jog { number, key: KEY, motor: 1, duty: i16::MAX });
        jogging.tick(&mut state, STILL, true);
        assert!(tick < 400 || state.duties() == [Duty::ZERO; 3], "a tenth of a second at 4 kHz: {tick}");
    }
    // Neither is one without the enable input.
    for _ in 0..10 {
        number += 1;
        jogging.command(&mut state, Jog { number, key: KEY, motor: 1, duty: 100 });
        jogging.tick(&mut state, STILL, false);
        assert_eq!(state.duties(), [Duty::ZERO; 3]);
    }
}

#[test]
fn what_ends_a_jog_stands_until_the_key_is_let_go() {
    let jogging = jogging();
    for (refusal, counts, motor) in [
        (JogRefusal::TooFast, (|tick| tick as i32 * 3) as fn(u32) -> i32, 0),
        (JogRefusal::TooFar, |tick| tick as i32 / 2, 0),
        (JogRefusal::NoMotor, |_| 0, 3),
    ] {
        let limits = JogLimits { max_travel_counts: 200, ..LIMITS };
        let jogging = if refusal == JogRefusal::TooFar { Jogging::try_new(limits, RATE).unwrap() } else { jogging };
        let (mut state, mut number) = (JogState::default(), 0);
        jogging.tick(&mut state, STILL, true);
        hold(&jogging, &mut state, &mut number, motor, 4_000, counts);
        assert_eq!((state.refusal(), state.duties()), (Some(refusal), [Duty::ZERO; 3]));
        jogging.command(&mut state, Jog { number: number + 1, key: 0, motor, duty: 0 });
        assert_eq!(state.refusal(), None);
    }
    // A sensor that fails, and another motor under a held key.
    let (mut state, mut number) = (JogState::default(), 0);
    jogging.tick(&mut state, STILL, true);
    hold(&jogging, &mut state, &mut number, 0, 800, |_| 0);
    jogging.tick(&mut state, None, true);
    assert_eq!((state.refusal(), state.duties()), (Some(JogRefusal::Sensor), [Duty::ZERO; 3]));
    let (mut state, mut number) = (JogState::default(), 0);
    jogging.tick(&mut state, STILL, true);
    hold(&jogging, &mut state, &mut number, 0, 800, |_| 0);
    hold(&jogging, &mut state, &mut number, 1, 1, |_| 0);
    assert_eq!((state.refusal(), state.duties()), (Some(JogRefusal::OtherMotor), [Duty::ZERO; 3]));
}

/// A motor that a host jogs repeatedly, after a number of ticks of silence or of frames without the key: the counts that
/// it is driven by in all, at two counts a tick while it is driven.
fn driven(limits: JogLimits<3>, tells: bool) -> (i32, Option<JogRefusal>) {
    let jogging = Jogging::try_new(limits, RATE).unwrap();
    let (mut state, mut number, mut count) = (JogState::default(), 0, 0);
    jogging.tick(&mut state, STILL, true);
    for tick in 0..400_000_u32 {
        let is_held = tick % 1_200 < 400;
        if tick.is_multiple_of(80) && (is_held || tells) {
            number += 1;
            let key = if is_held { KEY } else { 0 };
            jogging.command(&mut state, Jog { number, key, motor: 0, duty: i16::MAX });
        }
        count += if state.duties()[0].0 > 0 { i32::from(tick.is_multiple_of(2)) } else { 0 };
        jogging.tick(&mut state, Some([Counts(count); 3]), true);
    }
    (count, state.refusal())
}

#[test]
fn a_travel_does_not_start_again_after_a_silence_or_another_press_of_the_key() {
    let limits = JogLimits { max_travel_counts: 1_000, ..LIMITS };
    // After a silence nothing is driven until a frame without the key has come.
    let (silent, refusal) = driven(limits, false);
    assert!(silent <= 1_001, "{silent}");
    assert_eq!(refusal, Some(JogRefusal::Silent));
    let (released, _) = driven(limits, true);
    assert!(released <= 1_001, "{released}");
    assert!(released > 900, "it gets there: {released}");
}

#[test]
fn a_joint_that_falls_back_may_be_lifted_again_and_another_press_of_enable_starts_another_travel() {
    let limits = JogLimits { max_travel_counts: 1_000, ..LIMITS };
    let jogging = Jogging::try_new(limits, RATE).unwrap();
    let (mut state, mut number) = (JogState::default(), 0);
    jogging.tick(&mut state, STILL, true);
    for _ in 0..5 {
        hold(&jogging, &mut state, &mut number, 0, 1_800, |tick| tick as i32 / 2);
        assert_eq!(state.refusal(), None);
        number += 1;
        jogging.command(&mut state, Jog { number, key: 0, motor: 0, duty: 0 });
        (0..900).for_each(|back| jogging.tick(&mut state, Some([Counts(900 - back); 3]), true));
    }
    // Without falling back: a hundred counts more.
    for (again, refusal) in [(0, None), (1, Some(JogRefusal::TooFar))] {
        hold(&jogging, &mut state, &mut number, 0, 1_800, |tick| again * 900 + tick as i32 / 2);
        assert_eq!(state.refusal(), refusal);
    }
    number += 1;
    jogging.command(&mut state, Jog { number, key: 0, motor: 0, duty: 0 });
    jogging.tick(&mut state, Some([Counts(1_100); 3]), false);
    hold(&jogging, &mut state, &mut number, 0, 1_800, |tick| 1_100 + tick as i32 / 2);
    assert_eq!(state.refusal(), None);
}
