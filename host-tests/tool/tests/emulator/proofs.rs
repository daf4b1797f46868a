//! What is proved of the image from its machine code; and that what is planted there is found.

use crate::running::{boards, is_wanted};
use palpate_tool::commands::image::{TICK, deepest_stack, unwanted};
use palpate_tool::firmware::{Board, Pace, Program, Progress};
use palpate_tool::proof::{Code, Finding, Lines, LoopList, StackError, Tree, deepest};
use palpate_tool::repository;
use std::collections::BTreeMap;
use std::io::{Write, stderr};

/// Stack of the whole image, bytes.
const STACK: i64 = 2 * 1024;
/// The same with all protection: its tick calls one function more.
const PROTECTED_STACK: i64 = STACK + 256;
/// Flash of an image with all protection, bytes: a small part's half.
const PROTECTED: u64 = 64 * 1024;

struct Read {
    code: Code,
    lines: Lines,
    flash: u64,
}

fn read(board: Board, program: &str, features: &[&str]) -> Read {
    let program = Program::prepare(board, program, features, &Progress::new()).unwrap();
    let elf = &program.image.elf;
    Read { code: Code::read(elf).unwrap(), lines: Lines::read(elf).unwrap(), flash: program.image.flash }
}

impl Read {
    fn tree(&self) -> Tree<'_> {
        Tree::new(&self.code, self.code.named(TICK).unwrap())
    }

    fn missing(&self) -> Vec<String> {
        let list = LoopList::read(&repository::root().unwrap().join("host-tests/budgets/loops.toml")).unwrap();
        list.missing(&self.tree(), &self.lines)
    }
}

fn proves(board: Board, program: &str, features: &[&str]) {
    let image = read(board, program, features);
    let tree = image.tree();
    // A tree of one small function would prove nothing: evaluation, controller and servo are hundreds of instructions.
    let size: usize = tree.functions().map(|function| function.instructions.len()).sum();
    assert!(size > 1_000, "{board:?}: the tick is {size} instructions");
    assert!(tree.findings().is_empty(), "{board:?}, {program}: {:#?}", tree.findings());
    assert_eq!(image.missing(), Vec::<String>::new(), "{board:?}, {program}");
    assert_eq!(unwanted(&image.code, &image.lines), Vec::<String>::new(), "{board:?}, {program}");
    let stack = deepest_stack(&image.code).unwrap();
    let most = if features.is_empty() { STACK } else { PROTECTED_STACK };
    assert!(stack <= most, "{board:?}, {program} {features:?}: {stack} bytes of stack");
    let flash = image.flash;
    assert!(flash <= PROTECTED, "{board:?}, {program} {features:?}: {flash} bytes of flash");
    let core = board.core();
    let _ = writeln!(stderr(), "{core} {program} {features:?}: {flash} bytes of flash, {stack} of stack at most");
}

#[test]
fn no_tick_panics_allocates_recurses_computes_in_f64_or_loops_without_a_bound() {
    if !is_wanted("no_tick_panics_allocates_recurses_computes_in_f64_or_loops_without_a_bound") {
        return;
    }
    for board in Board::CORTEX_F {
        for program in ["uart", "fifo"] {
            proves(board, program, &[]);
        }
    }
}

#[test]
fn no_protected_tick_does_either_and_its_image_stays_within_64_kilobytes() {
    if !is_wanted("no_protected_tick_does_either_and_its_image_stays_within_64_kilobytes") {
        return;
    }
    for &board in boards() {
        proves(board, "uart", &["protected"]);
    }
}

#[test]
fn what_is_planted_is_found() {
    if !is_wanted("what_is_planted_is_found") {
        return;
    }
    let planted = |board, feature| read(board, "uart", &[feature]);
    let finds = |board, feature, is: fn(&Finding) -> bool| {
        let image = planted(board, feature);
        let tree = image.tree();
        assert!(tree.findings().iter().any(is), "{board:?}, {feature}: {:?}", tree.findings());
    };
    for &board in boards() {
        finds(board, "planted-panic", |found| matches!(found, Finding::Panic(_)));
    }
    // A routine where the core has no such unit, an instruction where it has.
    for board in [Board::M4, Board::M7] {
        finds(board, "planted-f64", |found| matches!(found, Finding::Double(..)));
    }
    let soft = planted(Board::M4, "planted-f64");
    assert!(unwanted(&soft.code, &soft.lines).iter().any(|found| found.contains("f64")));
    finds(Board::M4, "planted-recursion", |found| matches!(found, Finding::Recursion(_)));
    finds(Board::M4, "planted-indirect", |found| matches!(found, Finding::Indirect(..)));
    let endless = planted(Board::M4, "planted-loop").missing();
    assert!(endless.iter().any(|found| found.contains("planted::fault")), "{endless:?}");
    let allocating = planted(Board::M4, "planted-alloc");
    assert!(unwanted(&allocating.code, &allocating.lines).iter().any(|found| found.contains("an allocator")));
    assert!(deepest_stack(&planted(Board::M4, "planted-stack").code).unwrap() > STACK);
    let recursive = planted(Board::M4, "planted-recursion");
    let depth = deepest(&recursive.code, recursive.code.named(TICK).unwrap());
    assert!(matches!(depth, Err(StackError::Recursive { .. })), "{depth:?}");
}

#[test]
fn the_stack_measured_is_within_its_bound() {
    if !is_wanted("the_stack_measured_is_within_its_bound") {
        return;
    }
    for &board in boards() {
        let program = Program::prepare(board, "stack", &[], &Progress::new()).unwrap();
        let bound = deepest_stack(&Code::read(&program.image.elf).unwrap()).unwrap();
        let said: BTreeMap<String, i64> = toml::from_str(&program.run(Pace::Counting).unwrap()).unwrap();
        let measured = said["stack"];
        let _ = writeln!(stderr(), "{}: {measured} bytes of stack measured, {bound} at most", board.core());
        assert!(measured <= bound && bound <= STACK, "{board:?}: measured {measured}, bound {bound}");
        // Painting that finds nothing would be within any bound: the tick alone takes more than this.
        assert!(measured > 256, "{board:?}: {measured}");
        // Every boundary mode, by its number from 1.
        assert!(said["modes"] == 0b111_1110 && said["ticks_in_contact"] > 1_000, "{said:?}");
    }
}
