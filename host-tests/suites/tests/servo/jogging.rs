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
