//! The host at the line.

use super::{Failure, Reaction::Latched, Setting, Shown::Planted, row};
use palpate::servo::Fault;
use palpate::wire::HostMessage;

pub(super) const TABLE: &[Failure] = &[
    row(
        [
            "host",
            "it is silent for the link timeout, here 50 ms",
            "every tick",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        50.5,
        Latched(Fault::LinkLost),
        Planted(Setting::Linked, |_| true),
    ),
    row(
        ["host", "it sends stop", "every tick", "a_loop_that_is_told_to_stop_from_outside_lets_go_with_its_next_tick"],
        0.25,
        Latched(Fault::Stopped),
        Planted(Setting::Linked, |touch| {
            touch.sends.push(HostMessage::Stop);
            true
        }),
    ),
];
