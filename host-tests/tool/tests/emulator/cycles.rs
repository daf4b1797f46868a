//! `palpate cycles`: its roots are functions of the image, and their calls are followed instruction by instruction.

use crate::running::is_wanted;
use palpate_tool::budgets::Budget;
use palpate_tool::cycles::{Core, LOOPS, ROOTS, Root, SERVO, estimate};
use palpate_tool::firmware::{Board, Program, Progress, cores};
use palpate_tool::proof::Code;

/// Calls of each root that are followed here; the command follows thousands.
const CALLS: usize = 20;
/// Protected ticks: some ten seconds.
const A_FEW: usize = 3_000;

/// Whether the whole walk is followed: in a long run.
fn is_long() -> bool {
    cores().len() > 1
}

#[test]
fn each_root_is_a_function_of_the_image() {
    if !is_wanted("each_root_is_a_function_of_the_image") {
        return;
    }
    for board in [Board::M4, Board::M7] {
        let program = Program::prepare(board, "budget", &[], &Progress::new()).expect("the program builds");
        let code = Code::read(&program.image.elf).expect("the image holds code");
        for root in &ROOTS {
            assert!(code.named(root.function).is_ok(), "{board:?}: {:?}", code.named(root.function).err());
        }
    }
}

#[test]
fn the_instructions_followed_are_those_that_the_budget_counts() {
    if !is_wanted("the_instructions_followed_are_those_that_the_budget_counts") {
        return;
    }
    // The closest point comes after the servo's whole walk: minutes, instruction by instruction.
    let roots: Vec<Root> = ROOTS.iter().filter(|root| !root.title.starts_with("closest")).copied().collect();
    let roots: Vec<Root> = roots.iter().map(|root| Root { take: root.take.min(CALLS), ..*root }).collect();
    let program = Program::prepare(Board::M4, "budget", &[], &Progress::new()).expect("the program builds");
    let found = estimate(&program, Core::M4, &roots).expect("the program is followed");
    let budget = Budget::load(Board::M4).expect("the committed budget");
    for (root, calls) in &found {
        assert_eq!(calls.instructions.len(), root.take, "{}", root.title);
        for (index, instructions) in calls.instructions.iter().enumerate() {
            let [low, high] = calls.cycles.each_ref().map(|cycles| cycles[index]);
            assert!(instructions / 2 <= low && low <= high, "{}: {instructions}, {low} to {high}", root.title);
        }
    }
    for degree in ["(2, 2)", "(3, 3)"] {
        let title = format!("evaluation, degree {degree}");
        let (_, calls) = found.iter().find(|(root, _)| root.title == title).expect("an evaluation");
        let counted = budget.of(&format!("evaluation, polynomial, degree {degree}")).expect("a figure of the budget");
        // The budget's counter also takes the call and the reading of its clock.
        let followed = calls.instructions[0];
        assert!(followed <= counted && 10 * followed >= 8 * counted, "{title}: {followed} followed, {counted} counted");
    }
}

#[test]
fn protected_ticks_are_followed_one_by_one_as_the_budget_counts_them() {
    if !is_wanted("protected_ticks_are_followed_one_by_one_as_the_budget_counts_them") {
        return;
    }
    let budget = Budget::load(Board::M4).expect("the committed budget");
    for (feature, title) in LOOPS.into_iter().filter(|(feature, _)| ["counted", "folded"].contains(feature)) {
        let program = Program::prepare(Board::M4, "budget", &[feature], &Progress::new()).expect("the program builds");
        let root = Root { title, take: if is_long() { SERVO.take } else { A_FEW }, ..SERVO };
        let found = estimate(&program, Core::M4, &[root]).expect("the program is followed");
        let worst = budget.of(&format!("{title}, worst")).expect("a figure of the budget");
        let followed = found[0].1.instructions.iter().max().copied().expect("ticks");
        println!("{title}: at most {followed} followed, {worst} counted");
        // Two ticks for one would be more.
        assert!(followed <= worst, "{title}: {followed} followed, {worst} counted");
        // The counter takes the call and the reading of its clock too, and counts five times as many ticks as are followed.
        let is_near = 100 * followed >= 98 * worst;
        assert!(!is_long() || is_near, "{title}: {followed} followed, {worst} counted");
    }
}
