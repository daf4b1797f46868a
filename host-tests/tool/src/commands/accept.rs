//! `palpate accept`: whether a board does what the library promises of it, without its motors.

use super::output::{print, write_whole};
use crate::accept::{
    self, DeviceLine, Found, GREETING, PATIENCE, Plan, Report, Surroundings, examine, expected, judge,
};
use crate::firmware::{Board, Program, Progress, SetUpError};
use anyhow::{Context, bail, ensure};
use clap::Args;
use palpate::wire::acceptance::Failure;
use serialport::SerialPort;
use std::fs;
use std::io::{self, ErrorKind, Read, Write};
use std::path::PathBuf;
use std::process::ExitCode;

/// Accepts a board with motors disabled: the host's bits, cycles, rate and jitter, tables, sensors, resets.
///
/// The board runs the image of `palpate firmware --board B accept`, which cannot drive a motor. The report has each
/// figure and its limit; docs/howto/acceptance.md has the wiring and the failures.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Serial port, such as /dev/ttyACM0
    #[arg(long, required_unless_present = "emulator", conflicts_with = "emulator")]
    port: Option<String>,
    /// Baud rate
    #[arg(long, default_value_t = 500_000)]
    baud: u32,
    /// Emulated board instead of a device
    #[arg(long, value_parser = Board::cortex_f())]
    emulator: Option<Board>,
    /// Image for the emulator, built before; default: build it now
    #[arg(long, value_name = "ELF", requires = "emulator")]
    image: Option<PathBuf>,
    /// Time to watch the device's own ticks, s
    #[arg(long, default_value_t = 60.0)]
    seconds: f64,
    /// Maximum ticks of each lap of the script; the longest has 300,000
    #[arg(long, default_value_t = 300_000)]
    ticks: u32,
    /// Provoke a hang, a panic and an exception, and check the reset reason after each
    #[arg(long, conflicts_with = "emulator")]
    resets: bool,
    /// Bare board without sensors: report them without a verdict
    #[arg(long)]
    bare: bool,
    /// Skip the emulator, which counts instructions to compare with the device's cycles
    #[arg(long, conflicts_with = "emulator")]
    without_emulator: bool,
    /// Report file
    #[arg(long, default_value = "palpate-report/accept.md")]
    report: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    ensure!(arguments.seconds.is_finite() && arguments.seconds > 0.0, "--seconds must be a positive time");
    ensure!(arguments.ticks > 0, "--ticks must be at least 1");
    let resets = arguments.resets.then_some([Failure::Hang, Failure::Panic, Failure::Exception]);
    let failures = resets.into_iter().flatten().collect();
    let plan = Plan { most: arguments.ticks, seconds: arguments.seconds, failures, greeting: GREETING };
    let (device, mut found, counted) = if let Some(board) = arguments.emulator {
        let program = match &arguments.image {
            Some(elf) => Program::of_image(board, elf, &Progress::new())?,
            None => accept::prepared(board, &[])?,
        };
        let found = accept::on_emulator(&program, &plan)?;
        let counted = Ok(Some(found.lines.clone()));
        (format!("{} ({}), emulated", board.name(), board.machine()), found, counted)
    } else if let Some(path) = &arguments.port {
        let mut port = Port { path: path.clone(), baud: arguments.baud, open: None };
        port.reopen().with_context(|| format!("cannot open the serial port {path}"))?;
        let found = examine(&mut port, &plan).with_context(|| format!("serial port {path}"))?;
        let counted = counted(arguments, &plan, &found);
        (format!("serial port {path}"), found, counted)
    } else {
        bail!("either --port or --emulator");
    };
    // A device that was examined has its report, whatever comes after.
    let counted = counted.unwrap_or_else(|error| {
        found.broken_off.get_or_insert(format!("no instructions were counted beside the cycles: {error:#}"));
        None
    });
    let around =
        Surroundings { emulated: arguments.emulator.is_some(), bare: arguments.bare, counted: counted.as_deref() };
    let expected = expected(arguments.ticks);
    let checks = judge(&found, &expected, &around);
    let report = Report::new(&device, &found, &expected, &around, checks);
    let text = report.to_string();
    print(text.as_bytes())?;
    if let Some(folder) = arguments.report.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    write_whole(&arguments.report, text.as_bytes())?;
    eprintln!("the report to post: {}", arguments.report.display());
    Ok(if report.failed().is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// A serial port, or none while its device is gone.
struct Port {
    path: String,
    baud: u32,
    open: Option<Box<dyn SerialPort>>,
}

impl Port {
    fn line(&mut self) -> io::Result<&mut Box<dyn SerialPort>> {
        self.open.as_mut().ok_or_else(|| ErrorKind::NotConnected.into())
    }
}

impl Read for Port {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.line()?.read(buffer)
    }
}

impl Write for Port {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.line()?.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.line()?.flush()
    }
}

impl DeviceLine for Port {
    fn reopen(&mut self) -> io::Result<()> {
        // Let go of first: a plug that comes back while its old name is in use is given another.
        self.open = None;
        let mut port = serialport::new(&self.path, self.baud).timeout(PATIENCE).open()?;
        // A device at its own USB plug tells while this is up. Not every system raises it; not every port has it.
        let _ = port.write_data_terminal_ready(true);
        self.open = Some(port);
        Ok(())
    }
}

/// The instructions that an emulated core of the device's kind counts in the same script; `None` where there is no
/// emulator.
fn counted(
    arguments: &Arguments,
    plan: &Plan,
    found: &Found,
) -> anyhow::Result<Option<Vec<palpate::wire::acceptance::Line>>> {
    let board = match (found.identity.core >> 4) & 0xfff {
        0xc24 => Board::M4,
        0xc27 => Board::M7,
        0xd21 => Board::M33,
        _ => return Ok(None),
    };
    if arguments.without_emulator {
        return Ok(None);
    }
    let short = Plan { seconds: 0.1, failures: Vec::new(), ..plan.clone() };
    match accept::prepared(board, &[]) {
        Ok(program) => Ok(Some(accept::on_emulator(&program, &short)?.lines)),
        Err(SetUpError::NoEmulator(reason)) => {
            eprintln!("no instructions are counted beside the cycles: {reason}");
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}
