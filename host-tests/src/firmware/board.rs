//! The emulated boards.

use super::repository;
use clap::ValueEnum;
use std::path::PathBuf;

/// An emulated board. All run the same programs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, ValueEnum)]
pub enum Board {
    /// mps2-an386, a Cortex-M4F.
    #[default]
    M4,
    /// mps2-an500, a Cortex-M7.
    M7,
    /// mps2-an505, a Cortex-M33.
    M33,
}

impl Board {
    /// Every board.
    pub const ALL: [Self; 3] = [Self::M4, Self::M7, Self::M33];

    /// The word for it on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::M4 => "m4",
            Self::M7 => "m7",
            Self::M33 => "m33",
        }
    }

    /// The core, as its maker calls it.
    pub const fn core(self) -> &'static str {
        match self {
            Self::M4 => "Cortex-M4F",
            Self::M7 => "Cortex-M7",
            Self::M33 => "Cortex-M33",
        }
    }

    /// The emulator's name for it.
    pub const fn machine(self) -> &'static str {
        match self {
            Self::M4 => "mps2-an386",
            Self::M7 => "mps2-an500",
            Self::M33 => "mps2-an505",
        }
    }

    /// The compiler's name for its kind of core.
    pub const fn target(self) -> &'static str {
        match self {
            Self::M4 | Self::M7 => "thumbv7em-none-eabihf",
            Self::M33 => "thumbv8m.main-none-eabihf",
        }
    }

    /// Its crate's folder.
    pub fn folder(self) -> PathBuf {
        repository().join("boards").join(format!("qemu-{}", self.name()))
    }
}
