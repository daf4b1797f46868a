//! The paper's limits of performance: which gains are stable, which are proved to lower the distance, how far the
//! witness point lags, how deep the probe may go.

use super::laws::Integrator;
use crate::math::ROOT_EXCESS;
use crate::patch::{Curvature, ShapeBounds};

/// Limits of the controller on a patch, or at a point of it, at a servo rate and a distance.
///
/// Near the closest point `P*` of a probe at the signed gap `d` (positive outside, negative inside), half the squared
/// distance has the curvature `μ = 1 + κ d` along the principal direction of curvature `κ` (per squared metre moved on
/// the surface), and a tick of explicit Euler multiplies that part of the error by `1 − K h μ`. All limits follow from
/// the minimum and maximum `μ`; each states its claim and hypotheses. A missing bound gives no
/// promise: an infinite curvature gives a stable gain of 0, an infinite lag, a depth of 0.
///
/// `const`, so that a firmware can check its gain at compile time:
///
/// ```
/// use palpate::patch::Curvature;
/// use palpate::track::{Integrator, PerformanceLimits};
///
/// // A ball of 50 mm radius at 1 kHz, with the probe 50 mm in front of it.
/// const BALL: Curvature = Curvature { min: 20.0, max: 20.0 };
/// const LIMITS: PerformanceLimits = PerformanceLimits::at_point(BALL, Integrator::Euler, 1_000.0, 0.05);
/// const GAIN: f32 = 500.0;
/// const _: () = assert!(GAIN < LIMITS.stable_gain());
/// assert_eq!(LIMITS.stable_gain(), 1_000.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PerformanceLimits {
    curvature: Curvature,
    /// 1/m; see [`ShapeBounds::max_bend`].
    bend: f32,
    /// `z`.
    stability: f32,
    /// `1/h`, Hz.
    rate: f32,
    /// `d`, m.
    gap: f32,
}

impl PerformanceLimits {
    /// Over a whole patch, at a servo `rate` in Hz and a signed `gap` in metres (the distance `‖ΔR‖` outside, minus the
    /// depth inside).
    ///
    /// # Panics
    /// Where the rate is not positive and finite or the gap is not finite: at compile time in a `const`. Not for the
    /// tick.
    pub const fn new(shape: &ShapeBounds, integrator: Integrator, rate: f32, gap: f32) -> Self {
        Self::with(shape.curvature, shape.max_bend, integrator, rate, gap)
    }

    /// At a point with its own principal curvatures. The bend is not a matter of one point, so there is no monotone
    /// gain.
    ///
    /// # Panics
    /// As [`Self::new`].
    pub const fn at_point(curvature: Curvature, integrator: Integrator, rate: f32, gap: f32) -> Self {
        Self::with(curvature, f32::INFINITY, integrator, rate, gap)
    }

    const fn with(curvature: Curvature, bend: f32, integrator: Integrator, rate: f32, gap: f32) -> Self {
        assert!(rate > 0.0 && rate < f32::INFINITY, "rate");
        assert!(gap.is_finite(), "gap");
        Self { curvature, bend, stability: integrator.stability_bound(), rate, gap }
    }

    /// Maximum `μ`, a pure number: the fastest part of the error decays `μ` times as fast as the gain.
    pub const fn max_contraction(&self) -> f32 {
        let curvature = if self.gap >= 0.0 { self.curvature.max } else { self.curvature.min };
        contraction(curvature, self.gap)
    }

    /// Minimum `μ`. At 0 and below, the closest point is lost: the probe is beyond a centre of curvature.
    pub const fn min_contraction(&self) -> f32 {
        let curvature = if self.gap >= 0.0 { self.curvature.min } else { self.curvature.max };
        contraction(curvature, self.gap)
    }

    /// With a point's own curvature this is where the linearised error stops decaying: necessary and sufficient for
    /// small errors, while `P*` is inside a span. With a patch's bounds it is not above that of any point. It does not
    /// cover large errors: see [`Self::monotone_gain`]. 0 if the closest point is lost, or without bounds.
    pub const fn stable_gain(&self) -> f32 {
        if self.min_contraction() > 0.0 { self.stability * self.rate / self.max_contraction() } else { 0.0 }
    }

    /// A gain `K`, 1/s, at which each tick of explicit Euler is proved to lower the distance to a probe that rests,
    /// from projection errors up to `residual` metres long: `1 / (h ((1 + c r)² + c ‖ΔR‖ + (k − 1) c (2 r + ‖ΔR‖)))`
    /// with `c` the maximum bend and `k` [`crate::math::ROOT_EXCESS`], for the roots that are taken from above.
    ///
    /// It is not above what [`certified_gain`](crate::track::certified_gain) can be there, whatever the direction and the place, and near what
    /// it tends to as the witness point arrives, but for the bend being that of one place and direction then. Proved
    /// for any patch that is C¹ along the step, convex or not, from either side. 0 where nothing is known.
    pub const fn monotone_gain(&self, residual: f32) -> f32 {
        let distance = if self.gap >= 0.0 { self.gap } else { -self.gap };
        let reach = 1.0 + self.bend * residual;
        let excess = (ROOT_EXCESS - 1.0) * (2.0 * residual + distance);
        let gain = self.rate / (reach * reach + self.bend * (distance + excess));
        // NaN, from an infinite bend times 0.
        if gain > 0.0 { gain } else { 0.0 }
    }

    /// The lag `‖P − P*‖`, metres, to expect behind a probe of this `speed`, m/s, along the surface, at the gain
    /// `gain`, 1/s, after a tick that has seen where the probe is now: `(1 − c)/c · speed · h/μ` with `c = K h μ`,
    /// which is `speed / (K μ²)` for low gains.
    ///
    /// First order: of the linearised error with explicit Euler, in the steady state, for the direction in which it is
    /// largest. `1/μ` is there twice, as the closest point itself moves at `speed/μ`. Not a bound: see
    /// [`Self::lag_bound`]. Infinite where the gain is not stable.
    pub const fn lag(&self, gain: f32, speed: f32) -> f32 {
        if !(gain > 0.0 && gain < self.stable_gain()) {
            return f32::INFINITY;
        }
        let ends = [self.min_contraction(), self.max_contraction()];
        let mut worst = 0.0;
        let mut index = 0;
        // Largest at an end of the range: |1 − c| / (1 − |1 − c|) / μ falls while c < 1 and rises from there.
        while index < ends.len() {
            let factor = 1.0 - gain * ends[index] / self.rate;
            let size = if factor < 0.0 { -factor } else { factor };
            let lag = size / (1.0 - size) * speed / (self.rate * ends[index]);
            if lag > worst {
                worst = lag;
            }
            index += 1;
        }
        worst
    }

    /// A bound of the lag `‖P − P*‖`, metres, that holds at every tick once it holds at one, for a probe of at most
    /// this `speed`, m/s, in whatever direction, at the gain `gain`, 1/s, or the certified one where that is less;
    /// without feed-forward.
    ///
    /// Let `W = ½ (‖ΔR‖² − E²)`. Where `½ ‖ΔR‖²` is `μ`-convex along the shortest way on the surface from `P` to `P*`,
    /// `W ≥ ½ μ ‖P − P*‖²` and the squared projection error `s ≥ 2 μ W`; as `∂W/∂Q = P* − P`, a probe that moves by `δ`
    /// raises `√W` by at most `δ/√(2 μ)`. A step of gain `a = K h ≤ ā`, the certified one, lowers `W` by `a s (1 −
    /// a/2ā)` or more. So a tick takes `√W` to at most `q (√W + δ/√(2 μ))` with `q² = 1 − a μ (2 − a/ā)`:
    /// input-to-state stability, with `‖P − P*‖ ≤ q/(1 − q) · speed · h/μ` at rest. For low gains that is the
    /// first-order lag but for one `μ`.
    ///
    /// Hypotheses: explicit Euler; `P` and `P*` joined by a shortest way inside the patch, from whose tangent planes
    /// the probe has gaps between 0 and the one given here (in front of a convex patch, not farther away); no step cut
    /// at the border. Infinite where nothing is known, and where the certified gain, less for long projection errors,
    /// does not keep up.
    pub const fn lag_bound(&self, gain: f32, speed: f32) -> f32 {
        // On the way the gap is between 0 and the given one, and μ is 1 at 0.
        let least = self.min_contraction();
        let convexity = if least < 1.0 { least } else { 1.0 };
        if !(convexity > 0.0 && gain > 0.0) {
            return f32::INFINITY;
        }
        let moved = speed / (self.rate * convexity);
        let greatest = self.max_contraction();
        let slope = if greatest > 1.0 { greatest } else { 1.0 };
        // The certified gain depends on the residual, and that on the lag: from below, until it holds with a little to
        // spare.
        let mut bound = 0.0;
        let mut rounds = 0;
        while rounds < 32 {
            let certified = self.monotone_gain(slope * (bound + moved));
            let used = if gain < certified { gain } else { certified };
            if used <= 0.0 {
                return f32::INFINITY;
            }
            let fall = used / self.rate * convexity * (2.0 - used / certified);
            let kept = root_from_above(1.0 - fall);
            // q/(1 − q), without the difference.
            let next = kept * (1.0 + kept) / fall * moved;
            if next <= bound {
                return bound;
            }
            bound = next * 1.001;
            rounds += 1;
        }
        f32::INFINITY
    }

    /// Maximum depth of a probe, metres, before the closest point is lost: `1/κ_max`, the focal depth. Infinite if
    /// nothing bends outward.
    ///
    /// Up to there `P*` stays a local minimum of the distance, from which small errors decay. Another part of the
    /// surface may be nearer before.
    pub const fn depth_limit(&self) -> f32 {
        if self.curvature.max > 0.0 { 1.0 / self.curvature.max } else { f32::INFINITY }
    }

    /// Maximum distance of a probe outside, metres, for the same reason: `−1/κ_min`, infinite on a convex patch.
    pub const fn clearance_limit(&self) -> f32 {
        if self.curvature.min < 0.0 { -1.0 / self.curvature.min } else { f32::INFINITY }
    }
}

/// Not below the square root of `x ≤ 1`: Newton's iteration stays above. From 1, near it for all but the smallest `x`.
const fn root_from_above(x: f32) -> f32 {
    let x = if x > 0.0 { x } else { 0.0 };
    let (mut root, mut rounds) = (1.0, 0);
    while rounds < 6 {
        root = 0.5 * (root + x / root);
        rounds += 1;
    }
    root
}

/// `1 + κ d`; 1 on the surface, whatever the curvature.
const fn contraction(curvature: f32, gap: f32) -> f32 {
    if gap == 0.0 { 1.0 } else { 1.0 + curvature * gap }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::SecondDerivativeBounds;

    const BALL: Curvature = Curvature { min: 20.0, max: 20.0 };
    /// A firmware can check its gain like this.
    const LIMITS: PerformanceLimits = PerformanceLimits::at_point(BALL, Integrator::Euler, 1_000.0, 0.05);

    #[test]
    fn a_ball_outside_and_inside() {
        // κ d = 1: the modes decay twice as fast, half the gain is left.
        assert_eq!(LIMITS.stable_gain(), 1_000.0);
        assert_eq!(LIMITS.max_contraction(), 2.0);
        let inside = PerformanceLimits::at_point(BALL, Integrator::RungeKutta4, 1_000.0, -0.025);
        // One rounding of the division.
        assert!((inside.stable_gain() - 2.0 * 2_785.293_6).abs() < 1e-3);
        assert_eq!((inside.depth_limit(), inside.min_contraction()), (0.05, 0.5));
        assert_eq!(PerformanceLimits::at_point(BALL, Integrator::Euler, 1_000.0, -0.05).stable_gain(), 0.0);
        // K h μ = 0.5: one tick's way of the closest point, 0.5 mm, is left behind.
        assert!((LIMITS.lag(250.0, 1.0) - 5e-4).abs() < 1e-9);
        assert_eq!(LIMITS.lag(1_000.0, 1.0), f32::INFINITY);
    }

    #[test]
    fn a_saddle_loses_its_closest_point_on_both_sides() {
        let saddle = Curvature { min: -10.0, max: 20.0 };
        let at = |gap| PerformanceLimits::at_point(saddle, Integrator::Euler, 4_000.0, gap);
        assert_eq!((at(0.0).depth_limit(), at(0.0).clearance_limit()), (0.05, 0.1));
        assert!(at(0.099).stable_gain() > 0.0 && at(0.101).stable_gain() == 0.0);
        assert!(at(-0.049).stable_gain() > 0.0 && at(-0.051).stable_gain() == 0.0);
    }

    #[test]
    fn what_is_not_known_is_not_promised() {
        let unknown = ShapeBounds::unknown(SecondDerivativeBounds { uu: 1.0, uv: 1.0, vv: 1.0 });
        for gap in [-0.01, 0.01] {
            let limits = PerformanceLimits::new(&unknown, Integrator::Euler, 4_000.0, gap);
            assert_eq!((limits.stable_gain(), limits.monotone_gain(0.0), limits.depth_limit()), (0.0, 0.0, 0.0));
            assert_eq!((limits.lag(100.0, 0.1), limits.lag_bound(100.0, 0.1)), (f32::INFINITY, f32::INFINITY));
        }
    }

    #[test]
    fn the_bound_is_above_the_first_order_lag_and_near_it_for_low_gains() {
        let shape = ShapeBounds {
            curvature: BALL,
            max_bend: 25.0,
            ..ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.2, uv: 0.1, vv: 0.2 })
        };
        // In front, and inside where the modes decay half as fast.
        for gap in [1e-4, -0.025] {
            let limits = PerformanceLimits::new(&shape, Integrator::Euler, 4_000.0, gap);
            for (share, most) in [(0.01, 1.02), (0.1, 1.1), (0.5, 1.5)] {
                let gain = share * limits.monotone_gain(0.0);
                let ratio = limits.lag_bound(gain, 0.01) / limits.lag(gain, 0.01);
                assert!((1.0..most).contains(&ratio), "{gap}, {share}: {ratio}");
            }
        }
    }
}
