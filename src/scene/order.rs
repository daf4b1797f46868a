//! What a host may ask of what is felt, between two ticks.

use super::frame::axes;
use super::limits::SceneError;
use super::scene::Scene;
use super::state::SceneState;
use crate::math::{Vec3, inverse_sqrt, vec3};
use crate::render::Friction;
use crate::servo::Surface;
use crate::track::Placement;

/// Where a body is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pose {
    /// Its origin, metres, in the scene.
    pub position: [f32; 3],
    /// Its orientation as a unit quaternion: x, y, z, w.
    pub orientation: [f32; 4],
}

/// An order, applied whole between two ticks or not at all. Bodies go by their index in the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Order {
    /// A resting body is somewhere else: [`Scene::place`].
    Place {
        /// Which.
        body: u8,
        /// Where.
        pose: Pose,
    },
    /// A resting body is there by now, and moves on as [`Self::Move`] has it: [`Scene::lead`]. For a motion that the
    /// host gives, pose by pose.
    Lead {
        /// Which.
        body: u8,
        /// Where.
        pose: Pose,
        /// Of its origin, m/s.
        velocity: [f32; 3],
        /// rad/s.
        angular_velocity: [f32; 3],
        /// For how long, unless another order comes, seconds.
        seconds: f32,
    },
    /// A resting body moves on from where it is: [`Scene::move_along`].
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
    /// Bodies of these groups are on, all others off, group 0 the lowest bit: [`Scene::switch`].
    Switch {
        /// The groups.
        groups: u32,
    },
    /// Group `index` alone is on; of a knob, this feel: [`crate::servo::Event::Chosen`].
    Choose {
        /// Which.
        index: u8,
    },
    /// Another stiffness and damping: [`Scene::harden`].
    Harden {
        /// Which.
        body: u8,
        /// N/m.
        stiffness: f32,
        /// N·s/m.
        damping: f32,
    },
    /// Other friction, by [`Friction`]'s four numbers in their order, or none: [`Scene::rub`].
    Rub {
        /// Which.
        body: u8,
        /// The numbers.
        friction: Option<[f32; 4]>,
    },
    /// A tool with a tip of another radius: [`Scene::set_tip_radius`].
    Tip {
        /// Metres.
        radius: f32,
    },
    /// The greatest force of all of the scene, at most [`super::Limits::max_force`]. It comes without a step.
    Limit {
        /// N.
        force: f32,
    },
    /// A force of the host's own, added to that of the bodies, in the scene's frame; at most
    /// [`super::Limits::max_force`]. It stands for [`super::HOLD`] seconds, unless it is asked for anew.
    Push {
        /// N.
        force: [f32; 3],
    },
    /// The body that was uploaded last takes the place of this one: [`super::Slot`].
    Take {
        /// Which.
        body: u8,
    },
}

impl Pose {
    /// The placement, at rest; `None` where the quaternion is not of length 1, within a thousandth.
    pub fn placement(&self) -> Option<Placement> {
        let [x, y, z, w] = self.orientation;
        let squared = x * x + y * y + z * z + w * w;
        // What is not a number is neither.
        if !squared.is_finite() || (squared - 1.0).abs() > 2e-3 {
            return None;
        }
        let scale = inverse_sqrt(squared);
        let axes = axes(&self.orientation.map(|number| number * scale));
        Some(Placement { axes, origin: Vec3::from_array(self.position), ..Placement::IDENTITY })
    }
}

impl<S: Surface, const N: usize> Scene<'_, S, N> {
    /// Does what a host asks for, or nothing.
    ///
    /// # Errors
    /// What is out of range, by its body.
    pub fn obey(&self, state: &mut SceneState<S::Witness, N>, order: &Order) -> Result<(), SceneError> {
        match *order {
            Order::Place { body, pose } => {
                let placement = pose.placement().ok_or(SceneError::Placement(body))?;
                self.place(state, usize::from(body), placement)
            }
            Order::Lead { body, pose, velocity, angular_velocity, seconds } => {
                let placement = pose.placement().ok_or(SceneError::Placement(body))?;
                let motion = [velocity, angular_velocity].map(Vec3::from_array);
                // Whether it may move so is seen before it is anywhere else.
                self.may_move(usize::from(body), &placement, motion, seconds)?;
                self.lead(state, usize::from(body), placement)?;
                self.move_along(state, usize::from(body), motion, seconds)
            }
            Order::Move { body, velocity, angular_velocity, seconds } => {
                let motion = [velocity, angular_velocity].map(Vec3::from_array);
                self.move_along(state, usize::from(body), motion, seconds)
            }
            Order::Switch { groups } => {
                self.switch(state, groups);
                Ok(())
            }
            Order::Choose { index } if index > 31 => Err(SceneError::Group(index)),
            Order::Choose { index } => {
                self.choose(state, index);
                Ok(())
            }
            Order::Harden { body, stiffness, damping } => self.harden(state, usize::from(body), stiffness, damping),
            Order::Rub { body, friction } => {
                let friction = friction.map(|[stiffness, damping, static_coefficient, dynamic_coefficient]| Friction {
                    stiffness,
                    damping,
                    static_coefficient,
                    dynamic_coefficient,
                });
                self.rub(state, usize::from(body), friction)
            }
            Order::Tip { radius } => self.set_tip_radius(state, radius),
            Order::Limit { force } => state.host.set_limit(self.limits(), force),
            Order::Push { force: [x, y, z] } => state.host.push(self.limits(), vec3(x, y, z)),
            Order::Take { body } => self.take(state, usize::from(body)),
        }
    }
}
