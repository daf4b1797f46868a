//! The firmware's code for the browser.

use crate::firmware::{Progress, SetUpError, Toolchain, output};
use crate::repository;
use std::fs;

/// The compiler's name for a browser.
pub const TARGET: &str = "wasm32-unknown-unknown";

/// Sets up the compiler as far as it is missing, builds the module and gives its bytes.
///
/// # Errors
/// What is missing, or what the compiler says.
pub fn compile(progress: &Progress) -> Result<Vec<u8>, SetUpError> {
    let toolchain = Toolchain::set_up(TARGET, progress)?;
    let target_folder = toolchain.target_folder()?;
    let mut cargo = toolchain.cargo();
    cargo.current_dir(repository::root()?.join("host-tests/page"));
    cargo.args(["build", "--release", "--locked", "--target", TARGET, "--target-dir"]).arg(&target_folder);
    progress.during("building the firmware's code for the browser", || output(&mut cargo))?;
    let module = target_folder.join(TARGET).join("release/palpate_page.wasm");
    fs::read(&module).map_err(SetUpError::io(module.display()))
}
