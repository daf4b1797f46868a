//! `palpate talk`: a device, by hand.

use super::bake;
use crate::firmware::Board;
use crate::models::is_baked;
use crate::talk::{Console, Emulated, Misunderstood, Step};
use anyhow::{Context as _, bail};
use clap::Args;
use palpate::wire::hold;
use palpate_link::{Device, Error, Line, Port, SILENCE};
use palpate_sim::simulated::{Hand, Kind, Simulated};
use std::io::{IsTerminal as _, Write, stdin, stdout};
use std::path::Path;
use std::process::ExitCode;
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};

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
    /// Emulated board with a simulated arm over two capped boxes
    #[arg(long, value_enum, group = "where")]
    emulator: Option<Board>,
    /// The boards' loop compiled for the host, with the same arm
    #[arg(long, group = "where")]
    host: bool,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let (line, hand): (Box<dyn Line>, _) = match (&arguments.port, arguments.emulator, arguments.host) {
        (Some(port), ..) => (Box::new(Port::open(port, arguments.baud)?), None),
        (None, Some(board), _) => {
            let device = Emulated::start(board)?;
            let hand = device.hand();
            (Box::new(device), Some(hand))
        }
        (None, None, true) => {
            let device = Simulated::new(Kind::default())?.paced();
            let hand = device.hand();
            (Box::new(device), Some(hand))
        }
        (None, None, false) => bail!("either --port, --emulator or --host"),
    };
    talk(line, hand.as_ref())
}

fn talk(line: Box<dyn Line>, hand: Option<&Hand>) -> anyhow::Result<ExitCode> {
    let mut device = Device::over(line)?;
    if let Some(hand) = hand {
        // A button is asked for once the device has seen it released for long enough.
        let until = device.now() + SILENCE;
        while device.view(SILENCE)?.hold & hold::RELEASE_FIRST != 0 && device.now() < until {}
        hand.enables(true);
    }
    let mut console = Console::new(device, &file_of);
    let (lines, by_hand) = (lines(), stdin().is_terminal());
    let mut output = stdout().lock();
    writeln!(output, "{}", console.who())?;
    loop {
        if by_hand || !console.is_busy() {
            match lines.try_recv() {
                Ok(line) => match console.obey(&line?, &mut output) {
                    Ok(Step::GoesOn) => {}
                    Ok(Step::Ends) => return Ok(ExitCode::SUCCESS),
                    Err(error) if by_hand && is_passing(&error) => writeln!(output, "{error:#}")?,
                    Err(error) => return Err(error),
                },
                Err(TryRecvError::Disconnected) => return Ok(ExitCode::SUCCESS),
                Err(TryRecvError::Empty) => {}
            }
        }
        console.tend(&mut output)?;
        output.flush()?;
    }
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
