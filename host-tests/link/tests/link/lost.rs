//! Frames that are lost or spoiled on the way.

use crate::line::{Bad, device, for_seconds};
use crate::orders::at;
use palpate_link::{Device, Error, TRIES};
use palpate_sim::simulated::Kind;

#[test]
fn an_answer_that_is_lost_is_asked_for_anew_under_the_same_number() {
    let mut device = device(Kind::default());
    device.limit(4.0).unwrap();
    device.line().lose_answers = TRIES - 1;
    device.limit(3.0).unwrap();
    let numbers = &device.line().numbers;
    assert_eq!(numbers.len() as u32, 1 + TRIES);
    assert!(numbers[1..].iter().all(|number| *number == numbers[0] + 1), "{numbers:?}");
}

#[test]
fn an_order_that_is_lost_is_said_anew() {
    let mut device = device(Kind::default());
    let gap = for_seconds(&mut device, 0.2).gap;
    device.line().lose_orders = TRIES - 1;
    device.place(0, at([0.0, 0.0, -0.01])).unwrap();
    // The tip swings by less than half a millimetre.
    assert!((for_seconds(&mut device, 0.2).gap - gap - 0.01).abs() < 5e-4);
}

#[test]
fn an_order_without_an_answer_is_said_to_be_lost_and_the_next_one_is_not() {
    let mut device = device(Kind::default());
    for lost in [(TRIES, 0), (0, TRIES)] {
        (device.line().lose_answers, device.line().lose_orders) = lost;
        let error = device.limit(3.0).unwrap_err();
        let number = *device.line().numbers.last().unwrap();
        assert!(matches!(error, Error::Lost { asked: "limit", number: n, tries: TRIES } if n == number), "{error}");
        device.limit(3.0).unwrap();
    }
}

#[test]
fn an_answer_that_comes_late_is_taken_for_no_other_order() {
    let mut device = device(Kind::default());
    device.line().holds_answers = true;
    assert!(matches!(device.place(5, at([0.0; 3])), Err(Error::Lost { .. })));
    device.line().holds_answers = false;
    // Five refusals come first.
    device.limit(3.0).unwrap();
}

#[test]
fn a_move_whose_answer_is_lost_is_done_once() {
    let mut device = device(Kind::default());
    let gap = for_seconds(&mut device, 0.3).gap;
    device.line().lose_answers = 3;
    device.move_along(0, [[0.0, 0.0, -0.1], [0.0; 3]], 0.1).unwrap();
    assert_eq!(device.line().numbers.len(), 4);
    // 10 mm; done again with each of three answers that were lost it would be 40. The tip swings by half a millimetre.
    assert!((for_seconds(&mut device, 0.3).gap - gap - 0.01).abs() < 5e-4);
}

#[test]
fn over_a_line_that_spoils_bytes_what_is_said_to_be_done_is_done() {
    let mut failed = 0;
    for seed in 0..8 {
        let mut device = Device::over(Bad::new(Kind::default(), seed)).unwrap();
        let gap = for_seconds(&mut device, 0.3).gap;
        // One byte in a hundred is lost, one in a hundred has a bit flipped: every other view is spoiled.
        device.line().spoils = 10_000;
        for round in 0..40 {
            let down = 1e-3 * ((round * 7) % 16) as f32;
            match device.place(0, at([0.0, 0.0, -down])) {
                Ok(()) => {
                    let found = for_seconds(&mut device, 0.03).gap;
                    assert!((found - gap - down).abs() < 5e-4, "seed {seed}, round {round}: {found} for {down}");
                }
                Err(Error::Lost { .. }) => failed += 1,
                Err(error) => panic!("{error}"),
            }
        }
        assert!(device.damaged() > 100, "{}", device.damaged());
        assert_eq!(device.fault().unwrap(), None);
    }
    println!("{failed} of 320 orders said to be lost");
    // An order and its answer of some 60 bytes come through with 0.3, none of five with 0.2.
    assert!(failed < 120, "{failed}");
}
