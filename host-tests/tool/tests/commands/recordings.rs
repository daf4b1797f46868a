//! Recordings of `sim`: what a hand got, and which device it had in it.

use std::error::Error;
use std::path::Path;
use std::process::{Command, Output};

fn palpate(arguments: &[&str]) -> Result<Output, Box<dyn Error>> {
    Ok(Command::new(env!("CARGO_BIN_EXE_palpate")).args(arguments).output()?)
}

/// Records five seconds on a device, with further options.
fn record(device: &str, options: &[&str], csv: &Path) -> Result<(), Box<dyn Error>> {
    let csv = csv.to_str().unwrap_or_default();
    let run = palpate(&[&["sim", "--device", device, "--csv", csv], options].concat())?;
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    Ok(())
}

/// The largest step of the force between two rows, N.
fn largest_step(csv: &Path) -> Result<f64, Box<dyn Error>> {
    let mut reader = csv::Reader::from_path(csv)?;
    let columns = ["force_x", "force_y", "force_z"];
    let headers = reader.headers()?.clone();
    let at = columns.map(|name| headers.iter().position(|header| header == name).expect("the column"));
    let (mut last, mut largest) = (None, 0.0_f64);
    for row in reader.records() {
        let row = row?;
        let force = at.map(|column| row[column].parse::<f64>().expect("a number"));
        let step = last.map_or(0.0, |last: [f64; 3]| {
            force.iter().zip(last).map(|(now, before)| (now - before).powi(2)).sum::<f64>().sqrt()
        });
        (last, largest) = (Some(force), largest.max(step));
    }
    Ok(largest)
}

/// 200 N/s are 50 mN a tick at 4 kHz.
#[test]
fn a_run_is_as_smooth_as_is_recommended_unless_it_is_to_be_plain() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let csv = folder.path().join("run.csv");
    for device in ["woodenhaptics-2016", "falcon"] {
        record(device, &[], &csv)?;
        let smooth = largest_step(&csv)?;
        record(device, &["--rendering", "plain"], &csv)?;
        let plain = largest_step(&csv)?;
        println!("{device}: largest step {:.1} mN, plain {:.1} mN", smooth * 1e3, plain * 1e3);
        assert!(smooth < 0.0501 && plain > 0.1, "{device}: {smooth} N, plain {plain} N");
    }
    Ok(())
}

/// The polarity pulses of a protected run are 2 N on a Falcon.
#[test]
fn the_pulses_of_the_polarity_check_are_no_steps_of_the_surface() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let csv = folder.path().join("run.csv");
    record("falcon", &["--protected"], &csv)?;
    let pulse = largest_step(&csv)?;
    let feel = palpate(&["feel", "--device", "falcon", "--recording", csv.to_str().unwrap_or_default()])?;
    let table = String::from_utf8(feel.stdout)?;
    let figure = |name: &str| -> Option<f64> {
        let (_, figure) = table.lines().find_map(|line| line.split_once(name))?;
        figure.split_whitespace().next()?.parse().ok()
    };
    let (step, ripple) = (figure("largest step  "), figure("ripple in the longest touch"));
    println!("largest step {step:?} mN, of a pulse {:.1} mN; ripple {ripple:?} mN", 1e3 * pulse);
    assert!(pulse > 1.0 && step.is_some_and(|step| (1.0..50.1).contains(&step)), "{table}");
    assert!(ripple.is_some_and(|ripple| ripple < 500.0), "{table}");
    Ok(())
}

#[test]
fn a_recording_of_another_device_is_refused() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let csv = folder.path().join("run.csv");
    record("falcon", &[], &csv)?;
    let feel = |device| palpate(&["feel", "--device", device, "--recording", csv.to_str().unwrap_or_default()]);
    let refused = feel("polhem-v2")?;
    let message = String::from_utf8(refused.stderr)?;
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(message.contains("recorded with falcon, not with polhem-v2"), "{message}");
    let taken = feel("falcon")?;
    assert!(taken.status.success() && String::from_utf8(taken.stdout)?.contains("capped_box"));

    // Spoiled: a row of another device, of another model, and of none.
    let text = std::fs::read_to_string(&csv)?;
    let last = text.trim_end().rfind('\n').expect("rows") + 1;
    let (before, row) = text.split_at(last);
    for (from, to, message) in [
        ("falcon", "polhem-v2", "is of \"polhem-v2\", the rows before it of \"falcon\"; record one device"),
        ("capped_box", "sphere", "is of \"sphere.toml\", the rows before it of \"capped_box.toml\"; record one device"),
        ("falcon", "", "is of \"\", the rows before it of \"falcon\"; record one device"),
    ] {
        assert!(row.contains(from), "{row}");
        std::fs::write(&csv, format!("{before}{}", row.replace(from, to)))?;
        let refused = feel("falcon")?;
        let said = String::from_utf8(refused.stderr)?;
        assert!(refused.status.code() == Some(2) && said.contains(message), "{to}: {said}");
    }
    Ok(())
}

/// A wall of half a newton holds no hand of this stiffness: it is pushed 10 mm in, the limit.
#[test]
fn a_contact_that_was_released_is_printed_beside_the_faults() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let report = folder.path().join("demo.html");
    let report_path = report.to_str().unwrap_or_default();
    for (arguments, is_lost) in [
        (&["sim", "--max-force", "0.5"][..], true),
        (&["sim"], false),
        (&["demo", "--host", "--max-force", "0.5", "--report", report_path], true),
    ] {
        let said = String::from_utf8(palpate(arguments)?.stdout)?;
        let mut lines = said.lines().skip_while(|line| !line.contains("  faults  ")).skip(1);
        let row = "  contacts lost        1, too deep: released at the contact limit";
        assert_eq!(lines.next().is_some_and(|line| line.starts_with(row)), is_lost, "{said}");
        assert_eq!(said.contains("contacts lost"), is_lost, "{said}");
    }
    assert!(std::fs::read_to_string(&report)?.contains("contacts lost"));
    Ok(())
}
