//! From the witness point to a force: [`Contact`] decides whether the surface is touched, [`Penalty`] how it pushes back.

mod contact;
mod penalty;

pub use contact::Contact;
pub use penalty::Penalty;
