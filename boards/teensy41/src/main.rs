//! palpate on a Teensy 4.1: three magnetic angle sensors, three current amplifiers, a button that asks for force.
//!
//! The servo runs in the interrupt of the periodic timer (PIT), which nothing can delay. Below it `main` sends
//! telemetry and feeds the watchdog. Both are the loop of every board (`boards/src`); here are this one's
//! clocks, pins and memory ([`set_up`]). The README has the wiring; [`body`] is what to change first, `build.rs` the
//! memory map.

#![no_std]
#![no_main]

mod body;
mod bus;
mod chip;
mod fault_input;
mod port;
mod pulse_width;
mod set_up;
mod supply;
mod ticks;
mod usb;
mod watchdog;

use crate::body::This;
use crate::set_up::Board;
use imxrt_rt::{entry, interrupt};
use palpate::wire::telemetry::Queue;
use palpate_bench::cortex::{Shared, Ticking};
use teensy4_bsp::interrupt;

/// The loop, or with the feature `accept` the tick of a board that is being accepted: it has no way to drive a motor.
#[cfg(not(feature = "accept"))]
type Loop = palpate_bench::Bench<'static, This, Board, 3>;
#[cfg(feature = "accept")]
type Loop = palpate_bench::accept::Acceptance<'static, This, Board, 3>;
/// Its telemetry.
type Message = <Loop as Ticking>::Message;

static SHARED: Shared<Loop> = Shared::new();

#[interrupt]
fn PIT() {
    static mut TAKEN: Option<&'static mut Loop> = None;

    SHARED.tick(TAKEN);
}

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Message, 16> = Queue::new();
    static mut LOOP: Option<Loop> = None;

    let below = set_up::set_up(QUEUE, LOOP);
    #[cfg(feature = "accept")]
    below.examine(&SHARED.mailbox, &This, &set_up::BENCH);
    #[cfg(not(feature = "accept"))]
    below.run(&SHARED.mailbox, &body::SETTINGS, &body::offers());
}
