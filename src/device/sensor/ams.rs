//! AS5047P and AS5048A: 14-bit magnetic angle sensors over SPI.

use super::SensorError;
use embedded_hal::spi::SpiDevice;

/// Which of the two it is. Frames are alike; diagnostics are not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AmsChip {
    /// AS5047P: diagnostics at 0x3FFC, weak field in bit 11, strong in bit 10.
    As5047p,
    /// AS5048A: diagnostics at 0x3FFD; bits 11 and 10 tell a field too strong and too weak, the other way about.
    As5048a,
}

/// The angle, with dynamic compensation where the chip has it.
const ANGLE: u16 = 0x3fff;
/// Error flags; reading clears them.
const ERRORS: u16 = 0x0001;
const READ: u16 = 1 << 14;
const DATA: u16 = 0x3fff;
const ERROR_FLAG: u16 = 1 << 14;
const PARITY: u16 = 1 << 15;

/// Diagnostics: the offset compensation has settled, so the angle is good.
const READY: u16 = 1 << 8;
/// Diagnostics: the angle's computation overflowed; the angle is not valid.
const OVERFLOW: u16 = 1 << 9;
/// Diagnostics: the field is too strong or too weak; which bit is which differs.
const FIELD: u16 = 0b11 << 10;
/// Diagnostics: the automatic gain.
const GAIN: u16 = 0xff;

/// One sensor. The bus runs in mode 1 (clock idle low, sampled on the falling edge), at most 10 MHz, 16 bits a frame.
///
/// **The data in a frame answer the frame before.** So a reading is two frames: the second requests the diagnostics,
/// which the first of the next reading brings. Settled bit, field flags and gain are checked in every reading and cost
/// no frame of their own.
///
/// A frame: bit 15 makes the parity of the whole even; bit 14 asks for a read, or answers that the last command was
/// damaged; the rest is address or data (data sheets of both chips).
#[derive(Debug)]
pub struct AmsAngle<S> {
    bus: S,
    chip: AmsChip,
}

/// One reading of the sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AmsReading {
    /// The angle during the last frame, about 2 µs old, 0 to 16,383 a turn.
    pub angle: u16,
    /// The chip's automatic gain at the end of the reading before: low in a strong field, 255 in a weak one.
    pub gain: u8,
}

/// The frame with bit 15 set so that the number of ones is even.
const fn with_parity(frame: u16) -> u16 {
    if frame & !PARITY != 0 && (frame & !PARITY).count_ones() % 2 == 1 { frame | PARITY } else { frame & !PARITY }
}

impl<S: SpiDevice<u8>> AmsAngle<S> {
    /// A sensor on its bus. Nothing is sent yet.
    pub const fn new(bus: S, chip: AmsChip) -> Self {
        Self { bus, chip }
    }

    /// Gives the bus back.
    pub fn free(self) -> S {
        self.bus
    }

    /// Clears the sensor's error flags, checks that it is there, settled and sees its magnet, and requests the
    /// diagnostics of the first reading. Three frames. Call it before the first [`Self::read`] and after any error.
    ///
    /// # Errors
    /// [`SensorError::Absent`], [`SensorError::Magnet`], and the errors of a frame.
    pub fn start(&mut self) -> Result<(), SensorError<S::Error>> {
        // The answer to this first frame belongs to an unknown request: an error flag in it is about to be cleared.
        self.exchange(ERRORS)?;
        match self.exchange(self.diagnostics()).and_then(Self::checked) {
            // The answer to the command that clears the flag still carries it.
            Ok(_) | Err(SensorError::Refused) => {}
            Err(error) => return Err(error),
        }
        let diagnostics = self.exchange(self.diagnostics()).and_then(Self::checked)?;
        Self::gain(diagnostics).map(|_| ())
    }

    /// The angle now. Two frames.
    ///
    /// # Errors
    /// Bus, parity, the error flag, a bus that gives only ones or only zeros, a sensor that is not settled, and a field
    /// that is too strong or too weak. The angle of such a reading is not to be used.
    pub fn read(&mut self) -> Result<AmsReading, SensorError<S::Error>> {
        let diagnostics = self.exchange(ANGLE).and_then(Self::checked)?;
        let gain = Self::gain(diagnostics)?;
        let angle = self.exchange(self.diagnostics()).and_then(Self::checked)?;
        Ok(AmsReading { angle, gain })
    }

    /// The gain in good diagnostics. A bus that is stuck low reads as parity-clean zeros: the settled bit tells.
    fn gain(diagnostics: u16) -> Result<u8, SensorError<S::Error>> {
        if diagnostics & READY == 0 {
            return Err(SensorError::Absent);
        }
        if diagnostics & (OVERFLOW | FIELD) != 0 {
            return Err(SensorError::Magnet);
        }
        Ok((diagnostics & GAIN) as u8)
    }

    const fn diagnostics(&self) -> u16 {
        match self.chip {
            AmsChip::As5047p => 0x3ffc,
            AmsChip::As5048a => 0x3ffd,
        }
    }

    /// Sends a command to read an address; the answer is that of the frame before.
    fn exchange(&mut self, address: u16) -> Result<u16, SensorError<S::Error>> {
        let mut frame = with_parity(READ | address).to_be_bytes();
        self.bus.transfer_in_place(&mut frame).map_err(SensorError::Bus)?;
        Ok(u16::from_be_bytes(frame))
    }

    /// The data of a valid frame.
    fn checked(frame: u16) -> Result<u16, SensorError<S::Error>> {
        // All ones is a whole frame with its error flag set, but far more likely no sensor is connected.
        if frame == u16::MAX {
            return Err(SensorError::Absent);
        }
        if frame.count_ones() % 2 == 1 {
            return Err(SensorError::Damaged);
        }
        if frame & ERROR_FLAG != 0 {
            return Err(SensorError::Refused);
        }
        Ok(frame & DATA)
    }
}

#[cfg(test)]
mod tests {
    use super::with_parity;

    #[test]
    fn commands_have_even_parity() {
        // Worked by hand: 15 ones get a sixteenth; 0x4001 has two already; 0x4000 one.
        assert_eq!([0x7fff, 0x4001, 0x4000, 0x7ffc, 0x7ffd].map(with_parity), [0xffff, 0x4001, 0xc000, 0xfffc, 0x7ffd]);
    }
}
