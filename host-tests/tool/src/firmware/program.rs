//! A board's program other than the plain ones: it prints, logs or tells of itself.

use super::process::output;
use super::{
    Board, Choice, Emulator, Image, LinkError, Pace, Progress, Qemu, Running, SetUpError, Toolchain, Transport, image,
};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};
use tempfile::TempDir;

/// A program's image and the emulator for it.
#[derive(Debug)]
pub struct Program {
    qemu: Qemu,
    /// The image.
    pub image: Image,
    /// Keeps the image's file, and those that it reads and writes.
    folder: TempDir,
}

impl Program {
    /// Installs missing tools and builds a program, with features of the board's crate.
    ///
    /// # Errors
    /// Missing tools or a failed build.
    pub fn prepare(board: Board, program: &str, features: &[&str], progress: &Progress) -> Result<Self, SetUpError> {
        Self::prepare_with(&Choice { board, ..Choice::default() }, program, features, progress)
    }

    /// The same with a choice of body and settings.
    ///
    /// # Errors
    /// Missing tools or a failed build.
    pub fn prepare_with(
        choice: &Choice,
        program: &str,
        features: &[&str],
        progress: &Progress,
    ) -> Result<Self, SetUpError> {
        let qemu = Qemu::set_up(choice.board, progress)?;
        let toolchain = Toolchain::set_up(choice.board.target(), progress)?;
        let folder = tempfile::Builder::new().prefix("palpate-image-").tempdir().map_err(SetUpError::io("a folder"))?;
        let image = image::build_program(&toolchain, choice, program, features, folder.path(), progress)?;
        Ok(Self { qemu, image, folder })
    }

    /// A program that was built before.
    ///
    /// # Errors
    /// If it is none, or there is no emulator.
    pub fn of_image(board: Board, elf: &Path, progress: &Progress) -> Result<Self, SetUpError> {
        let folder = tempfile::Builder::new().prefix("palpate-image-").tempdir().map_err(SetUpError::io("a folder"))?;
        // The emulator runs in a folder of its own.
        let elf = elf.canonicalize().map_err(SetUpError::io(elf.display()))?;
        Ok(Self { qemu: Qemu::set_up(board, progress)?, image: image::measure(board, elf)?, folder })
    }

    /// The folder that it runs in.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    fn command(&self, pace: Pace) -> Command {
        let mut command = self.qemu.board(&self.image.elf, self.image.board, pace);
        command.current_dir(self.folder.path());
        command
    }

    /// Runs the program alone, without a link to the host, and returns its output.
    ///
    /// # Errors
    /// The program's output, if it failed.
    pub fn run(&self, pace: Pace) -> Result<String, SetUpError> {
        output(&mut self.command(pace))
    }

    /// Runs the program and logs every block of instructions that starts in one of these ranges (start, length), as a
    /// line `Trace …` on its standard error.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn trace(&self, ranges: &[(u64, u64)]) -> Result<Child, SetUpError> {
        let filter: Vec<String> = ranges.iter().map(|(start, length)| format!("{start:#x}+{length:#x}")).collect();
        let mut command = self.command(Pace::Free);
        command.args(["-d", "exec,nochain", "-D", "/dev/stderr", "-dfilter", &filter.join(",")]);
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        command.spawn().map_err(SetUpError::io("the emulator"))
    }

    /// Starts it where it speaks over its UART alone: that line comes with it.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn start_with_line(&self) -> Result<(Running, TcpStream), LinkError> {
        Running::start(&self.qemu, &self.image)
    }

    /// Starts it where it speaks over this transport alone.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn start_over(&self, transport: Transport) -> Result<Emulator, LinkError> {
        Emulator::start(&self.qemu, &self.image, transport)
    }

    /// Starts it where it speaks over FIFOs and tells of itself over its UART: the line it does that on comes with it.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn start_with_telemetry(&self) -> Result<(Emulator, TcpStream), LinkError> {
        self.start_with_flash(&[])
    }

    /// The same with this in the flash of a program that has some; erased, if it is nothing.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn start_with_flash(&self, flash: &[u8]) -> Result<(Emulator, TcpStream), LinkError> {
        Emulator::start_with_telemetry(&self.qemu, &self.image, flash)
    }

    /// Starts it where it speaks over FIFOs and writes to its standard output, which comes with it.
    ///
    /// # Errors
    /// If the emulator does not start.
    pub fn start_with_output(&self) -> Result<(Emulator, ChildStdout), LinkError> {
        Emulator::start_with_output(&self.qemu, &self.image)
    }
}
