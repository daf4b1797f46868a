//! The page for the browser: the firmware's code as wasm, three.js and the page's own modules in one HTML file.

mod browser;
mod bundle;
mod compile;
mod recording;
mod serve;

pub use browser::Browser;
pub use bundle::{Given, Shown, bundle};
pub use compile::{TARGET, compile, compiled};
pub use recording::{Cut, Loop, RecordedBody, RecordedScene, Recording};
pub use serve::serve;
