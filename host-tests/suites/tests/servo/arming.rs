//! Before there is force: what the loop waits for.

use crate::harmed::{decayed, device, safety};
use crate::injection::TICKS_PER_PASS;
use crate::surfaces::WALL;
use crate::traces::SETTINGS;
use palpate::device::{Counts, Duty};
use palpate::math::Vec3;
use palpate::servo::{Config, Event, Fault, Input, Phase, ResetReason, SafeOutput, Safety, Servo};

#[test]
fn the_loop_is_armed_only_when_settled_homed_and_checked() {
    let (device, patch) = (device(), decayed());
    let servo =
        Servo::new(&device, &patch, Config { settings: SETTINGS, safety: safety(SafeOutput::Zero), ..Config::DEFAULT });
    let mut state = servo.start();
    let good = Input::Sensors { counts: [Counts(0); 3], enable: true };
    assert_eq!(state.phase(), Phase::Reset);
    for _ in 0..80 {
        let _ = servo.tick(&mut state, good);
        assert_eq!((state.phase(), state.duties()), (Phase::Calibrate, [Duty::ZERO; 3]));
    }
    servo.note(&mut state, Event::LinkAlive);
    servo.note(&mut state, Event::Homed);
    let mut phases = Vec::new();
    for _ in 0..200 {
        servo.note(&mut state, Event::LinkAlive);
        let _ = servo.tick(&mut state, good);
        phases.push(state.phase());
    }
    let armed = phases.iter().position(|phase| *phase == Phase::Armed);
    // The first tick is that of reset; 200 of settling after it.
    assert_eq!(armed, Some(120));
    assert!(phases[121..].iter().all(|phase| *phase == Phase::Running));
    // The first one when the loop was started.
    assert_eq!(u64::from(state.table_check().passes), 1 + 280 / u64::from(TICKS_PER_PASS), "{:?}", state.table_check());
    assert_eq!(state.reset(), ResetReason::PowerOn);
    assert_eq!(servo.start_after(ResetReason::Pin).reset(), ResetReason::Pin);
}

#[test]
fn a_stale_table_is_never_armed() {
    let (device, mut patch) = (device(), decayed());
    patch.0.baked = Some(WALL.table_crc() ^ 1);
    let servo = Servo::new(&device, &patch, Config { settings: SETTINGS, ..Config::DEFAULT });
    let mut state = servo.start();
    for _ in 0..10 {
        let _ = servo.tick(&mut state, Input::Sensors { counts: [Counts(0); 3], enable: true });
        assert!(matches!(state.phase(), Phase::Calibrate | Phase::Fault));
    }
    assert_eq!(state.fault().map(|(fault, _)| fault), Some(Fault::TableCorrupt));
    assert_eq!(state.force(), Vec3::ZERO);
    // Unless the check was turned off.
    let unchecked = Servo::new(
        servo.device(),
        servo.surface(),
        Config { safety: Safety { checks_tables: false, ..Safety::DEFAULT }, ..servo.config() },
    );
    let mut state = unchecked.start();
    for _ in 0..10 {
        let _ = unchecked.tick(&mut state, Input::Sensors { counts: [Counts(0); 3], enable: true });
    }
    assert_eq!((state.phase(), state.fault()), (Phase::Running, None));
}
