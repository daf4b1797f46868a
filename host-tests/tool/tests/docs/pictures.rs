//! The committed figures are what the tool draws today.

use crate::pages::{cells, files, palpate, repository, text};
use std::{env, fs};

/// Not drawn by the tool, or in a lane of its own: the race compiles its peers for minutes (`cargo palpate race`), the
/// importer its reader (`import host-tests/cad/tests/parts/s09.step --picture`). Clean stiffness takes minutes to be found (`palpate feel
/// --clean`).
const OTHERWISE: [&str; 6] =
    ["commission.svg", "tick.svg", "race.svg", "cad-s09.svg", "cad-s12.svg", "clean-phantom.svg"];

#[test]
fn every_committed_figure_is_drawn_the_same_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let out = path("");
    let printed = palpate(&["figures", "--out", &out]);
    palpate(&["figures", "--shapes", "--out", &out]);
    palpate(&["demo", "--host", "--report", &path("demo.html"), "--picture", &path("demo-path.svg")]);
    let knob = ["demo", "--device", "knob", "--host", "--report", &path("knob.html"), "--picture", &path("knob.svg")];
    palpate(&knob);
    let scene = repository().join("host-tests/scenes/turntable.toml").to_string_lossy().into_owned();
    let picture = path("turntable.svg");
    palpate(&["demo", "--host", "--model", &scene, "--report", &path("scene.html"), "--picture", &picture]);
    let mut older = Vec::new();
    for file in files("docs/figures", "svg") {
        let name = file.rsplit('/').next().expect("a name");
        if OTHERWISE.contains(&name) {
            continue;
        }
        let drawn = fs::read(path(name)).unwrap_or_else(|error| panic!("{file} is committed and not drawn: {error}"));
        if drawn != fs::read(repository().join(&file)).expect("it is there") {
            if env::var_os("PALPATE_WRITE").is_some() {
                fs::write(repository().join(&file), drawn).expect("it can be written");
            } else {
                older.push(file);
            }
        }
    }
    assert!(older.is_empty(), "older than the code, to be written anew with PALPATE_WRITE=1: {older:?}");
    the_shares_of_figure_7(&printed);
}

/// The table in `docs/figures/README.md` beside what was printed: for each controller its mean and worst share.
fn the_shares_of_figure_7(printed: &str) {
    let share = |model: &str, controller: &str| {
        let mut lines = printed.lines().skip_while(|line| *line != model);
        let line = lines.find(|line| line.split_whitespace().next() == Some(controller)).expect("a row");
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        format!("{:.0} %, {:.0} %", numbers[0], numbers[1])
    };
    let rows = [
        ("Newton, measure numbers", "newton"),
        ("… with saturation", "newton-saturated"),
        ("Newton, covariant errors", "newton-covariant"),
        ("… with saturation", "newton-covariant-saturated"),
        ("projected Newton with line search (not in the paper)", "newton-projected"),
        ("the paper's switching controller, as in the firmware, `f32`", "switching"),
        ("the firmware's default, of second order, `f32`", "second-order"),
    ];
    let page = text("docs/figures/README.md");
    let table: Vec<Vec<&str>> = page.lines().filter_map(cells).filter(|row| row.len() == 3).skip(1).collect();
    for ((title, controller), row) in rows.iter().zip(&table) {
        assert_eq!(row[0], *title);
        let found = [share("table1", controller), share("table1c", controller)];
        assert_eq!(row[1..], found, "docs/figures/README.md: {title}");
    }
}
