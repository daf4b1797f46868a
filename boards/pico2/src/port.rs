//! The serial port, byte by byte, and the watchdog.

use palpate_bench::{Port, Watchdog};
use rp235x_hal::fugit::ExtU32;
use rp235x_hal::pac::{PSM, UART0, WATCHDOG};
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

/// The stages that the watchdog resets: every stage of the start ("PSM: WDSEL") but the two oscillators. Pads go to
/// their reset state with the peripherals; were the core's supply switched instead, they would hold their levels.
const RESETS: u32 = 0x01ff_ffff & !(0b11 << 2);

/// The chip's watchdog.
pub struct ChipWatchdog(rp235x_hal::Watchdog);

impl ChipWatchdog {
    /// Starts it, for 20 ms.
    pub fn start(mut watchdog: rp235x_hal::Watchdog) -> Self {
        watchdog.start(20.millis());
        // SAFETY: two registers that nobody else uses by now.
        unsafe {
            // The HAL's choice is an RP2040's: this chip has more stages, the processors after those.
            (*PSM::ptr()).wdsel().write(|w| w.bits(RESETS));
            // A breakpoint is a program that hangs while its motors turn. By the HAL the watchdog would wait for it.
            (*WATCHDOG::ptr())
                .ctrl()
                .modify(|_, w| w.pause_dbg0().clear_bit().pause_dbg1().clear_bit().pause_jtag().clear_bit());
        }
        Self(watchdog)
    }
}

impl Watchdog for ChipWatchdog {
    #[inline]
    fn feed(&mut self) {
        self.0.feed();
    }
}
