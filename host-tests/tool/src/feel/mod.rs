//! What a hand feels on the devices that ship: the scripts of [`palpate_sim::feel`] on each, as rows of figures.
//!
//! [`rows`] runs them, [`table`] prints them and writes them as CSV, [`plot`] draws what is felt beside the threshold,
//! [`clean_stiffness`] finds the stiffest wall that is not felt to buzz.

mod clean;
pub mod plot;
mod rows;
pub mod table;

pub use clean::{Clean, ENCODERS, RATES, TRIED, clean_stiffness, slice};
pub use rows::{Row, Wish, rows};
