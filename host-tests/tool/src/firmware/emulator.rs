//! A running emulator with the firmware in it.

use super::fifos::Fifos;
use super::line::Line;
use super::qemu::Pace;
use super::transport::Transport;
use super::{Image, Link, LinkError, Qemu};
use palpate::wire::Report;
use palpate::wire::frame::{DELIMITER, MAX_FRAME, Received, Receiver};
use std::fs::{self, File};
use std::io::ErrorKind;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// How long a report may take. The emulator answers within a millisecond; over the UART it waits a second or so for a
/// host that stays silent, and a loaded machine makes that several.
const PATIENCE: Duration = Duration::from_secs(60);
/// How often to look whether the emulator is still there.
const LOOK: Duration = Duration::from_millis(100);

/// Where an image that has flash keeps it, in the folder where the emulator was started.
const FLASH: &str = "flash";

/// A running emulator. It ends when this is dropped, or by itself if this program is gone.
#[derive(Debug)]
pub struct Emulator {
    child: Child,
    transport: Transport,
    line: Line,
    receiver: Receiver<Report>,
    /// Bytes read ahead: those from `next` to `end` are still to be taken.
    buffer: [u8; MAX_FRAME],
    next: usize,
    end: usize,
    /// Holds the socket or FIFOs and what the emulator said.
    folder: TempDir,
}

impl Emulator {
    /// Starts an image.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn start(qemu: &Qemu, image: &Image, transport: Transport) -> Result<Self, LinkError> {
        let (mut command, folder) = command(qemu, image, Pace::Counting)?;
        let (child, line) = match transport {
            Transport::Uart => {
                let (child, stream) = accept_uart(&mut command, &folder)?;
                (child, Line::Socket(stream))
            }
            Transport::Fifo => {
                let fifos = Fifos::new(folder.path())?;
                (command.spawn()?, Line::Fifos(fifos))
            }
        };
        Ok(Self::new(child, transport, line, folder))
    }

    /// Starts an image that speaks over FIFOs and tells of itself over its UART: the line it does that on comes with
    /// it. `flash` is what lies in its flash, if the image has some; nothing is erased flash.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn start_with_telemetry(qemu: &Qemu, image: &Image, flash: &[u8]) -> Result<(Self, TcpStream), LinkError> {
        let (mut command, folder) = command(qemu, image, Pace::Brisk)?;
        if !flash.is_empty() {
            fs::write(folder.path().join(FLASH), flash)?;
        }
        let fifos = Fifos::new(folder.path())?;
        let (child, telemetry) = accept_uart(&mut command, &folder)?;
        Ok((Self::new(child, Transport::Fifo, Line::Fifos(fifos), folder), telemetry))
    }

    /// Starts an image that speaks over FIFOs and writes to its standard output, which comes with it.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn start_with_output(qemu: &Qemu, image: &Image) -> Result<(Self, ChildStdout), LinkError> {
        let (mut command, folder) = command(qemu, image, Pace::Brisk)?;
        let fifos = Fifos::new(folder.path())?;
        let mut child = command.stdout(Stdio::piped()).spawn()?;
        let output = child.stdout.take().ok_or_else(|| LinkError::Io(ErrorKind::BrokenPipe.into()))?;
        Ok((Self::new(child, Transport::Fifo, Line::Fifos(fifos), folder), output))
    }

    fn new(child: Child, transport: Transport, line: Line, folder: TempDir) -> Self {
        Self { child, transport, line, receiver: Receiver::new(), buffer: [0; MAX_FRAME], next: 0, end: 0, folder }
    }

    /// The content of its flash; empty if it was never written.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn flash(&self) -> Result<Vec<u8>, LinkError> {
        match fs::read(self.folder.path().join(FLASH)) {
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Vec::new()),
            read => Ok(read?),
        }
    }

    /// Hangs up, so that the firmware finds its host gone, and waits for the emulator to end by itself.
    ///
    /// # Errors
    /// [`LinkError::Silent`] if it is still running after that time.
    pub fn hang_up(mut self, patience: Duration) -> Result<std::process::ExitStatus, LinkError> {
        self.line = Line::Closed;
        let start = Instant::now();
        while start.elapsed() < patience {
            if let Some(status) = self.child.try_wait()? {
                return Ok(status);
            }
            std::thread::sleep(LOOK);
        }
        Err(LinkError::Silent(patience))
    }

    /// Reads the available bytes, or waits for some.
    fn fill(&mut self) -> Result<(), LinkError> {
        self.next = 0;
        self.end = 0;
        let start = Instant::now();
        while self.end == 0 {
            match self.line.receive(&mut self.buffer, LOOK)? {
                Some(0) => return Err(self.ended()),
                Some(read) => self.end = read,
                None if self.child.try_wait()?.is_some() => return Err(self.ended()),
                None if start.elapsed() > PATIENCE => return Err(LinkError::Silent(PATIENCE)),
                None => {}
            }
        }
        Ok(())
    }

    fn ended(&mut self) -> LinkError {
        // The line may close a moment before the process is gone.
        let start = Instant::now();
        let mut status = None;
        while status.is_none() && start.elapsed() < Duration::from_secs(2) {
            status = self.child.try_wait().ok().flatten();
            std::thread::sleep(Duration::from_millis(5));
        }
        let status = status.map_or_else(|| "it closed the line".to_owned(), |status| status.to_string());
        LinkError::Ended { status, output: fs::read_to_string(self.folder.path().join("said")).unwrap_or_default() }
    }
}

impl Link for Emulator {
    fn send_bytes(&mut self, bytes: &[u8]) -> Result<(), LinkError> {
        match self.line.send(bytes) {
            Err(error) if matches!(error.kind(), ErrorKind::BrokenPipe | ErrorKind::ConnectionReset) => {
                Err(self.ended())
            }
            result => Ok(result?),
        }
    }

    fn stay_silent(&mut self) -> Result<(), LinkError> {
        match self.transport {
            // The device's own patience runs out.
            Transport::Uart => Ok(()),
            // Emulated time stands still while the device reads: say that there is nothing to say.
            Transport::Fifo => self.send_bytes(&[DELIMITER]),
        }
    }

    fn receive(&mut self) -> Result<Report, LinkError> {
        loop {
            while self.next < self.end {
                let byte = self.buffer[self.next];
                self.next += 1;
                match self.receiver.feed(byte) {
                    Some(Received::Message(report)) => return Ok(report),
                    // The device always has something to say.
                    Some(Received::Damaged | Received::Empty) => return Err(LinkError::Damaged),
                    None => {}
                }
            }
            self.fill()?;
        }
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        // It may have ended by itself: both calls then find nothing to do.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// An emulator that is left to itself. It ends when this is dropped.
#[derive(Debug)]
pub struct Running {
    child: Child,
    /// Holds what the emulator said.
    _folder: TempDir,
}

impl Running {
    /// Starts an image that speaks over its UART alone: that line comes with it.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn start(qemu: &Qemu, image: &Image) -> Result<(Self, TcpStream), LinkError> {
        let (mut command, folder) = command(qemu, image, Pace::Counting)?;
        let (child, line) = accept_uart(&mut command, &folder)?;
        Ok((Self { child, _folder: folder }, line))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended by itself: both calls then find nothing to do.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The emulator's command line for an image, to be run in a folder of its own.
fn command(qemu: &Qemu, image: &Image, pace: Pace) -> Result<(Command, TempDir), LinkError> {
    let folder = tempfile::Builder::new().prefix("palpate-link-").tempdir()?;
    let mut command = qemu.board(&image.elf, image.board, pace);
    command.current_dir(folder.path()).stdout(Stdio::null()).stderr(File::create(folder.path().join("said"))?);
    Ok((command, folder))
}

/// Starts the emulator with its UART on a socket of this machine. This program listens and the emulator calls: there is
/// no moment at which one could miss the other.
fn accept_uart(command: &mut Command, folder: &TempDir) -> Result<(Child, TcpStream), LinkError> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
    listener.set_nonblocking(true)?;
    let port = listener.local_addr()?.port();
    let socket = format!("socket,id=uart,host=127.0.0.1,port={port},server=off,nodelay=on");
    let mut child = command.args(["-chardev", &socket, "-serial", "chardev:uart"]).spawn()?;
    let start = Instant::now();
    loop {
        match listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(false)?;
                stream.set_nodelay(true)?;
                return Ok((child, stream));
            }
            Err(error) if error.kind() == ErrorKind::WouldBlock => {}
            Err(error) => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(error.into());
            }
        }
        let ended = child.try_wait()?;
        if ended.is_some() || start.elapsed() > PATIENCE {
            let _ = child.kill();
            let status = child.wait()?.to_string();
            let output = fs::read_to_string(folder.path().join("said")).unwrap_or_default();
            return Err(LinkError::Ended { status, output });
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}
