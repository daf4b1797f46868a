//! Position and velocity between counts: an observer that a count leaves alone as long as it explains it.

/// The tracking observer with play: `x̂' = v̂ + 2ω e`, `v̂' = ω² e`, where `e` is how far the estimate lies outside of
/// the count that was read, and 0 within it.
///
/// A count says between which two lines the joint is, nothing more. So nothing is corrected while the estimate is
/// there: a joint that rests does not flicker, and one that moves steadily is followed along the edge of its count
/// without a ripple. The play costs trust: the estimate and the joint may lie at opposite edges of a count, so that the
/// position may be wrong by a whole one, where a count's middle is wrong by half. Both that and the delay count in the
/// bounds of a wall ([`crate::render::bounds::DeviceFriction::between_counts`],
/// [`crate::render::bounds::between_counts_delay`]). At a steady speed the position has no delay; the velocity lags by
/// `2/ω`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BetweenCounts {
    period: f32,
    /// `2 ω h`.
    position_gain: f32,
    /// `ω² h`.
    velocity_gain: f32,
    /// Half a count.
    play: f32,
}

impl BetweenCounts {
    /// An observer of corner frequency `corner` for positions of `count` a step, in the unit of position, sampled at
    /// `rate`; both Hz. `ω h` is held to 0.5, as the tracking observer's.
    pub const fn new(corner: f32, rate: f32, count: f32) -> Self {
        let omega_period = core::f32::consts::TAU * corner / rate;
        let omega_period = if omega_period < 0.5 { omega_period } else { 0.5 };
        Self {
            period: 1.0 / rate,
            position_gain: 2.0 * omega_period,
            velocity_gain: omega_period * omega_period * rate,
            play: 0.5 * count.abs(),
        }
    }

    /// The next lag (of the estimate behind the middle of the count that was read) and velocity, from the last ones and
    /// how far that middle moved in this period: finite, as the difference of two readings is.
    #[inline]
    pub fn next(&self, lag: f32, velocity: f32, moved: f32) -> (f32, f32) {
        let away = lag + moved - velocity * self.period;
        let error = if away > self.play {
            away - self.play
        } else if away < -self.play {
            away + self.play
        } else {
            return (away, velocity);
        };
        (away - self.position_gain * error, velocity + self.velocity_gain * error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f32 = 4_000.0;
    const COUNT: f32 = 57.6e-6;

    /// Follows a position, m by tick, through counts: the position believed, and the velocity.
    fn follow(corner: f32, position: impl Fn(u32) -> f32, mut look: impl FnMut(u32, f32, f32)) {
        let observer = BetweenCounts::new(corner, RATE, COUNT);
        // The middle of the count that is read; no position here is negative, so that a cast rounds down.
        let read = |tick: u32| ((position(tick) / COUNT) as i32 as f32 + 0.5) * COUNT;
        let (mut lag, mut velocity, mut last) = (0.0, 0.0, read(0));
        for tick in 1..8_000 {
            let now = read(tick);
            (lag, velocity) = observer.next(lag, velocity, now - last);
            last = now;
            look(tick, now - lag, velocity);
        }
    }

    #[test]
    fn a_steady_motion_is_followed_without_a_ripple() {
        for speed in [0.01_f32, 0.03, 0.1, 0.3] {
            let (mut least, mut most) = (f32::MAX, f32::MIN);
            follow(
                200.0,
                |tick| tick as f32 * speed / RATE,
                |tick, _, velocity| {
                    if tick >= 6_000 {
                        least = if velocity < least { velocity } else { least };
                        most = if velocity > most { velocity } else { most };
                    }
                },
            );
            // A count in a period is 230 mm/s to a difference. Here what is left is a twentieth of the speed.
            assert!(least > 0.95 * speed && most < 1.05 * speed, "{speed}: {least} to {most}");
        }
    }

    #[test]
    fn at_rest_nothing_flickers_on_the_line_between_two_counts() {
        // A motion of a tenth of a count over a line: every other tick another count.
        let line = 100.0 * COUNT;
        let place = |tick: u32| line + if tick.is_multiple_of(2) { 0.05 * COUNT } else { -0.05 * COUNT };
        let (mut least, mut most) = (f32::MAX, f32::MIN);
        follow(200.0, place, |tick, believed, velocity| {
            if tick > 2_000 {
                least = if believed < least { believed } else { least };
                most = if believed > most { believed } else { most };
                // Rounding of 6 mm.
                assert!(velocity.abs() < 1e-5, "{tick}: {velocity}");
            }
        });
        assert!(most - least < 2e-9, "{}", most - least);
    }

    #[test]
    fn it_is_never_off_by_more_than_a_count_in_a_hand_s_motion() {
        // 20 mm at 1.6 Hz: 0.2 m/s and 2 m/s².
        let place = |tick: u32| 0.03 + 0.02 * crate::math::sin_cos(tick as f32 * 10.0 / RATE).0;
        follow(200.0, place, |tick, believed, _| {
            // Beside the count, what an acceleration of 2 m/s² leaves behind: a/ω², 1.3 µm; rounding of 30 mm.
            let off = (believed - place(tick)).abs();
            assert!(tick < 200 || off < COUNT + 2.0e-6, "{tick}: {off:e}");
        });
    }
}
