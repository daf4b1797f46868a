//! The serial port, byte by byte, and the watchdog.

use palpate_bench::{Port, Watchdog};
use stm32g4xx_hal::gpio::{AF7, PA2, PA3};
use stm32g4xx_hal::independent_watchdog::IndependentWatchdog;
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::serial::{FullConfig, Serial};
use stm32g4xx_hal::stm32::USART2;

/// The port of the board's own USB, 500,000 baud: 170 MHz / 340.
pub struct Usart(Serial<USART2, PA2<AF7>, PA3<AF7>>);

/// Opens it.
///
/// # Panics
/// If the clock could not make the rate: it can.
pub fn open(port: USART2, out: PA2<AF7>, back: PA3<AF7>, rcc: &mut Rcc) -> Usart {
    let Ok(serial) = port.usart(out, back, FullConfig::default().baudrate(500_000.bps()), rcc) else {
        panic!("170 MHz make 500,000 baud")
    };
    Usart(serial)
}

impl Port for Usart {
    #[inline]
    fn send(&mut self, byte: u8) -> bool {
        let Self(_) = self;
        // SAFETY: nobody else uses the registers of the port that this owns.
        let port = unsafe { &*USART2::ptr() };
        let is_free = port.isr().read().txe().bit_is_set();
        if is_free {
            // SAFETY: nine bits, of which eight are used.
            port.tdr().write(|w| unsafe { w.tdr().bits(u16::from(byte)) });
        }
        is_free
    }

    #[inline]
    fn receive(&mut self) -> Option<u8> {
        // SAFETY: as above.
        let port = unsafe { &*USART2::ptr() };
        // A byte that nobody took in time keeps all later ones out until this.
        port.icr().write(|w| w.orecf().clear_bit_by_one());
        let has_come = port.isr().read().rxne().bit_is_set();
        has_come.then(|| port.rdr().read().rdr().bits() as u8)
    }
}

/// The independent watchdog.
pub struct Bowl(pub IndependentWatchdog);

impl Watchdog for Bowl {
    #[inline]
    fn feed(&mut self) {
        self.0.feed();
    }
}
