//! The scene: bodies, the checks of their parameters, and the tick.

use super::SceneError;
use super::host_force::HostForce;
use super::limits::Limits;
use super::part::{Motion, Part, PartState};
use super::rigid::Wrench;
use super::state::SceneState;
use crate::body::{Body, TableCursor, TickWork};
use crate::math::{Vec3, saturate};
use crate::render::{Friction, Penalty, Press, limit};
use crate::servo::{BakedTables, Carrier, Surface, ToolContact, Touched, Tracked};
use crate::track::{Contact, Controller, Probe};

/// No body.
pub(super) const NOBODY: u8 = u8::MAX;

/// The register from which a step of the CRC (with a word of 0) gives all ones, the initial value of a CRC.
const TO_ALL_ONES: u32 = 0x9226_f562;

/// Bodies that stand and move in one frame, touched by one tool. Constant, in flash; `N` is their maximum number, at
/// most 32.
///
/// A [`Surface`] like any other, whose force is all its own: give it to a [`crate::servo::Servo`]. The two nearest
/// bodies are tracked at each tick, touched ones first; one of the others is checked per tick.
///
/// ```
/// use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
/// use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};
/// use palpate::math::Vec3;
/// use palpate::scene::{Limits, Material, Motion, Part, Scene, SceneError, Sphere};
/// use palpate::track::Placement;
///
/// static WALL: SplinePatch = SplineTable {
///     // …
/// #   degree: [1, 1],
/// #   breaks_u: &[0.0, 1.0],
/// #   breaks_v: &[0.0, 1.0],
/// #   coefficients: Coefficients::Polynomial(&[[0.0; 3], [0.0, 0.0, 0.2], [0.0, 0.2, 0.0], [0.0; 3]]),
/// #   shape: ShapeBounds::unknown(SecondDerivativeBounds::ZERO),
/// #   orientation: Orientation::Outward,
/// #   size_m: 0.2,
/// #   crc: None,
/// }
/// .checked();
///
/// let part = |material| Part {
///     surface: &WALL,
///     motion: Motion::Resting(Placement::IDENTITY),
///     material,
///     sphere: Sphere { centre_m: Vec3::ZERO, radius_m: 0.15 },
///     group: 0,
/// };
/// let limits = Limits::of(&DEVICE, 4_000.0);
/// let soft = part(Material::new(300.0, 1.0));
/// assert!(Scene::try_new(limits, [soft, soft]).is_ok());
/// // Two bodies may push at once: their stiffnesses together must be within the device's.
/// let hard = part(Material::new(900.0, 1.0));
/// assert_eq!(Scene::try_new(limits, [soft, hard]).err(), Some(SceneError::Stiffness(0)));
/// ```
#[derive(Debug)]
pub struct Scene<'a, S, const N: usize> {
    pub(super) parts: [Part<'a, S>; N],
    pub(super) limits: Limits,
}

impl<'a, S: Surface, const N: usize> Scene<'a, S, N> {
    /// The longest time, in ticks, from one look at a body that is on and not tracked to the next.
    pub const LOOKS: u32 = if N > 2 { N as u32 - 2 } else { 1 };

    /// Checks the bodies and takes them.
    ///
    /// # Errors
    /// The first choice that is refused, naming the body by its index.
    pub const fn try_new(limits: Limits, mut parts: [Part<'a, S>; N]) -> Result<Self, SceneError> {
        if N == 0 || N > 32 {
            return Err(SceneError::Bodies);
        }
        if !limits.is_valid() {
            return Err(SceneError::Limits);
        }
        // The sphere of a body holds its effects too, so that it is visited in time.
        let mut index = 0;
        while index < N {
            if let Some(effects) = parts[index].material.effects {
                parts[index].sphere.radius_m += effects.reach();
            }
            index += 1;
        }
        let scene = Self { parts, limits };
        let mut index = 0;
        while index < N {
            let Part { material, group, .. } = &scene.parts[index];
            let number = index as u8;
            let beside = limits.stiffest_beside(&scene.parts, index);
            let left = limits.for_effects(&scene.parts, index);
            // A wall that is too stiff by itself is refused as such, below.
            let fits = material.stiffness_n_per_m <= left.stiffness_n_per_m && left.damping_n_s_per_m >= 0.0;
            if fits
                && let Some(effects) = material.effects
                && effects.check(&left).is_err()
            {
                return Err(SceneError::Effects(number));
            }
            let stiffness = [material.stiffness_n_per_m, beside];
            if let Err(error) = scene.check(index, stiffness, material.damping_n_s_per_m, material.friction.as_ref()) {
                return Err(error);
            }
            if !scene.parts[index].is_held() {
                return Err(SceneError::Sphere(number));
            }
            if *group > 31 {
                return Err(SceneError::Group(number));
            }
            index += 1;
        }
        Ok(scene)
    }

    /// [`Self::try_new`] for a `static`.
    ///
    /// # Panics
    /// At compile time, where it is refused.
    pub const fn new(limits: Limits, parts: [Part<'a, S>; N]) -> Self {
        match Self::try_new(limits, parts) {
            Ok(scene) => scene,
            Err(error) => panic!("{}", error.message()),
        }
    }

    /// The bodies.
    pub const fn parts(&self) -> &[Part<'a, S>; N] {
        &self.parts
    }

    /// The limits of all bodies.
    pub const fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Whether a body may have this stiffness, damping and friction, beside one of that stiffness: two bodies at once
    /// push with the sum of both.
    pub(super) const fn check(
        &self,
        index: usize,
        [stiffness, beside]: [f32; 2],
        damping: f32,
        friction: Option<&Friction>,
    ) -> Result<(), SceneError> {
        let number = index as u8;
        let Part { motion, sphere, material, .. } = &self.parts[index];
        let (stiffness, damping) = match material.effects {
            // A negative one stays negative, to be refused.
            Some(effects) if stiffness >= 0.0 && damping >= 0.0 => {
                (material.steepest(stiffness, self.limits.max_force_n), damping + effects.damping())
            }
            _ => (stiffness, damping),
        };
        if !(stiffness >= 0.0 && stiffness + beside <= self.limits.max_stiffness_n_per_m) {
            return Err(SceneError::Stiffness(number));
        }
        if !(damping >= 0.0 && damping <= self.limits.max_damping_n_s_per_m) {
            return Err(SceneError::Damping(number));
        }
        if let Some(friction) = friction
            && !friction.is_valid()
        {
            return Err(SceneError::Friction(number));
        }
        if !self.parts[index].moves_well() {
            return Err(SceneError::Motion(number));
        }
        if let Motion::Free(body) = motion {
            let period = 1.0 / self.limits.rate_hz;
            let (mut hold, mut drag) = (stiffness, damping);
            if let Some(friction) = friction {
                if friction.damping_n_s_per_m < 0.5 * period * friction.stiffness_n_per_m {
                    return Err(SceneError::Slack(number));
                }
                hold += friction.stiffness_n_per_m;
                drag += friction.damping_n_s_per_m;
            }
            // An explicit damper that takes more than all of the velocity in a tick would throw it back.
            let light = (hold * period + drag) * period * body.max_mobility(sphere.centre_m, sphere.radius_m) <= 1.0;
            if !light {
                return Err(SceneError::Light(number));
            }
        }
        Ok(())
    }

    pub(super) const fn bit(&self, index: usize) -> u32 {
        1 << (self.parts[index].group & 31)
    }

    const fn has_effects(&self, index: usize) -> bool {
        self.parts[index].material.effects.is_some()
    }

    #[inline]
    fn is_on(&self, state: &SceneState<S::Witness, N>, index: usize) -> bool {
        index < N && state.groups & self.bit(index) != 0
    }

    /// Moves a body on to this tick, and its witness point with it.
    #[inline(never)]
    fn visit(
        &self,
        controller: &Controller,
        state: &mut SceneState<S::Witness, N>,
        index: usize,
        probe: Probe,
        period: f32,
    ) -> bool {
        let Part { surface, motion, sphere, .. } = &self.parts[index];
        let (ticks, tip_radius) = (state.ticks, state.tip_radius);
        let part = &mut state.parts[index];
        let passed = ticks.wrapping_sub(part.seen);
        part.seen = ticks;
        let elapsed = if passed == 1 { period } else { period * passed as f32 };
        match motion {
            Motion::Resting(_) => {
                if part.way > 0 && part.go_along(passed, elapsed) {
                    state.switched = true;
                }
            }
            Motion::Prescribed(path) => path.go_on(ticks, &mut part.frame),
            Motion::Free(body) => {
                body.step(&mut part.moving, &part.push, elapsed);
                part.frame = body.frame(&part.moving);
                part.push = Wrench::default();
            }
        }
        let frame = &part.frame;
        let position = frame.point_to_body(probe.position);
        part.velocity = frame.to_body(probe.velocity - frame.velocity_at(probe.position));
        let seen = Probe { position, velocity: part.velocity };
        let Touched { normal, rejected, unexplained } = surface.follow(controller, &mut part.witness, seen, elapsed);
        part.normal = normal;
        part.unexplained = unexplained;
        part.gap = part.witness.gap() - tip_radius;
        part.contact = match part.witness.contact() {
            Contact::Behind => Contact::Behind,
            _ if part.gap >= 0.0 => Contact::InFront,
            _ if part.contact != Contact::Behind => Contact::Touching,
            _ => Contact::Behind,
        };
        if N > 2 {
            // A witness point that has been left behind by an eighth of the body's size is searched for again.
            let clear = (position - sphere.centre_m).length() - sphere.radius_m - tip_radius;
            let most = sphere.radius_m * (1.0 / 32.0);
            let clear = saturate(clear, 0.0, if most < f32::INFINITY { most } else { 0.0 });
            part.rests = (clear * self.limits.rate_hz / self.limits.max_speed_m_per_s) as u32;
        }
        rejected
    }

    /// One body beside the two that are tracked, the next that is due; and whether it is to be tracked from now on.
    #[inline]
    fn look(&self, controller: &Controller, state: &mut SceneState<S::Witness, N>, probe: Probe, period: f32) {
        let mut next = usize::from(state.turn);
        for _ in 0..N {
            next = if next + 1 < N { next + 1 } else { 0 };
            let due = state.ticks.wrapping_sub(state.parts[next].seen) > state.parts[next].rests;
            if due && self.is_on(state, next) && !state.is_tracked(next) {
                state.turn = next as u8;
                self.visit(controller, state, next, probe, period);
                self.promote(state, next);
                if !state.is_tracked(next) {
                    self.leave(state, next);
                }
                return;
            }
        }
    }

    /// Tracks a body from now on, if it is nearer than one of those that are; a touched one stays.
    fn promote(&self, state: &mut SceneState<S::Witness, N>, index: usize) {
        let rank = |state: &SceneState<S::Witness, N>, index: usize| {
            if !self.is_on(state, index) {
                return f32::INFINITY;
            }
            let part = &state.parts[index];
            if part.contact == Contact::Touching { f32::NEG_INFINITY } else { part.gap.abs() }
        };
        let [first, second] = state.tracked.map(usize::from);
        let (a, b) = (rank(state, first), rank(state, second));
        let (slot, farther) = if a > b { (0, a) } else { (1, b) };
        if rank(state, index) < farther {
            let left = usize::from(state.tracked[slot]);
            if left < N {
                state.parts[left].force = Vec3::ZERO;
                state.switched |= self.has_effects(left);
                self.leave(state, left);
            }
            state.tracked[slot] = index as u8;
            // It may be in contact, or within the reach of its effects, since its last check: its force rises from zero.
            state.switched |= state.parts[index].contact == Contact::Touching || self.has_effects(index);
        }
    }

    /// A body that was looked at in this tick and pushes nothing: one with a motion of its own moves on.
    #[inline]
    fn leave(&self, state: &mut SceneState<S::Witness, N>, index: usize) {
        let part = &mut state.parts[index];
        if S::HAS_OWN_PUSH && part.seen == state.ticks {
            let wall = Penalty { stiffness_n_per_m: 0.0, damping_n_s_per_m: 0.0, max_force_n: 0.0 };
            self.parts[index].surface.push(&mut part.witness, &wall, None);
        }
    }

    /// The force of a body on the tool, N, in the scene's frame; the reaction is kept for its next tick.
    #[inline(never)]
    fn press(&self, state: &mut SceneState<S::Witness, N>, index: usize, period: f32) -> Vec3 {
        let Part { surface, material, motion, .. } = &self.parts[index];
        let part = &mut state.parts[index];
        let mut point = part.witness.witness().surface.point;
        let mut push = 0.0;
        let penalty = Penalty {
            stiffness_n_per_m: part.stiffness,
            damping_n_s_per_m: part.damping,
            max_force_n: self.limits.max_force_n,
        };
        if part.contact == Contact::Touching && !part.unexplained {
            let (gap_m, normal, velocity) = (part.gap, part.normal, part.velocity);
            let mut touch = ToolContact { gap_m, normal, velocity, carrier: Carrier::FIXED, period_s: period };
            if !S::HAS_OWN_PUSH {
                push = penalty.push(part.gap, part.velocity.dot(part.normal));
            }
            if let Motion::Free(body) = motion {
                let (at, normal) = (part.frame.point_to_scene(point), part.frame.to_scene(part.normal));
                touch.carrier.mobility_per_kg = body.mobility(&part.moving, &part.frame, at, normal);
                touch.carrier.outward_m_per_s = part.frame.velocity_at(at).dot(normal);
                if !S::HAS_OWN_PUSH {
                    push = touch.carried(push, &penalty);
                }
            }
            if S::HAS_OWN_PUSH {
                push = surface.push(&mut part.witness, &penalty, Some(touch));
            }
        } else if S::HAS_OWN_PUSH {
            surface.push(&mut part.witness, &penalty, None);
        }
        let witness = part.witness.witness();
        let place = || (witness.parameters, witness.surface.tangent_u);
        let press = Press { point, normal: part.normal, velocity: part.velocity, push };
        let force = match material.effects {
            None => press.force(part.friction.as_ref(), None, &mut part.anchor, place),
            Some(effects) => {
                let texture = effects.texture.as_ref();
                let pressed = press.force(part.friction.as_ref(), texture, &mut part.anchor, place);
                // A drag acts where the tool is, or it would turn a free body with energy of its own.
                point += part.normal * part.witness.gap();
                let is_near = part.contact != Contact::Behind && !part.unexplained;
                if is_near { effects.force(pressed, part.gap, part.normal, part.velocity) } else { pressed }
            }
        };
        part.force = part.frame.to_scene(force);
        if let Motion::Free(_) = motion {
            let arm = part.frame.point_to_scene(point) - part.moving.position();
            part.push = Wrench { force: -part.force, torque: arm.cross(-part.force) };
        }
        part.force
    }

    /// The foremost body: the one touched deepest, or the nearer of the two.
    #[inline]
    fn foremost(&self, state: &SceneState<S::Witness, N>) -> u8 {
        let [first, second] = state.tracked;
        if !self.is_on(state, usize::from(second)) {
            return first;
        }
        let [a, b] = [&state.parts[usize::from(first)], &state.parts[usize::from(second)]];
        let is_second = if a.contact == b.contact && self.is_on(state, usize::from(first)) {
            b.gap < a.gap
        } else {
            b.contact > a.contact || !self.is_on(state, usize::from(first))
        };
        if is_second { second } else { first }
    }
}

impl<const N: usize> Scene<'_, Body<'_>, N> {
    /// Bound of the evaluations of every tick, see [`Body::worst_tick`]: the two bodies that are tracked and the one
    /// that is checked, each at its worst.
    pub const fn worst_tick(&self, weights: TickWork) -> u32 {
        let mut most = [0; 3];
        let mut index = 0;
        while index < N {
            let mut cost = self.parts[index].surface.worst_tick(weights).cost;
            let mut place = 0;
            while place < most.len() {
                if cost > most[place] {
                    (most[place], cost) = (cost, most[place]);
                }
                place += 1;
            }
            index += 1;
        }
        most[0] + most[1] + most[2]
    }
}

impl<S: Surface, const N: usize> Surface for Scene<'_, S, N> {
    type Witness = SceneState<S::Witness, N>;

    fn rest(&self) -> Self::Witness {
        SceneState {
            parts: core::array::from_fn(|index| PartState::new(&self.parts[index], self.parts[index].surface.rest())),
            ticks: 0,
            tracked: [0, if N > 1 { 1 } else { NOBODY }],
            turn: 0,
            felt: 0,
            groups: u32::MAX,
            tip_radius: 0.0,
            backed: Vec3::ZERO,
            left_over: Vec3::ZERO,
            switched: false,
            host: HostForce::NONE,
            force: Vec3::ZERO,
        }
    }

    fn is_for(&self, period: f32) -> bool {
        self.parts.iter().all(|part| part.surface.is_for(period))
    }

    #[inline]
    fn follow(&self, controller: &Controller, state: &mut Self::Witness, probe: Probe, period: f32) -> Touched {
        state.ticks = state.ticks.wrapping_add(1);
        let mut rejected = false;
        for slot in 0..if N > 1 { 2 } else { 1 } {
            let index = usize::from(state.tracked[slot]);
            if self.is_on(state, index) {
                rejected |= self.visit(controller, state, index, probe, period);
            }
        }
        if N > 2 {
            self.look(controller, state, probe, period);
        }
        let mut force = Vec3::ZERO;
        for slot in 0..if N > 1 { 2 } else { 1 } {
            let index = usize::from(state.tracked[slot]);
            if self.is_on(state, index) {
                force += self.press(state, index, period);
            }
        }
        if state.switched {
            (state.left_over, state.switched) = (state.backed - force, false);
        }
        let let_go = self.limits.release_n_per_s * period;
        if state.left_over != Vec3::ZERO {
            state.left_over -= limit::saturated(state.left_over, let_go);
        }
        state.backed = force + state.left_over;
        state.force = state.host.step(state.backed, let_go);
        state.felt = self.foremost(state);
        let part = &state.parts[usize::from(state.felt)];
        Touched {
            normal: part.frame.to_scene(part.normal),
            rejected,
            unexplained: state.tracked.iter().any(|index| {
                state
                    .parts
                    .get(usize::from(*index))
                    .is_some_and(|part| part.unexplained && part.contact == Contact::Touching)
            }),
        }
    }

    fn release(&self, state: &mut Self::Witness) {
        let mut any = false;
        for index in 0..N {
            let part = &state.parts[index];
            if state.is_tracked(index) && part.unexplained && part.contact == Contact::Touching {
                self.forget(state, index);
                any = true;
            }
        }
        if !any {
            self.forget(state, usize::from(state.felt));
        }
    }

    fn is_too_deep(&self, state: &Self::Witness) -> bool {
        let index = usize::from(state.felt);
        self.parts[index].surface.is_too_deep(&state.parts[index].witness)
    }

    /// Switches the group of this number on, and all others off.
    fn choose(&self, state: &mut Self::Witness, group: u8) {
        if group < 32 {
            self.switch(state, 1 << group);
        }
    }
}

impl<S: BakedTables, const N: usize> BakedTables for Scene<'_, S, N> {
    /// The tables of all bodies that carry a CRC, one after the other. After those of each comes a record of one word:
    /// the one that takes the CRC of tables as they were baked back to 0, and every other to something else, for one
    /// step of a CRC takes each word to another. So the CRC of the whole is 0 exactly where that of the last body is
    /// right with all others, or two errors happen to cancel, once in 2³².
    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        let mut record = cursor.record;
        for Part { surface, .. } in &self.parts {
            let Some(baked) = surface.baked_crc() else { continue };
            let records = surface.table_records();
            if record < records {
                return surface.table_word(TableCursor { record, ..cursor });
            }
            if record == records {
                return (cursor.word == 0).then_some(!baked ^ TO_ALL_ONES);
            }
            record -= records + 1;
        }
        None
    }

    fn table_records(&self) -> u32 {
        self.parts
            .iter()
            .filter(|part| part.surface.baked_crc().is_some())
            .map(|part| part.surface.table_records() + 1)
            .sum()
    }

    fn baked_crc(&self) -> Option<u32> {
        self.parts.iter().any(|part| part.surface.baked_crc().is_some()).then_some(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::crc32;

    #[test]
    fn one_word_takes_a_right_crc_back_to_nothing_and_no_other() {
        for baked in [0, 1, 0x9AE0_DAAF, u32::MAX] {
            let word = !baked ^ TO_ALL_ONES;
            assert_eq!(crc32(baked, word), 0);
            assert_ne!(crc32(baked ^ 0x0001_0000, word), 0);
        }
    }
}
