//! The parts of a pair that may become it, or come into contact: the core's corners and edges, the borders of the body's
//! face. Beside a convex body most of them wait, behind the plane of their last visit.

use super::scene::{NEARER, Scene, TOUCHING};
use super::step::{Foot, Pair};
use super::tool::{Region, Tool, unit};
use crate::math::{Vec3, saturate, sqrt};
use crate::patch::SurfacePoint;
use crate::track::Placement;

/// Gap below which a part of the core is looked at in every tick, metres: more than a proxy closes in one.
const REACH_M: f32 = 1.5e-3;
/// Parts of the core that are visited in a tick beside a convex body.
const VISITS: usize = 2;
/// By how much the plane of a part that waits for its turn may be nearer than the body, metres.
const STALE_M: f32 = 1.0e-6;

/// Corners of a core that are tracked.
pub(super) const CORNERS: usize = 8;
/// Pieces of a core's edges that are tracked: two of each of a box.
pub(super) const EDGES: usize = 24;
/// Borders of a face.
pub(super) const BORDERS: usize = 4;

/// The parts of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parts {
    /// The core's corners, each with its nearest point of the body.
    pub corners: [Option<Part>; CORNERS],
    /// The core's edges, each with its nearest pair.
    pub edges: [Option<Part>; EDGES],
    /// The borders of the body's face.
    pub borders: [Option<Part>; BORDERS],
    /// Corners and edges that the core has.
    pub count: [u8; 2],
    /// Which corners, borders and edges may be the nearest or in contact: a bit of each.
    awake: [u32; 3],
}

/// Corners and edges of the core, borders of the body's face.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    Corner,
    Border,
    Edge,
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

impl Parts {
    /// No part. No constant: that would be copied, all 8 kB of it, where only the marks of its places have to be set.
    #[inline(always)]
    pub const fn none() -> Self {
        Self { corners: [None; CORNERS], edges: [None; EDGES], borders: [None; BORDERS], count: [0; 2], awake: [0; 3] }
    }

    /// Whether there is none: beside a convex body the pair of a point is all.
    const fn is_empty(&self) -> bool {
        matches!((self.count, &self.borders[0]), ([0, 0], None))
    }

    /// The corners, the borders and the edges: those that there are come first.
    pub fn iter(&self) -> impl Iterator<Item = &Option<Part>> {
        let [corners, edges] = self.count.map(usize::from);
        self.corners.iter().take(corners).chain(&self.borders).chain(self.edges.iter().take(edges))
    }

    /// The same.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Option<Part>> {
        let [corners, edges] = self.count.map(usize::from);
        self.corners.iter_mut().take(corners).chain(&mut self.borders).chain(self.edges.iter_mut().take(edges))
    }

    /// Those corners, borders or edges that may be the nearest or in contact.
    pub fn awake(&self, kind: Kind) -> impl Iterator<Item = &Part> {
        let parts = match kind {
            Kind::Corner => &self.corners[..],
            Kind::Border => &self.borders[..],
            Kind::Edge => &self.edges[..],
        };
        let mut left = self.awake[kind as usize];
        core::iter::from_fn(move || {
            let index = left.trailing_zeros();
            left &= left.wrapping_sub(1);
            parts.get(index as usize)?.as_ref()
        })
    }

    /// The places of the borders, for those of another face.
    pub const fn changed_borders(&mut self) -> &mut [Option<Part>; BORDERS] {
        self.awake[Kind::Border as usize] = (1 << BORDERS) - 1;
        &mut self.borders
    }
}

impl Part {
    pub const fn new(pair: Pair, middle: Vec3, half: Vec3) -> Self {
        let (since, distance, normal) = (f32::INFINITY, 0.0, Vec3::ZERO);
        Self { pair, middle, half, held: [false; 2], rests_for: 0.0, since, is_settled: false, distance, normal }
    }

    /// A border of the body's face, across which a parameter is held.
    pub fn border(pair: Pair, (middle, half): (Vec3, Vec3), held: [bool; 2]) -> Self {
        Self { held, ..Self::new(pair, middle, half) }
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

    /// Takes a motion of the core, metres. Whether it may be the nearest or in contact then.
    #[inline]
    fn wakes(&mut self, motion: f32) -> bool {
        self.since += motion;
        self.rests_for -= motion;
        !self.is_at_rest()
    }

    /// Whether it can be neither the nearest nor in contact, and its pair was left where it was.
    pub fn is_at_rest(&self) -> bool {
        self.rests_for > 0.0
    }
}

/// Result of a look at the parts: the nearest, and those whose turn it is, by their indices.
struct Look<'a> {
    region: Region<'static>,
    tool: &'a Tool<'a>,
    /// Distance of the pair.
    least: f32,
    is_lean: bool,
    /// Of those that were visited.
    best: (f32, Option<usize>),
    /// One that may be nearer than the pair.
    nearest: (f32, Option<usize>),
    due: [(f32, Option<usize>); VISITS],
}

impl Look<'_> {
    /// A part that has moved far enough.
    fn at(&mut self, scene: &mut Scene, part: &mut Part, index: usize) {
        let (tool, least) = (self.tool, self.least);
        if !self.is_lean {
            scene.visit(part);
            part.rests_for = rest(part.distance, tool, least);
            if part.distance < self.best.0 && !part.is_at_rest() {
                self.best = (part.distance, Some(index));
            }
            return;
        }
        let at_least = part.least_distance(&self.region, scene.placement);
        part.rests_for = rest(at_least, tool, least);
        if part.rests_for > 0.0 {
            return;
        }
        // A corner before the edges that end in it, whose planes lean by rounding.
        if at_least < self.nearest.0 {
            self.nearest = (at_least - TOUCHING * scene.body.size(), Some(index));
        }
        let gap = at_least - tool.radius();
        let slack = STALE_M + if gap > 0.0 { gap } else { 0.0 };
        if !part.is_settled || part.since * part.since >= 2.0 * tool.radius() * slack {
            // One that has not arrived says nothing of how near the body is.
            let short = part.since * part.since * 0.5 / tool.radius();
            let order = if part.is_settled { at_least - short } else { 0.0 };
            let mut entering = (order, Some(index));
            for slot in &mut self.due {
                if entering.0 < slot.0 {
                    core::mem::swap(slot, &mut entering);
                }
            }
        }
    }
}

impl Scene<'_> {
    /// Steps of the parts that may be the nearest or in contact.
    ///
    /// If `is_lean`, beside a convex body, at most [`VISITS`] of them: first one that may be nearer than the pair, then the nearest of
    /// those whose planes may be nearer than the body by more than [`STALE_M`] and a share of their gaps. At a distance `d` a
    /// plane falls short by at most `m²/2d` after a motion of `m`, which counts as nearer too, so that each has its turn.
    pub(super) fn tick_parts(
        &mut self,
        parts: &mut Parts,
        best_pair: &mut Pair,
        tool: &Tool,
        (motion, is_lean): (f32, bool),
    ) {
        if parts.is_empty() {
            return;
        }
        let least = self.distance(best_pair);
        let level = least - NEARER * self.body.size();
        let region = self.region.solid();
        let none = [(f32::INFINITY, None); VISITS];
        let mut look = Look { region, tool, least, is_lean, best: (level, None), nearest: (level, None), due: none };
        let [corners, edges] = parts.count.map(usize::from);
        let mut first = 0;
        let Parts { corners: of_core, borders, edges: of_edges, awake, .. } = parts;
        let kinds = [(&mut of_core[..], corners), (&mut borders[..], BORDERS), (&mut of_edges[..], edges)];
        for ((kind, count), awake) in kinds.into_iter().zip(awake) {
            *awake = 0;
            for (index, part) in kind.iter_mut().take(count).enumerate() {
                if let Some(part) = part
                    && part.wakes(motion)
                {
                    look.at(self, part, first + index);
                    *awake |= u32::from(!part.is_at_rest()) << index;
                }
            }
            first += count;
        }
        let Look { mut best, nearest, due, .. } = look;
        let mut visits = VISITS;
        for index in core::iter::once(nearest).chain(due).filter_map(|(_, index)| index) {
            let Some(Some(part)) = parts.iter_mut().nth(index).filter(|_| visits > 0) else { continue };
            if !part.is_fresh() {
                self.visit(part);
                visits -= 1;
                if part.distance < best.0 {
                    best = (part.distance, Some(index));
                }
            }
        }
        if let Some(Some(Some(part))) = best.1.map(|index| parts.iter().nth(index)) {
            *best_pair = part.pair;
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
}

/// Motion of the core after which a part at a distance may be the nearest, or in contact.
pub(super) fn rest(distance: f32, tool: &Tool, least: f32) -> f32 {
    let until_nearest = 0.5 * (distance - least);
    let until_contact = distance - tool.radius() - REACH_M;
    if until_nearest < until_contact { until_nearest } else { until_contact }
}
