//! Two FIFOs of the host, read and written through the emulator's semihosting: the fast link, for long runs.
//!
//! The emulated clock stands still while the host thinks, so there is no waiting time to bound: a host that does not
//! answer a tick sends an empty frame, and one that is gone leaves an end of file.

use palpate::wire::frame::{MAX_FRAME, Received, Receiver};
use semihosting::fs::{File, OpenOptions};
use semihosting::io::{Read, Write};

use crate::link::{Frame, Link};

/// A read that gives nothing is an end of file, or one that a signal cut short in the emulator; only the end of file
/// comes this often in a row.
const EMPTY_READS: u32 = 16;

/// Frames over the FIFOs `to-device` and `from-device` in the folder where the emulator was started.
pub struct FifoLink {
    to_device: File,
    from_device: File,
    receiver: Receiver<Frame>,
    /// Bytes read ahead: those from `next` to `end` are still to be taken.
    buffer: [u8; MAX_FRAME],
    next: usize,
    end: usize,
}

impl FifoLink {
    /// Opens both FIFOs.
    ///
    /// # Panics
    /// If they are not there: without a host there is nothing to do.
    pub fn open() -> Self {
        Self {
            to_device: File::open(c"to-device").expect("the host makes the FIFO to-device"),
            from_device: OpenOptions::new()
                .write(true)
                .create(true)
                .truncate(true)
                .open(c"from-device")
                .expect("the host makes the FIFO from-device"),
            receiver: Receiver::new(),
            buffer: [0; MAX_FRAME],
            next: 0,
            end: 0,
        }
    }

    /// The next byte, or `None` at the end of file.
    fn read(&mut self) -> Option<u8> {
        if self.next >= self.end {
            // Emptied first: at the end of file nothing old may be taken for new.
            (self.next, self.end) = (0, 0);
            self.end = (0..EMPTY_READS).find_map(|_| self.read_some())?;
        }
        let byte = self.buffer.get(self.next).copied();
        self.next += 1;
        byte
    }

    fn read_some(&mut self) -> Option<usize> {
        self.to_device.read(&mut self.buffer).ok().filter(|read| *read > 0)
    }
}

impl Link for FifoLink {
    fn receive(&mut self) -> Option<Received<Frame>> {
        // A frame that does not end is damaged already; the bound only keeps a stream of rubbish from holding the loop.
        for _ in 0..16 * MAX_FRAME {
            let byte = self.read()?;
            let received = self.receiver.feed(byte);
            if received.is_some() {
                return received;
            }
        }
        None
    }

    fn send(&mut self, frame: &[u8]) {
        // A host that is gone is found out by the next read.
        let _ = self.from_device.write_all(frame);
    }
}
