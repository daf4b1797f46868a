//! How a mode moves: a damped oscillator, solved exactly over a tick in which its force is constant (theory §15).

use crate::math::square_root;

/// A mode as an oscillator, in terms of its most moved point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Modal {
    /// Modal mass, kg; 0 for a mode without inertia.
    pub mass_kg: f32,
    /// Modal damping, N·s/m; 0 as well as the mass: the mode follows its force at once.
    pub damping_n_s_per_m: f32,
    /// Modal stiffness, N/m; above 0.
    pub stiffness_n_per_m: f32,
}

/// Maximum of `(ω · period)²`, 256 radians a tick: a faster mode is to be given without mass.
const MAX_PHASE_SQUARED: f32 = 65_536.0;

impl Modal {
    /// From a natural frequency, Hz, a modal mass, kg, and a damping ratio (1: critical).
    pub const fn new(frequency_hz: f32, mass_kg: f32, damping_ratio: f32) -> Self {
        let rate = core::f32::consts::TAU * frequency_hz;
        Self {
            mass_kg,
            damping_n_s_per_m: 2.0 * damping_ratio * rate * mass_kg,
            stiffness_n_per_m: rate * rate * mass_kg,
        }
    }

    /// Whether its numbers are finite, mass and damping not negative, the stiffness positive, and a tick of `period_s`
    /// is at most 256 radians long.
    pub const fn is_valid(&self, period_s: f32) -> bool {
        let Self { mass_kg, damping_n_s_per_m, stiffness_n_per_m } = *self;
        let is_finite = mass_kg < f32::INFINITY && damping_n_s_per_m < f32::INFINITY;
        let is_stiff = stiffness_n_per_m > 0.0 && stiffness_n_per_m < f32::INFINITY;
        let is_followed = mass_kg == 0.0 || stiffness_n_per_m / mass_kg * period_s * period_s <= MAX_PHASE_SQUARED;
        is_finite && is_stiff && is_followed && mass_kg >= 0.0 && damping_n_s_per_m >= 0.0 && period_s > 0.0
    }
}

/// A tick of a mode: six constants, in flash. The new state is the old one plus increments, because in `f32` a matrix
/// near the identity loses their digits: a mode without damping would gain or lose energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModalStep {
    /// Change of `q` by `q`; by `v`, s; by the force, m/N.
    pub displacement: [f32; 3],
    /// Change of `v` by `q`, 1/s; by `v`; by the force, m/(N·s).
    pub velocity: [f32; 3],
}

impl ModalStep {
    /// No motion.
    pub const ZERO: Self = Self { displacement: [0.0; 3], velocity: [0.0; 3] };

    /// The step over `period_s` seconds of a [valid](Modal::is_valid) mode.
    pub const fn new(modal: &Modal, period_s: f32) -> Self {
        let Modal { mass_kg: mass, damping_n_s_per_m: damping, stiffness_n_per_m: stiffness } = *modal;
        if mass == 0.0 {
            let by_q = if damping == 0.0 { -1.0 } else { exp_less_one(-stiffness * period_s / damping) };
            return Self { displacement: [by_q, 0.0, -by_q / stiffness], velocity: [0.0, -1.0, 0.0] };
        }
        // In w = v · period the tick has the length 1: q' = w, w' = −κ q − d w.
        let spring = stiffness / mass * period_s * period_s;
        let drag = damping / mass * period_s;
        let [[q_q, q_w], [w_q, w_w]] = if drag > 1.0 && drag * drag > 16.0 * spring {
            overdamped(spring, drag)
        } else {
            oscillating(spring, drag)
        };
        // The force moves the rest to force/stiffness.
        Self {
            displacement: [q_q, q_w * period_s, -q_q / stiffness],
            velocity: [w_q / period_s, w_w, -w_q / (period_s * stiffness)],
        }
    }

    /// The free motion of `q` in a tick, metres, from `q`, metres, and `v`, m/s.
    #[inline(always)]
    pub fn free_motion(&self, q: f32, v: f32) -> f32 {
        self.displacement[0] * q + self.displacement[1] * v
    }

    /// The motion of `q` by 1 N in a tick, metres.
    #[inline(always)]
    pub const fn compliance(&self) -> f32 {
        self.displacement[2]
    }

    /// `[q, v]` after a tick under a constant force, N.
    #[inline(always)]
    pub fn advance(&self, [q, v]: [f32; 2], force_n: f32) -> [f32; 2] {
        let ([q_q, q_v, q_f], [v_q, v_v, v_f]) = (self.displacement, self.velocity);
        [q + (q_q * q + q_v * v + q_f * force_n), v + (v_q * q + v_v * v + v_f * force_n)]
    }

    /// `[q, v]` after a number of ticks without force: their product, by squaring.
    pub fn ring(&self, mut state: [f32; 2], ticks: u32) -> [f32; 2] {
        let ([q_q, q_v, _], [v_q, v_v, _]) = (self.displacement, self.velocity);
        let (mut step, mut left) = ([[q_q, q_v], [v_q, v_v]], ticks);
        while left > 0 {
            if left & 1 == 1 {
                let [q, v] = state;
                state = [q + (step[0][0] * q + step[0][1] * v), v + (step[1][0] * q + step[1][1] * v)];
            }
            left >>= 1;
            step = twice(&step);
        }
        state
    }

    /// [`Self::advance`] between two stops at `±limit`, metres: a mode that reaches one rests there, which takes its
    /// kinetic energy and gives none.
    #[inline(always)]
    pub fn advance_within(&self, state: [f32; 2], force_n: f32, limit: f32) -> [f32; 2] {
        within(self.advance(state, force_n), limit)
    }
}

/// A state between the stops at `±limit`.
#[inline(always)]
pub(crate) fn within([q, v]: [f32; 2], limit: f32) -> [f32; 2] {
    // Written so that NaN comes to rest.
    if q > -limit && q < limit {
        [q, v]
    } else if q >= limit {
        [limit, 0.0]
    } else if q <= -limit {
        [-limit, 0.0]
    } else {
        [0.0; 2]
    }
}

/// `e^A − 1` for `A = [[0, 1], [−κ, −d]]`, by halves of it that Taylor's series holds, doubled.
const fn oscillating(spring: f32, drag: f32) -> [[f32; 2]; 2] {
    let (mut length, mut halvings) = (1.0, 0);
    // 256 radians, with a drag of at most four times as much.
    while halvings < 12 && (spring * length * length > 0.0625 || drag * length > 0.5) {
        length *= 0.5;
        halvings += 1;
    }
    let a = [[0.0, length], [-spring * length, -drag * length]];
    // From the smallest term: A (1 + A/2 (1 + A/3 (…))); the ninth is below the rounding of the first.
    let (mut sum, mut order) = ([[0.0; 2]; 2], 9);
    while order > 0 {
        let inner = [[1.0 + sum[0][0], sum[0][1]], [sum[1][0], 1.0 + sum[1][1]]];
        sum = scaled(&product(&a, &inner), 1.0 / order as f32);
        order -= 1;
    }
    while halvings > 0 {
        sum = twice(&sum);
        halvings -= 1;
    }
    sum
}

/// The increments of a step taken twice.
const fn twice(step: &[[f32; 2]; 2]) -> [[f32; 2]; 2] {
    let square = product(step, step);
    [
        [2.0 * step[0][0] + square[0][0], 2.0 * step[0][1] + square[0][1]],
        [2.0 * step[1][0] + square[1][0], 2.0 * step[1][1] + square[1][1]],
    ]
}

/// The same from its two real roots, apart by a factor of more than 13: the slow one has digits of its own. With less
/// drag than 1 the two would cancel.
const fn overdamped(spring: f32, drag: f32) -> [[f32; 2]; 2] {
    let spread = square_root(drag * drag - 4.0 * spring);
    let fast = -0.5 * (drag + spread);
    let slow = spring / fast;
    let (by_fast, by_slow) = (exp_less_one(fast), exp_less_one(slow));
    let q_w = (by_slow - by_fast) / spread;
    let q_q = (slow * by_fast - fast * by_slow) / spread;
    [[q_q, q_w], [-spring * q_w, (slow * by_slow - fast * by_fast) / spread]]
}

/// `e^x − 1` for `x ≤ 0`.
const fn exp_less_one(x: f32) -> f32 {
    // Below, e^x is under half a unit in the last place of 1.
    if x <= -17.4 {
        return -1.0;
    }
    let (mut part, mut halvings) = (x, 0);
    while halvings < 8 && part < -0.25 {
        part *= 0.5;
        halvings += 1;
    }
    let (mut sum, mut order) = (0.0, 8);
    while order > 0 {
        sum = part * (1.0 + sum) / order as f32;
        order -= 1;
    }
    while halvings > 0 {
        sum = 2.0 * sum + sum * sum;
        halvings -= 1;
    }
    sum
}

const fn product(a: &[[f32; 2]; 2], b: &[[f32; 2]; 2]) -> [[f32; 2]; 2] {
    [
        [a[0][0] * b[0][0] + a[0][1] * b[1][0], a[0][0] * b[0][1] + a[0][1] * b[1][1]],
        [a[1][0] * b[0][0] + a[1][1] * b[1][0], a[1][0] * b[0][1] + a[1][1] * b[1][1]],
    ]
}

const fn scaled(a: &[[f32; 2]; 2], by: f32) -> [[f32; 2]; 2] {
    [[a[0][0] * by, a[0][1] * by], [a[1][0] * by, a[1][1] * by]]
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: f32 = 2.5e-4;

    /// The motion of an oscillator in double precision, by steps of the classical Runge-Kutta method.
    fn integrated(modal: &Modal, [q, v]: [f64; 2], force: f64, time: f64) -> [f64; 2] {
        let [m, c, k] = [modal.mass_kg, modal.damping_n_s_per_m, modal.stiffness_n_per_m].map(f64::from);
        let slope = |[q, v]: [f64; 2]| [v, (force - k * q - c * v) / m];
        // The fastest root moves by less than 1/50 in a step: the error is below 1e-9.
        let steps = ((c / m + (k / m).sqrt()) * time * 50.0).ceil().max(20.0);
        let h = time / steps;
        let along = |[q, v]: [f64; 2], [dq, dv]: [f64; 2], h: f64| [q + h * dq, v + h * dv];
        let mut at = [q, v];
        for _ in 0..steps as u32 {
            let a = slope(at);
            let b = slope(along(at, a, 0.5 * h));
            let c = slope(along(at, b, 0.5 * h));
            let d = slope(along(at, c, h));
            for ((at, (a, b)), (c, d)) in at.iter_mut().zip(a.iter().zip(b)).zip(c.iter().zip(d)) {
                *at += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
            }
        }
        at
    }

    #[test]
    fn a_tick_is_that_of_the_integrated_oscillator() {
        for frequency in [0.5, 5.0, 50.0, 400.0, 1_500.0, 6_000.0] {
            for damping in [0.0, 0.05, 0.7, 0.999, 1.0, 1.001, 1.9, 2.1, 10.0, 60.0] {
                let modal = Modal::new(frequency, 0.05, damping);
                assert!(modal.is_valid(PERIOD));
                let step = ModalStep::new(&modal, PERIOD);
                let rate = f64::from(core::f32::consts::TAU * frequency);
                for (state, force) in [([1e-3, 0.0], 0.0), ([0.0, 0.3], 0.0), ([-2e-3, 0.1], 3.0), ([0.0, 0.0], 1.0)] {
                    let [q, v] = step.advance(state, force);
                    let expected = integrated(&modal, state.map(f64::from), f64::from(force), f64::from(PERIOD));
                    // As energies: of the state and of the force's work.
                    let size = f64::from(state[0]).abs()
                        + f64::from(state[1]).abs() / rate
                        + f64::from(force) / f64::from(modal.stiffness_n_per_m);
                    let [q_off, v_off] = [f64::from(q) - expected[0], f64::from(v) - expected[1]];
                    // A rounding of each of some ten operations, once more for each of up to six doublings.
                    let most = 3e-6 * size;
                    assert!(
                        q_off.abs() <= most && v_off.abs() <= most * rate,
                        "{frequency} Hz, {damping}, {state:?}, {force} N: {q} {v} {expected:?}"
                    );
                }
            }
        }
    }

    /// Relative errors of a slow creep, which a rounding against 1 would bury.
    #[test]
    fn a_heavily_damped_mode_creeps_at_its_slow_root() {
        for damping in [3.0, 30.0, 3_000.0] {
            let modal = Modal::new(10.0, 0.05, damping);
            let step = ModalStep::new(&modal, PERIOD);
            let [_, c, k] = [0.0, modal.damping_n_s_per_m, modal.stiffness_n_per_m].map(f64::from);
            let massless = Modal { mass_kg: 0.0, ..modal };
            let expected = (-k / c * f64::from(PERIOD)).exp_m1();
            let found = f64::from(ModalStep::new(&massless, PERIOD).displacement[0]);
            assert!((found / expected - 1.0).abs() < 1e-6, "{damping}: {found} {expected}");
            let rate = core::f64::consts::TAU * 10.0;
            let slow = -rate / (f64::from(damping) + (f64::from(damping).powi(2) - 1.0).sqrt());
            // On the slow root's direction.
            let state = [1e-3, (1e-3 * slow) as f32];
            let creep = f64::from(step.free_motion(state[0], state[1]));
            let expected = 1e-3 * (slow * f64::from(PERIOD)).exp_m1();
            assert!((creep / expected - 1.0).abs() < 1e-5, "{damping}: {creep} {expected}");
        }
    }

    #[test]
    fn a_mode_without_mass_and_damping_follows_its_force_at_once() {
        let step = ModalStep::new(&Modal { mass_kg: 0.0, damping_n_s_per_m: 0.0, stiffness_n_per_m: 500.0 }, PERIOD);
        assert_eq!(step.advance([3e-3, 0.2], 1.0), [0.002, 0.0]);
    }

    /// A million ticks without damping. The determinant of the step is off by the roundings of its constants: those of
    /// `q` by `q` and `v` by `v`, each (ω h)²/2, and of the product of the others, (ω h)², each computed and stored with a
    /// rounding of 2⁻²⁴. Roundings of the sums do not add up: some 2e-5.
    #[test]
    fn a_mode_without_damping_keeps_its_energy() {
        for frequency in [5.0, 13.0, 29.0, 50.0] {
            let modal = Modal::new(frequency, 0.05, 0.0);
            let step = ModalStep::new(&modal, PERIOD);
            let energy = |[q, v]: [f32; 2]| {
                let [q, v] = [q, v].map(f64::from);
                0.5 * (f64::from(modal.stiffness_n_per_m) * q * q + f64::from(modal.mass_kg) * v * v)
            };
            let (start, ticks) = ([3e-3, 0.0], 1_000_000);
            let mut state = start;
            for _ in 0..ticks {
                state = step.advance(state, 0.0);
            }
            let phase = core::f64::consts::TAU * f64::from(frequency * PERIOD);
            let most = f64::from(ticks) * 4.0 * phase * phase * 2.0_f64.powi(-24) + 2e-5;
            let off = energy(state) / energy(start) - 1.0;
            assert!(off.abs() <= most, "{frequency} Hz: {off:e}, at most {most:e}");
        }
    }

    /// `−ΔE − …`: the force's work less the gain in energy is what is dissipated, and that is never negative, at a stop
    /// neither.
    #[test]
    fn a_stop_takes_energy_and_gives_none() {
        let limit = 2e-3;
        let mut at_stop = 0;
        for (frequency, damping) in [(5.0, 0.05), (50.0, 0.0), (50.0, 1.0), (200.0, 5.0), (20.0, 0.3)] {
            let modal = Modal::new(frequency, 0.05, damping);
            let step = ModalStep::new(&modal, PERIOD);
            let [m, k] = [modal.mass_kg, modal.stiffness_n_per_m].map(f64::from);
            let energy = |[q, v]: [f32; 2]| 0.5 * (k * f64::from(q).powi(2) + m * f64::from(v).powi(2));
            let mut state = [0.0; 2];
            for tick in 0..40_000_u32 {
                let force = 8.0 * (tick as f32 * 0.01).sin() * (tick as f32 * 3.7e-4).cos();
                let next = step.advance_within(state, force, limit);
                assert!(next[0].abs() <= limit);
                at_stop += u32::from(next[0].abs() == limit);
                let work = f64::from(force) * f64::from(next[0] - state[0]);
                let dissipated = work - (energy(next) - energy(state));
                // The rounding of q and v, 2⁻²⁴ of each, in energy.
                let most = 4e-7 * (energy(state) + energy(next) + work.abs()) + 1e-12;
                assert!(dissipated >= -most, "{frequency} Hz, tick {tick}: {dissipated:e}, rounding {most:e}");
                state = next;
            }
        }
        assert!(at_stop > 1_000, "{at_stop}");
        let step = ModalStep::new(&Modal::new(20.0, 0.05, 0.1), PERIOD);
        assert_eq!(step.advance_within([f32::NAN, 0.0], 0.0, limit), [0.0; 2]);
    }

    #[test]
    fn modes_that_are_none_are_refused() {
        let good = Modal::new(20.0, 0.05, 0.1);
        for bad in [
            Modal { mass_kg: -1.0, ..good },
            Modal { mass_kg: f32::NAN, ..good },
            Modal { damping_n_s_per_m: -1.0, ..good },
            Modal { damping_n_s_per_m: f32::INFINITY, ..good },
            Modal { stiffness_n_per_m: 0.0, ..good },
            Modal { stiffness_n_per_m: f32::INFINITY, ..good },
            Modal::new(2e6, 0.05, 0.1),
        ] {
            assert!(!bad.is_valid(PERIOD), "{bad:?}");
        }
        assert!(good.is_valid(PERIOD) && !good.is_valid(0.0));
    }
}
