//! A board's program that runs by itself and prints.

use super::process::output;
use super::{Board, Choice, Image, Progress, Qemu, SetUpError, Toolchain, image};
use tempfile::TempDir;

/// An image that needs no host but a console.
#[derive(Debug)]
pub struct Program {
    qemu: Qemu,
    /// The image.
    pub image: Image,
    /// Keeps the image's file.
    _folder: TempDir,
}

impl Program {
    /// Sets up what is missing and builds a program, with the features of the boards' shared crate that are named.
    ///
    /// # Errors
    /// What is missing or wrong.
    pub fn prepare(board: Board, program: &str, features: &[&str], progress: &Progress) -> Result<Self, SetUpError> {
        let qemu = Qemu::set_up(progress)?;
        let toolchain = Toolchain::set_up(board.target(), progress)?;
        let choice = Choice { board, ..Choice::default() };
        let folder = tempfile::Builder::new().prefix("palpate-image-").tempdir().map_err(SetUpError::io("a folder"))?;
        let image = image::build_program(&toolchain, &choice, program, features, folder.path(), progress)?;
        Ok(Self { qemu, image, _folder: folder })
    }

    /// Runs it to its end and gives what it printed. With `counted`, an instruction takes 64 ns of the emulated clock and
    /// every run is the same in every count; without, the clock is the host's and the run is faster.
    ///
    /// # Errors
    /// What it printed before it failed.
    pub fn run(&self, counted: bool) -> Result<String, SetUpError> {
        let Image { board, elf, .. } = &self.image;
        let mut command = if counted { self.qemu.board(elf, *board) } else { self.qemu.uncounted(elf, *board) };
        output(&mut command)
    }
}
