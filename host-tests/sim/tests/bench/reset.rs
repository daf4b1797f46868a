//! After a reset: what force waits for.

use palpate::device::SerialArm;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::servo::{Config, Event, Fault, Phase, ResetReason, SafeOutput, Safety, Servo};
use palpate::wire::HostMessage;
use palpate_bench::{Cause, Memo, ResetFlags};
use palpate_sim::rig::{Rig, SETTINGS, WALL, held_at, settings};

/// Ticks that are longer than what a button that acknowledges is held for, 50 ms.
const HELD: u32 = 210;

/// 4 mm inside the wall, where force is felt at once.
fn rig(reset: ResetReason) -> Rig<SerialArm> {
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    Rig::new(servo, held_at([0.0, 0.0, -0.004]), &settings(), reset)
}

#[test]
fn an_enable_that_is_held_at_reset_gives_no_force_until_it_was_seen_released() {
    for reset in
        [ResetReason::PowerOn, ResetReason::Pin, ResetReason::Software, ResetReason::Unknown, ResetReason::Tool]
    {
        let mut rig = rig(reset);
        rig.set(|world| world.button = true);
        rig.ticks_off(4_000);
        assert_eq!((rig.state().phase(), rig.fault()), (Phase::Armed, None), "{reset:?}");
        rig.set(|world| world.button = false);
        rig.ticks_off(150);
        // And then by the soft start: a tenth of a second is 400 ticks.
        rig.set(|world| world.button = true);
        let mut last = 0.0;
        for tick in 0..400 {
            rig.tick();
            let force = rig.state().force().length();
            assert!(force <= 5.0 * (tick + 2) as f32 / 400.0, "tick {tick}: {force} N");
            last = force;
        }
        assert!(last > 1.0, "{reset:?}: {last} N");
    }
}

#[test]
fn an_enable_that_is_released_and_pressed_again_starts_softly_again() {
    let mut rig = rig(ResetReason::PowerOn);
    for _ in 0..3 {
        rig.press_until_it_runs();
        let full = rig.state().force().length();
        rig.set(|world| world.button = false);
        rig.tick();
        assert!(rig.is_off() && full > 1.0);
        rig.set(|world| world.button = true);
        rig.tick();
        assert!(rig.state().force().length() < 0.01 * full);
    }
}

#[test]
fn a_reset_by_the_watchdog_or_a_brown_out_stays_safe_until_it_is_acknowledged() {
    let of = [
        (ResetReason::Watchdog, Fault::WatchdogReset),
        (ResetReason::Panic, Fault::WatchdogReset),
        (ResetReason::Exception, Fault::WatchdogReset),
        (ResetReason::BrownOut, Fault::BrownOut),
    ];
    for (reset, fault) in of {
        // Stop was pressed before: letting go of it acknowledges nothing that was not looked at.
        let mut rig = rig(reset);
        rig.set(|world| world.stop_open = true);
        rig.ticks_off(HELD);
        rig.set(|world| world.stop_open = false);
        for pressed in [false, true, false, true] {
            rig.set(|world| world.button = pressed);
            rig.ticks_off(1_000);
            assert_eq!((rig.fault(), rig.state().reset()), (Some(fault), reset));
        }
        // Pressed and let go, but with enable held: no.
        rig.set(|world| world.stop_open = true);
        rig.ticks_off(HELD);
        rig.set(|world| world.stop_open = false);
        rig.ticks_off(HELD);
        assert_eq!(rig.fault(), Some(fault));
        // Nor by an enable that is let go of a little later.
        rig.set(|world| world.button = false);
        rig.ticks_off(HELD);
        assert_eq!(rig.fault(), Some(fault));
        // With enable released: yes. And then as after any reset.
        rig.set(|world| world.stop_open = true);
        rig.ticks_off(HELD);
        rig.set(|world| world.stop_open = false);
        rig.ticks_off(HELD);
        assert_eq!((rig.fault(), rig.state().reset()), (None, reset));
        rig.press_until_it_runs();
    }
}

#[test]
fn noise_on_the_stop_line_acknowledges_nothing_and_a_button_that_bounces_does() {
    let mut rig = rig(ResetReason::Watchdog);
    rig.ticks_off(1_000);
    // A spike, or many, or a contact that is loose: never 50 ms either way.
    for ticks in [1, 2, 10, 190] {
        for _ in 0..8 {
            rig.set(|world| world.stop_open = !world.stop_open);
            rig.ticks_off(ticks);
        }
        rig.ticks_off(1_000);
        assert_eq!(rig.fault(), Some(Fault::WatchdogReset), "{ticks} ticks");
    }
    // Pressed for long, let go of for a moment, and pressed again.
    rig.set(|world| world.stop_open = true);
    rig.ticks_off(HELD);
    rig.set(|world| world.stop_open = false);
    rig.ticks_off(190);
    assert_eq!(rig.fault(), Some(Fault::WatchdogReset));
    // A contact bounces for some milliseconds at each end.
    for level in [true, false] {
        for tick in 0..20 {
            rig.set(|world| world.stop_open = level ^ (tick % 3 == 1));
            rig.ticks_off(1);
        }
        rig.set(|world| world.stop_open = level);
        assert_eq!(rig.fault(), Some(Fault::WatchdogReset));
        rig.ticks_off(HELD);
    }
    assert_eq!(rig.fault(), None);
    rig.press_until_it_runs();
}

#[test]
fn the_host_acknowledges_a_reset_and_nothing_else() {
    let mut rig = rig(ResetReason::Watchdog);
    rig.ticks_off(150);
    rig.send(HostMessage::Alive);
    rig.ticks_off(10);
    assert_eq!(rig.fault(), Some(Fault::WatchdogReset));
    rig.send(HostMessage::Acknowledge);
    rig.ticks_off(10);
    assert_eq!(rig.fault(), Some(Fault::WatchdogReset), "nobody has confirmed it");
    for (pressed, ticks) in [(true, 2_100), (false, 150)] {
        rig.set(|world| world.button = pressed);
        rig.ticks_off(ticks);
    }
    assert_eq!(rig.fault(), None);
    rig.press_until_it_runs();
    // Its stop is latched, whoever acknowledges.
    rig.send(HostMessage::Stop);
    rig.ticks_off(1);
    rig.send(HostMessage::Acknowledge);
    rig.ticks_off(10);
    assert_eq!(rig.fault(), Some(Fault::Stopped));
}

#[test]
fn an_enable_that_is_held_while_the_host_acknowledges_gives_no_force() {
    let mut rig = rig(ResetReason::Watchdog);
    // It was released, and pressed again by somebody who wonders why nothing is felt.
    rig.ticks_off(100);
    rig.set(|world| world.button = true);
    rig.ticks_off(100);
    rig.send(HostMessage::Acknowledge);
    rig.ticks_off(4_000);
    rig.set(|world| world.button = false);
    rig.ticks_off(1_000);
    // It was held from before: that confirms nothing.
    assert_eq!(rig.fault(), Some(Fault::WatchdogReset));
}

#[test]
fn an_acknowledged_loop_checks_its_tables_and_angles_anew() {
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    let mut state = servo.start_after(ResetReason::BrownOut);
    servo.note(&mut state, Event::Acknowledged);
    assert_eq!((state.phase(), state.counts(), state.fault()), (Phase::Reset, None, None));
    // A fault that came later is none of a reset's.
    let mut state = servo.start_after(ResetReason::PowerOn);
    servo.note(&mut state, Event::DriveFault);
    servo.note(&mut state, Event::Acknowledged);
    assert_eq!((state.phase(), state.fault()), (Phase::Fault, Some((Fault::Drive, 0))));
}

#[test]
fn a_brown_out_is_not_a_power_on() {
    let running = Memo::new(Cause::Running);
    let power = ResetFlags { power: true, pin: true, ..ResetFlags::default() };
    // The same flags: memory that faded, and memory that did not.
    assert_eq!(power.reason(Memo([0x1234_5678, 0x9abc_def0])), ResetReason::PowerOn);
    assert_eq!(power.reason(running), ResetReason::BrownOut);
    // A chip that tells them apart.
    assert_eq!(ResetFlags { brown_out: true, ..power }.reason(Memo::EMPTY), ResetReason::BrownOut);
    // The pin alone, a debugger, and a flag that is not known.
    assert_eq!(ResetFlags { pin: true, ..ResetFlags::default() }.reason(running), ResetReason::Pin);
    assert_eq!(
        ResetFlags { software: true, pin: true, ..ResetFlags::default() }.reason(running),
        ResetReason::Software
    );
    assert_eq!(ResetFlags::default().reason(running), ResetReason::Unknown);
}

#[test]
fn a_watchdog_says_what_it_found_and_a_tool_that_uses_it_is_told_apart() {
    let watchdog = ResetFlags { watchdog: true, pin: true, ..ResetFlags::default() };
    for (cause, reason) in [
        (Cause::Running, ResetReason::Watchdog),
        (Cause::Panic, ResetReason::Panic),
        (Cause::Exception, ResetReason::Exception),
    ] {
        assert_eq!(watchdog.reason(Memo::new(cause)), reason);
        assert_eq!(reason.fault(), Some(Fault::WatchdogReset));
        assert_eq!(Memo::new(cause).cause(), Some(cause));
    }
    assert_eq!(watchdog.reason(Memo::EMPTY), ResetReason::Watchdog);
    assert_eq!(ResetFlags { tool: true, ..watchdog }.reason(Memo::EMPTY), ResetReason::Tool);
    assert_eq!(ResetReason::Tool.fault(), None);
}

#[test]
fn memory_that_holds_anything_holds_no_memo() {
    assert_eq!(Memo::EMPTY.cause(), None);
    let Memo(words) = Memo::new(Cause::Panic);
    for bit in 0..32 {
        assert_eq!(Memo([words[0] ^ 1 << bit, words[1]]).cause(), None);
        assert_eq!(Memo([words[0], words[1] ^ 1 << bit]).cause(), None);
    }
    // Whole, but of no cause that is ours.
    assert_eq!(Memo([words[0] ^ 0x80, !(words[0] ^ 0x80)]).cause(), None);
}

#[test]
fn after_a_reset_nothing_damps_by_itself() {
    let safety = Safety { output: SafeOutput::Damping(5.0), ..Safety::DEFAULT };
    let rig = |reset| {
        let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT });
        Rig::new(servo, held_at([0.0, 0.0, 0.01]), &settings(), reset)
    };
    // A fault of the reset: not before it is acknowledged, whatever the button does.
    for reset in [ResetReason::Watchdog, ResetReason::Panic, ResetReason::BrownOut] {
        let mut rig = rig(reset);
        for pressed in [true, false, true] {
            rig.set(|world| world.button = pressed);
            rig.ticks_off(500);
        }
    }
    // Any other: not before the button was seen released.
    let mut rig = rig(ResetReason::PowerOn);
    rig.set(|world| (world.button, world.bad) = (true, 1));
    rig.ticks_off(500);
    assert_eq!(rig.fault(), Some(Fault::FrameDamaged));
    rig.set(|world| world.button = false);
    rig.ticks(150);
    assert!(!rig.is_off(), "now it damps");
}
