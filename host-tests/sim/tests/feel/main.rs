//! What scripted hands get of the loop on the devices that ship.

mod edges;
mod plain;
mod rate;
mod shown;
