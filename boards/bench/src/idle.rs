//! What runs below the tick: main's loop.

use crate::Mailbox;
use crate::outbox::Outbox;
use palpate::servo::Heartbeat;
use palpate::wire::frame::{Received, Receiver};
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

/// Feeds the watchdog while ticks go on, sends records or readings, takes commands.
pub struct Idle<'a> {
    mailbox: &'a Mailbox,
    records: Consumer<'a, Record>,
    heartbeat: Heartbeat,
    receiver: Receiver<Command>,
    outbox: Outbox,
}

impl<'a> Idle<'a> {
    /// The other end of the loop's queue and mailbox.
    pub const fn new(mailbox: &'a Mailbox, records: Consumer<'a, Record>, heartbeat: Heartbeat) -> Self {
        Self { mailbox, records, heartbeat, receiver: Receiver::new(), outbox: Outbox::new() }
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
        if self.outbox.is_empty() {
            // Records in their order, then the newest reading.
            if let Some(record) = self.records.dequeue() {
                self.outbox.put(&record);
            } else if let Some(reading) = self.mailbox.take_reading() {
                self.outbox.put(&reading);
            } else {
                return;
            }
        }
        self.outbox.step(port);
    }
}
