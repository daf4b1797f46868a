//! The virtual coupling between the hand and the drawn tool, and the step that it makes of the drawn tool.

use super::contact::ToolContact;
use super::press::{Step, press};
use crate::math::{Vec3, product, sqrt, turned_by, vec3};
use crate::scene::{BodyPose, Wrench};

/// Maximum speed of the proxy, m/s and rad/s, and its maximum motion in a tick, beyond which a linearised gap says too
/// little.
const SPEED: [f32; 2] = [2.0, 40.0];
const STEP: [f32; 2] = [0.5e-3, 0.01];
/// Maximum change of the wrench by a proxy that moves farther than the hand, as where it slips over an edge: N/s and
/// N·m/s, and in a tick.
const SLIP: [f32; 2] = [100.0, 0.4];
const SLIP_STEP: [f32; 2] = [0.025, 0.1e-3];
/// Largest coefficient of friction: above that of rubber on dry stone.
const MAX_FRICTION: f32 = 2.0;
/// Seconds over which the wrench fades once contact is given up, as a point's force does.
const FADE_S: f32 = 0.005;
/// Steps below, m and rad, are not taken where there is friction.
const HELD: [f32; 2] = [1.0e-8, 1.0e-6];

/// The spring between hand and proxy, in six directions about the origin of the tool's frame.
///
/// For an angle `θ` the torque is `k sin θ` about its axis, the gradient of the exact potential `2 k ‖vec q‖²`, without
/// arc functions. A device that renders it at period `h` needs a damping of `k h/2` in each direction.
///
/// The proxy follows by at most 2 m/s and 40 rad/s, and adds at most 100 N/s and 0.4 N·m/s to what the hand's own motion
/// makes of the wrench; below 4 kHz by as much a tick as at 4 kHz.
///
/// ```
/// use palpate::pair::ToolCoupling;
///
/// // 1 kN/m and 0.1 N·m/rad at 4 kHz.
/// let coupling = ToolCoupling::new(1_000.0, 0.1, 4_000.0).expect("three positive numbers");
/// let [damping, turning] = coupling.min_damping();
/// assert!((damping - 0.125).abs() < 1e-6 && (turning - 1.25e-5).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolCoupling {
    stiffness_n_per_m: f32,
    /// Infinite where the proxy has the hand's orientation.
    stiffness_n_m_per_rad: f32,
    period_s: f32,
    /// How far a force and a torque move the proxy, m/N and rad/(N·m): 0 where it has the hand's orientation.
    soft: [f32; 2],
    /// Of the proxy in a tick, m and rad.
    pub(super) max_step: [f32; 2],
    /// Of a proxy that slips, beyond the hand's motion in a tick, m and rad.
    max_slip: [f32; 2],
    /// By which the share of a given-up wrench falls in a tick.
    pub(super) fade_step: f32,
    /// Coefficient `μ` of dry friction.
    friction: f32,
}

impl ToolCoupling {
    /// A spring of a stiffness in N/m and one in N·m/rad, in a loop of `rate_hz`; `None` unless all are positive and
    /// finite.
    pub const fn new(stiffness_n_per_m: f32, stiffness_n_m_per_rad: f32, rate_hz: f32) -> Option<Self> {
        if !is_positive(stiffness_n_per_m) || !is_positive(stiffness_n_m_per_rad) || !is_positive(rate_hz) {
            return None;
        }
        let fade = 1.0 / (FADE_S * rate_hz);
        let soft = [1.0 / stiffness_n_per_m, 1.0 / stiffness_n_m_per_rad];
        let [slip, slip_turn] = in_a_tick(SLIP, SLIP_STEP, rate_hz);
        Some(Self {
            stiffness_n_per_m,
            stiffness_n_m_per_rad,
            period_s: 1.0 / rate_hz,
            soft,
            max_step: in_a_tick(SPEED, STEP, rate_hz),
            max_slip: [slip * soft[0], slip_turn * soft[1]],
            fade_step: if fade < 1.0 { fade } else { 1.0 },
            friction: 0.0,
        })
    }

    /// With dry friction (Coulomb) of a coefficient `μ` at the contacts: the proxy is held along the body while the force
    /// of each contact lies in its cone, `‖F_t‖ ≤ μ F_n`, and slides at the cone's edge (W. S. Harwin and N. Melder,
    /// *Improved haptic rendering for multi-finger manipulation using friction cone based god-objects*, 2002). A rolling
    /// tool is not braked. `None` unless `μ` is from 0 to 2.
    #[must_use]
    pub const fn with_friction(self, coefficient: f32) -> Option<Self> {
        // A NaN fails too.
        if coefficient >= 0.0 && coefficient <= MAX_FRICTION {
            Some(Self { friction: coefficient, ..self })
        } else {
            None
        }
    }

    /// The spring of a device whose wrist has no motors: the proxy has the hand's orientation and there is no torque.
    ///
    /// A force alone is not the gradient of a potential in six directions: along a closed path of the hand that turns
    /// the tool in contact, its energy need not come back to where it was (Barbagli & Salisbury 2003).
    pub const fn without_torque(stiffness_n_per_m: f32, rate_hz: f32) -> Option<Self> {
        match Self::new(stiffness_n_per_m, 1.0, rate_hz) {
            Some(coupling) => {
                Some(Self { stiffness_n_m_per_rad: f32::INFINITY, soft: [coupling.soft[0], 0.0], ..coupling })
            }
            None => None,
        }
    }

    const fn has_torque(&self) -> bool {
        self.stiffness_n_m_per_rad < f32::INFINITY
    }

    /// N·m/rad of the torque that is given.
    const fn torsion(&self) -> f32 {
        if self.has_torque() { self.stiffness_n_m_per_rad } else { 0.0 }
    }

    /// The damping that makes the sampled spring passive: N·s/m and N·m·s/rad.
    pub const fn min_damping(&self) -> [f32; 2] {
        [0.5 * self.stiffness_n_per_m * self.period_s, 0.5 * self.torsion() * self.period_s]
    }

    /// On the proxy at `from`, by a hand at `to`; minus it is on the hand.
    pub fn wrench(&self, from: &BodyPose, to: &BodyPose) -> Wrench {
        let (away, (vector, scalar)) = stretch(from, to);
        let torque = vector * (2.0 * self.torsion() * scalar);
        Wrench { force: away * self.stiffness_n_per_m, torque }
    }

    /// The energy in the spring, J.
    pub fn energy_j(&self, from: &BodyPose, to: &BodyPose) -> f32 {
        let (away, (vector, _)) = stretch(from, to);
        0.5 * self.stiffness_n_per_m * away.length_squared() + 2.0 * self.torsion() * vector.length_squared()
    }

    /// The proxy's pose a tick later: the quadratic model of the spring's energy, minimised where no linearised gap
    /// closes and friction holds. The contacts' forces are found from those that they have.
    ///
    /// A share of a step is feasible and lower as the step is, so that the step and the motion beyond `hand`'s since
    /// `before` are bounded.
    pub(super) fn settle(
        &self,
        proxy: &BodyPose,
        [before, hand]: [&BodyPose; 2],
        contacts: &mut [ToolContact],
        radius: f32,
    ) -> BodyPose {
        let (way, (vector, scalar)) = stretch(proxy, hand);
        let mut free = Step { way, turn: vector * (2.0 * scalar), soft: self.soft };
        if self.friction > 0.0 {
            press::<true>(&mut free, contacts, radius, self.friction);
        } else {
            press::<false>(&mut free, contacts, radius, 0.0);
        }
        let Step { way, turn, .. } = free;
        let (moved, (turned, _)) = stretch(before, hand);
        let [slip, slip_turn] = self.max_slip;
        let length = |vector: Vec3| sqrt(vector.length_squared());
        let least = |one: f32, other: f32| if one < other { one } else { other };
        // One factor for both, so that the step still lowers the spring's energy.
        let max_way = least(self.max_step[0], length(moved) + slip);
        let mut share = share_within([way, turn], [max_way, self.max_step[1]]);
        if self.has_torque() {
            let turned = turned * 2.0;
            share = least(share, share_within([turn, Vec3::ZERO], [length(turned) + slip_turn, 0.0]));
            share = share_behind(turned, turn, slip_turn, share);
        }
        share = share_behind(moved, way, slip, share);
        // Steps of rounding would carry it out of where friction holds it.
        if self.friction > 0.0 && share_within([way, turn], HELD) >= 1.0 {
            return *proxy;
        }
        let position = (Vec3::from_array(proxy.position) + way * share).to_array();
        let next = BodyPose { position, orientation: turned_by(turn * (0.5 * share), &proxy.orientation) };
        // Where nothing has to be taken back and the proxy need not turn, standing still is feasible.
        let may_stay = self.has_torque() && contacts.iter().all(|contact| contact.gap >= 0.0);
        if may_stay && self.energy_j(&next, hand) > self.energy_j(proxy, hand) { *proxy } else { next }
    }
}

const fn is_positive(number: f32) -> bool {
    number > 0.0 && number < f32::INFINITY
}

/// The share of a rate a second that a tick of a loop at `rate_hz` takes, at most `most`.
const fn in_a_tick([way, turn]: [f32; 2], [most_way, most_turn]: [f32; 2], rate_hz: f32) -> [f32; 2] {
    let (way, turn) = (way / rate_hz, turn / rate_hz);
    [if way < most_way { way } else { most_way }, if turn < most_turn { turn } else { most_turn }]
}

/// The factor, at most 1, that brings both vectors within their limits.
pub(super) fn share_within(vectors: [Vec3; 2], limits: [f32; 2]) -> f32 {
    let mut share = 1.0;
    for (vector, limit) in vectors.into_iter().zip(limits) {
        let length = sqrt(vector.length_squared());
        if length * share > limit {
            share = limit / length;
        }
    }
    share
}

/// The largest share of a step, at most `most`, that stretches the spring by no more than the hand's motion and `slip` do.
fn share_behind(hand: Vec3, step: Vec3, slip: f32, most: f32) -> f32 {
    let moved = hand.length_squared();
    let beyond = slip * (slip + 2.0 * sqrt(moved));
    if (hand - step * most).length_squared() <= moved + beyond {
        return most;
    }
    // The root of ‖h − s x‖² = (‖h‖ + slip)²: not above `most`, for there it lies beyond.
    let (along, squared) = (hand.dot(step), step.length_squared());
    (along + sqrt(along * along + squared * beyond)) / squared
}

/// From one pose to another: the way, and the rotation as the vector and the scalar of its quaternion.
pub(super) fn stretch(from: &BodyPose, to: &BodyPose) -> (Vec3, (Vec3, f32)) {
    let [x, y, z, w] = from.orientation;
    let [a, b, c, s] = product(&to.orientation, &[-x, -y, -z, w]);
    (Vec3::from_array(to.position) - Vec3::from_array(from.position), (vec3(a, b, c), s))
}
