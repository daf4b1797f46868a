//! The board's UART: the real link.

use crate::board::Board;
use crate::link::{Frame, Link};
pub use crate::processor::Uart;
use palpate::wire::frame::{Received, Receiver};
use palpate_bench::Port;

/// How often the line is looked at before the host is given up for this tick.
///
/// A real device waits one servo period. In the emulator the host's answer takes about a millisecond of the host's own
/// time, whatever the emulated clock says, and much longer on a busy machine: this is about one and a half seconds.
const POLLS: u32 = 4_000_000;

/// Frames over the UART.
pub struct UartLink {
    uart: Uart,
    receiver: Receiver<Frame>,
}

impl UartLink {
    /// Switches the UART on.
    pub fn new(board: &Board) -> Self {
        Self { uart: Uart::new(board), receiver: Receiver::new() }
    }
}

impl Link for UartLink {
    fn receive(&mut self) -> Option<Received<Frame>> {
        for _ in 0..POLLS {
            let Some(byte) = self.uart.receive() else { continue };
            let received = self.receiver.feed(byte);
            if received.is_some() {
                return received;
            }
        }
        None
    }

    fn send(&mut self, frame: &[u8]) {
        for byte in frame {
            // A line that takes nothing loses this byte, and the host finds the frame damaged.
            for _ in 0..POLLS {
                if self.uart.send(*byte) {
                    break;
                }
            }
        }
    }
}
