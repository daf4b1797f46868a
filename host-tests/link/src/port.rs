//! A serial port.

use crate::line::came;
use crate::{Error, Line};
use serialport::{ClearBuffer, SerialPort};
use std::io;
use std::time::Duration;

/// How long a port that takes nothing is waited for.
const SENDS: Duration = Duration::from_millis(250);

/// A device at a serial port.
pub struct Port {
    port: Box<dyn SerialPort>,
    name: String,
}

impl Port {
    /// Opens it, and forgets what came before.
    ///
    /// # Errors
    /// A port that is not there, or another program's.
    pub fn open(name: &str, baud: u32) -> Result<Self, Error> {
        let opened = serialport::new(name, baud).timeout(SENDS).open();
        let opened = opened.and_then(|port| port.clear(ClearBuffer::Input).map(|()| port));
        let mut port = opened.map_err(|cause| Error::Open { port: name.to_owned(), cause })?;
        // A device at its own USB plug listens while this is up. Not every system raises it; not every port has it.
        let _ = port.write_data_terminal_ready(true);
        Ok(Self { port, name: name.to_owned() })
    }
}

impl Line for Port {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.port.set_timeout(SENDS)?;
        io::Write::write_all(&mut self.port, bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        if wait.is_zero() && self.port.bytes_to_read()? == 0 {
            return Ok(0);
        }
        self.port.set_timeout(wait.max(Duration::from_millis(1)))?;
        came(io::Read::read(&mut self.port, buffer))
    }
}

impl std::fmt::Debug for Port {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_tuple("Port").field(&self.name).finish()
    }
}
