//! Report of a run: its figures as text, and one HTML file that contains the plots.

mod html;
mod plots;
mod summary;

pub use html::{Report, Section, Table};
pub use plots::{path, sections};
pub use summary::{Instructions, Summary, contacts_lost};
