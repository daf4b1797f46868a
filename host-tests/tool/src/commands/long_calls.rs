//! Cargo without a compiler's warning that our own settings cause: the Nucleo's code calls from one memory into another
//! by registers, a feature of the code generator that rustc has no name for and warns of in each crate.

use std::io::{self, BufRead, BufReader, Write};
use std::process::{Command, ExitStatus, Stdio};

/// Runs cargo and passes on all that it reports but this warning and cargo's counts of warnings.
///
/// # Errors
/// If the command does not start, or standard error cannot be written.
pub fn build(command: &mut Command) -> io::Result<ExitStatus> {
    let mut child = command.stderr(Stdio::piped()).spawn()?;
    if let Some(reported) = child.stderr.take() {
        pass_on(BufReader::new(reported), io::stderr())?;
    }
    child.wait()
}

fn pass_on(reported: impl BufRead, mut out: impl Write) -> io::Result<()> {
    let mut is_skipped = false;
    for line in reported.split(b'\n') {
        let line = line?;
        let text = String::from_utf8_lossy(&line);
        // A warning ends with an empty line.
        let was_skipped = is_skipped;
        is_skipped = if is_skipped { !text.trim().is_empty() } else { is_ours(&text) };
        if !was_skipped && !is_skipped && !is_count(&text) {
            out.write_all(&line)?;
            out.write_all(b"\n")?;
        }
    }
    Ok(())
}

fn is_ours(line: &str) -> bool {
    line.contains("unknown and unstable feature") && line.contains("long-calls")
}

/// `palpate` (lib) generated 1 warning
fn is_count(line: &str) -> bool {
    line.starts_with("warning: `") && line.contains(") generated ") && line.contains(" warning")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_warning_of_our_own_settings_is_left_out() {
        let reported = "   Compiling palpate v0.1.0\n\
            warning: unknown and unstable feature specified for `-Ctarget-feature`: `long-calls`\n  |\n  = note: passed\n\n\
            warning: unused variable: `x`\n --> src/main.rs:2:9\n\n\
            warning: `palpate` (lib) generated 2 warnings\n    Finished\n";
        let mut out = Vec::new();
        pass_on(reported.as_bytes(), &mut out).expect("a buffer");
        let expected =
            "   Compiling palpate v0.1.0\nwarning: unused variable: `x`\n --> src/main.rs:2:9\n\n    Finished\n";
        assert_eq!(String::from_utf8_lossy(&out), expected);
    }
}
