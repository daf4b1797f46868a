//! The path of a hand that feels a surface on a device: as often and as widely as speed and workspace let it.

use crate::plant::path::{PathError, TouchingPath};
use crate::plant::touching::TouchingSettings;
use crate::plant::vector::Vector;
use glam::DVec3;
use palpate::body::Body;
use palpate::math::Vec3;
use palpate::patch::{Patch as _, SplinePatch};
use std::f64::consts::PI;

/// How often the hand touches: a stroke of 0.8 s.
const TOUCHES_PER_SECOND: f64 = 1.2;
/// How deep it aims at least and at most, m.
pub(super) const PRESS_DEPTH: [f64; 2] = [0.006, 0.014];
/// How far it reaches around a body, seen from its middle: from above to this angle, radians, along either axis.
const AROUND: f64 = 0.6 * PI;
/// Shares of the surface, in twentieths, that it is content with: all of it, down to its middle third.
const SHARES: std::ops::RangeInclusive<u32> = 6..=20;

impl TouchingPath {
    /// A path of `duration` seconds over `surface` (as in [`Self::new`]) that stays where `has_room` allows it, m in
    /// the device frame. If the surface is larger than that, the hand keeps to the surface's middle; if surface or seed
    /// would need a higher speed than a hand has, it touches less often.
    ///
    /// # Errors
    /// A duration that makes no sense, a surface that is not finite, [`PathError::NoRoom`], or [`PathError::TooFast`] where even
    /// its middle third leaps from place to place.
    pub fn within(
        surface: impl Fn(f64, f64) -> (Vector, Vector),
        duration: f64,
        seed: u64,
        has_room: impl Fn(Vector) -> bool,
    ) -> Result<Self, PathError> {
        // A short run sees the start of a path that a hand could follow.
        let duration = duration.max(1.0);
        let most_touches = (TOUCHES_PER_SECOND * duration).round() as u32;
        let path_of = |share: f64, touches| {
            // Most touches stay on the face; in the air the hand goes over the rim.
            let touching = TouchingSettings {
                duration,
                touches,
                press_depth: PRESS_DEPTH,
                pressed_reach: 0.8,
                ..TouchingSettings::default()
            };
            let part = |at: f64| 0.5 + share * (at - 0.5);
            Self::new(|u, v| surface(part(u), part(v)), touching, seed)
        };
        let is_too_fast = |path: &Result<_, PathError>| matches!(path, Err(PathError::TooFast { .. }));
        let slower = |share| {
            let paths = (1..=most_touches).rev().map(|touches| path_of(share, touches));
            paths.into_iter().find(|path| !is_too_fast(path)).unwrap_or_else(|| path_of(share, 1))
        };
        let keeps = |path: &Result<Self, PathError>| match path {
            Ok(path) => path.keeps_to(&has_room),
            Err(_) => !is_too_fast(path),
        };
        let mut refused = PathError::NoRoom;
        for share in SHARES.rev() {
            let path = slower(f64::from(share) / 20.0);
            if keeps(&path) {
                return path;
            }
            refused = path.err().unwrap_or(PathError::NoRoom);
        }
        Err(refused)
    }
}

/// Where a hand may touch a body, seen from its middle, m: for each `(u, v)` in `[0, 1]²`, which is a
/// [direction](direction_around) to a place outside, the body's closest point to that place, and the direction back.
/// Continuous around a convex body, edges and corners included.
pub fn place_around(body: &Body<'_>, middle: Vec3, u: f64, v: f64) -> (DVec3, DVec3) {
    let outside = middle + DVec3::from_array(direction_around(u, v)).as_vec3() * body.size();
    let found = body.locate(outside);
    let [u, v] = found.parameters;
    let point = body.faces()[usize::from(found.face)].patch.evaluate(u, v).point;
    (point.as_dvec3(), (outside - point).as_dvec3().normalize_or_zero())
}

/// The middle of the box around points of these patches.
pub fn middle<'a>(patches: impl Iterator<Item = &'a SplinePatch<'a>>) -> Vec3 {
    let grid = || (0..=16).flat_map(|i| (0..=16).map(move |j| (i as f32 / 16.0, j as f32 / 16.0)));
    let (low, high) = patches
        .flat_map(|patch| grid().map(|(u, v)| patch.evaluate(u, v).point))
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)));
    0.5 * (low + high)
}

/// The direction, a unit vector from a body's middle, that a place in `[0, 1]²` stands for: `(½, ½)` is upwards, and
/// the borders lie below the body's sides.
pub fn direction_around(u: f64, v: f64) -> Vector {
    let [a, b] = [u, v].map(|share| 2.0 * AROUND * (share - 0.5));
    let angle = a.hypot(b);
    // sin(x)/x at 0 is 1.
    let sideways = if angle > 1e-9 { angle.sin() / angle } else { 1.0 };
    [a * sideways, b * sideways, angle.cos()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::vector::norm;

    /// A square of 20 cm at the height 0.
    fn square(u: f64, v: f64) -> (Vector, Vector) {
        ([0.2 * u - 0.1, 0.2 * v - 0.1, 0.0], [0.0, 0.0, 1.0])
    }

    #[test]
    fn it_keeps_to_the_part_of_a_surface_that_there_is_room_for_and_says_where_there_is_none() {
        let is_near = |[x, y, _]: Vector| x.abs() < 0.05 && y.abs() < 0.05;
        let path = TouchingPath::within(square, 5.0, 2, is_near).expect("half of it is near");
        assert!(path.keeps_to(is_near));
        // The next larger share of it would not do.
        assert!(!path.keeps_to(|[x, y, _]| x.abs() < 0.04 && y.abs() < 0.04));
        assert_eq!(TouchingPath::within(square, 5.0, 2, |_| false), Err(PathError::NoRoom));
        // All of it is near, but its halves lie apart.
        let torn = |u, v| if u < 0.5 { square(u, v) } else { square(u + 1.0, v) };
        let leaps = TouchingPath::within(torn, 5.0, 2, |_| true);
        assert!(matches!(leaps, Err(PathError::TooFast { speed }) if speed > 100.0), "{leaps:?}");
        let endless = TouchingPath::within(square, 1e9, 2, |_| true);
        assert!(matches!(endless, Err(PathError::Setting { field: "duration", .. })), "{endless:?}");
        let broken = TouchingPath::within(|u, v| ([u, v, f64::NAN], [0.0, 0.0, 1.0]), 5.0, 2, |_| true);
        assert!(matches!(broken, Err(PathError::Surface { .. })), "{broken:?}");
    }

    #[test]
    fn directions_are_units_and_go_from_above_to_below_the_sides() {
        assert_eq!(direction_around(0.5, 0.5), [0.0, 0.0, 1.0]);
        for index in 0..121 {
            let [u, v] = [index / 11, index % 11].map(|at| f64::from(at) / 10.0);
            assert!((norm(direction_around(u, v)) - 1.0).abs() < 1e-12, "rounding");
        }
        assert!(direction_around(0.0, 0.5)[2] < 0.0);
    }
}
