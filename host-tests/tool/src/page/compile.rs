//! The firmware's code for the browser.

use crate::firmware::{Progress, SetUpError, Toolchain, output};
use crate::repository;
use std::fs;
use std::path::PathBuf;

/// The compiler's name for a browser.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// Sets up the compiler as far as it is missing, builds the module and gives its bytes.
///
/// # Errors
/// What is missing, or what the compiler says.
pub fn compile(progress: &Progress) -> Result<Vec<u8>, SetUpError> {
    let (toolchain, target_folder, module) = places(progress)?;
    let mut cargo = toolchain.cargo();
    cargo.current_dir(repository::root()?.join("host-tests/page"));
    cargo.args(["build", "--release", "--locked", "--target", TARGET, "--target-dir"]).arg(&target_folder);
    progress.during("building the firmware's code for the browser", || output(&mut cargo))?;
    fs::read(&module).map_err(SetUpError::io(module.display()))
}

/// The module where it has been built here before, as [`compile`] gives it; `None` where that would take setting up.
///
/// # Errors
/// What the compiler says.
pub fn compiled(progress: &Progress) -> Result<Option<Vec<u8>>, SetUpError> {
    if !Toolchain::is_at_hand(TARGET) || !places(progress)?.2.exists() {
        return Ok(None);
    }
    compile(progress).map(Some)
}

/// The compiler, where it builds, and what comes of it.
fn places(progress: &Progress) -> Result<(Toolchain, PathBuf, PathBuf), SetUpError> {
    let toolchain = Toolchain::set_up(TARGET, progress)?;
    let target_folder = toolchain.target_folder()?;
    let module = target_folder.join(TARGET).join("release/palpate_page.wasm");
    Ok((toolchain, target_folder, module))
}
