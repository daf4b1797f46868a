//! The forces of a tool's contacts: projected Gauss-Seidel sweeps from those of the last tick, with dry friction.

use super::contact::{MAX_CONTACTS, ToolContact};
use super::coupling::share_within;
use crate::math::Vec3;

/// Maximum sweeps over the contacts: without friction, with it.
const SWEEPS: [u8; 2] = [6, 12];
/// Change of all contacts' forces in a sweep, N, after which no other follows.
const SETTLED_N: [f32; 2] = [1.0e-3, 1.0e-4];
/// Maximum rounds in which gaps that the sweeps leave closed are pushed open, and how far one may stay closed, metres.
const REPAIRS: u8 = 4;
const CLOSED_M: f32 = 1.0e-7;

/// A step of the proxy: a way and a rotation, and how far a force and a torque move it, m/N and rad/(N·m).
pub(super) struct Step {
    pub way: Vec3,
    pub turn: Vec3,
    pub soft: [f32; 2],
}

/// The contacts' forces by projected Gauss-Seidel, and the step that they leave. `friction` is the
/// coefficient where it `HOLDS`.
pub(super) fn press<const HOLDS: bool>(step: &mut Step, contacts: &mut [ToolContact], radius: f32, friction: f32) {
    let (mut all, mut held) = ([Pressed::NONE; MAX_CONTACTS], [Held::NONE; MAX_CONTACTS]);
    for (contact, (pressed, held)) in contacts.iter().zip(all.iter_mut().zip(&mut held)) {
        *pressed = Pressed::new(contact, step.soft);
        step.push(contact.normal * pressed.force, pressed.lever * pressed.force);
        if HOLDS {
            *held = Held::new(contact, step.soft, radius);
            step.push(held.force, held.at.cross(held.force));
        }
    }
    for _ in 0..SWEEPS[usize::from(HOLDS)] {
        let mut most = 0.0_f32;
        if HOLDS {
            for (contact, (pressed, held)) in contacts.iter().zip(all.iter().zip(&mut held)) {
                let changed = held.hold(step, contact.normal, friction * pressed.force);
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
    // Gaps that are still closed are pushed open: they count more than the last of a force.
    for _ in 0..REPAIRS {
        let mut most = 0.0_f32;
        for (contact, pressed) in contacts.iter().zip(&mut all) {
            let closed = -pressed.gap(step, contact);
            if closed > 0.0 {
                pressed.add(step, contact, closed * pressed.stiff);
                most = if closed > most { closed } else { most };
            }
        }
        if most <= CLOSED_M {
            break;
        }
    }
    for (contact, (pressed, held)) in contacts.iter_mut().zip(all.iter().zip(&held)) {
        contact.force = contact.normal * pressed.force;
        if HOLDS {
            contact.force += held.force;
        }
    }
}

/// A contact along its normal.
#[derive(Clone, Copy)]
struct Pressed {
    /// N.
    force: f32,
    /// The torque of a unit force, metres.
    lever: Vec3,
    /// Newtons that undo a metre.
    stiff: f32,
}

/// A contact along the body.
#[derive(Clone, Copy)]
struct Held {
    /// N.
    force: Vec3,
    /// The place on the tool that touches, metres from its origin.
    at: Vec3,
    /// Newtons that undo a metre, at least.
    stiff: f32,
}

impl Step {
    #[inline]
    fn push(&mut self, force: Vec3, torque: Vec3) {
        (self.way, self.turn) = (self.way + force * self.soft[0], self.turn + torque * self.soft[1]);
    }
}

impl Pressed {
    const NONE: Self = Self { force: 0.0, lever: Vec3::ZERO, stiff: 0.0 };

    fn new(contact: &ToolContact, [soft, softer]: [f32; 2]) -> Self {
        let (lever, force) = (contact.lever(), contact.force.dot(contact.normal));
        let force = if force > 0.0 { force } else { 0.0 };
        Self { force, lever, stiff: 1.0 / (soft + softer * lever.length_squared()) }
    }

    /// The linearised gap at the end of a step, metres.
    #[inline]
    fn gap(&self, step: &Step, contact: &ToolContact) -> f32 {
        contact.gap + contact.normal.dot(step.way) + self.lever.dot(step.turn)
    }

    #[inline]
    fn add(&mut self, step: &mut Step, contact: &ToolContact, more: f32) {
        step.push(contact.normal * more, self.lever * more);
        self.force += more;
    }

    /// Keeps the linearised gap open. Returns by how much the force has changed, N.
    #[inline]
    fn press(&mut self, step: &mut Step, contact: &ToolContact) -> f32 {
        let wanted = self.force - self.gap(step, contact) * self.stiff;
        let more = (if wanted > 0.0 { wanted } else { 0.0 }) - self.force;
        if more.abs() > 0.0 {
            self.add(step, contact, more);
        }
        more.abs()
    }
}

impl Held {
    const NONE: Self = Self { force: Vec3::ZERO, at: Vec3::ZERO, stiff: 0.0 };

    fn new(contact: &ToolContact, [soft, softer]: [f32; 2], radius: f32) -> Self {
        let at = contact.arm - contact.normal * radius;
        let force = along(contact.force, contact.normal);
        Self { force, at, stiff: 1.0 / (soft + softer * at.length_squared()) }
    }

    /// Holds the place that touches by at most a force of the cone, N. Returns by how much its force has changed.
    #[inline]
    fn hold(&mut self, step: &mut Step, normal: Vec3, most: f32) -> f32 {
        let slid = along(step.way + step.turn.cross(self.at), normal);
        let wanted = self.force - slid * self.stiff;
        let next = wanted * share_within([wanted, Vec3::ZERO], [most, 0.0]);
        let more = next - self.force;
        step.push(more, self.at.cross(more));
        self.force = next;
        more.abs().max_element()
    }
}

/// The part of a vector across a unit normal.
fn along(vector: Vec3, normal: Vec3) -> Vec3 {
    vector - normal * normal.dot(vector)
}
