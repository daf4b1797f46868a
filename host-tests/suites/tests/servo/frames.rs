//! Frames under arbitrary messages and arbitrary damage.

use palpate::wire::Sensors;
use palpate::wire::frame::{DELIMITER, MAX_FRAME, Received, Receiver, pack};
use proptest::prelude::*;

fn any_sensors() -> impl Strategy<Value = Sensors> {
    (any::<u32>(), any::<[i32; 3]>(), any::<bool>()).prop_map(|(tick, counts, enable)| Sensors { tick, counts, enable })
}

fn frame_of(sensors: &Sensors) -> Vec<u8> {
    let mut buffer = [0; MAX_FRAME];
    pack(sensors, &mut buffer).expect("any frame fits").to_vec()
}

fn feed(receiver: &mut Receiver<Sensors>, bytes: &[u8]) -> Vec<Received<Sensors>> {
    bytes.iter().filter_map(|byte| receiver.feed(*byte)).collect()
}

proptest! {
    #[test]
    fn any_message_comes_back(messages in prop::collection::vec(any_sensors(), 1..20)) {
        let line: Vec<u8> = messages.iter().flat_map(frame_of).collect();
        let received = feed(&mut Receiver::new(), &line);
        prop_assert_eq!(received, messages.into_iter().map(Received::Message).collect::<Vec<_>>());
    }

    #[test]
    fn whatever_came_before_the_next_frame_is_taken(
        rubbish in prop::collection::vec(any::<u8>(), 0..400),
        sensors in any_sensors(),
    ) {
        let mut receiver = Receiver::new();
        let results = feed(&mut receiver, &rubbish);
        prop_assert!(results.iter().all(|result| !matches!(result, Received::Message(_))));
        receiver.feed(DELIMITER);
        prop_assert_eq!(feed(&mut receiver, &frame_of(&sensors)), [Received::Message(sensors)]);
    }

    #[test]
    fn a_burst_of_errors_is_found(
        sensors in any_sensors(),
        start in any::<prop::sample::Index>(),
        burst in prop::collection::vec(any::<u8>(), 1..4),
    ) {
        let frame = frame_of(&sensors);
        let mut damaged = frame.clone();
        let start = start.index(frame.len());
        for (byte, change) in damaged[start..].iter_mut().zip(&burst) {
            *byte ^= change;
        }
        prop_assume!(damaged != frame);
        let mut receiver = Receiver::new();
        let results = feed(&mut receiver, &damaged);
        prop_assert!(results.iter().all(|result| !matches!(result, Received::Message(_))), "{:?}", results);
    }
}
