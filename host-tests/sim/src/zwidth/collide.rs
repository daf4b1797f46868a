//! One collision with a virtual wall.

use super::{Slice, SoftWall};
use palpate::device::{Counts, Duty, Encoder, VelocityEstimator, VelocityMethod};
use palpate::math::Vec3;
use palpate::render::bounds::between_counts_delay;
use palpate::render::{Ease, Eased, Penalty, Reason};
use std::collections::VecDeque;

/// Integration steps in a servo period; half a period's delay is ten of them.
const SUB_STEPS: u64 = 20;
/// Speed of the probe when it hits the wall, m/s.
const SPEED: f64 = 0.05;
/// Maximum duration of the simulation: seconds, periods of the mass on the wall, and time constants `B/K` of a damper
/// that only creeps. The swing is measured over windows of `WINDOW` seconds; a window without swing ends the
/// simulation.
const DURATION: f64 = 1.2;
const PERIODS: f64 = 15.0;
const CREEPS: f64 = 12.0;
const WINDOW: f64 = 0.3;
/// A swing of this many counts is rest, from which no oscillation can start again.
const REST: f64 = 1e-3;

/// The virtual wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// N/m.
    pub stiffness: f64,
    /// N·s/m.
    pub damping: f64,
}

/// The loop from sensor to force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loop {
    /// Servo rate, Hz.
    pub rate: f64,
    /// Delay from sampling to the amplifier, in periods.
    pub delay_periods: f64,
    /// The velocity estimator.
    pub velocity: VelocityMethod,
    /// Its corner, Hz.
    pub corner: f64,
    /// Easing of the force.
    pub ease: Option<Ease>,
}

impl Loop {
    /// The delay, s, in the bound of passivity: transport, the force source's lag, and the lag of the position between
    /// counts.
    pub fn delay(&self, slice: &Slice) -> f64 {
        let observer = match self.velocity {
            VelocityMethod::BetweenCounts => f64::from(between_counts_delay(self.corner as f32)),
            VelocityMethod::LowPass => 0.0,
        };
        self.delay_periods / self.rate + slice.time_constant + observer
    }

    /// The maximum stiffness that is passive with a damping (N·s/m), N/m. The bound covers spring and damper; the
    /// effect of an easing is only simulated.
    pub fn passive_stiffness(&self, slice: &Slice, damping: f64) -> f64 {
        let friction = match self.velocity {
            VelocityMethod::BetweenCounts => slice.friction().between_counts(),
            VelocityMethod::LowPass => slice.friction(),
        };
        f64::from(friction.passive_stiffness(damping as f32, 1.0 / self.rate as f32, self.delay(slice) as f32))
    }
}

/// The hand's force during a collision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// A steady push of the hand into the wall, N. It neither damps nor stores energy: only the device and the wall let
    /// the probe settle.
    pub push: f64,
}

impl Default for Collision {
    fn default() -> Self {
        Self { push: 1.0 }
    }
}

/// Result of a collision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// From the lowest to the highest position at the end, in encoder counts.
    pub counts: f64,
    /// The mean position at the end, m; negative in the wall.
    pub rest: f64,
}

impl Swing {
    /// Whether it came to rest, apart from a limit cycle of two counts.
    pub fn has_decayed(&self) -> bool {
        self.counts <= 2.0
    }
}

/// Hits the wall at 50 mm/s and follows the probe until it should have come to rest.
///
/// Force and friction are constant over a sub-step, in which the motion is then exact; the sub-step in which the probe
/// stops is the one where friction is below its limit.
pub fn collide(slice: &Slice, wall: Wall, servo: &Loop, collision: Collision) -> Swing {
    collide_with(slice, wall, servo, collision, None)
}

/// [`collide`] with a body that gives way, made for the loop's rate.
pub(super) fn collide_with(
    slice: &Slice,
    wall: Wall,
    servo: &Loop,
    collision: Collision,
    soft: Option<&SoftWall>,
) -> Swing {
    let mut hit = soft.map(SoftWall::start);
    let step = 1.0 / (servo.rate * SUB_STEPS as f64);
    let encoder = Encoder::new(slice.resolution as f32, 0.0);
    let estimator =
        VelocityEstimator::new(servo.velocity, servo.corner as f32, servo.rate as f32, slice.resolution as f32);
    let penalty = Penalty {
        stiffness_n_per_m: wall.stiffness as f32,
        damping_n_s_per_m: wall.damping as f32,
        max_force_n: slice.max_force as f32,
    };
    let eased = servo.ease.map(|ease| Eased::new(ease, &penalty, 1.0 / servo.rate as f32));
    let delay = (servo.delay_periods * SUB_STEPS as f64).round() as u64;
    let decay = (-step / slice.time_constant).exp();

    // A third of a count before the wall.
    let (mut position, mut velocity) = (slice.resolution / 3.0, -SPEED);
    let read = |position: f64| encoder.angle(Counts((position / slice.resolution).floor() as i32));
    let mut memory = estimator.start();
    let mut last = read(position);
    let (mut believed, mut rate, mut given) = (last, 0.0, 0.0);
    let (mut aim, mut force) = (0.0, 0.0);
    let mut under_way: VecDeque<(u64, f64)> = VecDeque::new();
    let periods = PERIODS * std::f64::consts::TAU * (slice.mass / wall.stiffness).sqrt();
    let duration = DURATION + periods + CREEPS * wall.damping / wall.stiffness;
    let window = (WINDOW * servo.rate) as u64;
    let ticks = (duration / WINDOW).ceil() as u64 * window;
    let (mut lowest, mut highest, mut sum) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
    let mut swing = Swing { counts: f64::INFINITY, rest: 0.0 };
    for tick in 0..ticks {
        let now = read(position);
        let before = rate;
        rate = estimator.next(&mut memory, now - last);
        last = now;
        let moved = now - memory.lag - believed;
        believed += moved;
        let eased_wall = eased.map_or(penalty, |eased| eased.wall(&penalty, believed));
        let push = match &mut hit {
            Some(hit) => hit.push(&eased_wall, believed, rate),
            None => eased_wall.push(believed, rate),
        };
        given = eased.map_or(push, |eased| {
            let [push, given, moved, quickened] = [push, given, moved, rate - before].map(|along| Vec3::Z * along);
            eased.next(push, given, &Reason { moved, quickened }).z
        });
        let duty = Duty::from_fraction(given / penalty.max_force_n);
        under_way.push_back((tick * SUB_STEPS + delay, f64::from(duty.fraction()) * slice.max_force));
        for sub_step in tick * SUB_STEPS..(tick + 1) * SUB_STEPS {
            while let Some(&(arrival, arrived)) = under_way.front()
                && arrival <= sub_step
            {
                under_way.pop_front();
                aim = arrived;
            }
            force = aim + (force - aim) * decay;
            let smooth = force - collision.push - slice.viscous * velocity;
            let free = velocity + smooth / slice.mass * step;
            let dry = (-free * slice.mass / step).clamp(-slice.coulomb, slice.coulomb);
            let after = free + dry / slice.mass * step;
            position += 0.5 * (velocity + after) * step;
            velocity = after;
            lowest = lowest.min(position);
            highest = highest.max(position);
        }
        sum += position;
        if (tick + 1) % window == 0 {
            swing = Swing { counts: (highest - lowest) / slice.resolution, rest: sum / window as f64 };
            if swing.counts < REST {
                break;
            }
            (lowest, highest, sum) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        }
    }
    swing
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::named;

    const SERVO: Loop =
        Loop { rate: 4_000.0, delay_periods: 1.0, velocity: VelocityMethod::LowPass, corner: 200.0, ease: None };

    #[test]
    fn a_soft_wall_stops_the_probe_where_the_push_is_balanced() {
        let slice = Slice::of(named("woodenhaptics-2016").unwrap());
        let swing = collide(&slice, Wall { stiffness: 400.0, damping: 2.0 }, &SERVO, Collision::default());
        assert!(swing.has_decayed(), "{swing:?}");
        // 1 N on 400 N/m, give or take the dry friction and a count.
        let spread = slice.coulomb / 400.0 + slice.resolution;
        assert!((swing.rest + 1.0 / 400.0).abs() < spread, "{swing:?}");
    }

    #[test]
    fn a_wall_far_too_stiff_never_comes_to_rest() {
        let slice = Slice::of(named("woodenhaptics-2016").unwrap());
        let swing = collide(&slice, Wall { stiffness: 50_000.0, damping: 0.0 }, &SERVO, Collision::default());
        assert!(swing.counts > 10.0, "{swing:?}");
    }

    #[test]
    fn without_friction_and_wall_damping_a_sampled_wall_gives_out_energy() {
        // Colgate and Schenkel: nothing but the device's own damping pays for sampling.
        let slice = Slice { viscous: 0.0, coulomb: 0.0, ..Slice::of(named("woodenhaptics-2016").unwrap()) };
        let swing = collide(&slice, Wall { stiffness: 400.0, damping: 0.0 }, &SERVO, Collision::default());
        assert!(!swing.has_decayed(), "{swing:?}");
    }
}
