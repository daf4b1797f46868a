//! Changes of a scene between two ticks while it is rendered. None of them steps the force.

use super::frame::Frame;
use super::part::{Motion, Part, PartState};
use super::path::{finite, is_rigid};
use super::scene::Scene;
use super::state::SceneState;
use super::{Command, Commanded, SceneError};
use crate::math::{Vec3, sqrt};
use crate::render::Friction;
use crate::servo::{Surface, Tracked as _};
use crate::track::{Contact, Placement};

/// Ticks that a placement from outside may be late: as far as a body comes in these it is led, not put.
const LATE: f32 = 4.0;

impl<S: Surface, const N: usize> Scene<'_, S, N> {
    /// Another stiffness (N/m) and damping (N·s/m) for a body. The force moves to the new one without a step.
    ///
    /// # Errors
    /// The value that is out of range; nothing changes then.
    pub fn harden(
        &self,
        state: &mut SceneState<S::Witness, N>,
        index: usize,
        stiffness: f32,
        damping: f32,
    ) -> Result<(), SceneError> {
        let Some(part) = state.parts.get(index) else { return Err(SceneError::Missing(saturated(index))) };
        let friction = part.friction;
        let beside = self.stiffest_now(state, index);
        let limits = self.limits();
        self.check(index, [stiffness, beside], damping, friction.as_ref()).map_err(|error| match error {
            SceneError::Stiffness(body) => {
                SceneError::TooStiff { body, max_n_per_m: limits.max_stiffness_n_per_m - beside }
            }
            SceneError::Damping(body) => SceneError::TooDamped { body, max_n_s_per_m: limits.max_damping_n_s_per_m },
            other => other,
        })?;
        (state.parts[index].stiffness, state.parts[index].damping) = (stiffness, damping);
        state.switched = true;
        Ok(())
    }

    /// Other friction for a body, or none. The force moves to the new one without a step.
    ///
    /// # Errors
    /// The value that is out of range; nothing changes then.
    pub fn rub(
        &self,
        state: &mut SceneState<S::Witness, N>,
        index: usize,
        friction: Option<Friction>,
    ) -> Result<(), SceneError> {
        let Some(part) = state.parts.get(index) else { return Err(SceneError::Missing(saturated(index))) };
        let (stiffness, damping) = (part.stiffness, part.damping);
        self.check(index, [stiffness, self.stiffest_now(state, index)], damping, friction.as_ref())?;
        state.parts[index].friction = friction;
        state.switched = true;
        Ok(())
    }

    /// Moves a resting body to another place: its force fades out, and it gives none until the tool has been in front
    /// of it.
    ///
    /// # Errors
    /// An invalid placement, or a body that moves by itself; nothing changes then.
    pub fn place(
        &self,
        state: &mut SceneState<S::Witness, N>,
        index: usize,
        placement: Placement,
    ) -> Result<(), SceneError> {
        let Some(part) = self.parts.get(index) else { return Err(SceneError::Missing(saturated(index))) };
        if !matches!(part.motion, Motion::Resting(_)) || !is_rigid(&placement) {
            return Err(SceneError::Placement(saturated(index)));
        }
        state.parts[index].frame = Frame::new(&placement);
        state.parts[index].way = 0;
        self.forget(state, index);
        Ok(())
    }

    /// Guides a resting body: its placement and motion in the next tick. For a motion that is given from outside tick
    /// by tick and agrees with its velocity. A placement farther away than the maximum speed allows in four ticks is
    /// another place, as in [`Self::place`]: a body that jumps into the hand does not push it.
    ///
    /// # Errors
    /// As [`Self::place`].
    pub fn lead(
        &self,
        state: &mut SceneState<S::Witness, N>,
        index: usize,
        placement: Placement,
    ) -> Result<(), SceneError> {
        let Some(Part { motion: Motion::Resting(_), sphere, .. }) = self.parts.get(index) else {
            return self.place(state, index, placement);
        };
        let (before, after) = (state.parts[index].frame, Frame::new(&placement));
        let radius = if sphere.radius_m < f32::INFINITY { sphere.radius_m } else { 0.0 };
        let turned = [0, 1, 2].map(|axis| (after.axes[axis] - before.axes[axis]).length_squared());
        let moved = after.point_to_scene(sphere.centre_m) - before.point_to_scene(sphere.centre_m);
        // A turn takes the axes together no less far than any unit vector.
        let way = moved.length() + radius * sqrt(turned[0] + turned[1] + turned[2]);
        if way <= LATE * self.limits.max_speed_m_per_s / self.limits.rate_hz && is_rigid(&placement) {
            (state.parts[index].frame, state.parts[index].way) = (after, 0);
            return Ok(());
        }
        self.place(state, index, placement)
    }

    /// Moves a resting body on from where it is, at these velocities of its origin (m/s) and about it (rad/s), for a
    /// number of seconds; then it rests there.
    ///
    /// # Errors
    /// A body that moves by itself, numbers that are not finite, or faster than the scene's maximum speed; nothing
    /// changes then.
    pub fn move_along(
        &self,
        state: &mut SceneState<S::Witness, N>,
        index: usize,
        [velocity, angular_velocity]: [Vec3; 2],
        seconds: f32,
    ) -> Result<(), SceneError> {
        let Some(PartState { frame, .. }) = state.parts.get(index) else {
            return Err(SceneError::Missing(saturated(index)));
        };
        let frame = self.may_move(index, &frame.placement(), [velocity, angular_velocity], seconds)?;
        // Saturates: some days at 100 kHz.
        (state.parts[index].frame, state.parts[index].way) = (frame, (seconds * self.limits.rate_hz) as u32);
        if state.parts[index].way == 0 {
            state.parts[index].rest_here();
        }
        state.switched = true;
        Ok(())
    }

    /// The frame of a resting body that is there and moves so.
    pub(super) fn may_move(
        &self,
        index: usize,
        here: &Placement,
        [velocity, angular_velocity]: [Vec3; 2],
        seconds: f32,
    ) -> Result<Frame, SceneError> {
        let number = saturated(index);
        let Some(part) = self.parts.get(index) else { return Err(SceneError::Missing(number)) };
        let is_finite = finite(velocity) && finite(angular_velocity) && (0.0..f32::INFINITY).contains(&seconds);
        if !matches!(part.motion, Motion::Resting(_)) || !is_finite || !is_rigid(here) {
            return Err(SceneError::Placement(number));
        }
        let frame = Frame::new(&Placement { velocity, angular_velocity, ..*here });
        let radius = if part.sphere.radius_m < f32::INFINITY { part.sphere.radius_m } else { 0.0 };
        let middle = frame.velocity_at(frame.point_to_scene(part.sphere.centre_m));
        let fastest = middle.length() + radius * angular_velocity.length();
        if fastest <= self.limits.max_speed_m_per_s { Ok(frame) } else { Err(SceneError::TooFast(number)) }
    }

    /// Switches groups on and off: those of these bits, group 0 the lowest. The force of a body that is switched off
    /// fades out; a body that is switched on gives none until the tool has been in front of it.
    pub fn switch(&self, state: &mut SceneState<S::Witness, N>, groups: u32) {
        let changed = groups ^ state.groups;
        state.groups = groups;
        for index in 0..N {
            if changed & self.bit(index) != 0 {
                self.forget(state, index);
            }
        }
    }

    /// Sets the radius of the tool's tip, metres. A body that only the larger tip would touch gives no force until the
    /// tip has been in front of it.
    ///
    /// # Errors
    /// An invalid radius; nothing changes then.
    pub fn set_tip_radius(&self, state: &mut SceneState<S::Witness, N>, radius: f32) -> Result<(), SceneError> {
        if !(0.0..f32::INFINITY).contains(&radius) {
            return Err(SceneError::TipRadius);
        }
        state.tip_radius = radius;
        for part in &mut state.parts {
            part.gap = part.witness.gap() - radius;
            if part.contact == Contact::InFront && part.gap < 0.0 {
                part.contact = Contact::Behind;
            }
        }
        state.switched = true;
        Ok(())
    }

    /// The stiffness of the stiffest body beside this one, as it is now, N/m.
    fn stiffest_now(&self, state: &SceneState<S::Witness, N>, index: usize) -> f32 {
        let beside = state.parts.iter().zip(&self.parts).enumerate().filter(|(other, _)| *other != index);
        let each = beside.map(|(_, (now, part))| part.material.steepest(now.stiffness, self.limits().max_force_n));
        each.fold(0.0, |stiffest, its| if its > stiffest { its } else { stiffest })
    }

    pub(super) fn forget(&self, state: &mut SceneState<S::Witness, N>, index: usize) {
        let part = &mut state.parts[index];
        self.parts[index].surface.release(&mut part.witness);
        (part.contact, part.rests) = (Contact::Behind, 0);
        state.switched = true;
    }
}

impl<S: Commanded, const N: usize> Scene<'_, S, N> {
    /// Replaces this body by the last uploaded one: the old force fades out, and the new body gives none until the tool
    /// has been in front of it.
    ///
    /// # Errors
    /// No body was uploaded, or not for this slot; nothing changes then.
    pub fn take(&self, state: &mut SceneState<S::Witness, N>, index: usize) -> Result<(), SceneError> {
        self.exchange(state, index, &Command::Take { body: saturated(index) })
    }

    /// The body that was built in takes the place of this one again, as [`Self::take`] has it.
    ///
    /// # Errors
    /// A body that is always the one built in; nothing changes then.
    pub fn put_back(&self, state: &mut SceneState<S::Witness, N>, index: usize) -> Result<(), SceneError> {
        self.exchange(state, index, &Command::PutBack { body: saturated(index) })
    }

    fn exchange(
        &self,
        state: &mut SceneState<S::Witness, N>,
        index: usize,
        command: &Command,
    ) -> Result<(), SceneError> {
        let (Some(part), Some(kept)) = (self.parts.get(index), state.parts.get_mut(index)) else {
            return Err(SceneError::Missing(saturated(index)));
        };
        part.surface.apply(&mut kept.witness, command)?;
        self.forget(state, index);
        Ok(())
    }
}

pub(super) fn saturated(index: usize) -> u8 {
    u8::try_from(index).unwrap_or(u8::MAX)
}
