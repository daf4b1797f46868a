//! `cargo test` with the time of each test, and the slowest of them at the end.

use crate::firmware::without_outer_cargo;
use anyhow::Context as _;
use std::env;
use std::ffi::OsString;
use std::io::{BufRead as _, BufReader, Write as _, stdout};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};

/// The subcommand that cargo starts each test program with.
pub const RUNNER: &str = "run-test";

/// Number of tests listed at the end.
const LISTED: usize = 15;

/// Seconds of each test so far, with its name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times(Vec<(f64, String)>);

impl Times {
    /// Runs `cargo test` and passes its output on; `tool` is this program or a copy of it.
    ///
    /// # Errors
    /// If cargo does not start, or its output cannot be passed on.
    pub fn cargo_test(&mut self, tool: &Path, arguments: impl FnOnce(&mut Command)) -> anyhow::Result<ExitStatus> {
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        let runner = [tool.to_str().context("the tool's path is not UTF-8")?, RUNNER].map(toml::Value::from);
        let runner = toml::Value::from(runner.to_vec());
        without_outer_cargo(&mut cargo).arg("test").arg("--config").arg(format!("target.'cfg(all())'.runner={runner}"));
        arguments(&mut cargo);
        let mut running = cargo.stdout(Stdio::piped()).spawn().with_context(|| format!("{cargo:?}"))?;
        let mut lines = BufReader::new(running.stdout.take().context("cargo has no output")?);
        let mut line = Vec::new();
        while lines.read_until(b'\n', &mut line)? > 0 {
            stdout().write_all(&line)?;
            self.0.extend(time(&String::from_utf8_lossy(&line)));
            line.clear();
        }
        Ok(running.wait()?)
    }

    /// The slowest tests, a line each.
    pub fn slowest(&self) -> String {
        let mut all = self.0.clone();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.truncate(LISTED);
        all.iter().map(|(seconds, name)| format!("{seconds:9.1} s  {name}\n")).collect()
    }
}

/// Seconds and name in a line such as `test module::name ... ok <1.234s>`.
fn time(line: &str) -> Option<(f64, String)> {
    let (name, rest) = line.trim_end().strip_prefix("test ")?.split_once(" ... ")?;
    let (_, seconds) = rest.strip_suffix("s>")?.rsplit_once('<')?;
    Some((seconds.parse().ok()?, name.to_owned()))
}

/// Runs a program for cargo; a test program reports the time of each test. Gives its exit status.
///
/// # Errors
/// If it does not start.
pub fn run_test(program: &OsString, arguments: &[OsString]) -> anyhow::Result<ExitStatus> {
    let mut command = Command::new(program);
    command.args(arguments);
    // Not the programs of doctests, which lie elsewhere and take other arguments.
    if Path::new(program).parent().is_some_and(|folder| folder.ends_with("deps")) {
        // Times are an unstable option of the test harness, which a stable one accepts if this variable is set.
        command.env("RUSTC_BOOTSTRAP", "1").args(["-Zunstable-options", "--report-time"]);
    }
    command.status().with_context(|| format!("{command:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slowest_tests_are_listed_first() {
        let lines = "test a ... ok <0.100s>\ntest b::c ... FAILED <12.000s>\ntest d ... ignored\nrunning 3 tests\n";
        let times = Times(lines.lines().filter_map(time).collect());
        assert_eq!(times.slowest(), "     12.0 s  b::c\n      0.1 s  a\n");
    }
}
