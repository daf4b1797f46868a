//! The device hears from a program that calls, and only from such a one; stopping.

use crate::line::{device, for_seconds, running};
use crate::orders::at;
use palpate::servo::ResetReason;
use palpate_link::{Error, Fault, Phase};
use palpate_sim::simulated::Kind;
use std::time::Duration;

#[test]
fn a_program_that_calls_keeps_the_link_and_one_that_hangs_loses_it() {
    let mut device = device(Kind { link_timeout: 0.1, ..Kind::default() });
    for _ in 0..60 {
        // A third of the timeout between two calls.
        device.line().device.run(132);
        device.tend().unwrap();
    }
    assert_eq!(device.fault().unwrap(), None);
    // 0.1 s at 4 kHz, and what the last word took.
    device.line().device.run(410);
    assert_eq!(for_seconds(&mut device, 0.05).fault, Fault::LinkLost.code());
}

#[test]
fn an_order_that_waits_for_its_answer_keeps_the_link() {
    let mut device = device(Kind { link_timeout: 0.05, ..Kind::default() });
    device.line().lose_orders = 4;
    device.place(0, at([0.0; 3])).unwrap();
    assert_eq!(device.fault().unwrap(), None);
}

#[test]
fn stop_stops_though_the_first_words_are_lost() {
    let (mut device, hand) = running();
    hand.goes_to([0.03, 0.02, 0.025]);
    for_seconds(&mut device, 0.5);
    assert_ne!(device.line().device.duties(), [0; 3]);
    device.line().lose_stops = 5;
    device.stop().unwrap();
    assert_eq!((device.phase().unwrap(), device.fault().unwrap()), (Phase::Fault, Some(Fault::Stopped)));
    assert_eq!(device.line().device.duties(), [0; 3]);
    let error = device.acknowledge().unwrap_err();
    assert!(matches!(error, Error::Fault(Fault::Stopped)), "{error}");
}

#[test]
fn a_stop_that_nobody_hears_is_said() {
    // Said before the first view: the device's own link timeout would stop it too.
    let mut device = palpate_link::Device::over(crate::line::Bad::new(Kind::default(), 1)).unwrap();
    device.line().lose_stops = 1_000;
    let error = device.stop().unwrap_err();
    assert!(matches!(error, Error::NotStopped { tries, .. } if tries >= 20), "{error}");
}

#[test]
fn a_reset_by_the_watchdog_is_acknowledged() {
    let mut device = device(Kind { reset: ResetReason::Watchdog, ..Kind::default() });
    assert_eq!(device.fault().unwrap(), Some(Fault::WatchdogReset));
    device.acknowledge().unwrap();
    assert_eq!(device.fault().unwrap(), None);
}

#[test]
fn a_view_is_not_waited_for_longer_than_asked() {
    let mut device = device(Kind::default());
    device.view(Duration::from_millis(50)).unwrap();
    let began = device.now();
    device.view(Duration::ZERO).unwrap();
    // What has come is read in two looks, of a tick of the simulation.
    assert!(device.now() - began <= Duration::from_millis(1), "{:?}", device.now() - began);
}

#[test]
fn a_device_that_was_reset_says_so_until_it_is_greeted() {
    // It is found out by the refusal of an order, by the hello of one that begins, or, where that is lost, by its
    // ticks.
    for (found_by_order, between, ticks) in [(true, true, 0), (false, true, 8), (false, false, 60)] {
        let (mut device, _) = running();
        for_seconds(&mut device, 0.5);
        if found_by_order {
            // A hello that comes now may be the answer to this.
            device.greet().unwrap();
        }
        device.place(0, at([0.0, 0.0, -0.01])).unwrap();
        device.line().restart(between);
        if found_by_order {
            let error = device.limit(3.0).unwrap_err();
            assert!(matches!(error, Error::BeganAnew { .. }), "{error}");
        }
        device.line().device.run(ticks);
        for _ in 0..2 {
            let _ = device.tend();
        }
        assert!(matches!(device.tend(), Err(Error::BeganAnew { .. })), "{found_by_order} {between}");
        assert!(matches!(device.view(Duration::ZERO), Err(Error::BeganAnew { .. })));
        let said = device.line().numbers.len();
        assert!(matches!(device.limit(3.0), Err(Error::BeganAnew { .. })));
        assert_eq!(device.line().numbers.len(), said, "an order was said to a device that knows nothing of before");
        device.greet().unwrap();
        device.limit(3.0).unwrap();
    }
}
