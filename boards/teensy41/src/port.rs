//! The serial port, byte by byte.

use palpate_bench::Port;
use teensy4_bsp::board::Lpuart;

/// 8 MHz / 16, exactly. Of 921,600 baud its clock makes 888,889: too far off to be understood.
pub const BAUD: u32 = 500_000;

/// The port.
pub struct Uart(pub Lpuart);

impl Port for Uart {
    #[inline]
    fn send(&mut self, byte: u8) -> bool {
        self.0.try_write(byte)
    }

    #[inline]
    fn receive(&mut self) -> Option<u8> {
        // A damaged byte is none; the frame that it belonged to will not match its checksum.
        self.0.try_read().ok().flatten()
    }
}
