//! palpate for C: the static library for each kind of core, and its example.

use crate::firmware::{
    Board, Program, Progress, SetUpError, Toolchain, apt_install, on_path, output, without_outer_cargo,
};
use crate::repository;
use palpate_sim::devices::{ShippedDevice, c_preset};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The variable that makes the tests of the C library run; `palpate test` sets it once everything is set up.
pub const WITH_C: &str = "PALPATE_C";

/// The compiler for microcontrollers, and the packages that it comes in.
const GCC: &str = "arm-none-eabi-gcc";
const PACKAGES: [&str; 2] = ["gcc-arm-none-eabi", "libnewlib-arm-none-eabi"];

/// Target of a library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Core {
    /// Cortex-M4F, and M7 as well.
    M4,
    /// Cortex-M33.
    M33,
    /// This machine.
    Host,
    /// This machine, with checked memory accesses.
    Sanitized,
}

impl Core {
    /// Options of gcc for this target, apart from warnings.
    pub const fn gcc(self) -> &'static [&'static str] {
        match self {
            Self::M4 => &["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16", "-ffreestanding"],
            Self::M33 => &["-mcpu=cortex-m33", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv5-sp-d16", "-ffreestanding"],
            Self::Host => &[],
            Self::Sanitized => &["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"],
        }
    }

    /// The folders of an Arduino library where its builder looks for this core's.
    pub const fn arduino(self) -> &'static [&'static str] {
        match self {
            // The builder asks for the core's name, or for the chip's on Teensy 4.x.
            Self::M4 => &["cortex-m4/fpv4-sp-d16-hard", "cortex-m7/fpv5-d16-hard", "imxrt1062/fpv5-d16-hard"],
            Self::M33 => &["cortex-m33/fpv5-sp-d16-hard"],
            Self::Host | Self::Sanitized => &[],
        }
    }
}

/// The folder of the library's crate.
///
/// # Errors
/// Outside of the repository.
pub fn folder() -> Result<PathBuf, SetUpError> {
    Ok(repository::root()?.join("host-tests/c"))
}

/// Whether the compiler for microcontrollers is there.
pub fn has_compiler() -> bool {
    on_path(GCC).is_some()
}

/// Installs that compiler if it is missing; gives its version.
///
/// # Errors
/// If it cannot be had.
pub fn set_up(progress: &Progress) -> Result<String, SetUpError> {
    if !has_compiler() {
        apt_install(&PACKAGES, progress).map_err(SetUpError::NoToolchain)?;
    }
    let said = output(Command::new(GCC).arg("--version"))?;
    Ok(said.lines().next().unwrap_or_default().to_owned())
}

/// Builds the library and returns its file.
///
/// # Errors
/// Missing tools or an error of the compiler.
pub fn library(core: Core, progress: &Progress) -> Result<PathBuf, SetUpError> {
    let target = match core {
        Core::M4 => Board::M4.target(),
        Core::M33 => Board::M33.target(),
        Core::Host | Core::Sanitized => return for_host(core, progress),
    };
    let toolchain = Toolchain::set_up(target, progress)?;
    let folder_of_target = toolchain.target_folder()?;
    let mut cargo = toolchain.cargo();
    cargo.current_dir(folder()?).args(["build", "--profile", "abort", "--locked", "--target", target]);
    cargo.arg("--target-dir").arg(&folder_of_target);
    progress.during(&format!("building the C library for {target}"), || output(&mut cargo))?;
    Ok(folder_of_target.join(target).join("abort/libpalpate.a"))
}

fn for_host(core: Core, progress: &Progress) -> Result<PathBuf, SetUpError> {
    let folder_of_target = repository::root()?.join("target");
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    without_outer_cargo(&mut cargo);
    cargo
        .current_dir(folder()?)
        .args(["build", "--profile", "abort", "--locked", "--target-dir"])
        .arg(&folder_of_target);
    let mut built = folder_of_target;
    if core == Core::Sanitized {
        // The sanitizer is of the compiler's unstable options, of which a stable one asks for this word; its run-time
        // part is gcc's. With the target named it is not for build scripts, which run without one.
        let host = host()?;
        cargo.env("RUSTC_BOOTSTRAP", "1").env("RUSTFLAGS", "-Zsanitizer=address -Zexternal-clangrt");
        cargo.args(["--target", &host]);
        built.push(host);
    }
    progress.during("building the C library for this machine", || output(&mut cargo))?;
    Ok(built.join("abort/libpalpate.a"))
}

/// A shared library out of the static one of this machine: it exports the functions of the header.
///
/// # Errors
/// An error of the linker.
pub fn shared(library: &Path, out: &Path) -> anyhow::Result<()> {
    let exported = out.with_extension("map");
    fs::write(&exported, "{ global: palpate_*; local: *; };\n")?;
    let mut gcc = Command::new("cc");
    gcc.args(["-shared", "-Wl,--whole-archive"]).arg(library).args(["-Wl,--no-whole-archive", "-Wl,--gc-sections"]);
    gcc.args(["-Wl,-soname,libpalpate.so", "-Wl,--strip-debug"]);
    output(gcc.arg(format!("-Wl,--version-script={}", exported.display())).arg("-o").arg(out))?;
    Ok(fs::remove_file(exported)?)
}

/// Takes the debugger's tables, and so the builder's paths, out of a library, if the tool for that is there.
///
/// # Errors
/// An error of that tool.
pub fn strip(core: Core, library: &Path) -> Result<(), SetUpError> {
    let program = if core.arduino().is_empty() { "strip" } else { "arm-none-eabi-strip" };
    if on_path(program).is_some() {
        output(Command::new(program).arg("--strip-debug").arg(library))?;
    }
    Ok(())
}

/// The compiler's name for this machine.
fn host() -> Result<String, SetUpError> {
    let mut rustc = Command::new("rustc");
    let said = output(without_outer_cargo(&mut rustc).arg("-vV"))?;
    let host = said.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| SetUpError::NoToolchain("rustc -vV names no host".to_owned()))
}

/// A C or C++ compiler for a core, with the header's folder and all warnings as errors.
///
/// # Errors
/// Outside of the repository.
pub fn compiler(core: Core, program: &str) -> Result<Command, SetUpError> {
    let mut gcc = match core {
        Core::M4 | Core::M33 => Command::new(format!("arm-none-eabi-{program}")),
        Core::Host | Core::Sanitized => Command::new(program),
    };
    gcc.args(core.gcc()).args(["-Wall", "-Wextra", "-Werror", "-O2"]);
    gcc.arg("-I").arg(folder()?.join("include"));
    Ok(gcc)
}

/// Builds the example for the emulated board, with a body's file and a device's constants in it; returns the image with its emulator.
///
/// # Errors
/// Missing tools or an error of a compiler.
pub fn example(body: &Path, device: &ShippedDevice, elf: &Path, progress: &Progress) -> Result<Program, SetUpError> {
    let library = library(Core::M4, progress)?;
    let folder = folder()?.join("examples/cube");
    let mut gcc = compiler(Core::M4, "gcc")?;
    gcc.args(["-std=c11", "-ffunction-sections", "-fdata-sections"]).arg("-I").arg(folder.join("Core/Inc"));
    gcc.arg(format!("-DPART=\"{}\"", body.display()));
    let beside = elf.parent().unwrap_or(elf);
    let header = beside.join("device.h");
    fs::write(&header, c_preset(device)).map_err(SetUpError::io(header.display()))?;
    gcc.arg("-I").arg(beside);
    for source in ["main.c", "board.c", "startup_mps2.c", "part.S"] {
        gcc.arg(folder.join("Core/Src").join(source));
    }
    gcc.arg(library).arg("-T").arg(folder.join("mps2_an386.ld"));
    gcc.args(["-nostartfiles", "--specs=nosys.specs", "-Wl,--gc-sections", "-o"]).arg(elf);
    progress.during("compiling the example in C", || output(&mut gcc))?;
    Program::of_image(Board::M4, elf, progress)
}
