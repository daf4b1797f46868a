//! Two FIFOs in a folder, which the firmware opens through semihosting. Only a Unix has them: elsewhere `no_fifos.rs`
//! stands in.

use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::stat::Mode;
use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::os::fd::AsFd as _;
use std::path::Path;
use std::time::Duration;

/// Both directions.
#[derive(Debug)]
pub(super) struct Fifos {
    to_device: File,
    from_device: File,
}

impl Fifos {
    /// Makes them. Each is opened to read *and* write, which never blocks; the other end comes when the firmware opens
    /// it.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let open = |name| {
            let path = folder.join(name);
            nix::unistd::mkfifo(&path, Mode::S_IRUSR | Mode::S_IWUSR)?;
            OpenOptions::new().read(true).write(true).open(path)
        };
        Ok(Self { to_device: open("to-device")?, from_device: open("from-device")? })
    }

    pub fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.to_device.write_all(bytes)
    }

    pub fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let mut asked = [PollFd::new(self.from_device.as_fd(), PollFlags::POLLIN)];
        match poll(&mut asked, PollTimeout::try_from(wait).unwrap_or(PollTimeout::MAX)) {
            Ok(0) | Err(Errno::EINTR) => Err(ErrorKind::TimedOut.into()),
            Ok(_) => self.from_device.read(buffer),
            Err(error) => Err(error.into()),
        }
    }
}
