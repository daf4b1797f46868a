//! One of several devices on a bus, whose select line keeps the times that its data sheet asks for.

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::{Error, ErrorKind, ErrorType, Operation, SpiBus, SpiDevice};

/// Times of a select line, nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SelectTiming {
    /// High before it falls again.
    pub high: u32,
    /// From its fall to the first clock.
    pub set_up: u32,
    /// From the last clock to its rise.
    pub hold: u32,
}

/// A device for the time of a transaction: the bus, its select line, and a delay to keep the times with.
#[derive(Debug)]
pub struct Selected<'a, B, P, D> {
    /// The bus, which nobody else uses meanwhile.
    pub bus: &'a mut B,
    /// The select line, low to select.
    pub select: &'a mut P,
    /// The delay.
    pub delay: &'a mut D,
    /// How long.
    pub timing: SelectTiming,
}

/// The bus or the select line failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SelectError<E> {
    /// The bus.
    Bus(E),
    /// The select line.
    Select,
}

impl<E: Error> Error for SelectError<E> {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Bus(error) => error.kind(),
            Self::Select => ErrorKind::ChipSelectFault,
        }
    }
}

impl<B: SpiBus, P: OutputPin, D: DelayNs> ErrorType for Selected<'_, B, P, D> {
    type Error = SelectError<B::Error>;
}

impl<B: SpiBus, P: OutputPin, D: DelayNs> SpiDevice for Selected<'_, B, P, D> {
    #[inline]
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Self::Error> {
        self.delay.delay_ns(self.timing.high);
        self.select.set_low().map_err(|_| SelectError::Select)?;
        self.delay.delay_ns(self.timing.set_up);
        let mut done = Ok(());
        for operation in operations {
            if done.is_ok() {
                done = match operation {
                    Operation::Read(words) => self.bus.read(words),
                    Operation::Write(words) => self.bus.write(words),
                    Operation::Transfer(read, write) => self.bus.transfer(read, write),
                    Operation::TransferInPlace(words) => self.bus.transfer_in_place(words),
                    Operation::DelayNs(nanoseconds) => {
                        self.delay.delay_ns(*nanoseconds);
                        Ok(())
                    }
                };
            }
        }
        // Whatever failed, the line goes up, and only once the last clock is over.
        let flushed = self.bus.flush();
        self.delay.delay_ns(self.timing.hold);
        self.select.set_high().map_err(|_| SelectError::Select)?;
        done.and(flushed).map_err(SelectError::Bus)
    }
}
