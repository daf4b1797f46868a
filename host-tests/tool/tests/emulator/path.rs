//! A movement for the probe: from above the body down into it.

use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::wire::Sensors;

/// Ticks until the probe is deep in any body that lies in the middle of the workspace.
pub const TICKS: u32 = 2_000;

/// The sensors at a tick of the movement: half a second at 4 kHz, well below the speed of a hand.
pub fn sensors(tick: u32) -> Sensors {
    let along = tick.min(TICKS) as f32 / TICKS as f32;
    let angles = [0.02 * along, 0.6 * along, 0.6 + 0.5 * along];
    let mut counts = [0; 3];
    for ((count, angle), encoder) in counts.iter_mut().zip(angles).zip(&WOODEN_HAPTICS_2016.encoders) {
        *count = (angle / encoder.radians_per_count).round() as i32;
    }
    Sensors { tick, counts, enable: true }
}
