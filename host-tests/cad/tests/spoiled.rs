//! Spoiled files: each is refused with a sentence, or imported; none ends in a panic.

use palpate_cad::{Options, import};
use std::fs;
use std::path::PathBuf;

fn whole() -> String {
    fs::read_to_string(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/parts/s02.step")).unwrap()
}

/// What is said of a text.
fn outcome(name: &str, text: &str) -> Result<usize, String> {
    let path = std::env::temp_dir().join(format!("palpate-cad-{}-{name}.step", std::process::id()));
    fs::write(&path, text).unwrap();
    let result = std::panic::catch_unwind(|| import(&path, &Options::default()));
    fs::remove_file(&path).unwrap();
    match result {
        Ok(Ok(imported)) => Ok(imported.patches.len()),
        Ok(Err(error)) => Err(error.to_string()),
        Err(_) => panic!("{name}: panicked"),
    }
}

fn refused(name: &str, text: &str, words: &str) {
    let message = outcome(name, text).expect_err(name);
    assert!(message.contains(words), "{name}: {message}");
}

#[test]
fn nothing_but_a_part_is_imported() {
    let whole = whole();
    refused("empty", "", "not a whole STEP file");
    refused("text", "a part, honestly", "not a whole STEP file");
    refused("toml", "unit = \"mm\"\n", "not a whole STEP file");
    refused("no-data", "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n", "");
    for (k, share) in (1..40).map(|k| (k, k * whole.len() / 40)) {
        refused(&format!("cut-{k}"), &whole[..share], "not a whole STEP file");
    }
}

#[test]
fn a_missing_entity_is_named() {
    let whole = whole();
    for (id, kind) in [
        (21, "EDGE_CURVE"),
        (19, "EDGE_LOOP"),
        (32, "PLANE"),
        (23, "CARTESIAN_POINT"),
        (16, "CLOSED_SHELL"),
        (27, "LINE"),
    ] {
        let start = whole.find(&format!("#{id} = {kind}")).unwrap();
        let end = start + whole[start..].find(';').unwrap() + 1;
        let text = format!("{}{}", &whole[..start], &whole[end..]);
        let message = outcome(&format!("without-{id}"), &text).unwrap_err();
        assert!(message.contains('#'), "without #{id}: {message}");
    }
}

#[test]
fn circles_and_nonsense_end() {
    let whole = whole();
    let spoiled = |from: &str, to: &str| {
        assert!(whole.contains(from), "{from}");
        whole.replacen(from, to, 1)
    };
    let cases = [
        ("loop-of-itself", spoiled("#19 = EDGE_LOOP('',(#20,", "#19 = EDGE_LOOP('',(#19,")),
        ("shell-of-itself", spoiled("#16 = CLOSED_SHELL('',(#17,", "#16 = CLOSED_SHELL('',(#16,")),
        ("nan", spoiled("(-20.,-15.,-10.)", "(NaN,-15.,-10.)")),
        ("huge", spoiled("(-20.,-15.,-10.)", "(-1e308,-15.,-10.)")),
        ("moved", spoiled("(-20.,-15.,-10.)", "(-25.,-15.,-10.)")),
        ("no-radius", whole.replace(",6.)", ",0.)")),
        ("negative-radius", whole.replace(",6.)", ",-6.)")),
        ("no-axis", spoiled("(0.,0.,1.)", "(0.,0.,0.)")),
        ("no-edges", spoiled("EDGE_LOOP('',(#20,#55,#83,#111))", "EDGE_LOOP('',())")),
        ("two-edges", spoiled("EDGE_LOOP('',(#20,#55,#83,#111))", "EDGE_LOOP('',(#20,#83))")),
        ("twice", spoiled("#17 = ADVANCED_FACE", "#16 = ADVANCED_FACE")),
    ];
    for (name, text) in cases {
        if let Err(message) = outcome(name, &text) {
            assert!(!message.is_empty() && !message.contains('\n'), "{name}: {message}");
        }
    }
}

/// Each of many entities taken out, and each of many digits changed: a sentence or a part, and an end.
#[test]
fn no_single_fault_panics() {
    let whole = whole();
    let statements: Vec<&str> = whole.split_inclusive(';').collect();
    for k in (10..statements.len() - 3).step_by(9) {
        let text: String = statements.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, text)| *text).collect();
        let _ = outcome(&format!("out-{k}"), &text);
    }
    let digits: Vec<usize> = whole.char_indices().filter(|(_, c)| c.is_ascii_digit()).map(|(at, _)| at).collect();
    for at in digits.iter().skip(500).step_by(97).take(60) {
        let text = format!("{}7{}", &whole[..*at], &whole[at + 1..]);
        let _ = outcome(&format!("digit-{at}"), &text);
    }
}
