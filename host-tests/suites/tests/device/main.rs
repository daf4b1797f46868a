//! Devices: their mathematics against simulated ones, their sensors and drives at the pins.

mod mechanisms;
mod own;
mod pins;
mod wooden_haptics;
