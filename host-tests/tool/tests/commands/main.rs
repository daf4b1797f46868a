//! What the tool's commands take, refuse and print.

mod cache;
mod figures;
mod installed;
mod outside;
mod queries;
mod race;
mod talking;
