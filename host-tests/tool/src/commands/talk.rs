//! `palpate talk`: a device, by hand.

use super::bake;
use crate::firmware::Board;
use crate::models::is_baked;
use crate::talk::{Button, Console, Emulated, Misunderstood, Press, Step, at_knob};
use anyhow::{Context as _, bail};
use clap::Args;
use palpate::wire::hold;
use palpate_link::{Device, Error, Line, Port, SILENCE};
use palpate_sim::knob::{KnobFlash, SharedKnob, SimulatedKnob, dial};
use palpate_sim::simulated::{self, Simulated};
use std::io::{IsTerminal as _, Write, stdin, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::time::Duration;

/// Controls a running device: reads it, moves and switches its bodies, uploads bodies, adds a force.
///
/// Each line is a command, in millimetres, degrees and newtons; `help` lists them. An error states its reason. In a
/// script the first error ends the run with exit status 2. `talk` keeps the link alive while it runs; a device that
/// watches its link stops when it ends.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Serial port, such as /dev/ttyACM0
    #[arg(long, group = "where")]
    port: Option<String>,
    /// Baud rate
    #[arg(long, default_value_t = 500_000)]
    baud: u32,
    /// Emulated board with WoodenHaptics, simulated, over two capped boxes
    #[arg(long, value_parser = Board::cortex_f(), group = "where")]
    emulator: Option<Board>,
    /// The boards' loop compiled for the host, with the same device
    #[arg(long, group = "where")]
    host: bool,
    /// Log (CSV): tick, position, velocity, force, gap, feature, phase and fault; of a knob, degrees and torque
    #[arg(long, value_name = "OUT.csv")]
    log: Option<PathBuf>,
    /// Rows of --log a second, Hz, up to the servo rate; each needs 63 bytes of the line, 1 kHz USB; default: 1000, of a
    /// knob 100, its most
    #[arg(long, requires = "log", value_name = "HZ")]
    log_rate: Option<f64>,
    /// The emulated or simulated device: one of two, never your file (my.toml), which `sim`, `demo` and `firmware` take
    #[arg(long, value_enum, default_value = "arm")]
    device: Kind,
}

/// A device that can be talked with without having it.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// WoodenHaptics over two capped boxes
    Arm,
    /// A knob, whose dial a hand turns there and back
    Knob,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let knob = (arguments.device == Kind::Knob).then(|| SharedKnob::new(dial()));
    let (line, button): (Box<dyn Line>, Option<Button>) = match (&arguments.port, arguments.emulator, arguments.host) {
        (Some(port), ..) => (Box::new(Port::open(port, arguments.baud)?), None),
        (None, Some(board), _) => {
            let device = match &knob {
                Some(knob) => Emulated::start_knob(board, knob)?,
                None => Emulated::start(board)?,
            };
            let button = device.button();
            (Box::new(device), Some(button))
        }
        (None, None, true) => match &knob {
            Some(knob) => {
                let device = SimulatedKnob::new(knob, Box::leak(Box::new(KnobFlash::new()))).paced();
                (Box::new(device), Some(at_knob(knob, true)))
            }
            None => {
                let device = Simulated::new(simulated::Kind { bytes_per_tick: USB, ..Default::default() })?.paced();
                let hand = device.hand();
                let button = move |press| {
                    hand.enables(press == Press::Down);
                    press != Press::Reset
                };
                (Box::new(device), Some(Box::new(button)))
            }
        },
        (None, None, false) => bail!("either --port, --emulator or --host"),
    };
    let log = arguments.log.as_deref().map(|path| (path, arguments.log_rate));
    talk(line, button, knob.as_ref(), log)
}

fn talk(
    line: Box<dyn Line>,
    button: Option<Button>,
    knob: Option<&SharedKnob>,
    log: Option<(&Path, Option<f64>)>,
) -> anyhow::Result<ExitCode> {
    let mut device = Device::over(line)?;
    if let Some(button) = &button {
        press(&mut device, button)?;
        if let Some(knob) = knob {
            // The first press has it aligned; then the device wants to see the button released.
            let until = device.now() + ALIGNED;
            while device.view(SILENCE)?.hold & hold::RELEASE_FIRST == 0 && device.now() < until {}
            button(Press::Up);
            press(&mut device, button)?;
            knob.world().turns_from = 0.0;
        }
    }
    let mut console = Console::new(device, &file_of).with_button(button);
    if let Some((path, rate)) = log {
        console = console.with_log(path, rate)?;
    }
    let mut output = stdout().lock();
    writeln!(output, "{}", console.who())?;
    let ended = converse(&mut console, &mut output);
    console.end_log(&mut output)?;
    ended.map(|()| ExitCode::SUCCESS)
}

fn converse(console: &mut Console<'_, Box<dyn Line>>, output: &mut dyn Write) -> anyhow::Result<()> {
    let (lines, by_hand) = (lines(), stdin().is_terminal());
    let mut count = 0;
    loop {
        if by_hand || !console.is_busy() {
            match lines.try_recv() {
                Ok(line) => {
                    let line = line?;
                    count += 1;
                    match console.obey(&line, output) {
                        Ok(Step::GoesOn) => {}
                        Ok(Step::Ends) => return Ok(()),
                        Err(error) if by_hand && is_passing(&error) => writeln!(output, "{error:#}")?,
                        Err(error) => bail!("{error:#}: line {count}, \"{line}\""),
                    }
                }
                Err(TryRecvError::Disconnected) => return Ok(()),
                Err(TryRecvError::Empty) => {}
            }
        }
        console.tend(output)?;
        output.flush()?;
    }
}

/// Bytes that USB carries in a tick of 4 kHz: a device in this program has no baud rate.
const USB: u32 = 240;

/// How long a knob takes to be aligned at most.
const ALIGNED: Duration = Duration::from_secs(5);

/// A button is asked for once the device has seen it released for long enough.
fn press(device: &mut Device<Box<dyn Line>>, button: &Button) -> Result<(), Error> {
    let until = device.now() + SILENCE;
    while device.view(SILENCE)?.hold & hold::RELEASE_FIRST != 0 && device.now() < until {}
    button(Press::Down);
    Ok(())
}

/// Whether the conversation can go on after it.
fn is_passing(error: &anyhow::Error) -> bool {
    let gone =
        matches!(error.downcast_ref(), Some(Error::Line { .. } | Error::Silent { .. } | Error::NotStopped { .. }));
    error.is::<Misunderstood>() || !gone
}

/// The lines typed so far, without waiting for one.
fn lines() -> Receiver<std::io::Result<String>> {
    let (sender, lines) = sync_channel(1);
    std::thread::spawn(move || {
        for line in stdin().lines() {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    lines
}

/// A body's file as it is, or made of a model.
fn file_of(path: &Path) -> anyhow::Result<Vec<u8>> {
    if is_baked(path) {
        return std::fs::read(path).with_context(|| path.display().to_string());
    }
    bake::file_of(path)
}
