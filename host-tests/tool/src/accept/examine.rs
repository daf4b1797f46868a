//! Asking a device, over its line.

use anyhow::{Context, bail};
use palpate::wire::acceptance::{Failure, Finding, Identity, Line, Request, Ticks};
use palpate::wire::frame::{self, MAX_FRAME, Received, Receiver};
use std::collections::VecDeque;
use std::io::{ErrorKind, Read, Write};
use std::time::{Duration, Instant};

/// How long a device may take to say who it is, a reset included, and how often it is asked meanwhile.
const GREETING: Duration = Duration::from_secs(20);
const AGAIN: Duration = Duration::from_millis(500);
/// How long it may be silent in the midst of its script or of its ticks: an emulated one on a busy machine is slow.
const SILENCE: Duration = Duration::from_secs(120);

/// What is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Ticks of each lap of the script, at most.
    pub most: u32,
    /// Seconds of the device's own ticks.
    pub seconds: f64,
    /// How it is to fail, one after the other.
    pub failures: Vec<Failure>,
}

/// What a device said.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Who it is.
    pub identity: Identity,
    /// The lines of its script.
    pub lines: Vec<Line>,
    /// Its own ticks. The first one is where they begin.
    pub ticks: Vec<Ticks>,
    /// Seconds by the host's clock from the first of them to the last.
    pub seconds: f64,
    /// Frames that came damaged.
    pub damaged: u32,
    /// How it was told to fail, and the reset reason that it gave afterwards, as its number.
    pub failures: Vec<(Failure, u8)>,
}

/// Asks a device everything, over a line whose reading gives up after a moment.
///
/// # Errors
/// If it does not answer, or the line fails.
pub fn examine<L: Read + Write>(line: &mut L, plan: &Plan) -> anyhow::Result<Found> {
    let mut talk = Talk { line, receiver: Receiver::new(), came: VecDeque::new(), damaged: 0 };
    let mut found = Found { identity: talk.greet()?, ..Found::default() };
    // What came before the greeting may have begun before this program did.
    talk.damaged = 0;

    talk.ask(Request::Script { most: plan.most })?;
    loop {
        match talk.next(SILENCE)?.context("the device fell silent in the midst of its script")? {
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
        let finding = talk.next(SILENCE)?.context("the device fell silent in the midst of its ticks")?;
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
        // It is gone before it is asked again.
        let gone = Instant::now();
        while gone.elapsed() < AGAIN {
            talk.next(AGAIN)?;
        }
        let identity = talk.greet().with_context(|| format!("after it was told to fail ({failure:?})"))?;
        found.failures.push((*failure, identity.reset));
    }
    Ok(found)
}

/// A line, and what came over it.
struct Talk<'a, L> {
    line: &'a mut L,
    receiver: Receiver<Finding>,
    came: VecDeque<Finding>,
    damaged: u32,
}

impl<L: Read + Write> Talk<'_, L> {
    fn ask(&mut self, request: Request) -> anyhow::Result<()> {
        let mut buffer = [0; MAX_FRAME];
        let frame = frame::pack(&request, &mut buffer)?;
        self.line.write_all(frame).context("the line to the device")
    }

    /// Asks who it is until it says so.
    fn greet(&mut self) -> anyhow::Result<Identity> {
        let began = Instant::now();
        while began.elapsed() < GREETING {
            self.ask(Request::Identity)?;
            let asked = Instant::now();
            while asked.elapsed() < AGAIN {
                if let Some(Finding::Identity(identity)) = self.next(AGAIN)? {
                    return Ok(identity);
                }
            }
        }
        bail!("no device answers: is its image the one of `firmware --board B accept`?")
    }

    /// What it says next; `None` if it says nothing for so long.
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
