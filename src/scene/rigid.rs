//! A body that is free: a mass and its inertia, held to the world by a joint, a spring, or nothing.
//!
//! # The step
//!
//! A push is held over a tick of length `h`. The state is the velocity `v` of the centre of mass and the angular
//! momentum `L` about it, both in the world's frame. The damping, `c`, acts at the middle of the tick: with `u` the
//! mean of `v` and `v'`, `m (v' − v)/h = F − c u` is `u − v = (F − c v)/(2m/h + c)`, and `x' = x + h u`. Multiplied by
//! `h u`: `½ m v'² − ½ m v² = F · (x' − x) − h c u²`, exactly. **The body gains the work of the push over the body's
//! displacement, less the damped energy**: as a port it is passive at any `h` and `m` and at no negative `c`. The same
//! holds of its turning, in the body's principal axes, with `L`, `I` and the mean angular velocity.
//!
//! A spring that is pulled at the start of the tick, where its potential `U` has a second derivative of at most `k`,
//! gives `U' ≤ U + ∇U · Δx + ½ k Δx²` (the descent lemma), which is `½ k h² u²` too much: a damper of `c = ½ k h` takes
//! exactly that. For a linear spring it is the implicit midpoint rule. So the tether, the turning spring and a hinge's
//! weight are passive, too, at any stiffness.
//!
//! The turning itself remains: with no torque `L` stays, and the body is turned by the mean angular velocity of the
//! tick, to second order. Rounding and the third order change the energy of that `L`: the state keeps its initial
//! energy and the input since then, and where the energy rises beyond their sum, `L` is scaled down. So the energy of
//! the whole never rises beyond the push's work by more than rounding.

use super::frame::{Frame, axes};
use super::path::{dot, finite, is_rigid};
use crate::math::{Vec3, product, quaternion, saturate, sqrt, turned_by, vec3};
use crate::track::Placement;

/// A body with a mass, its suspension, and its initial placement. Start with [`RigidBody::new`].
///
/// ```
/// use palpate::math::{Vec3, vec3};
/// use palpate::scene::{Joint, Motion, RigidBody};
/// use palpate::track::Placement;
///
/// /// A slider of 200 g along x, damped.
/// const SLIDER: RigidBody = RigidBody {
///     joint: Joint::Slider(Vec3::X),
///     damping_n_s_per_m: 2.0,
///     ..RigidBody::new(Placement::IDENTITY, 0.2, vec3(1e-4, 1e-4, 1e-4))
/// };
/// let motion = Motion::Free(SLIDER);
/// # let _ = motion;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBody {
    /// Where it starts, and how it moves then.
    pub start: Placement,
    /// kg.
    pub mass_kg: f32,
    /// Moments of inertia about axes through the centre of mass along those of the body's frame, kg·m²: these must be
    /// principal ones.
    pub inertia_kg_m2: Vec3,
    /// The centre of mass in the body's frame, metres.
    pub centre_m: Vec3,
    /// How it may move.
    pub joint: Joint,
    /// Acceleration of gravity, m/s².
    pub gravity_m_per_s2: Vec3,
    /// Linear damping, N·s/m.
    pub damping_n_s_per_m: f32,
    /// Angular damping, N·m·s/rad.
    pub angular_damping_n_m_s_per_rad: f32,
    /// The spring that pulls the centre of mass back.
    pub tether: Option<Tether>,
    /// The spring that turns a [`Joint::Free`] or [`Joint::Hinge`] body back to its initial orientation, N·m/rad for
    /// small angles; the torque is that times the sine of the angle.
    pub angular_stiffness_n_m_per_rad: f32,
}

/// How a body may move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Joint {
    /// Every way.
    Free,
    /// Not at all: fixed to the world where it starts.
    Fixed,
    /// Along a unit vector of the world's frame, without turning.
    Slider(Vec3),
    /// About an axis that is fixed in the world.
    Hinge {
        /// A unit vector.
        axis: Vec3,
        /// A point of it, metres.
        pivot: Vec3,
    },
}

/// A spring from the centre of mass to a place in the world: slack within a box, stiff beyond it. Without slack it is a
/// spring; with a large slack and stiff, it is the walls of a container.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tether {
    /// The middle, metres.
    pub anchor_m: Vec3,
    /// How far it is slack to either side along each axis, metres.
    pub slack_m: Vec3,
    /// N/m.
    pub stiffness_n_per_m: f32,
    /// N·s/m, everywhere.
    pub damping_n_s_per_m: f32,
}

/// How a free body moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moving {
    /// Its orientation, a unit quaternion: the vector, then the scalar.
    orientation: [f32; 4],
    /// The centre of mass, metres.
    position: Vec3,
    /// Its velocity, m/s.
    velocity: Vec3,
    /// Angular momentum about it, kg·m²/s, in the world's frame; of a hinge about the pivot.
    momentum: Vec3,
    /// Twice the permitted energy of its turning, J: the initial energy and the input since then.
    turning: f32,
}

/// A force on a body, and its torque about the centre of mass. N, N·m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// N.
    pub force: Vec3,
    /// N·m.
    pub torque: Vec3,
}

impl RigidBody {
    /// A free body without gravity, damping or springs.
    pub const fn new(start: Placement, mass: f32, inertia: Vec3) -> Self {
        Self {
            start,
            mass_kg: mass,
            inertia_kg_m2: inertia,
            centre_m: Vec3::ZERO,
            joint: Joint::Free,
            gravity_m_per_s2: Vec3::ZERO,
            damping_n_s_per_m: 0.0,
            angular_damping_n_m_s_per_rad: 0.0,
            tether: None,
            angular_stiffness_n_m_per_rad: 0.0,
        }
    }

    /// Before the first tick.
    pub fn rest(&self) -> Moving {
        let Placement { origin, velocity, angular_velocity, .. } = self.start;
        let arm = self.start.direction_to_a(self.centre_m);
        let position = origin + arm;
        let (velocity, momentum) = match self.joint {
            Joint::Free => (velocity + angular_velocity.cross(arm), self.momentum(&self.start, angular_velocity)),
            Joint::Fixed => (Vec3::ZERO, Vec3::ZERO),
            Joint::Slider(axis) => (axis * axis.dot(velocity), Vec3::ZERO),
            Joint::Hinge { axis, pivot } => {
                let rate = axis.dot(angular_velocity);
                ((axis * rate).cross(position - pivot), axis * (rate * self.hinge_inertia(axis, pivot)))
            }
        };
        let along = self.start.direction_to_b(momentum);
        let turning = along.dot(along / self.inertia_kg_m2);
        Moving { orientation: quaternion(&self.start.axes), position, velocity, momentum, turning }
    }

    /// A tick of `period` seconds later, under a push that was held over it.
    pub fn step(&self, state: &mut Moving, push: &Wrench, period: f32) {
        match self.joint {
            Joint::Fixed => {}
            Joint::Hinge { axis, pivot } => self.swing(state, axis, pivot, push, period),
            Joint::Slider(axis) => self.travel(state, Some(axis), push.force, period),
            Joint::Free => {
                self.travel(state, None, push.force, period);
                self.turn(state, push.torque, period);
            }
        }
    }

    /// Where the body's frame is.
    pub fn placement(&self, state: &Moving) -> Placement {
        self.frame(state).placement()
    }

    /// The same, with the centre of mass for a pivot.
    pub(super) fn frame(&self, state: &Moving) -> Frame {
        let axes = axes(&state.orientation);
        let mut frame = Frame {
            axes,
            pivot: state.position,
            offset: -self.centre_m,
            velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
        };
        frame.angular_velocity = match self.joint {
            Joint::Free => frame.to_scene(frame.to_body(state.momentum) / self.inertia_kg_m2),
            Joint::Hinge { axis, pivot } => state.momentum * (1.0 / self.hinge_inertia(axis, pivot)),
            Joint::Fixed | Joint::Slider(_) => Vec3::ZERO,
        };
        frame.velocity = state.velocity + state.position.cross(frame.angular_velocity);
        frame
    }

    /// Kinetic energy and that of weight, tether and turning spring, J.
    pub fn energy(&self, state: &Moving) -> f32 {
        let placement = self.placement(state);
        let turning = 0.5 * placement.angular_velocity.dot(state.momentum);
        let kinetic = match self.joint {
            Joint::Hinge { .. } => turning,
            _ => 0.5 * self.mass_kg * state.velocity.length_squared() + turning,
        };
        let mut potential =
            -self.mass_kg * self.gravity_m_per_s2.dot(state.position - self.start.point_to_a(self.centre_m));
        if let Some(tether) = &self.tether
            && !matches!(self.joint, Joint::Hinge { .. })
        {
            potential += 0.5 * tether.stiffness_n_per_m * tether.stretch(state.position).length_squared();
        }
        let [x, y, z, _] = self.turned(state);
        kinetic + potential + 2.0 * self.angular_stiffness_n_m_per_rad * vec3(x, y, z).length_squared()
    }

    /// By how much a unit force along `direction` at `point` of the world moves that point along it, per kg⁻¹: the
    /// inverse of the effective mass there.
    pub(super) fn mobility(&self, state: &Moving, frame: &Frame, point: Vec3, direction: Vec3) -> f32 {
        match self.joint {
            Joint::Fixed => 0.0,
            Joint::Slider(axis) => {
                let along = axis.dot(direction);
                along * along / self.mass_kg
            }
            Joint::Hinge { axis, pivot } => {
                let lever = axis.dot((point - pivot).cross(direction));
                lever * lever / self.hinge_inertia(axis, pivot)
            }
            Joint::Free => {
                let lever = frame.to_body((point - state.position).cross(direction));
                1.0 / self.mass_kg + lever.dot(lever / self.inertia_kg_m2)
            }
        }
    }

    /// No less than [`Self::mobility`] anywhere within `radius` of a point of the body's frame.
    pub(super) const fn max_mobility(&self, point: Vec3, radius: f32) -> f32 {
        let Vec3 { x, y, z, .. } = self.centre_m;
        let reach = radius + (point.x - x).abs() + (point.y - y).abs() + (point.z - z).abs();
        let least = least(self.inertia_kg_m2.x, least(self.inertia_kg_m2.y, self.inertia_kg_m2.z));
        1.0 / self.mass_kg + reach * reach / least
    }

    pub(super) const fn is_valid(&self) -> bool {
        let Vec3 { x, y, z, .. } = self.inertia_kg_m2;
        let has_axis = match self.joint {
            Joint::Free | Joint::Fixed => true,
            Joint::Slider(axis) => is_unit(axis),
            Joint::Hinge { axis, pivot } => is_unit(axis) && finite(pivot),
        };
        let tethered = match &self.tether {
            None => true,
            Some(Tether {
                anchor_m: anchor,
                slack_m: slack,
                stiffness_n_per_m: stiffness,
                damping_n_s_per_m: damping,
            }) => {
                finite(*anchor)
                    && is_size(slack.x)
                    && is_size(slack.y)
                    && is_size(slack.z)
                    && is_size(*stiffness)
                    && is_size(*damping)
            }
        };
        let heavy = self.mass_kg > 0.0 && x > 0.0 && y > 0.0 && z > 0.0 && finite(self.inertia_kg_m2);
        heavy
            && self.mass_kg < f32::INFINITY
            && finite(self.centre_m)
            && finite(self.gravity_m_per_s2)
            && has_axis
            && tethered
            && is_size(self.damping_n_s_per_m)
            && is_size(self.angular_damping_n_m_s_per_rad)
            && is_size(self.angular_stiffness_n_m_per_rad)
            && is_rigid(&self.start)
    }

    /// The centre of mass, along a line or every way.
    fn travel(&self, state: &mut Moving, axis: Option<Vec3>, push: Vec3, period: f32) {
        let mut force = push + self.gravity_m_per_s2 * self.mass_kg;
        let mut damping = self.damping_n_s_per_m;
        if let Some(tether) = &self.tether {
            force -= tether.stretch(state.position) * tether.stiffness_n_per_m;
            damping += tether.damping_n_s_per_m + 0.5 * period * tether.stiffness_n_per_m;
        }
        if let Some(axis) = axis {
            force = axis * axis.dot(force);
        }
        // Half the change: the error of a rounded factor cancels over a swing; with the mean itself it would not.
        let change = (force - state.velocity * damping) * (1.0 / (2.0 * self.mass_kg / period + damping));
        state.position += (state.velocity + change) * period;
        state.velocity += change * 2.0;
    }

    /// The body about its centre of mass.
    fn turn(&self, state: &mut Moving, torque: Vec3, period: f32) {
        let inertia = self.inertia_kg_m2;
        let frame = of_axes(axes(&state.orientation));
        let mut torque = torque;
        if self.angular_stiffness_n_m_per_rad > 0.0 {
            let [x, y, z, scalar] = self.turned(state);
            torque -= vec3(x, y, z) * (2.0 * self.angular_stiffness_n_m_per_rad * scalar);
        }
        let damping = self.angular_damping_n_m_s_per_rad + 0.5 * period * self.angular_stiffness_n_m_per_rad;
        let momentum = frame.to_body(state.momentum);
        let torque = frame.to_body(torque);
        let inertial = inertia * (2.0 / period);
        let mean = (momentum * (2.0 / period) + torque) / (inertial + Vec3::splat(damping));
        // Only the change is added: without a torque there is no rounding.
        let change = (torque - mean * damping) * period;
        let pushed = momentum + change;
        state.momentum += frame.to_scene(change);
        state.turning += 2.0 * change.dot(mean);
        // The mean of the tick, to second order: in the body's frame momentum turns as well.
        let middle = mean + (pushed.cross(pushed / inertia) / inertia) * (0.5 * period);
        let half = frame.to_scene(middle) * (0.5 * period);
        state.orientation = turned_by(half, &state.orientation);
        let after = of_axes(axes(&state.orientation)).to_body(state.momentum);
        let risen = after.dot(after / inertia);
        if risen > state.turning {
            state.momentum *= sqrt(saturate(state.turning / risen, 0.0, 1.0));
        }
    }

    /// A hinge.
    fn swing(&self, state: &mut Moving, axis: Vec3, pivot: Vec3, push: &Wrench, period: f32) {
        let inertia = self.hinge_inertia(axis, pivot);
        let arm = state.position - pivot;
        let weight = self.gravity_m_per_s2 * self.mass_kg;
        let mut torque = axis.dot(push.torque + arm.cross(push.force + weight));
        // The second derivative of the weight's potential is at most `m g r`.
        let steep = sqrt(weight.length_squared() * arm.length_squared());
        if self.angular_stiffness_n_m_per_rad > 0.0 {
            let [x, y, z, scalar] = self.turned(state);
            torque -= axis.dot(vec3(x, y, z)) * (2.0 * self.angular_stiffness_n_m_per_rad * scalar);
        }
        let damping = self.angular_damping_n_m_s_per_rad + 0.5 * period * (self.angular_stiffness_n_m_per_rad + steep);
        let rate = axis.dot(state.momentum) / inertia;
        let change = (torque - damping * rate) / (2.0 * inertia / period + damping);
        state.momentum += axis * (2.0 * inertia * change);
        state.orientation = turned_by(axis * (0.5 * period * (rate + change)), &state.orientation);
        let turned = of_axes(axes(&state.orientation));
        // From where it started, so that it never drifts off the pivot.
        let start = self.start.direction_to_b(self.start.point_to_a(self.centre_m) - pivot);
        state.position = pivot + turned.to_scene(start);
        state.velocity = (axis * (rate + 2.0 * change)).cross(state.position - pivot);
    }

    /// How far it has turned since the start, as a quaternion of the world's frame whose scalar is not negative.
    fn turned(&self, state: &Moving) -> [f32; 4] {
        let [x, y, z, w] = quaternion(&self.start.axes);
        let [a, b, c, s] = product(&state.orientation, &[-x, -y, -z, w]);
        if s < 0.0 { [-a, -b, -c, -s] } else { [a, b, c, s] }
    }

    fn hinge_inertia(&self, axis: Vec3, pivot: Vec3) -> f32 {
        let along = self.start.direction_to_b(axis);
        let arm = axis.cross(self.start.point_to_a(self.centre_m) - pivot);
        (along * along).dot(self.inertia_kg_m2) + self.mass_kg * arm.length_squared()
    }

    fn momentum(&self, placement: &Placement, angular_velocity: Vec3) -> Vec3 {
        placement.direction_to_a(placement.direction_to_b(angular_velocity) * self.inertia_kg_m2)
    }
}

impl Tether {
    /// How far beyond the slack, metres.
    #[inline]
    fn stretch(&self, position: Vec3) -> Vec3 {
        let off = position - self.anchor_m;
        let beyond = |off: f32, slack: f32| off - saturate(off, -slack, slack);
        vec3(beyond(off.x, self.slack_m.x), beyond(off.y, self.slack_m.y), beyond(off.z, self.slack_m.z))
    }
}

impl Moving {
    /// The centre of mass, metres.
    pub const fn position(&self) -> Vec3 {
        self.position
    }

    /// Its velocity, m/s.
    pub const fn velocity(&self) -> Vec3 {
        self.velocity
    }

    /// Angular momentum about it, of a hinge about the pivot, kg·m²/s, in the world's frame.
    pub const fn momentum(&self) -> Vec3 {
        self.momentum
    }

    pub(super) fn for_each_word(&self, mut take: impl FnMut(u32)) {
        for number in self.orientation {
            take(number.to_bits());
        }
        take(self.turning.to_bits());
        for vector in [self.position, self.velocity, self.momentum] {
            for number in vector.to_array() {
                take(number.to_bits());
            }
        }
    }
}

/// A frame at the origin.
#[inline]
const fn of_axes(axes: [Vec3; 3]) -> Frame {
    let none = Vec3::ZERO;
    Frame { axes, pivot: none, offset: none, velocity: none, angular_velocity: none }
}

const fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

const fn is_size(x: f32) -> bool {
    x >= 0.0 && x < f32::INFINITY
}

const fn is_unit(vector: Vec3) -> bool {
    (dot(vector, vector) - 1.0).abs() < 1e-4
}
