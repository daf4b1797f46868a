//! Sensors and drives at their pins: frame by frame against what the data sheets say, and against the simulated device.

mod drives;
mod sensors;
mod simulated;
mod three_phase;
