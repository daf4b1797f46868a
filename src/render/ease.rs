//! Easing: prevents clicks of the force. The damping rises with the push, and steps without a matching motion are
//! spread out.

use super::Penalty;
use crate::math::{Vec3, inverse_sqrt_from_below};

/// How a force rises, changes and ends.
///
/// A damper that acts from the first tick of contact meets the whole speed at once, and an edge ends or turns a force
/// between two ticks. Here the damping rises with the spring's push, after K. H. Hunt and F. R. E. Crossley
/// (*Coefficient of restitution interpreted as damping in vibroimpact*, J. Applied Mechanics 42(2), 1975), who make it
/// proportional to the depth all the way; and a change of force is spread out unless the probe's motion explains it.
///
/// A motion explains the change that the wall's own spring and full damper make of the probe's motion against it. So on
/// a flat wall only the onset of the damping is limited; and the bound alone holds at an edge, where the probe moves
/// along the surface, or on into the space where the body ends.
///
/// The force lost at an edge is given back late, which adds no energy as long as the probe is slow: a spring's push `F`
/// that falls by `change` a second does work of at most `v F²/(2 change)` on a probe that moves away at `v`, and the
/// released spring held `F²/(2K)`. Up to `v = change/K`, 0.4 m/s at 500 N/m, no more energy returns than was put in.
///
/// A force that turns, by a difference `E` of vectors, releases no energy that could pay for its lag. The difference
/// held back falls by `change − K v` a second or more while the wall's own force moves on by at most `K v`, so it does
/// at most `v E²/(2(change − K v))`: 0.6 mJ for 1 N that turns by a right angle at 0.1 m/s and 300 N/m.
///
/// ```
/// use palpate::render::Ease;
/// use palpate::servo::Rendering;
///
/// // Softer over edges: 1 N in 10 ms.
/// let ease = Ease { change_n_per_s: 100.0, ..Ease::SMOOTH };
/// let rendering = Rendering { ease: Some(ease), ..Rendering::PLAIN };
/// assert_eq!(rendering.check(500.0, 1.0 / 4_000.0), Ok(()));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ease {
    /// The spring's push over which the damping comes in, N. A force and not a depth, so that a stiff wall, which is
    /// never pressed in far, keeps its damper.
    pub onset_n: f32,
    /// How fast the force may change where no motion explains it, N/s. Over an edge it ends, or turns, at this rate: at
    /// 200 N/s 1 N in 5 ms.
    pub change_n_per_s: f32,
}

impl Ease {
    /// 1 N, in which a damper of 2 N·s/m on a wall of 500 N/m adds no more than 23 mN a tick at 0.3 m/s and 4 kHz,
    /// `K B v²/(onset rate)`; and 50 mN a tick there.
    pub const SMOOTH: Self = Self { onset_n: 1.0, change_n_per_s: 200.0 };

    /// Whether both are finite, the onset not negative, the rate positive.
    pub const fn is_valid(&self) -> bool {
        let Self { onset_n: onset, change_n_per_s: change } = *self;
        onset >= 0.0 && onset < f32::INFINITY && change > 0.0 && change < f32::INFINITY
    }
}

/// An [`Ease`] ready to run, for a wall and a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eased {
    /// Increase of a wall's damping with the depth, N·s/m²; infinite if it is there at once.
    damping_slope: f32,
    /// The change that is allowed in a tick whatever moves, N.
    free: f32,
    /// N/m: the spring's.
    stiffness: f32,
    /// N·s/m: the damper's when all of it is there.
    damping: f32,
}

/// The motion that may explain a change of force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reason {
    /// The probe's motion in this period, m.
    pub moved: Vec3,
    /// The change of its velocity, m/s.
    pub quickened: Vec3,
}

impl Eased {
    /// For a wall and a period (s).
    pub const fn new(ease: Ease, wall: &Penalty, period: f32) -> Self {
        Self {
            damping_slope: wall.damping_n_s_per_m * wall.stiffness_n_per_m / ease.onset_n,
            free: ease.change_n_per_s * period,
            stiffness: wall.stiffness_n_per_m,
            damping: wall.damping_n_s_per_m,
        }
    }

    /// The wall at a negative gap, m: with its damping as far as it has risen.
    #[inline]
    pub fn wall(&self, wall: &Penalty, gap: f32) -> Penalty {
        let damping = self.damping_slope * -gap;
        if damping < wall.damping_n_s_per_m { Penalty { damping_n_s_per_m: damping, ..*wall } } else { *wall }
    }

    /// `force`, or the nearest force that one step from `last` may reach for this reason. A force that is not finite
    /// stays so: the gate turns it into a fault.
    #[inline]
    pub fn next(&self, force: Vec3, last: Vec3, reason: &Reason) -> Vec3 {
        // Backwards, as a spring's force is to its motion.
        let change = last - force;
        let size = change.length_squared();
        if size <= self.free * self.free {
            return force;
        }
        // The change that spring and damper make of the motion, along the change, times its length.
        let explained = (reason.moved * self.stiffness + reason.quickened * self.damping).dot(change);
        if explained >= size {
            return force;
        }
        let inverse = inverse_sqrt_from_below(size);
        let explained = explained / size;
        let free = self.free * inverse;
        last - change * if explained > free { explained } else { free }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;

    const WALL: Penalty = Penalty { stiffness_n_per_m: 500.0, damping_n_s_per_m: 5.0, max_force_n: 5.0 };
    const STEP: Eased = Eased::new(Ease::SMOOTH, &WALL, 1.0 / 4_000.0);

    /// With nothing that explains a change.
    const NONE: Reason = Reason { moved: Vec3::ZERO, quickened: Vec3::ZERO };

    fn next(force: Vec3, last: Vec3) -> Vec3 {
        STEP.next(force, last, &NONE)
    }

    #[test]
    fn damping_that_begins_with_the_push_makes_no_step_at_contact() {
        let push = |gap: f32, rate: f32| STEP.wall(&WALL, gap).push(gap, rate);
        // 0.3 m/s at 5 N·s/m: 1.5 N in the first tick without it, and here less than two micronewtons at a nanometre.
        assert!(WALL.push(-1e-9, -0.3) > 1.49 && push(-1e-9, -0.3) < 2e-6);
        assert!((push(-0.001, -0.1) - 0.75).abs() < 1e-6);
        // All of it from 1 N on, which is 2 mm, without a step there; rounding of a newton and a half.
        assert!((push(-0.002, -0.1) - WALL.push(-0.002, -0.1)).abs() < 1e-6);
        assert_eq!(push(-0.003, -0.1), WALL.push(-0.003, -0.1));
        let at_once = Eased::new(Ease { onset_n: 0.0, ..Ease::SMOOTH }, &WALL, 1.0 / 4_000.0);
        assert_eq!(at_once.wall(&WALL, -1e-9), WALL);
    }

    #[test]
    fn a_stiffer_wall_has_its_damper_as_much_earlier() {
        let stiff = Penalty { stiffness_n_per_m: 5_000.0, ..WALL };
        let step = Eased::new(Ease::SMOOTH, &stiff, 1.0 / 4_000.0);
        assert!((step.wall(&stiff, -0.0001).damping_n_s_per_m - 2.5).abs() < 1e-6);
        assert_eq!(step.wall(&stiff, -0.000_201), stiff);
    }

    #[test]
    fn nothing_that_is_not_a_number_becomes_a_push_beyond_the_limit() {
        for gap in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for rate in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                let push = STEP.wall(&WALL, gap).push(gap, rate);
                assert!((0.0..=5.0).contains(&push), "{gap} {rate}: {push}");
            }
        }
    }

    #[test]
    fn a_force_that_vanishes_ends_step_by_step_and_is_then_exactly_zero() {
        let mut force = vec3(0.0, 3.0, 4.0);
        let mut ticks = 0;
        while force != Vec3::ZERO {
            let left = next(Vec3::ZERO, force);
            // 200 N/s at 4 kHz, and rounding of 5 N.
            assert!((left - force).length() <= 0.05 + 1e-6, "{ticks}: {force} to {left}");
            assert!(left.cross(force).length() < 1e-5 && left.length() < force.length());
            (force, ticks) = (left, ticks + 1);
        }
        // 5 N in steps of 50 mN.
        assert!((99..=101).contains(&ticks), "{ticks}");
    }

    #[test]
    fn a_turn_goes_by_steps_of_the_same_length() {
        let (mut force, aim) = (Vec3::Z * 0.7, Vec3::X * 0.7);
        let mut ticks = 0;
        while force != aim {
            let turned = next(aim, force);
            assert!((turned - force).length() <= 0.05 + 1e-6 && turned.length() <= 0.7 + 1e-6);
            (force, ticks) = (turned, ticks + 1);
        }
        // √2 · 0.7 N.
        assert_eq!(ticks, 20);
    }

    #[test]
    fn what_spring_and_damper_make_of_a_motion_is_not_held_back() {
        // 1 mm deeper is 0.5 N of the spring, 0.02 m/s faster 0.1 N of the damper.
        let reason = Reason { moved: Vec3::Z * -1e-3, quickened: Vec3::Z * -0.02 };
        let last = Vec3::Z * 0.1;
        assert_eq!(STEP.next(Vec3::Z * 0.699, last, &reason), Vec3::Z * 0.699);
        let held = STEP.next(Vec3::Z * 0.9, last, &reason);
        assert!((held.z - 0.7).abs() < 1e-6, "{held}");
        // Lifted off as fast as it was pressed, and let go: the same backwards.
        let lifted = Reason { moved: Vec3::Z * 1e-3, ..NONE };
        assert_eq!(STEP.next(Vec3::ZERO, Vec3::Z * 0.499, &lifted), Vec3::ZERO);
    }

    #[test]
    fn at_an_edge_no_motion_explains_that_the_force_goes() {
        // The hand goes on along the face, or into the space where the body was, or round the edge: 0.4 m/s at 4 kHz.
        for way in [Vec3::X, -Vec3::Z, (Vec3::X - Vec3::Z) * 0.7] {
            for aim in [Vec3::ZERO, Vec3::X * 0.7] {
                let last = Vec3::Z * 0.7;
                let step = STEP.next(aim, last, &Reason { moved: way * 1e-4, ..NONE }) - last;
                // Rounding of 0.7 N.
                assert!(step.length() <= 0.05 + 1e-6, "{way} {aim}: {step}");
            }
        }
    }

    #[test]
    fn a_flat_wall_s_own_force_passes_untouched_once_its_damper_is_there() {
        // A stiff wall behind coarse counts: the force jumps by what the counts do, as without easing.
        let stiff = Penalty { stiffness_n_per_m: 5_000.0, damping_n_s_per_m: 8.0, max_force_n: 5.0 };
        let step = Eased::new(Ease::SMOOTH, &stiff, 1.0 / 4_000.0);
        let (mut gap, mut rate, mut last) = (-0.0005, 0.0, stiff.push(-0.0005, 0.0));
        for moved in [58e-6_f32, 0.0, -116e-6, 58e-6, 58e-6, 0.0, -58e-6] {
            let quicker = 0.27 * (moved * 4_000.0 - rate);
            (gap, rate) = (gap + moved, rate + quicker);
            let asked = step.wall(&stiff, gap).push(gap, rate);
            let reason = Reason { moved: Vec3::Z * moved, quickened: Vec3::Z * quicker };
            let given = step.next(Vec3::Z * asked, Vec3::Z * last, &reason).z;
            // Rounding of a gap of half a millimetre, times the stiffness.
            assert!((given - asked).abs() < 1e-6 * asked.max(1.0), "{given} {asked}");
            last = given;
        }
    }

    #[test]
    fn what_is_held_back_falls_by_what_is_free_less_what_the_wall_moves_on() {
        let mut seed = 1_u32;
        let mut draw = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 23) as f32 - 1.0
        };
        let mut held_back = 0;
        for _ in 0..100_000 {
            let [last, force] = [(); 2].map(|()| vec3(draw(), draw(), draw()) * 3.0);
            let reason =
                Reason { moved: vec3(draw(), draw(), draw()) * 1e-4, quickened: vec3(draw(), draw(), draw()) * 2e-3 };
            // The wall's own force moves on by so much at most, whichever way.
            let most =
                WALL.stiffness_n_per_m * reason.moved.length() + WALL.damping_n_s_per_m * reason.quickened.length();
            let way = vec3(draw(), draw(), draw());
            let moved_on = force + way * (most / way.length().max(1.0));
            let (before, after) = ((last - force).length(), (STEP.next(moved_on, last, &reason) - moved_on).length());
            held_back += u32::from(after > 0.0);
            // The root's 0.2 %, and rounding of 5 N.
            assert!(
                after <= (before + most - 0.998 * 0.05).max(0.0) + 2e-6,
                "{last} {force} {reason:?}: {before} {after}"
            );
        }
        assert!(held_back > 90_000, "{held_back}");
    }

    #[test]
    fn what_is_not_finite_reaches_the_gate() {
        for bad in [f32::NAN, f32::INFINITY] {
            assert!(!next(Vec3::X * bad, Vec3::Z).is_finite());
        }
        assert!(Ease::SMOOTH.is_valid());
        for bad in [-1.0, f32::NAN, f32::INFINITY] {
            assert!(
                !Ease { onset_n: bad, ..Ease::SMOOTH }.is_valid()
                    && !Ease { change_n_per_s: bad, ..Ease::SMOOTH }.is_valid()
            );
        }
    }
}
