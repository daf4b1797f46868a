//! What a scene is held to: `cargo test -p palpate-sim --test scene`.

mod books;
mod common;
mod effects;
mod files;
mod loops;
mod motion;
mod orders;
mod several;
mod soft;
mod switching;
