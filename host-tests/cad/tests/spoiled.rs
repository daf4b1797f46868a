//! Spoiled files: each is refused with a sentence, or imported; none ends in a panic.

use palpate_cad::{Options, import};
use std::fs;
use std::path::PathBuf;
use std::process::Command;

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
        // Its number, and that of the one that refers to it.
        let says = format!("cannot be used: it refers to #{id}, which the file does not have; export the part again");
        assert!(message.starts_with("entity #") && message.ends_with(&says), "without #{id}: {message}");
    }
}

#[test]
fn a_surface_of_a_type_that_is_not_read_is_named_with_those_that_are() {
    let whole = whole();
    let start = whole.find("#32 = PLANE('',").unwrap();
    let spoiled = format!("{}#32 = BLEND_SURFACE('',{}", &whole[..start], &whole[start + "#32 = PLANE('',".len()..]);
    let words = "entity #32 (BLEND_SURFACE) of ";
    refused("blend", &spoiled, words);
    refused("blend", &spoiled, "B-spline (NURBS) surface; export the part again");
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

/// A spoiled file: its name, its text, and what the sentence must hold.
struct Spoiled {
    name: String,
    text: String,
    words: &'static str,
}

fn part(name: &str) -> String {
    fs::read_to_string(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/parts/{name}.step"))).unwrap()
}

/// Ten places at which each part is cut off.
fn cut_off() -> Vec<Spoiled> {
    let cut = |name: &str, text: &str, k: usize| Spoiled {
        name: format!("{name}-cut-{k}"),
        text: text[..k * text.len() / 11].to_owned(),
        words: "not a whole STEP file: ",
    };
    let parts = ["s02", "s09", "s12"].map(|name| (name, part(name)));
    parts.iter().flat_map(|(name, text)| (1..=10).map(|k| cut(name, text, k))).collect()
}

/// The first and the last entity of each type that a shape cannot do without, taken out.
fn without_entities() -> Vec<Spoiled> {
    let kinds = [
        "CARTESIAN_POINT",
        "DIRECTION",
        "VECTOR",
        "LINE",
        "CIRCLE",
        "AXIS2_PLACEMENT_3D",
        "VERTEX_POINT",
        "EDGE_CURVE",
        "ORIENTED_EDGE",
        "EDGE_LOOP",
        "FACE_BOUND",
        "PLANE",
        "CYLINDRICAL_SURFACE",
        "TOROIDAL_SURFACE",
        "B_SPLINE_CURVE_WITH_KNOTS",
        "ADVANCED_FACE",
        "CLOSED_SHELL",
        "MANIFOLD_SOLID_BREP",
        "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION",
        "ITEM_DEFINED_TRANSFORMATION",
        "NEXT_ASSEMBLY_USAGE_OCCURRENCE",
    ];
    let text = part("s11");
    let mut all = Vec::new();
    for kind in kinds {
        let starts: Vec<usize> = text.match_indices(&format!(" = {kind}(")).map(|(at, _)| at).collect();
        let mut which = vec![starts[0], starts[starts.len() - 1]];
        which.dedup();
        for at in which {
            let start = text[..at].rfind('\n').unwrap() + 1;
            let end = at + text[at..].find(';').unwrap() + 1;
            let id = &text[start..at];
            let text = format!("{}{}", &text[..start], &text[end..]);
            all.push(Spoiled { name: format!("without-{kind}-{}", &id[1..]), text, words: "#" });
        }
    }
    all
}

fn nonsense() -> Vec<Spoiled> {
    let (box_, assembly) = (part("s02"), part("s11"));
    let edit = |name: &str, of: &str, from: &str, to: &str, words: &'static str| {
        assert!(of.contains(from), "{name}: {from}");
        Spoiled { name: name.to_owned(), text: of.replacen(from, to, 1), words }
    };
    let schema = "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }";
    let loop_ = "#19 = EDGE_LOOP('',(#20,#55,#83,#111))";
    let corner = "(-20.,-15.,-10.)";
    let ring = "'1','base','',#5,#31,$";
    let rows = |row: &dyn Fn(usize) -> String| {
        let head = &box_[..box_.find("DATA;").unwrap() + 6];
        let data: String = (1..1_000_000).map(row).collect();
        format!("{head}{data}ENDSEC;\nEND-ISO-10303-21;\n")
    };
    let many = |name: &str, text: String, words| Spoiled { name: name.to_owned(), text, words };
    vec![
        // Wrong schema.
        edit("schema-of-buildings", &box_, schema, "IFC4", "has the schema \"IFC4\""),
        edit("schema-of-frames", &box_, schema, "STRUCTURAL_FRAME_SCHEMA", "has the schema"),
        edit("no-schema", &box_, &format!("FILE_SCHEMA(('{schema}'));"), "", "FILE_SCHEMA"),
        // Circles.
        edit("loop-of-itself", &box_, loop_, "#19 = EDGE_LOOP('',(#19,#55,#83,#111))", "#19 (EDGE_LOOP)"),
        edit("shell-of-itself", &box_, "CLOSED_SHELL('',(#17,", "CLOSED_SHELL('',(#16,", "#16 (CLOSED_SHELL)"),
        edit("product-of-itself", &assembly, ring, "'1','base','',#31,#31,$", "is made of itself"),
        edit(
            "products-of-each-other",
            &assembly,
            "'2','pin','',#5,#702,$",
            "'2','pin','',#31,#5,$",
            "is made of itself",
        ),
        // Nothing to feel.
        edit("no-solid", &box_, "MANIFOLD_SOLID_BREP", "SPARE", "#"),
        edit("empty-loop", &box_, loop_, "#19 = EDGE_LOOP('',())", "#19 (EDGE_LOOP)"),
        many("empty", String::new(), "not a whole STEP file"),
        many("a-page", "<html><body>404</body></html>".to_owned(), "not a whole STEP file"),
        // Shapes that are none.
        edit("corner-off", &box_, corner, "(-25.,-15.,-10.)", "face 1 (#17): its edge #21 lies 5.000000 mm off it"),
        edit("corner-of-four", &box_, corner, "(-20.,-15.,-10.,1.)", "#23 (CARTESIAN_POINT)"),
        edit("corner-of-words", &box_, corner, "(-20.,'x',-10.)", "#"),
        edit("corner-not-a-number", &box_, corner, "(NaN,-15.,-10.)", "line 32"),
        edit("corner-far-off", &box_, corner, "(-1.E+308,-15.,-10.)", "#"),
        edit("nested", &box_, corner, &"(".repeat(1_000_000), "nesting too deep"),
        edit("two-edges", &box_, loop_, "#19 = EDGE_LOOP('',(#20,#83))", "(#17): the edges of a loop"),
        edit("edges-in-disorder", &box_, loop_, "#19 = EDGE_LOOP('',(#20,#83,#55,#111))", "(#17): the edges of a loop"),
        edit("edge-twice", &box_, loop_, "#19 = EDGE_LOOP('',(#20,#20,#83,#111))", "(#17): the edges of a loop"),
        edit("point-for-an-edge", &box_, loop_, "#19 = EDGE_LOOP('',(#23,#55,#83,#111))", "#19 (EDGE_LOOP)"),
        edit("number-too-large", &box_, loop_, &loop_.replace("#20", "#99999999999999999999"), "line 28"),
        edit("no-radius", &box_, ",6.);", ",0.);", "its radius is 0"),
        edit("radius-below-nothing", &box_, ",6.);", ",-6.);", "its radius is -6"),
        edit("twice-one-number", &box_, "#17 = ADVANCED_FACE", "#16 = ADVANCED_FACE", "duplicate entity #16"),
        edit("misspelt", &box_, "= ADVANCED_FACE", "= ADVANCED_FACES", "#17 (ADVANCED_FACES)"),
        edit("no-comma", &box_, "(#20,#55,", "(#20#55,", "line 28"),
        // A million entities.
        many(
            "million-points",
            rows(&|id| format!("#{id} = CARTESIAN_POINT('',({id}.,0.,0.));\n")),
            "no solid and no shell",
        ),
        many(
            "million-cut-off",
            rows(&|id| format!("#{id} = CARTESIAN_POINT('',({id}.,0.,0.));\n"))
                .split_inclusive("(999")
                .next()
                .map_or_else(String::new, str::to_owned),
            "it ends on line ",
        ),
        many("million-in-a-chain", rows(&|id| format!("#{id} = VERTEX_POINT('',#{});\n", id + 1)), "#1 (VERTEX_POINT)"),
        edit("million-faces", &box_, "SHELL('',(#17,", &format!("SHELL('',(#17,{}", "#17,".repeat(1_000_000)), "faces"),
    ]
}

/// By the program itself: a sentence, exit status 2, no file.
#[test]
fn a_hundred_spoiled_files_are_refused_with_a_sentence() {
    let folder = std::env::temp_dir().join(format!("palpate-cad-spoiled-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let (file, out) = (folder.join("part.step"), folder.join("part.toml"));
    let mut refused = 0;
    for Spoiled { name, text, words } in cut_off().into_iter().chain(without_entities()).chain(nonsense()) {
        fs::write(&file, text).unwrap();
        let run = Command::new(env!("CARGO_BIN_EXE_palpate-cad")).args([&file, &out]).arg("0.01").output().unwrap();
        let message = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{name}: {message}");
        assert_eq!(message.trim().lines().count(), 1, "{name}: {message}");
        assert!(message.contains(words), "{name}: {message}");
        assert!(!message.contains("failed on this part"), "{name} panicked");
        // Where it is cut off: the line, and the entity there.
        let is_placed = message.contains(" line ") && message.contains('#');
        assert!(is_placed || !name.contains("-cut-"), "{name}: {message}");
        fs::remove_file(&file).unwrap();
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "{name} left a file");
        refused += 1;
    }
    fs::remove_dir(&folder).unwrap();
    println!("{refused} spoiled parts refused");
    assert!(refused >= 100, "{refused}");
}
