//! Query files that are not right are refused with file and line; what is odd but right is taken.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn closest(queries: &str, options: &[&str]) -> Result<(Output, Option<String>), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let (input, output) = (directory.path().join("in.csv"), directory.path().join("out.csv"));
    fs::write(&input, queries)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_palpate"));
    command.arg("closest").arg("--queries").arg(input).arg("--out").arg(&output).args(options);
    if !options.contains(&"--model") {
        command.arg("--model").arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/table1c.toml"));
    }
    let run = command.output()?;
    Ok((run, fs::read_to_string(output).ok()))
}

#[test]
fn bad_query_files_are_refused_and_nothing_is_written() -> Result<(), Box<dyn Error>> {
    for (queries, expected) in [
        ("", "empty: a header"),
        ("1,2,3\n4,5,6\n", "no column qx in the header"),
        ("qx,qy\n1,2\n", "no column qz in the header"),
        ("qx,qy,qz,qx\n1,2,3,4\n", "column qx stands twice in the header"),
        ("qx;qy;qz\n1,5;2;3\n", "parted by semicolons; columns are parted by commas"),
        ("qx\tqy\tqz\n1\t2\t3\n", "parted by tabs"),
        ("QX,qy,qz\n1,2,3\n", "no column qx in the header, only QX"),
        ("qx,qy,qz\n1,2,3\n4,nan,6\n", "in.csv:3: qy is NaN"),
        ("qx,qy,qz\n1,2,inf\n", "in.csv:2: qz is inf"),
        ("qx,qy,qz\n1,2,three\n", "in.csv:2: qz is \"three\", not a number"),
        ("qx,qy,qz\n1,,3\n", "in.csv:2: qy is \"\", not a number"),
        ("qx,qy,qz\n1,2,3\n1,2\n", "line: 3"),
        ("qx,qy,qz\n1,2,1e30\n", "in.csv:2: qz is beyond"),
    ] {
        let (run, output) = closest(queries, &[])?;
        let message = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{queries:?}: {message}");
        assert!(message.contains(expected), "{queries:?} gave: {message}");
        assert!(output.is_none(), "{queries:?}");
    }
    Ok(())
}

#[test]
fn other_columns_comments_and_blanks_are_ignored() -> Result<(), Box<dyn Error>> {
    let (run, plain) = closest("qx,qy,qz\n1,2,30\n4,5,60\n", &[])?;
    assert_eq!(run.status.code(), Some(0));
    let (_, decorated) = closest("# probes\nname, qz, qy ,qx\r\nfirst,30,2,1\r\nsecond, 60.0,5,4\r\n", &[])?;
    assert!(plain.is_some());
    assert_eq!(plain, decorated);
    Ok(())
}

#[test]
fn a_header_alone_is_answered_with_a_header_alone() -> Result<(), Box<dyn Error>> {
    let (_, output) = closest("qx,qy,qz\n", &[])?;
    assert_eq!(output.as_deref(), Some("patch,u,v,px,py,pz,gap,steps,status,error_bound\n"));
    Ok(())
}

#[test]
fn rows_that_jump_are_located_anew() -> Result<(), Box<dyn Error>> {
    let queries = "qx,qy,qz\n10,10,60\n90,20,70\n15,85,65\n80,80,-40\n10,10,60\n";
    let gaps = |output: Option<String>| -> Result<Vec<f64>, Box<dyn Error>> {
        let output = output.ok_or("no output")?;
        output.lines().skip(1).map(|row| Ok(row.split(',').nth(6).ok_or("no gap")?.parse()?)).collect()
    };
    let (_, cold) = closest(queries, &[])?;
    let (run, tracked) = closest(queries, &["--mode", "track"])?;
    assert_eq!(run.status.code(), Some(0));
    for (cold, tracked) in gaps(cold)?.iter().zip(gaps(tracked)?) {
        // The same search; what differs is where its last point is evaluated.
        assert!((cold - tracked).abs() <= 1e-6 * cold.abs(), "{cold} cold, {tracked} tracked");
    }
    Ok(())
}

#[test]
fn a_query_beyond_the_locator_gets_a_wider_one_with_a_note_or_is_far() -> Result<(), Box<dyn Error>> {
    let queries = "qx,qy,qz\n5,5,8\n5,5,60\n";
    let statuses = |answers: &str| -> Vec<String> {
        answers.lines().skip(1).filter_map(|line| line.split(',').nth(8).map(str::to_owned)).collect()
    };
    let (run, widened) = closest(queries, &[])?;
    let (note, widened) = (String::from_utf8(run.stderr)?, widened.ok_or("no output")?);
    assert_eq!(statuses(&widened), ["converged", "converged"], "{widened}");
    assert!(note.contains("table1c.toml: 1 of 2 queries lie beyond the locator's default reach"), "{note}");
    let margin = note.trim().rsplit(' ').next().ok_or("no margin")?;
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("table1c.palp");
    for (margin, expected) in [("0", ["converged", "far"]), (margin, ["converged", "converged"])] {
        let mut bake = Command::new(env!("CARGO_BIN_EXE_palpate"));
        assert!(bake.args(["bake", "table1c", "--margin", margin, "--out"]).arg(&file).output()?.status.success());
        let (run, answers) = closest(queries, &["--model", &file.to_string_lossy()])?;
        let answers = answers.ok_or("no output")?;
        assert_eq!((statuses(&answers), run.stderr), (expected.map(str::to_owned).to_vec(), Vec::new()), "{answers}");
        assert_eq!(answers.lines().last() == widened.lines().last(), margin != "0", "{answers}{widened}");
    }
    let (_, output) = closest("qx,qy,qz\n5,5,8\n50,50,90000\n", &[])?;
    assert_eq!(statuses(&output.ok_or("no output")?), ["converged", "far"]);
    Ok(())
}
