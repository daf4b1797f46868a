//! `palpate cycles`: its roots are functions of the image, and their calls are followed instruction by instruction.

use crate::running::is_wanted;
use palpate_tool::budgets::Budget;
use palpate_tool::cycles::{Core, ROOTS, Root, estimate};
use palpate_tool::firmware::{Board, Program, Progress};
use palpate_tool::proof::Code;

/// Calls of each root that are followed here; the command follows thousands.
const CALLS: usize = 20;

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
