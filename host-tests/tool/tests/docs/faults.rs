//! `docs/reference/faults.md` has the table of failures, and every fault of the loop has a row with a test.

use crate::pages::{compare, files, sources, text};
use palpate::servo::Fault;
use palpate_tool::faults::{Failure, Reaction, Shown, TABLE, page, plant};

const PAGE: &str = "docs/reference/faults.md";
const MARK: &str = "<!-- generated: cargo palpate faults -->\n\n";

#[test]
fn the_page_has_the_table() {
    let now = text(PAGE);
    let (before, rest) = now.split_once(MARK).expect("a generated block");
    let (_, after) = rest.split_once("<!-- end -->").expect("its end");
    compare(PAGE, &format!("{before}{MARK}{}\n<!-- end -->{after}", page()));
}

#[test]
fn every_fault_has_a_row() {
    for fault in Fault::ALL {
        // They show the same failure of a sensor in two ways.
        let shown = match fault {
            Fault::JointJumped => Fault::FrameDamaged,
            Fault::Unreachable => Fault::JointOutOfRange,
            other => other,
        };
        assert!(TABLE.iter().any(|row| row.reaction == Reaction::Latched(shown)), "{PAGE}: no row for {fault}");
    }
}

#[test]
fn every_row_names_a_test() {
    let all: String = ["host-tests/sim/tests", "host-tests/suites/tests", "host-tests/tool/tests"]
        .iter()
        .flat_map(|folder| sources(folder))
        .map(|file| text(&file))
        .collect();
    let registers: String = files("host-tests/registers", "py").iter().map(|file| text(file)).collect();
    for row in TABLE.iter().filter(|row| !matches!(row.shown, Shown::Gap(_))) {
        let is_there = all.contains(&format!("fn {}()", row.test)) || registers.contains(&format!("def {}(", row.test));
        assert!(is_there, "{PAGE}: no test {}", row.test);
    }
}

#[test]
fn every_planted_failure_is_detected_as_the_page_states() {
    let nothing = Failure { shown: Shown::Planted(|_, _| ()), ..TABLE[0] };
    let found = plant(&nothing).expect("it can be planted");
    assert_eq!((found.off_ms, found.fault), (None, None), "no failure, nothing detected");
    for row in TABLE {
        if let Some(found) = plant(row) {
            assert!(row.is_as_stated(&found), "{}: {found:?}, promised {} ms", row.failure, row.within_ms);
        }
    }
}
