//! A body of the scene: its surface, motion and feel; and its state between two ticks.

use super::frame::Frame;
use super::path::{Path, finite, is_rigid};
use super::rigid::{Moving, RigidBody, Wrench};
use crate::body::Body;
use crate::math::{Vec3, vec3};
use crate::render::{Anchor, Effects, Friction};
use crate::servo::{SoftBody, Tracked};
use crate::track::{Contact, Placement};

/// How a body moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// It rests, or is guided by [`super::Scene::lead`].
    Resting(Placement),
    /// It moves as prescribed.
    Prescribed(Path),
    /// It is free, and the tool pushes it.
    Free(RigidBody),
}

/// How a body feels.
#[derive(Clone, Copy, Debug)]
pub struct Material {
    /// Stiffness, N/m.
    pub stiffness_n_per_m: f32,
    /// Damping, N·s/m.
    pub damping_n_s_per_m: f32,
    /// Dry friction.
    pub friction: Option<Friction>,
    /// Texture, magnet, viscous layer and limit of force. By reference: most bodies have none.
    pub effects: Option<&'static Effects>,
}

impl Material {
    /// A spring and a damper.
    pub const fn new(stiffness: f32, damping: f32) -> Self {
        Self { stiffness_n_per_m: stiffness, damping_n_s_per_m: damping, friction: None, effects: None }
    }

    /// The steepest change of the force of a body of this stiffness with the tool's position, N/m.
    pub(super) const fn steepest(&self, stiffness: f32, max_force: f32) -> f32 {
        match self.effects {
            Some(effects) if effects.stiffness(max_force) > stiffness => effects.stiffness(max_force),
            _ => stiffness,
        }
    }
}

/// A ball that holds all of a body, in its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Metres.
    pub centre_m: Vec3,
    /// Metres.
    pub radius_m: f32,
}

/// A body of the scene.
#[derive(Debug)]
pub struct Part<'a, S> {
    /// Its surface, in its own frame.
    pub surface: &'a S,
    /// How it moves.
    pub motion: Motion,
    /// How it feels.
    pub material: Material,
    /// The sphere that contains the whole body.
    pub sphere: Sphere,
    /// The group it belongs to, 0 to 31, which can be switched on and off.
    pub group: u8,
}

impl<S> Clone for Part<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<S> Copy for Part<'_, S> {}

impl<'a, 'b> Part<'a, Body<'b>> {
    /// A body of group 0. Its sphere follows from its tables: no two points of a body are farther from each other than
    /// `√3` times its size. Set a smaller one if you know it.
    pub const fn new(body: &'a Body<'b>, motion: Motion, material: Material) -> Self {
        let sphere = match body.vertices() {
            [first, ..] => Sphere { centre_m: first.point, radius_m: 1.732_051 * body.size() },
            [] => Sphere { centre_m: Vec3::ZERO, radius_m: f32::INFINITY },
        };
        Self { surface: body, motion, material, sphere, group: 0 }
    }
}

impl<'a, 'b> Part<'a, SoftBody<'b>> {
    /// A body of group 0 that deforms; a rigid one beside it has no modes. Its sphere, of [`Part::new`], holds its
    /// motion too.
    pub const fn soft(body: &'a SoftBody<'b>, motion: Motion, material: Material) -> Self {
        let Sphere { centre_m, mut radius_m } = Part::new(body.soft().rest(), motion, material).sphere;
        let (modes, mut index) = (body.soft().modes(), 0);
        while index < modes.len() {
            radius_m += modes[index].limit * modes[index].bounds.motion;
            index += 1;
        }
        Self { surface: body, motion, material, sphere: Sphere { centre_m, radius_m }, group: 0 }
    }
}

impl<S> Part<'_, S> {
    fn frame(&self) -> Frame {
        match &self.motion {
            Motion::Resting(placement) => Frame::new(placement),
            Motion::Prescribed(path) => path.frame(),
            Motion::Free(body) => body.frame(&body.rest()),
        }
    }

    pub(super) const fn moves_well(&self) -> bool {
        match &self.motion {
            Motion::Resting(placement) => is_rigid(placement),
            Motion::Prescribed(path) => path.is_valid(),
            Motion::Free(body) => body.is_valid(),
        }
    }

    pub(super) const fn is_held(&self) -> bool {
        finite(self.sphere.centre_m) && self.sphere.radius_m >= 0.0
    }
}

/// The state of a body between two ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartState<W> {
    /// The state of its tracker, in the body's frame.
    pub(super) witness: W,
    /// Where it is.
    pub(super) frame: Frame,
    /// How it moves, where it is free.
    pub(super) moving: Moving,
    /// The push of the last tick.
    pub(super) push: Wrench,
    /// Where friction holds it, in its frame.
    pub(super) anchor: Anchor,
    /// Whether the tool touches it.
    pub(super) contact: Contact,
    /// From the tool to it, metres.
    pub(super) gap: f32,
    /// Its outward normal at the witness point, and the tool's velocity past it, in its frame.
    pub(super) normal: Vec3,
    pub(super) velocity: Vec3,
    /// Its force on the tool, N.
    pub(super) force: Vec3,
    pub(super) stiffness: f32,
    pub(super) damping: f32,
    pub(super) friction: Option<Friction>,
    /// For how many ticks more a resting body moves along.
    pub(super) way: u32,
    /// The tick of its last check.
    pub(super) seen: u32,
    /// Ticks from then on in which no look is due.
    pub(super) rests: u32,
    /// Whether the tracker lost it in this tick.
    pub(super) unexplained: bool,
}

impl<W: Tracked> PartState<W> {
    pub(super) fn new<S>(part: &Part<'_, S>, witness: W) -> Self {
        let frame = part.frame();
        let resting = RigidBody::new(Placement::IDENTITY, 1.0, vec3(1.0, 1.0, 1.0));
        let moving = match &part.motion {
            Motion::Free(body) => body.rest(),
            _ => resting.rest(),
        };
        Self {
            witness,
            frame,
            moving,
            push: Wrench::default(),
            anchor: Anchor::default(),
            contact: Contact::Behind,
            gap: 0.0,
            normal: Vec3::ZERO,
            velocity: Vec3::ZERO,
            force: Vec3::ZERO,
            stiffness: part.material.stiffness_n_per_m,
            damping: part.material.damping_n_s_per_m,
            friction: part.material.friction,
            way: 0,
            seen: 0,
            rests: 0,
            unexplained: false,
        }
    }

    /// The state of its tracker; points are in the body's own frame.
    pub const fn witness(&self) -> &W {
        &self.witness
    }

    /// Its placement at its last check: in this tick, if it is near.
    pub fn placement(&self) -> Placement {
        self.frame.placement()
    }

    /// How it moves, if it is free.
    pub const fn moving(&self) -> &Moving {
        &self.moving
    }

    /// Whether the tool touches it.
    pub const fn contact(&self) -> Contact {
        self.contact
    }

    /// From the tool's surface to it, metres; negative inside.
    pub const fn gap(&self) -> f32 {
        self.gap
    }

    /// Its force on the tool, N, in the scene's frame.
    pub const fn force(&self) -> Vec3 {
        self.force
    }

    /// Moves a resting body along for a number of ticks, `elapsed` seconds together; true once it has arrived.
    #[inline(never)]
    pub(super) fn go_along(&mut self, ticks: u32, elapsed: f32) -> bool {
        let share = if ticks > self.way { self.way as f32 / ticks as f32 } else { 1.0 };
        self.frame.go_along(elapsed * share);
        self.way = self.way.saturating_sub(ticks);
        if self.way == 0 {
            self.rest_here();
        }
        self.way == 0
    }

    /// No longer moves.
    pub(super) fn rest_here(&mut self) {
        (self.frame.velocity, self.frame.angular_velocity) = (Vec3::ZERO, Vec3::ZERO);
    }

    pub(super) fn for_each_word(&self, mut take: impl FnMut(u32)) {
        self.witness.for_each_word(&mut take);
        self.moving.for_each_word(&mut take);
        let Frame { axes: [a, b, c], pivot, offset, velocity, angular_velocity } = self.frame;
        let anchor = self.anchor.point.unwrap_or(Vec3::ZERO);
        let pushes = [self.push.force, self.push.torque, self.force, self.normal, self.velocity, anchor];
        for vector in [a, b, c, pivot, offset, velocity, angular_velocity].into_iter().chain(pushes) {
            for number in vector.to_array() {
                take(number.to_bits());
            }
        }
        for number in [self.gap, self.stiffness, self.damping] {
            take(number.to_bits());
        }
        let slippery = Friction {
            stiffness_n_per_m: 0.0,
            damping_n_s_per_m: 0.0,
            static_coefficient: 0.0,
            dynamic_coefficient: 0.0,
        };
        let Friction {
            stiffness_n_per_m: stiffness,
            damping_n_s_per_m: damping,
            static_coefficient,
            dynamic_coefficient,
        } = self.friction.unwrap_or(slippery);
        for number in [stiffness, damping, static_coefficient, dynamic_coefficient] {
            take(number.to_bits());
        }
        take(self.way);
        take(self.contact as u32 | u32::from(self.anchor.slips) << 8 | u32::from(self.unexplained) << 9);
        take(self.seen);
        take(self.rests);
    }
}
