//! Lines of the person's side and of the amplifiers.

use super::{
    Failure,
    Reaction::{Hold, Latched},
    Setting,
    Shown::Planted,
    gap, row,
};
use palpate::servo::Fault;

pub(super) const TABLE: &[Failure] = &[
    row(
        [
            "line",
            "the enable wire breaks",
            "every tick",
            "an_enable_that_is_released_and_pressed_again_starts_softly_again",
        ],
        0.25,
        Hold,
        Planted(Setting::Pressed, |touch| {
            touch.world.button = false;
            true
        }),
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
        Planted(Setting::Pressed, |touch| {
            (touch.world.button, touch.world.second_contact) = (false, Some(true));
            true
        }),
    ),
    row(
        ["line", "the stop wire breaks", "every tick", "a_broken_stop_wire_stops"],
        0.25,
        Hold,
        Planted(Setting::Pressed, |touch| {
            touch.world.stop_open = true;
            true
        }),
    ),
    row(
        [
            "line",
            "the stop contact is welded or its wire is shorted, with `tests_stop`",
            "no force before it was pressed once",
            "where_the_stop_button_is_tested_there_is_no_force_before_it_was_pressed_and_let_go_of",
        ],
        0.25,
        Hold,
        Planted(Setting::StopUntested, |touch| {
            touch.world.button = true;
            true
        }),
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
        Planted(Setting::Pressed, |touch| {
            touch.world.ready_wires[0] = false;
            true
        }),
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
        Planted(Setting::Pressed, |touch| {
            (touch.world.button, touch.world.is_enable_shorted) = (false, true);
            true
        }),
    ),
    gap(
        "line",
        "the only enable contact stays closed",
        "no force before it was seen released, but letting go is not seen: wire two (`TwoChannels`)",
        Some((Setting::Pressed, |_| true)),
    ),
];
