//! What a run shows: its figures as text, and one HTML file with the plots inside.

mod html;
pub mod plots;
mod summary;

pub use html::{Page, write_page};
pub use summary::{Instructions, Summary};
