//! `talk`, with a simulated device: lines in, sentences out.

use std::collections::BTreeSet;
use std::io::Write as _;
use std::process::{Command, Stdio};

/// The exit status, what is printed, and what is complained of.
fn talk(arguments: &[&str], lines: &str) -> (Option<i32>, String, String) {
    let mut run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .arg("talk")
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    // One that refuses its options reads nothing.
    let _ = run.stdin.take().expect("a pipe").write_all(lines.as_bytes());
    let run = run.wait_with_output().expect("it ends");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (run.status.code(), text(&run.stdout), text(&run.stderr))
}

#[test]
fn a_session_is_done_line_by_line() {
    let session = "# two boxes\n\nwho\nwait 0.5\nwhere\nplace 0 0 0 -10\nwait 0.1\nwhere\nturn 0 0 0 1 5\n\
                   place 0 0 0 0 0 0 1 0\nmove 1 0 0 -10 0.2\nspin 1 0 0 10 0.1\nharden 0 300 1\n\
                   rub 0 800 1 0.6 0.4\nrub 0 off\ntip 1\nlimit 4\nupload 1 capped_box\npush 0 0 1\nwait 0.4\nwhere\n\
                   push 0 0 0\nwatch 0.25\nswitch none\nswitch all\nchoose 0\nstop\nwhere\nquit\nnot read any more\n";
    let (status, said, complained) = talk(&["--host"], session);
    println!("{said}{complained}");
    assert_eq!(status, Some(0), "{complained}");
    let views: Vec<_> = said.lines().filter(|line| line.starts_with("at ")).collect();
    let gap = |view: &str| -> f64 {
        let rest = view.split("gap ").nth(1).and_then(|rest| rest.split(' ').next());
        rest.and_then(|gap| gap.parse().ok()).expect("a gap")
    };
    assert!(views[0].ends_with("running"), "{}", views[0]);
    // A body 10 mm lower, less what the tip swings.
    assert!((gap(views[1]) - gap(views[0]) - 10.0).abs() < 0.5, "{} {}", views[0], views[1]);
    assert!(views[2].contains("force 0.00 0.00 1.00 N"), "{}", views[2]);
    // Ten times a second for a quarter of one.
    assert_eq!(views.len(), 3 + 3 + 1);
    assert!(views[6].ends_with("stopped: stopped by hand"), "{}", views[6]);
    assert!(said.contains("4532 of 4532 bytes") && said.contains("its origin is at 0.000 0.000 0.000 mm of the model"));
    // All but who, where, wait, watch and quit.
    assert_eq!(said.lines().filter(|line| *line == "done").count(), 17);
}

#[test]
fn a_line_that_is_refused_or_not_understood_ends_a_file_with_a_sentence() {
    for (line, sentence) in [
        ("place 5 0 0 0", "place was refused by the device: there is no body 5"),
        ("limit 9", "limit was refused by the device: a force must be finite and at most the scene's maximum"),
        (
            "harden 1 1e4 1",
            "harden was refused by the device: body 1: the stiffness must be between 0 and 600 N/m, effects included",
        ),
        (
            "harden 1 400 9",
            "harden was refused by the device: body 1: the damping must be between 0 and 8 N·s/m, effects included",
        ),
        ("turn 1 0 0 1 90", "the place of body 1 is unknown; place it first"),
        ("jump", "unknown command \"jump\"; `help` lists all"),
        ("place 1 0 0", "place BODY X Y Z [AX AY AZ DEGREES]: Z is missing"),
        (
            "upload 0 capped_box",
            "body 0 cannot be replaced: no memory for another is built in with it; upload to another body",
        ),
        ("upload 1 no-such.palp", "no-such.palp: No such file or directory (os error 2)"),
    ] {
        let (status, said, complained) = talk(&["--host"], &format!("{line}\nwho\n"));
        assert_eq!(
            (status, complained.trim()),
            (Some(2), &*format!("error: {sentence}: line 1, \"{line}\"")),
            "{line}"
        );
        assert_eq!(said.matches("a device of 4000 Hz").count(), 1, "{line}: {said}");
    }
}

#[test]
fn a_knob_says_what_became_of_its_feel() {
    let arguments = ["--device", "knob", "--host"];
    let (status, said, complained) = talk(&arguments, "free\nwait 0.2\nkeep-feel\nforget-feel\n");
    assert!(said.starts_with("a knob of 4000 Hz;"), "{said}");
    let outcome = "done\nthe simulated hand has released the button, and holds it to confirm\n\
                   kept: the knob starts with this feel from the next reset on\n\
                   the simulated hand has released the button, and holds it to confirm\n\
                   cleared: it starts with its table from the next reset on\n";
    assert_eq!((status, said.contains(outcome)), (Some(0), true), "{said}{complained}");
    // A reset starts with what was kept: spring and damping have no detents, the table's first feel has 30 mN·m.
    // It is aligned as the help says.
    let (_, help, _) = talk(&arguments, "help\n");
    let aligns = help.lines().find(|line| line.starts_with("reset ")).expect("reset");
    let aligns: String = aligns.split('`').skip(1).step_by(2).map(|line| format!("{line}\n")).collect();
    let lines = format!("free\ndamping 1\nkeep-feel\nreset\ndial 0\n{aligns}wait 0.5\nwhere\n");
    let (status, said, complained) = talk(&arguments, &lines);
    let last = said.lines().last().unwrap_or_default();
    assert!(said.contains("; the kept feel was used; calibrating"), "{said}{complained}");
    assert!(status == Some(0) && last.contains("; feel 6; the kept feel was used; running"), "{said}{complained}");
    let (status, _, complained) = talk(&["--host"], "reset\n");
    assert!(status == Some(2) && complained.contains("only the simulated knob is reset from here"), "{complained}");
    // The hand turns the dial on, which has no torque.
    let (_, said, complained) = talk(&arguments, "stop\nwait 0.1\ndial 0.6\n");
    let turns: Vec<_> = said.lines().filter(|line| line.starts_with("dial at")).collect();
    let angles: BTreeSet<_> = turns.iter().map(|line| line.split(' ').nth(2)).collect();
    let is_stopped = |line: &&str| line.contains(" 0.0 mN·m;") && line.ends_with("; stopped: stopped by hand");
    assert!(turns.len() > 3 && angles.len() > 3 && turns.iter().all(is_stopped), "{said}{complained}");
    // Its place is an angle, everywhere.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    let (_, said, complained) =
        talk(&[&arguments[..], &["--log", path.to_str().unwrap()]].concat(), "free\nwait 1\nwhere\n");
    let said = said.lines().find(|line| line.ends_with("; running")).unwrap_or_else(|| panic!("{said}{complained}"));
    let now: f64 = said.split(' ').nth(2).unwrap().parse().unwrap();
    let mut log = csv::Reader::from_path(path).unwrap();
    let angle = log.headers().unwrap().iter().position(|name| name == "angle_degrees").unwrap();
    let angles: Vec<f64> = log.into_records().map(|row| row.unwrap()[angle].parse().unwrap()).collect();
    let last = angles.last().unwrap();
    assert!(angles.len() > 90 && (last - now).abs() < 5.0 && last.abs() > 5.0, "{said}: {angles:?}");
    for (lines, says) in [
        ("choose 9\n", "choose was refused by the device: there is no feel 9: choose 0 to 5"),
        ("keep-feel\n", "keep-feel was refused by the device: no feel was set since the last reset; set one first"),
        (
            "spring 17 31.25 0\n",
            "spring was refused by the device: with it the feel has up to 61.25 mN·m, and the device's limit is 56.00 mN·m \
             (max_force_n): weaken it or another part, or take one away",
        ),
    ] {
        let (status, _, complained) = talk(&arguments, lines);
        assert!(status == Some(2) && complained.contains(says), "{complained}");
    }
}

#[test]
fn a_log_of_a_device_in_this_program_has_each_row() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    let (_, said, complained) = talk(&["--host", "--log", path.to_str().unwrap()], "wait 1\n");
    assert!(said.trim_end().ends_with(" rows at 1000 Hz, 0 missing"), "{said}{complained}");
}

#[test]
fn a_device_has_to_be_somewhere() {
    assert_eq!(talk(&[], "").2.trim(), "error: either --port, --emulator or --host");
    let (status, _, complained) = talk(&["--port", "/dev/no-such-port"], "");
    assert_eq!(status, Some(2));
    assert!(complained.starts_with("error: cannot open the serial port /dev/no-such-port: "), "{complained}");
}

#[test]
fn help_lists_every_command() {
    let (status, said, _) = talk(&["--host"], "help\n");
    assert_eq!(status, Some(0));
    for word in ["who", "where", "watch", "push", "place", "turn", "move", "spin", "switch", "choose", "harden", "rub"]
    {
        assert!(said.lines().any(|line| line.starts_with(word)), "{word}: {said}");
    }
}
