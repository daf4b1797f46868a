//! From an address to the source.

use std::path::{Path, PathBuf};

/// A line of the source that an instruction came from.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// The file.
    pub file: PathBuf,
    /// The line, from 1.
    pub line: u32,
    /// The function it stands in.
    pub function: String,
}

/// The line tables of an image.
pub struct Lines(addr2line::Loader);

impl Lines {
    /// Of an image.
    ///
    /// # Errors
    /// If there are none.
    pub fn read(path: &Path) -> Result<Self, Box<dyn std::error::Error>> {
        Ok(Self(addr2line::Loader::new(path)?))
    }

    /// The lines an instruction came from, the innermost first: a function that was inlined, then where it was called, and
    /// so on.
    pub fn places(&self, address: u64) -> Vec<Place> {
        let mut places = Vec::new();
        let Ok(mut frames) = self.0.find_frames(address) else { return places };
        while let Ok(Some(frame)) = frames.next() {
            let Some(location) = frame.location else { continue };
            let function = frame.function.and_then(|name| name.raw_name().ok().map(|name| name.into_owned()));
            let function = function.map_or_else(String::new, |name| format!("{:#}", rustc_demangle::demangle(&name)));
            let (Some(file), Some(line)) = (location.file, location.line) else { continue };
            places.push(Place { file: PathBuf::from(file), line, function });
        }
        places
    }
}
