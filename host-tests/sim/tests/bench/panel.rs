//! Stop, ready lines and supply: what keeps the motors off, and how force comes back.

use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{SerialArm, SupplyRange};
use palpate::servo::{Config, Fault, Phase, ResetReason, SafeOutput, Safety, Servo};
use palpate::wire::hold;
use palpate_bench::Settings;
use palpate_sim::rig::{Rig, SETTINGS, WALL, World, held_at, settings};

fn rig() -> Rig<SerialArm> {
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    Rig::new(servo, held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn)
}

/// What the last record says holds.
fn told(rig: &mut Rig<SerialArm>) -> u8 {
    rig.last_record().map_or(0, |record| record.hold)
}

/// Force is there; something holds for half a second; it is over. Force must go in the same tick, and come back only
/// once enable was released, by the soft start.
#[track_caller]
fn holds_and_returns_softly(
    rig: &mut Rig<SerialArm>,
    within: u32,
    begin: fn(&mut World),
    end: fn(&mut World),
    bit: u8,
) {
    rig.press_until_it_runs();
    let full = rig.state().force().length();
    assert!(full > 1.0, "{full} N");
    rig.set(begin);
    rig.ticks(within - 1);
    rig.ticks_off(2_000);
    assert!(told(rig) & bit != 0);
    rig.set(end);
    // The button is still held: whoever holds it does not ask for force now.
    rig.ticks_off(2_000);
    assert_eq!((rig.state().phase(), rig.fault(), told(rig)), (Phase::Armed, None, hold::RELEASE_FIRST));
    rig.set(|world| world.button = false);
    rig.ticks_off(150);
    rig.set(|world| world.button = true);
    for tick in 0..400 {
        rig.tick();
        let force = rig.state().force().length();
        assert!(force <= 5.0 * (tick + 2) as f32 / 400.0, "tick {tick}: {force} N");
    }
    rig.ticks(400);
    assert!((rig.state().force().length() - full).abs() < 0.05 * full);
}

#[test]
fn after_a_stop_force_returns_by_the_soft_start_and_only_once_enable_was_released() {
    holds_and_returns_softly(
        &mut rig(),
        1,
        |world| world.stop_open = true,
        |world| world.stop_open = false,
        hold::STOP,
    );
}

#[test]
fn an_emergency_stop_in_the_motors_supply_alone_gives_no_kick_when_it_is_lifted() {
    // The loop hears of it by the supply and by the amplifiers, whose ready lines fall with it.
    holds_and_returns_softly(
        &mut rig(),
        1,
        |world| world.supply = 0.0,
        |world| world.supply = 24.0,
        hold::NOT_READY | hold::SUPPLY,
    );
}

#[test]
fn amplifiers_that_fall_before_the_supply_does_have_no_fault_of_their_own() {
    // Capacitors hold the supply for 20 ms after the contactor fell.
    let mut rig = rig();
    rig.press_until_it_runs();
    rig.set(|world| world.ready_wires = [false; 3]);
    rig.ticks_off(80);
    rig.set(|world| world.supply = 0.0);
    rig.ticks_off(2_000);
    assert_eq!(rig.fault(), None);
    rig.set(|world| (world.ready_wires, world.supply) = ([true; 3], 24.0));
    rig.ticks_off(100);
    rig.press_until_it_runs();
}

#[test]
fn a_supply_that_dips_takes_force_away_and_a_single_reading_does_not() {
    holds_and_returns_softly(&mut rig(), 4, |world| world.supply = 15.0, |world| world.supply = 24.0, hold::SUPPLY);
    // Too high, from braking; and a converter that fails.
    holds_and_returns_softly(&mut rig(), 4, |world| world.supply = 35.0, |world| world.supply = 24.0, hold::SUPPLY);
    holds_and_returns_softly(
        &mut rig(),
        4,
        |world| world.measured = |_| None,
        |world| world.measured = Some,
        hold::SUPPLY,
    );
    holds_and_returns_softly(
        &mut rig(),
        4,
        |world| world.measured = |_| Some(f32::NAN),
        |world| world.measured = Some,
        hold::SUPPLY,
    );
    let mut rig = rig();
    rig.press_until_it_runs();
    for _ in 0..100 {
        rig.set(|world| world.supply = 15.0);
        rig.ticks(1);
        rig.set(|world| world.supply = 24.0);
        rig.ticks(3);
        assert!(!rig.is_off());
    }
}

#[test]
fn a_supply_out_of_its_range_in_half_of_the_readings_holds_and_one_above_it_at_once() {
    for (volts, bad, good, within) in [(15.0, 3, 1, 8), (15.0, 2, 2, 12), (40.0, 1, 3, 1), (40.0, 3, 1, 1)] {
        let mut rig = rig();
        rig.press_until_it_runs();
        let mut ticks = 0;
        while !rig.is_off() {
            let is_bad = ticks % (bad + good) < bad;
            rig.set(|world| world.supply = if is_bad { volts } else { 24.0 });
            rig.tick();
            ticks += 1;
            assert!(ticks <= within, "{volts} V in {bad} of {} readings", bad + good);
        }
        // It stays off while the supply does so, and after it until the button was released.
        for tick in 0..2_000 {
            rig.set(|world| world.supply = if tick % (bad + good) < bad { volts } else { 24.0 });
            rig.ticks_off(1);
        }
        rig.set(|world| world.supply = 24.0);
        rig.ticks_off(1_000);
        assert_eq!(rig.fault(), None);
        rig.press_until_it_runs();
    }
}

/// A contact that chatters: closed but for a sample now and then, and for less than the time of a release.
fn chatter(rig: &mut Rig<SerialArm>, opens: fn(&mut World, bool)) {
    for open in [1, 2, 10, 80] {
        for _ in 0..20 {
            rig.set(|world| opens(world, true));
            rig.ticks_off(open);
            rig.set(|world| opens(world, false));
            rig.ticks_off(7);
        }
    }
}

#[test]
fn a_button_that_is_held_and_chatters_is_not_released() {
    let opens: fn(&mut World, bool) = |world, open| world.button = !open;
    // Since the reset.
    let mut rig = rig();
    rig.set(|world| world.button = true);
    chatter(&mut rig, opens);
    rig.ticks_off(2_000);
    // Through a stop, and after it.
    let mut rig = self::rig();
    rig.press_until_it_runs();
    rig.set(|world| world.stop_open = true);
    rig.ticks_off(200);
    chatter(&mut rig, opens);
    rig.set(|world| world.stop_open = false);
    chatter(&mut rig, opens);
    rig.ticks_off(2_000);
    assert_eq!(told(&mut rig), hold::RELEASE_FIRST);
    // Force comes back once it was released, and pressed.
    rig.press_until_it_runs();
}

#[test]
fn a_stop_that_chatters_ends_nothing_and_a_spike_on_enable_asks_for_nothing() {
    // Damping goes on by itself once a hold is over: not in between.
    let safety = Safety { output: SafeOutput::Damping(5.0), ..Safety::DEFAULT };
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT });
    let mut rig = Rig::new(servo, held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn);
    rig.press_until_it_runs();
    rig.set(|world| world.bad = 3);
    rig.ticks(5);
    assert!(!rig.is_off(), "it damps");
    rig.set(|world| world.stop_open = true);
    rig.ticks_off(10);
    chatter(&mut rig, |world, open| world.stop_open = !open);
    // One sample of an open interlock.
    let mut rig = self::rig();
    rig.ticks(150);
    for _ in 0..100 {
        rig.set(|world| world.button = true);
        rig.ticks_off(1);
        rig.set(|world| world.button = false);
        rig.ticks_off(3);
    }
}

#[test]
fn one_of_two_contacts_asks_for_nothing_and_one_that_stays_closed_holds_until_both_were_open() {
    // A wire off: the other contact alone does nothing.
    let mut alone = rig();
    alone.ticks(150);
    alone.set(|world| (world.button, world.second_contact) = (true, Some(false)));
    alone.ticks_off(4_000);
    assert!(told(&mut alone) & hold::ENABLE != 0);

    // Welded: the first release is the last force.
    let mut welded = rig();
    welded.press_until_it_runs();
    welded.set(|world| (world.button, world.second_contact) = (false, Some(true)));
    welded.ticks_off(1_990);
    assert!(told(&mut welded) & hold::ENABLE == 0, "contacts may differ for half a second");
    welded.ticks_off(30);
    assert!(told(&mut welded) & hold::ENABLE != 0);
    welded.set(|world| world.button = true);
    welded.ticks_off(2_000);
    // Let go of for less than half a second, and pressed again.
    welded.set(|world| world.button = false);
    welded.ticks_off(300);
    welded.set(|world| world.button = true);
    welded.ticks_off(2_000);
    // Repaired while it is held.
    welded.set(|world| world.second_contact = None);
    welded.ticks_off(2_000);
    welded.set(|world| world.button = false);
    welded.ticks_off(300);
    assert_eq!((welded.fault(), told(&mut welded)), (None, 0));
    welded.press_until_it_runs();

    // A hand is slow: contacts that differ for a third of a second.
    let mut slow = rig();
    slow.ticks(150);
    slow.set(|world| (world.button, world.second_contact) = (true, Some(false)));
    slow.ticks_off(1_300);
    slow.set(|world| world.second_contact = None);
    slow.ticks(40);
    assert!(!slow.is_off());
}

#[test]
fn where_the_stop_button_is_tested_there_is_no_force_before_it_was_pressed_and_let_go_of() {
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    let settings = Settings { tests_stop: true, ..settings() };
    let mut rig = Rig::new(servo, held_at([0.0, 0.0, -0.004]), &settings, ResetReason::PowerOn);
    let press = |rig: &mut Rig<SerialArm>| {
        rig.set(|world| world.button = false);
        rig.ticks_off(150);
        rig.set(|world| world.button = true);
        rig.ticks_off(2_000);
    };
    press(&mut rig);
    assert_eq!(told(&mut rig) & hold::STOP, hold::STOP);
    // A spike is no press.
    rig.set(|world| world.stop_open = true);
    rig.ticks_off(10);
    rig.set(|world| world.stop_open = false);
    press(&mut rig);
    rig.set(|world| world.stop_open = true);
    rig.ticks_off(400);
    // While it is held nothing moves either.
    press(&mut rig);
    rig.set(|world| (world.stop_open, world.button) = (false, false));
    rig.ticks_off(150);
    rig.press_until_it_runs();
}

#[test]
fn how_long_a_release_must_last_is_a_time_at_every_rate() {
    for rate in [500.0_f32, 1_000.0, 4_000.0, 20_000.0] {
        let opens_after = |released: u32| {
            let mut interlock = palpate_bench::Interlock::new(rate);
            (0..released).for_each(|_| assert!(!interlock.next(false, false)));
            (0..released).any(|_| interlock.next(true, false))
        };
        // 20 to 50 ms open it, and less does not.
        assert!(opens_after((0.050 * rate) as u32), "{rate} Hz");
        assert!(!opens_after((0.020 * rate) as u32), "{rate} Hz");
        // Letting go counts at once, and a press of two samples at least.
        let mut interlock = palpate_bench::Interlock::new(rate);
        (0..(0.050 * rate) as u32).for_each(|_| assert!(!interlock.next(false, false)));
        assert!(!interlock.next(true, false), "one sample");
        assert!((0..(0.002 * rate) as u32 + 2).any(|_| interlock.next(true, false)));
        assert!(!interlock.next(false, false));
    }
}

#[test]
fn the_supply_is_believed_from_its_least_to_its_most_volt_and_nothing_else_is() {
    let range = SupplyRange::TWENTY_FOUR;
    for volts in [20.0, 24.0, 30.0] {
        assert!(range.holds(volts), "{volts} V");
    }
    for volts in [19.99, 30.01, 0.0, -24.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(!range.holds(volts), "{volts} V");
    }
    assert_eq!(settings().supply, Some(range));
}

#[test]
fn a_broken_ready_wire_or_an_amplifier_without_supply_reads_as_not_ready() {
    for wire in 0..3 {
        let mut rig = rig();
        rig.set(|world| world.ready_wires[wire] = false);
        rig.ticks(10);
        rig.set(|world| world.button = true);
        rig.ticks_off(1_000);
        // It was never driven: nothing has failed that the loop could know of.
        assert_eq!(
            (rig.state().phase(), rig.fault(), told(&mut rig)),
            (Phase::Armed, None, hold::NOT_READY | hold::RELEASE_FIRST)
        );
    }
    let mut rig = rig();
    rig.set(|world| world.supply = 0.0);
    rig.ticks(10);
    rig.set(|world| world.button = true);
    rig.ticks_off(1_000);
    assert_eq!(rig.fault(), None);
}

#[test]
fn a_ready_line_that_breaks_while_driving_lets_go_at_once_and_is_a_fault_if_nothing_explains_it() {
    for wire in 0..3 {
        let mut rig = rig();
        rig.press_until_it_runs();
        rig.set(|world| world.ready_wires[wire] = false);
        // 50 ms of grace are 200 ticks: the first sets them, the rest count.
        rig.ticks_off(200);
        assert_eq!(rig.fault(), None);
        rig.ticks_off(1);
        assert_eq!(rig.fault(), Some(Fault::Drive));
        rig.set(|world| world.ready_wires = [true; 3]);
        rig.ticks_off(1_000);
    }
}

#[test]
fn an_amplifiers_own_fault_is_latched() {
    let mut rig = rig();
    rig.press_until_it_runs();
    rig.set(|world| world.amplifiers_well = false);
    rig.ticks_off(201);
    assert_eq!(rig.fault(), Some(Fault::Drive));
}

#[test]
fn an_amplifier_that_has_failed_damps_nothing_once_it_says_that_it_is_ready_again() {
    let safety = Safety { output: SafeOutput::Damping(5.0), ..Safety::DEFAULT };
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT });
    let mut rig = Rig::new(servo, held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn);
    rig.press_until_it_runs();
    rig.set(|world| world.amplifiers_well = false);
    rig.ticks_off(201);
    assert_eq!(rig.fault(), Some(Fault::Drive));
    rig.set(|world| world.amplifiers_well = true);
    rig.ticks_off(1_000);
}

#[test]
fn a_broken_stop_wire_stops() {
    // The contact is closed unless pressed: a wire that is off is a contact that is open.
    let mut rig = rig();
    rig.set(|world| world.stop_open = true);
    rig.ticks(10);
    rig.set(|world| world.button = true);
    rig.ticks_off(1_000);
    assert_eq!(told(&mut rig) & hold::STOP, hold::STOP);
}

#[test]
fn stop_stops_damping_too() {
    let safety = Safety { output: SafeOutput::Damping(5.0), ..Safety::DEFAULT };
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT });
    let mut rig = Rig::new(servo, held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn);
    rig.press_until_it_runs();
    rig.set(|world| world.bad = 3);
    rig.ticks(5);
    assert_eq!((rig.fault(), rig.is_off()), (Some(Fault::FrameDamaged), false), "it damps");
    rig.set(|world| world.stop_open = true);
    rig.ticks_off(100);
}

/// Ticks of a second in which the light is on, and how often it comes on.
fn light(rig: &mut Rig<SerialArm>) -> (u32, u32) {
    let (mut lit, mut flashes, mut last) = (0, 0, rig.world.borrow().light);
    for _ in 0..4_000 {
        rig.tick();
        let now = rig.world.borrow().light;
        lit += u32::from(now);
        flashes += u32::from(now && !last);
        last = now;
    }
    (lit, flashes)
}

#[test]
fn the_light_tells_driving_from_holding_and_both_from_a_fault() {
    let mut rig = rig();
    rig.ticks(150);
    assert_eq!(light(&mut rig), (0, 0), "armed, and nobody asks for force");
    rig.press_until_it_runs();
    assert_eq!(light(&mut rig), (4_000, 0));
    rig.set(|world| world.stop_open = true);
    rig.tick();
    // A sixteenth of a second, once.
    assert_eq!(light(&mut rig), (250, 1));
    rig.set(|world| (world.stop_open, world.bad) = (false, 3));
    rig.ticks(10);
    assert_eq!(rig.fault(), Some(Fault::FrameDamaged));
    assert_eq!(light(&mut rig), (2_000, 4));
}

#[test]
fn an_enable_line_that_reads_on_though_it_was_released_is_a_fault() {
    // Before the first force, and after it: in the tick that follows the release.
    let mut early = rig();
    early.ticks_off(150);
    early.set(|world| world.is_enable_shorted = true);
    early.tick();
    assert_eq!(early.fault(), Some(Fault::Drive));
    let mut rig = rig();
    rig.press_until_it_runs();
    rig.set(|world| world.is_enable_shorted = true);
    rig.ticks(100);
    assert_eq!(rig.fault(), None, "it is on because the loop wants it");
    rig.set(|world| world.button = false);
    rig.ticks_off(2);
    assert_eq!(rig.fault(), Some(Fault::Drive));
}
