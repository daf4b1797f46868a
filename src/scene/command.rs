//! A host's commands to a scene, applied between two ticks, and the reasons for refusing one.

use super::frame::axes;
use super::scene::Scene;
use super::state::SceneState;
use crate::body::Body;
use crate::device::Kinematics;
use crate::math::{Vec3, inverse_sqrt, vec3};
use crate::patch::{Patch, SplinePatch};
use crate::render::{Feel, FeelPart, Friction};
use crate::servo::{
    DialState, Guard, Hertzian, Knob, KnobError, KnobWitness, OnePatch, Phase, Servo, ServoState, SoftBody,
    SoftContact, Surface,
};
use crate::track::Placement;
use thiserror::Error;

/// Where a body is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BodyPose {
    /// Its origin, metres, in the scene.
    pub position: [f32; 3],
    /// Its orientation as a unit quaternion: x, y, z, w.
    pub orientation: [f32; 4],
}

/// A command, applied whole between two ticks or not at all. Bodies go by their index in the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Command {
    /// A resting body is somewhere else: [`crate::scene::Scene::place`].
    Place {
        /// Which.
        body: u8,
        /// Where.
        pose: BodyPose,
    },
    /// A resting body is there by now, and moves on as [`Self::Move`] has it: [`crate::scene::Scene::lead`]. For a
    /// motion that the host gives, pose by pose.
    Lead {
        /// Which.
        body: u8,
        /// Where.
        pose: BodyPose,
        /// Of its origin, m/s.
        velocity: [f32; 3],
        /// rad/s.
        angular_velocity: [f32; 3],
        /// For how long, unless another order comes, seconds.
        seconds: f32,
    },
    /// A resting body moves on from where it is: [`crate::scene::Scene::move_along`].
    Move {
        /// Which.
        body: u8,
        /// Of its origin, m/s.
        velocity: [f32; 3],
        /// rad/s.
        angular_velocity: [f32; 3],
        /// For how long; then it rests, seconds.
        seconds: f32,
    },
    /// Bodies of these groups are on, all others off, group 0 the lowest bit: [`crate::scene::Scene::switch`].
    Switch {
        /// The groups.
        groups: u32,
    },
    /// Group `index` alone is on; of a knob, this feel: [`crate::servo::Event::Chosen`].
    Choose {
        /// Which.
        index: u8,
    },
    /// Another stiffness and damping: [`crate::scene::Scene::harden`].
    Harden {
        /// Which.
        body: u8,
        /// N/m.
        stiffness: f32,
        /// N·s/m.
        damping: f32,
    },
    /// Other friction, by [`crate::render::Friction`]'s four numbers in their order, or none:
    /// [`crate::scene::Scene::rub`].
    Rub {
        /// Which.
        body: u8,
        /// The numbers.
        friction: Option<[f32; 4]>,
    },
    /// A tool with a tip of another radius: [`crate::scene::Scene::set_tip_radius`].
    Tip {
        /// Metres.
        radius: f32,
    },
    /// Maximum force of the whole scene, at most [`crate::scene::Limits::max_force_n`]. The change gives no step.
    Limit {
        /// N.
        force: f32,
    },
    /// A force of the host's own, added to that of the bodies, in the scene's frame; at most
    /// [`crate::scene::Limits::max_force_n`]. It lasts [`crate::scene::HOLD`] seconds, unless the host repeats it.
    Push {
        /// N.
        force: [f32; 3],
    },
    /// The body that was uploaded last takes the place of this one: [`crate::scene::Slot`].
    Take {
        /// Which.
        body: u8,
    },
    /// The body that was built in takes this one's place again: [`crate::scene::Scene::put_back`].
    PutBack {
        /// Which.
        body: u8,
    },
    /// A part of a knob's feel: [`crate::servo::Knob::set`].
    Feel(FeelPart),
}

/// Which choice is refused.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SceneError {
    /// No body, or more than 32.
    #[error("a scene has 1 to 32 bodies")]
    Bodies,
    /// A shared limit is not positive, or not finite.
    #[error("the scene's limits must be positive and finite")]
    Limits,
    /// A stiffness is out of range. Where several bodies may be touched, two of them must be within it together.
    #[error("body {0}: the stiffness must be between 0 and the maximum, together with that of the stiffest other body")]
    Stiffness(u8),
    /// A damping is out of range.
    #[error("body {0}: the damping must be between 0 and the maximum")]
    Damping(u8),
    /// Friction is negative, not finite, or holds more slipping than sticking.
    #[error("body {0}: friction must be finite and not negative, its dynamic coefficient not above the static one")]
    Friction(u8),
    /// A number of an effect is out of range, see [`crate::render::Effects::check`].
    #[error("body {0}: an effect or its limit of force is out of range")]
    Effects(u8),
    /// Axes that are not orthonormal, a number that is not finite, no mass.
    #[error("body {0}: its motion has axes that are not orthonormal, a number that is not finite, or no mass")]
    Motion(u8),
    /// A free body is lighter than its stiffness, damping and friction allow at this rate.
    #[error("body {0}: it is too light for its stiffness, damping and friction at this rate")]
    Light(u8),
    /// The damping along a free body's surface is less than its stiffness there times half a tick.
    #[error("body {0}: friction on a free body needs a damping of at least its stiffness times half a tick")]
    Slack(u8),
    /// A sphere that is not finite.
    #[error("body {0}: its sphere must have a finite centre and a radius")]
    Sphere(u8),
    /// A group of 32 and more.
    #[error("body {0}: groups are 0 to 31")]
    Group(u8),
    /// There is no such body.
    #[error("there is no body {0}")]
    Missing(u8),
    /// A placement that is no rigid motion, or of a body that does not rest.
    #[error("body {0}: only a resting body is placed, with orthonormal axes and finite numbers")]
    Placement(u8),
    /// The radius of a tool's tip is negative or not finite.
    #[error("the radius of the tip must be finite and not negative")]
    TipRadius,
    /// A body is to move faster than [`crate::scene::Limits::max_speed_m_per_s`].
    #[error("body {0}: it may not be moved faster than the scene's bodies are met at most")]
    TooFast(u8),
    /// A force of the host's, or a limit of the force, that is negative, not finite or above
    /// [`crate::scene::Limits::max_force_n`].
    #[error("a force must be finite and at most the scene's maximum")]
    Force,
    /// The surface does not support this command.
    #[error("this surface does not support the command")]
    NotOffered,
    /// There is no body that was uploaded, or it does not go there.
    #[error("body {0}: nothing was uploaded for it")]
    NotUploaded(u8),
    /// A part of a knob's feel.
    #[error("{0}")]
    Feel(KnobError),
    /// A body file has no modes, so nothing is uploaded in the place of a body that deforms.
    #[error("body {0}: it deforms, and a body file has no modes; build the other body in")]
    Deforms(u8),
    /// [`crate::scene::Scene::harden`] to a stiffness out of range.
    #[error("body {body}: the stiffness must be between 0 and {max_n_per_m} N/m, effects included")]
    TooStiff {
        /// Which.
        body: u8,
        /// The scene's limit, less the stiffness of the stiffest other body that may be touched with it, N/m.
        max_n_per_m: f32,
    },
    /// The same of its damping.
    #[error("body {body}: the damping must be between 0 and {max_n_s_per_m} N·s/m, effects included")]
    TooDamped {
        /// Which.
        body: u8,
        /// The scene's limit, N·s/m.
        max_n_s_per_m: f32,
    },
}

impl SceneError {
    /// The text without a body's number, for a panic at compile time.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Bodies => "a scene has 1 to 32 bodies",
            Self::Limits => "the scene's limits must be positive and finite",
            Self::Stiffness(_) | Self::TooStiff { .. } => {
                "the stiffness must be between 0 and the maximum, together with that of the stiffest other body"
            }
            Self::Damping(_) | Self::TooDamped { .. } => "the damping must be between 0 and the maximum",
            Self::Friction(_) => {
                "friction must be finite and not negative, its dynamic coefficient not above the static one"
            }
            Self::Effects(_) => "an effect or its limit of force is out of range",
            Self::Motion(_) => "its motion has axes that are not orthonormal, a number that is not finite, or no mass",
            Self::Light(_) => "it is too light for its stiffness, damping and friction at this rate",
            Self::Slack(_) => "friction on a free body needs a damping of at least its stiffness times half a tick",
            Self::Sphere(_) => "its sphere must have a finite centre and a radius",
            Self::Group(_) => "groups are 0 to 31",
            Self::Missing(_) => "there is no such body",
            Self::Placement(_) => "only a resting body is placed, with orthonormal axes and finite numbers",
            Self::TipRadius => "the radius of the tip must be finite and not negative",
            Self::TooFast(_) => "it may not be moved faster than the scene's bodies are met at most",
            Self::Force => "a force must be finite and at most the scene's maximum",
            Self::NotOffered => "this surface does not support the command",
            Self::NotUploaded(_) => "nothing was uploaded for it",
            Self::Feel(error) => error.message(),
            Self::Deforms(_) => "it deforms, and a body file has no modes; build the other body in",
        }
    }
}

impl BodyPose {
    /// The placement, at rest; `None` where the quaternion is not of length 1, within a thousandth.
    pub fn placement(&self) -> Option<Placement> {
        let squared = self.norm_squared();
        if !is_near_one(squared) {
            return None;
        }
        let scale = inverse_sqrt(squared);
        let axes = axes(&self.orientation.map(|number| number * scale));
        Some(Placement { axes, origin: Vec3::from_array(self.position), ..Placement::IDENTITY })
    }

    /// Whether it has a placement, and a position of finite numbers.
    pub(crate) fn is_sound(&self) -> bool {
        is_near_one(self.norm_squared()) && self.position.iter().all(|coordinate| coordinate.is_finite())
    }

    fn norm_squared(&self) -> f32 {
        let [x, y, z, w] = self.orientation;
        x * x + y * y + z * z + w * w
    }
}

/// Whether the square of a quaternion's length is 1, within a thousandth of the length; a NaN is not.
fn is_near_one(squared: f32) -> bool {
    (squared - 1.0).abs() <= 2e-3
}

/// A surface that takes commands of a host.
pub trait Commanded: Surface {
    /// Applies a command between two ticks, or changes nothing. Bounded work.
    ///
    /// # Errors
    /// [`SceneError::NotOffered`] unless the surface takes this command, or the value that is out of range.
    fn apply(&self, witness: &mut Self::Witness, command: &Command) -> Result<(), SceneError> {
        let _ = (witness, command);
        Err(SceneError::NotOffered)
    }

    /// The dial as it is, of a knob whose joint is at an angle, radians.
    fn dial(&self, witness: &Self::Witness, joint_rad: f32, phase: Phase) -> Option<DialState> {
        let _ = (witness, joint_rad, phase);
        None
    }

    /// The feel that a host has set, of a knob.
    fn feel(&self, witness: &Self::Witness) -> Option<Feel> {
        let _ = witness;
        None
    }

    /// Starts with a feel that a host has set before ([`Knob::restore`]), or changes nothing.
    ///
    /// # Errors
    /// [`SceneError::NotOffered`] unless the surface is a knob, or the value that is out of range.
    fn restore(&self, witness: &mut Self::Witness, feel: Feel) -> Result<(), SceneError> {
        let _ = (witness, feel);
        Err(SceneError::NotOffered)
    }
}

impl<const KINDS: u32> Commanded for Body<'_, crate::field::Rigid<KINDS>> {}

/// A body file has no modes: nothing is uploaded in the place of a body that deforms.
impl Commanded for SoftBody<'_> {
    fn apply(&self, _: &mut SoftContact, command: &Command) -> Result<(), SceneError> {
        match command {
            Command::Take { body } | Command::PutBack { body } if !self.soft().modes().is_empty() => {
                Err(SceneError::Deforms(*body))
            }
            _ => Err(SceneError::NotOffered),
        }
    }
}

impl Commanded for SplinePatch<'_> {}

impl<S: Commanded> Commanded for Hertzian<'_, S> {
    fn apply(&self, witness: &mut S::Witness, command: &Command) -> Result<(), SceneError> {
        self.surface().apply(witness, command)
    }
}

impl<P: Patch> Commanded for OnePatch<P> {}

/// A knob takes [`Command::Choose`] of an entry that it has, and [`Command::Feel`].
impl Commanded for Knob {
    fn apply(&self, witness: &mut KnobWitness, command: &Command) -> Result<(), SceneError> {
        match command {
            Command::Choose { index } => {
                // A table has 1 to 255 entries.
                let last = (self.feels().len() - usize::from(witness.own().is_none())) as u8;
                if *index > last {
                    return Err(SceneError::Feel(KnobError::Missing { asked: *index, last }));
                }
                self.choose(witness, *index);
                Ok(())
            }
            Command::Feel(part) => self.set(witness, *part).map_err(SceneError::Feel),
            _ => Err(SceneError::NotOffered),
        }
    }

    fn dial(&self, witness: &KnobWitness, joint_rad: f32, phase: Phase) -> Option<DialState> {
        Some(Self::dial(self, witness, joint_rad, phase))
    }

    fn feel(&self, witness: &KnobWitness) -> Option<Feel> {
        witness.own().copied()
    }

    fn restore(&self, witness: &mut KnobWitness, feel: Feel) -> Result<(), SceneError> {
        Self::restore(self, witness, feel).map_err(SceneError::Feel)
    }
}

impl<S: Commanded, K: Kinematics<JOINTS>, const JOINTS: usize, G: Guard<JOINTS>> Servo<'_, S, K, JOINTS, G> {
    /// Applies a host's command between two ticks, or changes nothing. It neither drives a motor nor ends a fault: its
    /// force comes in the ticks that follow, as far as there is force at all.
    ///
    /// # Errors
    /// The value that is out of range, or a command that the surface does not take.
    pub fn apply(
        &self,
        state: &mut ServoState<JOINTS, S::Witness, G::State>,
        command: &Command,
    ) -> Result<(), SceneError> {
        self.surface().apply(state.witness_mut(), command)
    }

    /// Starts with a feel that a host has set before, or changes nothing. Before the first tick only.
    ///
    /// # Errors
    /// The value that is out of range, or a surface that is no knob.
    pub fn restore(&self, state: &mut ServoState<JOINTS, S::Witness, G::State>, feel: Feel) -> Result<(), SceneError> {
        self.surface().restore(state.witness_mut(), feel)
    }

    /// The dial as it is, of a knob. A fault ends its torque; the angle goes on.
    pub fn dial(&self, state: &ServoState<JOINTS, S::Witness, G::State>) -> Option<DialState> {
        self.surface().dial(state.witness(), *state.angles().first()?, state.phase())
    }

    /// The feel that a host has set, of a knob.
    pub fn own_feel(&self, state: &ServoState<JOINTS, S::Witness, G::State>) -> Option<Feel> {
        self.surface().feel(state.witness())
    }
}

impl<S: Commanded, const N: usize> Commanded for Scene<'_, S, N> {
    fn apply(&self, state: &mut SceneState<S::Witness, N>, command: &Command) -> Result<(), SceneError> {
        match *command {
            Command::Place { body, pose } => {
                let placement = pose.placement().ok_or(SceneError::Placement(body))?;
                self.place(state, usize::from(body), placement)
            }
            Command::Lead { body, pose, velocity, angular_velocity, seconds } => {
                let placement = pose.placement().ok_or(SceneError::Placement(body))?;
                let motion = [velocity, angular_velocity].map(Vec3::from_array);
                // Whether it may move so is seen before it is anywhere else.
                self.may_move(usize::from(body), &placement, motion, seconds)?;
                self.lead(state, usize::from(body), placement)?;
                self.move_along(state, usize::from(body), motion, seconds)
            }
            Command::Move { body, velocity, angular_velocity, seconds } => {
                let motion = [velocity, angular_velocity].map(Vec3::from_array);
                self.move_along(state, usize::from(body), motion, seconds)
            }
            Command::Switch { groups } => {
                self.switch(state, groups);
                Ok(())
            }
            Command::Choose { index } if index > 31 => Err(SceneError::Group(index)),
            Command::Choose { index } => {
                self.choose(state, index);
                Ok(())
            }
            Command::Harden { body, stiffness, damping } => self.harden(state, usize::from(body), stiffness, damping),
            Command::Rub { body, friction } => {
                let friction = friction.map(|[stiffness, damping, static_coefficient, dynamic_coefficient]| Friction {
                    stiffness_n_per_m: stiffness,
                    damping_n_s_per_m: damping,
                    static_coefficient,
                    dynamic_coefficient,
                });
                self.rub(state, usize::from(body), friction)
            }
            Command::Tip { radius } => self.set_tip_radius(state, radius),
            Command::Limit { force } => state.host.set_limit(self.limits(), force),
            Command::Push { force: [x, y, z] } => state.host.push(self.limits(), vec3(x, y, z)),
            Command::Take { body } => self.take(state, usize::from(body)),
            Command::PutBack { body } => self.put_back(state, usize::from(body)),
            Command::Feel(_) => Err(SceneError::NotOffered),
        }
    }
}
