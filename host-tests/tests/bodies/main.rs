//! Bodies of several patches: Voronoi regions, the two-level tracker, the global start.
//!
//! `PALPATE_PROBES`, `PALPATE_TICKS` and `PALPATE_STARTS` set the numbers for long runs.

mod cold;
mod converging;
mod plate;
mod regions;
mod scene;
mod tour;
mod tracker;
mod walk;
