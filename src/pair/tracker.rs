//! Location and tracking of a tool: the closest pair, the core's corners, and the rivals that may become the pair.

use super::cells::{Cells, Visit};
use super::common_normal;
use super::step::{Foot, Moved, Pair};
use super::tool::{Core, Region, Tool, unit};
use crate::body::{Body, EdgeKind};
use crate::math::{Vec3, saturate, sqrt, sqrt_from_above};
use crate::patch::SurfacePoint;
use crate::track::Placement;

/// Corners of a core that are tracked.
const CORNERS: usize = 8;
/// Pieces of a core's edges that are tracked: two of each of a box.
const EDGES: usize = 24;
/// Other minima of a body that is not convex that are tracked.
const RIVALS: usize = 4;
/// Cells that the audit visits in a tick by default.
pub const DEFAULT_CELLS: u16 = 16;
/// Maximum cells that a location visits.
pub const MAX_CELLS: u16 = 16_384;
/// Maximum steps of a pair in a tick: one more after each switch.
const MAX_SWITCHES: u8 = 3;
/// Relative to the size: minima that are farther than the pair by less are tracked beside it.
pub(super) const LOOKAHEAD: f32 = 0.03;
/// Relative to the size: bodies nearer than this intersect, as far as their coordinates tell.
pub(super) const TOUCHING: f32 = 1.0e-6;
/// Relative to the size: a pair takes the place of another if it is nearer by more.
pub(super) const NEARER: f32 = 3.0e-8;
/// Relative to the size: witness points nearer than this are those of one minimum.
const SAME: f32 = 1.0e-3;
/// Gap below which a part of the core is looked at in every tick, metres: more than a proxy closes in one.
const REACH_M: f32 = 1.5e-3;
/// Parts of the core that are visited in a tick beside a convex body.
const VISITS: usize = 2;
/// By how much the plane of a part that waits for its turn may be nearer than the body, metres.
const STALE_M: f32 = 1.0e-6;
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
    /// The core's corners, each with its nearest point of the body.
    pub(super) corners: [Option<Part>; CORNERS],
    /// The core's edges, each with its nearest pair.
    pub(super) edges: [Option<Part>; EDGES],
    /// The corners of the pair's face of the body, and which face it is.
    vertices: ([Foot; 4], u16),
    /// Metres of the core's motion after which a corner of the face may be the nearest, or in contact.
    vertices_rest_for: f32,
    /// The borders of that face.
    pub(super) borders: [Option<Part>; 4],
    /// Corners and edges that the core has.
    pub(super) count: [u8; 2],
    pub(super) rivals: [Option<Pair>; RIVALS],
    /// The descent from a cell of the audit.
    pub(super) explorer: Option<Pair>,
    pub(super) cells: Cells,
    placement: Placement,
    /// Whether the pair is that of the common normal.
    pub(super) is_inside: bool,
    /// Whether the pair passes the sign test.
    pub(super) is_in_front: bool,
}

/// A corner or an edge of the core, or a border of the body's face, with its closest pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    pub pair: Pair,
    middle: Vec3,
    half: Vec3,
    /// Which of the body's parameters stay: those across a border.
    held: [bool; 2],
    /// Metres of the core's motion after which it may be the nearest, or in contact.
    pub rests_for: f32,
    /// Motion of the core since the last visit, metres.
    since: f32,
    /// Whether that ended without a switch of faces.
    is_settled: bool,
    /// Distance at the last visit, metres.
    pub distance: f32,
    /// From the body's point to the core's at the last visit, a unit vector; zero on the far side of the body.
    pub normal: Vec3,
}

/// A body and a tool at a pose, and what has been spent on them.
pub(super) struct Scene<'a> {
    pub body: &'a Body<'a>,
    pub region: Region<'a>,
    pub placement: &'a Placement,
    pub evaluations: u32,
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

    /// The same; beside a convex body with at most [`VISITS`] corners and edges in a tick, if `is_lean`.
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
        state.placement = *placement;
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
        scene.tick_parts(state, tool, motion, is_lean);
        for rival in state.rivals.iter_mut().flatten() {
            scene.tick(rival);
        }
        if !self.is_convex() {
            scene.audit(state, cells);
        }
        scene.exchange(state, tool, motion);
        let distance = scene.distance(&state.pair);
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
            corners: [None; CORNERS],
            edges: [None; EDGES],
            vertices: ([pair.a; 4], u16::MAX),
            vertices_rest_for: 0.0,
            borders: [None; 4],
            count: [0; 2],
            rivals: [None; RIVALS],
            explorer: None,
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
        let parts = self.corners.iter().chain(&self.edges).chain(&self.borders).flatten().map(|part| &part.pair);
        core::iter::once(&self.pair).chain(parts).chain(self.rivals.iter().flatten())
    }

    /// The corners, the borders and the edges: those that there are come first.
    pub(super) fn parts(&self) -> impl Iterator<Item = &Option<Part>> {
        let [corners, edges] = self.count.map(usize::from);
        self.corners.iter().take(corners).chain(&self.borders).chain(self.edges.iter().take(edges))
    }

    /// The same.
    pub(super) fn parts_mut(&mut self) -> impl Iterator<Item = &mut Option<Part>> {
        let [corners, edges] = self.count.map(usize::from);
        self.corners.iter_mut().take(corners).chain(&mut self.borders).chain(self.edges.iter_mut().take(edges))
    }

    /// The corners of the pair's face that may be near, each with the opposite point of a core that is no body.
    pub(super) fn vertices<'a>(
        &'a self,
        region: &Region,
        placement: &'a Placement,
    ) -> impl Iterator<Item = (&'a Foot, Vec3)> {
        let (vertices, face) = &self.vertices;
        let count = if *face == u16::MAX || self.vertices_rest_for > 0.0 { 0 } else { vertices.len() };
        let region = region.solid();
        vertices.iter().take(count).map(move |a| (a, region.nearest(placement.point_to_b(a.point())).0))
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

impl Part {
    pub const fn new(pair: Pair, middle: Vec3, half: Vec3) -> Self {
        let (since, distance, normal) = (f32::INFINITY, 0.0, Vec3::ZERO);
        Self { pair, middle, half, held: [false; 2], rests_for: 0.0, since, is_settled: false, distance, normal }
    }

    pub fn is_border(&self) -> bool {
        self.held != [false; 2]
    }

    /// Whether it was visited in this tick.
    pub fn is_fresh(&self) -> bool {
        self.since <= 0.0
    }

    /// Not above its distance from a convex body: that of the plane through the body's point at the last visit, behind
    /// which all of the body lies. Without one it comes nearer by no more than the core moves. A border's point slides
    /// along its tangent and takes the core's nearest to it, and may be off by as much.
    fn least_distance(&mut self, region: &Region, placement: &Placement) -> f32 {
        if self.is_border() {
            let a = self.on_border(placement);
            let b = region.nearest(placement.point_to_b(a)).0;
            self.pair.b = Foot::in_solid(b);
            let squared = (placement.point_to_a(b) - a).length_squared() - self.since * self.since;
            return if squared > 0.0 { sqrt(squared) } else { 0.0 };
        }
        if self.normal == Vec3::ZERO {
            return self.distance - self.since;
        }
        let (normal, half) = (placement.direction_to_b(self.normal), self.half);
        let across = normal.x.abs() * half.x + normal.y.abs() * half.y + normal.z.abs() * half.z;
        self.normal.dot(placement.origin - self.pair.a.point()) + normal.dot(self.middle) - across
    }

    /// The point of a border's tangent nearest to the core's: where the body's point has slid since the last visit.
    pub fn on_border(&self, placement: &Placement) -> Vec3 {
        let (a, axis) = (&self.pair.a, usize::from(self.held[0]));
        let SurfacePoint { point, tangent_u, tangent_v } = a.curved.surface;
        let tangent = [tangent_u, tangent_v][axis];
        let (squared, from) = (tangent.length_squared(), a.parameters[axis]);
        if self.is_fresh() || squared <= f32::MIN_POSITIVE {
            return point;
        }
        let along = tangent.dot(placement.point_to_a(self.pair.b.point()) - point) / squared;
        point + tangent * (saturate(from + along, 0.0, 1.0) - from)
    }

    /// Whether it can be neither the nearest nor in contact, and its pair was left where it was.
    pub fn is_at_rest(&self) -> bool {
        self.rests_for > 0.0
    }
}

impl Scene<'_> {
    pub(super) fn distance(&self, pair: &Pair) -> f32 {
        sqrt(pair.difference(self.placement).length_squared())
    }

    const fn closest(&self, pair: &Pair, distance: f32, status: ToolStatus) -> Closest {
        Closest { distance, body: pair.a.point(), core: pair.b.point(), evaluations: self.evaluations, status }
    }

    /// A step of the pair, and then the switches: asked before the step, with the new pose, motion along an edge would
    /// hide that the pair wants to cross it.
    pub(super) fn tick(&mut self, pair: &mut Pair) -> Moved {
        let region = self.region;
        self.tick_on(&region, pair, [false; 2]).0
    }

    /// Steps until none ends with a switch: behind an edge the first ends on it, short of the closest pair.
    fn follow(&mut self, region: &Region, pair: &mut Pair) -> (Moved, bool) {
        let (mut moved, mut switched) = (Moved::AtRest, true);
        for _ in 0..MAX_SWITCHES {
            if switched {
                (moved, switched) = self.tick_on(region, pair, [false; 2]);
            }
        }
        (moved, switched)
    }

    /// One step; whether a point has changed its face as well.
    pub(super) fn tick_on(&mut self, region: &Region, pair: &mut Pair, held: [bool; 2]) -> (Moved, bool) {
        let mut moved = pair.step(self.body, region, self.placement, held);
        self.evaluations += 1;
        let towards = -pair.difference(self.placement);
        let mut switched = held == [false; 2] && pair.a.hand_over(self.body, towards);
        if let Region::Surface(core) = region {
            self.evaluations += 1;
            switched |= pair.b.hand_over(core, -self.placement.direction_to_b(towards));
        }
        if switched {
            (moved, self.evaluations) = (Moved::Nearer, self.evaluations + 1);
        }
        (moved, switched)
    }

    /// Steps of the parts that may be the nearest or in contact.
    ///
    /// If `is_lean`, beside a convex body, at most [`VISITS`] of them: first one that may be nearer than the pair, then the nearest of
    /// those whose planes may be nearer than the body by more than [`STALE_M`] and a share of their gaps. At a distance `d` a
    /// plane falls short by at most `m²/2d` after a motion of `m`, which counts as nearer too, so that each has its turn.
    fn tick_parts(&mut self, state: &mut ToolWitness, tool: &Tool, motion: f32, is_lean: bool) {
        let least = self.distance(&state.pair);
        let mut best = (least - NEARER * self.body.size(), None);
        let mut nearest = (least - NEARER * self.body.size(), None);
        let mut due = [(f32::INFINITY, None); VISITS];
        let region = self.region.solid();
        for (index, part) in state.parts_mut().enumerate() {
            let Some(part) = part else { continue };
            part.since += motion;
            part.rests_for -= motion;
            if part.rests_for > 0.0 {
                continue;
            }
            if !is_lean {
                self.visit(part);
                part.rests_for = Self::rest(part.distance, tool, least);
                if part.distance < best.0 && !part.is_at_rest() {
                    best = (part.distance, Some(index));
                }
                continue;
            }
            let at_least = part.least_distance(&region, self.placement);
            part.rests_for = Self::rest(at_least, tool, least);
            if part.rests_for > 0.0 {
                continue;
            }
            // A corner before the edges that end in it, whose planes lean by rounding.
            if at_least < nearest.0 {
                nearest = (at_least - TOUCHING * self.body.size(), Some(index));
            }
            let gap = at_least - tool.radius();
            let slack = STALE_M + if gap > 0.0 { gap } else { 0.0 };
            if !part.is_settled || part.since * part.since >= 2.0 * tool.radius() * slack {
                // One that has not arrived says nothing of how near the body is.
                let short = part.since * part.since * 0.5 / tool.radius();
                let order = if part.is_settled { at_least - short } else { 0.0 };
                let mut entering = (order, Some(index));
                for slot in &mut due {
                    if entering.0 < slot.0 {
                        core::mem::swap(slot, &mut entering);
                    }
                }
            }
        }
        let mut visits = VISITS;
        for index in core::iter::once(nearest).chain(due).filter_map(|(_, index)| index) {
            let Some(Some(part)) = state.parts_mut().nth(index).filter(|_| visits > 0) else { continue };
            if !part.is_fresh() {
                self.visit(part);
                visits -= 1;
                if part.distance < best.0 {
                    best = (part.distance, Some(index));
                }
            }
        }
        if let Some(Some(Some(part))) = best.1.map(|index| state.parts().nth(index)) {
            state.pair = part.pair;
        }
    }

    /// A step of a part, and its plane.
    fn visit(&mut self, part: &mut Part) {
        // A corner's leaves it where it is.
        let region = Region::Solid { middle: part.middle, half: part.half };
        let switched = if part.is_border() {
            self.tick_on(&region, &mut part.pair, part.held).1
        } else {
            self.follow(&region, &mut part.pair).1
        };
        self.note(part);
        // On the far side it has not arrived.
        part.is_settled = !switched && part.normal != Vec3::ZERO;
    }

    /// Takes the plane of a part at its place.
    pub(super) fn note(&mut self, part: &mut Part) {
        let difference = part.pair.difference(self.placement);
        part.distance = sqrt(difference.length_squared());
        let is_in_front = part.pair.a.outward(self.body).dot(difference) < 0.0;
        part.normal = if is_in_front { -unit(difference) } else { Vec3::ZERO };
        (part.since, part.is_settled) = (0.0, true);
    }

    /// Motion of the core after which a part at a distance may be the nearest, or in contact.
    pub(super) fn rest(distance: f32, tool: &Tool, least: f32) -> f32 {
        let until_nearest = 0.5 * (distance - least);
        let until_contact = distance - tool.radius() - REACH_M;
        if until_nearest < until_contact { until_nearest } else { until_contact }
    }

    /// The nearest point of the body to a point of the core.
    pub(super) fn beneath(&mut self, b: Foot) -> Pair {
        let located = self.body.locate(self.placement.point_to_a(b.point()));
        self.evaluations += u32::from(located.evaluations);
        Pair { a: Foot::on(self.body, located.face, located.parameters), b, halvings: 0 }
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
                let moved = self.tick(&mut explorer);
                state.explorer = (moved != Moved::AtRest).then_some(explorer);
                if moved == Moved::AtRest && self.distance(&explorer) < bound {
                    self.keep(&state.pair, &mut state.rivals, explorer);
                }
                continue;
            }
            self.evaluations += 1;
            if let Visit::Start(start) = state.cells.visit(self.body, &self.region, self.placement, bound) {
                state.explorer = (!state.knows_cell_of(&start)).then_some(start);
            }
        }
    }

    /// Makes the nearest of pair, corners, edges, vertices and rivals the pair; drops rivals that are far, or one with another.
    fn exchange(&mut self, state: &mut ToolWitness, tool: &Tool, motion: f32) {
        let face = state.pair.a.face;
        // Of a convex body and a point the pair is all.
        let is_point = matches!(self.region, Region::Solid { half: Vec3::ZERO, .. }) && self.body.is_convex();
        state.vertices_rest_for -= motion;
        if let (false, true, Region::Solid { middle, half }) = (is_point, state.vertices.1 != face, self.region) {
            self.evaluations += 8;
            state.vertices_rest_for = 0.0;
            let ends = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
            state.vertices = (ends.map(|end| Foot::on(self.body, face, end)), face);
            for (number, border) in state.borders.iter_mut().enumerate() {
                let mut at = state.pair.a.parameters;
                at[number / 2] = if number % 2 == 0 { 0.0 } else { 1.0 };
                let pair = Pair::facing(Foot::on(self.body, face, at), &self.region, self.placement);
                let mut part = Part { held: [number < 2, number >= 2], ..Part::new(pair, middle, half) };
                self.note(&mut part);
                *border = Some(part);
            }
        }
        let mut least = self.distance(&state.pair) - NEARER * self.body.size();
        let (mut nearest, mut rest_for) = (None, f32::INFINITY);
        for (a, b) in state.vertices(&self.region, self.placement) {
            let distance = sqrt((a.point() - self.placement.point_to_a(b)).length_squared());
            let rests = Self::rest(distance, tool, least);
            rest_for = if rests < rest_for { rests } else { rest_for };
            if distance < least {
                (least, nearest) = (distance, Some(Pair { a: *a, b: Foot::in_solid(b), halvings: 0 }));
            }
        }
        if rest_for < f32::INFINITY {
            state.vertices_rest_for = rest_for;
        }
        if let Some(nearest) = nearest {
            state.pair = nearest;
        }
        for rival in state.rivals.iter_mut().flatten() {
            let distance = self.distance(rival);
            if distance < least {
                least = distance;
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
    }

    /// Whether the body has an inside: no open edge.
    pub(super) fn has_inside(&self) -> bool {
        self.body.edges().iter().all(|edge| edge.kind != EdgeKind::Open)
    }

    /// The sign test: whether the two support planes part the bodies. A rest of convex bodies is then their closest
    /// pair. A solid's nearest point needs no test.
    pub(super) fn is_global(&self, pair: &Pair) -> bool {
        let difference = pair.difference(self.placement);
        let of_body = pair.a.outward(self.body).dot(difference) < 0.0;
        of_body
            && match &self.region {
                Region::Solid { .. } => true,
                Region::Surface(core) => pair.b.outward(core).dot(self.placement.direction_to_b(difference)) > 0.0,
            }
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
