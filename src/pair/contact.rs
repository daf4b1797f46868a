//! The contacts of a tool with a body: where, in which direction, and how far.

use super::parts::{Kind, Part};
use super::step::Pair;
use super::tool::{Tool, unit};
use super::tracker::ToolWitness;
use crate::body::Body;
use crate::math::{Vec3, sqrt, sqrt_from_above};
use crate::track::Placement;

/// Maximum contacts of a manifold.
pub const MAX_CONTACTS: usize = 6;
/// Relative to the body's size: arms that differ by less are one.
const SAME_ARM: f32 = 1.0e-3;
/// The same of a contact that goes on from one tick to the next.
const NEAR_ARM: f32 = 0.02;
/// Normals whose cosine is above this are one: an angle of 0.08 degrees.
const SAME_NORMAL: f32 = 1.0 - 1.0e-6;

/// A contact, in the frame of the body's tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolContact {
    /// Unit vector from the body's point to the core's: out of the body.
    pub normal: Vec3,
    /// From the origin of the tool's frame to the core's point, metres.
    pub arm: Vec3,
    /// Distance of the tool from the body, metres: the core's less the radius. Negative where the ball around the core
    /// is in the body.
    pub gap: f32,
    /// Of the body on the tool, N: what holds the drawn tool outside, with friction.
    pub force: Vec3,
}

/// The contacts that a tool can close in one tick: the pair first, then the core's corners, the corners and borders of the
/// body's face, the core's edges, and the rivals, the nearest of each first. None has both arm and normal of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manifold {
    contacts: [ToolContact; MAX_CONTACTS],
    count: u8,
    /// Arm and force of the contacts that pressed in the last tick.
    pressed: [[Vec3; 2]; MAX_CONTACTS],
    pressed_count: u8,
}

impl ToolContact {
    const NONE: Self = Self { normal: Vec3::ZERO, arm: Vec3::ZERO, gap: 0.0, force: Vec3::ZERO };

    /// The torque of a unit force along the normal about the origin of the tool's frame, metres.
    pub(super) fn lever(&self) -> Vec3 {
        self.arm.cross(self.normal)
    }

    /// Of a body's point and a core's, in the body's frame, if a translation of `reach_m` and a rotation of `reach_rad` can
    /// close its gap. `None` of one that the signs find on the far side of the body, or whose points coincide.
    fn of(a: Vec3, b: Vec3, within: &Within, is_outside: impl FnOnce(Vec3) -> bool) -> Option<Self> {
        let arm = within.placement.direction_to_a(b);
        let away = arm + within.placement.origin - a;
        let reach = within.reach_of(arm);
        let squared = away.length_squared();
        if squared > reach * reach || !is_outside(away) {
            return None;
        }
        Some(Self { normal: unit(away), arm, gap: sqrt(squared) - within.radius, force: Vec3::ZERO })
    }

    /// Of a part that may have waited since its last visit: of its plane, or of a border's point.
    #[inline(always)]
    fn of_part(part: &Part, within: &Within) -> Option<Self> {
        if part.normal == Vec3::ZERO {
            return None;
        }
        if part.is_border() {
            return Self::of(part.on_border(within.placement), part.pair.b.point(), within, |away| {
                part.normal.dot(away) > 0.0
            });
        }
        let arm = within.placement.direction_to_a(part.pair.b.point());
        let distance = part.normal.dot(arm + within.placement.origin - part.pair.a.point());
        within.holds(distance, arm).then_some(Self {
            normal: part.normal,
            arm,
            gap: distance - within.radius,
            force: Vec3::ZERO,
        })
    }
}

/// The pose of a tool, and how far its contacts are closed in a tick.
struct Within<'a> {
    placement: &'a Placement,
    radius: f32,
    reach_m: f32,
    reach_rad: f32,
}

impl Within<'_> {
    /// Whether a core's point is in reach. Most are so without the turn.
    fn holds(&self, distance: f32, arm: Vec3) -> bool {
        distance <= self.radius + self.reach_m || distance <= self.reach_of(arm)
    }

    fn reach_of(&self, arm: Vec3) -> f32 {
        self.radius + self.reach_m + self.reach_rad * sqrt_from_above(arm.length_squared())
    }
}

impl Manifold {
    /// No contact.
    pub const NONE: Self = Self {
        contacts: [ToolContact::NONE; MAX_CONTACTS],
        count: 0,
        pressed: [[Vec3::ZERO; 2]; MAX_CONTACTS],
        pressed_count: 0,
    };

    /// The contacts.
    pub fn contacts(&self) -> &[ToolContact] {
        self.contacts.get(..usize::from(self.count)).unwrap_or(&[])
    }

    /// The contacts, whose forces are to be found.
    pub(super) fn contacts_mut(&mut self) -> &mut [ToolContact] {
        self.contacts.get_mut(..usize::from(self.count)).unwrap_or(&mut [])
    }

    /// Takes the forces of the last tick for a start, where a contact goes on.
    pub(super) fn recall(&mut self, size: f32) {
        let near = NEAR_ARM * size;
        let (pressed, contacts) = (&self.pressed, &mut self.contacts);
        for contact in contacts.iter_mut().take(usize::from(self.count)) {
            let goes_on = |[arm, _]: &&[Vec3; 2]| (*arm - contact.arm).length_squared() <= near * near;
            let known = pressed.iter().take(usize::from(self.pressed_count)).find(goes_on);
            contact.force = known.map_or(Vec3::ZERO, |[_, force]| *force);
        }
    }

    /// Keeps the forces that were found for the next tick.
    pub(super) fn remember(&mut self) {
        let mut count = 0;
        let pressing = self.contacts.iter().take(usize::from(self.count)).filter(|contact| contact.force != Vec3::ZERO);
        for (pressed, contact) in self.pressed.iter_mut().zip(pressing) {
            *pressed = [contact.arm, contact.force];
            count += 1;
        }
        self.pressed_count = count;
    }

    /// Enters the contacts of parts of one kind.
    fn enter_parts<'a>(&mut self, parts: impl Iterator<Item = &'a Part>, within: &Within, size: f32) {
        let first = usize::from(self.count);
        for part in parts {
            if let Some(contact) = ToolContact::of_part(part, within) {
                self.enter(&contact, first, size);
            }
        }
    }

    /// Enters a contact among those from `first` on, by its gap, unless one of all is the same.
    fn enter(&mut self, contact: &ToolContact, first: usize, size: f32) {
        // Every place is taken by one as near.
        let is_full = usize::from(self.count) == MAX_CONTACTS;
        if is_full && (first == MAX_CONTACTS || contact.gap >= self.contacts[MAX_CONTACTS - 1].gap) {
            return;
        }
        let same = SAME_ARM * size;
        let is_known = self.contacts().iter().any(|known| {
            let apart = known.arm - contact.arm;
            // Most differ in the first coordinate.
            apart.x.abs() <= same
                && apart.length_squared() <= same * same
                && known.normal.dot(contact.normal) > SAME_NORMAL
        });
        if is_known {
            return;
        }
        if !is_full {
            self.count += 1;
        }
        let Some(places) = self.contacts.get_mut(first..usize::from(self.count)) else { return };
        // Those behind it move up from the last place on, which is free, or whose contact falls out.
        let Some((mut place, mut rest)) = places.split_last_mut() else { return };
        while let Some((before, more)) = core::mem::take(&mut rest).split_last_mut()
            && contact.gap < before.gap
        {
            *place = *before;
            (place, rest) = (before, more);
        }
        *place = *contact;
    }
}

impl ToolWitness {
    /// The contacts whose gap a translation of `reach_m` and a rotation of `reach_rad` can close.
    pub(super) fn collect(
        &self,
        manifold: &mut Manifold,
        body: &Body,
        tool: &Tool,
        placement: &Placement,
        [reach_m, reach_rad]: [f32; 2],
    ) {
        let within = Within { placement, radius: tool.radius(), reach_m, reach_rad };
        manifold.count = 0;
        let (region, size) = (tool.region(), body.size());
        if let Some(contact) = ToolContact::of(self.pair.a.point(), self.pair.b.point(), &within, |_| self.is_in_front)
        {
            manifold.enter(&contact, 0, size);
        }
        manifold.enter_parts(self.parts.awake(Kind::Corner), &within, size);
        let first = usize::from(manifold.count);
        for (a, b) in self.vertices(&region, placement) {
            if let Some(contact) = ToolContact::of(a.point, b, &within, |away| a.outward.dot(away) > 0.0) {
                manifold.enter(&contact, first, size);
            }
        }
        manifold.enter_parts(self.parts.awake(Kind::Border), &within, size);
        manifold.enter_parts(self.parts.awake(Kind::Edge), &within, size);
        let first = usize::from(manifold.count);
        for Pair { a, b, .. } in self.rivals.iter().flatten() {
            let is_outside = |away| a.outward(body).dot(away) > 0.0;
            if let Some(contact) = ToolContact::of(a.point(), b.point(), &within, is_outside) {
                manifold.enter(&contact, first, size);
            }
        }
    }
}
