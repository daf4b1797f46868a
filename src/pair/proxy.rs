//! The drawn tool, held outside the body: a god-object in six degrees of freedom, and the virtual coupling to the hand.

use super::contact::{MAX_CONTACTS, Manifold, ToolContact};
use super::location::Location;
use super::tool::Tool;
use super::tracker::{JUMP, ToolStatus, ToolWitness};
use crate::body::Body;
use crate::math::{Vec3, product, sqrt, turned_by, vec3};
use crate::scene::{BodyPose, Wrench};
use crate::track::Placement;
use core::fmt;

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
/// Maximum sweeps over the contacts, without friction and with it.
const SWEEPS: [u8; 2] = [6, 12];
/// Change of all contacts' forces in a sweep, N, after which no other follows.
const SETTLED_N: [f32; 2] = [1.0e-3, 1.0e-4];
/// Steps below, m and rad, are not taken where there is friction.
const HELD: [f32; 2] = [1.0e-8, 1.0e-6];
/// Maximum rounds in which gaps that the sweeps leave closed are pushed open, and how far one may stay closed, metres.
const REPAIRS: u8 = 4;
const CLOSED_M: f32 = 1.0e-7;
/// Of the radius: contact is given up where the core is nearer to the body than the rest.
const GIVEN_UP: f32 = 0.5;
/// Of the jump that a tracker notices: how far the tool goes in a tick from where it was located to the hand.
const STRIDE: f32 = 0.25;
/// Radians, of the same.
const STRIDE_RAD: f32 = 0.05;

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
    /// Of the proxy in a tick, m and rad.
    max_step: [f32; 2],
    /// Of the wrench in a tick, by a proxy that slips, N and N·m.
    max_slip: [f32; 2],
    /// By which the share of a given-up wrench falls in a tick.
    fade_step: f32,
    /// Coefficient `μ` of dry friction.
    friction: f32,
}

/// Why a proxy is not started, or was given up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ProxyError {
    /// The radius of the tool is below 1 % of its core's largest half length, or 0.
    Thin,
    /// Stiffness or rate of the coupling are not positive and finite.
    Coupling,
    /// The coefficient of friction is not from 0 to 2.
    Friction,
    /// The hand's pose is not finite, or its quaternion not of length 1.
    Pose,
    /// Tool and body intersect.
    Intersects,
    /// The closest pair is not known: the location was stopped short, or the tracker lost it.
    Lost,
}

/// The proxy, and the state of its contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proxy {
    pose: BodyPose,
    hand: BodyPose,
    state: ToolWitness,
    manifold: Manifold,
    distance: f32,
    evaluations: u32,
    stage: ProxyStage,
    /// The last wrench on the hand before contact was given up, and the share of it that is still given.
    wrench: Wrench,
    share: f32,
}

/// The stages of a proxy. Only the one that holds gives a wrench of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ProxyStage {
    /// Finds the contacts at a pose that the hand has had, a step a tick.
    Locating(Location),
    /// Follows them from there to the hand.
    Approaching,
    /// Holds the drawn tool outside of the body.
    Holding,
    GivenUp(ProxyError),
}

impl fmt::Display for ProxyError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Thin => "radius: a tool for contact needs at least 1 % of its core's largest half length",
            Self::Coupling => "coupling: stiffness and rate must be positive and finite",
            Self::Friction => "friction: the coefficient must be from 0 to 2",
            Self::Pose => "pose: needs finite numbers and a quaternion of length 1",
            Self::Intersects => "pose: tool and body intersect; move the tool out of the body",
            Self::Lost => "the closest pair is not known; start the proxy again",
        })
    }
}

impl core::error::Error for ProxyError {}

impl ToolCoupling {
    /// A spring of a stiffness in N/m and one in N·m/rad, in a loop of `rate_hz`; `None` unless all are positive and
    /// finite.
    pub const fn new(stiffness_n_per_m: f32, stiffness_n_m_per_rad: f32, rate_hz: f32) -> Option<Self> {
        if !is_positive(stiffness_n_per_m) || !is_positive(stiffness_n_m_per_rad) || !is_positive(rate_hz) {
            return None;
        }
        let fade = 1.0 / (FADE_S * rate_hz);
        Some(Self {
            stiffness_n_per_m,
            stiffness_n_m_per_rad,
            period_s: 1.0 / rate_hz,
            max_step: in_a_tick(SPEED, STEP, rate_hz),
            max_slip: in_a_tick(SLIP, SLIP_STEP, rate_hz),
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
            Some(coupling) => Some(Self { stiffness_n_m_per_rad: f32::INFINITY, ..coupling }),
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
    fn settle(
        &self,
        proxy: &BodyPose,
        [before, hand]: [&BodyPose; 2],
        contacts: &mut [ToolContact],
        radius: f32,
    ) -> BodyPose {
        // An infinite stiffness gives 0: no contact turns the proxy.
        let soft = [1.0 / self.stiffness_n_per_m, 1.0 / self.stiffness_n_m_per_rad];
        let (way, (vector, scalar)) = stretch(proxy, hand);
        let mut free = Step { way, turn: vector * (2.0 * scalar), soft };
        if self.friction > 0.0 {
            self.press::<true>(&mut free, contacts, radius);
        } else {
            self.press::<false>(&mut free, contacts, radius);
        }
        let Step { way, turn, .. } = free;
        let (moved, (turned, _)) = stretch(before, hand);
        let [slip, slip_turn] = [0, 1].map(|axis| self.max_slip[axis] * soft[axis]);
        let length = |vector: Vec3| sqrt(vector.length_squared());
        let least = |one: f32, other: f32| if one < other { one } else { other };
        // One factor for both, so that the step still lowers the spring's energy.
        let max_way = least(self.max_step[0], length(moved) + slip);
        let mut share;
        if self.has_torque() {
            let turned = turned * 2.0;
            share = share_within([way, turn], [max_way, least(self.max_step[1], length(turned) + slip_turn)]);
            share = share_behind(turned, turn, slip_turn, share);
        } else {
            share = share_within([way, turn], [max_way, self.max_step[1]]);
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

    /// The contacts' forces by projected Gauss-Seidel, and the step that they leave.
    fn press<const HOLDS: bool>(&self, step: &mut Step, contacts: &mut [ToolContact], radius: f32) {
        let mut all = [Pressed::NONE; MAX_CONTACTS];
        for (contact, pressed) in contacts.iter().zip(&mut all) {
            *pressed = Pressed::new::<HOLDS>(contact, step.soft, radius);
            step.push(contact.normal * pressed.normal, pressed.lever * pressed.normal);
            if HOLDS {
                step.push(pressed.along, pressed.at.cross(pressed.along));
            }
        }
        for _ in 0..SWEEPS[usize::from(HOLDS)] {
            let mut most = 0.0_f32;
            if HOLDS {
                for (contact, pressed) in contacts.iter().zip(&mut all) {
                    let changed = pressed.hold(step, contact.normal, self.friction);
                    most = if changed > most { changed } else { most };
                }
            }
            // Last, for no gap may close.
            for (contact, pressed) in contacts.iter().zip(&mut all) {
                let changed = pressed.press(step, contact);
                most = if changed > most { changed } else { most };
            }
            // One contact without friction is solved at once.
            let is_solved = contacts.len() < 2 && !HOLDS;
            if is_solved || most <= SETTLED_N[usize::from(HOLDS)] {
                break;
            }
        }
        // What the sweeps leave closed is pushed open: gaps count more than the last of a force.
        for _ in 0..REPAIRS {
            let mut most = 0.0_f32;
            for (contact, pressed) in contacts.iter().zip(&mut all) {
                let closed = -pressed.gap(step, contact);
                if closed > 0.0 {
                    let more = closed * pressed.stiff[0];
                    step.push(contact.normal * more, pressed.lever * more);
                    pressed.normal += more;
                    most = if closed > most { closed } else { most };
                }
            }
            if most <= CLOSED_M {
                break;
            }
        }
        for (contact, pressed) in contacts.iter_mut().zip(&all) {
            contact.force = contact.normal * pressed.normal;
            if HOLDS {
                contact.force = contact.force + pressed.along;
            }
        }
    }
}

/// A step of the proxy: a way and a rotation, and how far a force and a torque move it, m/N and rad/(N·m).
struct Step {
    way: Vec3,
    turn: Vec3,
    soft: [f32; 2],
}

/// What is found of a contact: its force along the normal and along the body, N.
#[derive(Clone, Copy)]
struct Pressed {
    normal: f32,
    along: Vec3,
    /// The torque of a unit force along the normal, and the place on the tool that touches, metres.
    lever: Vec3,
    at: Vec3,
    /// Newtons that undo a metre along the normal, and along the body.
    stiff: [f32; 2],
}

impl Step {
    #[inline]
    fn push(&mut self, force: Vec3, torque: Vec3) {
        (self.way, self.turn) = (self.way + force * self.soft[0], self.turn + torque * self.soft[1]);
    }
}

impl Pressed {
    const NONE: Self = Self { normal: 0.0, along: Vec3::ZERO, lever: Vec3::ZERO, at: Vec3::ZERO, stiff: [0.0; 2] };

    fn new<const HOLDS: bool>(contact: &ToolContact, [soft, softer]: [f32; 2], radius: f32) -> Self {
        let stiff = |lever: Vec3| 1.0 / (soft + softer * lever.length_squared());
        let (lever, force) = (contact.lever(), contact.force.dot(contact.normal));
        let normal = if force > 0.0 { force } else { 0.0 };
        let pressed = Self { normal, lever, stiff: [stiff(lever), 0.0], ..Self::NONE };
        if !HOLDS {
            return pressed;
        }
        let at = contact.arm - contact.normal * radius;
        Self { along: along(contact.force, contact.normal), at, stiff: [pressed.stiff[0], stiff(at)], ..pressed }
    }

    /// The linearised gap at the end of a step, metres.
    #[inline]
    fn gap(&self, step: &Step, contact: &ToolContact) -> f32 {
        contact.gap + contact.normal.dot(step.way) + self.lever.dot(step.turn)
    }

    /// Keeps the linearised gap open. Returns by how much the force has changed, N.
    #[inline]
    fn press(&mut self, step: &mut Step, contact: &ToolContact) -> f32 {
        let wanted = self.normal - self.gap(step, contact) * self.stiff[0];
        let next = if wanted > 0.0 { wanted } else { 0.0 };
        let more = next - self.normal;
        if more.abs() > 0.0 {
            step.push(contact.normal * more, self.lever * more);
            self.normal = next;
        }
        more.abs()
    }

    /// Holds the place that touches, as far as the cone lets it.
    #[inline]
    fn hold(&mut self, step: &mut Step, normal: Vec3, friction: f32) -> f32 {
        let slid = along(step.way + step.turn.cross(self.at), normal);
        let wanted = self.along - slid * self.stiff[1];
        let next = wanted * share_within([wanted, Vec3::ZERO], [friction * self.normal, 0.0]);
        let more = next - self.along;
        step.push(more, self.at.cross(more));
        self.along = next;
        more.abs().max_element()
    }
}

/// The part of a vector across a unit normal.
fn along(vector: Vec3, normal: Vec3) -> Vec3 {
    vector - normal * normal.dot(vector)
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
fn share_within(vectors: [Vec3; 2], limits: [f32; 2]) -> f32 {
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
fn stretch(from: &BodyPose, to: &BodyPose) -> (Vec3, (Vec3, f32)) {
    let [x, y, z, w] = from.orientation;
    let [a, b, c, s] = product(&to.orientation, &[-x, -y, -z, w]);
    (Vec3::from_array(to.position) - Vec3::from_array(from.position), (vec3(a, b, c), s))
}

impl Proxy {
    /// The proxy at the hand's pose in the frame of the body's tables. Locates all contacts first: for set-up, not for a
    /// tick.
    ///
    /// # Errors
    /// A tool that is too thin, a pose that is none, and tools that do not lie outside the body.
    pub fn start(body: &Body, tool: &Tool, hand: &BodyPose) -> Result<Self, ProxyError> {
        if !tool.is_thick() {
            return Err(ProxyError::Thin);
        }
        let placement = placement_of(hand).ok_or(ProxyError::Pose)?;
        let (state, found) = body.locate_tool(tool, &placement);
        match found.status {
            ToolStatus::AtRest if found.distance >= 0.0 => {
                Ok(Self { evaluations: found.evaluations, ..Self::with(state, *hand, ProxyStage::Holding) })
            }
            ToolStatus::AtRest | ToolStatus::Inside => Err(ProxyError::Intersects),
            _ => Err(ProxyError::Lost),
        }
    }

    /// A proxy that locates its contacts tick by tick, from the first tick on: for a loop, in which the hand's pose is not
    /// known before and the work of a tick is bounded. There is no wrench until all are located, the proxy has gone to
    /// the hand, and the hand's tool is outside of the body: [`Self::is_holding`].
    pub const fn unlocated() -> Self {
        let pose = BodyPose { position: [0.0; 3], orientation: [0.0, 0.0, 0.0, 1.0] };
        // Given up with nothing to fade: the first tick locates.
        Self::with(ToolWitness::unlocated(&Placement::IDENTITY), pose, ProxyStage::GivenUp(ProxyError::Lost))
    }

    const fn with(state: ToolWitness, pose: BodyPose, stage: ProxyStage) -> Self {
        Self {
            pose,
            hand: pose,
            state,
            manifold: Manifold::NONE,
            distance: 0.0,
            evaluations: 0,
            stage,
            wrench: Wrench { force: Vec3::ZERO, torque: Vec3::ZERO },
            share: 1.0,
        }
    }

    /// As [`Self::tick`], but contact that was given up is located again once the wrench has faded, and the work of that
    /// is spread over ticks too: one cold query of a point or one step of a pair in each.
    pub fn tick_located(
        &mut self,
        body: &Body,
        tool: &Tool,
        coupling: &ToolCoupling,
        hand: &BodyPose,
        cells: u16,
    ) -> Wrench {
        match &mut self.stage {
            ProxyStage::GivenUp(_) if self.share <= 0.0 || self.wrench == Wrench::default() => {
                if let Some(placement) = placement_of(hand).filter(|_| tool.is_thick()) {
                    *self =
                        Self::with(ToolWitness::unlocated(&placement), *hand, ProxyStage::Locating(Location::START));
                }
                Wrench::default()
            }
            ProxyStage::Locating(location) => {
                let before = location.evaluations();
                location.step(body, tool, &mut self.state, false);
                self.evaluations = location.evaluations() - before;
                if location.is_done() {
                    self.stage = match location.closest(&self.state, tool).status {
                        ToolStatus::AtRest => ProxyStage::Approaching,
                        ToolStatus::Inside => ProxyStage::GivenUp(ProxyError::Intersects),
                        _ => ProxyStage::GivenUp(ProxyError::Lost),
                    };
                }
                Wrench::default()
            }
            ProxyStage::Approaching => {
                if let Err(error) = self.approach(body, tool, hand, cells) {
                    self.stage = ProxyStage::GivenUp(error);
                }
                Wrench::default()
            }
            ProxyStage::GivenUp(_) | ProxyStage::Holding => self.tick(body, tool, coupling, hand, cells),
        }
    }

    /// A stride to the hand, with the contacts. There it holds, once the tool is outside.
    fn approach(&mut self, body: &Body, tool: &Tool, hand: &BodyPose, cells: u16) -> Result<(), ProxyError> {
        placement_of(hand).ok_or(ProxyError::Pose)?;
        let (away, (vector, scalar)) = stretch(&self.pose, hand);
        let stride = STRIDE * JUMP * body.size();
        let reach = tool.extents().max_element();
        let max_turn = if stride < STRIDE_RAD * reach { stride / reach } else { STRIDE_RAD };
        let turn = vector * (2.0 * scalar);
        let share = share_within([away, turn], [stride, max_turn]);
        let is_there = share >= 1.0 && scalar.abs() > 0.9;
        self.pose = if is_there {
            *hand
        } else {
            BodyPose {
                position: (Vec3::from_array(self.pose.position) + away * share).to_array(),
                orientation: turned_by(turn * (0.5 * share), &self.pose.orientation),
            }
        };
        self.hand = *hand;
        let placement = placement_of(&self.pose).ok_or(ProxyError::Pose)?;
        let found = body.step_tool_with(tool, &mut self.state, &placement, cells, true);
        (self.distance, self.evaluations) = (found.distance, found.evaluations);
        if !matches!(found.status, ToolStatus::Following | ToolStatus::AtRest) {
            return Err(ProxyError::Lost);
        }
        if is_there && found.distance >= 0.0 {
            self.stage = ProxyStage::Holding;
        }
        Ok(())
    }

    /// One tick: follows the contacts of the proxy, lets it go towards the hand as far as they let it, and gives the
    /// wrench on the hand about the origin of the tool's frame. Once contact is given up the last one fades within 5 ms,
    /// and there is none until the proxy is started again: the hand's pose is none, the tracker lost the pair, or the
    /// core is nearer to the body than half the radius. `cells` as in [`Body::step_tool`].
    pub fn tick(&mut self, body: &Body, tool: &Tool, coupling: &ToolCoupling, hand: &BodyPose, cells: u16) -> Wrench {
        if self.is_holding()
            && let Err(error) = self.follow(body, tool, coupling, hand, cells)
        {
            self.stage = ProxyStage::GivenUp(error);
        }
        if !self.is_holding() {
            let left = self.share - coupling.fade_step;
            self.share = if left > 0.0 { left } else { 0.0 };
            let Wrench { force, torque } = self.wrench;
            return Wrench { force: force * self.share, torque: torque * self.share };
        }
        let Wrench { force, torque } = coupling.wrench(&self.pose, hand);
        self.wrench = Wrench { force: -force, torque: -torque };
        self.wrench
    }

    fn follow(
        &mut self,
        body: &Body,
        tool: &Tool,
        coupling: &ToolCoupling,
        hand: &BodyPose,
        cells: u16,
    ) -> Result<(), ProxyError> {
        let (Some(_), Some(placement)) = (placement_of(hand), placement_of(&self.pose)) else {
            return Err(ProxyError::Pose);
        };
        let found = body.step_tool_with(tool, &mut self.state, &placement, cells, true);
        (self.distance, self.evaluations) = (found.distance, found.evaluations);
        let is_known = matches!(found.status, ToolStatus::Following | ToolStatus::AtRest);
        if !is_known || found.distance < -GIVEN_UP * tool.radius() {
            return Err(ProxyError::Lost);
        }
        self.state.collect(&mut self.manifold, body, tool, &placement, coupling.max_step);
        self.manifold.recall(body.size());
        self.pose = coupling.settle(&self.pose, [&self.hand, hand], self.manifold.contacts_mut(), tool.radius());
        self.manifold.remember();
        self.hand = *hand;
        Ok(())
    }

    /// Where the tool is drawn, in the frame of the body's tables.
    pub const fn pose(&self) -> &BodyPose {
        &self.pose
    }

    /// The contacts of the last tick, as they were before the proxy moved.
    pub fn contacts(&self) -> &[ToolContact] {
        self.manifold.contacts()
    }

    /// Evaluations of patches that the last tick has spent, or the start.
    pub const fn evaluations(&self) -> u32 {
        self.evaluations
    }

    /// Why contact was given up, if it was.
    pub const fn given_up(&self) -> Option<ProxyError> {
        match self.stage {
            ProxyStage::GivenUp(error) => Some(error),
            _ => None,
        }
    }

    /// Whether all contacts are known, and the drawn tool is held outside.
    pub const fn is_holding(&self) -> bool {
        matches!(self.stage, ProxyStage::Holding)
    }

    /// From the drawn tool to the hand's, metres: zero unless a contact holds the one.
    pub fn stretch(&self) -> Vec3 {
        if self.is_holding() { stretch(&self.pose, &self.hand).0 } else { Vec3::ZERO }
    }

    /// Distance of the drawn tool from the body, metres: in the last tick, before the proxy moved. Negative where the
    /// ball around the core is in the body.
    pub const fn distance(&self) -> f32 {
        self.distance
    }

    /// From the core's witness point to the body's, metres, in the last tick.
    pub fn difference(&self) -> Vec3 {
        self.state.pair().difference(self.state.placement())
    }

    /// The contacts' tracker.
    pub const fn tracker(&self) -> &ToolWitness {
        &self.state
    }
}

/// The placement of a pose whose numbers are finite.
fn placement_of(pose: &BodyPose) -> Option<Placement> {
    pose.placement().filter(|placement| placement.origin.is_finite())
}
