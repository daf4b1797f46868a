//! Any region as quads: the cheapest tiling that a search finds.
//!
//! A front of directed sides waits for quads on its left; at first it is the outline, holes and all. A quad takes its
//! sides out of the front and puts the others in, turned round; when nothing waits the region is tiled. The side with
//! the fewest quads to choose from goes first, and what costs more than the best tiling so far is left. Without points
//! inside there are `V/2 + h − 1` quads for `V` vertices and `h` holes; each point inside is one more.

use super::candidates::{Candidate, Candidates, Manner, Turning};
use super::plane::{Border, Edge, Plane, Vertex, cost, inward, middles, scale, vertices};
use crate::effort::Effort;
use crate::error::ImportError;
use crate::mesh::{Mesh, Quad, Side};
use crate::nurbs::Surface;
use crate::path::Path;
use glam::DVec2;
use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::f64::consts::TAU;
use std::hash::{Hash as _, Hasher as _};
use std::rc::Rc;

/// Quads tried in a search without points inside.
const TRIES: usize = 40_000;
/// Quads tried in a search with them, or with triangles, where there are far more to choose from.
const TRIES_INSIDE: usize = 2_500;
/// With more vertices than this, points inside leave too much to choose from.
const LARGE: usize = 22;
/// A tiling that costs less than this a quad is taken without looking whether points inside help.
const GOOD: f64 = 1.6;

/// Points inside a region, and its quads.
type Tiling = (Vec<DVec2>, Vec<Candidate>);

/// A hash of everything that a tiling follows from.
fn key(face: &str, plane: &Plane, scale: DVec2, manner: Manner) -> u64 {
    let mut hasher = DefaultHasher::new();
    (face, manner.turning == Turning::Free, manner.triangles).hash(&mut hasher);
    let mut firsts = HashMap::new();
    for (index, vertex) in plane.vertices.iter().enumerate() {
        // Two vertices may be one node.
        firsts.entry(vertex.node).or_insert(index).hash(&mut hasher);
    }
    for border in &plane.borders {
        (border.ends, border.place, border.points.len()).hash(&mut hasher);
    }
    let angles = plane.vertices.iter().filter_map(|vertex| vertex.angle).flatten();
    let points = plane.borders.iter().flat_map(|border| border.points.iter().copied());
    let numbers = points.chain(angles).chain([scale]).flat_map(|point| point.to_array().map(f64::to_bits));
    numbers.for_each(|number| number.hash(&mut hasher));
    hasher.finish()
}

/// Tiles a face's region.
///
/// # Errors
/// If no tiling was found.
pub fn quads(mesh: &mut Mesh<'_>, face: usize, manner: Manner) -> Result<Vec<Quad>, ImportError> {
    let scale = scale(mesh, face);
    let mut plane = Plane::new(mesh, face, scale);
    let key = key(&mesh.part.faces[face].name, &plane, scale, manner);
    let memory = &mesh.part.memory;
    let tiling: Option<Tiling> = memory.get(key).unwrap_or_else(|| {
        let tiling = search(mesh, face, manner, scale, &plane);
        // With more effort a search might have succeeded.
        if tiling.is_some() || !mesh.part.effort.is_spent() {
            memory.keep(key, tiling.clone());
        }
        tiling
    });
    let Some((points, found)) = tiling else {
        let count = mesh.regions[face].loops.iter().map(Vec::len).sum::<usize>();
        let reason = format!(
            "no division into quads was found for its outline of {count} sides ({})",
            mesh.part.faces[face].kind
        );
        return Err(ImportError::too_much(mesh.part, face, reason));
    };
    plane.vertices.extend(vertices(points));
    Ok(build(mesh, face, scale, &plane, &found))
}

fn search(mesh: &Mesh<'_>, face: usize, manner: Manner, scale: DVec2, plane: &Plane) -> Option<Tiling> {
    let (surface, effort) = (&mesh.part.faces[face].surface, &mesh.part.effort);
    let turn = |from: DVec2, to: DVec2| match manner.turning {
        Turning::Free => 0.0,
        Turning::Dear => turn(surface, from / scale, to / scale),
    };
    let mut best: Option<(f64, Plane, Vec<Candidate>)> = None;
    let is_large = plane.vertices.len() > LARGE;
    for round in 0..if is_large { 4 } else { 7 } {
        let mut trial = plane.clone();
        let points = match round {
            0 => Vec::new(),
            1 => inward(plane, 0.23),
            2 => middles(plane, 3),
            3 => [inward(plane, 0.3), middles(plane, 1)].concat(),
            4 => middles(plane, 6),
            5 => inward(plane, 0.23),
            _ => [inward(plane, 0.15), middles(plane, 4)].concat(),
        };
        trial.vertices.extend(vertices(points));
        let most = if manner.triangles || (1..4).contains(&round) { TRIES_INSIDE } else { TRIES };
        let found = Search::new(&trial, most, &turn, manner.triangles, effort)
            .run(best.as_ref().map_or(f64::INFINITY, |(cost, ..)| *cost));
        if let Some((cost, quads)) = found {
            let good = cost <= GOOD * quads.len() as f64;
            best = Some((cost, trial, quads));
            if good {
                break;
            }
        }
        if round >= 1 && best.is_some() {
            break;
        }
    }
    let found = best.map(|(_, trial, found)| (trial, found));
    let (mut trial, found) = found.or_else(|| behind_a_ring(plane, &turn, manner.triangles, effort))?;
    smooth(&mut trial, &found);
    let points = trial.vertices[plane.vertices.len()..].iter().map(|vertex| vertex.point).collect();
    Some((points, found))
}

/// How far a surface's normal turns along a straight line of its parameters, radians.
fn turn(surface: &Surface, from: DVec2, to: DVec2) -> f64 {
    const STEPS: usize = 8;
    let normal = |k: usize| surface.normal(from.lerp(to, k as f64 / STEPS as f64));
    let turns = (0..STEPS).map(|k| normal(k).angle_between(normal(k + 1)));
    turns.filter(|turn| turn.is_finite()).sum()
}

/// A ring along the outline, and a tiling of the rest.
fn behind_a_ring(
    outline: &Plane,
    turn: &dyn Fn(DVec2, DVec2) -> f64,
    triangles: bool,
    effort: &Effort,
) -> Option<(Plane, Vec<Candidate>)> {
    for depth in [0.3, 0.2, 0.4, 0.12] {
        let Some(mut ring) = Ring::new(outline, depth) else { continue };
        let bare = ring.within.clone();
        for inside in 0..4 {
            let points = middles(&bare, inside);
            ring.within = bare.clone();
            ring.within.vertices.extend(vertices(points));
            if let Some((_, found)) = Search::new(&ring.within, TRIES, turn, triangles, effort).run(f64::INFINITY) {
                return Some(ring.joined(&found));
            }
        }
    }
    None
}

struct Search<'p> {
    candidates: Candidates<'p>,
    effort: &'p Effort,
    tries: usize,
    most: usize,
    best: f64,
    quads: Option<Vec<Candidate>>,
    /// On the way: the quads so far, as places in lists.
    laid: Vec<(Rc<[Candidate]>, usize)>,
    /// The lines that a line rules out, once one was drawn.
    ruled_out: HashMap<[usize; 2], Bits>,
}

/// A set of small numbers.
#[derive(Clone, Default)]
struct Bits(Vec<u64>);

impl Bits {
    fn up_to(count: usize) -> Self {
        Self(vec![0; count.div_ceil(64)])
    }

    fn has(&self, index: usize) -> bool {
        self.0[index / 64] >> (index % 64) & 1 == 1
    }

    fn set(&mut self, index: usize, is_in: bool) {
        let bit = 1 << (index % 64);
        if is_in { self.0[index / 64] |= bit } else { self.0[index / 64] &= !bit }
    }

    fn add(&mut self, others: &Self) {
        self.0.iter_mut().zip(&others.0).for_each(|(word, other)| *word |= other);
    }
}

#[derive(Clone)]
struct State {
    front: Vec<Edge>,
    /// The same by [`Search::index`].
    waits: Bits,
    /// Lines that are drawn already, or cross one that is.
    barred: Bits,
    /// The points inside that quads use already.
    used: Bits,
    cost: f64,
}

impl<'p> Search<'p> {
    fn new(
        plane: &'p Plane,
        most: usize,
        turn: &'p dyn Fn(DVec2, DVec2) -> f64,
        triangles: bool,
        effort: &'p Effort,
    ) -> Self {
        let candidates = Candidates::new(plane, turn, triangles, effort);
        let (laid, ruled_out) = (Vec::new(), HashMap::new());
        Self { candidates, effort, tries: 0, most, best: f64::INFINITY, quads: None, laid, ruled_out }
    }

    fn run(mut self, bound: f64) -> Option<(f64, Vec<Candidate>)> {
        self.best = bound;
        let Plane { vertices, borders, .. } = self.candidates.plane;
        let front: Vec<Edge> = (0..borders.len()).map(Edge::Border).collect();
        let mut waits = Bits::up_to(borders.len() + vertices.len().pow(2));
        front.iter().for_each(|edge| waits.set(self.index(*edge), true));
        let barred = Bits::up_to(self.candidates.lines().len());
        self.step(&State { front, waits, barred, used: Bits::up_to(vertices.len()), cost: 0.0 });
        self.quads.map(|quads| (self.best, quads))
    }

    /// The place of an edge among all that there could be.
    fn index(&self, edge: Edge) -> usize {
        let Plane { vertices, borders, .. } = self.candidates.plane;
        match edge {
            Edge::Border(index) => index,
            Edge::Line(a, b) => borders.len() + a * vertices.len() + b,
        }
    }

    fn step(&mut self, state: &State) {
        if state.front.is_empty() {
            if state.cost < self.best {
                self.best = state.cost;
                self.quads = Some(self.laid.iter().map(|(all, index)| all[*index].clone()).collect());
            }
            return;
        }
        // A quad takes four sides out of the front at most.
        if state.cost + 0.25 * state.front.len() as f64 >= self.best || self.tries > self.most || self.effort.is_spent()
        {
            return;
        }
        let mut fewest: Option<(Rc<[Candidate]>, Vec<usize>)> = None;
        for edge in &state.front {
            let most = fewest.as_ref().map_or(usize::MAX, |(_, fitting)| fitting.len());
            let all = self.candidates.on(*edge);
            self.effort.spend(all.len() as u64);
            let fitting: Vec<usize> =
                (0..all.len()).filter(|index| self.fits(state, &all[*index])).take(most).collect();
            if fitting.len() < most {
                let none = fitting.is_empty();
                fewest = Some((all, fitting));
                if none {
                    break;
                }
            }
        }
        let Some((all, fitting)) = fewest else { return };
        for index in fitting {
            let candidate = &all[index];
            self.tries += 1;
            let mut next = state.clone();
            for edge in candidate.edges.into_iter().filter(|edge| !edge.is_point()) {
                if let Some(place) = next.front.iter().position(|waiting| *waiting == edge) {
                    next.front.swap_remove(place);
                    next.waits.set(self.index(edge), false);
                } else if let Edge::Line(a, b) = edge {
                    next.front.push(Edge::Line(b, a));
                    next.waits.set(self.index(Edge::Line(b, a)), true);
                    next.barred.add(self.ruled_out([a, b]));
                    for end in [a, b] {
                        next.used.set(end, self.candidates.plane.vertices[end].node.is_none());
                    }
                }
            }
            next.cost += candidate.cost;
            self.laid.push((Rc::clone(&all), index));
            self.step(&next);
            self.laid.pop();
        }
    }

    /// Whether a quad's sides wait, or are new lines that cross none, and it lies on no point that others use.
    fn fits(&self, state: &State, candidate: &Candidate) -> bool {
        let is_free = |edge: &Edge| match *edge {
            Edge::Border(_) => false,
            Edge::Line(a, b) => self.candidates.number(a, b).is_some_and(|line| !state.barred.has(line)),
        };
        let is_sound = |edge: &Edge| edge.is_point() || state.waits.has(self.index(*edge)) || is_free(edge);
        candidate.edges.iter().all(is_sound) && !candidate.covers.iter().any(|point| state.used.has(*point))
    }

    /// A line itself and all that cross it.
    fn ruled_out(&mut self, [a, b]: [usize; 2]) -> &Bits {
        let candidates = &self.candidates;
        let point = |k: usize| candidates.plane.vertices[k].point;
        self.ruled_out.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let mut lines = Bits::up_to(candidates.lines().len());
            for (index, [c, d]) in candidates.lines().iter().enumerate() {
                let is_ruled_out = match [a, b].iter().filter(|end| *end == c || *end == d).count() {
                    0 => crate::outline::meet([point(a), point(b)], [point(*c), point(*d)]),
                    1 => false,
                    _ => true,
                };
                lines.set(index, is_ruled_out);
            }
            lines
        })
    }
}

/// Moves the points inside to where the quads about them are best.
fn smooth(plane: &mut Plane, quads: &[Candidate]) {
    let inside: Vec<usize> = (0..plane.vertices.len()).filter(|k| plane.vertices[*k].node.is_none()).collect();
    let used: Vec<usize> = inside.into_iter().filter(|k| quads.iter().any(|quad| quad.corners.contains(k))).collect();
    let cost = |plane: &Plane, vertex: usize| -> f64 {
        let about = quads.iter().filter(|quad| quad.corners.contains(&vertex));
        about.map(|quad| cost_of(plane, quad)).sum()
    };
    for round in 0..24 {
        let share = 0.25 * 0.8_f64.powi(round);
        for vertex in &used {
            let here = plane.vertices[*vertex].point;
            let near = quads.iter().filter(|quad| quad.corners.contains(vertex)).flat_map(|quad| quad.corners);
            let reach = near.map(|k| plane.vertices[k].point.distance(here)).fold(0.0, f64::max);
            let mut best = (cost(plane, *vertex), here);
            for k in 0..8 {
                let point = here + DVec2::from_angle(f64::from(k) * std::f64::consts::FRAC_PI_4) * (share * reach);
                plane.vertices[*vertex].point = point;
                let value = cost(plane, *vertex);
                if value < best.0 && plane.contains(point) {
                    best = (value, point);
                }
            }
            plane.vertices[*vertex].point = best.1;
        }
    }
}

fn cost_of(plane: &Plane, quad: &Candidate) -> f64 {
    let has_point = quad.edges.iter().any(|edge| edge.is_point());
    super::plane::cost(&|s, t| plane.quad_at(&quad.edges, &quad.corners, s, t), has_point).unwrap_or(100.0)
}

/// Nodes, wires and sides of the quads that were found.
fn build(mesh: &mut Mesh<'_>, face: usize, scale: DVec2, plane: &Plane, found: &[Candidate]) -> Vec<Quad> {
    let mut nodes: HashMap<usize, usize> = HashMap::new();
    let mut lines: HashMap<[usize; 2], Side> = HashMap::new();
    let outline = mesh.regions[face].loops.clone();
    let mut quads = Vec::with_capacity(found.len());
    for quad in found {
        let mut sides = Vec::with_capacity(4);
        for edge in quad.edges {
            sides.push(match edge {
                Edge::Border(index) => {
                    let [of, side] = plane.borders[index].place;
                    outline[of][side].clone()
                }
                Edge::Line(a, b) if lines.contains_key(&[a, b]) => lines[&[a, b]].clone(),
                Edge::Line(a, b) => {
                    let mut node = |mesh: &mut Mesh<'_>, vertex: usize| match plane.vertices[vertex].node {
                        Some(node) => node,
                        None => *nodes.entry(vertex).or_insert_with(|| {
                            let uv = plane.vertices[vertex].point / scale;
                            let point = mesh.part.faces[face].surface.at(uv).point;
                            mesh.add_node(point)
                        }),
                    };
                    let ends = [node(mesh, a), node(mesh, b)];
                    let [from, to] = [a, b].map(|k| plane.vertices[k].point / scale);
                    if a == b {
                        Side::pole(ends[0], from, to)
                    } else {
                        let side = mesh.add_inside(face, ends, Path::line(from, to));
                        lines.insert([b, a], side.reversed());
                        side
                    }
                }
            });
        }
        if let Ok(sides) = <[Side; 4]>::try_from(sides) {
            quads.push(Quad { sides });
        }
    }
    quads
}

// A ring of quads along an outline, and the rest tiled within straight sides.
//
// Where an outline goes on smoothly at a vertex, a line has to leave there: two smooth vertices in a row leave a
// search without points inside nothing to choose. Behind a ring, a quad to each side, the sides are straight and
// every vertex is a corner.

/// A plane with the vertices of a ring, the ring's quads, and the region within as a plane of its own.
pub struct Ring {
    /// The whole, the ring's vertices behind the outline's.
    pub plane: Plane,
    /// Its quads.
    pub quads: Vec<Candidate>,
    /// The rest of the region.
    pub within: Plane,
}

impl Ring {
    /// The ring whose vertices lie so far in, as a part of the way across; `None` if a quad of it would fold.
    pub fn new(outline: &Plane, depth: f64) -> Option<Self> {
        let count = outline.vertices.len();
        let points: Vec<DVec2> = (0..count).map(|index| inward_from(outline, index, depth)).collect::<Option<_>>()?;
        let mut plane = outline.clone();
        plane.vertices.extend(super::plane::vertices(points.clone()));
        let mut quads = Vec::with_capacity(outline.borders.len());
        for (index, border) in outline.borders.iter().enumerate() {
            let [a, b] = border.ends;
            let (corners, edges) = (
                [a, b, count + b, count + a],
                [
                    Edge::Border(index),
                    Edge::Line(b, count + b),
                    Edge::Line(count + b, count + a),
                    Edge::Line(count + a, a),
                ],
            );
            let cost = cost(&|s, t| plane.quad_at(&edges, &corners, s, t), false)?;
            quads.push(Candidate { corners, edges, cost, covers: Vec::new().into() });
        }
        let within = within(outline, &points);
        within.is_simple().then_some(Self { plane, quads, within })
    }

    /// The whole with the quads of the region within.
    pub fn joined(&self, found: &[Candidate]) -> (Plane, Vec<Candidate>) {
        // Behind the outline's vertices as many of the ring, and points that were put inside.
        let first = self.plane.vertices.len() / 2;
        let mut plane = self.plane.clone();
        plane.vertices.extend(self.within.vertices[first..].iter().copied());
        let place = |vertex: usize| first + vertex;
        let edge = |edge: &Edge| {
            let [a, b] = match *edge {
                Edge::Border(index) => self.within.borders[index].ends,
                Edge::Line(a, b) => [a, b],
            };
            Edge::Line(place(a), place(b))
        };
        let moved = found.iter().map(|quad| Candidate {
            corners: quad.corners.map(place),
            edges: quad.edges.each_ref().map(edge),
            cost: quad.cost,
            covers: Vec::new().into(),
        });
        let quads = self.quads.iter().cloned().chain(moved).collect();
        (plane, quads)
    }
}

/// A point on the line that halves the angle at a vertex.
fn inward_from(plane: &Plane, index: usize, depth: f64) -> Option<DVec2> {
    let Vertex { point, angle, .. } = plane.vertices[index];
    let [out, back] = angle?;
    let whole = out.perp_dot(back).atan2(out.dot(back)).rem_euclid(TAU);
    let whole = if whole < 1e-9 { TAU } else { whole };
    let way = DVec2::from_angle(0.5 * whole).rotate(out);
    let far = crate::divide::plane::hit(plane, point, way)?;
    // No farther than its sides are long: a wide region has a narrow ring.
    let sides = plane.borders.iter().filter(|border| border.ends.contains(&index));
    let length =
        sides.clone().map(|border| border.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>());
    let length = length.fold(f64::INFINITY, f64::min);
    // Nor so far that it would meet the ring of another loop.
    let others = plane.polygons.iter().filter(|polygon| !polygon.contains(&point)).flatten();
    let clear = others.flat_map(|other| sides.clone().map(|border| distance(*other, &border.points)));
    let clear = clear.fold(f64::INFINITY, f64::min);
    Some(point + way * (depth * far).min(0.5 * length).min(depth * clear))
}

/// Of a point from a line through points.
fn distance(point: DVec2, line: &[DVec2]) -> f64 {
    let of = |pair: &[DVec2]| {
        let way = pair[1] - pair[0];
        let along = ((point - pair[0]).dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        point.distance(pair[0] + way * along)
    };
    line.windows(2).map(of).fold(f64::INFINITY, f64::min)
}

/// The region between the ring's inner sides.
fn within(outline: &Plane, points: &[DVec2]) -> Plane {
    let mut vertices: Vec<Vertex> =
        points.iter().map(|point| Vertex { point: *point, node: Some(0), angle: None }).collect();
    // Different nodes: those of one node do not see each other.
    (vertices.iter_mut().enumerate()).for_each(|(index, vertex)| vertex.node = Some(index));
    let mut borders = Vec::with_capacity(outline.borders.len());
    for border in &outline.borders {
        let [a, b] = border.ends;
        let way = (points[b] - points[a]).normalize_or_zero();
        vertices[a].angle = Some([way, vertices[a].angle.map_or(way, |angle| angle[1])]);
        vertices[b].angle = Some([vertices[b].angle.map_or(-way, |angle| angle[0]), -way]);
        borders.push(Border { points: vec![points[a], points[b]], ..border.clone() });
    }
    let loops = outline.borders.iter().map(|border| border.place[0]).max().map_or(0, |last| last + 1);
    let polygon = |index: usize| {
        outline.borders.iter().filter(|border| border.place[0] == index).map(|border| points[border.ends[0]]).collect()
    };
    Plane { vertices, borders, polygons: (0..loops).map(polygon).collect() }
}
