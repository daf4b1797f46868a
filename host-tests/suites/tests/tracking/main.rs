//! The closest point on a patch: what is certified, what is measured, and golden points. Each module says which
//! variables make its runs long.

mod certificates;
mod golden_pairs;
mod guarantee;
mod limits;
mod located;
mod pairs;
mod poles;
mod proxy;
mod sweep;
mod tools;
