//! The renderings of the library by name, as options and recordings have them.

use clap::ValueEnum;
use palpate::servo::Rendering;

/// `Rendering`'s constants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Smoothing {
    Smooth,
    Eased,
    Plain,
}

impl Smoothing {
    /// The library's constant.
    pub const fn rendering(self) -> Rendering {
        match self {
            Self::Smooth => Rendering::SMOOTH,
            Self::Eased => Rendering::EASED,
            Self::Plain => Rendering::PLAIN,
        }
    }

    /// Its name in a recording.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Eased => "eased",
            Self::Plain => "plain",
        }
    }

    /// As Rust source.
    pub const fn source(self) -> &'static str {
        match self {
            Self::Smooth => "palpate::servo::Rendering::SMOOTH",
            Self::Eased => "palpate::servo::Rendering::EASED",
            Self::Plain => "palpate::servo::Rendering::PLAIN",
        }
    }
}
