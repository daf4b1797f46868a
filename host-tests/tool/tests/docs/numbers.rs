//! `docs/reference/measured.md`: each row is held by a test or a budget, and names a command that is there.

use crate::pages::{cells, compare, palpate, sources, text};
use palpate::body::BodyWitness;
use palpate::device::VelocityMethod;
use palpate::servo::{Guard, Guarded, ServoState};
use palpate_sim::zwidth::{Loop, Slice, in_words, sweep};
use palpate_tool::budgets::Budget;
use palpate_tool::devices::DEVICES;
use palpate_tool::firmware::Board;
use palpate_tool::models::SHIPPED;
use palpate_truth::measured::{self, Row, grouped};

/// Where the counted instructions begin and what comes after them.
const COUNTED: &str = "## Counted instructions";

/// Whether a claim is one that a test makes: the text between its placeholders, in order.
fn is_made(claim: &str, template: &str) -> bool {
    let mut rest = claim;
    let mut parts = template.split('{').enumerate().map(|(index, part)| match index {
        0 => part,
        _ => part.split_once('}').map_or("", |(_, after)| after),
    });
    let first = parts.next().unwrap_or_default();
    let Some(after) = rest.strip_prefix(first) else { return false };
    rest = after;
    let mut last = first;
    for part in parts {
        let Some((_, after)) = rest.split_once(part) else { return false };
        (rest, last) = (if part.is_empty() { rest } else { after }, part);
    }
    rest.is_empty() || last.is_empty()
}

/// The claims of all tests: every literal that a call of `measured` or what leads to one could have.
fn templates() -> Vec<String> {
    let crates = ["bake", "sim", "suites", "tool", "truth"];
    let sources = crates.iter().flat_map(|folder| sources(&format!("host-tests/{folder}")));
    let sources: Vec<String> = sources.collect();
    let texts = sources.iter().map(|file| text(file)).filter(|text| text.contains("measured"));
    let literals = |text: String| text.split('"').skip(1).map(str::to_owned).collect::<Vec<_>>();
    texts.flat_map(literals).filter(|literal| literal.len() > 10 && !literal.contains('\n')).collect()
}

#[test]
fn every_row_is_claimed_by_a_test() {
    let templates = templates();
    let counted = rows_after(COUNTED);
    let free: Vec<Row> = measured::rows()
        .into_iter()
        .filter(|row| !counted.contains(row))
        .filter(|row| !templates.iter().any(|template| is_made(&row.claim, template)))
        .collect();
    assert!(free.is_empty(), "no test measures {free:#?}");
}

/// The rows of a section.
fn rows_after(title: &str) -> Vec<Row> {
    let page = text("docs/reference/measured.md");
    let section =
        page.split(title).nth(1).unwrap_or_else(|| panic!("docs/reference/measured.md has no section {title:?}"));
    let section = section.split("\n## ").next().unwrap_or_default();
    measured::rows().into_iter().filter(|row| section.contains(&format!("| {} |", row.claim))).collect()
}

#[test]
fn counted_instructions_are_those_of_the_committed_budgets() {
    let rows = rows_after(COUNTED);
    assert!(rows.len() > 15);
    let budgets = Board::ALL.map(|board| (board.core(), Budget::load(board).expect("a budget")));
    for Row { claim, .. } in rows {
        let (core, name) = claim.split_once(": ").unwrap_or_else(|| panic!("{claim} names no core"));
        let (_, budget) = budgets.iter().find(|(known, _)| *known == core).unwrap_or_else(|| panic!("no core {core}"));
        let count = budget.of(name).unwrap_or_else(|| panic!("no budget of {name:?}"));
        measured::measured(&claim, grouped(count.into()));
    }
}

#[test]
fn the_table_of_cores_is_that_of_the_committed_budgets() {
    const PAGE: &str = "docs/howto/board.md";
    const MARK: &str = "<!-- generated: cargo palpate budgets --cores -->\n\n";
    let now = text(PAGE);
    let (before, rest) = now.split_once(MARK).expect("a generated block");
    let (_, after) = rest.split_once("<!-- end -->").expect("its end");
    compare(PAGE, &format!("{before}{MARK}{}\n<!-- end -->{after}", palpate(&["budgets", "--cores"])));
}

/// One device at one rate: all of them take minutes.
#[test]
fn the_walls_of_a_device_at_a_high_rate_are_those_of_the_page() {
    let page = text("docs/explanation/feel.md");
    let table =
        page.split("<!-- generated: cargo palpate zwidth --device all --rate 4000,10000,20000,40000 -->").nth(1);
    let row = table.and_then(|table| table.lines().find(|line| line.starts_with("| `hapkit`"))).expect("its row");
    let device = DEVICES.iter().find(|device| device.name == "hapkit").expect("the device");
    let like = Loop { rate: 0.0, delay_periods: 0.0, velocity: VelocityMethod::LowPass, corner: 200.0, ease: None };
    let slice = Slice::of(device);
    let limits = sweep(&slice, &[10e3], &[1.0], like, None, || ());
    let [stiffest, passive] =
        limits.iter().fold([0.0, 0.0], |[a, b], limit| [f64::max(a, limit.simulated), f64::max(b, limit.passive)]);
    let expected = format!("{} ({passive:.1})", in_words(&slice, stiffest));
    assert_eq!(cells(row).expect("cells")[2].replace(',', ""), expected);
}

#[test]
fn every_command_of_a_row_is_one_that_there_is() {
    let tests: String = sources("host-tests").iter().map(|file| text(file)).collect();
    let commands = text("docs/reference/commands.md");
    for Row { claim, command, .. } in measured::rows() {
        let command = command.trim_matches('`');
        let words: Vec<&str> = command.split_whitespace().skip_while(|word| word.starts_with("PALPATE_")).collect();
        let is_there = match words[..] {
            ["cargo", "test", name, ..] => tests.contains(&format!("fn {name}")),
            ["cargo", "palpate", name, ..] => commands.contains(&format!("\n## {name}\n")),
            _ => false,
        };
        assert!(is_there, "{claim}: there is no {command:?}");
    }
}

#[test]
fn the_state_of_a_loop_on_a_body() {
    let plain = size_of::<ServoState<3, BodyWitness>>();
    let protected = size_of::<ServoState<3, BodyWitness, <Guarded<3> as Guard<3>>::State>>();
    measured::measured("RAM of the state of a loop of three joints on a body", plain);
    measured::measured("RAM of the state of a protected loop of three joints on a body", protected);
    // The goal of the guard: heat of three motors, a release, three polarities.
    assert!(protected - plain <= 160, "{protected}, {plain}");
}

#[test]
fn the_models_take_the_bytes_that_were_measured() {
    let rows = measured::rows();
    let page = text("docs/reference/models.md");
    let mut count = 0;
    for row in page.lines().filter_map(cells).filter(|row| row.len() == 5 && row[2].contains(',')) {
        let claim = format!("flash of the tables of {}", row[0]);
        let measured = rows.iter().find(|row| row.claim == claim).unwrap_or_else(|| panic!("no row {claim:?}"));
        assert_eq!(row[2], measured.value, "docs/reference/models.md: {}", row[0]);
        count += 1;
    }
    assert!(count >= 7, "{count} models");
}

#[test]
fn the_units_of_the_models_are_listed() {
    let of = |unit: &'static str| SHIPPED.iter().filter(move |(_, text)| text.contains(unit));
    let cm: Vec<_> = of("unit = \"cm\"").map(|(name, _)| format!("`{name}`")).collect();
    assert_eq!(of("unit = \"mm\"").count() + cm.len(), SHIPPED.len());
    let [first, second, last] = &cm[..] else { panic!("{cm:?}") };
    let line = format!("Units: mm; {first}, {second} and {last} cm.");
    assert!(text("docs/reference/models.md").contains(&line), "docs/reference/models.md: {line}");
}
