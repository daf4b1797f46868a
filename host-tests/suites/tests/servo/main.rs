//! The servo loop against the simulated device, against faults, against arbitrary sensors and arbitrary frames.

mod arming;
mod damping;
mod faults;
mod frames;
mod fuzz;
mod guard;
mod harmed;
mod homing;
mod injection;
mod jogging;
mod knob;
mod limits;
mod motion;
mod mujoco;
mod no_alarm;
mod passivity;
mod protected;
mod signs;
mod surfaces;
mod through;
mod touch;
mod traces;
mod tuning;
mod velocity;
mod watched;
mod weight;
