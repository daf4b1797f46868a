//! A body that deforms as a surface of the loop: its modes move under the push (theory §15).

use super::surface::{BakedTables, Surface, ToolContact, Touched, Tracked};
use crate::body::{Soft, SoftError, SoftWitness, TableCursor};
use crate::field::{MAX_MODES, Modal, ModalStep, within};
use crate::math::saturate;
use crate::render::Penalty;
use crate::track::{Contact, Controller, Outcome, Probe, Witness};

/// A body that deforms, with the motion of its modes. Constant, in flash.
///
/// The push is that of the loop's spring in the middle of the tick, each mode having moved by half of its exact motion,
/// so that spring and modes together gain no energy that the probe has not spent. Modes rest at their limits.
///
/// ```
/// use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face, Soft};
/// use palpate::field::{FieldBounds, Modal, Mode, Quadratic};
/// use palpate::math::{Vec3, vec3};
/// use palpate::render::Penalty;
/// use palpate::servo::{Carrier, SoftBody, Surface, ToolContact, Tracked};
/// use palpate::track::{Contact, Controller, Probe};
///
/// # static FILE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/boards/bodies/capped_box.palp")));
/// # let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
/// # let body = Body::from_bytes(&FILE.0, BodyBuffer { faces: &mut faces, edges: &mut edges })?;
/// // A box of 60 mm that is squeezed along x.
/// static SQUEEZE: [Mode; 1] = [Mode {
///     field: Quadratic { linear: [vec3(16.7, 0.0, 0.0), Vec3::ZERO, Vec3::ZERO], ..Quadratic::ZERO },
///     bump: None,
///     limit: 0.006,
///     bounds: FieldBounds { motion: 1.01, stretch: 16.8, bend: 0.0, twist: 0.0 },
/// }];
/// // 500 N/m without inertia: it follows the push at once.
/// let rubber = Modal { mass_kg: 0.0, damping_n_s_per_m: 0.0, stiffness_n_per_m: 500.0 };
/// let soft = SoftBody::new(Soft::new(body, &SQUEEZE).unwrap(), &[rubber], 4_000.0).unwrap();
/// // In a loop, the wall of its settings.
/// let wall = Penalty { stiffness_n_per_m: 1_000.0, damping_n_s_per_m: 0.0, max_force_n: 5.0 };
/// let (mut state, mut push) = (soft.rest(), 0.0);
/// for tick in 0..400 {
///     let x = 0.062 - if tick < 200 { 0.000_025 * tick as f32 } else { 0.005 };
///     let touched = soft.follow(&Controller::SecondOrder, &mut state, Probe::at(vec3(x, 0.02, 0.01)), 2.5e-4);
///     let touch = ToolContact {
///         gap_m: state.gap(),
///         normal: touched.normal,
///         velocity: Vec3::ZERO,
///         carrier: Carrier::FIXED,
///         period_s: 2.5e-4,
///     };
///     let touch = (state.contact() == Contact::Touching).then_some(touch);
///     push = soft.push(&mut state, &wall, touch);
/// }
/// // 3 mm of spring and body in series: 1/K + 1/k = 3 mm/N.
/// assert!((push - 1.0).abs() < 0.01);
/// assert!((state.q()[0] + 0.002).abs() < 2e-5);
/// # Ok::<(), palpate::body::FileError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SoftBody<'a> {
    soft: Soft<'a>,
    /// Of each mode.
    steps: [ModalStep; MAX_MODES],
    period: f32,
}

/// Ticks after which a body that nobody has asked for is at rest: 16 s at 4 kHz.
const MAX_UNSEEN: u32 = 1 << 16;

/// State of a body that deforms in the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftContact {
    track: SoftWitness,
    /// `q` and its rate, of each mode.
    modes: [[f32; 2]; MAX_MODES],
    is_too_deep: bool,
    /// Whether the loop's rate is that of the modes' motion.
    is_in_time: bool,
}

impl<'a> SoftBody<'a> {
    /// A body with a motion for each of its modes, for a loop of this rate, Hz. Any other is [`super::Fault::OtherRate`].
    ///
    /// # Errors
    /// A mode that is none or too fast, or another number of motions than of modes; a rate that is no number or not
    /// positive.
    pub const fn new(soft: Soft<'a>, motion: &[Modal], rate_hz: f32) -> Result<Self, SoftError> {
        if soft.modes().len() != motion.len() {
            return Err(SoftError::Motions);
        }
        if !(rate_hz.is_finite() && rate_hz > 0.0) {
            return Err(SoftError::Rate);
        }
        let period = 1.0 / rate_hz;
        let mut steps = [ModalStep::ZERO; MAX_MODES];
        let mut index = 0;
        // `Soft::new` has bounded them: the compiler is to see it, for no image may hold a panic.
        while index < motion.len() && index < MAX_MODES {
            if !motion[index].is_valid(period) {
                return Err(SoftError::Motion { mode: index as u8 });
            }
            steps[index] = ModalStep::new(&motion[index], period);
            index += 1;
        }
        Ok(Self { soft, steps, period })
    }

    /// The body and its modes.
    pub const fn soft(&self) -> &Soft<'a> {
        &self.soft
    }

    /// Puts a mode to rest at some `q`, metres, saturated to its limit; a NaN becomes 0. Before each tick, it holds it
    /// there.
    pub fn put(&self, state: &mut SoftContact, mode: usize, q: f32) {
        if let (Some(moving), Some(mode)) = (state.modes.get_mut(mode), self.soft.modes().get(mode)) {
            let q = if q.is_nan() { 0.0 } else { q };
            *moving = [saturate(q, -mode.limit, mode.limit), 0.0];
        }
    }

    /// The push of this tick, N, and the motion of the modes under it to the next.
    #[inline(never)]
    fn press(&self, state: &mut SoftContact, wall: &Penalty, touch: &ToolContact) -> f32 {
        let ToolContact { gap_m, normal, velocity, carrier, .. } = *touch;
        let at = self.soft.material_point(&state.track);
        let mut along = [0.0; MAX_MODES];
        for (along, mode) in along.iter_mut().zip(self.soft.modes()) {
            *along = mode.displacement(at).dot(normal);
        }
        let Penalty { stiffness_n_per_m: stiffness, damping_n_s_per_m: damping, max_force_n } = *wall;
        let (rate, half) = (damping / self.period, 0.5 * self.period);
        // As in the rigid body's push: it moves as a whole too.
        let depth = half * carrier.outward_m_per_s - gap_m;
        let carried = half * carrier.mobility_per_kg * (half * stiffness + damping);
        let mut push = 0.0;
        let mut stopped = [None; MAX_MODES];
        // A mode that comes to a stop moves as far as the stop and yields no more: each round finds one more, or ends.
        for _ in 0..=self.soft.modes().len() {
            let (mut free, mut yielding) = (0.0, 0.0);
            let each = self.steps.iter().zip(self.soft.modes()).zip(&state.modes).zip(along.iter().zip(&stopped));
            for (((step, _), [q, v]), (along, stopped)) in each {
                match stopped {
                    Some(moved) => free += along * moved,
                    None => {
                        free += along * step.free_motion(*q, *v);
                        yielding += along * along * step.compliance();
                    }
                }
            }
            // In the middle of the tick the depth is more by half of the surface's motion; the damper has all of it.
            let spring = stiffness * (depth + 0.5 * free);
            let damper = rate * free - damping * velocity.dot(normal);
            let stiff = 1.0 + carried + (0.5 * stiffness + rate) * yielding;
            push = saturate((spring + damper) / stiff, 0.0, max_force_n);
            let mut is_settled = true;
            let each = self.steps.iter().zip(&state.modes).zip(self.soft.modes()).zip(along.iter().zip(&mut stopped));
            for (((step, [q, v]), mode), (along, stopped)) in each {
                if stopped.is_none() {
                    let next = q + (step.free_motion(*q, *v) - step.compliance() * along * push);
                    let within = saturate(next, -mode.limit, mode.limit);
                    if within != next {
                        (*stopped, is_settled) = (Some(within - q), false);
                    }
                }
            }
            if is_settled {
                break;
            }
        }
        self.advance(state, along.map(|along| -along * push));
        push
    }

    /// The motion of the modes over the ticks in which nobody asked for the body, one less than `elapsed` seconds are:
    /// free, for nothing touched it. Whether they are whole ticks.
    #[cold]
    #[inline(never)]
    fn ring(&self, state: &mut SoftContact, elapsed: f32) -> bool {
        let ticks = (elapsed / self.period + 0.5) as u32;
        let is_in_time = ticks > 0 && (elapsed - ticks as f32 * self.period).abs() <= 1e-3 * elapsed;
        if is_in_time {
            let each = self.steps.iter().zip(self.soft.modes()).zip(&mut state.modes);
            for ((step, mode), moving) in each {
                if *moving != [0.0; 2] {
                    // Longer, and squaring would add up its roundings.
                    let rung = if ticks <= MAX_UNSEEN { step.ring(*moving, ticks - 1) } else { [0.0; 2] };
                    *moving = within(rung, mode.limit);
                }
            }
        }
        is_in_time
    }

    /// A tick of all modes under their forces, N.
    #[inline]
    fn advance(&self, state: &mut SoftContact, forces: [f32; MAX_MODES]) {
        let each = self.steps.iter().zip(self.soft.modes()).zip(&mut state.modes).zip(forces);
        for (((step, mode), moving), force) in each {
            *moving = step.advance_within(*moving, force, mode.limit);
        }
    }
}

impl SoftContact {
    /// `q` of each mode at the next tick, metres.
    pub fn q(&self) -> [f32; MAX_MODES] {
        self.modes.map(|[q, _]| q)
    }

    /// Its rate, m/s.
    pub fn rates(&self) -> [f32; MAX_MODES] {
        self.modes.map(|[_, rate]| rate)
    }

    /// The tracker's state, on the body as it was in this tick.
    pub const fn track(&self) -> &SoftWitness {
        &self.track
    }
}

impl Surface for SoftBody<'_> {
    type Witness = SoftContact;

    const HAS_OWN_PUSH: bool = true;

    fn rest(&self) -> SoftContact {
        SoftContact { track: self.soft.start(), modes: [[0.0; 2]; MAX_MODES], is_too_deep: false, is_in_time: true }
    }

    #[inline]
    fn is_for(&self, period: f32) -> bool {
        (period - self.period).abs() <= 1e-3 * self.period
    }

    #[inline]
    fn follow(&self, controller: &Controller, state: &mut SoftContact, probe: Probe, period: f32) -> Touched {
        state.is_in_time = self.is_for(period) || self.ring(state, period);
        let q = state.q();
        let step = self.soft.step(controller, &mut state.track, probe, &q, period);
        state.is_too_deep = step.is_too_deep;
        Touched {
            normal: state.track.body.normal,
            rejected: step.body.outcome == Outcome::Rejected,
            unexplained: step.body.unexplained,
        }
    }

    #[inline]
    fn push(&self, state: &mut SoftContact, wall: &Penalty, touch: Option<ToolContact>) -> f32 {
        if let Some(touch) = touch
            && state.is_in_time
        {
            return self.press(state, wall, &touch);
        }
        self.advance(state, [0.0; MAX_MODES]);
        0.0
    }

    fn release(&self, state: &mut SoftContact) {
        state.track.body.forget();
    }

    #[inline]
    fn is_too_deep(&self, state: &SoftContact) -> bool {
        state.is_too_deep
    }
}

impl BakedTables for SoftBody<'_> {
    fn table_word(&self, cursor: TableCursor) -> Option<u32> {
        self.soft.rest().table_word(cursor)
    }

    fn table_records(&self) -> u32 {
        self.soft.rest().table_records()
    }

    fn baked_crc(&self) -> Option<u32> {
        self.soft.rest().baked_crc()
    }
}

impl Tracked for SoftContact {
    fn witness(&self) -> &Witness {
        &self.track.body.witness
    }

    fn gap(&self) -> f32 {
        self.track.body.gap
    }

    fn contact(&self) -> Contact {
        self.track.body.contact
    }

    fn feature(&self) -> u16 {
        self.track.body.feature.code()
    }

    fn modes(&self) -> Option<[f32; MAX_MODES]> {
        Some(self.q())
    }

    fn for_each_word(&self, mut take: impl FnMut(u32)) {
        self.track.body.for_each_word(&mut take);
        for number in self.modes.as_flattened() {
            take(number.to_bits());
        }
    }
}
