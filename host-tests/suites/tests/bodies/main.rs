//! Bodies of several patches: Voronoi regions, the two-level tracker, the global start.
//!
//! `PALPATE_PROBES`, `PALPATE_TICKS` and `PALPATE_STARTS` set the numbers for long runs.

mod anywhere;
mod borders;
mod bore;
mod brushes;
mod cold;
mod converging;
mod drawn;
mod files;
mod locator;
mod placement;
mod plate;
mod refusals;
mod regions;
mod rides;
mod ring;
mod scene;
mod signs;
mod soft;
mod tour;
mod tracker;
mod uneven;
mod walk;
