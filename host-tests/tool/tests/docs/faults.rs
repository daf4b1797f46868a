//! `docs/reference/faults.md` has the table of failures, and every fault of the loop has a row with a test.

use crate::pages::{compare, files, sources, text};
use palpate::servo::Fault;
use palpate_tool::devices::DEVICES;
use palpate_tool::faults::{
    Failure, KNOB, RELEASES, Reaction, SINKS, Setting, Shown, Subject, brakes_with_a_chopper, is_let_go, page, table,
};

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
        assert!(table().any(|row| row.reaction == Reaction::Latched(shown)), "{PAGE}: no row for {fault}");
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
    let arms = table().filter(|row| row.is_detected()).map(|row| row.test);
    for test in arms.chain(KNOB.iter().map(|row| row.test)) {
        let is_there = all.contains(&format!("fn {test}()")) || registers.contains(&format!("def {test}("));
        assert!(is_there, "{PAGE}: no test {test}");
    }
}

#[test]
fn every_planted_failure_is_detected_as_the_page_states_on_every_device() {
    for device in &DEVICES {
        let subject = Subject::new(device);
        let nothing = subject.plant(Setting::Pressed, |_| true).expect("it can be planted");
        assert_eq!((nothing.off_ms, nothing.fault), (None, None), "{}: no failure, nothing detected", device.name);
        for row in table().filter(|row| matches!(row.shown, Shown::Planted(..))) {
            // The tables are the loop's, whatever the device, and their check takes 24,000 ticks.
            if matches!(row.shown, Shown::Planted(Setting::Tabled, _)) && device.name != DEVICES[0].name {
                continue;
            }
            let is_excused = row.excuse(&subject).is_some();
            let found = row.plant(&subject);
            let is_as_stated = found.is_some_and(|found| row.is_as_stated(&found));
            assert!(
                is_as_stated || is_excused,
                "{} {}: {found:?}, promised {} ms",
                device.name,
                row.failure,
                row.within_ms
            );
        }
    }
}

#[test]
fn an_arm_of_ten_percent_more_weight_sinks_as_far_as_the_page_states() {
    let row: &Failure = table().find(|row| row.failure.contains("weight")).expect("the row of the weight");
    for (device, (name, sink)) in DEVICES.iter().zip(SINKS) {
        let found = row.plant(&Subject::new(device)).expect("it can be planted");
        assert_eq!((device.name, found.fault), (name, None));
        // The last digit of the page.
        assert!((found.motion_mm - sink).abs() <= 0.5, "{name}: {} mm, {sink} on the page", found.motion_mm);
    }
}

#[test]
fn an_arm_that_is_let_go_is_as_fast_as_the_page_states() {
    let mut found = Vec::new();
    for device in &DEVICES {
        let subject = Subject::new(device);
        let [stopped, free] =
            [Setting::Protected, Setting::Unprotected].map(|setting| subject.plant(setting, is_let_go));
        let stopped = stopped.map(|found| [found.speed_m_per_s, found.motion_mm]);
        found.push((device.name, stopped, free.expect("it can be planted").speed_m_per_s));
    }
    println!("{found:.2?}");
    // The last digits of the page.
    let is_near = |found: f64, page: f64, digit: f64| (found - page).abs() <= 0.5 * digit;
    for ((name, stopped, free), page) in found.into_iter().zip(RELEASES) {
        let is_same = match (stopped, page.stopped) {
            (Some([speed, motion]), Some([page, moved])) => is_near(speed, page, 0.01) && is_near(motion, moved, 0.1),
            (stopped, page) => stopped.is_none() && page.is_none(),
        };
        let is_free = is_near(free, page.free.unwrap_or(0.0), 0.01);
        assert!(name == page.device && is_same && is_free, "{name}: {stopped:?}, {free}");
    }
}

#[test]
fn every_failure_of_a_knob_is_detected_as_the_page_states() {
    assert_eq!(brakes_with_a_chopper(), None);
    for row in table() {
        assert!(
            row.plant_on_knob().is_none_or(|found| row.is_as_stated_of(found.off_ms, found.fault)),
            "{}",
            row.failure
        );
    }
    for row in &KNOB {
        let found = row.plant();
        assert!(row.is_as_stated(&found), "{}: {found:?}", row.failure);
    }
}
