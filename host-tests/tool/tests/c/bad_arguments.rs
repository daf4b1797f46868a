//! Bad arguments under the sanitizers: an error code each, and no byte touched that is not the library's to touch.

use crate::running::{capped_box, file, is_wanted, library, run};
use palpate_tool::in_c::{self, Core};
use std::process::Command;

/// How many calls.
const CALLS: u32 = 100_000;

#[test]
fn a_hundred_thousand_bad_calls_come_back_with_an_error_code_each() {
    if !is_wanted("a hundred thousand bad calls of the C library") {
        return;
    }
    let library = library(Core::Sanitized);
    let folder = tempfile::tempdir().expect("a folder");
    let hammer = folder.path().join("hammer");
    let mut gcc = in_c::compiler(Core::Sanitized, "gcc").expect("in the repository");
    gcc.args(["-std=c11"]).arg(file("tests/hammer.c")).arg(library).args(["-lm", "-o"]).arg(&hammer);
    run(&mut gcc);
    let said = run(Command::new(&hammer).arg(capped_box()).arg(CALLS.to_string()));
    print!("{said}");
    assert!(said.contains(&format!("hammer: {CALLS} calls with bad arguments, an error code each")), "{said}");
    // Each status that bad arguments can have comes up: a hammer that always hit the same nail would pass, too.
    let kinds = said.lines().filter(|line| line.starts_with("  ")).count();
    assert!(kinds >= 78, "{kinds} kinds of refusal only");
}
