//! Ways to spoil a model file: each is refused with a message that names file, patch and entry.

use palpate_bake::{BakedBody, BakedPatch, Model};
use palpate_truth::generate::Random;

const GOOD: &str = r#"name = "good"
unit = "mm"

[[patch]]
name = "top"
degree = [2, 1]
knots_u = [0, 0, 0, 0.5, 1, 1, 1]
knots_v = [0, 0, 1, 1]
points = [
  [[0, 0, 0], [0, 9, 0]],
  [[3, 0, 1], [3, 9, 1]],
  [[6, 0, 1], [6, 9, 1]],
  [[9, 0, 0], [9, 9, 0]],
]

[[patch]]
degree = [1, 1]
flip = true
points = [ [[0, 0, -5, 1], [0, 7, -5, 2]], [[7, 0, -5, 1], [7, 7, -5, 1]] ]
"#;

/// What is replaced, by what, and what the message must say.
const SPOILED: &[(&str, &str, &str)] = &[
    // Another kind of file.
    ("name = \"good\"", "ISO-10303-21;", "a STEP file: make a model of it with `cargo palpate import "),
    // Points.
    ("  [[3, 0, 1], [3, 9, 1]],\n", "", r#"patch "top": knots_u has 7 knots: 3 points of degree 2 need 6"#),
    ("[[3, 0, 1], [3, 9, 1]]", "[[3, 0, 1]]", r#"patch "top": points[1] has 1 points, points[0] has 2"#),
    ("[3, 9, 1]", "[3, 9]", r#"patch "top": points[1][1] has 2 numbers"#),
    ("[3, 9, 1]", "[3, 9, 1, 1, 1]", r#"patch "top": points[1][1] has 5 numbers"#),
    ("[3, 9, 1]", "[3, nan, 1]", r#"patch "top": points[1][1]: y is NaN"#),
    ("[3, 9, 1]", "[3, 9, -inf]", r#"patch "top": points[1][1]: z is -inf"#),
    ("[3, 9, 1]", "[\"3\", 9, 1]", "invalid type: string"),
    (
        "[[0, 0, -5, 1], [0, 7, -5, 2]], [[7, 0, -5, 1], [7, 7, -5, 1]]",
        "",
        "patch 1: 0 points along u: degree 1 needs at least 2",
    ),
    (
        "[[0, 0, -5, 1], [0, 7, -5, 2]], [[7",
        "[[0, 0, -5, 1], [0, 7, -5, 2]], [[1, 1, 1], [1, 1, 1]], [[7",
        "patch 1: 3 points along u without knots_u: a Bézier patch of degree 1 has 2",
    ),
    // Weights.
    ("[0, 7, -5, 2]", "[0, 7, -5, 0]", "patch 1: points[0][1]: the weight is 0"),
    ("[0, 7, -5, 2]", "[0, 7, -5, -1]", "patch 1: points[0][1]: the weight is -1"),
    ("[0, 7, -5, 2]", "[0, 7, -5, nan]", "patch 1: points[0][1]: the weight is NaN"),
    ("[0, 7, -5, 2]", "[0, 7, -5, inf]", "patch 1: points[0][1]: the weight is inf"),
    ("[0, 7, -5, 2]", "[0, 7, -5, 1e7]", "patch 1: span 0, 0: weights or knots are too uneven"),
    // Degrees.
    ("degree = [1, 1]", "degree = [0, 1]", "patch 1: degree along u is 0: 1 to 5"),
    ("degree = [1, 1]", "degree = [1, 6]", "patch 1: degree along v is 6: 1 to 5"),
    ("degree = [1, 1]", "degree = [-1, 1]", "patch 1: degree along u is -1"),
    ("degree = [1, 1]", "degree = [1]", "patch 1: degree has 1 numbers: one along u and one along v"),
    ("degree = [1, 1]", "degree = [1, 1, 1]", "patch 1: degree has 3 numbers: one along u and one along v"),
    ("degree = [2, 1]", "degree = [5, 1]", r#"patch "top": 4 points along u: degree 5 needs at least 6"#),
    // Knots.
    ("0.5, 1, 1, 1]", "0.5, 1, 1]", r#"patch "top": knots_u has 6 knots: 4 points of degree 2 need 7"#),
    ("0.5, 1, 1, 1]", "0.5, 1, 1, 1, 1]", r#"patch "top": knots_u has 8 knots"#),
    ("0.5, 1, 1, 1]", "1.5, 1, 1, 1]", r#"patch "top": knots_u[4] = 1 is below knots_u[3] = 1.5"#),
    ("0.5, 1, 1, 1]", "nan, 1, 1, 1]", r#"patch "top": knots_u[3] is NaN"#),
    (
        "0.5, 1, 1, 1]",
        "1e-9, 1, 1, 1]",
        r#"patch "top": knots_u: 0 and 0.000000001 are too close to be distinguished in single precision"#,
    ),
    ("0, 0, 0, 0.5, 1, 1, 1]", "0, 0, 0.1, 0.1, 0.1, 0.1, 1]", r#"patch "top": knots_u: the range of u is empty"#),
    (
        "0, 0, 0, 0.5, 1, 1, 1]",
        "0, 0, 0, 0, 1, 1, 1]",
        r#"patch "top": knots_u: 0 appears 4 times at an end: at most degree + 1 = 3"#,
    ),
    ("knots_v = [0, 0, 1, 1]", "knots_v = [0, 0, 0, 0]", r#"patch "top": knots_v: the range of v is empty"#),
    (
        "knots_v = [0, 0, 1, 1]",
        "knots_v = [-1e308, -1e308, 1e308, 1e308]",
        r#"patch "top": knots_v[0] is -1e308: 1e150 at most"#,
    ),
    ("knots_v = [0, 0, 1, 1]", "knots_v = [0, 0, 1e308, 1e308]", r#"patch "top": knots_v[2] is 1e308: 1e150 at most"#),
    // Shapes.
    (
        "[[0, 0, -5, 1], [0, 7, -5, 2]], [[7, 0, -5, 1], [7, 7, -5, 1]]",
        "[[0, 0, 0], [1, 0, 0]], [[2, 0, 0], [9, 0, 0]]",
        "patch 1: it has no area",
    ),
    (
        "[[0, 0, -5, 1], [0, 7, -5, 2]], [[7, 0, -5, 1], [7, 7, -5, 1]]",
        "[[1, 1, 1], [1, 1, 1]], [[1, 1, 1], [1, 1, 1]]",
        "patch 1: it has no area",
    ),
    ("[7, 7, -5, 1]", "[7, 7e9, -5, 1]", "m large"),
    (
        "[0, 7, -5, 2]], [[7, 0, -5, 1], [7, 7, -5, 1]]",
        "[0, 1e-7, -5, 2]], [[1e-7, 0, -5, 1], [1e-7, 1e-7, -5, 1]]",
        "m large: from 1e-6 m",
    ),
    (
        "[[0, 0, -5, 1], [0, 7, -5, 2]], [[7, 0, -5, 1], [7, 7, -5, 1]]",
        "[[0, 0, 9e5], [0, 7, 9e5]], [[7, 0, 9e5], [7, 7, 9e5]]",
        "patch \"top\": it is 9.0e-3 m large, below 1e-5 of the body's",
    ),
    ("[7, 7, -5, 1]", "[7, 1e300, -5, 1]", "patch 1: it is"),
    (
        "[[0, 0, -5, 1], [0, 7, -5, 2]], [[7, 0, -5, 1], [7, 7, -5, 1]]",
        "[[0, 0, -5], [0, 7, -5]], [[1e-6, 0, -5], [9e-7, 7, -5]]",
        "patch 1: it is a sliver, at most 1.0e-9 m wide along u",
    ),
    // The file.
    ("unit = \"mm\"", "unit = \"inch\"", "unit \"inch\" is unknown: m, cm or mm"),
    ("unit = \"mm\"\n", "", "missing field `unit`"),
    ("unit = \"mm\"", "unit = \"mm\"\nscale = 2", "unknown field `scale`"),
    ("flip = true", "flipped = true", "unknown field `flipped`"),
    ("flip = true", "flip = 1", "invalid type: integer `1`, expected a boolean"),
    ("flip = true", "name = \"top\"", "patches 0 and 1 are both named \"top\""),
    ("flip = true", "name = \"\"", "patch \"\": name is empty"),
    ("unit = \"mm\"", "unit = \"mm", "line 2"),
];

/// A model file that is read and baked; the message if it is refused.
pub fn baked(text: &str) -> Result<(), String> {
    let model = Model::parse(text, "spoiled.toml").map_err(|error| error.to_string())?;
    BakedBody::new(&model, "spoiled.toml").map(drop).map_err(|error| error.to_string())
}

#[test]
fn a_spoiled_model_file_is_refused_with_a_message() {
    assert_eq!(baked(GOOD), Ok(()));
    let mut refused = 0;
    let empty = [("", "missing field `unit`"), ("unit = \"mm\"\n", "the model has no patch")];
    let edited = SPOILED.iter().map(|(from, to, expected)| {
        assert!(GOOD.contains(from), "{from} is not in the model");
        (GOOD.replacen(from, to, 1), *expected)
    });
    for (text, expected) in edited.chain(empty.map(|(text, expected)| (text.to_owned(), expected))) {
        let message = baked(&text).expect_err(expected);
        assert!(message.starts_with("spoiled.toml") && message.contains(expected), "not {expected:?}: {message}");
        refused += 1;
    }
    println!("{refused} spoiled files refused");
}

#[test]
fn what_is_nested_too_deeply_is_said_with_its_line() {
    let deep = |line: String| format!("unit = \"mm\"\n{line}\n[[patch]]\n");
    let nested = |open: &str, close: &str| format!("points = {}1{}", open.repeat(200), close.repeat(200));
    for line in
        [format!("{}a = 1", "a.".repeat(500)), format!("[{}a]", "a.".repeat(500)), nested("[", "]"), nested("{a=", "}")]
    {
        let message = Model::parse(&deep(line), "deep.toml").expect_err("it is deep").to_string();
        assert!(message.starts_with("deep.toml: TOML parse error at line 2, column "), "{message}");
        assert!(message.lines().all(|line| line.chars().count() < 200), "{message}");
    }
}

#[test]
fn an_inner_knot_that_tears_the_surface_is_named() {
    let torn = GOOD.replacen("[0, 0, 0, 0.5, 1, 1, 1]", "[0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1]", 1).replacen(
        "  [[6, 0",
        "  [[4, 0, 1], [4, 9, 1]], [[5, 0, 1], [5, 9, 1]],\n  [[6, 0",
        1,
    );
    let message = Model::parse(&torn, "torn.toml").err().map(|error| error.to_string());
    let expected =
        "torn.toml: patch \"top\": knots_u: 0.5 appears 3 times inside: above degree 2 the surface is torn there";
    assert_eq!(message.as_deref(), Some(expected));
}

#[test]
fn more_spans_than_the_target_takes_are_refused() {
    let points: Vec<_> = (0..=257).map(|i| format!("[[{i}, 0, 0], [{i}, 9, 0]]")).collect();
    let knots: Vec<_> = [0].into_iter().chain(0..=257).chain([257]).map(|knot| knot.to_string()).collect();
    let text = format!(
        "name = \"long\"\nunit = \"mm\"\n[[patch]]\ndegree = [1, 1]\nknots_u = [{}]\npoints = [{}]\n",
        knots.join(", "),
        points.join(", ")
    );
    let message = Model::parse(&text, "long.toml").err().map(|error| error.to_string());
    assert_eq!(message.as_deref(), Some("long.toml: patch 0: 257 spans along u: at most 256; cut the patch in two"));
}

/// An exact net of an imported surface: refused at once, not checked for minutes.
#[test]
fn a_net_of_many_spans_both_ways_is_refused_with_the_limit() {
    let knots: Vec<String> = (0..=256).map(|k| format!("{k}")).collect();
    let knots = format!("[0, {}, 256]", knots.join(", "));
    let row = |i: usize| (0..257).map(|j| format!("[{i}, {j}, {}]", i * j % 7)).collect::<Vec<_>>().join(", ");
    let points: Vec<String> = (0..257).map(|i| format!("[{}]", row(i))).collect();
    let text = format!(
        "unit = \"mm\"\n[[patch]]\ndegree = [1, 1]\nknots_u = {knots}\nknots_v = {knots}\npoints = [{}]\n",
        points.join(", ")
    );
    let message = Model::parse(&text, "net.toml").err().map(|error| error.to_string());
    let wanted = "net.toml: patch 0: 256 × 256 spans: a patch has 1024 in all at most; cut it, or take fewer knots";
    assert_eq!(message.as_deref(), Some(wanted));
}

/// What a slip of the hand, or malice, writes in the place of a number.
const NUMBERS: &[&str] =
    &["0", "-1", "1e300", "-1e-300", "nan", "inf", "0.5", "3", "1e-7", "999999999999", "0.49999999999", "\"\"", "[]"];

/// However a file is mutated, it is a model that bakes or an error, never a panic.
#[test]
fn a_mutated_model_never_panics() {
    let mut random = Random::new(17);
    for _ in 0..3_000 {
        let mut words: Vec<String> = GOOD.split_inclusive([' ', ',', '[', ']', '\n']).map(str::to_owned).collect();
        for _ in 0..=random.below(5) {
            let [place, other] = [0; 2].map(|_| random.below(words.len()));
            match random.below(4) {
                0 => drop(words.remove(place)),
                1 => words.insert(place, words[other].clone()),
                2 => {
                    let end: String = words[place].chars().last().into_iter().collect();
                    words[place] = format!("{}{end}", NUMBERS[random.below(NUMBERS.len())]);
                }
                _ => words.swap(place, other),
            }
        }
        let text = words.concat();
        if let Ok(model) = Model::parse(&text, "mutated.toml") {
            for baked in model.patches.iter().filter_map(|patch| BakedPatch::new(patch).ok()) {
                assert!(baked.to_patch().is_ok(), "{text}");
            }
        }
    }
}

#[test]
fn a_patch_with_two_collapsed_sides_that_meet_is_named_with_the_remedy() {
    let leaf = r#"
name = "leaf"
unit = "mm"

[[patch]]
name = "leaf"
degree = [2, 2]
points = [
  [[0, 0, 0], [0, 0, 0], [0, 0, 0]],
  [[0, 0, 0], [10, 8, 2], [20, 4, 0]],
  [[0, 0, 0], [12, 2, 0], [30, 0, 0]],
]
"#;
    let error = baked(leaf).expect_err("a cusp");
    assert!(error.starts_with("spoiled.toml: patch \"leaf\""), "{error}");
    assert!(error.contains("its sides u = 0 and v = 0 are both one point"), "{error}");
    assert!(error.ends_with("let one of the two be a point, and give the other a length"), "{error}");
    // So it is an edge of the body.
    assert_eq!(baked(&leaf.replace("[[0, 0, 0], [0, 0, 0], [0, 0, 0]]", "[[0, 0, 0], [1, 3, 0], [2, 6, 0]]")), Ok(()));
}
