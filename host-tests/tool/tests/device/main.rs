//! Devices: their mathematics against simulated ones, their sensors and drives at the pins.

mod mechanisms;
mod pins;
mod wooden_haptics;
