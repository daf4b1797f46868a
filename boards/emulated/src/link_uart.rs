//! The board's UART: the real link.

use palpate::wire::{
    Sensors,
    frame::{Received, Receiver},
};
use vcell::VolatileCell;

use crate::board::Board;
use crate::link::Link;

/// How often the line is looked at before the host is given up for this tick.
///
/// A real device waits one servo period. In the emulator the host's answer takes about a millisecond of the host's own
/// time, whatever the emulated clock says, and much longer on a busy machine: this is about one and a half seconds.
const POLLS: u32 = 4_000_000;

/// The registers of an APB UART (Arm CMSDK technical reference, "APB UART").
#[repr(C)]
struct Registers {
    data: VolatileCell<u32>,
    state: VolatileCell<u32>,
    control: VolatileCell<u32>,
    interrupt: VolatileCell<u32>,
    divider: VolatileCell<u32>,
}

const TRANSMIT_FULL: u32 = 1;
const RECEIVE_FULL: u32 = 1 << 1;
const ENABLE_BOTH: u32 = 3;
/// The emulator takes any; the board's clock comes near enough, and 16 is the least divider that the hardware takes.
const BAUD: u32 = 921_600;

/// Frames over the UART.
pub struct UartLink {
    registers: &'static Registers,
    receiver: Receiver<Sensors>,
}

impl UartLink {
    /// Switches the UART on. Make one only: two would steal each other's bytes.
    pub fn new(board: &Board) -> Self {
        // SAFETY: the address is the chip's, the block is there for good, and a
        // `VolatileCell` may be shared.
        let registers = unsafe { &*(board.uart as *const Registers) };
        registers.divider.set(board.clock / BAUD);
        registers.control.set(ENABLE_BOTH);
        Self { registers, receiver: Receiver::new() }
    }
}

impl Link for UartLink {
    fn receive(&mut self) -> Option<Received<Sensors>> {
        for _ in 0..POLLS {
            if self.registers.state.get() & RECEIVE_FULL == 0 {
                continue;
            }
            let received = self.receiver.feed(self.registers.data.get() as u8);
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
                if self.registers.state.get() & TRANSMIT_FULL == 0 {
                    self.registers.data.set(u32::from(*byte));
                    break;
                }
            }
        }
    }
}
