//! What the tool's commands take, refuse and print.

mod baking;
mod body_file;
mod cache;
mod deform;
mod figures;
mod from_cad;
mod golden;
mod installed;
mod jogging;
mod outside;
mod pair;
mod protected_demo;
mod queries;
mod race;
mod race_on_target;
mod recordings;
mod refusals;
mod talking;
mod unread;
