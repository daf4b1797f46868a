//! A hand that touches a surface: comes down, presses, slides about, lifts off, and again; from a seed.

use super::hand::HandPath;
use super::touching::{HEIGHT, Motion, TouchingSettings};
use super::vector::{Vector, add_scaled, difference, norm, scaled};
use super::within::PRESS_DEPTH;

/// Knots per second. Motions of a hand lie below 10 Hz, so the cubic between knots adds nothing.
const KNOT_RATE: f64 = 1_000.0;

/// Why there is no such path.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PathError {
    /// A number that makes no sense.
    #[error("{field} makes no sense: {value}")]
    Setting {
        /// The number's name.
        field: &'static str,
        /// The given value.
        value: f64,
    },
    /// The surface gave a point or normal that is not finite.
    #[error("the surface is not finite at ({u}, {v})")]
    Surface {
        /// Where.
        u: f64,
        /// Where.
        v: f64,
    },
    /// Coming down and lifting off alone are faster than allowed, or the surface leaps from place to place.
    #[error("the hand would move at {speed:.1} m/s: too many touches for this time, or a surface that leaps under it")]
    TooFast {
        /// The speed, m/s.
        speed: f64,
    },
    /// The hand would leave the workspace, however little of the surface it feels.
    #[error("the workspace does not hold the hand even over the surface's middle third, from {} mm above to {} mm below", 1e3 * HEIGHT, 1e3 * PRESS_DEPTH[1])]
    NoRoom,
}

/// The touching hand, as a cubic through knots a millisecond apart: position and velocity are continuous.
#[derive(Clone, Debug, PartialEq)]
pub struct TouchingPath {
    knots: Vec<Vector>,
}

impl TouchingPath {
    /// A path over `surface`, which gives point (m, in the device frame) and outward unit normal at `(u, v)` in [0,
    /// 1]². The same seed gives the same path.
    ///
    /// # Errors
    /// Settings that make no sense, or a surface that is not finite.
    pub fn new(
        surface: impl Fn(f64, f64) -> (Vector, Vector),
        settings: TouchingSettings,
        seed: u64,
    ) -> Result<Self, PathError> {
        validate(&settings)?;
        let motion = Motion::draw(settings, seed);
        let mut pace = 1.0;
        // The speed is that of the touch plus what sliding adds, and sliding is proportional to the pace.
        loop {
            let path = Self { knots: sample(&surface, &motion, pace)? };
            let speed = path.peak_speed();
            if speed <= settings.greatest_speed {
                return Ok(path);
            }
            pace *= (settings.greatest_speed / speed).min(0.95);
            if pace < 0.01 {
                return Err(PathError::TooFast { speed });
            }
        }
    }

    /// The maximum speed from knot to knot, m/s.
    pub fn peak_speed(&self) -> f64 {
        self.knots.windows(2).map(|pair| norm(difference(pair[1], pair[0])) * KNOT_RATE).fold(0.0, f64::max)
    }

    /// Whether the hand keeps to places like this all the way.
    pub fn keeps_to(&self, like_this: impl Fn(Vector) -> bool) -> bool {
        self.knots.iter().all(|knot| like_this(*knot))
    }

    /// How long it lasts, s.
    pub fn duration(&self) -> f64 {
        (self.knots.len() - 1) as f64 / KNOT_RATE
    }

    /// The four knots around a time and the share between the middle two; at the ends the last knot is repeated.
    fn around(&self, time: f64) -> ([Vector; 4], f64) {
        let last = self.knots.len() - 1;
        let position = (time * KNOT_RATE).clamp(0.0, last as f64);
        let index = (position as usize).min(last - 1);
        let knot = |index: usize| self.knots[index.min(last)];
        ([knot(index.saturating_sub(1)), knot(index), knot(index + 1), knot(index + 2)], position - index as f64)
    }
}

impl HandPath for TouchingPath {
    fn target(&self, time: f64) -> Vector {
        let ([before, from, to, after], s) = self.around(time);
        let (speed_from, speed_to) = (scaled(difference(to, before), 0.5), scaled(difference(after, from), 0.5));
        // Hermite's cubic.
        let bend = s * s * (3.0 - 2.0 * s);
        let sum = add_scaled(from, difference(to, from), bend);
        let sum = add_scaled(sum, speed_from, s * (1.0 - s) * (1.0 - s));
        add_scaled(sum, speed_to, s * s * (s - 1.0))
    }

    fn velocity(&self, time: f64) -> Vector {
        if time > self.duration() {
            return [0.0; 3];
        }
        let ([before, from, to, after], s) = self.around(time);
        let (speed_from, speed_to) = (scaled(difference(to, before), 0.5), scaled(difference(after, from), 0.5));
        let sum = scaled(difference(to, from), 6.0 * s * (1.0 - s));
        let sum = add_scaled(sum, speed_from, (1.0 - s) * (1.0 - 3.0 * s));
        scaled(add_scaled(sum, speed_to, s * (3.0 * s - 2.0)), KNOT_RATE)
    }
}

fn sample(
    surface: impl Fn(f64, f64) -> (Vector, Vector),
    motion: &Motion,
    pace: f64,
) -> Result<Vec<Vector>, PathError> {
    let count = (motion.duration() * KNOT_RATE).ceil() as usize;
    (0..=count)
        .map(|index| {
            let time = index as f64 / KNOT_RATE;
            let [u, v] = [0, 1].map(|axis| motion.parameter(axis, time, pace));
            let (point, normal) = surface(u, v);
            let place = add_scaled(point, normal, motion.height(time));
            if place.iter().all(|entry| entry.is_finite()) { Ok(place) } else { Err(PathError::Surface { u, v }) }
        })
        .collect()
}

fn validate(settings: &TouchingSettings) -> Result<(), PathError> {
    let [least, most] = settings.press_depth;
    let checks = [
        // An hour of knots is 86 MB.
        ("duration", settings.duration, settings.duration > 0.0 && settings.duration <= 3_600.0),
        ("touches", f64::from(settings.touches), settings.touches > 0),
        ("start_height", settings.start_height, settings.start_height >= 0.0 && settings.start_height.is_finite()),
        ("pressed_reach", settings.pressed_reach, (0.0..=1.0).contains(&settings.pressed_reach)),
        ("press_depth", least, least.is_finite() && least <= most),
        ("press_depth", most, most.is_finite()),
        ("greatest_speed", settings.greatest_speed, settings.greatest_speed > 0.0),
    ];
    match checks.into_iter().find(|(_, _, good)| !good) {
        Some((field, value, _)) => Err(PathError::Setting { field, value }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::vector::dot;

    const RADIUS: f64 = 0.06;

    /// Part of a sphere about (0, 0, −50 mm).
    fn dome(u: f64, v: f64) -> (Vector, Vector) {
        let (across, along) = (2.0 * u - 1.0, 2.0 * v - 1.0);
        let normal = scaled([across, along, 1.2], 1.0 / norm([across, along, 1.2]));
        (add_scaled([0.0, 0.0, -0.05], normal, RADIUS), normal)
    }

    fn height(place: Vector) -> f64 {
        norm(difference(place, [0.0, 0.0, -0.05])) - RADIUS
    }

    fn path(seed: u64) -> TouchingPath {
        TouchingPath::new(dome, TouchingSettings::default(), seed).unwrap()
    }

    #[test]
    fn it_starts_above_touches_again_and_again_and_keeps_its_speed() {
        for seed in 0..50 {
            let path = path(seed);
            assert!((height(path.knots[0]) - 0.010).abs() < 1e-12);
            let heights: Vec<f64> = path.knots.iter().map(|knot| height(*knot)).collect();
            let landings = heights.windows(2).filter(|pair| pair[0] > 0.0 && pair[1] <= 0.0).count();
            assert_eq!(landings, 6, "seed {seed}");
            let deepest = heights.iter().copied().fold(0.0, f64::min);
            assert!((-0.008..-0.003).contains(&deepest), "seed {seed}: {deepest}");
            assert!(path.peak_speed() <= 0.5 && path.peak_speed() > 0.1, "seed {seed}: {}", path.peak_speed());
        }
    }

    #[test]
    fn it_visits_the_interior_and_all_four_borders() {
        // Sides of the dome reached while pressing: (u, v) back from the direction.
        let (mut borders, mut interior) = ([0; 4], 0);
        for seed in 0..10 {
            for knot in path(seed).knots.iter().filter(|knot| height(**knot) < 0.0) {
                let [x, y, z] = difference(*knot, [0.0, 0.0, -0.05]);
                let (u, v) = (0.5 + 0.6 * x / z, 0.5 + 0.6 * y / z);
                for (count, near) in borders.iter_mut().zip([u < 0.05, u > 0.95, v < 0.05, v > 0.95]) {
                    *count += usize::from(near);
                }
                interior += usize::from((0.2..0.8).contains(&u) && (0.2..0.8).contains(&v));
            }
        }
        // Of some 29,000 knots below the surface, each border has at least 5 % and the interior too.
        assert!(borders.iter().chain([&interior]).all(|count| *count > 1_450), "{borders:?} {interior}");
    }

    #[test]
    fn velocity_is_the_slope_of_the_target() {
        let path = path(3);
        for index in 10..4_900 {
            let time = (f64::from(index) + 0.37) * 1e-3;
            let step = 1e-7;
            let slope = scaled(difference(path.target(time + step), path.target(time - step)), 0.5 / step);
            // Rounding of 0.1 m over the step.
            assert!(norm(difference(slope, path.velocity(time))) < 1e-8, "{time}");
        }
        assert_eq!(path.velocity(6.0), [0.0; 3]);
        assert_eq!(path.target(6.0), *path.knots.last().unwrap());
    }

    #[test]
    fn position_and_velocity_are_continuous() {
        let path = path(4);
        for index in 1..5_000 {
            let (before, after) = (f64::from(index) * 1e-3 - 1e-9, f64::from(index) * 1e-3 + 1e-9);
            // 2 ns at 0.5 m/s, and at 100 m/s², with rounding.
            assert!(norm(difference(path.target(after), path.target(before))) < 1.1e-9);
            let jump = difference(path.velocity(after), path.velocity(before));
            assert!(dot(jump, jump).sqrt() < 1e-6, "{index}");
        }
    }

    #[test]
    fn the_seed_decides() {
        assert_eq!(path(7), path(7));
        assert_ne!(path(7), path(8));
    }

    #[test]
    fn nonsense_is_refused() {
        let settings = TouchingSettings::default();
        let refused = |settings| TouchingPath::new(dome, settings, 1).unwrap_err();
        assert!(matches!(
            refused(TouchingSettings { touches: 0, ..settings }),
            PathError::Setting { field: "touches", .. }
        ));
        assert!(matches!(
            refused(TouchingSettings { duration: f64::NAN, ..settings }),
            PathError::Setting { field: "duration", .. }
        ));
        assert!(matches!(refused(TouchingSettings { touches: 5_000, ..settings }), PathError::TooFast { .. }));
        let hole = |_, _| ([f64::NAN; 3], [0.0, 0.0, 1.0]);
        assert!(matches!(TouchingPath::new(hole, settings, 1), Err(PathError::Surface { .. })));
    }
}
