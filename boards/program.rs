//! What the image of a board on the bench is: the loop, or with the feature `accept` its acceptance, in which nothing
//! can drive a motor.

use palpate_bench::Mailbox;
use palpate_cortex::HandOver;

pub use chosen::{Loop, Message, below};

/// The loop on its way from main to the interrupt.
pub static HANDED_OVER: HandOver<Loop> = HandOver::new();
/// What passes between them afterwards.
pub static MAILBOX: Mailbox = Mailbox::new();

/// A tick, from the timer's interrupt, which keeps `place` for the loop.
#[inline(always)]
pub fn tick(place: &mut Option<Loop>) {
    // Taken at the first tick: from then on no lock is needed.
    if place.is_none() {
        *place = HANDED_OVER.take();
    }
    if let Some(servo_loop) = place {
        servo_loop.tick();
    }
}

#[cfg(not(feature = "accept"))]
mod chosen {
    use super::MAILBOX;
    use crate::body::SETTINGS;
    use crate::felt::This;
    use palpate::servo::{Heartbeat, ResetReason};
    use palpate::wire::Record;
    use palpate::wire::telemetry::Consumer;
    use palpate_bench::{Bench, Idle, Port, Watchdog};
    use palpate_cortex::Cycles;

    /// The loop.
    pub type Loop = Bench<'static, This, crate::Board, 3>;
    /// What it tells.
    pub type Message = Record;

    /// What runs below it. The watchdog is started here, once everything that takes its time is done.
    pub fn below<W: Watchdog>(
        records: Consumer<'static, Message>,
        _: Cycles,
        _: ResetReason,
        mut port: impl Port,
        start: impl FnOnce() -> W,
    ) -> ! {
        let idle = Idle::new(&MAILBOX, records, Heartbeat::default()).saying(SETTINGS.rate, SETTINGS.max_force);
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

#[cfg(feature = "accept")]
mod chosen {
    use super::MAILBOX;
    use crate::felt::This;
    use palpate::servo::ResetReason;
    use palpate::wire::acceptance::Ticks;
    use palpate::wire::telemetry::Consumer;
    use palpate_bench::accept::{Acceptance, Chip, Examiner};
    use palpate_bench::{Port, Watchdog};
    use palpate_cortex::{Cycles, core_id, fail};

    /// The tick of a board that is being accepted.
    pub type Loop = Acceptance<'static, This, crate::Board, 3>;
    /// What it tells.
    pub type Message = Ticks;

    /// What runs below it. The watchdog is started here, once everything that takes its time is done.
    pub fn below<W: Watchdog>(
        ticks: Consumer<'static, Message>,
        cycles: Cycles,
        reset: ResetReason,
        mut port: impl Port,
        start: impl FnOnce() -> W,
    ) -> ! {
        let chip = Chip { core: core_id(), reset };
        let mut examiner = Examiner::new(&This, &crate::BENCH, chip, &MAILBOX, ticks, cycles);
        let mut watchdog = start();
        loop {
            if let Some(failure) = examiner.step(&mut port, &mut watchdog) {
                fail(failure);
            }
        }
    }
}
