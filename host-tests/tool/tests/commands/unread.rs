//! Output whose reader is gone, as in `palpate zwidth | head`.

use std::fs::File;
use std::io::{self, Seek as _, Write as _};
use std::process::{Command, Stdio};

/// The exit status and standard error of a command that writes to `output`, with a session for `talk` at its input.
fn run(arguments: &[&str], output: impl Into<Stdio>) -> io::Result<(Option<i32>, String)> {
    let folder = tempfile::tempdir()?;
    let mut session = tempfile::tempfile()?;
    session.write_all(b"who\nwhere\nquit\n")?;
    session.rewind()?;
    let run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(arguments)
        .current_dir(&folder)
        .stdin(session)
        .stdout(output)
        .stderr(Stdio::piped())
        .spawn()?
        .wait_with_output()?;
    Ok((run.status.code(), String::from_utf8_lossy(&run.stderr).into_owned()))
}

#[test]
fn a_command_whose_reader_is_gone_ends_without_a_message() -> io::Result<()> {
    let zwidth = ["zwidth", "--device", "hapkit", "--rate", "1000"];
    for (arguments, status) in [
        // By `println!`: it ends there.
        (&zwidth[..], 141),
        (&["sim", "--seconds", "0.1"], 141),
        // By a writer of its own.
        (&["talk", "--host"], 141),
        // At once, and its verdict follows.
        (&["check", "capped_box"], 0),
    ] {
        let (reader, writer) = io::pipe()?;
        drop(reader);
        assert_eq!(run(arguments, writer)?, (Some(status), String::new()), "{arguments:?}");
    }
    // No other failure is hidden.
    let (status, message) = run(&zwidth, File::options().write(true).open("/dev/full")?)?;
    assert!(
        status == Some(101) && message.contains("failed printing to stdout: No space left"),
        "{status:?} {message}"
    );
    Ok(())
}
