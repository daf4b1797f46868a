//! Ways to spoil the seams between patches: each is refused with a message that names file and patches.

use super::spoiled_models::baked;

/// A closed box of 60 × 40 × 20, every patch a line of its own to be replaced.
const BOX: &[(&str, &str)] = &[
    ("top", "degree = [1, 1]\npoints = [[[0, 0, 20], [0, 40, 20]], [[60, 0, 20], [60, 40, 20]]]"),
    ("bottom", "degree = [1, 1]\npoints = [[[0, 0, 0], [60, 0, 0]], [[0, 40, 0], [60, 40, 0]]]"),
    ("front", "degree = [1, 1]\npoints = [[[0, 0, 0], [0, 0, 20]], [[60, 0, 0], [60, 0, 20]]]"),
    ("back", "degree = [1, 1]\npoints = [[[0, 40, 0], [60, 40, 0]], [[0, 40, 20], [60, 40, 20]]]"),
    ("left", "degree = [1, 1]\npoints = [[[0, 0, 0], [0, 40, 0]], [[0, 0, 20], [0, 40, 20]]]"),
    ("right", "degree = [1, 1]\npoints = [[[60, 0, 0], [60, 0, 20]], [[60, 40, 0], [60, 40, 20]]]"),
];

/// `left` runs from z to y: its normal is to point to −x.
fn model(edit: &[(&str, &str)], more: &[(&str, &str)]) -> String {
    let mut text = "name = \"box\"\nunit = \"mm\"\n".to_owned();
    let edited = |name: &str, good: &'static str| {
        edit.iter().find(|(patch, _)| *patch == name).map_or(good.to_owned(), |(_, with)| (*with).to_owned())
    };
    for (name, patch) in BOX {
        text += &format!("[[patch]]\nname = \"{name}\"\n{}\n", edited(name, patch));
    }
    for (name, patch) in more {
        text += &format!("[[patch]]\nname = \"{name}\"\n{patch}\n");
    }
    // A patch that is edited away.
    text.replace("[[patch]]\nname = \"bottom\"\n\n", "").replace("[[patch]]\nname = \"top\"\n\n", "")
}

/// The patches that are changed, those that are added, and what the message must say.
type Case = (&'static [(&'static str, &'static str)], &'static [(&'static str, &'static str)], &'static str);

const SPOILED: &[Case] = &[
    // One normal points inward.
    (
        &[("right", "flip = true\ndegree = [1, 1]\npoints = [[[60, 0, 0], [60, 0, 20]], [[60, 40, 0], [60, 40, 20]]]")],
        &[],
        r#"turn `flip` of patch "right""#,
    ),
    (
        &[("top", "flip = true\ndegree = [1, 1]\npoints = [[[0, 0, 20], [0, 40, 20]], [[60, 0, 20], [60, 40, 20]]]")],
        &[],
        r#"one edge, but the outward normals disagree across it: turn `flip` of patch "top""#,
    ),
    // A patch twice, and twice back to back.
    (
        &[],
        &[("again", "degree = [1, 1]\npoints = [[[0, 0, 20], [0, 40, 20]], [[60, 0, 20], [60, 40, 20]]]")],
        r#"patch "top" and patch "again" are the same surface twice"#,
    ),
    (
        &[],
        &[("again", "flip = true\ndegree = [1, 1]\npoints = [[[60, 0, 20], [60, 40, 20]], [[0, 0, 20], [0, 40, 20]]]")],
        r#"patch "top" and patch "again" are the same surface twice"#,
    ),
    // A fin on an edge of the box.
    (
        &[],
        &[("fin", "degree = [1, 1]\npoints = [[[0, 0, 20], [0, -9, 29]], [[60, 0, 20], [60, -9, 29]]]")],
        r#"patch "top", side v = 1 of patch "front" and side v = 0 of patch "fin" are one curve: an edge has two faces at most"#,
    ),
    // A lid in two halves on a box in one piece.
    (
        &[("top", "degree = [1, 1]\npoints = [[[0, 0, 20], [0, 40, 20]], [[30, 0, 20], [30, 40, 20]]]")],
        &[("half", "degree = [1, 1]\npoints = [[[30, 0, 20], [30, 40, 20]], [[60, 0, 20], [60, 40, 20]]]")],
        r#"side v = 0 of patch "top" from 0.000 to 1.000 lies on side v = 1 of patch "front", but they are not one edge"#,
    ),
    // A lid that sticks out: the longer border lies on the shorter in part.
    (
        &[("top", "degree = [1, 1]\npoints = [[[0, 0, 20], [0, 40, 20]], [[80, 0, 20], [80, 40, 20]]]")],
        &[],
        "edges that meet only in part must be cut where they part",
    ),
    // The same straight line at another pace.
    (
        &[(
            "top",
            "degree = [2, 1]\npoints = [[[0, 0, 20], [0, 40, 20]], [[20, 0, 20], [30, 40, 20]], [[60, 0, 20], [60, 40, 20]]]",
        )],
        &[],
        r#"side v = 0 of patch "top" and side v = 1 of patch "front" are the same curve with different parametrisations"#,
    ),
    // The same with weights.
    (
        &[("top", "degree = [1, 1]\npoints = [[[0, 0, 20, 1], [0, 40, 20, 1]], [[60, 0, 20, 2], [60, 40, 20, 1]]]")],
        &[],
        "are the same curve with different parametrisations (6.8",
    ),
    // A crack of a hundredth of a millimetre.
    (
        &[("top", "degree = [1, 1]\npoints = [[[0, 0, 20.01], [0, 40, 20.01]], [[60, 0, 20.01], [60, 40, 20.01]]]")],
        &[],
        "nearly meet: they are up to 1.000e-5 m apart, 6.0e-8 m is one edge",
    ),
    // One corner that was not moved along.
    (
        &[("top", "degree = [1, 1]\npoints = [[[0, 0, 20], [0, 40, 20]], [[60, 0, 20], [60, 40, 20.02]]]")],
        &[],
        "nearly meet",
    ),
    // Ends that meet, and a slit between them.
    (
        &[(
            "top",
            "degree = [2, 1]\npoints = [[[0, 0, 20], [0, 40, 20]], [[30, 0, 22], [30, 40, 20]], [[60, 0, 20], [60, 40, 20]]]",
        )],
        &[],
        r#"side v = 0 of patch "top" and side v = 1 of patch "front" nearly meet: they are up to 1.000e-3 m apart"#,
    ),
    // A border that is its neighbour's for a third of the way, and then leaves it.
    (
        &[(
            "top",
            "degree = [1, 1]\nknots_u = [0, 0, 1, 3, 3]\npoints = [[[0, 0, 20], [0, 40, 20]], [[20, 0, 20], [20, 40, 20]], [[60, 9, 20], [60, 40, 20]]]",
        )],
        &[],
        "edges that meet only in part",
    ),
];

fn refused(text: &str, expected: &str) {
    let message = baked(text).expect_err(expected);
    assert!(message.starts_with("spoiled.toml") && message.contains(expected), "expected {expected:?}, got: {message}");
}

#[test]
fn patches_that_do_not_fit_are_refused_by_name() {
    assert_eq!(baked(&model(&[], &[])), Ok(()));
    for (edit, more, expected) in SPOILED {
        refused(&model(edit, more), expected);
    }
    println!("{} spoiled bodies refused", SPOILED.len());
}

#[test]
fn a_body_inside_out_or_without_an_inside_is_refused() {
    let inside_out = model(&[], &[]).replace("degree =", "flip = true\ndegree =");
    refused(&inside_out, "closed and inside out (its volume is -4.800e-5 m³): turn `flip` of every patch");
    // Two sheets over one square that cross in the middle: as much is above as is below.
    let sheet = |z: i32, flip: bool| {
        let row = |x: i32, z: i32| format!("[[{x}, 0, 0], [{x}, 15, {z}], [{x}, 30, 0]]");
        let rows = [row(0, 0), row(10, z), row(20, -z), row(30, 0)].join(", ");
        format!("[[patch]]\nname = \"sheet{z}\"\nflip = {flip}\ndegree = [3, 2]\npoints = [{rows}]\n")
    };
    let sheets = format!("name = \"sheets\"\nunit = \"mm\"\n{}{}", sheet(9, false), sheet(-9, true));
    refused(&sheets, "closed but encloses no volume");
}
