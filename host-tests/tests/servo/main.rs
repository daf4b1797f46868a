//! The servo loop against the simulated device, against faults and against arbitrary sensors.

mod faults;
mod fuzz;
mod surfaces;
mod traces;
