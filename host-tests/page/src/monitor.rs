//! A device's own telemetry, frame by frame, as `palpate monitor` reads it.

use alloc::vec::Vec;
use palpate::wire::frame::{DELIMITER, Received, Receiver};
use palpate::wire::{Record, Told};

/// What has come so far.
pub struct Monitor {
    receiver: Receiver<Told>,
    /// Whether a frame has ended on the line: what comes before may be the rest of one.
    in_step: bool,
    /// Whole records.
    pub records: u32,
    /// Frames that are none.
    pub damaged: u32,
    last: Option<Record>,
}

impl Monitor {
    /// Before the first byte.
    pub const fn new() -> Self {
        Self { receiver: Receiver::new(), in_step: false, records: 0, damaged: 0, last: None }
    }

    /// Takes bytes as they come.
    pub fn feed(&mut self, bytes: &[u8]) {
        for byte in bytes {
            if !self.in_step {
                self.in_step = *byte == DELIMITER;
                continue;
            }
            match self.receiver.feed(*byte) {
                Some(Received::Message(Told::Record(record))) => {
                    self.records += 1;
                    self.last = Some(record);
                }
                Some(Received::Damaged) => self.damaged += 1,
                Some(Received::Empty | Received::Message(_)) | None => {}
            }
        }
    }

    /// The last record: tick, phase, fault, mode, contact, feature, gap, probe, force, and what a tick took and its
    /// period at most, seconds. Nothing before the first.
    pub fn view(&self, out: &mut Vec<f32>) {
        out.clear();
        let Some(record) = &self.last else { return };
        let clock = record.clock.max(1) as f32;
        out.extend([
            record.tick as f32,
            f32::from(record.phase),
            f32::from(record.fault),
            f32::from(record.mode),
            f32::from(record.contact),
            f32::from(record.feature),
            record.gap,
        ]);
        out.extend(record.probe);
        out.extend(record.force);
        out.extend([record.took as f32 / clock, record.longest as f32 / clock]);
    }
}
