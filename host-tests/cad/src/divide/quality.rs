//! How good a quad is: the least sine between the lines of its map, 1 for a rectangle, below 0 where it folds.

use glam::DVec2;

/// Over a grid of 7 × 7 points, the border's included. Where a side is one point the grid keeps off it.
pub fn of_map(map: &dyn Fn(f64, f64) -> DVec2, has_pole: bool) -> f64 {
    above(map, has_pole, f64::NEG_INFINITY)
}

/// The same; once it is found to lie below `floor`, what was found so far.
fn above(map: &dyn Fn(f64, f64) -> DVec2, has_pole: bool, floor: f64) -> f64 {
    // The corners first: there most are told to fold.
    const LINES: [i32; 7] = [0, 6, 3, 1, 5, 2, 4];
    let step = 1e-4;
    let mut least: f64 = 1.0;
    for i in LINES {
        for j in LINES {
            let keep = if has_pole { 0.05 } else { step };
            let [s, t] = [i, j].map(|k| (f64::from(k) / 6.0).clamp(keep, 1.0 - keep));
            let du = map(s + step, t) - map(s - step, t);
            let dv = map(s, t + step) - map(s, t - step);
            let sine = du.perp_dot(dv) / (du.length() * dv.length()).max(f64::MIN_POSITIVE);
            least = least.min(sine);
            if least < floor {
                return least;
            }
        }
    }
    least
}

/// What a quad costs: one patch, more if it is slanted, a little if it is long. None if it is not worth having.
pub fn cost(map: &dyn Fn(f64, f64) -> DVec2, has_pole: bool) -> Option<f64> {
    const LEAST: f64 = 0.12;
    let sine = above(map, has_pole, LEAST);
    if sine < LEAST {
        return None;
    }
    let lengths = [map(1.0, 0.5).distance(map(0.0, 0.5)), map(0.5, 1.0).distance(map(0.5, 0.0))];
    let aspect = (lengths[0] / lengths[1]).max(lengths[1] / lengths[0]);
    Some(1.0 + 2.0 * (1.0 - sine) * (1.0 - sine) + 0.05 * aspect.ln())
}
