//! A body that deforms: the rigid body's tables and modes, each in flash; what moves is `q`.

use super::feature::Feature;
use super::search::Located;
use super::table::Body;
use super::tick_bound::{TickLimit, WorstTick};
use super::tick_cost as cost;
use super::tracker::{BodyStep, BodyWitness};
use crate::field::{Displacement, Field, MAX_MODES, Mode};
use crate::math::Vec3;
use crate::patch::Patch as _;
use crate::tally::TickWork;
use crate::track::{Contact, Controller, Probe};
use core::fmt;

/// A body that deforms by modes. [`crate::field`] says what a mode is.
///
/// Each tick blends the modes at its `q`, carries the witness point along and runs the tracker of [`Body`] on the
/// displaced patches.
///
/// ```
/// use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face, Soft};
/// use palpate::field::{FieldBounds, Mode, Quadratic};
/// use palpate::math::{Vec3, vec3};
/// use palpate::track::{Controller, Probe};
///
/// # static FILE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/boards/bodies/capped_box.palp")));
/// # let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
/// # let body = Body::from_bytes(&FILE.0, BodyBuffer { faces: &mut faces, edges: &mut edges })?;
/// // A box of 60 mm × 40 mm that grows along x by 1 mm/mm at x = 60 mm.
/// static GROW: [Mode; 1] = [Mode {
///     field: Quadratic { linear: [vec3(16.7, 0.0, 0.0), Vec3::ZERO, Vec3::ZERO], ..Quadratic::ZERO },
///     bump: None,
///     limit: 0.006,
///     bounds: FieldBounds { motion: 1.01, stretch: 16.8, bend: 0.0, twist: 0.0 },
/// }];
/// let soft = Soft::new(body, &GROW).unwrap();
/// let (mut witness, probe) = (soft.start(), Probe::at(vec3(0.07, 0.02, 0.01)));
/// for tick in 0..20 {
///     soft.step(&Controller::SecondOrder, &mut witness, probe, &[0.000_1 * tick as f32], 0.001);
/// }
/// assert!((witness.body.gap - (0.01 - 0.0019)).abs() < 1e-5);
/// # Ok::<(), palpate::body::FileError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Soft<'a> {
    rest: Body<'a>,
    modes: &'a [Mode],
}

/// Error in the modes of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SoftError {
    /// There are more than [`MAX_MODES`].
    Modes,
    /// A bound or a limit is negative or not finite, or a radius is not positive.
    Mode {
        /// Its index.
        mode: u8,
    },
    /// The motions are not as many as the modes.
    Motions,
    /// A motion has a negative or infinite number, no stiffness, or more than 256 radians a tick.
    Motion {
        /// Its index.
        mode: u8,
    },
    /// The loop's rate is no number or not positive.
    Rate,
}

impl fmt::Display for SoftError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Modes => write!(formatter, "modes: more than {MAX_MODES}; leave the stiffest out"),
            Self::Mode { mode } => {
                write!(formatter, "modes: mode {mode} has a negative or infinite number; bake it again")
            }
            Self::Motions => write!(formatter, "motions: not as many as modes; give one for each"),
            Self::Motion { mode } => write!(
                formatter,
                "motions: mode {mode} has a negative or infinite number, no stiffness, or is too fast; leave it out, \
                 or give it no mass"
            ),
            Self::Rate => write!(formatter, "rate: not a positive number of Hz"),
        }
    }
}

impl core::error::Error for SoftError {}

/// State of the tracker of a body that deforms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftWitness {
    /// The tracker's.
    pub body: BodyWitness,
    /// `q` of the last tick, metres.
    q: [f32; MAX_MODES],
}

/// Result of a tick on a body that deforms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftStep {
    /// The tracker's.
    pub body: BodyStep,
    /// Whether a `q` was beyond its mode's limit or not a number, and was saturated.
    pub is_clamped: bool,
    /// [`Body::is_too_deep`] of the displaced body.
    pub is_too_deep: bool,
}

impl SoftWitness {
    /// `q` of the last tick, metres, each within its mode's limit: of the body as it was tracked.
    pub const fn q(&self) -> &[f32; MAX_MODES] {
        &self.q
    }
}

impl<'a> Soft<'a> {
    /// A body with its modes.
    ///
    /// # Errors
    /// The first error in the modes.
    pub const fn new(rest: Body<'a>, modes: &'a [Mode]) -> Result<Self, SoftError> {
        if modes.len() > MAX_MODES {
            return Err(SoftError::Modes);
        }
        let mut index = 0;
        while index < modes.len() {
            if !modes[index].is_valid() {
                return Err(SoftError::Mode { mode: index as u8 });
            }
            index += 1;
        }
        Ok(Self { rest, modes })
    }

    /// The body at rest.
    pub const fn rest(&self) -> &Body<'a> {
        &self.rest
    }

    /// The modes.
    pub const fn modes(&self) -> &'a [Mode] {
        self.modes
    }

    /// Bound of the evaluations of every tick, as [`Body::worst_tick`] of a rigid body, with those of the loop's push
    /// ([`crate::servo::SoftBody`]): of any `q`, also where modes take the body's convexity.
    pub const fn worst_tick(&self, weights: TickWork) -> WorstTick {
        let WorstTick { cost, vertex } = self.rest.displaced_by(&Field::REST, Contact::Touching).worst_tick(weights);
        // To ride, and for the material point.
        let each = if weights.curves > weights.patches { weights.curves } else { weights.patches };
        WorstTick { cost: cost + 2 * each, vertex }
    }

    /// Bound of the cycles of every servo tick on a Cortex-M4F, as [`Body::worst_cycles`].
    pub const fn worst_cycles(&self) -> u32 {
        let TickWork { patches, curves, spokes } = self.rest.weights();
        let weights =
            TickWork { patches: patches + cost::WARP, curves: curves + cost::WARP, spokes: spokes + cost::WARP };
        cost::cycles(self.worst_tick(weights).cost + cost::modes(self.modes.len() as u32))
    }

    /// The body with the highest effort up to its own with which every tick stays within the limit's cycles, as
    /// [`Body::fitted`].
    #[must_use]
    pub const fn fitted(mut self, limit: TickLimit) -> Self {
        while self.worst_cycles() > limit.cycles {
            match self.rest.effort.less() {
                Some(effort) => self.rest.effort = effort,
                None => break,
            }
        }
        self
    }

    /// The displacement at some `q`, metres, each saturated to its mode's limit.
    pub fn field(&self, q: &[f32]) -> Field<'a> {
        Field::new(self.modes, q)
    }

    /// The state before the first tick, at rest.
    pub fn start(&self) -> SoftWitness {
        SoftWitness { body: self.rest.start(), q: [0.0; MAX_MODES] }
    }

    /// One tick, as [`Body::step`], at this tick's `q`, metres.
    pub fn step(
        &self,
        controller: &Controller,
        state: &mut SoftWitness,
        probe: Probe,
        q: &[f32],
        period_s: f32,
    ) -> SoftStep {
        let field = self.field(q);
        let body = self.rest.displaced(&field);
        let mut evaluations = 0;
        if *field.q() != state.q {
            if state.body.contact == Contact::Touching {
                state.body.reach += field.motion_since(&state.q);
            }
            evaluations = body.ride(&mut state.body);
            state.q = *field.q();
        }
        let mut step = body.step(controller, &mut state.body, probe, period_s);
        step.evaluations += evaluations;
        let is_too_deep = state.body.contact == Contact::Touching && body.is_too_deep(&state.body);
        SoftStep { body: step, is_clamped: !field.holds(q), is_too_deep }
    }

    /// The place of the witness point on the body at rest, metres: the material point.
    pub fn material_point(&self, state: &SoftWitness) -> Vec3 {
        let [u, v] = state.body.witness.parameters;
        let found = match state.body.feature {
            Feature::Face(index) => self.rest.faces.get(usize::from(index)).map(|face| face.patch.evaluate(u, v).point),
            Feature::Edge(index) => self.rest.edges.get(usize::from(index)).map(|edge| edge.curve.point(u)),
            Feature::Vertex(index) => self.rest.vertices.get(usize::from(index)).map(|vertex| vertex.point),
        };
        found.unwrap_or(Vec3::ZERO)
    }

    /// [`Body::locate`] on the body at some `q`, metres.
    pub fn locate(&self, probe: Vec3, q: &[f32]) -> Located {
        self.rest.displaced(&self.field(q)).locate(probe)
    }
}

impl<'a> Body<'a> {
    /// The body as a field displaces it. Affine fields alone keep it convex.
    pub fn displaced<'f>(&self, by: &'f Field<'f>) -> Body<'f, &'f Field<'f>>
    where
        'a: 'f,
    {
        self.displaced_by(by, if by.is_affine() { self.sure_from } else { Contact::Touching })
    }
}

impl<D: Displacement> Body<'_, D> {
    /// Takes the witness point along with its place on the body, which has moved: otherwise the next step would compare
    /// two surfaces. Returns the number of evaluations of patches.
    #[inline(never)]
    fn ride(&self, state: &mut BodyWitness) -> u8 {
        let [u, v] = state.witness.parameters;
        match state.feature {
            Feature::Face(index) => {
                let Some(face) = self.faces.get(usize::from(index)) else { return 0 };
                let reached = self.patch(face).evaluate_apart([u, v]);
                (state.witness.surface, state.witness.second) = (reached.surface, reached.second);
                return 1;
            }
            Feature::Edge(index) => {
                let Some(edge) = self.edges.get(usize::from(index)) else { return 0 };
                let at = self.on_edge(edge, u);
                (state.witness.surface.point, state.witness.surface.tangent_u) = (at.point, at.tangent);
                state.witness.second.half_uu = at.half_second;
            }
            Feature::Vertex(index) => {
                let Some(vertex) = self.vertices.get(usize::from(index)) else { return 0 };
                state.witness.surface.point = self.place(vertex);
            }
        }
        0
    }
}
