//! `docs/reference/model-format.md`: its examples bake, and its messages are those of the tool, all of them.

use crate::pages::{blocks, cells, text};
use palpate_bake::topology::SeamFault;
use palpate_bake::{Axis, BakedBody, Model, ModelError, PatchFault};
use std::collections::BTreeSet;
use std::path::Path;

const PAGE: &str = "docs/reference/model-format.md";

#[test]
fn every_example_bakes() {
    let page = text(PAGE);
    let examples = blocks(&page, "toml");
    assert!(examples.len() >= 3);
    let closed = examples.into_iter().map(|example| {
        let model = Model::parse(example, "example.toml").unwrap_or_else(|error| panic!("{error}\n{example}"));
        let body = BakedBody::new(&model, "example.toml").unwrap_or_else(|error| panic!("{error}\n{example}"));
        (model.patches.len(), body.topology.is_closed(), body.is_convex)
    });
    assert_eq!(closed.collect::<Vec<_>>(), [(1, false, false), (1, false, false), (6, true, true)]);
}

#[test]
fn every_refusal_is_listed_with_its_message() {
    let page = text(PAGE);
    let (_, refusals) = page.split_once("## Refused input").expect("a section");
    // The code of a row's first cell; back quotes within it are written by two around it.
    let listed: BTreeSet<String> = refusals
        .lines()
        .filter_map(cells)
        .filter_map(|row| Some(row.first()?.strip_prefix('`')?.to_owned()))
        .map(|cell| match cell.strip_prefix('`') {
            Some(rest) => rest.split("``").next().unwrap_or_default().to_owned(),
            None => cell.split('`').next().unwrap_or_default().to_owned(),
        })
        .collect();
    let faults = faults().into_iter().map(|fault| fault.to_string());
    let seams = seams().into_iter().map(|fault| fault.to_string());
    let wanted: BTreeSet<String> = files().into_iter().chain(faults).chain(seams).collect();
    assert_eq!(listed, wanted, "left: {PAGE}, right: the tool");
}

#[test]
fn every_message_names_the_file_and_the_patch() {
    let file = "part.toml".to_owned();
    let patch = ModelError::Patch { file: file.clone(), patch: "\"top\"".to_owned(), fault: PatchFault::NoArea };
    assert!(patch.to_string().starts_with("part.toml: patch \"top\": it has no area"));
    let seam = ModelError::Seam { file, fault: SeamFault::NoVolume };
    assert!(seam.to_string().starts_with("part.toml: the body"));
}

/// Refusals of the file as a whole.
fn files() -> Vec<String> {
    let unknown = "name = \"part\"\nscale = 2\n";
    let syntax = Model::parse(unknown, "part.toml").expect_err("an unknown key").to_string();
    let refused = |text: &str| Model::parse(text, "part.toml").expect_err("refused").to_string();
    let patch = |name: &str| {
        format!("[[patch]]\n{name}degree = [1, 1]\npoints = [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]\n")
    };
    let [named, plain] = [patch("name = \"top\"\n"), patch("")];
    let missing = Model::read(Path::new("nowhere/part.toml")).expect_err("no file").to_string();
    vec![
        missing.replace("nowhere/", ""),
        syntax.lines().next().unwrap_or_default().to_owned(),
        refused("unit = \"inch\""),
        refused("unit = \"mm\""),
        refused(&format!("unit = \"mm\"\n{named}{plain}{plain}{named}")),
        refused(&format!("unit = \"m\"\n{}", plain.replace("0]", "2000]"))),
    ]
}

/// One of each; the match below does not compile where one is missing.
fn faults() -> Vec<PatchFault> {
    let (u, v) = (Axis::U, Axis::V);
    let all = vec![
        PatchFault::EmptyName,
        PatchFault::DegreeCount { count: 3 },
        PatchFault::Degree { axis: u, degree: 6 },
        PatchFault::TooFewPoints { axis: u, count: 2, degree: 2 },
        PatchFault::BezierPoints { axis: v, count: 4, degree: 2 },
        PatchFault::RaggedRow { row: 1, count: 3, expected: 2 },
        PatchFault::PointLength { row: 1, column: 0, count: 2 },
        PatchFault::Coordinate { row: 1, column: 0, coordinate: 'y', value: f64::NAN },
        PatchFault::Weight { row: 1, column: 0, value: -1.0 },
        PatchFault::KnotCount { axis: u, count: 6, points: 4, degree: 2 },
        PatchFault::KnotNotFinite { axis: u, index: 3, value: f64::INFINITY },
        PatchFault::KnotTooLarge { axis: u, index: 0, value: -1e308, limit: 1e150 },
        PatchFault::KnotDecreases { axis: u, index: 4, value: 0.5, before: 0.75 },
        PatchFault::Torn { axis: u, value: 0.5, times: 3, degree: 2 },
        PatchFault::EndMultiplicity { axis: u, value: 0.0, times: 4, degree: 2 },
        PatchFault::EmptyRange { axis: u, value: 1.0 },
        PatchFault::KnotsTooNear { axis: u, first: 0.5, second: 0.500_000_01 },
        PatchFault::TooManySpans { axis: v, count: 300 },
        PatchFault::TooManyCells { u: 256, v: 256, limit: 1024 },
        PatchFault::NoArea,
        PatchFault::Sliver { axis: u, width: 4e-8, tolerance: 6e-8 },
        PatchFault::Size { size: 4e4 },
        PatchFault::Tiny { size: 7e-3, body: 900.0, share: 1e-5 },
        PatchFault::NoBounds,
        PatchFault::Uneven { u: 0, v: 2 },
    ];
    match all[0] {
        PatchFault::EmptyName
        | PatchFault::DegreeCount { .. }
        | PatchFault::Degree { .. }
        | PatchFault::TooFewPoints { .. }
        | PatchFault::BezierPoints { .. }
        | PatchFault::RaggedRow { .. }
        | PatchFault::PointLength { .. }
        | PatchFault::Coordinate { .. }
        | PatchFault::Weight { .. }
        | PatchFault::KnotCount { .. }
        | PatchFault::KnotNotFinite { .. }
        | PatchFault::KnotTooLarge { .. }
        | PatchFault::KnotDecreases { .. }
        | PatchFault::Torn { .. }
        | PatchFault::EndMultiplicity { .. }
        | PatchFault::EmptyRange { .. }
        | PatchFault::KnotsTooNear { .. }
        | PatchFault::TooManySpans { .. }
        | PatchFault::TooManyCells { .. }
        | PatchFault::NoArea
        | PatchFault::Sliver { .. }
        | PatchFault::Size { .. }
        | PatchFault::Tiny { .. }
        | PatchFault::NoBounds
        | PatchFault::Uneven { .. } => all,
    }
}

/// As [`faults`], between patches.
fn seams() -> Vec<SeamFault> {
    let first = || "side u = 0 of patch \"a\"".to_owned();
    let second = || "side v = 1 of patch \"b\"".to_owned();
    let all = vec![
        SeamFault::ThreeFaces { first: first(), second: second(), third: "side u = 1 of patch \"c\"".to_owned() },
        SeamFault::Cusp { patch: "\"a\"".to_owned(), first: "u = 0".to_owned(), second: "v = 1".to_owned() },
        SeamFault::Duplicate { first: "\"a\"".to_owned(), second: "\"b\"".to_owned() },
        SeamFault::Orientation { first: first(), second: second(), suspect: "\"a\"".to_owned() },
        SeamFault::Partial { first: first(), second: second(), from: 0.25, to: 1.0 },
        SeamFault::Parametrisation { first: first(), second: second(), deviation: 1.5e-3 },
        SeamFault::Gap { first: first(), second: second(), deviation: 2e-5, tolerance: 6e-8 },
        SeamFault::InsideOut { volume: -2.4e-5 },
        SeamFault::NoVolume,
        SeamFault::TooMany { count: 1_100, limit: 1_024 },
    ];
    match all[0] {
        SeamFault::ThreeFaces { .. }
        | SeamFault::Cusp { .. }
        | SeamFault::Duplicate { .. }
        | SeamFault::Orientation { .. }
        | SeamFault::Partial { .. }
        | SeamFault::Parametrisation { .. }
        | SeamFault::Gap { .. }
        | SeamFault::InsideOut { .. }
        | SeamFault::NoVolume
        | SeamFault::TooMany { .. } => all,
    }
}
