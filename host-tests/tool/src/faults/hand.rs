//! The hand that holds the probe.

use super::bench::FIRM;
use super::{Failure, Reaction::Latched, Setting, Shown::Planted, Touch, gap, row};
use palpate::servo::Fault;
use palpate_sim::plant::HandSettings;

/// Down on the wall and up again, twice: [s, m].
pub(super) const APPROACHES: [[f64; 2]; 7] =
    [[0.0, 0.01], [0.2, -0.014], [0.5, -0.014], [0.6, 0.01], [0.8, -0.014], [1.1, -0.014], [1.3, -0.014]];

/// Of each device that ships: the sink of an arm of 10 % more weight from the middle of its workspace in 2 s, mm.
pub const SINKS: [(&str, f64); 7] = [
    ("woodenhaptics-2016", 84.2),
    ("polhem-v2", 105.6),
    ("phantom-premium", 0.0),
    ("falcon", 0.0),
    ("haply-2diy-v3", 0.0),
    ("haply-kit-v1", 0.0),
    ("hapkit", 0.0),
];

/// An arm that is let go at its deepest press.
#[derive(Clone, Copy, Debug)]
pub struct Release {
    /// The device.
    pub device: &'static str,
    /// Its speed, m/s, and motion, mm, when it is stopped; `None` without protection.
    pub stopped: Option<[f64; 2]>,
    /// Its largest speed without protection, m/s; `None` where a press as deep ends in another fault.
    pub free: Option<f64>,
}

const fn release(device: &'static str, stopped: Option<[f64; 2]>, free: Option<f64>) -> Release {
    Release { device, stopped, free }
}

/// Of each device that ships.
pub const RELEASES: [Release; 7] = [
    release("woodenhaptics-2016", Some([1.09, 6.4]), Some(1.48)),
    release("polhem-v2", Some([0.67, 4.7]), Some(1.02)),
    release("phantom-premium", Some([0.69, 9.8]), Some(1.64)),
    release("falcon", Some([0.77, 19.7]), Some(0.83)),
    release("haply-2diy-v3", None, None),
    release("haply-kit-v1", None, Some(0.65)),
    release("hapkit", None, Some(1.39)),
];

/// Twice on the wall, so that all polarities are seen, then as deep as a contact is kept; there it lets go.
pub fn is_let_go(touch: &mut Touch<'_>) -> bool {
    const RELEASED: f64 = 2.0;
    if touch.tick == 0 {
        touch.hold(HandSettings::default());
        // The hand's spring gives way by the force of the wall.
        let aim = -0.85 * touch.deepest - touch.max_force / FIRM.stiffness;
        touch.follow(&[APPROACHES.as_slice(), &[[1.6, aim]]].concat(), 0.0);
    }
    match touch.time() {
        RELEASED.. => touch.hold(HandSettings::NONE),
        1.3.. => touch.hold(FIRM),
        _ => {}
    }
    touch.time() >= RELEASED
}

/// The hand presses until the force is full, and then lets go.
pub(super) fn lets_go_of_a_full_press(touch: &mut Touch<'_>) -> bool {
    if touch.tick == 0 {
        // The hand's spring gives way by the force of the wall.
        let aim = -0.5 * touch.deepest - touch.max_force / FIRM.stiffness;
        touch.follow(&[[0.0, -0.004], [0.3, aim]], 0.0);
    }
    let lets_go = touch.time() >= 0.5;
    if lets_go {
        touch.hold(HandSettings::NONE);
    }
    lets_go
}

/// Through what the contact bears and out again, five times a second.
fn presses_too_deep(touch: &mut Touch<'_>) -> bool {
    if touch.tick == 0 {
        let deep = -touch.deepest - 0.008;
        let strokes = (0..8).flat_map(|stroke| {
            let start = 0.2 * f64::from(stroke);
            [[start, 0.005], [start + 0.1, deep], [start + 0.12, deep]]
        });
        touch.follow(&strokes.collect::<Vec<_>>(), 0.0);
    }
    touch.lost > 0
}

/// It lets go in free air, 10 mm over the wall.
fn sinks(touch: &mut Touch<'_>) -> bool {
    if touch.tick == 0 {
        touch.hold(HandSettings::NONE);
    }
    // For 2 s.
    touch.tick < 8_000
}

pub(super) const TABLE: &[Failure] = &[
    row(
        [
            "hand",
            "the arm is let go at its deepest press",
            "speed limits; the wall's energy in the motion",
            "an_arm_released_from_the_deepest_press_is_stopped",
        ],
        100.0,
        Latched(Fault::Overspeed),
        Planted(Setting::Protected, is_let_go),
    )
    .but("devices of one or two joints (no `Protection` ships)", |subject| {
        (subject.joints() < 3).then_some("no protection ships for it")
    }),
    row(
        [
            "hand",
            "it presses too deep four times within a second",
            "contact limits",
            "every_fault_in_every_phase_is_safe_named_and_latched",
        ],
        1_000.0,
        Latched(Fault::ContactLost),
        Planted(Setting::Pressed, presses_too_deep),
    ),
    row(
        ["hand", "it homes the arm in another pose", "homing", "every_fault_in_every_phase_is_safe_named_and_latched"],
        0.25,
        Latched(Fault::Homing),
        Planted(Setting::Misplaced, |touch| {
            touch.world.button = true;
            true
        }),
    ),
    gap(
        "hand",
        "it lets go of an arm whose weight is wrong by 10 %",
        "the arm sinks, more slowly than the speed limits; commissioning weighs",
        Some((Setting::Heavier, sinks)),
    ),
];
