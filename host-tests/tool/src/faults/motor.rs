//! Motors and their amplifiers.

use super::hand::APPROACHES;
use super::{
    Failure,
    Reaction::Latched,
    Setting,
    Shown::{OnKnob, Planted},
    gap, row,
};
use palpate::servo::Fault;
use palpate_sim::plant::HandSettings;

pub(super) const TABLE: &[Failure] = &[
    row(
        ["motor", "an amplifier fails", "its ready line; a fault after 50 ms", "an_amplifiers_own_fault_is_latched"],
        0.25,
        Latched(Fault::Drive),
        Planted(Setting::Pressed, |touch| {
            touch.world.amplifiers_well = false;
            true
        }),
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
        Planted(Setting::ReversedMotor(1), |touch| {
            if touch.tick == 0 {
                touch.hold(HandSettings::default());
                touch.follow(&APPROACHES, 0.0);
            }
            // It acts while the motor is driven.
            touch.world.currents()[1] != 0.0
        }),
    )
    .but("devices of one or two joints (no `Protection` ships)", |subject| {
        (subject.joints() < 3).then_some("no protection ships for it")
    }),
    row(
        [
            "motor",
            "a winding opens or shorts, behind `CurrentWatched`",
            "phase currents",
            "a_short_an_open_phase_and_a_lost_measurement_of_the_currents_stop_the_motor",
        ],
        500.0,
        Latched(Fault::Drive),
        OnKnob("phase currents"),
    ),
    gap(
        "motor",
        "a capstan cable or belt breaks, and the encoder goes on with the motor",
        "the joint is limp; under force its motor, without load, runs to the limits of rate or range",
        None,
    ),
    gap(
        "motor",
        "a winding of an arm opens or shorts",
        "an arm measures no current; its amplifier protects itself",
        Some((Setting::Pressed, |touch| {
            touch.world.open_windings[0] = true;
            true
        })),
    ),
];
