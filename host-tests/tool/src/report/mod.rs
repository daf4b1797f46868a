//! What a run shows: its figures as text, and one HTML file with the plots inside.

mod html;
pub mod plots;
mod summary;

use crate::simulation::Trace;
pub use html::{Section, write_page, write_sections};
use std::borrow::Cow;
pub use summary::{Instructions, Summary};

// What a page shows.

/// What goes on the page.
pub struct Page<'a> {
    /// The headline.
    pub title: &'a str,
    /// One sentence: what was run, on what.
    pub subtitle: &'a str,
    /// Name and value of each figure.
    pub figures: &'a [(&'static str, String)],
    /// The run.
    pub trace: &'a Trace,
    /// The surface that was touched, as lines on the page.
    pub net: &'a [Vec<(f64, f64)>],
    /// The file beside it that shows the run in 3-D, if there is one.
    pub replay: Option<Cow<'a, str>>,
}
