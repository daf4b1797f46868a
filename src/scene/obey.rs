//! What a scene does with an order.

use super::frame::axes;
use super::scene::Scene;
use super::state::SceneState;
use crate::math::{Vec3, inverse_sqrt, vec3};
use crate::order::{Order, Pose, SceneError};
use crate::render::Friction;
use crate::servo::Surface;
use crate::track::Placement;

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
                    stiffness_n_per_m: stiffness,
                    damping_n_s_per_m: damping,
                    static_coefficient,
                    dynamic_coefficient,
                });
                self.rub(state, usize::from(body), friction)
            }
            Order::Tip { radius } => self.set_tip_radius(state, radius),
            Order::Limit { force } => state.host.set_limit(self.limits(), force),
            Order::Push { force: [x, y, z] } => state.host.push(self.limits(), vec3(x, y, z)),
            Order::Take { body } => self.take(state, usize::from(body)),
            Order::PutBack { body } => self.put_back(state, usize::from(body)),
        }
    }
}
