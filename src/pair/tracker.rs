//! Location and tracking of a tool: the closest pair, the core's corners, and the rivals that may become the pair.

use super::cells::{Cells, Visit};
use super::common_normal;
use super::location::MAX_STEPS;
use super::parts::{Part, Parts, rest};
use super::scene::{NEARER, Scene, TOUCHING};
use super::step::{Foot, Moved, Pair};
use super::tool::{Core, Region, Tool};
use crate::body::{Body, Side};
use crate::math::{Vec3, sqrt, sqrt_from_above};
use crate::track::Placement;

/// Other minima of a body that is not convex that are tracked.
const RIVALS: usize = 4;
/// Cells that the audit visits in a tick by default.
pub const DEFAULT_CELLS: u16 = 16;
/// Maximum cells that a location visits.
pub const MAX_CELLS: u16 = 16_384;
/// Relative to the size: minima that are farther than the pair by less are tracked beside it.
pub(super) const LOOKAHEAD: f32 = 0.03;
/// Relative to the size: witness points nearer than this are those of one minimum.
const SAME: f32 = 1.0e-3;
/// Motion of the core between two ticks, relative to the body's size, above which it has jumped: locate it again.
pub(super) const JUMP: f32 = 0.03;

/// State of the closest pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ToolStatus {
    /// The points follow the closest pair.
    Following,
    /// The points are at rest, and no step lowers their distance. On a convex body they are the closest pair.
    AtRest,
    /// Body and core intersect. Between smooth convex bodies the distance is minus the depth, otherwise at least it.
    Inside,
    /// The points rest on the far side of a convex body. Locate the tool again.
    Behind,
    /// The tool has jumped. Locate it again.
    Jumped,
    /// A location used up its steps or cells: another pair may be nearer.
    StepLimit,
}

impl ToolStatus {
    /// Its name in tables; `sound` is that of points that follow the pair or rest at it.
    pub const fn name(self, sound: &'static str) -> &'static str {
        match self {
            Self::Following | Self::AtRest => sound,
            Self::Inside => "inside",
            Self::Behind | Self::Jumped => "behind",
            Self::StepLimit => "step-limit",
        }
    }
}

/// The closest pair of a body and a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Distance of body and core less the tool's radius, metres.
    pub distance: f32,
    /// The point on the body, metres, in the frame of its tables.
    pub body: Vec3,
    /// The point of the core, metres, in the tool's frame.
    pub core: Vec3,
    /// Evaluations of patches spent.
    pub evaluations: u32,
    /// State of the pair.
    pub status: ToolStatus,
}

/// State of the tracker of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolWitness {
    pub(super) pair: Pair,
    pub(super) parts: Parts,
    /// The corners of the pair's face of the body, and which face it is.
    vertices: ([Corner; 4], u16),
    /// Metres of the core's motion after which a corner of the face may be the nearest, or in contact.
    vertices_rest_for: f32,
    pub(super) rivals: [Option<Pair>; RIVALS],
    /// The descent from a cell of the audit, and its steps so far.
    pub(super) explorer: Option<Pair>,
    explored: u8,
    pub(super) cells: Cells,
    placement: Placement,
    /// Whether the pair is that of the common normal.
    pub(super) is_inside: bool,
    /// Whether the pair passes the sign test.
    pub(super) is_in_front: bool,
}

/// A corner of a face of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    /// Where, metres.
    pub point: Vec3,
    /// Out of the body.
    pub outward: Vec3,
}

/// The corners of a face: whether at the upper ends of its parameters.
const ENDS: [[bool; 2]; 4] = [[false, false], [true, false], [false, true], [true, true]];

const fn parameters_of([u, v]: [bool; 2]) -> [f32; 2] {
    [if u { 1.0 } else { 0.0 }, if v { 1.0 } else { 0.0 }]
}

impl Corner {
    const NONE: Self = Self { point: Vec3::ZERO, outward: Vec3::ZERO };

    /// From the table of vertices; evaluated where that does not tell which way is out.
    fn of(body: &Body, face: u16, upper: [bool; 2]) -> Self {
        let [u, v] = upper;
        let side = body.faces().get(usize::from(face)).and_then(|face| face.sides.get(usize::from(u)));
        let vertex = match side {
            Some(Side::Pole { vertex }) => Some(*vertex),
            Some(Side::Edge { edge, reversed, .. }) => {
                body.edges().get(usize::from(*edge)).map(|edge| edge.ends[usize::from(v != *reversed)])
            }
            None => None,
        };
        match vertex.and_then(|vertex| body.vertices().get(usize::from(vertex))) {
            Some(vertex) if vertex.outward != Vec3::ZERO => Self { point: vertex.point, outward: vertex.outward },
            _ => {
                let foot = Foot::on(body, face, parameters_of(upper));
                Self { point: foot.point(), outward: foot.outward(body) }
            }
        }
    }
}

impl<'a> Body<'a> {
    /// The state with the witness points on a face of the body and a face of the core; on a core that is no body, at its
    /// nearest point. Its corners and edges are not tracked.
    pub fn start_tool(
        &self,
        tool: &Tool,
        placement: &Placement,
        (face, parameters): (u16, [f32; 2]),
        (core_face, core_parameters): (u16, [f32; 2]),
    ) -> ToolWitness {
        let a = Foot::on(self, face, parameters);
        let pair = match tool.region() {
            region @ Region::Solid { .. } => Pair::facing(a, &region, placement),
            Region::Surface(core) => Pair { a, b: Foot::on(core, core_face, core_parameters), halvings: 0 },
        };
        ToolWitness::new(pair, placement)
    }

    /// One tick: follows the closest pair of this body and a tool with a few steps, each of at most one evaluation of
    /// the body and one of the core and as many for their switches. On bodies that are not convex it visits `cells` of
    /// the audit too.
    ///
    /// A corner or an edge is left out until the core has moved so far that it can be the nearest, or in contact. The
    /// distance at rest never rises by more than rounding. The nearest of the pair, the corners, the edges and the
    /// rivals is the result.
    pub fn step_tool(&self, tool: &Tool, state: &mut ToolWitness, placement: &Placement, cells: u16) -> Closest {
        self.step_tool_with(tool, state, placement, cells, false)
    }

    /// The same, and [`Self::locate_tool`] in a tick in which the tool has jumped, the points rest behind, or the core
    /// intersects: for a host, since a location takes far longer than a tick.
    pub fn follow_tool(&self, tool: &Tool, state: &mut ToolWitness, placement: &Placement, cells: u16) -> Closest {
        let step = self.step_tool(tool, state, placement, cells);
        let needs_location = match step.status {
            ToolStatus::Behind | ToolStatus::Jumped => true,
            // The tracker keeps hold of a common normal.
            ToolStatus::Inside => !state.is_inside,
            _ => false,
        };
        if !needs_location {
            return step;
        }
        let (start, found) = self.locate_tool(tool, placement);
        *state = start;
        Closest { evaluations: step.evaluations + found.evaluations, ..found }
    }

    /// The same as a step; beside a convex body with at most [`VISITS`] corners and edges in a tick, if `is_lean`.
    pub(super) fn step_tool_with(
        &self,
        tool: &Tool,
        state: &mut ToolWitness,
        placement: &Placement,
        cells: u16,
        is_lean: bool,
    ) -> Closest {
        let mut scene = Scene { body: self, region: tool.region(), placement, evaluations: 0 };
        let is_lean = is_lean && self.is_convex();
        let has_jumped = state.has_jumped(placement, self.size());
        let motion = core_motion(&state.placement, placement, tool.extents());
        // Nothing here takes its velocities.
        (state.placement.axes, state.placement.origin) = (placement.axes, placement.origin);
        if state.is_inside
            && let Core::Body(core) = *tool.core()
        {
            let depth = common_normal::follow(&mut state.pair, self, core, placement, 3, &mut scene.evaluations);
            state.is_inside = depth.is_some_and(|depth| depth > 0.0);
            if let Some(depth) = depth
                && state.is_inside
            {
                return scene.closest(&state.pair, -depth - tool.radius(), ToolStatus::Inside);
            }
        }
        let region = scene.region;
        let (moved, _) = scene.follow(&region, &mut state.pair);
        scene.tick_parts(&mut state.parts, &mut state.pair, tool, (motion, is_lean));
        for rival in state.rivals.iter_mut().flatten() {
            scene.tick(rival);
        }
        if !self.is_convex() {
            scene.audit(state, cells);
        }
        let distance = scene.exchange(state, tool, motion);
        state.is_in_front = scene.is_global(&state.pair);
        let status = if has_jumped {
            ToolStatus::Jumped
        } else if distance <= TOUCHING * self.size() {
            ToolStatus::Inside
        } else if self.is_convex() && moved == Moved::AtRest && !state.is_in_front {
            ToolStatus::Behind
        } else if moved == Moved::AtRest {
            ToolStatus::AtRest
        } else {
            ToolStatus::Following
        };
        scene.closest(&state.pair, distance - tool.radius(), status)
    }
}

impl ToolWitness {
    const fn new(pair: Pair, placement: &Placement) -> Self {
        Self {
            pair,
            parts: Parts::none(),
            vertices: ([Corner::NONE; 4], u16::MAX),
            vertices_rest_for: 0.0,
            rivals: [None; RIVALS],
            explorer: None,
            explored: 0,
            cells: Cells::START,
            placement: *placement,
            is_inside: false,
            is_in_front: true,
        }
    }

    /// Before a location.
    pub(super) const fn unlocated(placement: &Placement) -> Self {
        let nowhere = Foot::in_solid(Vec3::ZERO);
        Self::new(Pair { a: nowhere, b: nowhere, halvings: 0 }, placement)
    }

    /// The tool's pose in the last tick, or of the location.
    pub(super) const fn placement(&self) -> &Placement {
        &self.placement
    }

    pub(super) const fn restart_audit(&mut self) {
        (self.cells, self.explorer) = (Cells::START, None);
    }

    /// Whether the pair or a rival is in the cell that the last visit started from.
    pub(super) fn knows_cell_of(&self, start: &Pair) -> bool {
        self.rivals.iter().flatten().chain([&self.pair]).any(|known| Cells::holds(&start.a, &known.a))
    }

    /// The closest pair.
    pub const fn pair(&self) -> &Pair {
        &self.pair
    }

    /// The pair, the corners, edges and borders, and the rivals: what may come into contact.
    pub fn pairs(&self) -> impl Iterator<Item = &Pair> {
        let Parts { corners, edges, borders, .. } = &self.parts;
        let parts = corners.iter().chain(edges).chain(borders).flatten().map(|part| &part.pair);
        core::iter::once(&self.pair).chain(parts).chain(self.rivals.iter().flatten())
    }

    /// The corners of the pair's face that may be near, each with the opposite point of a core that is no body.
    pub(super) fn vertices<'a>(
        &'a self,
        region: &Region,
        placement: &'a Placement,
    ) -> impl Iterator<Item = (&'a Corner, Vec3)> {
        let (vertices, face) = &self.vertices;
        let count = if *face == u16::MAX || self.vertices_rest_for > 0.0 { 0 } else { vertices.len() };
        let region = region.solid();
        vertices.iter().take(count).map(move |a| (a, region.nearest(placement.point_to_b(a.point)).0))
    }

    /// Whether the core's witness point or its axes have moved far since the last tick.
    fn has_jumped(&self, placement: &Placement, size: f32) -> bool {
        let point = self.pair.b.point();
        let moved = placement.point_to_a(point) - self.placement.point_to_a(point);
        let turned = [0, 1, 2].map(|axis| (placement.axes[axis] - self.placement.axes[axis]).length_squared());
        let limit = JUMP * size;
        // Not so for a pose that is not finite.
        !(moved.length_squared() <= limit * limit && turned.iter().all(|turn| *turn <= 0.1))
    }
}

impl Scene<'_> {
    const fn closest(&self, pair: &Pair, distance: f32, status: ToolStatus) -> Closest {
        Closest { distance, body: pair.a.point(), core: pair.b.point(), evaluations: self.evaluations, status }
    }

    /// Keeps a rival, unless it is known, or all that are known are nearer.
    pub(super) fn keep(&self, best: &Pair, rivals: &mut [Option<Pair>; RIVALS], rival: Pair) {
        if rivals.iter().flatten().chain([best]).any(|known| self.is_same(known, &rival)) {
            return;
        }
        let mut entering = Some(rival);
        for slot in rivals {
            if let Some(pair) = entering
                && slot.is_none_or(|known| self.distance(&pair) < self.distance(&known))
            {
                entering = core::mem::replace(slot, entering);
            }
        }
    }

    fn is_same(&self, one: &Pair, other: &Pair) -> bool {
        let same = SAME * self.body.size();
        (one.a.point() - other.a.point()).length_squared() <= same * same
            && (one.b.point() - other.b.point()).length_squared() <= same * same
    }

    /// Visits some cells, and follows the descent from one that may hold another minimum.
    fn audit(&mut self, state: &mut ToolWitness, cells: u16) {
        let bound = self.distance(&state.pair) + LOOKAHEAD * self.body.size();
        for _ in 0..cells {
            if let Some(mut explorer) = state.explorer {
                // One that is handed to and fro between two faces never rests.
                let is_done = self.tick(&mut explorer) == Moved::AtRest || state.explored >= MAX_STEPS;
                state.explored += 1;
                state.explorer = (!is_done).then_some(explorer);
                if is_done && self.distance(&explorer) < bound {
                    self.keep(&state.pair, &mut state.rivals, explorer);
                }
                continue;
            }
            self.evaluations += 1;
            if let Visit::Start(start) = state.cells.visit(self.body, &self.region, self.placement, bound) {
                (state.explorer, state.explored) = ((!state.knows_cell_of(&start)).then_some(start), 0);
            }
        }
    }

    /// Makes the nearest of pair, corners, edges, vertices and rivals the pair, and returns its distance; drops rivals that
    /// are far, or one with another.
    fn exchange(&mut self, state: &mut ToolWitness, tool: &Tool, motion: f32) -> f32 {
        let face = state.pair.a.face;
        // Of a convex body and a point the pair is all.
        let is_point = matches!(self.region, Region::Solid { half: Vec3::ZERO, .. }) && self.body.is_convex();
        state.vertices_rest_for -= motion;
        if let (false, true, Region::Solid { middle, half }) = (is_point, state.vertices.1 != face, self.region) {
            self.evaluations += 4;
            state.vertices_rest_for = 0.0;
            state.vertices.1 = face;
            for (corner, upper) in state.vertices.0.iter_mut().zip(ENDS) {
                *corner = Corner::of(self.body, face, upper);
            }
            for (number, border) in state.parts.changed_borders().iter_mut().enumerate() {
                let mut at = state.pair.a.parameters;
                at[number / 2] = if number % 2 == 0 { 0.0 } else { 1.0 };
                let pair = Pair::facing(Foot::on(self.body, face, at), &self.region, self.placement);
                let mut part = Part::border(pair, (middle, half), [number < 2, number >= 2]);
                self.note(&mut part);
                *border = Some(part);
            }
        }
        let mut distance_of_pair = self.distance(&state.pair);
        let mut least = distance_of_pair - NEARER * self.body.size();
        let (mut nearest, mut rest_for) = (None, f32::INFINITY);
        for ((a, b), upper) in state.vertices(&self.region, self.placement).zip(ENDS) {
            let distance = sqrt((a.point - self.placement.point_to_a(b)).length_squared());
            let rests = rest(distance, tool, least);
            rest_for = if rests < rest_for { rests } else { rest_for };
            if distance < least {
                (least, nearest) = (distance, Some((upper, b)));
            }
        }
        if rest_for < f32::INFINITY {
            state.vertices_rest_for = rest_for;
        }
        if let Some((upper, b)) = nearest {
            self.evaluations += 1;
            state.pair = Pair { a: Foot::on(self.body, face, parameters_of(upper)), b: Foot::in_solid(b), halvings: 0 };
            distance_of_pair = least;
        }
        for rival in state.rivals.iter_mut().flatten() {
            let distance = self.distance(rival);
            if distance < least {
                (least, distance_of_pair) = (distance, distance);
                core::mem::swap(rival, &mut state.pair);
            }
        }
        let far = least + 2.0 * LOOKAHEAD * self.body.size();
        for index in 0..RIVALS {
            let Some(rival) = state.rivals[index] else { continue };
            let before = &state.rivals[..index];
            if self.distance(&rival) > far
                || before.iter().flatten().chain([&state.pair]).any(|known| self.is_same(known, &rival))
            {
                state.rivals[index] = None;
            }
        }
        distance_of_pair
    }
}

/// How far a point of the core has moved, at most, metres.
fn core_motion(from: &Placement, to: &Placement, extents: Vec3) -> f32 {
    let mut motion = sqrt_from_above((to.origin - from.origin).length_squared());
    for (axis, extent) in extents.to_array().into_iter().enumerate() {
        motion += extent * sqrt_from_above((to.axes[axis] - from.axes[axis]).length_squared());
    }
    motion
}
