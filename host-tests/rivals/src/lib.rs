//! The alternatives to palpate that a firmware engineer would write, for the race on the target: `no_std`, single
//! precision, checked indices, bounded work, tables in flash. Each answers one probe a tick with gap, normal and point.

#![no_std]

mod grid;
mod mesh;
mod newton;

pub use grid::Grid;
pub use mesh::{Mesh, NONE, Walk};
pub use newton::Newton;
use palpate::math::Vec3;

/// The answer to a probe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Signed distance, metres; negative inside.
    pub gap_m: f32,
    /// Unit vector out of the body.
    pub normal: Vec3,
    /// The closest point, metres.
    pub point: Vec3,
}

/// Contestants, by their number in the race's files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Contestant {
    /// palpate at the effort that a body has by default.
    Palpate = 0,
    /// palpate with one step and one candidate a tick.
    PalpateOne = 1,
    /// [`Newton`] on palpate's patches.
    Newton = 2,
    /// [`Grid::tricubic`].
    Tricubic = 3,
    /// [`Grid::trilinear`].
    Trilinear = 4,
    /// [`Walk::facets`].
    Facets = 5,
    /// [`Walk::shaded`].
    Shaded = 6,
}

impl Contestant {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 7] =
        [Self::Palpate, Self::PalpateOne, Self::Newton, Self::Tricubic, Self::Trilinear, Self::Facets, Self::Shaded];
}

/// The words of an answer in the race's files: instructions, gap, normal, point.
pub const ANSWER_WORDS: usize = 8;
