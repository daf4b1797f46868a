//! Compares the documents with the code: commands, files, messages, frames, numbers and pictures.
//!
//! `PALPATE_WRITE=1 cargo test -p palpate-tool --test docs` writes the generated parts.

mod book;
mod byte_tables;
mod commands;
mod faults;
mod file_page;
mod links;
mod mathematics;
mod model_format;
mod numbers;
mod pages;
mod pictures;
mod readme;
mod references;
mod transcript;
mod variables;
mod wire_page;
