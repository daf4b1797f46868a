//! The chip around the loop: turns of main, clocks, the watchdog, the break of the set-points' timer, memory. The checks
//! are the boards' own ([`Idle`], [`ClockCheck`], [`ProgramCheck`]); what the registers do to lines and outputs is a
//! model, which the row's test shows in the boards' images.

use palpate::device::Kinematics;
use palpate::scene::Commanded;
use palpate::servo::Guard;
use palpate::wire::Record;
use palpate::wire::telemetry::Queue;
use palpate_bench::{
    Cause, ClockCheck, Copied, Counter, Idle, Mailbox, Memo, Port, ProgramCheck, ResetFlags, Settings, WINDOW_MS,
    Watchdog, heartbeat,
};
use palpate_sim::rig::{CLOCK, RATE, Rig};
use std::cell::{Cell, RefCell};
use std::rc::Rc;

/// Turns of main in a tick: with half of its time in ticks, 2,600 cycles of a Nucleo each.
const TURNS: u32 = 8;
/// The longest time of a watchdog, with a host, and that of an oscillator a tenth slow, ms.
const TIMEOUT_MS: f64 = 1.1 * 40.0;
/// Of the oscillator that the clock is compared with, Hz.
const OSCILLATOR_HZ: u32 = 1_000_000;
/// Words of the protected image's program.
const WORDS: u32 = 12_750;

/// Failures of the chip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChipFailures {
    /// Neither ticks nor main go on.
    pub hangs: bool,
    /// The core locks up, which the break of the set-points' timer sees.
    pub locks_up: bool,
    /// Main feeds the watchdog in each turn.
    pub feeds_always: bool,
    /// Rate of the oscillator beside the clock, as a fraction of the right one.
    pub oscillator: f64,
    /// The word of the program that was compared last changes.
    pub word_changes: bool,
}

const WORKS: ChipFailures =
    ChipFailures { hangs: false, locks_up: false, feeds_always: false, oscillator: 1.0, word_changes: false };

#[derive(Clone, Debug, Default)]
struct Oscillator(Rc<Cell<f64>>);

impl Oscillator {
    fn advance(&self, counts: f64) {
        self.0.set(self.0.get() + counts);
    }
}

impl Counter for Oscillator {
    fn now(&self) -> u32 {
        // It wraps.
        self.0.get() as u64 as u32
    }
}

/// The program in RAM: the image of each word is its number.
#[derive(Clone, Debug)]
struct Program(Rc<RefCell<Vec<u32>>>);

impl Copied for Program {
    fn words(&self, at: usize) -> Option<[u32; 2]> {
        self.0.borrow().get(at).map(|word| [*word, at as u32])
    }
}

/// A watchdog with a window.
#[derive(Debug, Default)]
struct Window {
    now_ms: f64,
    fed_ms: f64,
    has_fired: bool,
}

impl Watchdog for Window {
    fn feed(&mut self) {
        self.has_fired |= self.now_ms - self.fed_ms < f64::from(WINDOW_MS);
        self.fed_ms = self.now_ms;
    }
}

struct NoLine;

impl Port for NoLine {
    fn send(&mut self, _: u8) -> bool {
        true
    }

    fn receive(&mut self) -> Option<u8> {
        None
    }
}

/// A chip whose program runs.
pub(super) struct Chip {
    pub failures: ChipFailures,
    runs: bool,
    is_watched: bool,
    memo: Memo,
    idle: Idle<'static>,
    clocks: ClockCheck<Oscillator, Oscillator>,
    oscillators: [Oscillator; 2],
    program: ProgramCheck<Program, 1>,
    ram: Program,
    compared: usize,
    watchdog: Window,
}

impl Chip {
    /// After a reset.
    pub fn new(mailbox: &'static Mailbox) -> Self {
        let queue: &'static mut Queue<Record, 2> = Box::leak(Box::new(Queue::new()));
        let oscillators = [Oscillator::default(), Oscillator::default()];
        let ram = Program(Rc::new(RefCell::new((0..WORDS).collect())));
        let [clock, other] = oscillators.clone();
        Self {
            failures: WORKS,
            runs: true,
            is_watched: true,
            memo: Memo::new(Cause::Running),
            idle: Idle::new(mailbox, queue.split().1, heartbeat(RATE as f32)),
            clocks: ClockCheck::new((clock, CLOCK), (other, OSCILLATOR_HZ)),
            oscillators,
            program: ProgramCheck::new([ram.clone()]),
            ram,
            compared: 0,
            watchdog: Window::default(),
        }
    }

    /// The memory test comes before the program; where bits stick it does not start.
    pub fn start_with_sticking_bits(&mut self) {
        self.runs = !sticking_bits_are_found();
        self.is_watched = self.runs;
    }

    /// A tick of the loop, a period of the device and main's turns in it.
    pub fn tick<K, G, const JOINTS: usize, S>(&mut self, rig: &mut Rig<K, G, JOINTS, S>, settings: &Settings)
    where
        K: Kinematics<JOINTS> + 'static,
        G: Guard<JOINTS> + 'static,
        S: Commanded + 'static,
    {
        if self.failures.locks_up {
            rig.set(|world| world.outputs_open = true);
        }
        self.runs &= !self.failures.hangs && !self.failures.locks_up;
        if self.runs {
            rig.bench.tick();
        }
        rig.world.borrow_mut().advance();
        self.oscillators[0].advance(f64::from(CLOCK) / RATE);
        self.oscillators[1].advance(self.failures.oscillator * f64::from(OSCILLATOR_HZ) / RATE);
        self.watchdog.now_ms += 1e3 / RATE;
        for _ in 0..TURNS {
            if self.runs && !self.turn() {
                // As the panic handler does.
                (self.runs, self.memo) = (false, Memo::new(Cause::Panic));
                rig.set(|world| world.enables = [false; 3]);
            }
        }
        // It runs from the program's start on.
        if !self.is_watched {
            return;
        }
        if self.watchdog.has_fired || self.watchdog.now_ms - self.watchdog.fed_ms > TIMEOUT_MS {
            rig.restart(settings, ResetFlags { watchdog: true, ..ResetFlags::default() }.reason(self.memo));
            *self = Self::new(rig.mailbox);
        }
    }

    /// A turn of main; false if it panics.
    fn turn(&mut self) -> bool {
        self.idle.step(&mut NoLine, &mut self.watchdog);
        if self.failures.feeds_always {
            self.watchdog.feed();
        }
        if self.failures.word_changes {
            // Until its turn comes again a whole pass goes by.
            self.ram.0.borrow_mut()[self.compared.saturating_sub(1)] = u32::MAX;
            self.failures.word_changes = false;
        }
        let program = self.program.step();
        self.compared = if program == Ok(false) { 0 } else { (self.compared + 1).min(WORDS as usize) };
        program.is_ok() && self.clocks.step().is_ok()
    }
}

/// Memory a bit of which sticks: its word, its mask and the level.
struct Sticking {
    words: [u32; 64],
    place: usize,
    mask: u32,
    level: u32,
}

impl Sticking {
    fn read(&self, at: usize) -> u32 {
        if at == self.place { self.words[at] & !self.mask | self.level & self.mask } else { self.words[at] }
    }

    /// March X, step by step as the boards' `__pre_init` does before Rust runs; false if a bit sticks.
    fn holds_its_bits(&mut self) -> bool {
        const PATTERN: u32 = 0xa5a5_a5a5;
        self.words.fill(PATTERN);
        for at in 0..self.words.len() {
            if self.read(at) != PATTERN {
                return false;
            }
            self.words[at] = !PATTERN;
        }
        for at in (0..self.words.len()).rev() {
            if self.read(at) != !PATTERN {
                return false;
            }
            self.words[at] = PATTERN;
        }
        (0..self.words.len()).all(|at| self.read(at) == PATTERN)
    }
}

/// Whether the memory test keeps the program from starting whatever bit sticks, at either level.
fn sticking_bits_are_found() -> bool {
    (0..64 * 64).all(|bit: usize| {
        let (place, mask, level) = (bit / 64, 1 << (bit / 2 % 32), if bit.is_multiple_of(2) { 0 } else { u32::MAX });
        !Sticking { words: [0; 64], place, mask, level }.holds_its_bits()
    })
}
