//! `palpate monitor`: the telemetry of a running device, live.

use super::demo::write_tables;
use super::options::SceneOptions;
use crate::firmware::{Board, Emulator, Program, Progress};
use crate::monitor::{Figures, Monitor, Table};
use crate::simulation;
use anyhow::{Context, bail, ensure};
use clap::{Args, ValueEnum};
use palpate::wire::frame::{self, MAX_FRAME};
use palpate::wire::{HostMessage, PROTOCOL};
use std::fs::File;
use std::io::{self, ErrorKind, IsTerminal, Read, Write, stdout};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Shows rate, jitter, phase, force and faults of a running device, and records them.
///
/// On a terminal one line is updated in place; elsewhere a line is printed every second and at each change of phase or
/// fault. Ends when the line is closed, --for seconds after the first record, or with Ctrl-C.
#[derive(Args, Debug)]
// The scene is the emulated board's alone: a device at a port has its own.
#[command(mut_group("SceneOptions", |scene| scene.conflicts_with("port")))]
pub struct Arguments {
    /// Record of everything (CSV): SI units, the tables' frame; contact 0 behind, 1 in front, 2 touching; phase 0 reset, 1
    /// calibrate, 2 armed, 3 running, 4 fault
    #[arg(long, value_name = "OUT")]
    csv: Option<PathBuf>,
    /// File for the raw bytes of the line
    #[arg(long, value_name = "OUT")]
    raw: Option<PathBuf>,
    /// Time after the first record at which it stops, s; default: when the line closes
    #[arg(long = "for", value_name = "SECONDS")]
    ends_after: Option<f64>,
    /// Serial port of the device, such as /dev/ttyACM0
    #[arg(
        long,
        required_unless_present = "emulator",
        conflicts_with = "emulator",
        help_heading = "A device at a port"
    )]
    port: Option<String>,
    /// Speed of the port, baud
    #[arg(long, default_value_t = 500_000, conflicts_with = "emulator", help_heading = "A device at a port")]
    baud: u32,
    /// Command to send to the device first
    #[arg(long, value_enum, value_name = "COMMAND", conflicts_with = "emulator", help_heading = "A device at a port")]
    send: Option<Sent>,
    /// Emulated board with a simulated hand, instead of a device
    #[arg(long, value_parser = Board::cortex_f(), help_heading = "An emulated board")]
    emulator: Option<Board>,
    #[command(flatten, next_help_heading = "An emulated board")]
    scene: SceneOptions,
}

/// A command for a device that runs by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Sent {
    /// Stops the device; latched
    Stop,
    /// Resumes after a reset by the watchdog or a brown-out, once the enable button was held for half a second
    Acknowledge,
}

impl Sent {
    const fn command(self) -> HostMessage {
        match self {
            Self::Stop => HostMessage::Stop,
            Self::Acknowledge => HostMessage::Acknowledge,
        }
    }
}

/// How long to wait for bytes before looking at the clock.
const PATIENCE: Duration = Duration::from_millis(50);
/// How often a terminal's line is updated, and how often a line is printed elsewhere.
const REFRESH: Duration = Duration::from_millis(100);
const LINE: Duration = Duration::from_secs(1);

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let mut view = View::new(arguments)?;
    if let Some(board) = arguments.emulator {
        watch_emulator(arguments, board, &mut view)?;
    } else if let Some(path) = &arguments.port {
        let port = serialport::new(path, arguments.baud).timeout(PATIENCE).open();
        let mut port = port.with_context(|| format!("cannot open the serial port {path}"))?;
        // A device at its own USB plug sends while this is up. Not every system raises it; not every port has it.
        let _ = port.write_data_terminal_ready(true);
        if let Some(sent) = arguments.send {
            let mut buffer = [0; MAX_FRAME];
            // It takes no command but a stop before a hello.
            let mut frames = frame::pack(&HostMessage::Hello { protocol: PROTOCOL }, &mut buffer)?.to_vec();
            frames.extend_from_slice(frame::pack(&sent.command(), &mut buffer)?);
            port.write_all(&frames).with_context(|| format!("cannot write to the serial port {path}"))?;
        }
        view.watch(&mut port)?;
    } else {
        bail!("either --port or --emulator");
    }
    view.end()
}

/// The emulated board in closed loop with the simulated device, one servo period of it in one of ours.
fn watch_emulator(arguments: &Arguments, board: Board, view: &mut View) -> anyhow::Result<()> {
    let scene = arguments.scene.scene()?;
    ensure!(scene.tool.is_none(), "--tool: monitor shows a point's loop; see demo --tool");
    let (_folder, choice) = write_tables(board, &scene)?;
    let program = Program::prepare_with(&choice, "telemetry", &[], &Progress::new())?;
    let (mut emulator, mut line) = program.start_with_telemetry()?;
    line.set_read_timeout(Some(PATIENCE))?;
    let mut plant = arguments.scene.plant(&scene)?;
    let span = scene.span();
    let driver = std::thread::spawn(move || {
        let start = Instant::now();
        let pace = |done: u32| {
            let due = Duration::from_secs_f64(f64::from(done) / span.rate);
            std::thread::sleep(due.saturating_sub(start.elapsed()));
        };
        let outcome = simulation::run(&mut emulator, &mut plant, span, pace);
        // The line closes with it, and the watching ends.
        drop::<Emulator>(emulator);
        outcome.map(drop)
    });
    view.watch(&mut line)?;
    if driver.is_finished() {
        driver.join().map_err(|_| anyhow::anyhow!("the simulation panicked"))??;
    }
    Ok(())
}

/// The display and the recording.
struct View {
    monitor: Monitor,
    csv: Option<PathBuf>,
    raw: Option<PathBuf>,
    /// Opened with the first record and the first bytes: a line that does not open keeps an older recording.
    table: Option<Table>,
    bytes: Option<File>,
    refreshes: bool,
    /// When the line was opened, then when the first record came: an image is built before, and a board starts.
    start: Instant,
    ends_after: Option<Duration>,
    shown: Option<(Instant, u8, u8)>,
}

impl View {
    fn new(arguments: &Arguments) -> anyhow::Result<Self> {
        let ends_after = arguments.ends_after.map(Duration::try_from_secs_f64).transpose();
        Ok(Self {
            monitor: Monitor::default(),
            csv: arguments.csv.clone(),
            raw: arguments.raw.clone(),
            table: None,
            bytes: None,
            refreshes: stdout().is_terminal(),
            start: Instant::now(),
            ends_after: ends_after.context("--for must be a positive time")?,
            shown: None,
        })
    }

    /// Reads until the line closes or the time is over.
    fn watch(&mut self, line: &mut impl Read) -> anyhow::Result<()> {
        let mut buffer = [0; 4096];
        self.start = Instant::now();
        while self.ends_after.is_none_or(|end| self.start.elapsed() < end) {
            let bytes = match line.read(&mut buffer) {
                Ok(0) => return Ok(()),
                Ok(read) => &buffer[..read],
                Err(error) => match error.kind() {
                    ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted => continue,
                    // A device that was unplugged, or an emulator that ended. What was seen so far counts.
                    _ => {
                        eprintln!("the line closed: {error}");
                        return Ok(());
                    }
                },
            };
            if let Some(path) = self.raw.take() {
                self.bytes = Some(File::create(&path).with_context(|| format!("cannot write {}", path.display()))?);
            }
            if let Some(file) = &mut self.bytes {
                file.write_all(bytes).context("the bytes of the line cannot be written")?;
            }
            for byte in bytes {
                if let Some(figures) = self.monitor.feed(*byte) {
                    self.take(&figures)?;
                }
            }
            if let Some(table) = &mut self.table {
                table.flush()?;
            }
        }
        Ok(())
    }

    fn take(&mut self, figures: &Figures) -> anyhow::Result<()> {
        if self.monitor.records == 1 {
            self.start = Instant::now();
        }
        if let Some(path) = self.csv.take() {
            self.table = Some(Table::create(&path).with_context(|| format!("cannot write {}", path.display()))?);
        }
        if let Some(table) = &mut self.table {
            table.write(figures)?;
        }
        let (phase, fault) = (figures.record.phase, figures.record.fault);
        let pause = if self.refreshes { REFRESH } else { LINE };
        let is_due = self.shown.is_none_or(|(at, shown_phase, shown_fault)| {
            at.elapsed() >= pause || (phase, fault) != (shown_phase, shown_fault)
        });
        if is_due {
            self.shown = Some((Instant::now(), phase, fault));
            self.show(figures)?;
        }
        Ok(())
    }

    fn show(&self, figures: &Figures) -> io::Result<()> {
        let rate = figures.rate.map_or_else(|| "     –   Hz".to_owned(), |rate| format!("{rate:8.1} Hz"));
        let [shortest, longest] = figures.periods;
        let line = format!(
            "tick {:>8}  {rate}  period {shortest:.1} to {longest:.1} µs  took {:.1} µs  {:<9}  {:<8}  gap {:+.2} mm  force {:.2} N  {}{}",
            figures.record.tick,
            figures.took,
            figures.phase(),
            figures.contact(),
            figures.record.gap * 1e3,
            figures.force(),
            figures.fault(),
            self.losses(figures),
        );
        let mut output = stdout().lock();
        if self.refreshes {
            // Back to the start of the line, and what was there wiped away.
            write!(output, "\r\x1b[2K{line}")?;
        } else {
            writeln!(output, "{line}")?;
        }
        output.flush()
    }

    /// The missing records, if there are any.
    fn losses(&self, figures: &Figures) -> String {
        let counts = [
            ("overruns", u64::from(figures.record.overruns)),
            ("dropped", u64::from(figures.record.dropped)),
            ("lost", self.monitor.lost),
            ("damaged", self.monitor.damaged),
            ("resets", self.monitor.resets),
        ];
        counts.iter().filter(|(_, count)| *count > 0).map(|(name, count)| format!("  {name} {count}")).collect()
    }

    fn end(mut self) -> anyhow::Result<ExitCode> {
        if let Some(table) = &mut self.table {
            table.flush()?;
        }
        let Monitor { records, damaged, lost, resets, .. } = self.monitor;
        if self.refreshes {
            println!();
        }
        println!("{records} records, {lost} lost on the line, {damaged} of them damaged, {resets} resets");
        Ok(ExitCode::SUCCESS)
    }
}

#[cfg(test)]
mod tests {
    use super::{Arguments, View};
    use clap::{Args as _, Command, FromArgMatches as _};
    use palpate::wire::frame::{MAX_FRAME, pack};
    use palpate::wire::{DeviceMessage, Record};
    use std::io::{self, Read};
    use std::time::{Duration, Instant};

    fn is_taken(line: &str) -> bool {
        Arguments::augment_args(Command::new("monitor")).try_get_matches_from(line.split(' ')).is_ok()
    }

    #[test]
    fn each_kind_of_device_takes_its_own_options_only() {
        for line in
            ["monitor --port /dev/ttyACM0 --baud 115200 --send stop --for 3", "monitor --emulator m4 --seconds 3"]
        {
            assert!(is_taken(line), "{line}");
        }
        for line in [
            "monitor",
            "monitor --port /dev/ttyACM0 --seconds 3",
            "monitor --port /dev/ttyACM0 --model capped_box",
            "monitor --emulator m4 --baud 115200",
            "monitor --emulator m4 --send stop",
            "monitor --emulator m4 --port /dev/ttyACM0",
        ] {
            assert!(!is_taken(line), "{line}");
        }
    }

    /// A record every 10 ms, once a board has started.
    struct Starting {
        until: Option<Instant>,
        number: u32,
    }

    impl Read for Starting {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            std::thread::sleep(Duration::from_millis(10));
            if self.until.is_none_or(|until| Instant::now() < until) {
                return Err(io::ErrorKind::TimedOut.into());
            }
            self.number += 1;
            let record = Record { tick: self.number, number: self.number, clock: 1_000, ..Record::default() };
            let mut frame = [0; MAX_FRAME];
            let frame = pack(&DeviceMessage::Record(record), &mut frame).expect("a frame");
            buffer[..frame.len()].copy_from_slice(frame);
            Ok(frame.len())
        }
    }

    #[test]
    fn the_time_of_watching_starts_with_the_first_record_and_ends_without_one() {
        let line = "monitor --port none --for 0.5";
        let matches = Arguments::augment_args(Command::new("monitor")).get_matches_from(line.split(' '));
        let arguments = Arguments::from_arg_matches(&matches).expect("arguments");
        let begun = Instant::now();
        let mut silent = View::new(&arguments).expect("a view");
        silent.watch(&mut Starting { until: None, number: 0 }).expect("it ends");
        assert!(begun.elapsed() >= Duration::from_millis(500) && silent.monitor.records == 0);
        // Made before the image is built, and the board starts for most of the time.
        let mut view = View::new(&arguments).expect("a view");
        std::thread::sleep(Duration::from_millis(600));
        let mut board = Starting { until: Some(Instant::now() + Duration::from_millis(400)), number: 0 };
        view.watch(&mut board).expect("it ends");
        // The first frame is that in which a listener gets into step.
        let since = board.until.expect("a start").elapsed();
        assert!(since >= Duration::from_millis(500) && view.monitor.records > 0, "{since:?}");
    }

    #[test]
    fn an_older_recording_is_replaced_only_once_there_are_records() {
        let folder = tempfile::tempdir().expect("a folder");
        let [csv, raw] = ["run.csv", "run.raw"].map(|name| folder.path().join(name));
        for path in [&csv, &raw] {
            std::fs::write(path, "older").expect("written");
        }
        let read = || [&csv, &raw].map(|path| std::fs::read(path).expect("a file"));
        let line = format!("monitor --port none --for 0.1 --csv {} --raw {}", csv.display(), raw.display());
        let matches = Arguments::augment_args(Command::new("monitor")).get_matches_from(line.split(' '));
        let arguments = Arguments::from_arg_matches(&matches).expect("arguments");
        assert!(super::run(&arguments).is_err() && read().iter().all(|file| file == b"older"));
        View::new(&arguments).expect("a view").watch(&mut Starting { until: None, number: 0 }).expect("it ends");
        assert!(read().iter().all(|file| file == b"older"));
        let mut board = Starting { until: Some(Instant::now()), number: 0 };
        View::new(&arguments).expect("a view").watch(&mut board).expect("it ends");
        assert!(read().iter().all(|file| file != b"older" && !file.is_empty()));
    }

    #[test]
    fn the_help_names_no_option_that_does_not_exist() {
        let mut command = Arguments::augment_args(Command::new("monitor"));
        let long: Vec<String> = command.get_arguments().filter_map(|a| Some(format!("--{}", a.get_long()?))).collect();
        let help = command.render_long_help().to_string();
        for word in help.split(|letter: char| letter != '-' && !letter.is_alphanumeric()) {
            assert!(!word.starts_with("--") || word == "--help" || long.iter().any(|name| name == word), "{word}");
        }
    }
}
