//! MT6701: a 14-bit magnetic angle sensor over SSI.

use super::SensorError;
use embedded_hal::spi::SpiDevice;

/// One sensor. SSI is a one-way SPI: select, 24 clocks, deselect; data change on the rising edge of the clock, so mode
/// 1.
///
/// A frame, most significant bit first: 14 bits of angle, 4 of status (lost track, button, field too weak, field too
/// strong), and the CRC-6 of these 18, polynomial `x⁶ + x + 1`, starting from zero (data sheet).
#[derive(Debug)]
pub struct Mt6701<S> {
    bus: S,
}

/// One reading of the sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mt6701Reading {
    /// The angle as the chip was selected, 0 to 16,383 a turn.
    pub angle: u16,
    /// The magnet was pressed nearer, as a push button.
    pub pressed: bool,
}

const TOO_STRONG: u32 = 1 << 0;
const TOO_WEAK: u32 = 1 << 1;
const PRESSED: u32 = 1 << 2;
const TRACK_LOST: u32 = 1 << 3;

impl<S: SpiDevice<u8>> Mt6701<S> {
    /// A sensor on its bus. Nothing is sent yet.
    pub const fn new(bus: S) -> Self {
        Self { bus }
    }

    /// Gives the bus back.
    pub fn free(self) -> S {
        self.bus
    }

    /// The angle now. One frame.
    ///
    /// # Errors
    /// Bus, CRC, or the error that the status reports. All zeros is a clean frame of angle zero with CRC 0, but a dead
    /// bus reads the same, so it is refused: that costs at most one reading in 16,384 of a good sensor.
    pub fn read(&mut self) -> Result<Mt6701Reading, SensorError<S::Error>> {
        let mut bytes = [0; 3];
        self.bus.read(&mut bytes).map_err(SensorError::Bus)?;
        let frame = bytes.into_iter().fold(0, |frame, byte| frame << 8 | u32::from(byte));
        if frame == 0 || frame == 0x00ff_ffff {
            return Err(SensorError::Absent);
        }
        let payload = frame >> 6;
        if crc6(payload) != frame & 0x3f {
            return Err(SensorError::Damaged);
        }
        if payload & TRACK_LOST != 0 {
            return Err(SensorError::TrackLost);
        }
        if payload & (TOO_STRONG | TOO_WEAK) != 0 {
            return Err(SensorError::Magnet);
        }
        let angle = (payload >> 4) as u16;
        Ok(Mt6701Reading { angle, pressed: payload & PRESSED != 0 })
    }
}

/// CRC-6 of 18 bits, bit by bit: 18 shifts, no table in flash.
fn crc6(payload: u32) -> u32 {
    const POLYNOMIAL: u32 = 0b100_0011;
    let mut remainder = payload << 6;
    for bit in (6..24).rev() {
        if remainder >> bit & 1 == 1 {
            remainder ^= POLYNOMIAL << (bit - 6);
        }
    }
    remainder
}

#[cfg(test)]
mod tests {
    use super::crc6;

    #[test]
    fn crc_is_the_remainder_of_the_polynomial() {
        // By hand: 1 leaves x⁶ = x + 1; 2 leaves x² + x; the polynomial itself leaves nothing; 0x20 · x⁶ = x¹¹ leaves
        // x⁶ + x⁵ = x⁵ + x + 1.
        assert_eq!([0, 1, 2, 0b100_0011, 0x20].map(crc6), [0, 0b11, 0b110, 0, 0b10_0011]);
    }

    #[test]
    fn every_single_and_double_bit_error_shows() {
        let flips = |count: u32| (0_u32..1 << 24).filter(move |flip| flip.count_ones() == count);
        let damaged = |flip: u32| crc6(flip >> 6) != flip & 0x3f;
        // The code is linear: an error passes where it is itself a clean frame.
        assert!(flips(1).all(damaged) && flips(2).all(damaged));
    }
}
