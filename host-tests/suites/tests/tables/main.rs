//! From a model file to the tables: what comes out, and what is refused.

mod body_source;
mod committed;
mod displaced;
mod flaws;
mod models;
mod pair_steps;
mod random_patches;
mod ritz;
mod second_order;
mod splitting;
mod spoiled_files;
mod spoiled_models;
mod spoiled_seams;
mod spoiled_tables;
mod tick_bound;
mod topology;
