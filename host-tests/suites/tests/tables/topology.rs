//! The features of the models that ship: counted, against what is known of the shapes.

use palpate::body::{EdgeKind, Separator, Side};
use palpate::patch::Patch as _;
use palpate_bake::BakedBody;
use palpate_bake::body::BakedSide;
use palpate_bake::topology::Border;
use std::error::Error;
use std::sync::LazyLock;

/// What is known of a model.
struct Known {
    file: &'static str,
    faces: usize,
    /// Convex, smooth, reflex, mixed, open.
    edges: [usize; 5],
    vertices: usize,
    poles: usize,
    pieces: usize,
    is_convex: bool,
}

const KNOWN: &[Known] = &[
    // A cuboid: 12 sharp edges, those of the dome too.
    Known { file: "capped_box", faces: 6, edges: [12, 0, 0, 0, 0], vertices: 8, poles: 0, pieces: 1, is_convex: true },
    Known { file: "thin_plate", faces: 6, edges: [12, 0, 0, 0, 0], vertices: 8, poles: 0, pieces: 1, is_convex: true },
    // A cube blown up: nothing is sharp.
    Known { file: "sphere_body", faces: 6, edges: [0, 12, 0, 0, 0], vertices: 8, poles: 0, pieces: 1, is_convex: true },
    Known {
        file: "ellipsoid_body",
        faces: 6,
        edges: [0, 12, 0, 0, 0],
        vertices: 8,
        poles: 0,
        pieces: 1,
        is_convex: true,
    },
    // An octahedron blown up; each face has a pole. Nothing proves convexity at a pole.
    Known {
        file: "ellipsoid_poles",
        faces: 8,
        edges: [0, 12, 0, 0, 0],
        vertices: 6,
        poles: 8,
        pieces: 1,
        is_convex: false,
    },
    // Wall and two rims: 4 faces each, 4 rings of 4 arcs, 3 · 4 straight or round lines. A cap: 5 faces, 4 sides, 4
    // diagonals, 4 corners.
    Known {
        file: "rounded_cylinder",
        faces: 3 * 4 + 2 * 5,
        edges: [0, 4 * 4 + 3 * 4 + 2 * 8, 0, 0, 0],
        vertices: 4 * 4 + 2 * 4,
        poles: 0,
        pieces: 1,
        is_convex: true,
    },
    // Body, handle, spout and lid. 32 · 4 sides, of which 8 are poles (of the lid's knob and of the bottom) and 16 are
    // open (rim, lid and both ends of handle and spout, 4 + 4 + 2 · 2 + 2 · 2); the rest meet in pairs. Body and lid
    // are discs, handle and spout tubes: V − E + F = 1 + 1 + 0 + 0 with V = 38; but the handle ends at (−2, 0, 0.9),
    // where rings of the body meet, and that is one vertex.
    Known {
        file: "teapot",
        faces: 32,
        edges: [0, (32 * 4 - 8 - 16) / 2, 0, 0, 16],
        vertices: 37,
        poles: 8,
        pieces: 4,
        is_convex: false,
    },
];

/// Every known model, baked once.
static BODIES: LazyLock<Vec<BakedBody>> =
    LazyLock::new(|| KNOWN.iter().map(|known| palpate_suites::body(known.file)).collect());

const KINDS: [EdgeKind; 5] = [EdgeKind::Convex, EdgeKind::Smooth, EdgeKind::Reflex, EdgeKind::Mixed, EdgeKind::Open];

#[test]
fn features_are_those_of_the_shape() -> Result<(), Box<dyn Error>> {
    for (known, body) in KNOWN.iter().zip(BODIES.iter()) {
        let topology = &body.topology;
        let poles = body.faces.iter().flat_map(|face| &face.sides);
        let poles = poles.filter(|side| matches!(side, BakedSide::Pole { .. })).count();
        println!(
            "{}: {} faces, {} vertices, {:?} edges, {poles} poles, convex {}, chi {}",
            known.file,
            body.faces.len(),
            body.vertices.len(),
            KINDS.map(|kind| topology.count(kind)),
            body.is_convex,
            topology.euler_characteristic(),
        );
        assert_eq!(body.faces.len(), known.faces, "{}", known.file);
        assert_eq!(KINDS.map(|kind| topology.count(kind)), known.edges, "{}", known.file);
        assert_eq!(body.vertices.len(), known.vertices, "{}", known.file);
        assert_eq!(poles, known.poles, "{}", known.file);
        assert_eq!(topology.components(), known.pieces, "{}", known.file);
        assert_eq!(topology.is_closed(), known.edges[4] == 0, "{}", known.file);
        assert_eq!(body.is_convex, known.is_convex, "{}", known.file);
        if topology.is_closed() {
            assert_eq!(topology.euler_characteristic(), 2, "{}", known.file);
        }
        body.to_body()?;
    }
    Ok(())
}

/// Every border of every face in `f32` against the edge's curve, and the separator against the conormal in double
/// precision.
#[test]
fn curves_and_separators_are_those_of_the_faces() -> Result<(), Box<dyn Error>> {
    for (known, baked) in KNOWN.iter().zip(BODIES.iter()) {
        let body = baked.to_body()?;
        let (mut apart, mut turned) = (0.0_f64, 0.0_f64);
        for (index, (face, of)) in body.faces().iter().zip(&baked.faces).enumerate() {
            for (side, role) in face.sides.iter().enumerate() {
                let border = Border { patch: index, side };
                let Side::Edge { edge, reversed, separator } = role else { continue };
                let curve = &body.edges()[usize::from(*edge)].curve;
                for k in 1..100_u16 {
                    let t = f32::from(k) / 100.0;
                    let own = if *reversed { 1.0 - t } else { t };
                    let [u, v] = border.parameters(f64::from(own)).map(|parameter| parameter as f32);
                    let on_curve = curve.evaluate(t);
                    apart = apart.max(f64::from((face.patch.evaluate(u, v).point - on_curve.point).length()));
                    let exact = border.at(&of.surface, f64::from(own));
                    if exact.normal == glam::DVec3::ZERO {
                        continue;
                    }
                    let along = on_curve.tangent.as_dvec3().normalize();
                    let sense = if *reversed { -1.0 } else { 1.0 };
                    turned = turned.max((along - sense * exact.tangent.normalize()).length());
                    let outward = match separator {
                        Separator::Plane { across, offset } => {
                            // Half an ulp of a coordinate off the plane, and of the offset.
                            let (across, offset) = (across.as_dvec3(), f64::from(*offset));
                            let off = (across.dot(exact.point) - offset) / across.length();
                            assert!(off.abs() < 2e-7 * baked.topology.size, "{}: {off:e}", known.file);
                            across
                        }
                        Separator::Ruled(across) => across.evaluate(t).point.as_dvec3(),
                    };
                    let conormal = (outward - along * outward.dot(along)).normalize();
                    turned = turned.max((conormal - exact.conormal()).length());
                }
            }
        }
        println!("{}: borders {apart:.1e} m off their curves, directions {turned:.1e} rad", known.file);
        // Two evaluations in f32, each a few units in the last place of the coordinates.
        assert!(apart < 1e-6 * baked.topology.size, "{}", known.file);
        // Rounding of the coefficients, 6e-8, times how much shorter a derivative is than the coordinates.
        assert!(turned < 2e-6, "{}", known.file);
    }
    Ok(())
}

#[test]
fn spokes_leave_their_vertex_along_the_edge() -> Result<(), Box<dyn Error>> {
    for (known, baked) in KNOWN.iter().zip(BODIES.iter()) {
        let body = baked.to_body()?;
        let mut ends = 0;
        for (index, vertex) in body.vertices().iter().enumerate() {
            for spoke in &body.spokes()[usize::from(vertex.first_spoke)..][..usize::from(vertex.spokes)] {
                let edge = &body.edges()[usize::from(spoke.edge)];
                assert_eq!(usize::from(edge.ends[usize::from(spoke.at_upper_end)]), index);
                let [end, near] = if spoke.at_upper_end { [1.0, 0.999] } else { [0.0, 0.001] };
                let start = edge.curve.evaluate(end).point;
                assert!((start - vertex.point).length() < 2e-6 * body.size());
                let chord = (edge.curve.evaluate(near).point - start).normalize();
                // A thousandth of the way the chord turns by no more than a few thousandths, where the pace is even.
                assert!(chord.dot(spoke.direction) > 0.9995, "{}: {chord} {}", known.file, spoke.direction);
                ends += 1;
            }
        }
        assert_eq!(ends, 2 * body.edges().len());
    }
    Ok(())
}
