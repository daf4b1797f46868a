//! The features of the models that ship: counted, against what is known of the shapes.

use palpate::body::EdgeKind;
use palpate_host::bake::{BakedBody, Model};
use std::error::Error;
use std::path::PathBuf;

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
    // Wall and two rims: 4 faces each, 4 rings of 4 arcs, 3 · 4 straight or round lines. A cap: 5 faces, 4 sides, 4 diagonals, 4 corners.
    Known {
        file: "rounded_cylinder",
        faces: 3 * 4 + 2 * 5,
        edges: [0, 4 * 4 + 3 * 4 + 2 * 8, 0, 0, 0],
        vertices: 4 * 4 + 2 * 4,
        poles: 0,
        pieces: 1,
        is_convex: true,
    },
];

fn bake(file: &str) -> Result<BakedBody, Box<dyn Error>> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("models/{file}.toml"));
    Ok(BakedBody::new(&Model::read(&path)?, &format!("{file}.toml"))?)
}

const KINDS: [EdgeKind; 5] = [EdgeKind::Convex, EdgeKind::Smooth, EdgeKind::Reflex, EdgeKind::Mixed, EdgeKind::Open];

#[test]
fn features_are_those_of_the_shape() -> Result<(), Box<dyn Error>> {
    for known in KNOWN {
        let body = bake(known.file)?;
        let topology = &body.topology;
        let poles = body.faces.iter().flat_map(|face| &face.sides);
        let poles = poles.filter(|side| matches!(side, palpate_host::bake::body::BakedSide::Pole { .. })).count();
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
#[test]
fn teapot() -> Result<(), Box<dyn Error>> {
    let body = bake("teapot")?;
    let topology = &body.topology;
    println!(
        "{:?} v {} chi {} comps {}",
        KINDS.map(|kind| topology.count(kind)),
        body.vertices.len(),
        topology.euler_characteristic(),
        topology.components()
    );
    body.to_body()?;
    Ok(())
}
