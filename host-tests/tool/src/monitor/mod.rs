//! Monitor of a running device: turns the bytes of its line into readable figures.

mod figures;
mod table;

pub use figures::Figures;
pub use table::Table;

use palpate::wire::frame::{DELIMITER, Received, Receiver};
use palpate::wire::{DeviceMessage, Record};

/// Extracts the records from the bytes of a line and counts the damaged and the lost ones.
#[derive(Debug, Default)]
pub struct Monitor {
    receiver: Receiver<DeviceMessage>,
    /// Whether a delimiter was seen; the bytes before it are the rest of a frame whose start was missed.
    in_step: bool,
    last: Option<Record>,
    /// Received records.
    pub records: u64,
    /// Damaged frames.
    pub damaged: u64,
    /// Records that were sent but not received, including the damaged ones.
    pub lost: u64,
    /// Number of resets of the device.
    pub resets: u64,
}

impl Monitor {
    /// Takes the next byte; the last byte of a record completes its figures.
    pub fn feed(&mut self, byte: u8) -> Option<Figures> {
        if !self.in_step {
            self.in_step = byte == DELIMITER;
            return None;
        }
        match self.receiver.feed(byte)? {
            Received::Message(DeviceMessage::Record(record)) => Some(self.take(record)),
            Received::Message(_) => None,
            Received::Damaged => {
                self.damaged += 1;
                None
            }
            Received::Empty => None,
        }
    }

    fn take(&mut self, record: Record) -> Figures {
        self.records += 1;
        // After a reset the numbers start again, so that no difference to the previous record makes sense.
        let last = self.last.replace(record).filter(|last| {
            let goes_on = record.number > last.number && record.tick >= last.tick;
            self.resets += u64::from(!goes_on);
            goes_on
        });
        if let Some(last) = &last {
            self.lost += u64::from(record.number - last.number - 1);
        }
        Figures::new(record, last.as_ref())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate::wire::frame::{MAX_FRAME, pack};

    fn record(number: u32) -> Record {
        Record {
            tick: number * 40,
            number,
            clock: 1_000_000,
            began: number.wrapping_mul(10_000).wrapping_sub(25_000),
            ..Record::default()
        }
    }

    fn frame(record: &Record) -> Vec<u8> {
        pack(&DeviceMessage::Record(*record), &mut [0; MAX_FRAME]).unwrap().to_vec()
    }

    #[test]
    fn a_line_joined_in_the_middle_of_a_frame_is_not_damaged() {
        let mut monitor = Monitor::default();
        let line: Vec<u8> = (0..6).flat_map(|number| frame(&record(number))).collect();
        let figures: Vec<Figures> = line[7..].iter().filter_map(|byte| monitor.feed(*byte)).collect();
        assert_eq!(figures.len(), 5);
        assert_eq!((monitor.records, monitor.damaged, monitor.lost, monitor.resets), (5, 0, 0, 0));
        // 40 ticks in 10 ms, over the counter's wrap too.
        assert_eq!(figures[0].rate, None);
        assert!(figures[1..].iter().all(|figures| figures.rate == Some(4_000.0)), "{figures:?}");
    }

    #[test]
    fn damaged_and_missing_records_are_counted_and_the_rate_is_right_all_the_same() {
        let mut monitor = Monitor::default();
        monitor.feed(DELIMITER);
        let mut rates = Vec::new();
        for number in 0..100 {
            let mut bytes = frame(&record(number));
            match number % 10 {
                3 => bytes.clear(),
                7 => bytes[2] ^= 0x10,
                _ => {}
            }
            rates.extend(bytes.iter().filter_map(|byte| monitor.feed(*byte)).map(|figures| figures.rate));
        }
        assert_eq!((monitor.records, monitor.damaged, monitor.lost, monitor.resets), (80, 10, 20, 0));
        assert!(rates[1..].iter().all(|rate| *rate == Some(4_000.0)), "{rates:?}");
    }

    #[test]
    fn a_device_that_begins_anew_is_noticed() {
        let mut monitor = Monitor::default();
        monitor.feed(DELIMITER);
        let numbers = [5, 6, 0, 1];
        let line: Vec<u8> = numbers.iter().flat_map(|number| frame(&record(*number))).collect();
        let rates: Vec<_> = line.iter().filter_map(|byte| monitor.feed(*byte)).map(|figures| figures.rate).collect();
        assert_eq!(rates, [None, Some(4_000.0), None, Some(4_000.0)]);
        assert_eq!((monitor.resets, monitor.lost), (1, 0));
    }
}
