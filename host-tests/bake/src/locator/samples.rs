//! Points of all faces in a tree of boxes, for the one nearest to a probe.

use super::stored::StoredSurface;
use glam::DVec3;

/// Intervals of the grid on each face.
const INTERVALS: usize = 16;
/// Intervals of a leaf of the tree: a block of the grid.
const BLOCK: usize = 4;

/// Grids of points on all faces.
pub(super) struct Samples {
    points: Vec<Sample>,
    /// The root first; a node's second half begins where it says.
    nodes: Vec<Node>,
}

/// A point of a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub face: u16,
    pub parameters: [f64; 2],
    pub point: DVec3,
}

/// A box with what is in it.
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
