//! A host that speaks with an emulated board, by the command that speaks with a real one.

use crate::running::is_wanted;
use std::io::Write as _;
use std::process::{Command, Stdio};

const SESSION: &str = "wait 0.5\nwhere\nplace 0 0 0 -10\nwait 0.1\nwhere\nlimit 2\nupload 1 capped_box\npush 0 0 1\n\
                       wait 0.3\nwhere\nstop\nwhere\n";

#[test]
fn a_host_places_pushes_uploads_and_stops_an_emulated_board() {
    if !is_wanted("a_host_places_pushes_uploads_and_stops_an_emulated_board") {
        return;
    }
    let mut run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(["talk", "--emulator", "m4"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("it starts");
    run.stdin.take().expect("a pipe").write_all(SESSION.as_bytes()).expect("it reads");
    let run = run.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&run.stdout);
    println!("{said}");
    assert!(run.status.success());
    let views: Vec<_> = said.lines().filter(|line| line.starts_with("at ")).collect();
    let [before, after, pushed, stopped] = views[..] else { panic!("four views") };
    let gap = |view: &str| -> f64 {
        let rest = view.split("gap ").nth(1).and_then(|rest| rest.split(' ').next());
        rest.and_then(|gap| gap.parse().ok()).expect("a gap")
    };
    // A body 10 mm lower, less what the tip swings.
    assert!(before.ends_with("running") && (gap(after) - gap(before) - 10.0).abs() < 0.5, "{before}\n{after}");
    assert!(said.contains("4532 of 4532 bytes"));
    assert!(pushed.contains("force 0.00 0.00 1.00 N"), "{pushed}");
    assert!(stopped.ends_with("stopped: stopped by hand"), "{stopped}");
}
