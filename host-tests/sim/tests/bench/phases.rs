//! No board looks at the phase: in each of them the pins do what the state's output says.

use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Duty, SerialArm};
use palpate::servo::{Config, Event, Fault, Output, Phase, ResetReason, SafeOutput, Safety, Servo};
use palpate_bench::Passive;
use palpate_sim::rig::{Rig, SETTINGS, WALL, held_at, settings};

fn servo(output: SafeOutput) -> Servo<'static, palpate::patch::SplinePatch<'static>, SerialArm, 3> {
    safe(Safety { output, settle_ticks: 50, ..Safety::DEFAULT })
}

fn safe(safety: Safety) -> Servo<'static, palpate::patch::SplinePatch<'static>, SerialArm, 3> {
    Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT })
}

/// The pins do what the state says; which phase it is, and whether they drive.
#[track_caller]
fn agreed(rig: &Rig<SerialArm>) -> (Phase, bool) {
    let (state, world) = (rig.state(), rig.world.borrow());
    match state.output() {
        Output::Off => assert_eq!(world.enables, [false; 3]),
        Output::Drive(duties) => {
            assert_eq!(world.enables, [true; 3]);
            for (Duty(duty), current) in duties.into_iter().zip(world.currents()) {
                // Half a step of 8,500 and half a step of 32,767, on a range of 0.4 either way.
                let bound = (0.5 / 8_500.0 + 0.5 / 32_767.0) / 0.4 + 1e-6;
                assert!((f64::from(duty) / 32_767.0 - current).abs() < bound, "{duties:?} {current}");
            }
        }
    }
    (state.phase(), world.enables == [true; 3])
}

#[test]
fn in_every_phase_and_with_either_safe_output_the_pins_do_what_the_state_says() {
    for (output, damps) in [(SafeOutput::Zero, false), (SafeOutput::Damping(5.0), true)] {
        let mut rig = Rig::new(servo(output), held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn);
        let mut seen = Vec::new();
        let mut look = |rig: &Rig<SerialArm>| {
            let now = agreed(rig);
            if seen.last() != Some(&now) {
                seen.push(now);
            }
        };
        for tick in 0..3_000 {
            rig.set(|world| world.button = (500..2_000).contains(&tick));
            if tick == 1_500 {
                rig.set(|world| world.bad = 3);
            }
            rig.tick();
            look(&rig);
        }
        // The frame that is the fault is none to be believed: for that tick nothing damps.
        let after: &[(Phase, bool)] =
            if damps { &[(Phase::Fault, false), (Phase::Fault, true)] } else { &[(Phase::Fault, false)] };
        let before = [(Phase::Calibrate, false), (Phase::Armed, false), (Phase::Running, true)];
        assert_eq!(seen, [&before[..], after].concat(), "{output:?}");
    }
}

#[test]
fn damping_after_a_fault_reaches_the_motors_and_brakes() {
    let speeds = [SafeOutput::Zero, SafeOutput::Damping(8.0)].map(|output| {
        // Nobody holds it, and it falls.
        let plant = palpate_sim::plant::Plant::new(
            &palpate_sim::plant::PlantSettings::wooden_haptics_2016(),
            palpate_sim::plant::HandSettings::NONE,
            Box::new(palpate_sim::plant::StillHand([0.0, 0.0, 0.03])),
            palpate_sim::rig::RATE,
        );
        let mut rig = Rig::new(servo(output), plant.unwrap(), &settings(), ResetReason::PowerOn);
        rig.ticks(100);
        rig.set(|world| world.reading = 100_000);
        rig.tick();
        rig.set(|world| world.reading = 200);
        assert_eq!(rig.fault(), Some(Fault::Overrun));
        rig.ticks(200);
        let world = rig.world.borrow();
        world.plant.velocity().iter().map(|component| component * component).sum::<f64>().sqrt()
    });
    let [free, braked] = speeds;
    assert!(braked < 0.5 * free && free > 0.1, "{speeds:?} m/s");
}

#[test]
fn a_tick_that_is_late_is_a_fault_and_its_own_duties_are_taken_back() {
    for phase in [Phase::Calibrate, Phase::Armed, Phase::Running] {
        let mut rig = Rig::new(servo(SafeOutput::Zero), held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn);
        match phase {
            Phase::Running => rig.press_until_it_runs(),
            Phase::Armed => rig.ticks(100),
            _ => rig.ticks(10),
        }
        assert_eq!(rig.state().phase(), phase);
        // A period is 42,500 cycles.
        rig.set(|world| world.reading = 43_000);
        rig.ticks_off(1);
        assert_eq!((rig.fault(), rig.state().overruns()), (Some(Fault::Overrun), 1));
        rig.set(|world| world.reading = 200);
        rig.ticks_off(1_000);
    }
}

#[test]
fn a_tick_that_begins_late_is_a_fault_and_gives_no_duties_of_its_own() {
    let mut rig = Rig::new(servo(SafeOutput::Zero), held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn);
    // However long nothing had begun before the first.
    rig.set(|world| world.cycles = world.cycles.wrapping_add(1_000_000));
    rig.press_until_it_runs();
    // The rig's own period is a whole one, and a little. Half a period of lateness is borne, as is half a period too early.
    for cycles in [20_000, -20_000] {
        rig.set(|world| world.cycles = world.cycles.wrapping_add_signed(cycles));
        rig.tick();
        assert_eq!((rig.fault(), rig.is_off()), (None, false));
    }
    rig.set(|world| world.cycles = world.cycles.wrapping_add(43_000));
    rig.ticks_off(1);
    assert_eq!((rig.fault(), rig.state().overruns()), (Some(Fault::Overrun), 1));
    rig.ticks_off(1_000);
    // A tick that took too long is counted itself, and not once more by the next, which it has kept waiting.
    let safety = Safety { max_overruns: 1, ..Safety::DEFAULT };
    let mut rig = Rig::new(safe(safety), held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn);
    rig.press_until_it_runs();
    rig.set(|world| world.reading = 80_000);
    rig.tick();
    rig.set(|world| world.reading = 200);
    rig.ticks(10);
    assert_eq!((rig.fault(), rig.state().overruns()), (None, 1));
}

#[test]
fn a_counter_that_stands_still_is_a_fault_within_two_milliseconds() {
    let mut rig = Rig::new(servo(SafeOutput::Zero), held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn);
    rig.press_until_it_runs();
    let mut still = 0;
    rig.set(|world| still = world.cycles);
    // 2 ms at 4 kHz.
    for _ in 0..8 {
        rig.set(|world| world.cycles = still);
        rig.tick();
    }
    assert_eq!((rig.fault(), rig.is_off()), (Some(Fault::Overrun), true));
}

#[test]
fn a_loop_that_is_told_to_stop_from_outside_lets_go_with_its_next_tick() {
    let mut rig = Rig::new(servo(SafeOutput::Zero), held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn);
    rig.press_until_it_runs();
    let mut state = *rig.state();
    let servo = servo(SafeOutput::Zero);
    servo.note(&mut state, Event::Stop);
    assert_eq!((state.output(), state.duties()), (Output::Off, [Duty::ZERO; 3]));
    assert!(rig.bench.board().release().is_ok() && rig.is_off());
}
