//! What the hot path costs is a budget, and some of it is promised.

use crate::running::{boards, is_wanted};
use palpate_tool::budgets::{Budget, Figures, Images, Verdict, measure};
use palpate_tool::firmware::{Board, Progress, is_long};
use std::fs;
use std::process::Command;

/// A biquadratic evaluation by Horner's rule cannot do with fewer instructions: `palpate::patch` counts them.
const EVALUATION_FLOOR: u32 = 94;
/// The same with all second derivatives: `src/patch/taylor.rs` counts them.
const CURVED_FLOOR: u32 = 115;
/// The most for a servo tick of three joints. The watch that ends contact which no motion explains is part of it.
const SERVO_TICK: u32 = 1_700;
/// The most for the same with all protection on, on the core that it was promised of: on trial, and once all joints
/// were seen and every motor is given less than it is asked for. Some 40 of it find an arm that was let go of. For a
/// smooth force as well.
const PROTECTED_TICK: u32 = 1_850;
/// The most that a smooth force costs the median tick, over spring and damper alone.
const SMOOTH: u32 = 120;
/// The most for any tick of the closest point on the capped box with normal, gap and contact. What the second order
/// costs beyond the 720 of the first buys a witness point that follows a probe at 1 m/s to a millionth of the size
/// between two edges: a step at the border, or one that is certain only in part, has its model's minimiser over the
/// square and the exact certificate in the one tick. While nothing is located a tick searches twice as much as the 687
/// of a single search, so that a probe inside is located within 10 ms.
const ANY_TICK: u32 = 1_050;
/// The most by which a tick on a body from a file and one on the same statics may differ: a branch or two.
const STATIC: u32 = 4;
/// The most that a body's path costs the median tick, over one that rests. The worst ticks are at other switches, for the
/// body comes to meet the probe: each has its own budget.
const PATH: u32 = 80;
/// The most for the closest point on a face of degree 3, away from its border.
const ON_A_FACE: u32 = 560;

#[test]
fn the_hot_path_is_within_its_budget() {
    if !is_wanted("the_hot_path_is_within_its_budget") {
        return;
    }
    // All of them in a long run.
    let boards = if is_long() { &Board::ALL[..] } else { boards() };
    for &board in boards {
        let found = compare(board);
        // Promised of the Cortex-M cores with floats alone.
        if Board::CORTEX_F.contains(&board) {
            holds_its_promises(board, &found);
        }
    }
}

/// A square tube, mm: 40 wide with a hole of 14, in which each tool lies in the opposite wall.
#[test]
fn a_tool_is_counted_where_it_is_outside_of_the_part() {
    if !is_wanted("a part with a hole, with tools") {
        return;
    }
    let square = |half: i32| [[half, half], [-half, half], [-half, -half], [half, -half]];
    let (outside, inside, mut model) = (square(20), square(7), "name = \"tube\"\nunit = \"mm\"\n".to_owned());
    for (from, to) in (0..4).map(|from| (from, (from + 1) % 4)) {
        let at = |[x, y]: [i32; 2], z: i32| [x, y, z];
        for points in [
            [[at(outside[from], 0), at(outside[from], 40)], [at(outside[to], 0), at(outside[to], 40)]],
            [[at(inside[to], 0), at(inside[to], 40)], [at(inside[from], 0), at(inside[from], 40)]],
            [[at(outside[from], 40), at(inside[from], 40)], [at(outside[to], 40), at(inside[to], 40)]],
            [[at(outside[to], 0), at(inside[to], 0)], [at(outside[from], 0), at(inside[from], 0)]],
        ] {
            model += &format!("[[patch]]\ndegree = [1, 1]\npoints = {points:?}\n");
        }
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("tube.toml");
    fs::write(&path, model).expect("a file");
    let run = Command::new(env!("CARGO_BIN_EXE_palpate")).args(["budgets", "--tool"]).arg(path).output();
    let run = run.expect("it starts");
    let said = format!("{}{}", String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    println!("{said}");
    assert!(run.status.success());
    for tool in ["ball", "capsule", "box"] {
        let figure = |name: &str| -> Option<u32> {
            let line = said.lines().find_map(|line| line.strip_prefix(&format!("{tool}, {name}")));
            line.and_then(|count| count.trim().parse().ok())
        };
        assert_eq!(figure("left out: patches with the part 16 mm in front"), Some(4), "{tool}");
        // As far as docs/howto/tool.md has it.
        assert!(figure("ticks until located").is_some_and(|ticks| ticks <= 450), "{tool}");
    }
}

fn compare(board: Board) -> Figures {
    let images = if is_long() { Images::All } else { Images::Few };
    let found = measure(board, images, &Progress::new()).expect("the program runs to its end");
    let verdicts = Budget::load(board).expect("the committed budget").compare(&found, images);
    let over: Vec<String> = verdicts
        .iter()
        .filter(|verdict| verdict.fails())
        .map(|Verdict { name, found, allowed }| format!("{name}: {found:?} instructions, {allowed:?} recorded"))
        .collect();
    assert!(
        over.is_empty(),
        "{}: worse than the budget by more than 3 %, missing or new:\n{}\n`cargo palpate budgets --board {name}` prints all; if this is meant, \
         record it with `cargo palpate budgets --board {name} --record`",
        board.core(),
        over.join("\n"),
        name = board.name(),
    );
    found
}

fn holds_its_promises(board: Board, found: &Figures) {
    let of = |name: &str| found.of(name).unwrap_or_else(|| panic!("{name} is not counted"));
    let evaluation = of("evaluation, polynomial, degree (2, 2)");
    assert!(
        4 * evaluation <= 5 * EVALUATION_FLOOR,
        "{board:?}: a biquadratic evaluation takes {evaluation} instructions"
    );
    let evaluation = of("second order, polynomial, degree (2, 2)");
    assert!(
        4 * evaluation <= 5 * CURVED_FLOOR,
        "{board:?}: a biquadratic evaluation with second derivatives takes {evaluation} instructions"
    );
    let closest = of("closest point of the capped box with normal, gap and contact, any, worst");
    assert!(closest <= ANY_TICK, "{board:?}: the worst tick on the capped box takes {closest} instructions");
    // The capped box has faces of degree 3.
    let evaluation = of("evaluation, polynomial, degree (3, 3)");
    for side in ["in front of it", "pressed into it"] {
        let closest = of(&format!("closest point of the capped box, on a face, {side}, worst"));
        assert!(
            closest <= ON_A_FACE,
            "{board:?}: the closest point on a face, {side}, takes {closest} instructions, an evaluation {evaluation}"
        );
    }
    // A body from a file is tracked by the same code at the same cost, but for branches that the numbers of a static
    // decide when it is compiled.
    for part in ["median", "worst"] {
        let [statics, file] =
            ["", " from its file"].map(|from| of(&format!("closest point of the capped box{from}, any, {part}")));
        assert!(
            file.abs_diff(statics) <= STATIC,
            "{board:?}: a tick, {part}, takes {file} on a body from a file and {statics} on statics"
        );
    }
    let [rest, path] =
        ["at rest", "on a path"].map(|moves| of(&format!("servo tick, a scene of one body {moves}, median")));
    assert!(path <= rest + PATH, "{board:?}: a tick, median, takes {path} with a path, {rest} without");
    // The worst ticks of two runs are of different kinds: each has its own limit.
    let [plain, smooth] = ["", " smooth,"].map(|kind| of(&format!("servo tick,{kind} median")));
    assert!(smooth <= plain + SMOOTH, "{board:?}: a tick, median, takes {smooth} smooth, {plain} plain");
    let tick = of("servo tick, worst");
    assert!(tick <= SERVO_TICK, "{board:?}: a servo tick takes {tick} instructions");
    for kind in ["protected", "folded back", "smooth"] {
        let tick = of(&format!("servo tick, {kind}, worst"));
        assert!(board != Board::M4 || tick <= PROTECTED_TICK, "{board:?}: a tick, {kind}, takes {tick} instructions");
    }
}
