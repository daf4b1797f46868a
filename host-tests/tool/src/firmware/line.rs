//! The bytes between this program and an emulator: a socket, which every system has, or FIFOs, which a Unix has.

use super::fifos::Fifos;
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

/// A line to an emulator.
#[derive(Debug)]
pub(super) enum Line {
    /// To the board's UART.
    Socket(TcpStream),
    /// To the firmware through semihosting.
    Fifos(Fifos),
    /// This end has hung up.
    Closed,
}

impl Line {
    /// Sends all of it.
    pub fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Socket(stream) => stream.write_all(bytes),
            Self::Fifos(fifos) => fifos.send(bytes),
            Self::Closed => Err(ErrorKind::BrokenPipe.into()),
        }
    }

    /// Reads the available bytes, or waits for some: their number, 0 if the other end has closed the line, `None` if
    /// nothing arrived within `wait`.
    pub fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<Option<usize>> {
        let read = match self {
            Self::Socket(stream) => {
                stream.set_read_timeout(Some(wait))?;
                stream.read(buffer)
            }
            Self::Fifos(fifos) => fifos.receive(buffer, wait),
            Self::Closed => Ok(0),
        };
        match read {
            Ok(read) => Ok(Some(read)),
            // A time that has run out goes by either name, depending on the system.
            Err(error)
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) =>
            {
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }
}
