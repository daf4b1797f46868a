//! The serial port, byte by byte, and the watchdog.

use palpate_bench::{Port, Watchdog};
use rp235x_hal::pac::UART0;
use rp235x_hal::uart::{Enabled, UartPeripheral, ValidUartPinout};

/// The port.
pub struct Uart<P: ValidUartPinout<UART0>>(pub UartPeripheral<Enabled, UART0, P>);

impl<P: ValidUartPinout<UART0>> Port for Uart<P> {
    #[inline]
    fn send(&mut self, byte: u8) -> bool {
        self.0.uart_is_writable() && self.0.write_raw(&[byte]).is_ok()
    }

    #[inline]
    fn receive(&mut self) -> Option<u8> {
        let mut byte = [0];
        // A damaged byte is none; the frame that it belonged to will not match its checksum.
        let has_come = self.0.uart_is_readable() && self.0.read_raw(&mut byte).is_ok();
        has_come.then_some(byte[0])
    }
}

/// The chip's watchdog.
pub struct Bowl(pub rp235x_hal::Watchdog);

impl Watchdog for Bowl {
    #[inline]
    fn feed(&mut self) {
        self.0.feed();
    }
}
