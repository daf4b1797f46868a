//! Fast rides along bodies, over smooth edges, sharp ones, corners and poles: the witness point keeps up, tick for
//! tick.

use crate::scene::Scene;
use palpate_truth::rides::{Lateness, Rides};

/// Ticks in a row that the nearest point may be late: straight over a pole at 1 m/s it takes four.
const LATE: u32 = 4;
/// How much too far the witness point may be until then, in sizes of the body.
const EXCESS: f32 = 1e-3;

#[test]
fn a_ride_at_a_metre_a_second_has_the_nearest_point_in_time() {
    for name in ["capped_box", "rounded_cylinder", "ellipsoid_body", "thin_plate"] {
        let body = &Scene::load(name).body;
        for speed in [0.3, 1.0] {
            let rides = Rides { count: 100, rate: 4_000.0, speed, distance: 0.01 * body.size() };
            let found @ Lateness { ticks, most, excess } = rides.along(body);
            println!("{name}, {speed} m/s: {found:?}");
            assert!(ticks > 5_000, "{name}: {ticks} ticks");
            assert!(most <= LATE && excess < EXCESS * body.size(), "{name} at {speed} m/s: {found:?}");
        }
    }
}
