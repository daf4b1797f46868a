//! From an address to the source.

use super::{Function, Loop};
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

    /// The lines an instruction came from, the innermost first: a function that was inlined, then where it was called,
    /// and so on.
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

    /// The function of the source that a loop is in: the innermost that its ways back have in common, apart from the
    /// core library's iterators. Empty if that is not known.
    pub fn home(&self, function: &Function, found: &Loop) -> String {
        let goes_back = |address: &&u64| {
            let (next, _) = function.successors(&function.instructions[*address]);
            next.iter().any(|target| found.heads.contains(target))
        };
        let mut chains = found.body.iter().filter(goes_back).map(|address| {
            let mut chain = self.places(*address);
            chain.reverse();
            chain
        });
        let mut common = chains.next().unwrap_or_default();
        for chain in chains {
            let same = common.iter().zip(&chain).take_while(|(one, other)| one.function == other.function).count();
            common.truncate(same);
        }
        while common.last().is_some_and(Place::is_core) {
            common.pop();
        }
        common.pop().map(|place| place.function).unwrap_or_default()
    }
}

impl Place {
    /// Whether it is in the core library.
    pub fn is_core(&self) -> bool {
        self.file.to_string_lossy().contains("/library/core/")
    }
}
