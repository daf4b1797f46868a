//! `commission --jog` of a simulated arm: the joint on the motor's output moves, and the other joints are held.

use std::process::{Command, Stdio};

/// The lines of a jog of output 0 that tell what moved, and why it ended: of at most some seconds of this machine's, which
/// may be busy.
fn jog(duty: &str, seconds: &str, planted: &[&str]) -> std::io::Result<Vec<String>> {
    let run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(["commission", "--host", "--jog", "0", "--for", seconds, "--duty", duty])
        .args(planted.iter().flat_map(|fault| ["--plant", *fault]))
        .output()?;
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let said = String::from_utf8_lossy(&run.stdout).into_owned();
    Ok(said.lines().skip_while(|line| !line.starts_with("output")).map(str::to_owned).collect())
}

#[test]
fn a_jog_moves_the_joint_on_its_output_until_a_limit_and_prints_how_far() -> std::io::Result<()> {
    for (duty, planted, moved) in [
        // In the shipped file only the encoder of joint a runs backwards.
        ("0.05", &[][..], "input 0 moved by -"),
        ("-0.05", &[], "input 0 moved by +"),
        ("0.05", &["motor-sign:0"], "input 0 moved by +"),
        ("0.05", &["encoder-sign:0"], "input 0 moved by +"),
        ("0.05", &["encoders:0-1"], "input 1 moved by -"),
        ("0.1", &["motors:0-2"], "input 2 moved by +"),
    ] {
        let lines = jog(duty, "300", planted)?;
        let [sentence, end] = &lines[..] else { panic!("{planted:?}: {lines:?}") };
        assert!(sentence.starts_with(&format!("output 0 at duty {duty}: {moved}")), "{planted:?}: {sentence}");
        // The other two are held.
        assert_eq!(sentence.matches("moved by").count(), 1, "{sentence}");
        assert!(end.starts_with("stopped by the device: moved too"), "{end}");
    }
    // The arm is carried: joint b does not fall.
    let lines = jog("0.0005", "3", &["motors:0-1"])?;
    assert!(matches!(&lines[..], [line] if line.contains("no input moved; raise --duty")), "{lines:?}");
    Ok(())
}

#[test]
fn masses_that_no_weighing_explains_are_not_written_and_end_with_a_status() -> std::io::Result<()> {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("found.toml");
    let run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(["commission", "--host", "--weigh", "--keep", "--plant", "weight:0", "--out"])
        .arg(&out)
        .output()?;
    let [said, errors] = [run.stdout, run.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert_eq!(run.status.code(), Some(1), "{said} {errors}");
    assert!(errors.starts_with("error: the file's masses do not explain"), "{errors}");
    assert!(said.contains("weights differ") && said.contains("nothing is saved in the device's flash"), "{said}");
    let [file, shipped] = [
        std::fs::read_to_string(&out)?,
        palpate_sim::devices::named("woodenhaptics-2016").and_then(|device| device.file()).map_or_else(
            String::new,
            |file| {
                let palpate_sim::devices::MechanismEntry::SerialArm { end_masses, .. } = file.mechanism else {
                    panic!()
                };
                format!("end_masses = [{}, {}]", end_masses[0], end_masses[1])
            },
        ),
    ];
    assert!(file.contains(&shipped), "{shipped}: {file}");
    Ok(())
}

#[test]
fn a_script_may_watch_a_device_and_not_jog_it() -> std::io::Result<()> {
    for (what, message) in [(["--watch", "1"], "no-such-port"), (["--jog", "0"], "standard input is no terminal")] {
        let run = Command::new(env!("CARGO_BIN_EXE_palpate"))
            .args(["commission", "--port", "no-such-port"])
            .args(what)
            .stdin(Stdio::null())
            .output()?;
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(run.status.code() == Some(2) && said.contains(message), "{what:?}: {said}");
    }
    Ok(())
}
