//! Building the firmware image and measuring it.

use super::process::output;
use super::{BenchBoard, Board, Place, Progress, SetUpError, Toolchain, Transport};
use object::{Object, ObjectSection, SectionFlags, SectionKind, elf};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use tempfile::TempDir;

/// Contents of the image.
#[derive(Clone, Debug, Default)]
pub struct Choice {
    /// The board.
    pub board: Board,
    /// A baked body; the board's default if `None`.
    pub body: Option<PathBuf>,
    /// A body file of which queries without history are counted.
    pub cold: Option<PathBuf>,
    /// A settings file; the board's default if `None`.
    pub settings: Option<PathBuf>,
    /// With all protection of the device.
    pub protected: bool,
    /// The tool has a shape, and the frames a wrist's counts.
    pub wrist: bool,
}

/// An image and its sizes.
#[derive(Clone, Debug)]
pub struct Image {
    /// The board that it runs on.
    pub board: Board,
    /// The ELF file.
    pub elf: PathBuf,
    /// Bytes in flash: code, constants, and the first values of variables.
    pub flash: u64,
    /// Bytes of variables in RAM. The stack comes on top.
    pub ram: u64,
}

/// The same firmware over each transport. The files are gone when this is dropped.
#[derive(Debug)]
pub struct Images {
    uart: Image,
    fifo: Image,
    /// Keeps the files.
    _folder: TempDir,
}

impl Images {
    /// The image that speaks over a transport.
    pub const fn of(&self, transport: Transport) -> &Image {
        match transport {
            Transport::Uart => &self.uart,
            Transport::Fifo => &self.fifo,
        }
    }
}

impl Choice {
    /// Whether files go into the image.
    const fn has_files(&self) -> bool {
        self.body.is_some() || self.settings.is_some() || self.cold.is_some()
    }
}

/// Builds the images with the body and settings of `choice`.
///
/// # Errors
/// An error of the compiler or a faulty file.
pub fn build(toolchain: &Toolchain, choice: &Choice, progress: &Progress) -> Result<Images, SetUpError> {
    let folder = tempfile::Builder::new().prefix("palpate-image-").tempdir().map_err(SetUpError::io("a folder"))?;
    let build =
        |transport: Transport| build_program(toolchain, choice, transport.binary(), &[], folder.path(), progress);
    Ok(Images { uart: build(Transport::Uart)?, fifo: build(Transport::Fifo)?, _folder: folder })
}

/// Builds one of the board's programs into a folder, with features of its crate.
///
/// # Errors
/// An error of the compiler or a faulty file.
pub fn build_program(
    toolchain: &Toolchain,
    choice: &Choice,
    program: &str,
    features: &[&str],
    folder: &Path,
    progress: &Progress,
) -> Result<Image, SetUpError> {
    // Another choice writes to the same place: the images are copied away before it may start.
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _guard = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);

    let mut cargo = cargo_build(toolchain, choice)?;
    cargo.args(["--bin", program]);
    for feature in features {
        cargo.args(["--features", feature]);
    }
    let built = toolchain.target_folder()?.join(toolchain.target()).join("release").join(program);
    let first = if built.exists() { "" } else { ", the first time about half a minute" };
    let what = format!("building the firmware image {program} for {}{first}", choice.board.core());
    progress.during(&what, || output(&mut cargo))?;

    let elf = folder.join(program);
    fs::copy(&built, &elf).map_err(SetUpError::io(built.display()))?;
    measure(choice.board, elf)
}

/// Programs that run on every Cortex-M with floats in every run of the tests; on other cores the first alone.
const ON_EVERY_CORE: [&str; 4] = ["parity", "uart", "fifo", "accept"];

/// Builds the programs that the tests run on a board, in parallel: each is ready when it is asked for.
///
/// # Errors
/// Missing tools or an error of the compiler.
pub fn build_all(board: Board, progress: &Progress) -> Result<(), SetUpError> {
    let toolchain = Toolchain::set_up(board.target(), progress)?;
    let mut cargo = cargo_build(&toolchain, &Choice { board, ..Choice::default() })?;
    if super::cores().contains(&board) {
        cargo.arg("--bins");
    } else {
        let count = if Board::CORTEX_F.contains(&board) { ON_EVERY_CORE.len() } else { 1 };
        cargo.args(ON_EVERY_CORE[..count].iter().flat_map(|program| ["--bin", program]));
    }
    progress.during(&format!("building the firmware images for {}", board.core()), || output(&mut cargo))?;
    Ok(())
}

/// `cargo build` for a board, with a body and settings.
fn cargo_build(toolchain: &Toolchain, choice: &Choice) -> Result<Command, SetUpError> {
    let mut cargo = toolchain.cargo();
    cargo
        .current_dir(Board::folder()?)
        .arg("--config")
        .arg(choice.board.cargo_config()?)
        .args(["build", "--release", "--target-dir"])
        .arg(toolchain.target_folder()?);
    if choice.has_files() {
        cargo.args(["--features", "chosen"]);
    }
    if choice.protected {
        cargo.args(["--features", "protected"]);
    }
    if choice.wrist {
        cargo.args(["--features", "wrist"]);
    }
    // The log's levels are chosen when it is compiled.
    cargo.env("DEFMT_LOG", "info");
    let chosen =
        [("PALPATE_BODY", &choice.body), ("PALPATE_SETTINGS", &choice.settings), ("PALPATE_COLD", &choice.cold)];
    for (variable, file) in chosen {
        match file {
            Some(file) => cargo.env(variable, file.canonicalize().map_err(SetUpError::io(file.display()))?),
            None => cargo.env_remove(variable),
        };
    }
    Ok(cargo)
}

/// A body for a board for the bench: its baked source, and where its tables lie.
pub type BenchBody<'a> = (&'a Path, Place);

/// Builds the program of a board for the bench, with its own body or another, and gives the ELF file.
///
/// # Errors
/// An error of the compiler.
pub fn build_bench(board: BenchBoard, body: Option<BenchBody<'_>>, progress: &Progress) -> Result<PathBuf, SetUpError> {
    let toolchain = Toolchain::set_up(board.target(), progress)?;
    let target_folder = toolchain.target_folder()?;
    let mut cargo = toolchain.cargo();
    cargo.current_dir(board.folder()?).args(["build", "--release", "--bin", board.name(), "--target-dir"]);
    cargo.arg(&target_folder);
    choose_body(&mut cargo, body)?;
    progress.during(&format!("building the firmware for the board {}", board.name()), || output(&mut cargo))?;
    Ok(target_folder.join(board.target()).join("release").join(board.name()))
}

/// Tells a board's build which body to take.
pub(crate) fn choose_body(cargo: &mut Command, body: Option<BenchBody<'_>>) -> Result<(), SetUpError> {
    let Some((file, place)) = body else {
        cargo.env_remove("PALPATE_BODY").env_remove("PALPATE_TABLES");
        return Ok(());
    };
    cargo.env("PALPATE_BODY", file.canonicalize().map_err(SetUpError::io(file.display()))?);
    cargo.env("PALPATE_TABLES", if place == Place::Fast { "fast" } else { "flash" });
    Ok(())
}

/// Adds up the sections that the linker gave an address.
pub(super) fn measure(board: Board, elf: PathBuf) -> Result<Image, SetUpError> {
    let content = fs::read(&elf).map_err(SetUpError::io(elf.display()))?;
    let file = object::File::parse(content.as_slice()).map_err(|error| refused(&elf, &error.to_string()))?;
    let (mut flash, mut ram) = (0, 0);
    for section in file.sections() {
        let SectionFlags::Elf { sh_flags, .. } = section.flags() else {
            return Err(refused(&elf, "not an ELF file"));
        };
        let has = |flag| sh_flags & flag == flag;
        if !has(elf::SHF_ALLOC) {
            continue;
        }
        if section.kind() != SectionKind::UninitializedData {
            flash += section.size();
        }
        if has(elf::SHF_WRITE) {
            ram += section.size();
        }
    }
    Ok(Image { board, elf, flash, ram })
}

fn refused(path: &Path, reason: &str) -> SetUpError {
    SetUpError::Image { path: path.to_path_buf(), reason: reason.to_owned() }
}
