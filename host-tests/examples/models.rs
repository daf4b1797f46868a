//! Writes the model files that are generated to `host-tests/models`.

use palpate_host::generate::bodies;
use std::path::Path;

fn main() -> std::io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    for model in bodies::all() {
        std::fs::write(folder.join(model.file), model.text)?;
    }
    Ok(())
}
