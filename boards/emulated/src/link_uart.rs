//! The board's UART: the real link.

use palpate::wire::{
    Sensors,
    frame::{Received, Receiver},
};
use palpate_bench::Port;
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
/// The emulator takes any; the board's clock comes near enough, and 16 is the minimum divider of the hardware.
const BAUD: u32 = 921_600;

/// The UART, byte by byte.
pub struct Uart(&'static Registers);

impl Uart {
    /// Switches it on. Make one only: two would steal each other's bytes.
    pub fn new(board: &Board) -> Self {
        // SAFETY: the address is the chip's, the block is there for good, and a
        // `VolatileCell` may be shared.
        let registers = unsafe { &*(board.uart as *const Registers) };
        registers.divider.set(board.clock / BAUD);
        registers.control.set(ENABLE_BOTH);
        Self(registers)
    }
}

impl Port for Uart {
    #[inline]
    fn send(&mut self, byte: u8) -> bool {
        let is_free = self.0.state.get() & TRANSMIT_FULL == 0;
        if is_free {
            self.0.data.set(u32::from(byte));
        }
        is_free
    }

    #[inline]
    fn receive(&mut self) -> Option<u8> {
        (self.0.state.get() & RECEIVE_FULL != 0).then(|| self.0.data.get() as u8)
    }
}

/// Frames over the UART.
pub struct UartLink {
    uart: Uart,
    receiver: Receiver<Sensors>,
}

impl UartLink {
    /// Switches the UART on.
    pub fn new(board: &Board) -> Self {
        Self { uart: Uart::new(board), receiver: Receiver::new() }
    }
}

impl Link for UartLink {
    fn receive(&mut self) -> Option<Received<Sensors>> {
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
