//! The stored table of a patch in `f64`: the surface the target has, without the rounding of its arithmetic.

use crate::BakedPatch;
use glam::{DVec3, DVec4, Vec4Swizzles as _};
use palpate::patch::span_centre;

/// A patch from its stored coefficients.
#[derive(Clone, Debug)]
pub struct StoredSurface {
    degree: [usize; 2],
    breaks: [Vec<f32>; 2],
    spans: Vec<Vec<[f64; 4]>>,
}

/// A point with its derivatives, metres per unit of parameter and unit squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredPoint {
    /// `f`.
    pub point: DVec3,
    /// `f_u`, `f_v`.
    pub first: [DVec3; 2],
    /// `f_uu`, `f_uv`, `f_vv`.
    pub second: [DVec3; 3],
}

impl StoredSurface {
    /// Widens the numbers of a table.
    pub fn new(patch: &BakedPatch) -> Self {
        let degree = patch.degree.map(usize::from);
        let count = (patch.breaks[0].len() - 1) * (patch.breaks[1].len() - 1);
        let spans = (0..count).map(|span| patch.coefficients.homogeneous_span(degree, span)).collect();
        Self { degree, breaks: patch.breaks.clone(), spans }
    }

    /// Evaluates at `(u, v)`.
    pub fn evaluate(&self, parameters: [f64; 2]) -> StoredPoint {
        let [(i, s), (j, t)] = [0, 1].map(|axis| {
            let breaks = &self.breaks[axis];
            let inner = &breaks[1..breaks.len() - 1];
            let span = inner.partition_point(|border| f64::from(*border) <= parameters[axis]);
            (span, parameters[axis] - f64::from(span_centre(breaks[span], breaks[span + 1])))
        });
        let powers = &self.spans[i * (self.breaks[1].len() - 1) + j];
        // Horner with two derivatives, half the second: rows along t, then along s.
        let mut sums = [[DVec4::ZERO; 3]; 3];
        for row in powers.chunks_exact(self.degree[1] + 1).rev() {
            let mut along = [DVec4::ZERO; 3];
            for entry in row.iter().rev() {
                along = [along[0] * t + DVec4::from_array(*entry), along[1] * t + along[0], along[2] * t + along[1]];
            }
            for (column, value) in along.iter().enumerate() {
                let [zeroth, once, twice] = [sums[0][column], sums[1][column], sums[2][column]];
                (sums[0][column], sums[1][column], sums[2][column]) =
                    (zeroth * s + *value, once * s + zeroth, twice * s + once);
            }
        }
        let (f, f_u, f_v) = (sums[0][0], sums[1][0], sums[0][1]);
        let (f_uu, f_uv, f_vv) = (sums[2][0] * 2.0, sums[1][1], sums[0][2] * 2.0);
        let inverse = 1.0 / f.w;
        let point = f.xyz() * inverse;
        let first = [f_u, f_v].map(|d| (d.xyz() - point * d.w) * inverse);
        let second = [
            f_uu.xyz() - first[0] * (2.0 * f_u.w) - point * f_uu.w,
            f_uv.xyz() - first[0] * f_v.w - first[1] * f_u.w - point * f_uv.w,
            f_vv.xyz() - first[1] * (2.0 * f_v.w) - point * f_vv.w,
        ];
        StoredPoint { point, first, second: second.map(|d| d * inverse) }
    }

    /// A local minimum of the distance over a rectangle of parameters: projected Newton from a start in it, with the
    /// steps it took.
    pub fn descend(&self, query: DVec3, start: [f64; 2], rectangle: [[f64; 2]; 2]) -> Minimum {
        let [low, high] = rectangle;
        let mut at = start;
        let mut here = self.evaluate(at);
        let mut evaluations = 1;
        for _ in 0..60 {
            let difference = here.point - query;
            let gradient = here.first.map(|tangent| difference.dot(tangent));
            let held =
                [0, 1].map(|i| (at[i] <= low[i] && gradient[i] >= 0.0) || (at[i] >= high[i] && gradient[i] <= 0.0));
            let direction = descent(&here, difference, gradient, held);
            if direction == [0.0, 0.0] {
                break;
            }
            let value = difference.length_squared();
            // Of φ a step gains at most this: nothing that doubles would show.
            if -(gradient[0] * direction[0] + gradient[1] * direction[1]) <= 1e-15 * value {
                break;
            }
            let mut scale = 1.0;
            let mut moved = None;
            while scale > 1e-10 {
                let next = [0, 1].map(|i| (at[i] + scale * direction[i]).clamp(low[i], high[i]));
                let there = self.evaluate(next);
                evaluations += 1;
                if there.point.distance_squared(query) < value {
                    moved = Some((next, there));
                    break;
                }
                scale *= 0.5;
            }
            let Some(next) = moved else { break };
            (at, here) = next;
        }
        Minimum { parameters: at, point: here.point, distance: here.point.distance(query), evaluations }
    }
}

/// Where a descent ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    /// `(u, v)`.
    pub parameters: [f64; 2],
    /// `f(u, v)`.
    pub point: DVec3,
    /// From the query, metres.
    pub distance: f64,
    /// Evaluations spent.
    pub evaluations: usize,
}

/// The Newton direction in the free parameters where the second derivative is positive definite, else the Gauss–Newton
/// one.
fn descent(here: &StoredPoint, difference: DVec3, gradient: [f64; 2], held: [bool; 2]) -> [f64; 2] {
    let [e, g] = here.first.map(|tangent| tangent.length_squared().max(1e-300));
    let f = here.first[0].dot(here.first[1]);
    let [uu, uv, vv] = here.second.map(|second| difference.dot(second));
    let alone = |i: usize| {
        let (plain, bent) = if i == 0 { (e, e + uu) } else { (g, g + vv) };
        -gradient[i] / if bent > 1e-6 * plain { bent } else { plain }
    };
    let solve = |[a, b, c]: [f64; 3]| {
        let determinant = a * c - b * b;
        (a > 0.0 && determinant > 1e-12 * a * c.abs()).then(|| {
            [(b * gradient[1] - c * gradient[0]) / determinant, (b * gradient[0] - a * gradient[1]) / determinant]
        })
    };
    match held {
        [true, true] => [0.0, 0.0],
        [true, false] => [0.0, alone(1)],
        [false, true] => [alone(0), 0.0],
        [false, false] => {
            solve([e + uu, f + uv, g + vv]).or_else(|| solve([e, f, g])).unwrap_or([-gradient[0] / e, -gradient[1] / g])
        }
    }
}

// Which borders of faces coincide: what the locator needs to know of a body's features.

/// A side of a face: `u = 0`, `u = 1`, `v = 0`, `v = 1` are 0 to 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BorderSide {
    /// The face.
    pub face: u16,
    /// Its side.
    pub side: u8,
    /// Whether it runs against the first side of its seam.
    pub reversed: bool,
}

/// A corner of a face: bit 0 for `u = 1`, bit 1 for `v = 1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BorderCorner {
    /// The face.
    pub face: u16,
    /// Its corner.
    pub corner: u8,
}

/// The seams of a body. The first member of each owns it: its candidates stand for all.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seams {
    /// Border curves with the sides that lie on them: one if open.
    pub edges: Vec<Vec<BorderSide>>,
    /// Points with the corners that lie on them; a side that is one point brings both its corners.
    pub vertices: Vec<Vec<BorderCorner>>,
    /// For each face, which sides are one point.
    pub poles: Vec<[bool; 4]>,
}

/// Parameters of a point of a side, `t` along it.
pub(super) fn on_side(side: u8, t: f64) -> [f64; 2] {
    match side {
        0 => [0.0, t],
        1 => [1.0, t],
        2 => [t, 0.0],
        _ => [t, 1.0],
    }
}

/// Parameters of a corner.
pub(super) fn at_corner(corner: u8) -> [f64; 2] {
    [f64::from(corner & 1), f64::from(corner >> 1)]
}

impl Seams {
    /// Finds the borders that coincide within `tolerance`, metres, by comparing 9 points of each.
    pub fn find(faces: &[StoredSurface], tolerance: f64) -> Self {
        const SAMPLES: usize = 9;
        let points = |face: usize, side: u8| -> [DVec3; SAMPLES] {
            std::array::from_fn(|k| faces[face].evaluate(on_side(side, k as f64 / (SAMPLES - 1) as f64)).point)
        };
        let same = |a: &[DVec3; SAMPLES], b: &mut dyn Iterator<Item = &DVec3>| {
            a.iter().zip(b).all(|(a, b)| a.distance(*b) <= tolerance)
        };
        let mut edges: Vec<(Vec<BorderSide>, [DVec3; SAMPLES])> = Vec::new();
        let mut vertices: Vec<(Vec<BorderCorner>, DVec3)> = Vec::new();
        let mut poles = vec![[false; 4]; faces.len()];
        for face in 0..faces.len() {
            for side in 0..4_u8 {
                let line = points(face, side);
                if line.iter().all(|point| point.distance(line[0]) <= tolerance) {
                    poles[face][usize::from(side)] = true;
                    continue;
                }
                let member = |reversed| BorderSide { face: face as u16, side, reversed };
                let found = edges.iter_mut().find_map(|(members, other)| {
                    let forward = same(&line, &mut other.iter());
                    (forward || same(&line, &mut other.iter().rev())).then_some((members, !forward))
                });
                match found {
                    Some((members, reversed)) => members.push(member(reversed)),
                    None => edges.push((vec![member(false)], line)),
                }
            }
            for corner in 0..4_u8 {
                let point = faces[face].evaluate(at_corner(corner)).point;
                let member = BorderCorner { face: face as u16, corner };
                match vertices.iter_mut().find(|(_, other)| other.distance(point) <= tolerance) {
                    Some((members, _)) => members.push(member),
                    None => vertices.push((vec![member], point)),
                }
            }
        }
        Self {
            edges: edges.into_iter().map(|(members, _)| members).collect(),
            vertices: vertices.into_iter().map(|(members, _)| members).collect(),
            poles,
        }
    }
}

// Points of all faces in a tree of boxes, for the one nearest to a probe.

/// Intervals of the grid on each face.
const INTERVALS: usize = 16;
/// Intervals of a leaf of the tree: a block of the grid.
const BLOCK: usize = 4;

/// Grids of points on all faces.
pub(super) struct Samples {
    points: Vec<Sample>,
    /// The root first; a node stores the start of its second half.
    nodes: Vec<Node>,
}

/// A point of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub face: u16,
    pub parameters: [f64; 2],
    pub point: DVec3,
}

/// A box with its content.
#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    holds: Holds,
}

#[derive(Clone, Copy, Debug)]
enum Holds {
    /// The next node, and the one of this index.
    Nodes(usize),
    /// A range of the points.
    Points(usize, usize),
}

impl Samples {
    pub(super) fn new(surfaces: &[StoredSurface]) -> Self {
        let mut points = Vec::new();
        let mut blocks = Vec::new();
        for (face, surface) in surfaces.iter().enumerate() {
            for block in 0..(INTERVALS / BLOCK) * (INTERVALS / BLOCK) {
                let first = [block / (INTERVALS / BLOCK), block % (INTERVALS / BLOCK)].map(|index| index * BLOCK);
                let begin = points.len();
                points.extend((0..(BLOCK + 1) * (BLOCK + 1)).map(|index| {
                    let steps = [first[0] + index / (BLOCK + 1), first[1] + index % (BLOCK + 1)];
                    let parameters = steps.map(|step| step as f64 / INTERVALS as f64);
                    Sample { face: face as u16, parameters, point: surface.evaluate(parameters).point }
                }));
                let [low, high] = bounds(points[begin..].iter().map(|sample| [sample.point; 2]));
                blocks.push(Node { low, high, holds: Holds::Points(begin, points.len()) });
            }
        }
        let mut nodes = Vec::with_capacity(2 * blocks.len());
        build(&mut nodes, &mut blocks);
        Self { points, nodes }
    }

    /// The nearest one; `None` if there are no faces.
    pub(super) fn nearest(&self, query: DVec3) -> Option<&Sample> {
        let mut best: Option<(f64, &Sample)> = None;
        let mut open = vec![0];
        while let Some(index) = open.pop() {
            let node = self.nodes.get(index)?;
            let away = |node: &Node| query.distance_squared(query.clamp(node.low, node.high));
            if best.is_some_and(|(least, _)| away(node) >= least) {
                continue;
            }
            match node.holds {
                Holds::Points(begin, end) => {
                    for sample in &self.points[begin..end] {
                        let squared = sample.point.distance_squared(query);
                        if best.is_none_or(|(least, _)| squared < least) {
                            best = Some((squared, sample));
                        }
                    }
                }
                Holds::Nodes(second) => {
                    let first_is_nearer = away(&self.nodes[index + 1]) <= away(&self.nodes[second]);
                    open.extend(if first_is_nearer { [second, index + 1] } else { [index + 1, second] });
                }
            }
        }
        best.map(|(_, sample)| sample)
    }
}

/// Halves blocks along the longest side of their box, in the order of their middles.
fn build(nodes: &mut Vec<Node>, blocks: &mut [Node]) {
    match blocks {
        [] => return,
        [block] => return nodes.push(*block),
        _ => {}
    }
    let [low, high] = bounds(blocks.iter().map(|block| [block.low, block.high]));
    let axis = (high - low).max_position();
    blocks.sort_by(|a, b| (a.low[axis] + a.high[axis]).total_cmp(&(b.low[axis] + b.high[axis])));
    let index = nodes.len();
    nodes.push(Node { low, high, holds: Holds::Nodes(0) });
    let (first, second) = blocks.split_at_mut(blocks.len() / 2);
    build(nodes, first);
    nodes[index].holds = Holds::Nodes(nodes.len());
    build(nodes, second);
}

fn bounds(boxes: impl Iterator<Item = [DVec3; 2]>) -> [DVec3; 2] {
    boxes.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], [a, b]| [low.min(a), high.max(b)])
}
