//! The commands of `palpate`, one file each: its arguments and what it does.

pub mod accept;
pub mod bake;
pub mod budgets;
pub mod check;
pub mod closest;
pub mod commission;
pub mod cycles;
pub mod demo;
pub mod demo_knob;
pub mod device;
pub mod felt;
pub mod figures;
pub mod firmware;
pub mod image;
pub mod import;
pub mod monitor;
pub mod options;
mod output;
pub mod page;
pub mod parts;
pub mod progress;
pub mod race;
pub mod rate;
pub mod sim;
mod table_report;
pub mod test;
pub mod zwidth;
