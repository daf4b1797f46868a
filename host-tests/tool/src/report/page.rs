//! What a page shows.

use crate::simulation::Trace;
use std::borrow::Cow;

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
