//! What runs below the tick: main's loop.

use crate::Mailbox;
use palpate::servo::Heartbeat;
use palpate::wire::frame::{self, MAX_FRAME, Received, Receiver};
use palpate::wire::telemetry::Consumer;
use palpate::wire::{Command, Record};

/// A serial port that is never waited for.
pub trait Port {
    /// Sends a byte; false if there is no room for it now.
    fn send(&mut self, byte: u8) -> bool;

    /// A byte that came.
    fn receive(&mut self) -> Option<u8>;
}

/// The hardware's watchdog.
pub trait Watchdog {
    /// Feeds it.
    fn feed(&mut self);
}

/// Feeds the watchdog while ticks go on, sends records, takes commands.
pub struct Idle<'a> {
    mailbox: &'a Mailbox,
    records: Consumer<'a, Record>,
    heartbeat: Heartbeat,
    receiver: Receiver<Command>,
    buffer: [u8; MAX_FRAME],
    /// What of the buffer is still to be sent.
    left: core::ops::Range<usize>,
}

impl<'a> Idle<'a> {
    /// The other end of the loop's queue and mailbox.
    pub const fn new(mailbox: &'a Mailbox, records: Consumer<'a, Record>, heartbeat: Heartbeat) -> Self {
        let receiver = Receiver::new();
        Self { mailbox, records, heartbeat, receiver, buffer: [0; MAX_FRAME], left: 0..0 }
    }

    /// A moment of it: at most a byte each way. Call it for ever.
    pub fn step(&mut self, port: &mut impl Port, watchdog: &mut impl Watchdog) {
        if self.heartbeat.may_feed(self.mailbox.ticks()) {
            watchdog.feed();
        }
        if let Some(byte) = port.receive()
            && let Some(Received::Message(command)) = self.receiver.feed(byte)
        {
            self.mailbox.put(command);
        }
        if self.left.is_empty() {
            let Some(record) = self.records.dequeue() else { return };
            let length = frame::pack(&record, &mut self.buffer).map_or(0, |frame| frame.len());
            self.left = 0..length;
        }
        if let Some(byte) = self.buffer.get(self.left.start)
            && port.send(*byte)
        {
            self.left.start += 1;
        }
    }
}
