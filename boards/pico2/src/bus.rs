//! The sensors' bus (SPI0), as the HAL set it up: frames of 8 bits.

use palpate_bench::sensors::Controller;
use rp235x_hal::pac::SPI0;

/// Looks at the controller, of four cycles or more: a byte takes 1 µs.
const LOOKS: u32 = 500;
/// Capacity of its buffer ("SPI: PL022").
const BYTES: u32 = 8;

/// The controller, which runs.
pub struct Spi(pub SPI0);

impl Spi {
    fn received(&mut self) -> Option<u8> {
        self.0.sspsr().read().rne().bit_is_set().then(|| self.0.sspdr().read().data().bits() as u8)
    }
}

impl Controller for Spi {
    #[inline]
    fn exchange(&mut self, frame: [u8; 2]) -> Option<[u8; 2]> {
        // A frame that was given up may have come since.
        let _ = (0..BYTES).any(|_| self.received().is_none());
        for byte in frame {
            // SAFETY: 16 bits, of which eight are used.
            self.0.sspdr().write(|w| unsafe { w.data().bits(u16::from(byte)) });
        }
        let mut answer = [0; 2];
        for byte in &mut answer {
            *byte = (0..LOOKS).find_map(|_| self.received())?;
        }
        Some(answer)
    }
}
