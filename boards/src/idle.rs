//! Main's loop, below the tick.

use crate::calibrations::Calibrating;
use crate::feels::FeelKeeping;
use crate::mailbox::Plain;
use crate::outbox::Outbox;
use crate::taking::Taking;
use crate::{Calibrations, Feels, Mailbox, Uploads};
use palpate::servo::Heartbeat;
use palpate::wire::frame::{Received, Receiver};
use palpate::wire::telemetry::Consumer;
use palpate::wire::{Answer, DeviceMessage, Dial, Hello, HostMessage, PROTOCOL, Record, Refused};

/// A serial port that is never waited for.
pub trait Port {
    /// Sends a byte; false if the buffer is full.
    fn send(&mut self, byte: u8) -> bool;

    /// A byte that came.
    fn receive(&mut self) -> Option<u8>;
}

/// How often the watchdog of a loop of `rate` Hz is fed: at least 2 ms apart, twice [`WINDOW_MS`], at any rate.
pub const fn heartbeat(rate: f32) -> Heartbeat {
    let ticks = 0.002 * rate;
    // The casts saturate, and take NaN for 0.
    let whole = ticks as u32;
    Heartbeat::every(if (whole as f32) < ticks { whole.saturating_add(1) } else { whole })
}

/// Time within which a watchdog with a window must not be fed again, ms: its own oscillator is up to a tenth off, and
/// main feeds it after the tick by as long as a turn takes.
pub const WINDOW_MS: u32 = 1;

/// The hardware's watchdog.
pub trait Watchdog {
    /// Feeds it.
    fn feed(&mut self);
}

/// Memory that a board offers to its host.
pub trait Offers {
    /// The same loop with that memory.
    fn offer<'a>(&'a self, idle: Idle<'a>) -> Idle<'a>;
}

/// None.
impl Offers for () {
    fn offer<'a>(&'a self, idle: Idle<'a>) -> Idle<'a> {
        idle
    }
}

/// RAM for bodies.
impl<U: Uploads> Offers for Option<U> {
    fn offer<'a>(&'a self, idle: Idle<'a>) -> Idle<'a> {
        match self {
            Some(memory) => idle.taking(memory),
            None => idle,
        }
    }
}

/// Feeds the watchdog while ticks go on, sends telemetry, takes commands.
pub struct Idle<'a> {
    mailbox: &'a Mailbox,
    records: Consumer<'a, Record>,
    heartbeat: Heartbeat,
    receiver: Receiver<HostMessage>,
    outbox: Outbox,
    taking: Taking<'a>,
    calibrating: Calibrating<'a>,
    feels: FeelKeeping<'a>,
    /// The device's own description.
    hello: Hello,
    /// Whether that is still to be sent.
    greets: bool,
    /// And how it is calibrated.
    tells_calibration: bool,
    /// Whether a host of this version has said hello.
    is_greeted: bool,
    /// The number of an order that is on its way through the tick, which answers it.
    awaits: Option<u16>,
    /// The answer to the last order: one that comes again, because this was lost, is not done again.
    last: Option<Answer>,
    /// An answer that is still to be given. A host that does not wait for it loses it to the next.
    answer: Option<Answer>,
}

impl<'a> Idle<'a> {
    /// The other end of the loop's queue and mailbox.
    pub const fn new(mailbox: &'a Mailbox, records: Consumer<'a, Record>, heartbeat: Heartbeat) -> Self {
        Self {
            mailbox,
            records,
            heartbeat,
            receiver: Receiver::new(),
            outbox: Outbox::new(),
            taking: Taking::nothing(),
            calibrating: Calibrating::nothing(),
            feels: FeelKeeping::nothing(),
            hello: Hello {
                protocol: PROTOCOL,
                rate: 0.0,
                max_force: 0.0,
                room: 0,
                faces: 0,
                edges: 0,
                flash: 0,
                kept: 0,
            },
            greets: true,
            tells_calibration: false,
            is_greeted: false,
            awaits: None,
            last: None,
            answer: None,
        }
    }

    /// Reports the loop's rate (Hz) and its maximum force (N; 0 of a knob, which has a torque).
    #[must_use]
    pub const fn saying(mut self, rate: f32, max_force: f32) -> Self {
        (self.hello.rate, self.hello.max_force) = (rate, max_force);
        self.taking.wait_at(rate);
        self
    }

    /// Takes bodies that come over the line.
    #[must_use]
    pub fn taking(mut self, uploads: &'a dyn Uploads) -> Self {
        (self.hello.room, self.hello.faces, self.hello.edges) = uploads.room();
        self.taking.memory = Some(uploads);
        self
    }

    /// Keeps bodies in flash. Reported faces and edges are the minimum of this and of [`Self::taking`]'s.
    #[must_use]
    pub fn keeping(mut self, flash: &'a dyn Uploads) -> Self {
        let (bytes, faces, edges) = flash.room();
        self.hello.flash = bytes;
        if self.hello.room == 0 {
            (self.hello.faces, self.hello.edges) = (faces, edges);
        } else {
            (self.hello.faces, self.hello.edges) = (self.hello.faces.min(faces), self.hello.edges.min(edges));
        }
        self.taking.flash = Some(flash);
        self
    }

    /// Keeps a calibration in flash.
    #[must_use]
    pub const fn calibrating(mut self, flash: &'a dyn Calibrations) -> Self {
        self.calibrating.flash = Some(flash);
        self
    }

    /// Keeps a knob's feel in flash.
    #[must_use]
    pub const fn keeping_feels(mut self, flash: &'a dyn Feels) -> Self {
        self.feels.flash = Some(flash);
        self
    }

    /// One step: at most a byte each way. Call it continuously.
    // Inlined into main's loop, the compiler unrolls it there to four times its 19 KB.
    #[inline(never)]
    pub fn step(&mut self, port: &mut impl Port, watchdog: &mut impl Watchdog) {
        feed(&mut self.heartbeat, self.mailbox, watchdog);
        if self.awaits.is_some()
            && let Some(answer) = self.mailbox.take_answer()
        {
            (self.awaits, self.last, self.answer) = (None, Some(answer), Some(answer));
        }
        if let Some(answer) = self.taking.wait(self.mailbox, &mut || feed(&mut self.heartbeat, self.mailbox, watchdog))
        {
            self.answer = Some(answer);
        }
        if let Some(answer) = self.calibrating.wait(self.mailbox) {
            self.answer = Some(answer);
        }
        if let Some(answer) = self.feels.wait(self.mailbox) {
            self.answer = Some(answer);
        }
        if let Some(byte) = port.receive()
            && let Some(Received::Message(command)) = self.receiver.feed(byte)
        {
            self.take(command, watchdog);
        }
        if self.outbox.is_empty() {
            match self.next() {
                Some(told) => self.outbox.put(&told),
                None => return,
            }
        }
        self.outbox.step(port);
    }

    fn take(&mut self, command: HostMessage, watchdog: &mut impl Watchdog) {
        match command {
            // A host that was not understood may stop the device, and nothing else.
            HostMessage::Alive | HostMessage::Acknowledge | HostMessage::SetUp | HostMessage::Jog(_)
                if !self.is_greeted => {}
            HostMessage::Alive => self.mailbox.put(Plain::Alive),
            HostMessage::Stop => self.mailbox.put(Plain::Stop),
            // Repeated until a person has confirmed it.
            HostMessage::Acknowledge => self.mailbox.put_both(Plain::Alive, Plain::Acknowledge),
            HostMessage::SetUp => self.mailbox.put_both(Plain::Alive, Plain::SetUp),
            HostMessage::Jog(jog) => self.mailbox.put_jog(jog),
            HostMessage::Hello { protocol } => {
                // Another host counts from the start.
                (self.greets, self.is_greeted, self.last) = (true, protocol == PROTOCOL, None);
                self.calibrating.forget_answer();
                self.feels.forget_answer();
                if self.is_greeted {
                    self.mailbox.put(Plain::Alive);
                }
            }
            HostMessage::Command { number, .. }
            | HostMessage::Upload { number, .. }
            | HostMessage::Calibrate { number, .. }
            | HostMessage::KeepFeel { number, .. }
                if !self.is_greeted =>
            {
                self.answer = Some(Answer { number, refused: Some(Refused::Hello) });
            }
            HostMessage::Command { number, .. } if self.awaits == Some(number) => {}
            HostMessage::Command { number, .. } if self.awaits.is_some() => {
                self.answer = Some(Answer { number, refused: Some(Refused::Busy) });
            }
            HostMessage::Command { number, .. } if self.last.is_some_and(|last| last.number == number) => {
                self.answer = self.last;
            }
            HostMessage::Command { number, command } => {
                self.mailbox.put(Plain::Alive);
                self.mailbox.put_order(number, &command);
                self.awaits = Some(number);
            }
            // On its way: not again.
            HostMessage::KeepFeel { .. } if self.feels.is_asked() => {}
            HostMessage::Calibrate { number, .. } | HostMessage::Upload { number, .. } if self.feels.is_asked() => {
                self.answer = Some(Answer { number, refused: Some(Refused::Busy) });
            }
            HostMessage::KeepFeel { number, keeps } => {
                self.mailbox.put(Plain::Alive);
                let answer = self.feels.take(number, keeps, self.mailbox);
                if answer.is_some() {
                    self.answer = answer;
                }
            }
            // On its way, or done before: not again.
            HostMessage::Calibrate { .. } if self.calibrating.is_asked() => {}
            HostMessage::Calibrate { number, .. } if self.calibrating.answered(number).is_some() => {
                self.answer = self.calibrating.answered(number);
            }
            HostMessage::Calibrate { number, joints } => {
                self.mailbox.put(Plain::Alive);
                let answer = self.calibrating.take((number, joints), self.mailbox);
                if answer.is_some() {
                    self.answer = answer;
                }
            }
            HostMessage::Upload { number, .. } if self.calibrating.is_asked() => {
                self.answer = Some(Answer { number, refused: Some(Refused::Busy) });
            }
            HostMessage::Upload { number, part } => {
                self.mailbox.put(Plain::Alive);
                let mut pause = || feed(&mut self.heartbeat, self.mailbox, watchdog);
                let answer = self.taking.take(number, &part, self.mailbox, &mut pause);
                // A check may have taken long: the host was heard all the same.
                self.mailbox.put(Plain::Alive);
                if answer.is_some() {
                    self.answer = answer;
                }
            }
        }
    }

    /// The next message: answers first, records in their order, then the newest reading or view.
    fn next(&mut self) -> Option<DeviceMessage> {
        if self.greets {
            (self.greets, self.tells_calibration) = (false, true);
            self.hello.kept = self.taking.kept();
            return Some(DeviceMessage::Hello(self.hello));
        }
        if self.tells_calibration {
            self.tells_calibration = false;
            if let Some(flash) = self.calibrating.flash {
                return Some(DeviceMessage::Calibrated(flash.in_use()));
            }
        }
        if let Some(answer) = self.answer.take() {
            return Some(DeviceMessage::Answer(answer));
        }
        if let Some(record) = self.records.dequeue() {
            return Some(DeviceMessage::Record(record));
        }
        if let Some(marked) = self.mailbox.take_marked() {
            return Some(DeviceMessage::Marked(marked));
        }
        if let Some(reading) = self.mailbox.take_reading() {
            return Some(DeviceMessage::Reading(reading));
        }
        if let Some(dial) = self.mailbox.take_dial().filter(|_| self.is_greeted) {
            return Some(DeviceMessage::Dial(Dial { kept: self.feels.kept() as u8, ..dial }));
        }
        if let Some(modes) = self.mailbox.take_modes().filter(|_| self.is_greeted) {
            return Some(DeviceMessage::Modes(modes));
        }
        let view = self.mailbox.take_view();
        if self.is_greeted {
            self.mailbox.look();
        }
        view.map(DeviceMessage::View)
    }
}

/// Feeds the watchdog while ticks go on.
fn feed(heartbeat: &mut Heartbeat, mailbox: &Mailbox, watchdog: &mut impl Watchdog) {
    if heartbeat.may_feed(mailbox.ticks()) {
        watchdog.feed();
    }
}
