//! Frames under arbitrary messages and arbitrary damage.

use palpate::wire::Sensors;
use palpate::wire::frame::{DELIMITER, MAX_FRAME, Received, Receiver, pack};
use palpate_truth::generate::Random;

/// Seeded cases a test.
const CASES: u32 = 2_000;

fn byte(random: &mut Random) -> u8 {
    random.below(256) as u8
}

/// A number of any size; often one with few bits.
fn word(random: &mut Random) -> u32 {
    let bytes = u32::from_le_bytes(std::array::from_fn(|_| byte(random)));
    bytes >> (8 * random.below(4))
}

fn any_sensors(random: &mut Random) -> Sensors {
    Sensors {
        tick: word(random),
        counts: std::array::from_fn(|_| (word(random) as i32).wrapping_mul(if random.happens(0.5) { 1 } else { -1 })),
        enable: random.happens(0.5),
    }
}

fn frame_of(sensors: &Sensors) -> Vec<u8> {
    let mut buffer = [0; MAX_FRAME];
    pack(sensors, &mut buffer).expect("any frame fits").to_vec()
}

fn feed(receiver: &mut Receiver<Sensors>, bytes: &[u8]) -> Vec<Received<Sensors>> {
    bytes.iter().filter_map(|byte| receiver.feed(*byte)).collect()
}

fn has_no_message(received: &[Received<Sensors>]) -> bool {
    received.iter().all(|result| !matches!(result, Received::Message(_)))
}

#[test]
fn any_message_comes_back() {
    let mut random = Random::new(1);
    for _ in 0..CASES {
        let messages: Vec<_> = (0..=random.below(19)).map(|_| any_sensors(&mut random)).collect();
        let line: Vec<u8> = messages.iter().flat_map(frame_of).collect();
        let received = feed(&mut Receiver::new(), &line);
        assert_eq!(received, messages.into_iter().map(Received::Message).collect::<Vec<_>>());
    }
}

#[test]
fn a_frame_after_rubbish_is_received() {
    let mut random = Random::new(2);
    for _ in 0..CASES {
        let rubbish: Vec<u8> = (0..random.below(400)).map(|_| byte(&mut random)).collect();
        let sensors = any_sensors(&mut random);
        let mut receiver = Receiver::new();
        assert!(has_no_message(&feed(&mut receiver, &rubbish)), "{rubbish:?}");
        receiver.feed(DELIMITER);
        assert_eq!(feed(&mut receiver, &frame_of(&sensors)), [Received::Message(sensors)], "{rubbish:?}");
    }
}

#[test]
fn a_burst_of_errors_is_found() {
    let mut random = Random::new(3);
    for _ in 0..CASES {
        let frame = frame_of(&any_sensors(&mut random));
        let mut damaged = frame.clone();
        let start = random.below(frame.len());
        let burst = 1 + random.below(3);
        damaged[start..].iter_mut().take(burst).for_each(|damaged| *damaged ^= byte(&mut random));
        if damaged != frame {
            let results = feed(&mut Receiver::new(), &damaged);
            assert!(has_no_message(&results), "{damaged:?}: {results:?}");
        }
    }
}
