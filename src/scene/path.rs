//! A body that moves as prescribed: it turns about an axis, and sways along a line, continuously.

use super::frame::{Frame, axes};
use crate::math::{Vec3, product, quaternion, sin_cos, vec3};
use crate::track::Placement;
use core::f32::consts::{PI, TAU};

/// A turn is 2³² of a phase's units, so that a phase wraps by itself and no time is too long for it.
const HALF_TURN: f32 = PI / (1_u32 << 31) as f32;

/// The placement of a body at each tick, in closed form. Can be evaluated at any tick; the cost grows with the motions
/// enabled.
///
/// ```
/// use core::f32::consts::TAU;
/// use palpate::math::Vec3;
/// use palpate::scene::{Motion, Path};
/// use palpate::track::Placement;
///
/// // One turn a second about z, at 4 kHz.
/// let path = Path::new(Placement::IDENTITY).turning(Vec3::Z, Vec3::ZERO, TAU, 4_000.0);
/// let quarter = path.at(1_000);
/// assert!((quarter.axes[0] - Vec3::Y).length() < 1e-5);
/// let motion = Motion::Prescribed(path);
/// # let _ = motion;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    start: Placement,
    turn: Option<Turn>,
    sway: Option<Sway>,
}

/// A turn about an axis at a constant rate.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Turn {
    /// Of the phase, a tick.
    step: u32,
    pivot: Vec3,
    /// From the pivot to the origin, in the body.
    offset: Vec3,
    angular_velocity: Vec3,
    /// The orientation is `still · cos φ/2 + turning · sin φ/2`, quaternions both.
    still: [f32; 4],
    turning: [f32; 4],
}

/// To and fro along a line, as a sine of time.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sway {
    step: u32,
    amplitude: Vec3,
    /// Maximum velocity, m/s.
    velocity: Vec3,
}

impl Path {
    /// A body that stays where it is placed, until a motion is added. `start`'s velocities are ignored.
    pub const fn new(start: Placement) -> Self {
        Self {
            start: Placement { velocity: Vec3::ZERO, angular_velocity: Vec3::ZERO, ..start },
            turn: None,
            sway: None,
        }
    }

    /// The same, turning about a unit `axis` through `pivot` (metres) at `rate` (rad/s), `servo_rate` ticks a second.
    /// The rate is rounded to a 2³²th of a turn a tick.
    #[must_use]
    pub const fn turning(mut self, axis: Vec3, pivot: Vec3, rate: f32, servo_rate: f32) -> Self {
        let step = phase_step(rate, servo_rate);
        let Placement { axes: [a, b, c], origin, .. } = self.start;
        let arm = vec3(origin.x - pivot.x, origin.y - pivot.y, origin.z - pivot.z);
        let still = quaternion(&self.start.axes);
        self.turn = Some(Turn {
            step,
            pivot,
            offset: vec3(dot(a, arm), dot(b, arm), dot(c, arm)),
            angular_velocity: scaled(axis, rate_of(step, servo_rate)),
            still,
            turning: product(&[axis.x, axis.y, axis.z, 0.0], &still),
        });
        self
    }

    /// The same, swaying by `amplitude` (metres) to either side at `rate` (rad/s), `servo_rate` ticks a second.
    #[must_use]
    pub const fn swaying(mut self, amplitude: Vec3, rate: f32, servo_rate: f32) -> Self {
        let step = phase_step(rate, servo_rate);
        self.sway = Some(Sway { step, amplitude, velocity: scaled(amplitude, rate_of(step, servo_rate)) });
        self
    }

    /// The placement of the body, with its motion, at a tick.
    pub fn at(&self, ticks: u32) -> Placement {
        let mut frame = self.frame();
        self.go_on(ticks, &mut frame);
        frame.placement()
    }

    /// The frame at the start: it contains everything that a turn does not change.
    pub(super) fn frame(&self) -> Frame {
        let mut frame = Frame::new(&self.start);
        if let Some(Turn { pivot, offset, angular_velocity, .. }) = &self.turn {
            let velocity = pivot.cross(*angular_velocity);
            frame = Frame { pivot: *pivot, offset: *offset, velocity, angular_velocity: *angular_velocity, ..frame };
        }
        frame
    }

    /// The same frame at a later tick.
    #[inline]
    pub(super) fn go_on(&self, ticks: u32, frame: &mut Frame) {
        if let Some(Turn { step, still, turning, .. }) = &self.turn {
            let (sine, cosine) = sin_cos_of_half(ticks.wrapping_mul(*step));
            let at = |index: usize| still[index] * cosine + turning[index] * sine;
            frame.axes = axes(&[at(0), at(1), at(2), at(3)]);
        }
        if let Some(Sway { step, amplitude, velocity }) = &self.sway {
            let (sine, cosine) = sin_cos(angle(ticks, *step));
            let (pivot, angular_velocity) = match &self.turn {
                Some(turn) => (turn.pivot, turn.angular_velocity),
                None => (self.start.origin, Vec3::ZERO),
            };
            frame.pivot = pivot + *amplitude * sine;
            frame.velocity = *velocity * cosine + frame.pivot.cross(angular_velocity);
        }
    }

    /// Where the body is without turn and sway.
    pub const fn start(&self) -> &Placement {
        &self.start
    }

    /// No point of the body within `radius` metres of its origin is ever faster, m/s.
    pub fn max_speed(&self, radius: f32) -> f32 {
        let turning = self.turn.map_or(0.0, |turn| turn.angular_velocity.length() * (turn.offset.length() + radius));
        turning + self.sway.map_or(0.0, |sway| sway.velocity.length())
    }

    pub(super) const fn is_valid(&self) -> bool {
        let mut is_finite = is_rigid(&self.start);
        if let Some(Turn { pivot, offset, angular_velocity, turning: [x, y, z, w], .. }) = &self.turn {
            // An axis that is not a unit vector gives a quaternion that is not one.
            let whole = *x * *x + *y * *y + *z * *z + *w * *w;
            is_finite &= finite(*angular_velocity) && finite(*pivot) && finite(*offset) && near_one(whole);
        }
        if let Some(sway) = &self.sway {
            is_finite &= finite(sway.amplitude) && finite(sway.velocity);
        }
        is_finite
    }
}

/// The angle at a tick, `−π ≤ φ ≤ π`: the product wraps as the angle does.
#[inline]
fn angle(ticks: u32, step: u32) -> f32 {
    ticks.wrapping_mul(step) as i32 as f32 * HALF_TURN
}

/// `(sin φ/2, cos φ/2)` of a phase, up to a sign of both: of an orientation they mean the same. About 30 instructions,
/// for nothing has to be reduced: with `r = φ/2 − π/2`, within a quarter of a turn, they are `cos r` and `−sin r`.
///
/// The polynomials are minimax on `|r| ≤ π/2`, off by 5e-9 and 4e-10 before their coefficients are rounded.
#[inline]
fn sin_cos_of_half(phase: u32) -> (f32, f32) {
    let r = ((phase >> 1) as i32 - (1 << 30)) as f32 * HALF_TURN;
    let r2 = r * r;
    let sine = r + r * r2 * (-0.166_666_57 + r2 * (8.333_017e-3 + r2 * (-1.980_661_5e-4 + r2 * 2.600_055e-6)));
    let quartic = 4.166_665_6e-2 + r2 * (-1.388_857e-3 + r2 * (2.476_930_4e-5 + r2 * -2.619_381_8e-7));
    let cosine = 1.0 - 0.5 * r2 + r2 * r2 * quartic;
    (cosine, -sine)
}

/// Units of the phase a tick; both casts saturate, and half a turn a tick is the most that makes sense.
const fn phase_step(rate: f32, servo_rate: f32) -> u32 {
    (rate / (servo_rate * HALF_TURN)) as i32 as u32
}

const fn rate_of(step: u32, servo_rate: f32) -> f32 {
    step as i32 as f32 * (TAU / 4_294_967_296.0) * servo_rate
}

const fn scaled(vector: Vec3, by: f32) -> Vec3 {
    vec3(vector.x * by, vector.y * by, vector.z * by)
}

pub(super) const fn dot(a: Vec3, b: Vec3) -> f32 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

pub(super) const fn finite(vector: Vec3) -> bool {
    vector.x.is_finite() && vector.y.is_finite() && vector.z.is_finite()
}

const fn near_one(x: f32) -> bool {
    (x - 1.0).abs() < 1e-4
}

/// Whether the axes are orthonormal and right-handed, to four digits, and the rest finite.
pub(super) const fn is_rigid(placement: &Placement) -> bool {
    let [a, b, c] = placement.axes;
    let crossed = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    near_one(dot(a, a))
        && near_one(dot(b, b))
        && dot(a, b).abs() < 1e-4
        && near_one(dot(crossed, c))
        && near_one(dot(c, c))
        && finite(placement.origin)
        && finite(placement.velocity)
        && finite(placement.angular_velocity)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f32 = 4_000.0;

    /// Against the motion's own definition: where it is half a millisecond on is where its velocities lead.
    #[test]
    fn velocities_are_what_the_placements_do() {
        let start = Placement { origin: vec3(0.04, -0.02, 0.01), ..Placement::IDENTITY };
        let axis = vec3(0.48, 0.6, 0.64);
        let path = Path::new(start).turning(axis, vec3(0.01, 0.02, -0.01), -3.0, RATE).swaying(
            vec3(0.0, 0.01, 0.02),
            20.0,
            RATE,
        );
        assert!(path.is_valid());
        for tick in (0..100_000).step_by(997) {
            let [before, now, after] = [0, 2, 4].map(|ahead| path.at(tick + ahead));
            let measured = |a: Vec3, b: Vec3| (b - a) * (RATE / 4.0);
            // Differences of coordinates below 0.1, each rounded by 4e-9, over a millisecond; and the third derivative,
            // 0.03 · 20³ · (0.5 ms)²/6.
            let most = 2e-5 + 1e-5;
            assert!((measured(before.origin, after.origin) - now.velocity).length() < most, "{tick}");
            for axis in 0..3 {
                let expected = now.angular_velocity.cross(now.axes[axis]);
                // Of axes good to some 3e-7, over a millisecond, twice.
                let found = measured(before.axes[axis], after.axes[axis]);
                assert!((found - expected).length() < 6e-4, "{tick} {axis}: {found} {expected}");
            }
            assert!(is_rigid(&now), "{tick}: {now:?}");
            assert!(now.velocity_at(now.origin + Vec3::X * 0.05).length() <= path.max_speed(0.05));
        }
    }

    #[test]
    fn sine_and_cosine_of_a_half_are_good_to_a_rounding() {
        for step in 0..100_000_u32 {
            let phase = step.wrapping_mul(42_949);
            let half = f64::from(phase) / 4_294_967_296.0 * core::f64::consts::PI;
            let (sine, cosine) = sin_cos_of_half(phase);
            // Against the series' own way: the library's sine, itself good to 1.2e-7.
            let (expected_sine, expected_cosine) = sin_cos(half as f32);
            assert!((sine - expected_sine).abs() < 4e-7 && (cosine - expected_cosine).abs() < 4e-7, "{phase}");
            assert!((sine * sine + cosine * cosine - 1.0).abs() < 5e-7);
        }
    }

    #[test]
    fn a_turn_ends_where_it_began_however_long_it_lasts() {
        let path = Path::new(Placement::IDENTITY).turning(Vec3::Z, Vec3::X, TAU, 4_096.0);
        // A turn a second is 2²⁰ units a tick, exactly.
        for seconds in [1, 1_000, 1_000_000] {
            assert_eq!(path.at(4_096_u32.wrapping_mul(seconds)), path.at(0), "{seconds}");
        }
    }

    #[test]
    fn what_is_no_motion_is_refused() {
        let path = Path::new(Placement::IDENTITY);
        assert!(!path.turning(Vec3::Z * 2.0, Vec3::ZERO, 1.0, RATE).is_valid());
        assert!(!path.turning(Vec3::Z, Vec3::X * f32::NAN, 1.0, RATE).is_valid());
        assert!(!path.swaying(Vec3::X * f32::INFINITY, 1.0, RATE).is_valid());
        let mirrored = Placement { axes: [Vec3::X, Vec3::Y, vec3(0.0, 0.0, -1.0)], ..Placement::IDENTITY };
        assert!(!Path::new(mirrored).is_valid());
        // A rate that is no number is none.
        let resting = path.turning(Vec3::Z, Vec3::ZERO, f32::NAN, RATE);
        assert_eq!(resting.at(77), resting.at(0));
    }
}
