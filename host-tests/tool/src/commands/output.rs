//! Where answers go: files that are whole or not there, and standard output.

use anyhow::Context as _;
use std::fs;
use std::io::{self, ErrorKind, Write as _};
use std::path::Path;

/// Writes a file beside its place and then moves it there, so that nobody ever reads half of it.
pub(super) fn write_whole(path: &Path, contents: &[u8]) -> anyhow::Result<()> {
    let name = path.file_name().with_context(|| format!("{}: not the name of a file", path.display()))?;
    let partial = path.with_file_name(format!(".{}.{}.partial", name.to_string_lossy(), std::process::id()));
    let written = fs::write(&partial, contents).and_then(|()| fs::rename(&partial, path));
    if written.is_err() {
        // It may not have come to be; the first error is the one to report.
        let _ = fs::remove_file(&partial);
    }
    written.with_context(|| format!("{}: cannot be written", path.display()))
}

/// Writes to standard output. A reader that has had enough (`| head`) is no failure.
pub(super) fn print(text: &[u8]) -> io::Result<()> {
    let mut output = io::stdout().lock();
    match output.write_all(text).and_then(|()| output.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        outcome => outcome,
    }
}
