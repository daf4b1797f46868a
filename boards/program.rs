//! What the image of a board on the bench is: the loop, or with the feature `accept` its acceptance, in which nothing
//! can drive a motor.

use palpate::servo::ResetReason;
use palpate::wire::telemetry::Consumer;
use palpate_bench::Mailbox;
use palpate_cortex::{Cycles, HandOver};

pub use chosen::{Loop, Message};

/// The loop on its way from main to the interrupt: where it lies, for moving it would take as much stack.
pub static HANDED_OVER: HandOver<&'static mut Loop> = HandOver::new();
/// What passes between them afterwards.
pub static MAILBOX: Mailbox = Mailbox::new();

/// A tick, from the timer's interrupt, which keeps in `taken` where the loop is.
#[inline(always)]
pub fn tick(taken: &mut Option<&'static mut Loop>) {
    // At the first tick: from then on no lock is needed.
    if taken.is_none() {
        *taken = HANDED_OVER.take();
    }
    if let Some(servo_loop) = taken {
        servo_loop.tick();
    }
}

/// What runs below the ticks, once all is set up. Main returns from setting up first: that takes most stack of all.
pub struct Below<P, S> {
    /// What the loop tells.
    pub messages: Consumer<'static, Message>,
    /// The core's clock, for the acceptance.
    #[cfg_attr(not(feature = "accept"), expect(dead_code))]
    pub cycles: Cycles,
    /// Why it was reset, likewise.
    #[cfg_attr(not(feature = "accept"), expect(dead_code))]
    pub reset: ResetReason,
    /// The way to a host.
    pub port: P,
    /// Starts the watchdog and the ticks: once everything that takes its time is done.
    pub start: S,
}

#[cfg(not(feature = "accept"))]
mod chosen {
    use super::{Below, MAILBOX};
    use crate::body::SETTINGS;
    use crate::felt::This;
    use palpate::servo::Heartbeat;
    use palpate::wire::Record;
    use palpate_bench::{Bench, Idle, Port, Watchdog};

    /// The loop.
    pub type Loop = Bench<'static, This, crate::Board, 3>;
    /// What it tells.
    pub type Message = Record;

    impl<P: Port, W: Watchdog, S: FnOnce() -> W> Below<P, S> {
        /// Runs it.
        pub fn run(self) -> ! {
            let Self { messages, mut port, start, .. } = self;
            let idle =
                Idle::new(&MAILBOX, messages, Heartbeat::default()).saying(SETTINGS.rate_hz, SETTINGS.max_force_n);
            #[cfg(feature = "host")]
            let ends = crate::host::ends();
            #[cfg(feature = "host")]
            let idle = ends.offer(idle);
            let mut idle = idle;
            let mut watchdog = start();
            loop {
                idle.step(&mut port, &mut watchdog);
            }
        }
    }
}

#[cfg(feature = "accept")]
mod chosen {
    use super::{Below, MAILBOX};
    use crate::felt::This;
    use palpate::wire::acceptance::Ticks;
    use palpate_bench::accept::{Acceptance, Chip, Examiner};
    use palpate_bench::{Port, Watchdog};
    use palpate_cortex::{core_id, fail};

    /// The tick of a board that is being accepted.
    pub type Loop = Acceptance<'static, This, crate::Board, 3>;
    /// What it tells.
    pub type Message = Ticks;

    impl<P: Port, W: Watchdog, S: FnOnce() -> W> Below<P, S> {
        /// Runs it.
        pub fn run(self) -> ! {
            let Self { messages, cycles, reset, mut port, start } = self;
            let chip = Chip { core: core_id(), reset };
            let mut examiner = Examiner::new(&This, &crate::set_up::BENCH, chip, &MAILBOX, messages, cycles);
            let mut watchdog = start();
            loop {
                if let Some(failure) = examiner.step(&mut port, &mut watchdog) {
                    fail(failure);
                }
            }
        }
    }
}
