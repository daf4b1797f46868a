//! Bodies of several patches: Voronoi regions, the two-level tracker, the global start.

mod cold;
mod plate;
mod regions;
mod scene;
mod walk;
