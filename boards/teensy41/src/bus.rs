//! The sensors' bus (LPSPI4): frames of 16 bits.

use palpate_bench::sensors::Controller;
use teensy4_bsp::board::Lpspi;
use teensy4_bsp::hal::lpspi::{MODE_1, Transaction};

/// Looks at the controller, of some 40 ns or more: a frame takes 2 µs.
const LOOKS: u32 = 500;
/// Capacity of its buffer.
const FRAMES: u32 = 16;

/// 16 bits in mode 1.
const FRAME: Transaction = {
    let Ok(mut frame) = Transaction::new(16) else { panic!("the controller takes 8 bits and more") };
    frame.set_mode(MODE_1);
    frame
};

/// The controller, which runs.
pub struct Spi(pub Lpspi);

impl Controller for Spi {
    #[inline]
    fn exchange(&mut self, frame: [u8; 2]) -> Option<[u8; 2]> {
        let Self(controller) = self;
        // A frame that was given up may have come since.
        let _ = (0..FRAMES).any(|_| controller.read_data().is_none());
        controller.enqueue_transaction(FRAME);
        controller.enqueue_data(u32::from(u16::from_be_bytes(frame)));
        let answer = (0..LOOKS).find_map(|_| controller.read_data())?;
        Some((answer as u16).to_be_bytes())
    }
}
