//! What a run shows: its figures as text, and one HTML file with the plots inside.

mod html;
mod page;
pub mod plots;
mod summary;

pub use html::{Section, write_page, write_sections};
pub use page::Page;
pub use summary::{Instructions, Summary};
