//! The servo loop against the simulated device, against faults and against arbitrary sensors.

mod faults;
mod fuzz;
mod harmed;
mod homing;
mod limits;
mod passivity;
mod surfaces;
mod touch;
mod traces;
mod velocity;
mod weight;
