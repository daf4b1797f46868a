//! What is only seen over several ticks: a sensor that is stuck, ticks that are late.

use crate::surfaces::WALL;
use crate::traces::SETTINGS;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Counts, Duty};
use palpate::servo::{Config, Event, Fault, Input, Phase, Safety, Servo};

#[test]
fn a_stuck_encoder_is_found_while_the_others_go_on() {
    // The turntable sweeps over the wall under load while the first link's encoder says the same again and again.
    let servo = Servo::new(
        &WOODEN_HAPTICS_2016,
        &WALL,
        Config { settings: SETTINGS, safety: Safety::DEFAULT, ..Config::DEFAULT },
    );
    let mut state = servo.start();
    let counts = |tick: i32| {
        // At (0.22, 0) over the foot, 3 mm below the wall, sweeping 0.5 rad a second; the second link's count lives on.
        [Counts((f64::from(tick) * 0.5 / 4_000.0 / -1.963e-4) as i32), Counts(-1_314), Counts(3_465 + 80 + tick % 2)]
    };
    // Down from above, so that contact begins in front.
    for step in 0..57 {
        let [a, b, c] = counts(0);
        let _ = servo.tick(&mut state, Input::Sensors { counts: [a, b, Counts(c.0 - 280 + step * 5)], enable: true });
    }
    let found = (0..8_000).find(|tick| {
        let _ = servo.tick(&mut state, Input::Sensors { counts: counts(*tick), enable: true });
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
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT });
    let mut state = servo.start();
    let good = Input::Sensors { counts: [Counts(0); 3], enable: true };
    for _ in 0..100 {
        let _ = servo.tick(&mut state, good);
        servo.note(&mut state, Event::Overrun);
        let _ = servo.tick(&mut state, good);
        servo.note(&mut state, Event::Overrun);
        let _ = servo.tick(&mut state, good);
        let _ = servo.tick(&mut state, good);
    }
    assert_eq!((state.overruns(), state.fault()), (200, None));
    for _ in 0..3 {
        servo.note(&mut state, Event::Overrun);
        let _ = servo.tick(&mut state, good);
    }
    assert_eq!(state.fault(), Some((Fault::Overrun, 402)));
}
