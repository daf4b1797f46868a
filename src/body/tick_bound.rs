//! The worst-case work of one tick on a body, from its tables (theory §10): a bound of every tick, whatever the probe.

use super::audit::{MAX_DEFERRED, MAX_EVALUATIONS_IN_AUDIT};
use super::feature::{Edge, EdgeFace, EdgeKind, Face, Separator, Side, Spoke, Vertex};
use super::table::Body;
use super::tick_cost as cost;
use crate::field::Displacement;
use crate::math::Vec3;
use crate::tally::TickWork;

/// Maximum number of spokes of a vertex: the only list of a body that a tick walks from its start to its end.
pub const MAX_SPOKES: usize = 64;

/// Limit of the work of a tick that an application grants a body, see [`Body::fitted`].
///
/// ```
/// use palpate::body::TickLimit;
///
/// // A core of 170 MHz at 4 kHz: three quarters of 42,500 cycles.
/// assert_eq!(TickLimit::of_period(170_000_000, 4_000).cycles, 31_875);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TickLimit {
    /// Evaluations of patches, curves and spokes in one tick.
    pub evaluations: u32,
    /// Modelled cycles of the whole tick ([`Body::worst_cycles`]).
    pub cycles: u32,
}

impl TickLimit {
    /// Three quarters of the period of a core's clock at this rate. The rest is for the sensors' frames (six of 3 µs
    /// on the Pico 2), interrupts of the host's line, and memory that the model has without wait states.
    pub const fn of_period(clock_hz: u32, rate_hz: u32) -> Self {
        Self { evaluations: 256, cycles: clock_hz / rate_hz / 4 * 3 }
    }

    /// The limit of the bench boards: that of the slowest of them, the Pico 2 with 150 MHz, at 4 kHz.
    pub const BENCH: Self = Self::of_period(150_000_000, 4_000);
    /// No limit but that of any tables, for a host.
    pub const NONE: Self = Self { evaluations: u32::MAX, cycles: u32::MAX };
}

/// Work that a tick may spend: part of the configuration ([`Body::with_effort`]) and of [`Body::worst_tick`]. Below 1
/// counts as 1.
///
/// ```
/// use palpate::body::Effort;
///
/// // The fastest tick, for a slow core or a high rate.
/// assert_eq!(Effort::ONE, Effort { steps: 1, candidates: 1 });
/// assert!(Effort::ONE.steps < Effort::BENCH.steps);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Effort {
    /// Steps of the tracker. One is enough on the way; the others are taken after a switch to another feature, at a
    /// border and after a step that was cut short or rejected.
    pub steps: u8,
    /// Evaluations of the search for a start, whose list of candidates counts as one, and of the audit.
    pub candidates: u8,
}

impl Effort {
    /// One of each.
    pub const ONE: Self = Self { steps: 1, candidates: 1 };
    /// The effort of the bench boards, and the default of a body.
    pub const BENCH: Self = Self { steps: 4, candidates: 8 };

    /// The lower of two, number by number.
    #[must_use]
    pub const fn min(self, other: Self) -> Self {
        Self {
            steps: if other.steps < self.steps { other.steps } else { self.steps },
            candidates: if other.candidates < self.candidates { other.candidates } else { self.candidates },
        }
    }

    /// The next lower effort of a body that does not fit; `None` below [`Self::ONE`].
    pub(super) const fn less(self) -> Option<Self> {
        let Self { steps, candidates } = self;
        match (steps, candidates) {
            (0..=1, 0..=1) => None,
            _ if candidates > 1 && candidates >= steps => Some(Self { steps, candidates: candidates / 2 }),
            _ => Some(Self { steps: steps / 2, candidates }),
        }
    }
}

/// The worst tick on a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct WorstTick {
    /// The sum of its evaluations, each with its weight.
    pub cost: u32,
    /// The vertex whose spokes it looks at; `None` on a body where edges or faces take longer.
    pub vertex: Option<u16>,
}

impl WorstTick {
    const fn or(self, other: Self) -> Self {
        if other.cost > self.cost { other } else { self }
    }
}

const fn larger(one: u32, other: u32) -> u32 {
    if other > one { other } else { one }
}

const NO_WORK: TickWork = TickWork { patches: 0, curves: 0, spokes: 0 };
const PATCH: TickWork = TickWork { patches: 1, ..NO_WORK };

const fn curves(curves: u32) -> TickWork {
    TickWork { curves, ..NO_WORK }
}

const fn spokes(spokes: usize) -> TickWork {
    TickWork { spokes: spokes as u32, ..NO_WORK }
}

/// The more expensive of two.
const fn or(one: TickWork, other: TickWork, weights: TickWork) -> TickWork {
    if other.weighed(weights) > one.weighed(weights) { other } else { one }
}

impl<D: Displacement> Body<'_, D> {
    /// Bound of the work of every tick ([`Body::step`] with the default controller), proved for these tables: the sum of
    /// the evaluations, each with its weight ([`TickWork::EACH`] counts evaluations). A first-order law adds
    /// [`Integrator::evaluations`](crate::track::Integrator::evaluations) less one.
    ///
    /// ```
    /// # use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face};
    /// use palpate::body::{TickLimit, TickWork};
    ///
    /// # static FILE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/boards/bodies/capped_box.palp")));
    /// # let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
    /// # let body = Body::from_bytes(&FILE.0, BodyBuffer { faces: &mut faces, edges: &mut edges })?;
    /// assert!(body.worst_tick(TickWork::EACH).cost <= TickLimit::BENCH.evaluations && body.fits(TickLimit::BENCH));
    /// # Ok::<(), palpate::body::FileError>(())
    /// ```
    pub const fn worst_tick(&self, weights: TickWork) -> WorstTick {
        self.with_effort_of(self.worst_last(weights), self.worst_step(weights), weights)
    }

    /// The last step of a tick, with contact.
    const fn worst_last(&self, weights: TickWork) -> WorstTick {
        let mut worst = self.worst_at_edges(weights);
        let mut index = 0;
        while index < self.vertices.len() {
            worst = worst.or(self.worst_at_vertex(index as u16, weights));
            index += 1;
        }
        index = 0;
        while index < self.faces.len() {
            worst = worst.or(self.worst_on_face(&self.faces[index], weights));
            index += 1;
        }
        worst
    }

    /// Bound of the ticks of one pass of the audit on a body that is not convex: of each candidate at most six
    /// evaluations, at [`Effort::candidates`] a tick. A nearer point that six find is taken within two passes.
    ///
    /// At an effort of one each evaluation is judged in the next tick. A candidate's end and its nearer point have a tick
    /// each too, one that is passed over has one, a pass has three to start, and eight are left to the tracker.
    pub const fn audit_ticks(&self) -> u32 {
        let (list, evaluations) = (self.locator.longest_list() as u32, MAX_EVALUATIONS_IN_AUDIT as u32);
        match self.effort.candidates {
            0..=1 => list * (2 * evaluations + 2) + 3 + MAX_DEFERRED as u32,
            candidates => (list * evaluations).div_ceil(candidates as u32),
        }
    }

    /// Bound of the cycles of every servo tick on a Cortex-M4F, by a model of its instructions (theory §10).
    pub const fn worst_cycles(&self) -> u32 {
        cost::cycles(self.worst_tick(self.weights()).cost)
    }

    /// The body with the highest effort up to its own with which every tick stays within the limit's cycles; with
    /// [`Effort::ONE`] where none does ([`Self::fits`]).
    #[must_use]
    pub const fn fitted(mut self, limit: TickLimit) -> Self {
        let weights = self.weights();
        let (last, step) = (self.worst_last(weights), self.worst_step(weights));
        while cost::cycles(self.with_effort_of(last, step, weights).cost) > limit.cycles {
            match self.effort.less() {
                Some(effort) => self.effort = effort,
                None => break,
            }
        }
        self
    }

    /// Whether every tick stays within a limit.
    pub const fn fits(&self, limit: TickLimit) -> bool {
        self.worst_tick(TickWork::EACH).cost <= limit.evaluations && self.worst_cycles() <= limit.cycles
    }

    /// [`Self::fitted`], with its worst tick in evaluations and cycles; calls `pause` between the features.
    pub(super) fn fitted_with(mut self, limit: TickLimit, pause: &mut dyn FnMut()) -> (Self, WorstTick, u32) {
        let weights = self.weights();
        let (each, weighed) = (self.worst_last_with(TickWork::EACH, pause), self.worst_last_with(weights, pause));
        let (step_each, step) = (self.worst_step(TickWork::EACH), self.worst_step(weights));
        loop {
            pause();
            let cycles = cost::cycles(self.with_effort_of(weighed, step, weights).cost);
            match self.effort.less() {
                Some(effort) if cycles > limit.cycles => self.effort = effort,
                _ => return (self, self.with_effort_of(each, step_each, TickWork::EACH), cycles),
            }
        }
    }

    /// [`Self::worst_last`] with pauses.
    fn worst_last_with(&self, weights: TickWork, pause: &mut dyn FnMut()) -> WorstTick {
        let mut worst = self.worst_at_edges(weights);
        for index in 0..self.vertices.len() {
            pause();
            worst = worst.or(self.worst_at_vertex(index as u16, weights));
        }
        for face in self.faces {
            pause();
            worst = worst.or(self.worst_on_face(face, weights));
        }
        worst
    }

    /// Instructions of the dearest evaluation of each kind, at rest.
    pub(super) const fn weights(&self) -> TickWork {
        let mut weights = TickWork { patches: 0, curves: 0, spokes: cost::SPOKE };
        let mut index = 0;
        while index < self.edges.len() {
            weights.curves = larger(weights.curves, cost::curve(&self.edges[index].curve));
            index += 1;
        }
        index = 0;
        while index < self.faces.len() {
            let face = &self.faces[index];
            weights.patches = larger(weights.patches, cost::patch(&face.patch));
            let mut side = 0;
            while side < 4 {
                if let Side::Edge { separator: Separator::Ruled(curve), .. } = &face.sides[side] {
                    weights.curves = larger(weights.curves, cost::curve(curve));
                }
                side += 1;
            }
            index += 1;
        }
        weights
    }

    /// A tick whose last step and contact take `last`, with the steps before it, each at most `step`, and the search: on
    /// a convex body that and the tracker take turns.
    const fn with_effort_of(&self, last: WorstTick, step: TickWork, weights: TickWork) -> WorstTick {
        let Effort { steps, candidates } = self.effort;
        // One more on an edge that the last one has reached.
        let before = if steps > 1 { steps as u32 } else { 0 };
        let before = before * step.weighed(weights);
        // The point that it hands over is evaluated too.
        let search = TickWork { patches: candidates as u32 + 1, ..NO_WORK }.weighed(weights);
        let tracked = WorstTick { cost: before + last.cost, ..last };
        if self.is_convex() {
            tracked.or(WorstTick { cost: search, vertex: None })
        } else {
            WorstTick { cost: search + tracked.cost, ..tracked }
        }
    }

    /// The step of the tracker that takes longest, without contact.
    const fn worst_step(&self, weights: TickWork) -> TickWork {
        let (mut worst, mut over, mut index) = (PATCH, NO_WORK, 0);
        while index < self.edges.len() {
            let edge = &self.edges[index];
            let asked = curves(self.ruled(edge));
            if matches!(edge.kind, EdgeKind::Smooth) {
                over = or(over, asked, weights);
            }
            worst = or(worst, or(asked.and(PATCH), asked.and(curves(1)), weights), weights);
            index += 1;
        }
        index = 0;
        let mut most = 0;
        while index < self.vertices.len() {
            let count = self.vertices[index].spokes as usize;
            most = if count > most { count } else { most };
            index += 1;
        }
        let at_pole = if self.has_poles { spokes(most) } else { NO_WORK };
        or(or(worst, PATCH.and(over).and(at_pole), weights), spokes(most).and(curves(2)), weights)
    }

    /// Ticks that start on an edge: both faces are asked, then one is entered, or a step along the edge is tried.
    const fn worst_at_edges(&self, weights: TickWork) -> WorstTick {
        let mut worst = TickWork { patches: 1, ..NO_WORK };
        let mut index = 0;
        while index < self.edges.len() {
            let edge = &self.edges[index];
            let asked = curves(self.ruled(edge)).and(self.contact_on_edge(edge));
            worst = or(worst, or(asked.and(PATCH), asked.and(curves(1)), weights), weights);
            index += 1;
        }
        WorstTick { cost: worst.weighed(weights), vertex: None }
    }

    /// Ticks that end on a vertex, over an edge or by staying there, or that leave it along an edge.
    const fn worst_at_vertex(&self, index: u16, weights: TickWork) -> WorstTick {
        let vertex = self.vertex_at(index);
        let all = self.spokes_at(vertex);
        let (mut asked, mut contact) = (0, NO_WORK);
        let mut number = 0;
        while number < all.len() {
            let edge = self.edge_at(all[number].edge);
            let ruled = self.ruled(edge);
            asked = if ruled > asked { ruled } else { asked };
            contact = or(contact, self.contact_on_edge(edge), weights);
            number += 1;
        }
        let stays = if vertex.is_open { NO_WORK } else { self.outside_at(vertex) };
        let comes = or(curves(asked), spokes(all.len()), weights).and(stays);
        // At the end of the spoke, and a step from there.
        let leaves = spokes(all.len()).and(curves(2)).and(contact);
        let worst = or(comes, leaves, weights);
        WorstTick { cost: worst.weighed(weights), vertex: Some(index) }
    }

    /// Ticks that step on a face, or from there over a smooth edge: one evaluation, then the borders that are near.
    const fn worst_on_face(&self, face: &Face<'_>, weights: TickWork) -> WorstTick {
        let (mut at_pole, mut over) = (NO_WORK, NO_WORK);
        let (mut worst, mut vertex) = self.contact_on_face(face, weights);
        let mut side = 0;
        while side < 4 {
            match &face.sides[side] {
                Side::Pole { vertex } => {
                    let count = self.spokes_at(self.vertex_at(*vertex)).len();
                    at_pole = or(at_pole, spokes(count), weights);
                }
                Side::Edge { edge, .. } => {
                    let edge = self.edge_at(*edge);
                    if matches!(edge.kind, EdgeKind::Smooth) {
                        over = or(over, curves(self.ruled(edge)), weights);
                        let mut number = 0;
                        while number < 2 {
                            if let Some(other) = self.face_of(edge.faces[number]) {
                                let (its, its_vertex) = self.contact_on_face(other, weights);
                                if its.weighed(weights) > worst.weighed(weights) {
                                    (worst, vertex) = (its, its_vertex);
                                }
                            }
                            number += 1;
                        }
                    }
                }
            }
            side += 1;
        }
        let worst = PATCH.and(at_pole).and(over).and(worst);
        WorstTick { cost: worst.weighed(weights), vertex }
    }

    /// [`Body::spokes_of`] in a `const fn`.
    const fn spokes_at(&self, vertex: &Vertex) -> &[Spoke] {
        let Some((_, from)) = self.spokes.split_at_checked(vertex.first_spoke as usize) else { return &[] };
        let Some((all, _)) = from.split_at_checked(vertex.spokes as usize) else { return &[] };
        all
    }

    // Checked tables name edges and vertices that exist; `get` is not a `const fn`, and an index could panic.

    const fn edge_at(&self, index: u16) -> &Edge<'_> {
        if (index as usize) < self.edges.len() { &self.edges[index as usize] } else { &Edge::VACANT }
    }

    const fn vertex_at(&self, index: u16) -> &Vertex {
        const NONE: Vertex =
            Vertex { point: Vec3::ZERO, outward: Vec3::ZERO, first_spoke: 0, spokes: 0, is_open: true };
        if (index as usize) < self.vertices.len() { &self.vertices[index as usize] } else { &NONE }
    }

    const fn face_of(&self, of: EdgeFace) -> Option<&Face<'_>> {
        if (of.face as usize) < self.faces.len() { Some(&self.faces[of.face as usize]) } else { None }
    }

    /// The number of curves that the separator of a face's side takes.
    const fn separator(&self, of: EdgeFace) -> u32 {
        let Some(face) = self.face_of(of) else { return 0 };
        match face.sides[of.side as usize & 3] {
            Side::Edge { separator: Separator::Plane { .. }, .. } => D::SEPARATORS[0],
            Side::Edge { separator: Separator::Ruled(_), .. } => D::SEPARATORS[1],
            Side::Pole { .. } => 0,
        }
    }

    /// The number of curves that separate the faces of an edge.
    const fn ruled(&self, edge: &Edge<'_>) -> u32 {
        self.separator(edge.faces[0]) + self.separator(edge.faces[1])
    }

    /// [`Body::update_contact`] on an edge: `is_above_smooth` or `is_below`.
    const fn contact_on_edge(&self, edge: &Edge<'_>) -> TickWork {
        match edge.kind {
            EdgeKind::Smooth => curves(self.separator(edge.faces[0])),
            EdgeKind::Convex | EdgeKind::Mixed if self.has_poles => curves(self.ruled(edge)),
            EdgeKind::Convex | EdgeKind::Mixed | EdgeKind::Reflex | EdgeKind::Open => NO_WORK,
        }
    }

    /// [`Body::update_contact`] on a face: `releases_at_border`, at one side or a corner, with the vertex that is asked.
    const fn contact_on_face(&self, face: &Face<'_>, weights: TickWork) -> (TickWork, Option<u16>) {
        let (mut worst, mut at) = (NO_WORK, None);
        let mut corner = 0;
        while corner < 4 {
            let (u, v) = (corner & 1, corner >> 1);
            let vertex = match &face.sides[u] {
                Side::Pole { vertex } => *vertex,
                Side::Edge { edge, reversed, .. } => self.edge_at(*edge).ends[(v ^ (*reversed as usize)) & 1],
            };
            let (mut asked, decides) = self.in_front_at(self.vertex_at(vertex));
            let sides = [self.side(face, u, weights), self.side(face, 2 + v, weights)];
            if !decides {
                asked = asked.and(sides[0]).and(sides[1]);
            }
            asked = or(asked, or(sides[0], sides[1], weights), weights);
            if asked.weighed(weights) > worst.weighed(weights) {
                (worst, at) = (asked, Some(vertex));
            }
            corner += 1;
        }
        (worst, at)
    }

    /// `is_in_front_of_neighbour`.
    const fn side(&self, face: &Face<'_>, number: usize, weights: TickWork) -> TickWork {
        match &face.sides[number & 3] {
            Side::Pole { vertex } => self.outside_at(self.vertex_at(*vertex)),
            Side::Edge { edge, .. } => {
                let edge = self.edge_at(*edge);
                match edge.kind {
                    EdgeKind::Convex => curves(larger(self.separator(edge.faces[0]), self.separator(edge.faces[1]))),
                    EdgeKind::Smooth => {
                        let [start, end] = edge.ends;
                        let (start, _) = self.in_front_at(self.vertex_at(start));
                        let (end, _) = self.in_front_at(self.vertex_at(end));
                        or(start, end, weights)
                    }
                    EdgeKind::Reflex | EdgeKind::Mixed | EdgeKind::Open => NO_WORK,
                }
            }
        }
    }

    const fn kind(&self, spoke: &Spoke) -> EdgeKind {
        self.edge_at(spoke.edge).kind
    }

    /// `is_outside_at`: whether an edge leads nearer, whether all are smooth, how hollow the faces are, and the planes.
    const fn outside_at(&self, vertex: &Vertex) -> TickWork {
        let all = self.spokes_at(vertex);
        let mut smooth = 0;
        while smooth < all.len() && matches!(self.kind(&all[smooth]), EdgeKind::Smooth) {
            smooth += 1;
        }
        let (planes, _) = self.in_front_at(vertex);
        if smooth == all.len() { spokes(3 * smooth) } else { spokes(all.len() + smooth + 1).and(planes) }
    }

    /// `is_in_front_at`, and whether the vertex decides there.
    const fn in_front_at(&self, vertex: &Vertex) -> (TickWork, bool) {
        let all = self.spokes_at(vertex);
        let (mut sharp, mut count) = ([0; 3], 0);
        let mut index = 0;
        while index < all.len() {
            match self.kind(&all[index]) {
                EdgeKind::Convex if count >= 3 => return (spokes(index + 1), false),
                EdgeKind::Convex => {
                    sharp[count] = all[index].edge;
                    count += 1;
                }
                EdgeKind::Smooth => {}
                EdgeKind::Reflex | EdgeKind::Mixed | EdgeKind::Open => return (spokes(index + 1), false),
            }
            index += 1;
        }
        let mut work = spokes(all.len());
        if count < 3 {
            return (work, false);
        }
        let mut pair = 0;
        while pair < 3 && !self.is_convex() {
            // The bulge of the face between two of the edges, or of all faces.
            let between =
                if self.have_common_face(sharp[pair], sharp[(pair + 1) % 3]) { curves(2) } else { spokes(all.len()) };
            work = work.and(between);
            pair += 1;
        }
        (work, true)
    }

    const fn have_common_face(&self, from: u16, to: u16) -> bool {
        let (from, to) = (&self.edge_at(from).faces, &self.edge_at(to).faces);
        let mut is_common = false;
        let mut pair = 0;
        while pair < 4 {
            let [one, other] = [from[pair & 1].face, to[pair >> 1 & 1].face];
            is_common |= one == other && (one as usize) < self.faces.len();
            pair += 1;
        }
        is_common
    }
}
