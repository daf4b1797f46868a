//! Asking a device, over its line.

use anyhow::{Context, bail};
use palpate::wire::acceptance::{Failure, Finding, Identity, Line, Request, Ticks};
use palpate::wire::frame::{self, MAX_FRAME, Received, Receiver};
use std::collections::VecDeque;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::thread;
use std::time::{Duration, Instant};

/// How long a device may take to say who it is, a reset included, and how often it is asked meanwhile.
pub const GREETING: Duration = Duration::from_secs(20);
const AGAIN: Duration = Duration::from_millis(500);
/// Time between attempts to reopen a broken line.
const TRIED: Duration = Duration::from_millis(50);
/// How long it may be silent in the midst of its script or of its ticks: an emulated one on a busy machine is slow.
const SILENCE: Duration = Duration::from_secs(120);

/// The line to a device.
pub trait DeviceLine: Read + Write {
    /// Opens it again after the device took the line along: a USB port of its own disconnects at every reset.
    ///
    /// # Errors
    /// If it is not there, or not yet.
    fn reopen(&mut self) -> io::Result<()> {
        Err(ErrorKind::Unsupported.into())
    }
}

/// An emulated board's, which stays.
impl DeviceLine for TcpStream {}

/// The requests of an examination.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Ticks of each lap of the script, at most.
    pub most: u32,
    /// Seconds of the device's own ticks.
    pub seconds: f64,
    /// How it is to fail, one after the other.
    pub failures: Vec<Failure>,
    /// How long the device may take to say who it is; [`GREETING`].
    pub greeting: Duration,
}

/// The device's answers.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The device's identity.
    pub identity: Identity,
    /// The lines of its script.
    pub lines: Vec<Line>,
    /// Its own ticks, from the first.
    pub ticks: Vec<Ticks>,
    /// Seconds by the host's clock from the first of them to the last.
    pub seconds: f64,
    /// Frames that came damaged.
    pub damaged: u32,
    /// The failures that were requested, and the reset reason after each, as its number.
    pub failures: Vec<(Failure, u8)>,
    /// Why not everything was asked, if so.
    pub broken_off: Option<String>,
}

/// Sends a device every request, over a line whose reading times out after a moment. If the device falls silent or its
/// line fails later on, the answers so far are kept: [`Found::broken_off`].
///
/// # Errors
/// If it does not identify itself.
pub fn examine<L: DeviceLine>(line: &mut L, plan: &Plan) -> anyhow::Result<Found> {
    let mut talk = Talk { line, receiver: Receiver::new(), came: VecDeque::new(), damaged: 0 };
    let mut found = Found { identity: talk.greet(plan.greeting)?, ..Found::default() };
    // What came before the greeting may have begun before this program did.
    talk.damaged = 0;
    if let Err(error) = ask_all(&mut talk, plan, &mut found) {
        found.broken_off = Some(format!("{error:#}"));
    }
    Ok(found)
}

/// Asks what there is to ask of a device that is known.
fn ask_all<L: DeviceLine>(talk: &mut Talk<'_, L>, plan: &Plan, found: &mut Found) -> anyhow::Result<()> {
    talk.ask(Request::Script { most: plan.most })?;
    loop {
        match talk.next(SILENCE)?.context("the device fell silent during its script")? {
            Finding::Line(line) => found.lines.push(line),
            Finding::Done => break,
            // Of a greeting that was repeated.
            Finding::Identity(_) | Finding::Ticks(_) => {}
        }
    }

    talk.ask(Request::Watch(true))?;
    let wanted = (plan.seconds * f64::from(found.identity.rate)) as u32;
    let mut began = Instant::now();
    loop {
        let finding = talk.next(SILENCE)?.context("the device fell silent while its ticks were watched")?;
        let Finding::Ticks(ticks) = finding else { continue };
        if found.ticks.is_empty() {
            began = Instant::now();
        }
        found.ticks.push(ticks);
        if ticks.ticks.wrapping_sub(found.ticks[0].ticks) >= wanted {
            break;
        }
    }
    found.seconds = began.elapsed().as_secs_f64();
    talk.ask(Request::Watch(false))?;
    found.damaged = talk.damaged;

    for failure in &plan.failures {
        talk.ask(Request::Fail(*failure))?;
        let identity =
            talk.greet_anew(plan.greeting).with_context(|| format!("after the provoked failure {failure:?}"))?;
        found.failures.push((*failure, identity.reset));
    }
    Ok(())
}

/// A line, and what came over it.
struct Talk<'a, L> {
    line: &'a mut L,
    receiver: Receiver<Finding>,
    came: VecDeque<Finding>,
    damaged: u32,
}

impl<L: DeviceLine> Talk<'_, L> {
    fn ask(&mut self, request: Request) -> anyhow::Result<()> {
        let mut buffer = [0; MAX_FRAME];
        let frame = frame::pack(&request, &mut buffer)?;
        self.line.write_all(frame).context("the line to the device")
    }

    /// Asks who it is until it says so.
    fn greet(&mut self, patience: Duration) -> anyhow::Result<Identity> {
        let began = Instant::now();
        while began.elapsed() < patience {
            if let Some(identity) = self.asked_who()? {
                return Ok(identity);
            }
        }
        bail!("no device answers: is its image the one of `firmware --board B accept`?")
    }

    /// Asks once who it is, and waits a moment for the answer.
    fn asked_who(&mut self) -> anyhow::Result<Option<Identity>> {
        self.ask(Request::Identity)?;
        let asked = Instant::now();
        while asked.elapsed() < AGAIN {
            if let Some(Finding::Identity(identity)) = self.next(AGAIN)? {
                return Ok(Some(identity));
            }
        }
        Ok(None)
    }

    /// The same of a device that resets. Its line may go with it, at once or only when its watchdog resets it, and is
    /// then opened again.
    fn greet_anew(&mut self, patience: Duration) -> anyhow::Result<Identity> {
        let began = Instant::now();
        // It is gone before it is asked again.
        let mut broken = loop {
            match self.next(AGAIN) {
                Ok(_) if began.elapsed() < AGAIN => {}
                Ok(_) => break None,
                Err(error) => break Some(error),
            }
        };
        while began.elapsed() < patience {
            if broken.is_some() {
                if self.line.reopen().is_err() {
                    thread::sleep(TRIED);
                    continue;
                }
                // Half of a frame from before is none.
                (self.receiver, broken) = (Receiver::new(), None);
                self.came.clear();
            }
            match self.asked_who() {
                Ok(Some(identity)) => return Ok(identity),
                Ok(None) => {}
                Err(error) => broken = Some(error),
            }
        }
        Err(broken.unwrap_or_else(|| anyhow::anyhow!("it did not come back")))
    }

    /// Its next message; `None` after the timeout.
    fn next(&mut self, patience: Duration) -> anyhow::Result<Option<Finding>> {
        let began = Instant::now();
        let mut buffer = [0; 512];
        while self.came.is_empty() && began.elapsed() < patience {
            let bytes = match self.line.read(&mut buffer) {
                Ok(0) => bail!("the device closed its line"),
                Ok(read) => &buffer[..read],
                Err(error) => match error.kind() {
                    ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted => continue,
                    _ => return Err(error).context("the line to the device"),
                },
            };
            for byte in bytes {
                match self.receiver.feed(*byte) {
                    Some(Received::Message(finding)) => self.came.push_back(finding),
                    Some(Received::Damaged) => self.damaged += 1,
                    Some(Received::Empty) | None => {}
                }
            }
        }
        Ok(self.came.pop_front())
    }
}
