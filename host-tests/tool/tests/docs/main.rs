//! The documents, held to the code: what they say of commands, files, messages, frames, numbers and pictures is what
//! there is.
//!
//! `PALPATE_WRITE=1 cargo test -p palpate-tool --test docs` writes anew what can be written.

mod columns;
mod commands;
mod file_page;
mod imports;
mod links;
mod mathematics;
mod model_format;
mod numbers;
mod pages;
mod pictures;
mod readme;
mod references;
mod variables;
mod wire_page;
