//! The line that carries the bytes.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// The bytes between this program and a device: a serial port, a socket, a simulation.
pub trait Line {
    /// Its name in messages.
    fn name(&self) -> String;

    /// Sends all of it.
    ///
    /// # Errors
    /// A line that broke.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Puts what has come at the start of the buffer, and says how much. It waits for something to come no longer than
    /// asked; nothing is no error.
    ///
    /// # Errors
    /// A line that broke, or was closed at the other end.
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize>;

    /// The time by which the device is waited for. A simulation has its own.
    fn now(&self) -> Instant {
        Instant::now()
    }
}

impl<L: Line + ?Sized> Line for Box<L> {
    fn name(&self) -> String {
        (**self).name()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        (**self).send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        (**self).receive(buffer, wait)
    }

    fn now(&self) -> Instant {
        (**self).now()
    }
}

/// A read that may have had nothing to read; the end of a line is an error.
pub(crate) fn came(read: io::Result<usize>) -> io::Result<usize> {
    match read {
        Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
        Ok(bytes) => Ok(bytes),
        Err(error) => match error.kind() {
            ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted => Ok(0),
            _ => Err(error),
        },
    }
}

/// A socket's own calls.
struct Socket<S> {
    set_nonblocking: fn(&S, bool) -> io::Result<()>,
    set_read_timeout: fn(&S, Option<Duration>) -> io::Result<()>,
}

impl<S: Read> Socket<S> {
    fn receive(&self, socket: &mut S, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        if wait.is_zero() {
            (self.set_nonblocking)(socket, true)?;
            let read = socket.read(buffer);
            (self.set_nonblocking)(socket, false)?;
            return came(read);
        }
        (self.set_read_timeout)(socket, Some(wait))?;
        came(socket.read(buffer))
    }
}

impl Line for TcpStream {
    fn name(&self) -> String {
        self.peer_addr().map_or_else(|_| "a socket".to_owned(), |address| address.to_string())
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let calls = Socket { set_nonblocking: Self::set_nonblocking, set_read_timeout: Self::set_read_timeout };
        calls.receive(self, buffer, wait)
    }
}

#[cfg(unix)]
impl Line for std::os::unix::net::UnixStream {
    fn name(&self) -> String {
        "a socket".to_owned()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let calls = Socket { set_nonblocking: Self::set_nonblocking, set_read_timeout: Self::set_read_timeout };
        calls.receive(self, buffer, wait)
    }
}
