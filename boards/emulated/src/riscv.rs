//! RISC-V on the emulated machine `virt`: how a program starts, its timer, its UART, the counter of instructions. No
//! interrupt is taken: a loop waits for its tick.

use core::arch::{asm, global_asm};

use palpate_bench::Port;
use vcell::VolatileCell;

use crate::board::Board;

// The emulator loads the ELF file whole, and starts at the lowest address of RAM. Floats are switched on here.
global_asm!(
    ".section .init, \"ax\"",
    ".global _start",
    "_start:",
    "la sp, _stack_start",
    "la t0, 0f",
    "csrw mtvec, t0",
    "li t0, 0x2000",
    "csrs mstatus, t0",
    "call main",
    // Where traps go is a multiple of four.
    ".balign 4",
    "0: j {trap}",
    trap = sym trap,
);

/// Every trap: no code here asks for one.
extern "C" fn trap() -> ! {
    crate::panic::stop()
}

/// The low half of the machine's time, 10 MHz, behind the base of the interrupt controller (CLINT).
const TIME: usize = 0xbff8;
/// The time at which the timer is due, in two halves.
const DUE: usize = 0x4000;

fn register(address: usize) -> &'static VolatileCell<u32> {
    // SAFETY: the address is the machine's, the register is there for good, and a `VolatileCell` may be shared.
    unsafe { &*(address as *const VolatileCell<u32>) }
}

/// The pace of a loop.
pub struct Pace {
    board: &'static Board,
    period: u32,
    due: u32,
}

impl Pace {
    /// `rate` Hz; the first tick comes a whole period later.
    pub fn start(board: &'static Board, rate: f32) -> Self {
        let now = register(board.timer + TIME).get();
        // The emulated time ends long before it takes more than the low half.
        register(board.timer + DUE + 4).set(0);
        // SAFETY: the timer alone may wake the core; interrupts stay off.
        unsafe { asm!("csrs mie, {}", in(reg) 1 << 7) };
        Self { board, period: (board.clock as f32 / rate) as u32, due: now }
    }

    /// Sleeps until the next tick.
    pub fn wait(&mut self) {
        self.due += self.period;
        register(self.board.timer + DUE).set(self.due);
        while (register(self.board.timer + TIME).get().wrapping_sub(self.due) as i32) < 0 {
            // SAFETY: it changes nothing.
            unsafe { asm!("wfi") };
        }
    }
}

/// The machine's time, which runs freely at the board's clock: what the telemetry measures time with.
pub struct Clock(&'static VolatileCell<u32>);

impl Clock {
    /// It runs already.
    pub fn start(board: &Board) -> Self {
        Self(register(board.timer + TIME))
    }

    /// The count, which rises and wraps at 32 bits.
    #[inline]
    pub fn now(&self) -> u32 {
        self.0.get()
    }
}

/// The core's cycles: nanoseconds of the emulator's time, 64 an instruction under `-icount shift=6`. Right as long as the
/// work is shorter than 4 s.
pub(crate) struct Ticks(());

impl Ticks {
    pub(crate) const MASK: u32 = u32::MAX;

    pub(crate) const fn take() -> Option<Self> {
        Some(Self(()))
    }

    pub(crate) const fn frequency(_: &Board) -> u32 {
        1_000_000_000
    }

    /// The count, which rises.
    #[inline(always)]
    pub(crate) fn now(&self) -> u32 {
        let count;
        // SAFETY: it only reads a counter. Not `nomem`: what is counted must not move across it.
        unsafe { asm!("csrr {}, mcycle", out(reg) count, options(nostack)) };
        count
    }
}

/// The machine's UART, a 16550, byte by byte.
pub struct Uart([&'static VolatileCell<u8>; 2]);

const RECEIVED: u8 = 1;
const TRANSMIT_EMPTY: u8 = 1 << 5;

impl Uart {
    /// Its data and its line's state. Make one only: two would steal each other's bytes.
    pub fn new(board: &Board) -> Self {
        // SAFETY: the addresses are the machine's, the registers are there for good, and a `VolatileCell` may be shared.
        Self([0, 5].map(|register| unsafe { &*((board.uart + register) as *const VolatileCell<u8>) }))
    }
}

impl Port for Uart {
    #[inline]
    fn send(&mut self, byte: u8) -> bool {
        let is_free = self.0[1].get() & TRANSMIT_EMPTY != 0;
        if is_free {
            self.0[0].set(byte);
        }
        is_free
    }

    #[inline]
    fn receive(&mut self) -> Option<u8> {
        (self.0[1].get() & RECEIVED != 0).then(|| self.0[0].get())
    }
}

/// A program that does this alone.
#[macro_export]
macro_rules! program {
    ($body:expr) => {
        #[unsafe(no_mangle)]
        extern "C" fn main() -> ! {
            $body
        }
    };
}

/// A program whose loop ticks by the timer: its type, the rate, Hz, and the way to its link.
#[macro_export]
macro_rules! ticking {
    ($servo_loop:ty, $rate:expr, $link:expr) => {
        $crate::program!({
            let board = &$crate::board::BOARD;
            let Some(counter) = $crate::timer::InstructionCounter::take(board) else { panic!("taken here alone") };
            let mut servo_loop = <$servo_loop>::new(board, $link, counter);
            let mut pace = $crate::processor::Pace::start(board, $rate);
            loop {
                pace.wait();
                servo_loop.tick();
            }
        });
    };
}
