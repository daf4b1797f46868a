//! The hand's perception on the devices that ship: the scripts of [`palpate_sim::feel`] on each, as rows of figures.
//!
//! [`rows`] runs them, [`table`] prints them and writes them as CSV, [`plot`] draws the motion beside the threshold,
//! [`clean_stiffness`] finds the stiffest wall without a perceptible buzz.

mod clean;
pub mod plot;
mod rows;
pub mod table;

pub use clean::{Clean, ENCODERS, RATES, TRIED, clean_stiffness, slice};
pub use rows::{Crossed, Row, Wish, rows};
