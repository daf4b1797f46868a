//! The failures of a device on the bench, each with its detector, the promised time and the loop's reaction. `palpate
//! faults` plants them in a simulated arm; the page `docs/reference/faults.md` is written from this table.

use palpate::device::SerialArm;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::servo::{Config, Fault, ResetReason, Safety, Servo};
use palpate_bench::sensors::BadFrame;
use palpate_sim::plant::EncoderFault;
use palpate_sim::rig::{Rig, SETTINGS, WALL, held_at, settings};
use std::fmt::Write as _;

/// Ticks of the simulated arm in a millisecond.
const TICKS_PER_MS: f64 = palpate_sim::rig::RATE / 1_000.0;
/// Ticks after which a failure counts as not detected.
const PATIENCE: u32 = 4_000;

/// How a failure shows in the loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// The motors are off, and this fault is latched.
    Latched(Fault),
    /// The motors are off until the cause has gone and enable was released.
    Hold,
    /// The program does not start: the motors stay off.
    NoStart,
}

/// How the row is shown.
#[derive(Clone, Copy, Debug)]
pub enum Shown {
    /// Planted by [`plant`]: this change of the simulated device, in every tick, with the tick's number.
    Planted(fn(&mut Rig<SerialArm>, u32)),
    /// A reset for this reason.
    Reset(ResetReason),
    /// By its test alone.
    Tested,
    /// Not detected; the reason.
    Gap(&'static str),
}

/// A failure.
#[derive(Clone, Copy, Debug)]
pub struct Failure {
    /// The failing part.
    pub part: &'static str,
    /// The failure.
    pub failure: &'static str,
    /// The detector.
    pub detected_by: &'static str,
    /// Promised time until the motors are off, ms.
    pub within_ms: f64,
    /// The reaction.
    pub reaction: Reaction,
    /// The test that shows it.
    pub test: &'static str,
    /// How it is shown here.
    pub shown: Shown,
}

const fn row(
    [part, failure, detected_by, test]: [&'static str; 4],
    within_ms: f64,
    reaction: Reaction,
    shown: Shown,
) -> Failure {
    Failure { part, failure, detected_by, within_ms, reaction, test, shown }
}

const fn gap(part: &'static str, failure: &'static str, reason: &'static str) -> Failure {
    row([part, failure, "", ""], f64::INFINITY, Reaction::Hold, Shown::Gap(reason))
}

/// Frames that are bad from now on.
fn bad(rig: &mut Rig<SerialArm>, kind: BadFrame) {
    rig.set(|world| (world.kind, world.bad) = (kind, 1));
}

use Reaction::{Hold, Latched, NoStart};
use Shown::{Planted, Reset, Tested};

/// Every failure, by part.
pub const TABLE: &[Failure] = &[
    row(
        [
            "sensor",
            "no frame comes",
            "third in a row",
            "two_bad_frames_in_a_row_are_bridged_and_counted_and_the_third_is_the_fault_in_its_own_tick",
        ],
        0.75,
        Latched(Fault::FrameLost),
        Planted(|rig, _| bad(rig, BadFrame::Absent)),
    ),
    row(
        [
            "sensor",
            "every frame is damaged",
            "third in a row",
            "two_bad_frames_in_a_row_are_bridged_and_counted_and_the_third_is_the_fault_in_its_own_tick",
        ],
        0.75,
        Latched(Fault::FrameDamaged),
        Planted(|rig, _| bad(rig, BadFrame::Damaged)),
    ),
    row(
        [
            "sensor",
            "two of three frames are damaged",
            "more than 1 % of frames",
            "more_than_one_bad_frame_in_a_hundred_is_a_fault_though_no_three_come_in_a_row",
        ],
        4.25,
        Latched(Fault::FrameDamaged),
        Planted(|rig, _| rig.set(|world| world.bad_of = [2, 3])),
    ),
    row(
        [
            "sensor",
            "a reading jumps",
            "faster than a hand, three times",
            "sensors_that_lie_or_fall_silent_are_faults_and_the_motors_are_off",
        ],
        0.75,
        Latched(Fault::FrameDamaged),
        Planted(|rig, tick| {
            if tick == 0 {
                rig.set(|world| world.plant.inject(1, Some(EncoderFault::Jump(300))));
            }
        }),
    ),
    row(
        [
            "sensor",
            "the magnet is lost",
            "diagnostic frame",
            "a_magnet_that_falls_off_and_a_sensor_that_freezes_are_faults_on_an_arm",
        ],
        1.0,
        Latched(Fault::Magnet),
        Planted(|rig, _| bad(rig, BadFrame::Magnet)),
    ),
    row(
        [
            "sensor",
            "a magnetic reading freezes",
            "1,000 equal readings",
            "a_magnet_that_falls_off_and_a_sensor_that_freezes_are_faults_on_an_arm",
        ],
        251.0,
        Latched(Fault::Frozen),
        Tested,
    ),
    row(
        [
            "sensor",
            "a counter sticks under load, the others move",
            "stuck limits",
            "a_sensor_that_sticks_under_load_is_a_fault_though_each_of_its_frames_is_good",
        ],
        2_000.0,
        Latched(Fault::JointStuck),
        Tested,
    ),
    row(
        [
            "sensor",
            "an angle leaves its range or the mechanism's reach",
            "every tick",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        0.25,
        Latched(Fault::JointOutOfRange),
        Tested,
    ),
    gap("sensor", "a counter without load stands still", "a joint at rest reads the same"),
    row(
        [
            "line",
            "the enable wire breaks",
            "every tick",
            "an_enable_that_is_released_and_pressed_again_starts_softly_again",
        ],
        0.25,
        Hold,
        Planted(|rig, _| rig.set(|world| world.button = false)),
    ),
    row(
        [
            "line",
            "one of two enable contacts stays closed",
            "force needs both; both must open within 0.5 s of each other",
            "one_of_two_contacts_asks_for_nothing_and_one_that_stays_closed_holds_until_both_were_open",
        ],
        0.25,
        Hold,
        Planted(|rig, _| rig.set(|world| (world.button, world.second_contact) = (false, Some(true)))),
    ),
    gap(
        "line",
        "the only enable contact stays closed",
        "no force before it was seen released, but letting go is not seen: wire two (`TwoChannels`)",
    ),
    row(
        ["line", "the stop wire breaks", "every tick", "a_broken_stop_wire_stops"],
        0.25,
        Hold,
        Planted(|rig, _| rig.set(|world| world.stop_open = true)),
    ),
    row(
        [
            "line",
            "the stop contact is welded or its wire is shorted, with `tests_stop`",
            "no force before it was pressed once",
            "where_the_stop_button_is_tested_there_is_no_force_before_it_was_pressed_and_let_go_of",
        ],
        0.0,
        Hold,
        Tested,
    ),
    row(
        [
            "line",
            "a ready wire breaks",
            "every tick; a fault after 50 ms",
            "a_ready_line_that_breaks_while_driving_lets_go_at_once_and_is_a_fault_if_nothing_explains_it",
        ],
        0.25,
        Latched(Fault::Drive),
        Planted(|rig, _| rig.set(|world| world.ready_wires[1] = false)),
    ),
    row(
        [
            "line",
            "an enable line stays on",
            "read back in the tick after its release",
            "an_enable_line_that_reads_on_though_it_was_released_is_a_fault",
        ],
        0.25,
        Latched(Fault::Drive),
        Planted(|rig, _| rig.set(|world| (world.button, world.is_enable_shorted) = (false, true))),
    ),
    row(
        ["motor", "an amplifier fails", "its ready line; a fault after 50 ms", "an_amplifiers_own_fault_is_latched"],
        0.25,
        Latched(Fault::Drive),
        Planted(|rig, _| rig.set(|world| world.amplifiers_well = false)),
    ),
    row(
        [
            "motor",
            "motor or encoder of a joint in contact is wired the other way",
            "polarity check",
            "a_wrong_sign_is_stopped_within_ten_milliseconds_and_a_millimetre",
        ],
        10.0,
        Latched(Fault::WrongPolarity),
        Tested,
    ),
    gap(
        "sensor",
        "a reversed encoder of a joint beyond the first keeps the probe from contact",
        "no contact gives no force; commissioning turns each joint and finds it",
    ),
    gap("motor", "a winding of an arm opens or shorts", "an arm measures no current; its amplifier protects itself"),
    row(
        [
            "motor",
            "a winding opens or shorts, behind `CurrentWatched`",
            "phase currents",
            "a_short_an_open_phase_and_a_lost_measurement_of_the_currents_stop_the_motor",
        ],
        500.0,
        Latched(Fault::Drive),
        Tested,
    ),
    row(
        [
            "clock",
            "a tick takes longer than its period",
            "the timer of the ticks",
            "a_tick_that_is_late_is_a_fault_and_its_own_duties_are_taken_back",
        ],
        0.25,
        Latched(Fault::Overrun),
        Planted(|rig, _| rig.set(|world| world.reading = 43_000)),
    ),
    row(
        [
            "clock",
            "a tick starts late",
            "the timer of the ticks",
            "a_tick_that_begins_late_is_a_fault_and_gives_no_duties_of_its_own",
        ],
        0.25,
        Latched(Fault::Overrun),
        Planted(|rig, _| rig.set(|world| world.cycles = world.cycles.wrapping_add(43_000))),
    ),
    row(
        [
            "clock",
            "the timer of the ticks stands still",
            "start of ticks",
            "a_counter_that_stands_still_is_a_fault_within_two_milliseconds",
        ],
        2.0,
        Latched(Fault::Overrun),
        Planted(|rig, _| rig.set(|world| world.cycles = 0x1234_5678)),
    ),
    row(
        [
            "clock",
            "two oscillators of the chip disagree by a fifth",
            "counted in main, 32 times a second",
            "test_clock_that_disagrees_with_another_of_the_chip_stops",
        ],
        100.0,
        Latched(Fault::WatchdogReset),
        Tested,
    ),
    row(
        [
            "supply",
            "the motors' voltage dips",
            "low-pass",
            "a_supply_that_dips_takes_force_away_and_a_single_reading_does_not",
        ],
        1.0,
        Hold,
        Planted(|rig, _| rig.set(|world| world.supply = 15.0)),
    ),
    row(
        [
            "supply",
            "braking raises the motors' voltage",
            "every reading",
            "a_supply_out_of_its_range_in_half_of_the_readings_holds_and_one_above_it_at_once",
        ],
        0.25,
        Hold,
        Planted(|rig, _| rig.set(|world| world.supply = 40.0)),
    ),
    row(
        [
            "supply",
            "the converter fails",
            "reading absent",
            "a_supply_that_dips_takes_force_away_and_a_single_reading_does_not",
        ],
        1.0,
        Hold,
        Planted(|rig, _| rig.set(|world| world.measured = |_| None)),
    ),
    row(
        [
            "supply",
            "no supply reading reaches a protected loop",
            "guard",
            "a_supply_out_of_range_or_that_nobody_measures_is_a_fault",
        ],
        100.0,
        Latched(Fault::Supply),
        Tested,
    ),
    row(
        [
            "supply",
            "the chip's supply broke down",
            "reset reason",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        0.25,
        Latched(Fault::BrownOut),
        Reset(ResetReason::BrownOut),
    ),
    row(
        [
            "memory",
            "the program hung",
            "watchdog, which resets the chip; reset reason",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        40.0,
        Latched(Fault::WatchdogReset),
        Reset(ResetReason::Watchdog),
    ),
    row(
        [
            "memory",
            "the program feeds the watchdog too early (Nucleo, Teensy)",
            "window of the watchdog; reset reason",
            "test_watchdog_is_fed_within_its_window_alone",
        ],
        1.0,
        Latched(Fault::WatchdogReset),
        Tested,
    ),
    row(
        [
            "memory",
            "a bit of stack or variables sticks at the start (Nucleo, Pico 2)",
            "March X before the program starts",
            "test_bit_of_memory_that_sticks_keeps_the_program_from_starting",
        ],
        0.0,
        NoStart,
        Tested,
    ),
    row(
        [
            "memory",
            "a word of the capped box's tables changes",
            "CRC, a word every second tick",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        2_000.0,
        Latched(Fault::TableCorrupt),
        Tested,
    ),
    row(
        [
            "memory",
            "the core locks up or a word is damaged (Nucleo)",
            "break of the timer",
            "test_core_that_locks_up_damaged_memory_and_a_falling_supply_end_the_set_points",
        ],
        0.25,
        Latched(Fault::WatchdogReset),
        Tested,
    ),
    row(
        ["memory", "a force is not a number", "every tick", "every_fault_in_every_phase_is_safe_named_and_latched"],
        0.25,
        Latched(Fault::NotFinite),
        Tested,
    ),
    row(
        [
            "memory",
            "the stored calibration is damaged",
            "CRC and limits at start",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        0.25,
        Latched(Fault::Calibration),
        Tested,
    ),
    row(
        [
            "memory",
            "a word of the program in RAM changes",
            "compared with its image in flash",
            "test_word_of_the_program_that_differs_from_its_image_stops",
        ],
        1_000.0,
        Latched(Fault::WatchdogReset),
        Tested,
    ),
    row(
        [
            "host",
            "it is silent for the link timeout",
            "every tick",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        0.25,
        Latched(Fault::LinkLost),
        Tested,
    ),
    row(
        ["host", "it sends stop", "every tick", "a_loop_that_is_told_to_stop_from_outside_lets_go_with_its_next_tick"],
        0.25,
        Latched(Fault::Stopped),
        Tested,
    ),
    row(
        [
            "hand",
            "the arm is let go at its deepest press",
            "speed limits",
            "an_arm_released_from_the_deepest_press_is_stopped",
        ],
        300.0,
        Latched(Fault::Overspeed),
        Tested,
    ),
    row(
        [
            "hand",
            "it presses too deep a fourth time within a second",
            "contact limits",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        0.25,
        Latched(Fault::ContactLost),
        Tested,
    ),
    row(
        ["hand", "it homes the arm in another pose", "homing", "every_fault_in_every_phase_is_safe_named_and_latched"],
        0.25,
        Latched(Fault::Homing),
        Tested,
    ),
    gap("hand", "it lets go of an arm whose weight is wrong by 10 %", "the arm sinks below the speed limits"),
];

/// The effect of a planted failure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Time until the motors were off, ms; `None` if they never were.
    pub off_ms: Option<f64>,
    /// The latched fault, 100 ms later.
    pub fault: Option<Fault>,
    /// Largest motion of the probe until the motors were off, mm.
    pub motion_mm: f64,
}

impl Failure {
    /// Whether the device did as the row says.
    pub fn is_as_stated(&self, found: &Found) -> bool {
        let fault = match self.reaction {
            Latched(fault) => Some(fault),
            Hold | NoStart => None,
        };
        found.off_ms.is_some_and(|time| time <= self.within_ms) && found.fault == fault
    }
}

fn rig(reset: ResetReason) -> Rig<SerialArm> {
    let config = Config { settings: SETTINGS, safety: Safety::DEFAULT, ..Config::DEFAULT };
    Rig::new(Servo::new(&WOODEN_HAPTICS_2016, &WALL, config), held_at([0.0, 0.0, -0.004]), &settings(), reset)
}

/// Plants a failure in the simulated arm while it pushes a hand that holds it 4 mm inside a wall; `None` for a row that
/// only its test shows.
pub fn plant(failure: &Failure) -> Option<Found> {
    let (mut rig, change): (_, fn(&mut Rig<SerialArm>, u32)) = match failure.shown {
        Planted(change) => (rig(ResetReason::PowerOn), change),
        Reset(reason) => (rig(reason), |rig, _| rig.set(|world| world.button = true)),
        Tested | Shown::Gap(_) => return None,
    };
    if matches!(failure.shown, Planted(_)) {
        rig.press_until_it_runs();
    }
    let start = rig.world.borrow().plant.position();
    let (mut found, mut until) = (Found { off_ms: None, fault: None, motion_mm: 0.0 }, PATIENCE);
    let mut tick = 0;
    while tick < until {
        change(&mut rig, tick);
        rig.tick();
        tick += 1;
        let now = rig.world.borrow().plant.position();
        let moved = now.iter().zip(start).map(|(now, start)| (now - start).powi(2)).sum::<f64>().sqrt();
        if found.off_ms.is_none() {
            found.motion_mm = found.motion_mm.max(1e3 * moved);
        }
        if found.off_ms.is_none() && rig.is_off() {
            // The latched fault may follow the hold.
            (found.off_ms, until) = (Some(f64::from(tick) / TICKS_PER_MS), tick + 400);
        }
    }
    found.fault = rig.fault();
    Some(found)
}

/// The table as Markdown, and the counted coverage.
pub fn page() -> String {
    let mut page =
        "| part | failure | detected by | within, ms | reaction | shown by |\n|---|---|---|---|---|---|\n".to_owned();
    for Failure { part, failure, detected_by, within_ms, reaction, test, shown } in TABLE {
        let _ = match (shown, reaction) {
            (Shown::Gap(reason), _) => writeln!(page, "| {part} | {failure} | **not detected**: {reason} | | | |"),
            (_, Latched(fault)) => writeln!(
                page,
                "| {part} | {failure} | {detected_by} | {within_ms} | off, [{}: {fault}](../troubleshooting.md#faults) | `{test}` |",
                fault.code()
            ),
            (_, Hold) => writeln!(page, "| {part} | {failure} | {detected_by} | {within_ms} | off, hold | `{test}` |"),
            (_, NoStart) => {
                writeln!(page, "| {part} | {failure} | {detected_by} | {within_ms} | no start | `{test}` |")
            }
        };
    }
    let gaps = TABLE.iter().filter(|row| matches!(row.shown, Shown::Gap(_))).count();
    let planted = TABLE.iter().filter(|row| matches!(row.shown, Planted(_) | Reset(_))).count();
    let _ = writeln!(
        page,
        "\n{} of {} failures are detected; the command plants {planted}.",
        TABLE.len() - gaps,
        TABLE.len()
    );
    page
}
