//! Patches cut in two, bodies cut along strips, and what must be cut.

use palpate_bake::body::BakedSide;
use palpate_bake::split::{self, Cut, Piece};
use palpate_bake::topology::{Border, Topology};
use palpate_bake::{BakedBody, Model, NurbsPatch};
use palpate_suites::model;
use palpate_truth::generate::Random;
use palpate_truth::oracle::OraclePoint;
use std::error::Error;
use std::f64::consts::FRAC_1_SQRT_2;

fn farthest(piece: &Piece, whole: &NurbsPatch) -> f64 {
    let grid = || (0..=12).map(|k| f64::from(k) / 12.0);
    let off = |u: f64, v: f64| {
        let [s, t] = piece.source.parameters([u, v]);
        OraclePoint::evaluate(&piece.patch, u, v).point.distance(OraclePoint::evaluate(whole, s, t).point)
    };
    grid().flat_map(|u| grid().map(move |v| (u, v))).map(|(u, v)| off(u, v)).fold(0.0, f64::max)
}

#[test]
fn both_parts_are_the_patch_and_share_a_border_to_the_last_bit() -> Result<(), Box<dyn Error>> {
    let mut random = Random::new(4);
    // Degrees 1 to 4, with and without inner knots, polynomial and rational.
    for name in ["table1", "table1c", "sphere_body", "ellipsoid_poles", "thin_plate", "capped_box", "cylinder"] {
        let whole = model(name).patches.swap_remove(0);
        // At random, and at an inner knot of Table I.
        for at in [random.between(0.05, 0.95), random.between(0.05, 0.95), 0.5, 1.0 / 3.0] {
            for axis in [0, 1] {
                let parts = split::cut_in_two(&whole, axis, at);
                let source = split::Provenance::whole(0);
                let sources = [source.part(axis, 0.0, at), source.part(axis, at, 1.0)];
                for (patch, source) in parts.iter().zip(sources) {
                    let off = farthest(&Piece { patch: patch.clone(), source }, &whole);
                    // A few roundings of f64 a knot that is inserted.
                    assert!(off < 1e-14 * whole.size(), "{name}, axis {axis} at {at}: {off:e}");
                }
                let [below, above] = &parts;
                let upper = Border { patch: 0, side: 2 * axis + 1 }.controls(below).ok_or("not clamped")?;
                let lower = Border { patch: 0, side: 2 * axis }.controls(above).ok_or("not clamped")?;
                let factor = upper[0].1 / lower[0].1;
                for (a, b) in upper.iter().zip(&lower) {
                    assert_eq!((a.0, a.1), (b.0, b.1 * factor), "{name}");
                }
            }
        }
    }
    Ok(())
}

#[test]
fn a_cut_runs_on_through_the_neighbours() -> Result<(), Box<dyn Error>> {
    for (name, pieces_after) in [("capped_box", 10), ("sphere_body", 10), ("ellipsoid_body", 10)] {
        let model = model(name);
        let whole = Piece::whole(&model);
        let topology = split::topology(&whole, &model, name)?;
        // Once around a belt of four faces.
        let pieces = split::cut(&whole, &topology, &[Cut { piece: 0, axis: 0, at: 0.3 }]);
        assert_eq!(pieces.len(), pieces_after, "{name}");
        let after: Topology = split::topology(&pieces, &model, name)?;
        assert!(after.is_closed() && after.euler_characteristic() == 2 && after.components() == 1);
        for piece in &pieces {
            assert!(farthest(piece, &model.patches[piece.source.patch]) < 1e-15);
        }
        let baked = BakedBody::of_pieces(pieces, &model, name)?;
        baked.to_body()?;
        assert!(baked.is_convex, "{name}: cutting leaves it convex");
    }
    Ok(())
}

/// A sphere as every modeller writes it: a half circle turned about z, one patch with a seam and two poles.
fn turned_sphere() -> Result<Model, Box<dyn Error>> {
    let circle = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
    let half = [[0, -1], [1, -1], [1, 0], [1, 1], [0, 1]];
    let weight = |index: usize| if index.is_multiple_of(2) { 1.0 } else { FRAC_1_SQRT_2 };
    let point = |i: usize, j: usize| {
        let ([x, y], [r, z]) = (circle[i], half[j]);
        format!("[{}, {}, {}, {}]", 50 * x * r, 50 * y * r, 50 * z, weight(i) * weight(j))
    };
    let row = |i: usize| format!("[{}]", (0..5).map(|j| point(i, j)).collect::<Vec<_>>().join(", "));
    let rows = (0..9).map(row).collect::<Vec<_>>().join(",\n");
    let text = format!(
        "name = \"turned\"\nunit = \"mm\"\n[[patch]]\nname = \"all\"\ndegree = [2, 2]\n\
         knots_u = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]\nknots_v = [0, 0, 0, 1, 1, 2, 2, 2]\npoints = [{rows}]\n"
    );
    Ok(Model::parse(&text, "turned.toml")?)
}

#[test]
fn a_sphere_of_one_patch_falls_into_octants() -> Result<(), Box<dyn Error>> {
    let model = turned_sphere()?;
    let body = BakedBody::new(&model, "turned.toml")?;
    let topology = &body.topology;
    assert_eq!((body.faces.len(), body.edges.len(), body.vertices.len()), (8, 12, 6));
    assert_eq!(topology.euler_characteristic(), 2);
    let poles = body.faces.iter().flat_map(|face| &face.sides).filter(|side| matches!(side, BakedSide::Pole { .. }));
    assert_eq!(poles.count(), 8);
    body.to_body()?;
    Ok(())
}

#[test]
fn a_pole_of_half_a_turn_is_cut_in_two() -> Result<(), Box<dyn Error>> {
    // A cone over the half circle of degree 3.
    let half = [[1.0, 0.0, 3.0], [1.0, 2.0, 1.0], [-1.0, 2.0, 1.0], [-1.0, 0.0, 3.0]];
    let row = |[x, y, w]: [f64; 3]| format!("[[{}, {}, 0, {w}], [0, 0, 30, {w}]]", 20.0 * x, 20.0 * y);
    let rows = half.map(row).join(", ");
    let cone = format!("name = \"cone\"\nunit = \"mm\"\n[[patch]]\ndegree = [3, 1]\npoints = [{rows}]\n");
    let pieces = split::prepared(&Model::parse(&cone, "cone.toml")?, "cone.toml")?;
    assert_eq!(pieces.len(), 2);
    assert_eq!(pieces[0].source.upper, [0.5, 1.0]);
    // The octants' sectors are right angles and stay whole.
    let model = model("ellipsoid_poles");
    assert_eq!(split::prepared(&model, "ellipsoid_poles.toml")?, Piece::whole(&model));
    Ok(())
}

#[test]
fn a_tube_of_one_patch_is_cut_in_three() -> Result<(), Box<dyn Error>> {
    // Closed and polynomial, with one knot that leaves it smooth: no crease to cut at.
    let ring = [[30, 0], [30, 30], [-20, 30], [-30, 0], [-20, -30], [30, -30], [30, 0]];
    let row = |[x, y]: [i32; 2]| format!("[[{x}, {y}, 0], [{x}, {y}, 40]]");
    let rows = ring.map(row).join(", ");
    let tube = format!(
        "name = \"tube\"\nunit = \"mm\"\n[[patch]]\ndegree = [4, 1]\n\
         knots_u = [0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3]\npoints = [{rows}]\n"
    );
    let model = Model::parse(&tube, "tube.toml")?;
    let body = BakedBody::new(&model, "tube.toml")?;
    assert_eq!((body.faces.len(), body.edges.len(), body.vertices.len()), (3, 9, 6));
    assert_eq!(body.topology.components(), 1);
    body.to_body()?;
    Ok(())
}
