//! The drawn tool, held outside the body: a god-object in six degrees of freedom.

use super::contact::{Manifold, ToolContact};
use super::coupling::{ToolCoupling, share_within, stretch};
use super::location::Location;
use super::tool::Tool;
use super::tracker::{JUMP, ToolStatus, ToolWitness};
use crate::body::Body;
use crate::math::{Vec3, turned_by};
use crate::scene::{BodyPose, Wrench};
use crate::track::Placement;
use core::fmt;

/// Of the radius: contact is given up where the core is nearer to the body than the rest.
const GIVEN_UP: f32 = 0.5;
/// Of the jump that a tracker notices: how far the tool goes in a tick from where it was located to the hand.
const STRIDE: f32 = 0.25;
/// Radians, of the same.
const STRIDE_RAD: f32 = 0.05;

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
    /// The closest pair is not known: it is not located yet, the location was stopped short, or the tracker lost it.
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
    /// Finds the contacts at a pose that the hand has had, some steps a tick; and why they were not known before.
    Locating(Location, ProxyError),
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
    /// is spread over ticks too: a cold query of a point in each, or steps of a pair, beside a body that is not convex
    /// some `cells` evaluations of them. It ends within some hundred ticks.
    pub fn tick_located(
        &mut self,
        body: &Body,
        tool: &Tool,
        coupling: &ToolCoupling,
        hand: &BodyPose,
        cells: u16,
    ) -> Wrench {
        match &mut self.stage {
            &mut ProxyStage::GivenUp(error) if self.share <= 0.0 || self.wrench == Wrench::default() => {
                if let Some(placement) = placement_of(hand).filter(|_| tool.is_thick()) {
                    let stage = ProxyStage::Locating(Location::START, error);
                    *self = Self::with(ToolWitness::unlocated(&placement), *hand, stage);
                }
                Wrench::default()
            }
            ProxyStage::Locating(location, _) => {
                let before = location.evaluations();
                location.tick(body, tool, &mut self.state, cells);
                self.evaluations = location.evaluations() - before;
                if location.is_done() {
                    self.stage = match location.closest(&self.state, tool).status {
                        // Short of its end the nearest found is held, and the audit goes on.
                        ToolStatus::AtRest | ToolStatus::StepLimit => ProxyStage::Approaching,
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
        if !hand.is_sound() {
            return Err(ProxyError::Pose);
        }
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
        // Not by `ok_or`, which would move the placement twice.
        let Some(placement) = placement_of(&self.pose) else { return Err(ProxyError::Pose) };
        let found = body.step_tool_with(tool, &mut self.state, &placement, cells, true);
        (self.distance, self.evaluations) = (found.distance, found.evaluations);
        match found.status {
            ToolStatus::Following | ToolStatus::AtRest => {}
            ToolStatus::Inside => return Err(ProxyError::Intersects),
            _ => return Err(ProxyError::Lost),
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
        if !hand.is_sound() {
            return Err(ProxyError::Pose);
        }
        let Some(placement) = placement_of(&self.pose) else { return Err(ProxyError::Pose) };
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

    /// Why there is no contact: it was given up, is not located (again) yet, or the tool lies in the body.
    pub const fn given_up(&self) -> Option<ProxyError> {
        match self.stage {
            ProxyStage::GivenUp(error) | ProxyStage::Locating(_, error) => Some(error),
            ProxyStage::Approaching if self.distance < 0.0 => Some(ProxyError::Intersects),
            ProxyStage::Approaching | ProxyStage::Holding => None,
        }
    }

    /// Whether all contacts are known, and the drawn tool is held outside.
    pub const fn is_holding(&self) -> bool {
        matches!(self.stage, ProxyStage::Holding)
    }

    /// Whether all contacts are known. A tool that lies in the body then is not held before it has been outside.
    pub const fn is_located(&self) -> bool {
        matches!(self.stage, ProxyStage::Approaching | ProxyStage::Holding)
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
    if pose.is_sound() { pose.placement() } else { None }
}
