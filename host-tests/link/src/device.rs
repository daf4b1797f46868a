//! A device on a line: sending and receiving.

use crate::{Error, Line, Port};
use palpate::wire::frame::{self, DELIMITER, MAX_FRAME, Received, Receiver};
use palpate::wire::{
    Answer, Calibrated, DeviceMessage, Dial, Hello, HostMessage, Modes, PROTOCOL, Reading, Record, View,
};
use std::time::{Duration, Instant};

/// The device hears from this program at least so often while a call runs, and at each call that comes later than this
/// after the last word.
pub const ALIVE: Duration = Duration::from_millis(20);
/// For how long a device is greeted, and how often meanwhile.
const GREETS: Duration = Duration::from_millis(1_500);
const GREETS_EVERY: Duration = Duration::from_millis(150);
/// How long one look at the line waits at most.
const LOOK: Duration = Duration::from_millis(5);
/// Maximum bytes read per call, and views kept for a log: a line that delivers faster than it is read must not block the caller.
const MOST: usize = 1 << 16;

/// A device that runs by itself, at the other end of a line.
///
/// No thread runs in the background. A device that watches its link ([`palpate::servo::Safety::link_timeout_s`]) goes
/// on only while this program calls: each call sends [`HostMessage::Alive`] if no message was sent for [`ALIVE`]. Call
/// any method, [`Self::view`] or [`Self::tend`], at least every third of that timeout. A background thread would keep the
/// device alive while the program hangs, and the user could not stop it.
#[derive(Debug)]
pub struct Device<L = Port> {
    pub(crate) line: L,
    receiver: Receiver<DeviceMessage>,
    hello: Hello,
    /// Of the last order or part of an upload.
    pub(crate) number: u16,
    /// The answer to it.
    pub(crate) answer: Option<Answer>,
    pub(crate) view: Option<(View, Instant)>,
    pub(crate) views: u64,
    /// All views since the last call of [`Self::take_views`], once that was called.
    pub(crate) all_views: Option<Vec<View>>,
    pub(crate) dial: Option<(Dial, Instant)>,
    pub(crate) modes: Option<(Modes, Instant)>,
    pub(crate) dials: u64,
    /// As [`Self::all_views`].
    pub(crate) all_dials: Option<Vec<Dial>>,
    pub(crate) record: Option<Record>,
    /// Of a device that is being set up.
    pub(crate) reading: Option<Reading>,
    calibrated: Option<Calibrated>,
    /// The times of the last message sent and of the last greeting.
    said: Instant,
    greeted: Instant,
    /// A greeting that was heard.
    heard: Option<Hello>,
    /// It has greeted unasked: it was reset.
    is_anew: bool,
    bytes: u64,
    frames: u64,
    damaged: u64,
}

impl Device<Port> {
    /// Opens a serial port, such as `/dev/ttyACM0`, and greets the device there. The boards' own speed is 500,000 baud;
    /// over USB it does not matter.
    ///
    /// # Errors
    /// A port that does not open, or what [`Self::greet`] says.
    pub fn open(port: &str, baud: u32) -> Result<Self, Error> {
        Self::over(Port::open(port, baud)?)
    }
}

impl<L: Line> Device<L> {
    /// Greets the device at this line.
    ///
    /// # Errors
    /// As [`Self::greet`].
    pub fn over(line: L) -> Result<Self, Error> {
        let now = line.now();
        let mut device = Self {
            line,
            receiver: Receiver::new(),
            hello: Hello::default(),
            number: 0,
            answer: None,
            view: None,
            views: 0,
            all_views: None,
            dial: None,
            modes: None,
            dials: 0,
            all_dials: None,
            record: None,
            reading: None,
            calibrated: None,
            said: now,
            greeted: now,
            heard: None,
            is_anew: false,
            bytes: 0,
            frames: 0,
            damaged: 0,
        };
        device.greet()?;
        Ok(device)
    }

    /// Says hello, and waits for what the device says of itself. Needed again only after [`Error::BeganAnew`].
    ///
    /// # Errors
    /// A line that broke, a device that is silent or not understood, or one of another version.
    pub fn greet(&mut self) -> Result<Hello, Error> {
        (self.heard, self.view, self.answer, self.record) = (None, None, None, None);
        (self.dial, self.modes) = (None, None);
        let (began, bytes, frames) = (self.line.now(), self.bytes, self.frames);
        // What was cut off before ends here.
        self.send_bytes(&[DELIMITER])?;
        while self.since(began) < GREETS {
            self.greeted = self.line.now();
            self.send(&HostMessage::Hello { protocol: PROTOCOL })?;
            while self.since(self.greeted) < GREETS_EVERY {
                self.hear(LOOK)?;
                if let Some(hello) = self.heard.take() {
                    return self.meet(hello);
                }
            }
        }
        if self.frames > frames || self.bytes == bytes {
            return Err(Error::Silent { line: self.line.name(), waited: self.since(began) });
        }
        Err(Error::Garbled { line: self.line.name(), bytes: self.bytes - bytes })
    }

    fn meet(&mut self, hello: Hello) -> Result<Hello, Error> {
        if hello.protocol != PROTOCOL {
            return Err(Error::Protocol { line: self.line.name(), device: hello.protocol, host: PROTOCOL });
        }
        (self.hello, self.is_anew) = (hello, false);
        Ok(hello)
    }

    /// The device's answer to the greeting.
    pub const fn hello(&self) -> Hello {
        self.hello
    }

    /// Which calibration it uses since its last reset, as it says right after its hello; `None` of a device that cannot
    /// keep one.
    pub const fn calibrated(&self) -> Option<Calibrated> {
        self.calibrated
    }

    /// Records the CRC of the body stored in its flash.
    pub(crate) const fn set_kept(&mut self, crc: u32) {
        self.hello.kept = crc;
    }

    /// The line.
    pub const fn line(&mut self) -> &mut L {
        &mut self.line
    }

    /// The time by which the device is waited for: [`Line::now`].
    pub fn now(&self) -> Instant {
        self.line.now()
    }

    /// Damaged frames so far. Each was discarded; requests among them are repeated.
    pub const fn damaged(&self) -> u64 {
        self.damaged
    }

    /// Tells the device that this program runs, and reads the received messages.
    ///
    /// # Errors
    /// A line that broke; a device that was reset, or is in commissioning mode.
    pub fn tend(&mut self) -> Result<(), Error> {
        self.drain()?;
        self.usable()
    }

    /// Reads what has come, without waiting.
    pub(crate) fn drain(&mut self) -> Result<(), Error> {
        let began = self.bytes;
        while self.hear(Duration::ZERO)? > 0 && self.bytes - began < MOST as u64 {}
        Ok(())
    }

    /// Checks that the device accepts messages in this session.
    pub(crate) fn usable(&self) -> Result<(), Error> {
        if self.is_anew {
            return Err(Error::BeganAnew { line: self.line.name() });
        }
        if self.reading.is_some() {
            return Err(Error::SetUp { line: self.line.name() });
        }
        Ok(())
    }

    /// The device was reset, as its refusal shows.
    pub(crate) fn has_begun_anew(&mut self) -> Error {
        self.is_anew = true;
        Error::BeganAnew { line: self.line.name() }
    }

    pub(crate) fn since(&self, then: Instant) -> Duration {
        self.line.now().saturating_duration_since(then)
    }

    /// Goes on tending the line for a while.
    pub(crate) fn pause(&mut self, lasts: Duration) -> Result<(), Error> {
        let began = self.line.now();
        while self.since(began) < lasts {
            self.hear(LOOK)?;
        }
        Ok(())
    }

    /// Reads the line once, waiting for a moment at most; returns the number of bytes.
    pub(crate) fn hear(&mut self, wait: Duration) -> Result<usize, Error> {
        if self.since(self.said) >= ALIVE {
            self.send(&HostMessage::Alive)?;
        }
        let mut buffer = [0; 4096];
        let received = self.line.receive(&mut buffer, wait.min(LOOK));
        let came = received.map_err(|cause| Error::Line { line: self.line.name(), cause })?;
        self.bytes += came as u64;
        for byte in &buffer[..came] {
            match self.receiver.feed(*byte) {
                Some(Received::Message(told)) => self.take(told),
                Some(Received::Damaged) => self.damaged += 1,
                Some(Received::Empty) | None => {}
            }
        }
        Ok(came)
    }

    fn take(&mut self, told: DeviceMessage) {
        self.frames += 1;
        match told {
            DeviceMessage::Hello(hello) => {
                // An answer to a greeting comes at once; whoever says hello later has just begun.
                self.is_anew |= self.since(self.greeted) > GREETS_EVERY * 2;
                self.heard = Some(hello);
            }
            // Late answers to what was given up are nobody's.
            DeviceMessage::Answer(answer) if answer.number == self.number => self.answer = Some(answer),
            DeviceMessage::Answer(_) => {}
            DeviceMessage::View(view) => {
                self.view = Some((view, self.line.now()));
                self.views += 1;
                if let Some(all) = self.all_views.as_mut().filter(|all| all.len() < MOST) {
                    all.push(view);
                }
                self.reading = None;
            }
            DeviceMessage::Record(record) => {
                // The hello of one that was reset in the middle of a frame is lost in it; its ticks begin anew too.
                self.is_anew |= self.record.is_some_and(|last| (record.tick.wrapping_sub(last.tick) as i32) < 0);
                (self.record, self.reading) = (Some(record), None);
            }
            DeviceMessage::Reading(reading) => self.reading = Some(reading),
            DeviceMessage::Calibrated(calibrated) => self.calibrated = Some(calibrated),
            DeviceMessage::Dial(dial) => {
                self.dial = Some((dial, self.line.now()));
                self.dials += 1;
                if let Some(all) = self.all_dials.as_mut().filter(|all| all.len() < MOST) {
                    all.push(dial);
                }
            }
            DeviceMessage::Modes(modes) => self.modes = Some((modes, self.line.now())),
            // Of a device that is being set up: `palpate commission` reads them.
            DeviceMessage::Marked(_) => {}
        }
    }

    /// Says something.
    pub(crate) fn send(&mut self, command: &HostMessage) -> Result<(), Error> {
        let mut buffer = [0; MAX_FRAME];
        // Any command fits; one that did not would not be answered, and that is said.
        let Ok(frame) = frame::pack(command, &mut buffer) else { return Ok(()) };
        self.send_bytes(frame)
    }

    fn send_bytes(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.line.send(bytes).map_err(|cause| Error::Line { line: self.line.name(), cause })?;
        self.said = self.line.now();
        Ok(())
    }
}
