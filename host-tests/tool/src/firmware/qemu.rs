//! Where the emulator is.

use super::process::{apt_install, on_path, output};
use super::{Board, Progress, SetUpError};
use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The program for a board, and the Debian package that it comes in.
const fn program(board: Board) -> [&'static str; 2] {
    match board {
        Board::Riscv | Board::RiscvImc => ["qemu-system-riscv32", "qemu-system-misc"],
        _ => ["qemu-system-arm"; 2],
    }
}

/// Pace of the emulated clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// 64 ns an instruction independent of the host, and sleep is skipped: runs are reproducible, and a counter of 25
    /// MHz resolves single instructions.
    Counting,
    /// The same with 8 ns, as on a real board: time remains between two ticks for tasks of lower priority, although a
    /// tick here also has to read and write frames. Instructions are not counted.
    Brisk,
    /// The host's clock, which is faster: counts are meaningless, and only code that reads no clock behaves the same.
    Free,
}

impl Pace {
    const fn instruction_count(self) -> Option<&'static str> {
        match self {
            Self::Counting => Some("shift=6,sleep=off"),
            Self::Brisk => Some("shift=3,sleep=off"),
            Self::Free => None,
        }
    }
}

/// An emulator, ready to start.
#[derive(Clone, Debug)]
pub struct Qemu {
    program: PathBuf,
    /// Its version, as it prints it.
    pub version: String,
}

impl Qemu {
    /// The emulator that `PALPATE_QEMU` names, or the one on the search path; installed if it is missing and may be.
    ///
    /// # Errors
    /// [`SetUpError::NoEmulator`], with the reason.
    pub fn set_up(board: Board, progress: &Progress) -> Result<Self, SetUpError> {
        // Before anything is installed in vain.
        crate::repository::root()?;
        let [name, package] = program(board);
        // The variable names the emulator of Arm cores.
        let named = env::var_os("PALPATE_QEMU").filter(|program| !program.is_empty() && name == package);
        if let Some(program) = named.map(PathBuf::from).or_else(|| on_path(name)) {
            return Self::at(program);
        }
        apt_install(&[package], progress).map_err(SetUpError::NoEmulator)?;
        Self::at(on_path(name).ok_or_else(|| SetUpError::NoEmulator(format!("{name} did not come with {package}")))?)
    }

    fn at(program: PathBuf) -> Result<Self, SetUpError> {
        match output(Command::new(&program).arg("--version")) {
            Ok(said) => Ok(Self { program, version: said.lines().next().unwrap_or_default().to_owned() }),
            Err(error) => Err(SetUpError::NoEmulator(error.to_string())),
        }
    }

    /// The command that runs an image on the emulated board.
    pub fn board(&self, elf: &Path, board: Board, pace: Pace) -> Command {
        let mut command = Command::new(&self.program);
        command.stdin(Stdio::null()).args(["-machine", board.machine()]);
        if board.machine() == "virt" {
            // Its firmware is the image alone.
            command.args(["-bios", "none"]);
        }
        if let Some(count) = pace.instruction_count() {
            command.args(["-icount", count]);
        }
        command
            .args(["-nodefaults", "-no-user-config", "-display", "none", "-monitor", "none", "-nic", "none"])
            .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
            .arg(elf);
        command
    }
}
