//! Clocks and the times of ticks.

use super::{Failure, Reaction::Latched, Setting, Shown::Planted, row};
use palpate::servo::Fault;

pub(super) const TABLE: &[Failure] = &[
    row(
        [
            "clock",
            "a tick takes longer than its period",
            "the timer of the ticks",
            "a_tick_that_is_late_is_a_fault_and_its_own_duties_are_taken_back",
        ],
        0.25,
        Latched(Fault::Overrun),
        Planted(Setting::Pressed, |touch| {
            touch.world.reading = 43_000;
            true
        }),
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
        Planted(Setting::Pressed, |touch| {
            touch.world.cycles = touch.world.cycles.wrapping_add(43_000);
            true
        }),
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
        Planted(Setting::Pressed, |touch| {
            touch.world.cycles = 0x1234_5678;
            true
        }),
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
        Planted(Setting::Pressed, |touch| {
            touch.chip.oscillator = 0.8;
            true
        }),
    ),
];
