//! palpate on a Teensy 4.1: three magnetic angle sensors, three current amplifiers, a button that asks for force.
//!
//! The servo runs in the interrupt of the periodic timer (PIT), which nothing can delay. Below it `main` sends
//! telemetry and feeds the watchdog. What both do is the loop of every board (`boards/bench`); here are this one's
//! clocks, pins and memory ([`set_up`]). The README has the wiring; [`body`] is what to change first, `build.rs` the
//! memory map.

#![no_std]
#![no_main]

mod body;
mod chip;
#[path = "../../felt.rs"]
mod felt;
#[cfg(feature = "host")]
#[path = "../../host_memory.rs"]
mod host;
mod port;
#[path = "../../program.rs"]
mod program;
mod pulse_width;
mod set_up;
mod supply;
mod ticks;
mod usb;
mod watchdog;

use imxrt_rt::{entry, interrupt};
use palpate::wire::telemetry::Queue;
use teensy4_bsp::interrupt;

use crate::program::{Loop, Message};
use crate::set_up::Board;

#[interrupt]
fn PIT() {
    static mut TAKEN: Option<&'static mut Loop> = None;

    program::tick(TAKEN);
}

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Message, 16> = Queue::new();
    static mut LOOP: Option<Loop> = None;

    set_up::set_up(QUEUE, LOOP).run()
}
