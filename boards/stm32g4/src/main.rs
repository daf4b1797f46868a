//! palpate on a Nucleo-G474RE: three encoders, three current amplifiers, a button that asks for force.
//!
//! The servo runs in the interrupt of TIM7, which nothing can delay; below it `main` sends telemetry and feeds the
//! watchdog. What both do is the loop of every board (`boards/bench`); here are this one's clocks, pins and memory. The
//! README has the wiring; [`body`] is what to change first.

#![no_std]
#![no_main]

mod amplifiers;
mod body;
mod chip;
mod encoders;
#[cfg_attr(feature = "host", path = "host/felt.rs")]
#[cfg_attr(not(feature = "host"), path = "../../felt.rs")]
mod felt;
#[cfg(feature = "host")]
mod host;
mod port;
#[path = "../../program.rs"]
mod program;
#[cfg(feature = "analog")]
#[path = "voltage.rs"]
mod set_points;
#[cfg(not(feature = "analog"))]
#[path = "pulse_width.rs"]
mod set_points;
mod set_up;
mod supply;
mod ticks;

use cortex_m_rt::entry;
use palpate::wire::telemetry::Queue;
use stm32g4xx_hal::stm32::interrupt;

use crate::program::{Loop, Message};
use crate::set_up::Board;

#[interrupt]
fn TIM7() {
    static mut TAKEN: Option<&'static mut Loop> = None;

    program::tick(TAKEN);
}

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Message, 16> = Queue::new();
    static mut LOOP: Option<Loop> = None;

    set_up::set_up(QUEUE, LOOP).run()
}
