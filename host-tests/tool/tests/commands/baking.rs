//! `palpate bake` and `palpate check`: files that are written, and files that are refused.

use glam::DVec3;
use palpate_bake::{BakedBody, Model};
use palpate_truth::generate::models::{cuboid, moved};
use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

fn repository() -> PathBuf {
    palpate_tool::repository::root().expect("tests run in it")
}

fn model(name: &str) -> PathBuf {
    repository().join("host-tests/models").join(name).with_extension("toml")
}

#[test]
fn the_committed_tables_are_what_bake_makes_of_their_models() -> Result<(), Box<dyn Error>> {
    for (name, is_certified) in [("table1c", false), ("ellipsoid", false), ("capped_box", true)] {
        let directory = tempfile::tempdir()?;
        let out = directory.path().join(name).with_extension("rs");
        let run =
            Command::new(env!("CARGO_BIN_EXE_palpate")).arg("bake").arg(model(name)).arg("--out").arg(&out).output()?;
        let said = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(0), "usable: {said}");
        assert_eq!(said.contains("no proof covers every probe"), !is_certified, "{said}");
        let committed = fs::read_to_string(repository().join("boards/bodies").join(name).with_extension("rs"))?;
        assert!(
            fs::read_to_string(out)? == committed,
            "boards/bodies/{name}.rs has drifted: \
             cargo palpate bake host-tests/models/{name}.toml --out boards/bodies/{name}.rs"
        );
        let left: Vec<_> = fs::read_dir(&directory)?.collect();
        assert_eq!(left.len(), 1, "no partial file is left");
    }
    Ok(())
}

#[test]
fn check_says_usable_and_not_certified() -> Result<(), Box<dyn Error>> {
    let run = Command::new(env!("CARGO_BIN_EXE_palpate")).arg("check").arg(model("table1")).output()?;
    let report = String::from_utf8_lossy(&run.stdout);
    assert_eq!(run.status.code(), Some(1));
    assert!(report.contains("usable, not certified") && report.contains("C1,C1") && report.contains("3x3"), "{report}");
    Ok(())
}

#[test]
fn bake_writes_source_graph_and_bytes() -> Result<(), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let [out, dot] = ["plate.rs", "plate.dot"].map(|name| directory.path().join(name));
    let mut bake = Command::new(env!("CARGO_BIN_EXE_palpate"));
    let run = bake.arg("bake").arg(model("thin_plate")).arg("--out").arg(&out).arg("--graph").arg(&dot);
    let run = run.arg("--table-report").output()?;
    assert_eq!(run.status.code(), Some(0), "certified: {}", String::from_utf8_lossy(&run.stderr));
    let source = fs::read_to_string(out)?;
    assert!(source.starts_with("// Baked table, not for editing: palpate bake thin_plate.toml --out plate.rs\n"));
    assert!(source.contains("pub static BODY: palpate::body::Body") && source.contains("pub const TABLE_CRC: u32 = "));
    syn::parse_file(&source)?;
    assert!(fs::read_to_string(dot)?.starts_with("graph \"thin-plate\" {"));
    let report = String::from_utf8_lossy(&run.stdout);
    // 6 faces of 4 points, 12 lines of 2, all of 3 numbers; all separators are planes; one pair of borders.
    for line in [
        "coefficients          288",
        "curves                288",
        "separators              0",
        "borders                 8",
    ] {
        assert!(report.contains(line), "{report}");
    }
    Ok(())
}

#[test]
fn bake_refuses_a_tick_above_the_limit() -> Result<(), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let out = directory.path().join("plate.rs");
    let bake = |option: &str, limit: &str| {
        let mut bake = Command::new(env!("CARGO_BIN_EXE_palpate"));
        bake.args(["bake", "thin_plate", "--table-report", option, limit, "--out"]).arg(&out).output()
    };
    // Less than a tick without a body takes.
    let run = bake("--tick-cycles", "4000")?;
    let text = String::from_utf8_lossy(&run.stderr);
    assert!((run.status.code(), out.exists()) == (Some(2), false) && text.contains("limit is 4000"), "{text}");
    let run = bake("--tick-limit", "29")?;
    let text = String::from_utf8_lossy(&run.stderr);
    assert_eq!((run.status.code(), out.exists()), (Some(2), false), "{text}");
    // Three edges end at the corner of a plate. There a tick looks at each of them up to three times, and at one more;
    // before that it takes the bench's four steps, of five evaluations at most.
    assert!(text.contains("30 evaluations") && text.contains("3 edges end") && text.contains("limit is 29"), "{text}");
    let run = bake("--tick-limit", "30")?;
    let text = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.code() == Some(0) && text.contains("worst tick             30 evaluations"), "{text}");
    Ok(())
}

/// What `bake` writes, with so many threads.
fn baked_source(name: &str, threads: &str) -> Result<(String, String), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let out = directory.path().join("out.rs");
    let mut bake = Command::new(env!("CARGO_BIN_EXE_palpate"));
    let run = bake.arg("bake").arg(model(name)).arg("--out").arg(&out).arg("--table-report");
    let run = run.env("RAYON_NUM_THREADS", threads).output()?;
    Ok((fs::read_to_string(out)?, String::from_utf8(run.stdout)?))
}

#[test]
fn bake_writes_the_locator_the_same_on_any_number_of_cores() -> Result<(), Box<dyn Error>> {
    let (source, report) = baked_source("capped_box", "1")?;
    assert!(baked_source("capped_box", "3")?.0 == source);
    let model = Model::read(&model("capped_box"))?;
    let body = BakedBody::new(&model, "capped_box")?;
    let options = body.locator_options();
    let (body, located) = body.located(&options, &|_, _| ())?;
    assert!(source.contains(&format!("pub const TABLE_CRC: u32 = {};", body.to_body()?.table_crc())));
    assert!(body.locator.nodes.len() > 10, "{}", body.locator.nodes.len());
    let row = |kind: &str| -> Result<usize, Box<dyn Error>> {
        let line = report.lines().find(|line| line.trim_start().starts_with(kind)).ok_or(report.clone())?;
        let number = line.trim_start()[kind.len()..].split_whitespace().next().ok_or("no number")?;
        Ok(number.parse()?)
    };
    // The whole box in 8 KiB.
    assert!(row("all")? <= 8192, "{report}");
    assert_eq!(row("locator leaves")?, located.leaves);
    let counts = located.leaves_by;
    assert_eq!([row("proved")?, row("convex")?, row("sampled")?, row("deep")?].iter().sum::<usize>(), located.leaves);
    assert_eq!((counts.sampled, counts.deep), (0, 0), "{report}");
    assert_eq!(row("cold start")?, 32);
    Ok(())
}

fn big() -> String {
    cuboid("a", [0.0, 0.0, 0.0], [40.0, 30.0, 20.0], false)
}

#[test]
fn the_tool_says_it_and_certifies_no_such_body() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let (model, out) = (folder.path().join("two.toml"), folder.path().join("two.rs"));
    for (text, code, words) in [
        (
            big() + &cuboid("b", [30.0, 10.0, 5.0], [70.0, 50.0, 55.0], false),
            1,
            "flaw: patch \"a top\" and patch \"b left\" cut each other near",
        ),
        (big() + &cuboid("b", [50.0, 10.0, 5.0], [60.0, 20.0, 15.0], false), 0, ""),
        (big().replacen("20.0]", "20.06]", 4), 0, "note: the body is open: 8 edges have one face"),
    ] {
        fs::write(&model, format!("unit = \"mm\"\n{text}"))?;
        for command in ["check", "bake"] {
            let mut tool = Command::new(env!("CARGO_BIN_EXE_palpate"));
            tool.arg(command).arg(&model);
            if command == "bake" {
                tool.arg("--out").arg(&out);
            }
            let run = tool.args((command == "bake").then_some("--require-certified")).output()?;
            let said = [run.stdout, run.stderr].map(|said| String::from_utf8_lossy(&said).into_owned()).concat();
            assert_eq!(run.status.code(), Some(code), "{command}: {said}");
            assert!(said.contains(words), "{command}: {said}");
            assert_eq!(said.contains("flaw: "), code == 1, "{command}: {said}");
        }
    }
    Ok(())
}

#[test]
fn the_tool_answers_in_the_frame_of_the_file_and_the_tables_say_where_theirs_lies() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let plate = fs::read_to_string(model("thin_plate"))?;
    let offset = DVec3::new(3_000.0, -2_000.0, 500.0);
    let run = |command: &str, place: DVec3, options: &[&str]| -> Result<String, Box<dyn Error>> {
        let [model, queries, out] = ["plate.toml", "in.csv", "out.rs"].map(|name| folder.path().join(name));
        fs::write(&model, moved(&plate, place.to_array()))?;
        // Outside, and inside.
        let rows = [DVec3::new(65.0, 3.0, 7.0), DVec3::new(20.0, 13.0, 0.5)].map(|row| row + place);
        let rows = rows.map(|row| format!("{},{},{}\n", row.x, row.y, row.z)).concat();
        fs::write(&queries, format!("qx,qy,qz\n{rows}"))?;
        let mut tool = Command::new(env!("CARGO_BIN_EXE_palpate"));
        tool.arg(command).args(options).arg(&model);
        if command == "closest" {
            tool.arg("--queries").arg(&queries);
        }
        let done = tool.arg("--out").arg(&out).output()?;
        assert!(done.status.code() < Some(2), "{}", String::from_utf8_lossy(&done.stderr));
        Ok(fs::read_to_string(out)?)
    };
    let mut rows = [DVec3::ZERO, offset].into_iter().map(|place| run("closest", place, &["--model"]));
    let (home, away) = (rows.next().ok_or("a run")??, rows.next().ok_or("a run")??);
    for (home, away) in home.lines().zip(away.lines()).skip(1) {
        let numbers = |row: &str| row.split(',').skip(3).take(4).map(str::parse).collect::<Result<Vec<f64>, _>>();
        let [home, away] = [numbers(home)?, numbers(away)?];
        for (axis, by) in [offset.x, offset.y, offset.z, 0.0].into_iter().enumerate() {
            // Nine digits of 3,000.
            assert!((away[axis] - home[axis] - by).abs() <= 5e-6 + 6e-5, "{home:?} {away:?}");
        }
    }
    for (place, centre) in [(DVec3::ZERO, DVec3::ZERO), (offset, 1e-3 * offset + DVec3::new(0.03, 0.02, 0.001))] {
        let source = run("bake", place, &[])?;
        let (_, said) = source.split_once("CENTRE: palpate::math::Vec3 = palpate::math::vec3(").ok_or("a centre")?;
        let said = said.split(')').next().unwrap_or_default().split(", ").map(str::parse);
        let said: [f64; 3] = said.collect::<Result<Vec<_>, _>>()?.try_into().map_err(|_| "three numbers")?;
        // To the grain that keeps it exact.
        assert!(DVec3::from_array(said).distance(centre) <= 0.005, "{said:?} is not near {centre}");
    }
    Ok(())
}

#[test]
fn a_refused_model_ends_with_2_names_its_file_and_writes_nothing() -> Result<(), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let (file, out) = (directory.path().join("spoiled.toml"), directory.path().join("out.rs"));
    let open = big().replacen("20.0]", "20.06]", 4);
    for (patches, status) in [
        (open.clone(), 0),
        // By its text, by a patch, by its seams.
        (open.replacen("degree = [1", "degree = [9", 1), 2),
        (open.replacen("points = [[[", "points = [[[1e300, ", 1), 2),
        (big().replacen("20.0]", "20.02]", 1), 2),
    ] {
        fs::write(&file, format!("unit = \"mm\"\n{patches}"))?;
        let run = Command::new(env!("CARGO_BIN_EXE_palpate")).arg("bake").arg(&file).arg("--out").arg(&out).output()?;
        let message = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(status), "{message}");
        assert!(message.contains("spoiled.toml"), "{message}");
        assert_eq!(fs::read_dir(&directory)?.count(), if status == 2 { 1 } else { 2 }, "{message}");
        if status == 0 {
            fs::remove_file(&out)?;
        }
    }
    Ok(())
}

#[test]
fn a_file_that_is_not_there_is_named_once() -> Result<(), Box<dyn Error>> {
    let run = Command::new(env!("CARGO_BIN_EXE_palpate")).args(["check", "nowhere.toml"]).output()?;
    let message = String::from_utf8_lossy(&run.stderr);
    assert_eq!(run.status.code(), Some(2));
    assert_eq!(message.matches("nowhere.toml").count(), 1, "{message}");
    Ok(())
}

#[test]
fn the_ending_of_the_output_says_what_bake_writes() -> Result<(), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let bake = |out: &str| {
        let mut bake = Command::new(env!("CARGO_BIN_EXE_palpate"));
        bake.args(["bake", "capped_box", "--out", out]).current_dir(&directory).output()
    };
    let run = bake("part.h")?;
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success() && said.contains("6 faces, 12 edges, "), "{said}");
    let text = fs::read_to_string(directory.path().join("part.h"))?;
    // A box has 6 faces and 12 edges; the array holds the file that is kept.
    assert!(text.contains("#define PART_FACES 6\n#define PART_EDGES 12\n"), "{text}");
    let (_, array) = text.split_once("= {").ok_or("no array")?;
    let bytes: Vec<u8> = array.split([',', '\n']).filter_map(|byte| byte.trim().parse().ok()).collect();
    assert!(bytes == fs::read(repository().join("boards/bodies/capped_box.palp"))?);
    assert!(text.contains("#define PART_TOP {0.030000f, 0.020000f, 0.033500f}"), "{text}");
    for out in ["part.txt", "part"] {
        let run = bake(out)?;
        let said = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.code() == Some(2) && said.contains(".rs for Rust source, .h for a C header"), "{said}");
        assert!(!directory.path().join(out).exists());
    }
    Ok(())
}

/// A frame of 60 x 40 x 4 mm around a hole from (10, 10) to (40, 30), whose widest side, 20 mm, is at the right.
fn frame() -> String {
    let around = |[x0, y0]: [f64; 2], [x1, y1]: [f64; 2]| [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
    let (outer, hole) = (around([0.0, 0.0], [60.0, 40.0]), around([10.0, 10.0], [40.0, 30.0]));
    let mut text = "unit = \"mm\"\n".to_owned();
    // The normal is (b − a) × (d − a).
    let mut quad = |a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]| {
        text += &format!("[[patch]]\ndegree = [1, 1]\npoints = [[{a:?}, {d:?}], [{b:?}, {c:?}]]\n");
    };
    let at = |[x, y]: [f64; 2], z: f64| [x, y, z];
    for (i, j) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
        let [a, b, c, d] = [outer[i], outer[j], hole[j], hole[i]];
        quad(at(a, 4.0), at(b, 4.0), at(c, 4.0), at(d, 4.0));
        quad(at(b, 0.0), at(a, 0.0), at(d, 0.0), at(c, 0.0));
        quad(at(a, 0.0), at(b, 0.0), at(b, 4.0), at(a, 4.0));
        quad(at(c, 0.0), at(d, 0.0), at(d, 4.0), at(c, 4.0));
    }
    text
}

#[test]
fn the_top_in_a_header_is_away_from_the_rim_of_a_hole() -> Result<(), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    fs::write(directory.path().join("frame.toml"), frame())?;
    let mut bake = Command::new(env!("CARGO_BIN_EXE_palpate"));
    let run = bake.args(["bake", "frame.toml", "--out", "frame.h"]).current_dir(&directory).output()?;
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = fs::read_to_string(directory.path().join("frame.h"))?;
    let (_, top) = text.split_once("FRAME_TOP {").ok_or("no top")?;
    let (top, _) = top.split_once('}').ok_or("no end")?;
    let top: Vec<f64> = top.split(", ").map(|number| number.trim_end_matches('f').parse()).collect::<Result<_, _>>()?;
    let [x, y, z] = top[..] else { panic!("{top:?}") };
    // No point is more than 10 mm from hole and border.
    let clear = (0.06 - x).min(x - 0.04).min(y).min(0.04 - y);
    assert!(clear > 8.5e-3 && z == 0.004, "{top:?}: {clear}");
    Ok(())
}
