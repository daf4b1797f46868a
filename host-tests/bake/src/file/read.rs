//! The host's tables from a file.

use super::notes::{FaceNotes, FileFault, Notes};
use crate::body::{BakedBody, BakedCurve, BakedEdge, BakedFace, BakedSeparator, BakedSide, LocatorTable};
use crate::locator::PackedLists;
use crate::model::Model;
use crate::topology::{Border, BorderRole, Sense, Topology, TopologyEdge, TopologySpoke, TopologyVertex};
use crate::{BakedCoefficients, BakedPatch, NurbsPatch};
use glam::DVec3;
use palpate::body::{Body, BodyBuffer, Edge, EdgeFace, Face, FileHead, Separator, Side, SplineCurve, TickLimit};
use palpate::patch::{Coefficients, Orientation, Patch as _, span_centre};

/// A file that has been read.
#[derive(Clone, Debug)]
pub struct BakedFile {
    /// SHA-256 of the model's file.
    pub source: [u8; 32],
    /// The model, as far as the file describes it: of a patch that is cut into several faces, the surface of the first.
    pub model: Model,
    /// The tables, with their locator.
    pub body: BakedBody,
}

impl BakedFile {
    /// Reads a file, with everything checked that the library checks.
    ///
    /// # Errors
    /// The first thing wrong with it.
    pub fn read(bytes: &[u8]) -> Result<Self, FileFault> {
        // A vector of bytes may lie anywhere; one of words does not.
        let words: Vec<u32> = bytes.as_chunks().0.iter().map(|word| u32::from_ne_bytes(*word)).collect();
        let aligned: &[u8] = if bytes.len().is_multiple_of(4) { bytemuck::cast_slice(&words) } else { bytes };
        let head = FileHead::of(aligned)?;
        let (mut faces, mut edges) = (vec![Face::VACANT; head.faces], vec![Edge::VACANT; head.edges]);
        let buffer = BodyBuffer { faces: &mut faces, edges: &mut edges };
        let body = Body::from_bytes_with(aligned, buffer, TickLimit::NONE, &mut || ())?;
        let borders: Vec<_> =
            body.faces().iter().map(|face| face.patch.breaks().map(|breaks| breaks.len() - 2)).collect();
        let notes = Notes::read(FileHead::notes(aligned)?, &borders)?;
        let baked = baked(&body, &notes)?;
        let first = |patch: usize| baked.faces.iter().find(|face| face.source.patch == patch);
        let patches = (0..notes.patches.len()).filter_map(first).map(|face| face.surface.clone()).collect();
        let model = Model { name: notes.name, unit: notes.unit, centre: head.centre.as_dvec3(), patches };
        Ok(Self { source: head.source, model, body: baked })
    }
}

fn baked(body: &Body<'_>, notes: &Notes) -> Result<BakedBody, FileFault> {
    let mut faces = Vec::with_capacity(notes.faces.len());
    for (index, (face, FaceNotes { source, continuity })) in body.faces().iter().zip(&notes.faces).enumerate() {
        let patch = patch(face, notes.patches[source.patch].clone());
        let surface = surface(&patch, continuity).ok_or(FileFault::Weight { face: index })?;
        faces.push(BakedFace { patch, sides: face.sides.each_ref().map(side), surface, source: *source });
    }
    let locator = body.locator();
    let locator = LocatorTable {
        corner: locator.corner,
        side: locator.side,
        nodes: locator.nodes.to_vec(),
        entries: PackedLists::unpacked(&locator.lists),
    };
    Ok(BakedBody {
        faces,
        edges: body.edges().iter().map(edge).collect(),
        vertices: body.vertices().to_vec(),
        spokes: body.spokes().to_vec(),
        locator,
        size: body.size(),
        is_convex: body.is_convex(),
        topology: topology(body),
    })
}

fn patch(face: &Face<'_>, name: Option<String>) -> BakedPatch {
    let patch = &face.patch;
    BakedPatch {
        name,
        degree: patch.degree(),
        breaks: patch.breaks().map(<[f32]>::to_vec),
        coefficients: coefficients(patch.coefficients()),
        shape: patch.shape(),
        orientation: if patch.orientation() > 0.0 { Orientation::Outward } else { Orientation::Inward },
        size: patch.size(),
    }
}

fn coefficients(coefficients: Coefficients<'_>) -> BakedCoefficients {
    match coefficients {
        Coefficients::Polynomial(entries) => BakedCoefficients::Polynomial(entries.to_vec()),
        Coefficients::Rational(entries) => BakedCoefficients::Rational(entries.to_vec()),
    }
}

fn curve(curve: &SplineCurve<'_>) -> BakedCurve {
    BakedCurve {
        degree: curve.degree,
        breaks: curve.breaks.to_vec(),
        coefficients: coefficients(curve.coefficients),
        second_derivative: curve.second_derivative,
    }
}

fn side(side: &Side<'_>) -> BakedSide {
    match side {
        Side::Pole { vertex } => BakedSide::Pole { vertex: *vertex },
        Side::Edge { edge, reversed, separator } => {
            let separator = match separator {
                Separator::Plane { across, offset } => {
                    BakedSeparator::Plane { across: across.to_array(), offset: *offset }
                }
                Separator::Ruled(of) => BakedSeparator::Ruled(curve(of)),
            };
            BakedSide::Edge { edge: *edge, reversed: *reversed, separator }
        }
    }
}

fn edge(edge: &Edge<'_>) -> BakedEdge {
    BakedEdge {
        curve: curve(&edge.curve),
        third_derivative: [edge.third_derivative, edge.jump],
        faces: edge.faces,
        ends: edge.ends,
        kind: edge.kind,
    }
}

/// How the features hang together, as the tables say.
fn topology(body: &Body<'_>) -> Topology {
    let sense = |reversed: bool| if reversed { Sense::Reversed } else { Sense::Same };
    let role = |side: &Side<'_>| match side {
        Side::Edge { edge, reversed, .. } => BorderRole::Edge { edge: usize::from(*edge), sense: sense(*reversed) },
        Side::Pole { vertex } => BorderRole::Pole { vertex: usize::from(*vertex) },
    };
    let border = |of: EdgeFace| Border { patch: usize::from(of.face), side: usize::from(of.side) };
    let partner = |of: EdgeFace| {
        let side = body.faces().get(usize::from(of.face))?.sides.get(usize::from(of.side))?;
        Some((border(of), sense(matches!(side, Side::Edge { reversed: true, .. }))))
    };
    let edge = |edge: &Edge<'_>| TopologyEdge {
        owner: border(edge.faces[0]),
        partner: partner(edge.faces[1]),
        ends: edge.ends.map(usize::from),
        kind: edge.kind,
    };
    let spoke = |spoke: &palpate::body::Spoke| TopologySpoke {
        edge: usize::from(spoke.edge),
        at_upper_end: spoke.at_upper_end,
        direction: spoke.direction.as_dvec3(),
    };
    let vertex = |vertex: &palpate::body::Vertex| TopologyVertex {
        point: vertex.point.as_dvec3(),
        spokes: body.spokes()[usize::from(vertex.first_spoke)..][..usize::from(vertex.spokes)]
            .iter()
            .map(spoke)
            .collect(),
        outward: vertex.outward.as_dvec3(),
    };
    Topology {
        roles: body.faces().iter().map(|face| face.sides.each_ref().map(role)).collect(),
        edges: body.edges().iter().map(edge).collect(),
        vertices: body.vertices().iter().map(vertex).collect(),
        size: f64::from(body.size()),
    }
}

// A NURBS patch in double precision from the numbers of a table.
//
// A span's polynomial has a blossom: symmetric, affine in each argument, and the polynomial itself where all arguments
// are one. A control point is the blossom at the knots that follow its own (Ramshaw, *Blossoms are polar forms*,
// 1989), of any span that it reaches.

/// The patch of a table, where `continuity` says how many derivatives are continuous at each inner border; `None` where
/// a weight is not positive.
pub(super) fn surface(baked: &BakedPatch, continuity: &[Vec<u8>; 2]) -> Option<NurbsPatch> {
    let degree = baked.degree.map(usize::from);
    let knots = [0, 1].map(|axis| knots(&baked.breaks[axis], degree[axis], &continuity[axis]));
    let counts = [0, 1].map(|axis| knots[axis].len() - degree[axis] - 1);
    let reached = [0, 1].map(|axis| -> Vec<Reached> {
        (0..counts[axis]).map(|point| Reached::new(&baked.breaks[axis], &knots[axis], degree[axis], point)).collect()
    });
    let spans_v = baked.breaks[1].len() - 1;
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for along_u in &reached[0] {
        for along_v in &reached[1] {
            let span = baked.coefficients.homogeneous_span(degree, along_u.span * spans_v + along_v.span);
            let mut sum = [0.0; 4];
            for (row, by_u) in span.chunks_exact(degree[1] + 1).zip(&along_u.shares) {
                for (power, by_v) in row.iter().zip(&along_v.shares) {
                    (0..4).for_each(|component| sum[component] += power[component] * by_u * by_v);
                }
            }
            let [x, y, z, weight] = sum;
            if !(weight > 0.0 && weight.is_finite()) {
                return None;
            }
            points.push(DVec3::new(x, y, z) / weight);
            weights.push(weight);
        }
    }
    let largest = weights.iter().copied().fold(0.0, f64::max);
    // Of a polynomial patch they are one but for the rounding of the sums.
    let is_polynomial = matches!(baked.coefficients, crate::BakedCoefficients::Polynomial(_));
    weights.iter_mut().for_each(|weight| *weight = if is_polynomial { 1.0 } else { *weight / largest });
    let flip = baked.orientation == Orientation::Inward;
    Some(NurbsPatch { name: baked.name.clone(), degree, knots, counts, points, weights, flip })
}

/// The clamped knots: an inner border as often as its continuity wants.
fn knots(breaks: &[f32], degree: usize, continuity: &[u8]) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    for (border, continuity) in breaks[1..breaks.len() - 1].iter().zip(continuity) {
        let times = degree.saturating_sub(usize::from(*continuity)).max(1);
        knots.resize(knots.len() + times, f64::from(*border));
    }
    knots.resize(knots.len() + degree + 1, 1.0);
    knots
}

/// How a control point follows from a span.
struct Reached {
    span: usize,
    /// By what each power of the span is multiplied.
    shares: Vec<f64>,
}

impl Reached {
    /// From the widest span that the point reaches: there the knots lie outside by the minimum.
    fn new(breaks: &[f32], knots: &[f64], degree: usize, point: usize) -> Self {
        let [first, last] = [point, point + degree + 1].map(|knot| knots[knot]);
        let width = |span: usize| f64::from(breaks[span + 1]) - f64::from(breaks[span]);
        let reached = (0..breaks.len() - 1)
            .filter(|span| first <= f64::from(breaks[*span]) && f64::from(breaks[span + 1]) <= last);
        let span = reached.max_by(|a, b| width(*a).total_cmp(&width(*b))).unwrap_or_default();
        let centre = f64::from(span_centre(breaks[span], breaks[span + 1]));
        let arguments = &knots[point + 1..=point + degree];
        // Elementary symmetric polynomials, one argument after the other.
        let mut shares = vec![0.0; degree + 1];
        shares[0] = 1.0;
        for (count, argument) in arguments.iter().enumerate() {
            for power in (1..=count + 1).rev() {
                shares[power] += shares[power - 1] * (argument - centre);
            }
        }
        let mut binomial = 1.0;
        for (power, share) in shares.iter_mut().enumerate() {
            *share /= binomial;
            binomial *= (degree - power) as f64 / (power + 1) as f64;
        }
        Self { span, shares }
    }
}
