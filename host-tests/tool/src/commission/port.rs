//! A serial port.

use super::Line;
use anyhow::Context;
use serialport::SerialPort;
use std::io::ErrorKind;
use std::time::Duration;

/// How long to wait for bytes.
const WAIT: Duration = Duration::from_millis(10);

/// A device at a serial port.
pub struct PortLine {
    port: Box<dyn SerialPort>,
    path: String,
}

impl PortLine {
    /// Opens it.
    ///
    /// # Errors
    /// A port that is not there, or another program's.
    pub fn open(path: &str, baud: u32) -> anyhow::Result<Self> {
        let port = serialport::new(path, baud).timeout(WAIT).open();
        let mut port = port.with_context(|| format!("cannot open the serial port {path}"))?;
        // A device at its own USB plug listens while this is up. Not every system raises it; not every port has it.
        let _ = port.write_data_terminal_ready(true);
        Ok(Self { port, path: path.to_owned() })
    }
}

impl Line for PortLine {
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.port.write_all(bytes).with_context(|| format!("cannot write to the serial port {}", self.path))
    }

    fn receive(&mut self) -> anyhow::Result<Vec<u8>> {
        let mut buffer = [0; 4096];
        match self.port.read(&mut buffer) {
            Ok(read) => Ok(buffer[..read].to_vec()),
            Err(error) => match error.kind() {
                ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted => Ok(Vec::new()),
                _ => Err(error).with_context(|| format!("the serial port {} closed", self.path)),
            },
        }
    }
}
