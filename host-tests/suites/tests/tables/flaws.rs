//! What is wrong with a body as a whole is said, and nothing of bodies that are right.

use palpate_bake::flaws::{self, Flaw};
use palpate_bake::{BakedBody, Model};
use palpate_truth::generate::models::{Corner, cuboid, rounded_box};
use std::error::Error;

fn found(patches: &str) -> Result<Vec<Flaw>, Box<dyn Error>> {
    let model = Model::parse(&format!("unit = \"mm\"\n{patches}"), "body.toml")?;
    let body = BakedBody::new(&model, "body.toml")?;
    let surfaces: Vec<_> = body.faces.iter().map(|face| face.surface.clone()).collect();
    Ok(flaws::find(&surfaces, &body.topology))
}

fn big() -> String {
    cuboid("a", [0.0, 0.0, 0.0], [40.0, 30.0, 20.0], false)
}

fn beside(low: Corner, high: Corner, hollow: bool) -> String {
    big() + &cuboid("b", low, high, hollow)
}

/// A ribbon over a cubic in the plane.
fn ribbon(name: &str, points: [[f64; 2]; 4]) -> String {
    let rows = points.map(|[x, y]| format!("[[{x}, {y}, 0], [{x}, {y}, 9]]")).join(", ");
    format!("[[patch]]\nname = \"{name}\"\ndegree = [3, 1]\npoints = [{rows}]\n")
}

/// A quarter of a cylinder, turned by some degrees.
fn quarter(name: &str, r: f64, degrees: f64) -> String {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let rows = [[r, 0.0, 1.0], [r, r, std::f64::consts::FRAC_1_SQRT_2], [0.0, r, 1.0]];
    let rows = rows.map(|[x, y, w]| [x * cosine - y * sine, x * sine + y * cosine, w]);
    let rows = rows.map(|[x, y, w]| format!("[[{x}, {y}, 0, {w}], [{x}, {y}, 9, {w}]]")).join(", ");
    format!("[[patch]]\nname = \"{name}\"\ndegree = [2, 1]\npoints = [{rows}]\n")
}

#[test]
fn bodies_that_are_right_have_no_flaw() -> Result<(), Box<dyn Error>> {
    for (what, text) in [
        ("a box", big()),
        ("two boxes apart", beside([50.0, 10.0, 20.0], [60.0, 20.0, 30.0], false)),
        ("one stands on the other", beside([10.0, 10.0, 20.0], [20.0, 20.0, 30.0], false)),
        ("they touch in an edge", beside([40.0, 30.0, -3.0], [80.0, 60.0, 40.0], false)),
        ("a hollow", beside([10.0, 10.0, 5.0], [20.0, 20.0, 15.0], true)),
        (
            "an island in a hollow",
            beside([10.0, 10.0, 5.0], [20.0, 20.0, 15.0], true)
                + &cuboid("c", [12.0, 12.0, 7.0], [15.0, 15.0, 10.0], false),
        ),
    ] {
        assert_eq!(found(&text)?, [], "{what}");
    }
    let rounded = rounded_box([40.0, 30.0, 20.0], 0.1);
    let (_, patches) = rounded.split_once("[[patch]]").ok_or("patches")?;
    assert_eq!(found(&format!("[[patch]]{patches}"))?, [], "small fillets");
    Ok(())
}

#[test]
fn boxes_that_overlap_cut_each_other() -> Result<(), Box<dyn Error>> {
    for (what, low, high, pairs) in [
        ("a corner in the other", [30.0, 10.0, 5.0], [70.0, 50.0, 55.0], 6),
        ("on the lines of the facets", [20.0, 15.0, 10.0], [60.0, 45.0, 30.0], 6),
        ("off them", [20.3, 15.1, 9.7], [60.0, 45.0, 30.0], 6),
        ("one through the other", [10.0, 10.0, -10.0], [20.0, 20.0, 55.0], 8),
        ("by a hundredth of the size", [39.6, 5.0, 5.0], [70.0, 25.0, 15.0], 4),
    ] {
        let flaws = found(&beside(low, high, false))?;
        assert!(matches!(flaws[..], [Flaw::Crossing { pairs: cut, .. }] if cut == pairs), "{what}: {flaws:?}");
    }
    Ok(())
}

/// A sheet from a line along y to another.
fn sheet(name: &str, from: [f64; 2], to: [f64; 2]) -> String {
    let line = |[x, z]: [f64; 2]| format!("[[{x}, 0, {z}], [{x}, 10, {z}]]");
    format!("[[patch]]\nname = \"{name}\"\ndegree = [1, 1]\npoints = [{}, {}]\n", line(from), line(to))
}

/// Two sheets meet in a line along y: flat, another passes through that seam; as a ridge, it lies on it.
#[test]
fn a_cut_along_a_smooth_seam_is_found_and_a_ridge_that_touches_is_none() -> Result<(), Box<dyn Error>> {
    let flat = sheet("left", [-10.0, 0.0], [0.0, 0.0]) + &sheet("right", [0.0, 0.0], [10.0, 0.0]);
    for top in [7.0, 5.0] {
        let through = found(&(flat.clone() + &sheet("wall", [0.0, -5.0], [0.0, top])))?;
        assert!(through.iter().any(Flaw::is_wrong), "{through:?}");
    }
    let ridge = sheet("left", [-10.0, -10.0], [0.0, 0.0]) + &sheet("right", [0.0, 0.0], [10.0, -10.0]);
    let touching = found(&(ridge + &sheet("lid", [-7.0, 0.0], [9.0, 0.0])))?;
    assert!(touching.iter().all(|flaw| !flaw.is_wrong()), "{touching:?}");
    Ok(())
}

#[test]
fn pieces_in_each_other_are_told_from_hollows() -> Result<(), Box<dyn Error>> {
    let flaws = found(&beside([10.0, 10.0, 5.0], [20.0, 20.0, 15.0], false))?;
    assert!(matches!(flaws[..], [Flaw::Nested { patch: 6, inside: 1, hollow: false }]), "{flaws:?}");
    let flaws = found(&beside([50.0, 10.0, 5.0], [60.0, 20.0, 15.0], true))?;
    assert!(matches!(flaws[..], [Flaw::Nested { patch: 6, inside: 0, hollow: true }]), "{flaws:?}");
    Ok(())
}

#[test]
fn a_patch_may_cut_itself() -> Result<(), Box<dyn Error>> {
    let looped = found(&ribbon("loop", [[0.0, 0.0], [30.0, 20.0], [-20.0, 20.0], [10.0, 0.0]]))?;
    assert!(matches!(looped[..], [Flaw::Crossing { patches: [0, 0], .. }]), "{looped:?}");
    let bent = found(&ribbon("bend", [[0.0, 0.0], [0.0, 20.0], [10.0, 20.0], [10.0, 0.0]]))?;
    assert_eq!(bent, []);
    Ok(())
}

/// Facets of two curved surfaces that lie near each other cut; the surfaces do not.
#[test]
fn surfaces_that_lie_near_each_other_do_not_cut() -> Result<(), Box<dyn Error>> {
    let ribs = |name, lift: f64| ribbon(name, [[0.0, lift], [13.0, 20.0 + lift], [17.0, 20.0 + lift], [30.0, lift]]);
    // Half a facet round, and by less apart than a facet bulges: 0.14 mm.
    let near = found(&(quarter("inner", 30.0, 0.0) + &quarter("outer", 30.08, 5.6)))?;
    assert!(near.iter().all(|flaw| !flaw.is_wrong()), "{near:?}");
    let across = found(&(quarter("arc", 30.0, 0.0) + &ribs("rib", 10.0)))?;
    assert!(across.iter().any(Flaw::is_wrong), "{across:?}");
    Ok(())
}

#[test]
fn a_seam_that_gapes_is_named_with_its_width() -> Result<(), Box<dyn Error>> {
    // By 1.5e-3 of the size: nearer borders are refused.
    let lifted = big().replacen("20.0]", "20.06]", 4);
    let flaws = found(&lifted)?;
    let [Flaw::Open { edges: 8, nearest: Some((_, gap)), .. }] = flaws[..] else { panic!("{flaws:?}") };
    assert!((gap - 6e-5).abs() < 1e-9, "{gap}");
    Ok(())
}
