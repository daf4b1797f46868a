//! The location of a tool without history, one evaluation of a patch or one cold query of a point after another: at once
//! for a query, a few a tick for a loop.

use super::cells::Visit;
use super::common_normal;
use super::parts::{Part, rest};
use super::scene::{NEARER, Scene, TOUCHING};
use super::step::{Foot, Moved, Pair};
use super::tool::{Core, Region, Tool};
use super::tracker::{Closest, LOOKAHEAD, MAX_CELLS, ToolStatus, ToolWitness};
use crate::body::Body;
use crate::math::Vec3;
use crate::track::Placement;

/// Maximum steps of a descent.
pub(super) const MAX_STEPS: u8 = 48;
/// Steps without a fall of the distance after which a descent ends.
const MAX_STALLS: u8 = 12;
/// Steps at rest in a row after which a descent ends.
const RESTS: u8 = 3;
/// Rounds of projections in turn before a descent.
const ROUNDS: u8 = 3;
/// Maximum ticks of a loop's search; the audit does the rest.
const MAX_SEARCH: u16 = 256;
/// Evaluations in a tick of a loop beside a convex body, and at least, after which no other step follows.
const EVALUATIONS: u16 = 1;

/// How far a location has come. The pairs found so far are in the tracker's state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Location {
    stage: Stage,
    descent: Descent,
    /// Whether the pair's last descent came to rest.
    is_at_rest: bool,
    /// Whether the signs of the normals prove the pair.
    is_proved: bool,
    /// Whether the descent is that from a corner or an edge, which were nearer.
    is_again: bool,
    visited: u16,
    /// Ticks of a loop in the search.
    searched: u16,
    status: ToolStatus,
    /// Of the cores, metres; minus the depth where they intersect.
    distance: f32,
    evaluations: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// Projections in turn on body and core, which on convex ones tend to the closest pair from any start.
    Project {
        round: u8,
    },
    /// The pair's descent. The signs of the normals prove the result on convex bodies.
    Descend,
    /// The places of the core's corners.
    Corners,
    /// A corner of the core.
    Corner {
        index: u8,
    },
    /// An edge of the core: its projections in turn, then steps.
    Edge {
        index: u8,
        step: u8,
    },
    /// A walk over the cells of the body that can hold a nearer pair.
    Search,
    /// The descent from one of them.
    Explore,
    /// Another descent of the pair, in case that none has come to rest.
    Settle {
        round: u8,
    },
    /// Whether body and core intersect.
    Part,
    Done,
}

impl Location {
    pub const START: Self = Self {
        stage: Stage::Project { round: 0 },
        descent: Descent { rests: 0, stalls: 0, steps: 0, least: 0.0 },
        is_at_rest: false,
        is_proved: false,
        is_again: false,
        visited: 0,
        searched: 0,
        status: ToolStatus::AtRest,
        distance: 0.0,
        evaluations: 0,
    };

    pub const fn is_done(&self) -> bool {
        matches!(self.stage, Stage::Done)
    }

    /// Evaluations spent so far.
    pub const fn evaluations(&self) -> u32 {
        self.evaluations
    }

    /// The result, once it is done.
    pub const fn closest(&self, state: &ToolWitness, tool: &Tool) -> Closest {
        let pair = state.pair();
        Closest {
            distance: self.distance - tool.radius(),
            body: pair.a.point(),
            core: pair.b.point(),
            evaluations: self.evaluations,
            status: self.status,
        }
    }

    /// A tick of a loop: a cold query of a point, or steps of some [`EVALUATIONS`], beside a body that is not convex as
    /// many as the audit's. The search ends after [`MAX_SEARCH`], with the best pair.
    pub fn tick(&mut self, body: &Body, tool: &Tool, state: &mut ToolWitness, cells: u16) {
        // Fewer than the audit's in contact, where each is cheaper.
        let cells = cells - cells / 4;
        let most = if body.is_convex() || cells < EVALUATIONS { EVALUATIONS } else { cells };
        let before = self.evaluations;
        self.searched += u16::from(self.is_searching());
        for _ in 0..most {
            self.step(body, tool, state, false);
            if self.evaluations - before >= u32::from(most) || self.is_next_cold() || self.is_done() {
                break;
            }
        }
    }

    const fn is_searching(&self) -> bool {
        matches!(self.stage, Stage::Search | Stage::Explore)
    }

    /// Whether the next step is a cold query.
    const fn is_next_cold(&self) -> bool {
        match self.stage {
            Stage::Project { .. } | Stage::Corner { .. } => true,
            Stage::Edge { step, .. } => step < ROUNDS,
            _ => false,
        }
    }

    /// One step, at the pose that the state was made for: at most a cold query of a point and an evaluation of the
    /// body, or a step of a pair with its switches. A query searches the common normal of smooth bodies that intersect as
    /// well, in one step of some hundred evaluations.
    fn step(&mut self, body: &Body, tool: &Tool, state: &mut ToolWitness, is_query: bool) {
        let (placement, region) = (*state.placement(), tool.region());
        let mut scene = Scene { body, region, placement: &placement, evaluations: 0 };
        self.stage = self.advance(&mut scene, tool, state, is_query);
        self.evaluations += scene.evaluations;
    }

    fn advance(&mut self, scene: &mut Scene, tool: &Tool, state: &mut ToolWitness, is_query: bool) -> Stage {
        let region = scene.region;
        match self.stage {
            Stage::Project { round: 0 } => {
                let (point, ..) = region.nearest(scene.placement.point_to_b(Vec3::ZERO));
                state.pair = scene.beneath(Foot::in_solid(point));
                Stage::Project { round: 1 }
            }
            Stage::Project { round } => {
                let pair = Pair::facing(state.pair.a, &region, scene.placement);
                state.pair.a = scene.beneath(Foot::in_solid(pair.b.point())).a;
                if round < ROUNDS {
                    return Stage::Project { round: round + 1 };
                }
                state.pair = Pair::facing(state.pair.a, &region, scene.placement);
                self.descent = Descent::start(scene, &state.pair);
                Stage::Descend
            }
            Stage::Descend => {
                let Some(rests) = self.descent.step(scene, &mut state.pair) else { return Stage::Descend };
                self.is_at_rest = rests;
                // A descent that has stalled proves nothing.
                self.is_proved = self.descent.rests() && scene.body.is_convex() && scene.is_global(&state.pair);
                match (self.is_again, self.is_proved) {
                    (false, _) => Stage::Corners,
                    (true, false) => Stage::Search,
                    (true, true) => Stage::Part,
                }
            }
            Stage::Corners => {
                let a = state.pair.a;
                state.parts.corners = tool
                    .corners()
                    .map(|corner| corner.map(|b| Part::new(Pair { a, b, halvings: 0 }, b.point(), Vec3::ZERO)));
                state.parts.count = [state.parts.corners.iter().flatten().count() as u8, 0];
                Stage::Corner { index: 0 }
            }
            Stage::Corner { index } => {
                if let Some(corner) = state.parts.corners.get_mut(usize::from(index)).and_then(Option::as_mut) {
                    corner.pair = scene.beneath(corner.pair.b);
                    scene.note(corner);
                    return Stage::Corner { index: index + 1 };
                }
                Stage::Edge { index: 0, step: 0 }
            }
            Stage::Edge { index, step } => self.edge(scene, tool, state, (index, step)),
            _ if self.is_searching() && self.searched > MAX_SEARCH => {
                self.status = ToolStatus::StepLimit;
                self.settle(scene, state)
            }
            Stage::Search => self.search(scene, state),
            Stage::Explore => {
                let Some(mut pair) = state.explorer else { return Stage::Search };
                let rests = self.descent.step(scene, &mut pair);
                state.explorer = rests.is_none().then_some(pair);
                let Some(rests) = rests else { return Stage::Explore };
                let least = scene.distance(&state.pair);
                if scene.distance(&pair) < least - NEARER * scene.body.size() {
                    pair = core::mem::replace(&mut state.pair, pair);
                    self.is_at_rest = rests;
                }
                scene.keep(&state.pair, &mut state.rivals, pair);
                self.next_cell(scene, state)
            }
            Stage::Settle { round } => {
                if self.is_at_rest || round == ROUNDS {
                    if !self.is_at_rest {
                        self.status = ToolStatus::StepLimit;
                    }
                    return Stage::Part;
                }
                let Some(rests) = self.descent.step(scene, &mut state.pair) else { return self.stage };
                self.is_at_rest = rests;
                self.descent = Descent::start(scene, &state.pair);
                Stage::Settle { round: round + 1 }
            }
            Stage::Part => {
                self.part(scene, tool, state, is_query);
                Stage::Done
            }
            Stage::Done => Stage::Done,
        }
    }

    fn search(&mut self, scene: &mut Scene, state: &mut ToolWitness) -> Stage {
        let margin = if scene.body.is_convex() { 0.0 } else { LOOKAHEAD * scene.body.size() };
        let bound = scene.distance(&state.pair) + margin;
        (self.visited, scene.evaluations) = (self.visited + 1, scene.evaluations + 1);
        match state.cells.visit(scene.body, &scene.region, scene.placement, bound) {
            Visit::End => return self.settle(scene, state),
            Visit::Start(start) if !state.knows_cell_of(&start) => {
                (state.explorer, self.descent) = (Some(start), Descent::start(scene, &start));
                return Stage::Explore;
            }
            Visit::Start(_) | Visit::Nothing => {}
        }
        self.next_cell(scene, state)
    }

    fn next_cell(&mut self, scene: &Scene, state: &mut ToolWitness) -> Stage {
        if self.visited < MAX_CELLS {
            return Stage::Search;
        }
        self.status = ToolStatus::StepLimit;
        self.settle(scene, state)
    }

    fn settle(&mut self, scene: &Scene, state: &mut ToolWitness) -> Stage {
        state.restart_audit();
        self.descent = Descent::start(scene, &state.pair);
        Stage::Settle { round: 0 }
    }

    fn part(&mut self, scene: &mut Scene, tool: &Tool, state: &mut ToolWitness, is_query: bool) {
        let body = scene.body;
        self.distance = scene.distance(&state.pair);
        let is_apart = self.distance > TOUCHING * body.size() && (scene.is_global(&state.pair) || !scene.has_inside());
        if !is_apart {
            (self.status, self.distance) = (ToolStatus::Inside, -self.distance);
            if let Core::Body(core) = *tool.core()
                && is_query
                && common_normal::is_smooth(body)
                && common_normal::is_smooth(core)
                && let Some((at, depth)) = common_normal::locate(body, core, scene.placement, &mut scene.evaluations)
            {
                (state.pair, self.distance, state.is_inside) = (at, -depth, true);
            }
        }
        let least = scene.distance(&state.pair);
        for part in state.parts.iter_mut().flatten() {
            part.rests_for = rest(part.distance, tool, least);
        }
    }

    /// Makes the nearest of pair, corners and edges the pair, and searches what else there may be. Between flats that are
    /// nearly parallel a pair that rests may be far from a corner that is nearer by more than rounding.
    fn compare(&mut self, scene: &Scene, state: &mut ToolWitness) -> Stage {
        let mut least = scene.distance(&state.pair) - NEARER * scene.body.size();
        for part in state.parts.iter().flatten() {
            if part.distance < least {
                (least, self.is_at_rest) = (part.distance, false);
                state.pair = part.pair;
            }
        }
        if self.is_proved {
            return Stage::Part;
        }
        if scene.body.is_convex() && !self.is_at_rest {
            (self.is_again, self.descent) = (true, Descent::start(scene, &state.pair));
            return Stage::Descend;
        }
        Stage::Search
    }

    /// A step of the closest pair of the body and an edge, from that of the core.
    fn edge(&mut self, scene: &mut Scene, tool: &Tool, state: &mut ToolWitness, (index, step): (u8, u8)) -> Stage {
        let slot = usize::from(index);
        let Some((middle, half)) = tool.edges().nth(slot).filter(|_| slot < state.parts.edges.len()) else {
            return self.compare(scene, state);
        };
        let edge = Region::Solid { middle, half };
        let mut pair = match &state.parts.edges[slot] {
            Some(part) if step > 0 => part.pair,
            _ => Pair::facing(state.pair.a, &edge, scene.placement),
        };
        let before = scene.distance(&pair);
        let is_settled = if step < ROUNDS {
            pair = Pair::facing(scene.beneath(pair.b).a, &edge, scene.placement);
            step > 0 && scene.distance(&pair) >= before - NEARER * scene.body.size()
        } else {
            scene.tick_on(&edge, &mut pair, [false; 2]).0 == Moved::AtRest
        };
        let mut part = Part::new(pair, middle, half);
        scene.note(&mut part);
        state.parts.edges[slot] = Some(part);
        state.parts.count[1] = index + 1;
        match (is_settled, step + 1) {
            (true, ..=ROUNDS) => Stage::Edge { index, step: ROUNDS },
            (false, next) if next < ROUNDS + MAX_STALLS => Stage::Edge { index, step: next },
            _ => Stage::Edge { index: index + 1, step: 0 },
        }
    }
}

/// Steps until a pair rests.
///
/// Steps at rest still refine the points. Where rounding hands a point to and fro between two faces, the distance tells.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Descent {
    rests: u8,
    stalls: u8,
    steps: u8,
    least: f32,
}

impl Descent {
    fn start(scene: &Scene, pair: &Pair) -> Self {
        Self { rests: 0, stalls: 0, steps: 0, least: scene.distance(pair) }
    }

    /// Whether the last steps promised no fall of the distance.
    const fn rests(&self) -> bool {
        self.rests == RESTS
    }

    /// One step. At the end, whether the pair rests, or at least stays.
    fn step(&mut self, scene: &mut Scene, pair: &mut Pair) -> Option<bool> {
        self.rests = if scene.tick(pair) == Moved::AtRest { self.rests + 1 } else { 0 };
        let distance = scene.distance(pair);
        let falls = distance < self.least - NEARER * scene.body.size();
        (self.stalls, self.least) = if falls { (0, distance) } else { (self.stalls + 1, self.least) };
        self.steps += 1;
        if self.rests() || self.stalls == MAX_STALLS {
            return Some(true);
        }
        (self.steps == MAX_STEPS).then_some(false)
    }
}

impl<'a> Body<'a> {
    /// Finds the closest pair of this body and a tool, without history.
    ///
    /// Projections in turn on body and core, which on convex ones tend to the closest pair from any start, then the
    /// joint step. The signs of the normals prove the result on convex bodies. Otherwise all cells of the body that can
    /// hold a nearer point are searched, at most [`MAX_CELLS`].
    pub fn locate_tool(&self, tool: &Tool, placement: &Placement) -> (ToolWitness, Closest) {
        let (mut location, mut state) = (Location::START, ToolWitness::unlocated(placement));
        // A cell is visited, and at most followed by a descent; all else is little beside it.
        for _ in 0..(u32::from(MAX_CELLS) + 64) * (u32::from(MAX_STEPS) + 1) {
            if location.is_done() {
                break;
            }
            location.step(self, tool, &mut state, true);
        }
        (state, location.closest(&state, tool))
    }
}
