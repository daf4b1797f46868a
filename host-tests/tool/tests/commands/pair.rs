//! `palpate pair`: rows in the model's unit, and bad input by file, row and entry.

use std::error::Error;
use std::fs;
use std::process::{Command, Output};

const HEADER: &str = "qw,qx,qy,qz,px,py,pz\n";

fn pair(tool: &str, poses: &str, options: &[&str]) -> Result<(Output, Option<String>), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let (input, output) = (directory.path().join("in.csv"), directory.path().join("out.csv"));
    fs::write(&input, poses)?;
    let run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(["pair", "--model", "capped_box", "--tool", tool, "--poses"])
        .arg(input)
        .arg("--out")
        .arg(&output)
        .args(options)
        .output()?;
    Ok((run, fs::read_to_string(output).ok()))
}

/// The box is 60 mm by 40 mm over z = 0. A segment of 2 × 8 mm stands under it, then lies, then a box turned about z.
#[test]
fn rows_are_in_the_unit_of_the_model() -> Result<(), Box<dyn Error>> {
    let poses = format!("{HEADER}1,0,0,0,30,20,-12\n0.7071067811865476,0,0.7071067811865475,0,30,20,-12\n");
    for mode in ["cold", "track"] {
        let (run, output) = pair("segment:8", &poses, &["--radius", "1.5", "--mode", mode])?;
        assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
        let output = output.ok_or("no output")?;
        let mut rows = output.lines();
        assert_eq!(rows.next(), Some("distance,bx,by,bz,tx,ty,tz,steps,status"));
        for (row, (distance, reach)) in rows.zip([(2.5, Some(8.0)), (10.5, None)]) {
            let fields: Vec<_> = row.split(',').collect();
            let number = |index: usize| fields[index].parse::<f64>();
            // 2e-6 of 60 mm.
            assert!((number(0)? - distance).abs() < 1.2e-4, "{mode}: {row}");
            assert!(
                number(3)?.abs() < 1e-4
                    && reach.is_none_or(|z| (fields[6].parse::<f64>().unwrap_or(0.0) - z).abs() < 1e-4)
            );
        }
    }
    Ok(())
}

#[test]
fn bad_input_is_refused_and_nothing_is_written() -> Result<(), Box<dyn Error>> {
    let row = |row: &str| format!("{HEADER}1,0,0,0,0,0,-9\n{row}\n");
    for (tool, poses, options, expected) in [
        ("point", "qw,qx,qy,qz,px,py\n".to_owned(), &[][..], "no column pz"),
        ("point", row("1,0,0,0,0,nan,0"), &[], "in.csv:3: py is NaN"),
        ("point", row("1,0,0,0,0,0,low"), &[], "in.csv:3: pz is \"low\", not a number"),
        ("point", row("0.5,0,0,0,0,0,0"), &[], "in.csv:3: qw, qx, qy, qz has length 0.5, not 1"),
        ("point", row("2,0,0,0,0,0,0"), &[], "in.csv:3: qw is beyond"),
        ("segment:-1", row("1,0,0,0,0,0,0"), &[], "segment:-1: a half length is -1"),
        ("segment:1,2", row("1,0,0,0,0,0,0"), &[], "give segment:H"),
        ("box:1,2", row("1,0,0,0,0,0,0"), &[], "give box:X,Y,Z"),
        ("box:1,2,x", row("1,0,0,0,0,0,0"), &[], "\"x\" is not a number"),
        ("point", row("1,0,0,0,0,0,0"), &["--radius", "-1"], "--radius -1: radius: must be 0 to 1e6 m"),
        ("segment:1e30", row("1,0,0,0,0,0,0"), &[], "segment:1e30 --radius 0: half: half lengths must be 0 to 1e6 m"),
        ("no-such-tool", row("1,0,0,0,0,0,0"), &[], "give point, segment:H, box:X,Y,Z, or a convex body's model"),
    ] {
        let (run, output) = pair(tool, &poses, options)?;
        let message = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{tool} {poses:?}: {message}");
        assert!(message.contains(expected), "{tool} {poses:?} gave: {message}");
        assert!(output.is_none(), "{tool} {poses:?}");
    }
    Ok(())
}
