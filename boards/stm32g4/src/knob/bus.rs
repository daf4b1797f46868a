//! The sensor's bus (SPI1), as the HAL set it up: frames of 8 bits, two of them packed into a half-word.

use palpate_bench::sensors::Controller;
use stm32g4xx_hal::stm32::SPI1;

/// Looks at the controller, of five cycles or more: a frame takes 3 µs.
const LOOKS: u32 = 500;
/// Capacity of its buffer.
const BYTES: u32 = 4;

/// The controller, which runs.
pub struct Spi(pub SPI1);

impl Spi {
    fn received(&mut self) -> Option<u8> {
        self.0.sr().read().rxne().bit_is_set().then(|| {
            // SAFETY: the data register, of which a byte is a frame.
            unsafe { self.0.dr().as_ptr().cast::<u8>().read_volatile() }
        })
    }
}

impl Controller for Spi {
    #[inline]
    fn exchange(&mut self, frame: [u8; 2]) -> Option<[u8; 2]> {
        // A frame that was given up may have come since.
        let _ = (0..BYTES).any(|_| self.received().is_none());
        for byte in frame {
            // SAFETY: as above.
            unsafe { self.0.dr().as_ptr().cast::<u8>().write_volatile(byte) };
        }
        let mut answer = [0; 2];
        for byte in &mut answer {
            *byte = (0..LOOKS).find_map(|_| self.received())?;
        }
        Some(answer)
    }
}
