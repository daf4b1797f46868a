//! Vertices: where edges end, and poles.

use super::border::Border;
use super::cone;
use super::edges::{BorderRole, TopologyEdge};
use crate::NurbsPatch;
use glam::DVec3;

/// A vertex with the ends of edges that meet there.
#[derive(Clone, Debug)]
pub struct TopologyVertex {
    /// Metres.
    pub point: DVec3,
    /// The edges that end here, in their order.
    pub spokes: Vec<TopologySpoke>,
    /// The unit vector along the sum of the faces' normals, each times the angle that it fills there; zero where that
    /// vanishes. A probe that is closest to the vertex is outside a closed body where it lies on this side.
    pub outward: DVec3,
}

/// One end of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TopologySpoke {
    /// The edge.
    pub edge: usize,
    /// Whether it is the end at 1.
    pub at_upper_end: bool,
    /// Unit tangent away from the vertex.
    pub direction: DVec3,
}

/// Points that are one within the tolerance. The first that comes stands for all.
#[derive(Debug, Default)]
pub(super) struct Cluster {
    pub points: Vec<DVec3>,
}

impl Cluster {
    /// The index of a point's vertex, a new one if it is near none.
    pub fn place(&mut self, point: DVec3, tolerance: f64) -> usize {
        let known = self.points.iter().position(|known| known.distance(point) <= tolerance);
        known.unwrap_or_else(|| {
            self.points.push(point);
            self.points.len() - 1
        })
    }
}

/// The vertices with their spokes.
pub(super) fn with_spokes(
    points: Vec<DVec3>,
    roles: &[[BorderRole; 4]],
    edges: &[TopologyEdge],
    patches: &[NurbsPatch],
) -> Vec<TopologyVertex> {
    let outward = cone::outward(patches, roles, edges, points.len());
    let bare = |(point, outward)| TopologyVertex { point, spokes: Vec::new(), outward };
    let mut vertices: Vec<_> = points.into_iter().zip(outward).map(bare).collect();
    for (edge, of) in edges.iter().enumerate() {
        for at_upper_end in [false, true] {
            let direction = departure(of.owner, &patches[of.owner.patch], at_upper_end);
            vertices[of.ends[usize::from(at_upper_end)]].spokes.push(TopologySpoke { edge, at_upper_end, direction });
        }
    }
    vertices
}

/// A derivative shorter than this, beside the next one, is nothing but rounding.
const VANISHING: f64 = 1e-9;

/// The direction in which a border leaves one of its ends: that of its first derivative which does not vanish there,
/// the second if the first does, a chord if both do.
fn departure(border: Border, patch: &NurbsPatch, at_upper_end: bool) -> DVec3 {
    let (t, inward) = if at_upper_end { (1.0, -1.0) } else { (0.0, 1.0) };
    let at = border.at(patch, t);
    let chord = |reach: f64| border.point(patch, t + inward * reach) - at.point;
    let scale = chord(0.5).length();
    if at.tangent.length() > VANISHING * scale {
        (at.tangent * inward).normalize()
    } else if at.second.length() > VANISHING * scale {
        at.second.normalize()
    } else {
        chord(1e-4).normalize_or_zero()
    }
}
