//! The servo of every board on the bench: one that feels what it was built with, or with the feature `host` one that a
//! host may order about.

#[cfg_attr(feature = "host", path = "hosted.rs")]
#[cfg_attr(not(feature = "host"), path = "alone.rs")]
mod chosen;

pub use chosen::This;
