//! Program, tables and calibration.

use super::{
    Failure,
    Reaction::{Latched, NoStart},
    Setting,
    Shown::{Planted, Tested},
    row,
};
use palpate::servo::{Fault, ResetReason};

pub(super) const TABLE: &[Failure] = &[
    row(
        [
            "memory",
            "the program hung",
            "watchdog, which resets the chip; reset reason",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        40.0,
        Latched(Fault::WatchdogReset),
        Planted(Setting::Reset(ResetReason::Watchdog), |touch| {
            touch.world.button = true;
            true
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
        Tested,
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
        Tested,
    ),
    row(
        [
            "memory",
            "a word of the capped box's tables changes",
            "CRC, a word every eighth tick",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        6_500.0,
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
            "a word of the program in RAM changes",
            "compared with its image in flash",
            "test_word_of_the_program_that_differs_from_its_image_stops",
        ],
        1_000.0,
        Latched(Fault::WatchdogReset),
        Tested,
    ),
];
