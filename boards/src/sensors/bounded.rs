//! A bus whose controller may not answer.

use embedded_hal::spi::{Error, ErrorKind, ErrorType, SpiBus};

/// A chip's SPI controller, 16 bits at a time.
pub trait Controller {
    /// Sends a frame and returns the one that came meanwhile, first byte first; `None` if the controller does not finish
    /// within some ten times what a frame takes.
    fn exchange(&mut self, frame: [u8; 2]) -> Option<[u8; 2]>;
}

/// The bus of a controller. The HALs' own wait without a bound, in the tick.
#[derive(Clone, Copy, Debug)]
pub struct Bounded<C>(pub C);

/// The controller did not finish a frame, or was given an odd number of bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unfinished;

impl Error for Unfinished {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

impl<C> ErrorType for Bounded<C> {
    type Error = Unfinished;
}

impl<C: Controller> SpiBus for Bounded<C> {
    fn read(&mut self, words: &mut [u8]) -> Result<(), Unfinished> {
        words.fill(0);
        self.transfer_in_place(words)
    }

    fn write(&mut self, words: &[u8]) -> Result<(), Unfinished> {
        let (frames, rest) = words.as_chunks();
        frames.iter().try_for_each(|frame| self.0.exchange(*frame).map(|_| ()).ok_or(Unfinished))?;
        if rest.is_empty() { Ok(()) } else { Err(Unfinished) }
    }

    fn transfer(&mut self, read: &mut [u8], write: &[u8]) -> Result<(), Unfinished> {
        let (sent, rest) = write.split_at(read.len().min(write.len()));
        read.fill(0);
        read[..sent.len()].copy_from_slice(sent);
        self.transfer_in_place(read)?;
        self.write(rest)
    }

    #[inline]
    fn transfer_in_place(&mut self, words: &mut [u8]) -> Result<(), Unfinished> {
        let (frames, rest) = words.as_chunks_mut();
        for frame in frames {
            *frame = self.0.exchange(*frame).ok_or(Unfinished)?;
        }
        if rest.is_empty() { Ok(()) } else { Err(Unfinished) }
    }

    /// A frame is over once it has come.
    fn flush(&mut self) -> Result<(), Unfinished> {
        Ok(())
    }
}
