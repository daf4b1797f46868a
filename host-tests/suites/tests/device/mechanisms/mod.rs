//! Every preset of the library, in f32, against its simulated device, in f64 and written apart from it.

mod case;
mod closed_loop;
mod kinematics;
mod weight;
