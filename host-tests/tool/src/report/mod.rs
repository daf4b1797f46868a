//! Report of a run: its figures as text, and one HTML file that contains the plots.

mod html;
pub mod plots;
mod summary;

use crate::simulation::Trace;
pub use html::{Section, write_page, write_sections};
use std::borrow::Cow;
pub use summary::{Instructions, Summary};

// What a page shows.

/// Content of the page.
pub struct Page<'a> {
    /// The headline.
    pub title: &'a str,
    /// One sentence: the run and its device.
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
