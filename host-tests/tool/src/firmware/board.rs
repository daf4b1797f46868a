//! The boards: emulated ones, and those for the bench.

use crate::repository::{self, NoRepository};
use clap::ValueEnum;
use clap::builder::PossibleValue;
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

    /// The folder of the crate for all of them.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn folder() -> Result<PathBuf, NoRepository> {
        Ok(repository::root()?.join("boards/emulated"))
    }

    /// The file to pass to cargo's `--config` for this board.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn cargo_config(self) -> Result<PathBuf, NoRepository> {
        Ok(Self::folder()?.join(self.name()).with_extension("toml"))
    }
}

/// A board for the bench, with real encoders and motors. Built here, and not run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BenchBoard {
    /// Nucleo-G474RE, a Cortex-M4F.
    Stm32g4,
    /// Raspberry Pi Pico 2 (RP2350), a Cortex-M33.
    Pico2,
    /// Teensy 4.1 (i.MX RT1062), a Cortex-M7.
    Teensy41,
}

impl BenchBoard {
    /// Every board for the bench.
    pub const ALL: [Self; 3] = [Self::Stm32g4, Self::Pico2, Self::Teensy41];

    /// The word for it on the command line, and its folder.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stm32g4 => "stm32g4",
            Self::Pico2 => "pico2",
            Self::Teensy41 => "teensy41",
        }
    }

    /// The compiler's name for its kind of core.
    pub const fn target(self) -> &'static str {
        match self {
            Self::Stm32g4 | Self::Teensy41 => "thumbv7em-none-eabihf",
            Self::Pico2 => "thumbv8m.main-none-eabihf",
        }
    }

    /// Its crate's folder.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn folder(self) -> Result<PathBuf, NoRepository> {
        Ok(repository::root()?.join("boards").join(self.name()))
    }
}

/// A board of either kind: a crate that cargo can be run for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AnyBoard {
    /// One that runs here.
    Emulated(Board),
    /// One that does not.
    Bench(BenchBoard),
}

impl AnyBoard {
    const ALL: [Self; 6] = [
        Self::Emulated(Board::M4),
        Self::Emulated(Board::M7),
        Self::Emulated(Board::M33),
        Self::Bench(BenchBoard::Stm32g4),
        Self::Bench(BenchBoard::Pico2),
        Self::Bench(BenchBoard::Teensy41),
    ];

    /// The word for it on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Emulated(board) => board.name(),
            Self::Bench(board) => board.name(),
        }
    }

    /// The compiler's name for its kind of core.
    pub const fn target(self) -> &'static str {
        match self {
            Self::Emulated(board) => board.target(),
            Self::Bench(board) => board.target(),
        }
    }

    /// Its crate's folder.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn folder(self) -> Result<PathBuf, NoRepository> {
        match self {
            Self::Emulated(_) => Board::folder(),
            Self::Bench(board) => board.folder(),
        }
    }

    /// The file to pass to cargo's `--config` in addition, if the board needs one.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn cargo_config(self) -> Result<Option<PathBuf>, NoRepository> {
        match self {
            Self::Emulated(board) => board.cargo_config().map(Some),
            Self::Bench(_) => Ok(None),
        }
    }
}

impl Default for AnyBoard {
    fn default() -> Self {
        Self::Emulated(Board::default())
    }
}

impl ValueEnum for AnyBoard {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}
