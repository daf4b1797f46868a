//! `palpate test`: sets up what it needs and runs every test, or those for every day.

use crate::firmware::{self, Board, Choice, Progress, Transport, WITH_FIRMWARE};
use crate::in_c::{self, WITH_C};
use crate::in_python;
use crate::own_copy::OwnCopy;
use crate::page;
use crate::repository;
use crate::timed_tests::{self, Times};
use anyhow::Context;
use clap::{Args, ValueEnum};
use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, ExitCode};

/// The arguments of `cargo test` for `--quick`, one a line. `.ci/quick` reads the same file.
const QUICK: &str = include_str!("../../../../.ci/quick.tests");

/// Runs every test: host, emulator, drift and budgets. Installs missing tools and lists them.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Only the everyday tests, in a few minutes: no long ones, no emulator.
    #[arg(long, conflicts_with = "without_emulator")]
    quick: bool,
    /// Skip the emulator: the tests of plain `cargo test`.
    #[arg(long)]
    without_emulator: bool,
    /// Suites to skip, for a CI with separate lanes for them.
    #[arg(long, value_enum, value_delimiter = ',', value_name = "SUITES")]
    without: Vec<Suite>,
    /// Only the page for the browser, in headless Chromium: installs the browser, its code and the emulator.
    #[arg(long, conflicts_with_all = ["quick", "without_emulator"])]
    page: bool,
    /// Only the C library: installs a C compiler for the boards, and the emulator.
    #[arg(long, conflicts_with_all = ["quick", "without_emulator", "page"])]
    c: bool,
    /// Only the Python wheel: installs its tools in virtual environments in `target/python`.
    #[arg(long, conflicts_with_all = ["quick", "without_emulator", "page", "c"])]
    python: bool,
    /// Arguments for `cargo test`, or with `--python` for pytest.
    #[arg(last = true)]
    cargo_test: Vec<String>,
}

/// A suite that is apart, which `cargo palpate test` runs where its tools are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Suite {
    /// The C library.
    C,
    /// The page for the browser.
    Page,
    /// The wheel for Python.
    Python,
}

/// Runs a program for `cargo test`, with the time of each test.
#[derive(Args, Debug)]
pub struct RunTestArguments {
    program: OsString,
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

/// Runs a test program, as `cargo palpate test` asks cargo to.
///
/// # Errors
/// If it does not start.
pub fn run_test(arguments: &RunTestArguments) -> anyhow::Result<ExitCode> {
    let status = timed_tests::run_test(&arguments.program, &arguments.arguments)?;
    if status.code().is_none() {
        eprintln!("{}: {status}", arguments.program.display());
    }
    Ok(status.code().map_or(ExitCode::FAILURE, |code| ExitCode::from(code as u8)))
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    if arguments.python {
        return in_python::test(&arguments.cargo_test);
    }
    let progress = Progress::new();
    let tool = OwnCopy::new()?;
    let mut times = Times::default();
    let outcome = if arguments.page {
        let browser = page::Browser::set_up(&progress).context("the tests of the page cannot run")?;
        on_page(&browser, tool.path(), &mut times, &arguments.cargo_test)
    } else {
        suites(arguments, tool.path(), &mut times, &progress)
    };
    let slowest = times.slowest();
    if !slowest.is_empty() {
        println!("\nthe slowest tests:\n{slowest}");
    }
    outcome
}

/// Everything but the page or the wheel alone.
fn suites(arguments: &Arguments, tool: &Path, times: &mut Times, progress: &Progress) -> anyhow::Result<ExitCode> {
    let root = repository::root()?;
    let is_asked_for = |suite: Suite| !arguments.without.contains(&suite);
    let with_c = !arguments.without_emulator && !arguments.quick && is_asked_for(Suite::C) && in_c::has_compiler();
    let with_firmware = !arguments.without_emulator && !arguments.quick && !arguments.c;
    if arguments.c {
        progress.say(&in_c::set_up(progress)?);
    } else if !with_c && !arguments.quick && is_asked_for(Suite::C) {
        progress.say("left out: the C library; `cargo palpate test --c` sets up what it needs");
    }
    if with_firmware {
        for board in firmware::compared() {
            set_up(board, progress)
                .context("the tests on the emulated boards cannot run (--without-emulator leaves them out)")?;
        }
    }
    let status = times.cargo_test(tool, |cargo| {
        cargo.current_dir(root).env_remove(WITH_FIRMWARE).env_remove(WITH_C);
        if arguments.c {
            cargo.args(["-p", "palpate-tool", "--test", "c"]);
        } else if arguments.quick {
            cargo.args(quick());
        } else {
            // All suites, also after one that failed: one run reports all failures.
            cargo.arg("--no-fail-fast");
        }
        cargo.args(&arguments.cargo_test);
        if arguments.c || with_c {
            cargo.env(WITH_C, "1");
        }
        if with_firmware {
            cargo.env(WITH_FIRMWARE, "1");
        }
    })?;
    // Words for one suite are no words for another.
    let is_whole =
        ![arguments.quick, arguments.without_emulator, arguments.c].contains(&true) && arguments.cargo_test.is_empty();
    let mut all = vec![if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE }];
    if is_whole && is_asked_for(Suite::Page) {
        if let Some(browser) = page::Browser::at_hand() {
            all.push(on_page(&browser, tool, times, &[])?);
        } else {
            progress.say("left out: the page for the browser; `cargo palpate test --page` sets up what it needs");
        }
    }
    if is_whole && is_asked_for(Suite::Python) {
        if in_python::is_set_up() {
            all.push(in_python::test(&[])?);
        } else {
            progress.say("left out: the wheel for Python; `cargo palpate test --python` sets up what it needs");
        }
    }
    Ok(if all.iter().all(|code| *code == ExitCode::SUCCESS) { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Builds the images of an emulated board and reports their sizes.
fn set_up(board: Board, progress: &Progress) -> anyhow::Result<()> {
    firmware::build_all(board, progress)?;
    if !Board::CORTEX_F.contains(&board) {
        return Ok(());
    }
    let ready = firmware::prepare(&Choice { board, ..Choice::default() }, progress)?;
    progress.say(&format!("{}: {}", board.core(), ready.qemu.version));
    for transport in [Transport::Uart, Transport::Fifo] {
        let image = ready.images.of(transport);
        let [flash, ram] = [image.flash, image.ram];
        progress.say(&format!("image {}: {flash} bytes of flash, {ram} bytes of RAM", transport.binary()));
    }
    Ok(())
}

/// The tests of the page, which are apart: only they need a browser and its driver.
fn on_page(browser: &page::Browser, tool: &Path, times: &mut Times, words: &[String]) -> anyhow::Result<ExitCode> {
    let root = repository::root()?;
    let status = times.cargo_test(tool, |cargo: &mut Command| {
        cargo.current_dir(root).args(["-p", "palpate-tool", "--test", "page"]);
        cargo.env("PALPATE_TOOL", tool).env("PALPATE_CHROMIUM", browser.path());
        // One browser at a time: each draws on all cores.
        cargo.args(["--", "--test-threads=1", "--nocapture"]).args(words);
    })?;
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn quick() -> impl Iterator<Item = &'static str> {
    QUICK.lines().filter(|line| !line.starts_with('#'))
}
