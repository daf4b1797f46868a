//! The browser that the page is tested in.

use super::compile::TARGET;
use crate::firmware::{Progress, SetUpError, Toolchain, apt_install, on_path};
use std::path::{Path, PathBuf};

/// What Chromium is called.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// A Chromium.
#[derive(Clone, Debug)]
pub struct Browser {
    path: PathBuf,
}

impl Browser {
    /// The one that is there, with a compiler for the page; `None` where something would have to be installed.
    pub fn at_hand() -> Option<Self> {
        Self::found().filter(|_| Toolchain::is_at_hand(TARGET))
    }

    /// The one that is there, or Debian's, installed where that needs no password.
    ///
    /// # Errors
    /// That there is none.
    pub fn set_up(progress: &Progress) -> Result<Self, SetUpError> {
        if let Some(found) = Self::found() {
            return Ok(found);
        }
        apt_install(&["chromium"], progress).map_err(SetUpError::NoBrowser)?;
        Self::found().ok_or_else(|| SetUpError::NoBrowser("it is still missing after installing it".to_owned()))
    }

    fn found() -> Option<Self> {
        NAMES.iter().find_map(|name| on_path(name)).map(|path| Self { path })
    }

    /// The program.
    pub fn path(&self) -> &Path {
        &self.path
    }
}
