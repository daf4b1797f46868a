//! How stiff a sampled wall may be and still be passive: closed forms for a device, a rate and a delay.
//!
//! They are sufficient, not necessary: a device in a hand is often stable far beyond (N. Diolaiti, G. Niemeyer, F.
//! Barbagli, J. K. Salisbury, *Stability of haptic rendering: discretization, quantization, time delay, and Coulomb
//! effects*, IEEE Trans. Robotics 22(2), 2006, who meet the same two conditions). `cargo palpate zwidth` finds the
//! simulated limit and draws these in.

/// A device's contribution to the stability of a wall, at the probe and along the wall's normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviceFriction {
    /// Viscous friction `b`, N·s/m.
    pub viscous_n_s_per_m: f32,
    /// Coulomb friction `f_c`, N.
    pub coulomb_n: f32,
    /// One encoder count `Δ`, metres at the probe.
    pub resolution_m: f32,
}

/// The minimum device damping for a wall, N·s/m: `b > K (T/2 + t_d) + |B|`.
///
/// J. E. Colgate and G. Schenkel, *Passivity of a class of sampled-data systems*, 1994, for `t_d = 0`. Their criterion
/// for a spring delayed by `d` whole periods is `b > K T/2 · (cos dθ − cos (d+1)θ)/(1 − cos θ)` for all `θ`, which has
/// its maximum at `θ → 0`: `2d + 1`, hence the delay's term. A damper, behind any delay and any low-pass, requires at
/// most `|B|`.
///
/// `stiffness` N/m, `damping` N·s/m, `period` and `delay` s.
pub const fn required_damping(stiffness: f32, damping: f32, period: f32, delay: f32) -> f32 {
    stiffness * (0.5 * period + delay) + damping.abs()
}

/// The maximum passive stiffness, N/m: [`required_damping`] solved for `K`; 0 if the wall's damping is above the
/// device's.
pub const fn passive_stiffness(device_damping: f32, damping: f32, period: f32, delay: f32) -> f32 {
    let left = device_damping - damping.abs();
    if left > 0.0 { left / (0.5 * period + delay) } else { 0.0 }
}

/// `K ≤ min(2 b/T, 2 f_c/Δ)`, N/m: with quantised position the dry friction must absorb the energy that a count's
/// rounding generates.
///
/// J. J. Abbott and A. M. Okamura, *Effects of position quantization and sampling rate on virtual-wall passivity*, IEEE
/// Trans. Robotics 21(5), 2005; for a wall without damping and without delay.
pub const fn quantised_stiffness(device: DeviceFriction, period: f32) -> f32 {
    lesser(2.0 * device.viscous_n_s_per_m / period, 2.0 * device.coulomb_n / device.resolution_m)
}

impl DeviceFriction {
    /// The same with the position between counts ([`crate::device::VelocityMethod::BetweenCounts`]), whose error,
    /// beyond the lag of [`between_counts_delay`], is that of a count `2 (1 + 2 e⁻²)` times as coarse.
    ///
    /// The observer sees what lies beyond its play, and so follows the true position and half a count of rounding and
    /// half of play: an error of a whole count at most, where a count's middle has one of half. It passes that on by no
    /// more than the integral of its impulse response's size, `∫ |ω (2 − ωt) e^{−ωt}| dt = 1 + 2 e⁻²`.
    pub const fn between_counts(self) -> Self {
        Self { resolution_m: BETWEEN_COUNTS * self.resolution_m, ..self }
    }

    /// The maximum stiffness, N/m, that meets both conditions, with the wall's damping (N·s/m) and a delay (s).
    pub const fn passive_stiffness(self, damping: f32, period: f32, delay: f32) -> f32 {
        let sampled = passive_stiffness(self.viscous_n_s_per_m, damping, period, delay);
        lesser(sampled, 2.0 * self.coulomb_n / self.resolution_m)
    }
}

/// `2 (1 + 2 e⁻²)`.
const BETWEEN_COUNTS: f32 = 2.541_341;

/// The effective delay, s, of a spring on the position between counts, for a velocity corner (Hz) as
/// [`crate::device::VelocityEstimator::new`] takes it: `1/(2ω)`.
///
/// The observer, `ω = 2π · 2 corner`, gives the position `P = 1 − s²/(s + ω)²`. A spring behind it requires a damping
/// of `−K Im P(jw)/w = K/ω · 2x²/(1 + x²)²` with `x = w/ω`, which has its maximum at `x = 1`.
pub const fn between_counts_delay(corner: f32) -> f32 {
    0.5 / (2.0 * core::f32::consts::TAU * corner)
}

const fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sin_cos;

    #[test]
    fn a_kilonewton_a_metre_asks_for_what_is_published() {
        // 0.5 N·s/m at 1 kHz, 0.063 at 8 kHz.
        const AT_1_KHZ: f32 = required_damping(1_000.0, 0.0, 1e-3, 0.0);
        assert!((AT_1_KHZ - 0.5).abs() < 1e-6);
        assert!((required_damping(1_000.0, 0.0, 1.25e-4, 0.0) - 0.062_5).abs() < 1e-6);
        assert!((passive_stiffness(0.5, 0.0, 1e-3, 0.0) - 1_000.0).abs() < 1e-2);
        assert_eq!(passive_stiffness(0.5, 0.6, 1e-3, 0.0), 0.0);
    }

    #[test]
    fn quantisation_takes_over_where_friction_is_low() {
        let device = DeviceFriction { viscous_n_s_per_m: 0.5, coulomb_n: 0.02, resolution_m: 50e-6 };
        // A rounding or two of each.
        let near = |a: f32, b: f32| (a / b - 1.0).abs() < 4.0 * f32::EPSILON;
        assert!(near(quantised_stiffness(device, 1e-3), 800.0));
        assert!(near(quantised_stiffness(DeviceFriction { coulomb_n: 1.0, ..device }, 1e-3), 1_000.0));
        assert!(near(device.passive_stiffness(0.0, 1e-3, 0.0), 800.0));
    }

    /// The observer's position for a true one, sampled: `P(z) = (α + (β − α) z⁻¹)/(1 − (2 − α − β) z⁻¹ + (1 − α) z⁻²)`
    /// with `α = 2ωh` and `β = (ωh)²`, as numerator and denominator in powers of `z⁻¹`.
    fn observer(omega_period: f32) -> ([f32; 3], [f32; 3]) {
        let (alpha, beta) = (2.0 * omega_period, omega_period * omega_period);
        ([alpha, beta - alpha, 0.0], [1.0, alpha + beta - 2.0, 1.0 - alpha])
    }

    #[test]
    fn the_observer_asks_for_no_more_than_its_delay() {
        const RATE: f32 = 4_000.0;
        for corner in [20.0_f32, 50.0, 100.0, 159.0] {
            let (above, below) = observer(core::f32::consts::TAU * 2.0 * corner / RATE);
            let at = |powers: [f32; 3], theta: f32| {
                let term = |n: usize| sin_cos(theta * n as f32);
                let sum = |part: fn((f32, f32)) -> f32| (0..3).map(|n| powers[n] * part(term(n))).sum::<f32>();
                (sum(|(_, cosine)| cosine), -sum(|(sine, _)| sine))
            };
            // As in `criterion`, of a spring of 1 N/m on P(z).
            let asked = (1..=3_000).map(|step| step as f32 * core::f32::consts::PI / 3_000.0).map(|theta| {
                let (up, down) = (at(above, theta), at(below, theta));
                let held = at([1.0, -1.0, 0.0], theta);
                let size = down.0 * down.0 + down.1 * down.1;
                let p = ((up.0 * down.0 + up.1 * down.1) / size, (up.1 * down.0 - up.0 * down.1) / size);
                0.5 / RATE * (held.0 * p.0 - held.1 * p.1) / (1.0 - sin_cos(theta).1)
            });
            let asked = asked.skip(20).fold(0.0, |worst, value| if value > worst { value } else { worst });
            let closed = required_damping(1.0, 0.0, 1.0 / RATE, between_counts_delay(corner));
            // Single precision in 1 − cos θ, as below. It is an upper bound: of a slow observer the sampling's own half
            // period, which it smooths, is counted in full.
            assert!(closed >= asked * 0.998, "{corner}: {closed} {asked}");
            assert!(closed - asked < 1.05 / RATE, "{corner}: {closed} {asked}");
        }
    }

    #[test]
    fn the_observer_passes_rounding_on_by_no_more_than_is_counted() {
        for omega_period in [0.02_f32, 0.1, 0.3, 0.5] {
            let ([a, b, _], [_, c, d]) = observer(omega_period);
            let (mut last, mut before, mut size) = (0.0_f32, 0.0_f32, 0.0_f32);
            for step in 0..2_000 {
                let driven = if step == 0 {
                    a
                } else if step == 1 {
                    b
                } else {
                    0.0
                };
                (last, before) = (driven - c * last - d * before, last);
                size += last.abs();
            }
            // Both bounds: not above what is counted, and for a slow observer not far below.
            assert!(2.0 * size <= BETWEEN_COUNTS * 1.000_1, "{omega_period}: {size}");
            assert!(omega_period > 0.05 || 2.0 * size > 0.98 * BETWEEN_COUNTS, "{omega_period}: {size}");
        }
    }

    /// The criterion itself: `b > T/2 · Re{(1 − e^{−jθ}) H}/(1 − cos θ)` for `0 < θ ≤ π`, `H = (K + B/T (1 − z⁻¹))
    /// z⁻ᵈ`.
    fn criterion(stiffness: f32, damping: f32, period: f32, delay: u32) -> f32 {
        (1..=3_000).fold(f32::NEG_INFINITY, |worst, step| {
            let theta = step as f32 * core::f32::consts::PI / 3_000.0;
            let cosine = |n: u32| sin_cos(theta * n as f32).1;
            let spring = cosine(delay) - cosine(delay + 1);
            // (1 − e^{−jθ})² = −2 (1 − cos θ) e^{−jθ}.
            let damper = -2.0 * (1.0 - cosine(1)) * cosine(delay + 1);
            let value = 0.5 * period * (stiffness * spring + damping / period * damper) / (1.0 - cosine(1));
            if theta > 0.02 && value > worst { value } else { worst }
        })
    }

    #[test]
    fn the_closed_form_is_never_below_the_criterion_and_for_a_spring_meets_it() {
        for delay in 0..4 {
            for (stiffness, damping) in [(1_000.0, 0.0), (1_000.0, 0.3), (200.0, 2.0), (0.0, 1.0)] {
                let asked = criterion(stiffness, damping, 1e-3, delay);
                let closed = required_damping(stiffness, damping, 1e-3, delay as f32 * 1e-3);
                // Single precision in 1 − cos θ down to θ = 0.02, where it is 2e-4: three digits.
                assert!(closed >= asked * 0.998, "{delay} {stiffness} {damping}: {closed} {asked}");
                assert!(damping > 0.0 || closed <= asked * 1.003, "{delay}: {closed} {asked}");
            }
        }
    }
}
