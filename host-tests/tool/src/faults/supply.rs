//! The motors' supply and the chip's.

use super::{
    Failure,
    Reaction::{Hold, Latched},
    Setting,
    Shown::Planted,
    row,
};
use palpate::servo::{Fault, ResetReason};

pub(super) const TABLE: &[Failure] = &[
    row(
        [
            "supply",
            "the motors' voltage dips",
            "low-pass",
            "a_supply_that_dips_takes_force_away_and_a_single_reading_does_not",
        ],
        1.0,
        Hold,
        Planted(Setting::Pressed, |touch| {
            touch.world.supply = 9.0;
            true
        }),
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
        Planted(Setting::Pressed, |touch| {
            touch.world.supply = 40.0;
            true
        }),
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
        Planted(Setting::Pressed, |touch| {
            touch.world.measured = |_| None;
            true
        }),
    ),
    row(
        [
            "supply",
            "a conversion never ends",
            "bounded wait; reading absent",
            "test_conversion_that_never_ends_stops_within_five_ticks",
        ],
        1.25,
        Hold,
        Planted(Setting::Pressed, |touch| {
            touch.world.converts = false;
            true
        }),
    ),
    row(
        [
            "supply",
            "the converter's reference is wrong",
            "it measures a voltage of the chip too",
            "test_converter_that_measures_its_own_reference_wrong_stops_within_five_ticks",
        ],
        1.25,
        Hold,
        Planted(Setting::Pressed, |touch| {
            touch.world.reference = 0.85;
            true
        }),
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
        Planted(Setting::NoSupply, |touch| {
            touch.world.button = true;
            true
        }),
    )
    .but("devices of one or two joints (no `Protection` ships)", |subject| {
        (subject.joints() < 3).then_some("no protection ships for it")
    }),
    row(
        [
            "supply",
            "the chip's supply broke down",
            "reset reason",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        0.25,
        Latched(Fault::BrownOut),
        Planted(Setting::Reset(ResetReason::BrownOut), |touch| {
            touch.world.button = true;
            true
        }),
    ),
];
