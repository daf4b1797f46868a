//! Transports of frames between host and emulator.

/// Transport of the frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transport {
    /// The board's UART: the real link.
    Uart,
    /// Two FIFOs through semihosting: several times faster, for long runs.
    Fifo,
}

impl Transport {
    /// The board's binary for it.
    pub const fn binary(self) -> &'static str {
        match self {
            Self::Uart => "uart",
            Self::Fifo => "fifo",
        }
    }
}
