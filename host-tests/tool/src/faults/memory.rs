//! Program, tables and calibration.

use super::{
    Failure,
    Reaction::{Latched, NoStart},
    Setting,
    Shown::Planted,
    hand::lets_go_of_a_full_press,
    row,
};
use palpate::servo::Fault;

pub(super) const TABLE: &[Failure] = &[
    row(
        [
            "memory",
            "the program hung",
            "watchdog of 20 ms, 40 with a host or a knob, its clock up to a tenth slow; reset reason",
            "test_watchdog_is_fed_only_while_ticks_go_on",
        ],
        45.0,
        Latched(Fault::WatchdogReset),
        Planted(Setting::Pressed, |touch| {
            touch.chip.hangs = lets_go_of_a_full_press(touch);
            touch.chip.hangs
        }),
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
        Planted(Setting::Pressed, |touch| {
            touch.chip.feeds_always = lets_go_of_a_full_press(touch);
            touch.chip.feeds_always
        }),
    ),
    row(
        [
            "memory",
            "a bit of stack or variables sticks at the start",
            "March X before the program starts; on the Teensy word by word",
            "test_bit_of_memory_that_sticks_keeps_the_program_from_starting",
        ],
        0.0,
        NoStart,
        Planted(Setting::NoStart, |touch| {
            touch.world.button = true;
            true
        }),
    ),
    row(
        [
            "memory",
            "a word of the capped box's tables changes",
            "CRC, a word every eighth tick",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        5_000.0,
        Latched(Fault::TableCorrupt),
        Planted(Setting::Tabled, |touch| {
            touch.word_changes = true;
            true
        }),
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
        Planted(Setting::Pressed, |touch| {
            touch.chip.locks_up = lets_go_of_a_full_press(touch);
            touch.chip.locks_up
        }),
    ),
    row(
        ["memory", "a force is not a number", "every tick", "every_fault_in_every_phase_is_safe_named_and_latched"],
        0.25,
        Latched(Fault::NotFinite),
        Planted(Setting::Pressed, |touch| {
            touch.poison.set(Some(f32::NAN));
            true
        }),
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
        Planted(Setting::Miscalibrated, |touch| {
            touch.world.button = true;
            true
        }),
    ),
    row(
        [
            "memory",
            "a soft body was made for another rate",
            "compared at start",
            "a_loop_of_another_rate_than_its_soft_body_is_a_fault_from_the_start",
        ],
        0.25,
        Latched(Fault::OtherRate),
        Planted(Setting::OtherRate, |touch| {
            touch.world.button = true;
            true
        }),
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
        Planted(Setting::Pressed, |touch| {
            touch.chip.word_changes = touch.tick == 0;
            true
        }),
    ),
];
