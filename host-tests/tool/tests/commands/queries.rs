//! Query files that are not right are refused with file and line; what is odd but right is taken.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn closest(queries: &str, options: &[&str]) -> Result<(Output, Option<String>), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let (input, output) = (directory.path().join("in.csv"), directory.path().join("out.csv"));
    fs::write(&input, queries)?;
    let run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(["closest", "--model"])
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/table1c.toml"))
        .arg("--queries")
        .arg(input)
        .arg("--out")
        .arg(&output)
        .args(options)
        .output()?;
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
fn a_query_beyond_the_locator_is_said_to_be_far() -> Result<(), Box<dyn Error>> {
    let (_, output) = closest("qx,qy,qz\n50,50,90\n50,50,90000\n", &[])?;
    let answers = output.ok_or("no output")?;
    let statuses: Vec<&str> = answers.lines().filter_map(|line| line.split(',').nth(8)).collect();
    assert_eq!(statuses, ["status", "converged", "far"], "{answers}");
    Ok(())
}
