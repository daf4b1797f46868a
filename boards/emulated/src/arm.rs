//! A Cortex-M: the board's timers and UART, the counter of instructions, and how a program of either kind starts.

use cortex_m::peripheral::{NVIC, Peripherals, SYST, syst::SystClkSource};
use cortex_m_rt::{ExceptionFrame, exception};
use palpate_bench::Port;
use vcell::VolatileCell;

use crate::board::Board;
use crate::vectors::Position;
pub use cortex_m_rt::entry;

/// The registers of an APB timer (Arm CMSDK technical reference, "APB timer").
#[repr(C)]
struct TimerRegisters {
    control: VolatileCell<u32>,
    value: VolatileCell<u32>,
    reload: VolatileCell<u32>,
    interrupt: VolatileCell<u32>,
}

/// How far behind the first timer the second one lies.
const SECOND_TIMER: usize = 0x1000;

const ENABLE: u32 = 1;
const ENABLE_INTERRUPT: u32 = 1 << 3;

impl Board {
    fn registers(&self) -> &'static TimerRegisters {
        // SAFETY: the address is the chip's, the block is there for good, and a `VolatileCell` may be shared; main
        // writes it before the interrupt is unmasked and the handler after.
        unsafe { &*(self.timer as *const TimerRegisters) }
    }

    /// Starts the servo's interrupt, `rate` Hz; the first one comes a whole period later.
    pub fn start_timer(&self, rate: f32) {
        let timer = self.registers();
        let reload = (self.clock as f32 / rate) as u32 - 1;
        timer.reload.set(reload);
        timer.value.set(reload);
        timer.control.set(ENABLE | ENABLE_INTERRUPT);
        self.acknowledge_timer();
        NVIC::unpend(Position(self.timer_interrupt));
        // SAFETY: no critical section is broken: main does nothing from here on but sleep.
        unsafe { NVIC::unmask(Position(self.timer_interrupt)) };
    }

    /// Extends this period by a number of counts: for the tests that must detect it.
    pub fn delay_timer(&self, counts: u32) {
        let timer = self.registers();
        timer.value.set(timer.value.get() + counts);
    }

    /// Takes the interrupt back, so that the next period can raise it again.
    #[inline]
    pub fn acknowledge_timer(&self) {
        self.registers().interrupt.set(1);
    }
}

/// The second timer, which runs freely at the board's clock: what the telemetry measures time with.
pub struct Clock(&'static TimerRegisters);

// SAFETY: it only ever reads a register that counts by itself, from whichever interrupt holds it.
unsafe impl Send for Clock {}

impl Clock {
    /// Starts it.
    pub fn start(board: &Board) -> Self {
        // SAFETY: the address is the chip's, the block is there for good, and a `VolatileCell` may be shared.
        let timer = unsafe { &*((board.timer + SECOND_TIMER) as *const TimerRegisters) };
        timer.reload.set(u32::MAX);
        timer.value.set(u32::MAX);
        timer.control.set(ENABLE);
        Self(timer)
    }

    /// The count, which rises and wraps at 32 bits.
    #[inline]
    pub fn now(&self) -> u32 {
        !self.0.value.get()
    }
}

/// SysTick, which runs freely at the core's clock.
///
/// Under `-icount shift=6` an instruction takes 64 ns of the emulator's time, 1.6 ticks at 25 MHz, 1.28 at 20 MHz: a
/// count is right to one instruction. 24 bits: right as long as the work is shorter than 0.67 s.
pub(crate) struct Ticks(());

impl Ticks {
    pub(crate) const MASK: u32 = 0x00ff_ffff;

    /// Takes SysTick, so that nobody else sets it, and starts it; `None` if the core's peripherals were taken before.
    pub(crate) fn take() -> Option<Self> {
        Peripherals::take().map(|core| Self::new(core.SYST))
    }

    pub(crate) fn new(mut systick: SYST) -> Self {
        systick.set_clock_source(SystClkSource::Core);
        systick.set_reload(Self::MASK);
        systick.clear_current();
        systick.enable_counter();
        Self(())
    }

    pub(crate) const fn frequency(board: &Board) -> u32 {
        board.clock
    }

    /// The count, which rises.
    #[inline(always)]
    pub(crate) fn now(&self) -> u32 {
        !SYST::get_current()
    }
}

/// The registers of an APB UART (Arm CMSDK technical reference, "APB UART").
#[repr(C)]
struct UartRegisters {
    data: VolatileCell<u32>,
    state: VolatileCell<u32>,
    control: VolatileCell<u32>,
    interrupt: VolatileCell<u32>,
    divider: VolatileCell<u32>,
}

const TRANSMIT_FULL: u32 = 1;
const RECEIVE_FULL: u32 = 1 << 1;
const ENABLE_BOTH: u32 = 3;
/// The emulator takes any; the board's clock comes near enough, and 16 is the minimum divider of the hardware.
const BAUD: u32 = 921_600;

/// The UART, byte by byte.
pub struct Uart(&'static UartRegisters);

impl Uart {
    /// Switches it on. Make one only: two would steal each other's bytes.
    pub fn new(board: &Board) -> Self {
        // SAFETY: the address is the chip's, the block is there for good, and a
        // `VolatileCell` may be shared.
        let registers = unsafe { &*(board.uart as *const UartRegisters) };
        registers.divider.set(board.clock / BAUD);
        registers.control.set(ENABLE_BOTH);
        Self(registers)
    }
}

impl Port for Uart {
    #[inline]
    fn send(&mut self, byte: u8) -> bool {
        let is_free = self.0.state.get() & TRANSMIT_FULL == 0;
        if is_free {
            self.0.data.set(u32::from(byte));
        }
        is_free
    }

    #[inline]
    fn receive(&mut self) -> Option<u8> {
        (self.0.state.get() & RECEIVE_FULL != 0).then(|| self.0.data.get() as u8)
    }
}

// SAFETY: it touches no state, so it does not matter where the fault struck.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    crate::panic::stop()
}

/// A program that does this alone.
#[macro_export]
macro_rules! program {
    ($body:expr) => {
        #[$crate::processor::entry]
        fn main() -> ! {
            $body
        }
    };
}

/// A program whose loop ticks in the timer's interrupt: its type, the rate, Hz, and the way to its link.
#[macro_export]
macro_rules! ticking {
    ($servo_loop:ty, $rate:expr, $link:expr) => {
        use $crate::vectors::interrupt;

        $crate::program!({
            $crate::board::BOARD.start_timer($rate);
            loop {
                cortex_m::asm::wfi();
            }
        });

        static PLACE: static_cell::StaticCell<$servo_loop> = static_cell::StaticCell::new();

        #[interrupt]
        fn TIMER0() {
            // Made in an interrupt of its own, in the only place that uses it: no lock is needed to hand it over, and
            // the first tick is on time, though checking the tables takes longer than a period.
            static mut SERVO_LOOP: Option<&'static mut $servo_loop> = None;

            $crate::board::BOARD.acknowledge_timer();
            if let Some(servo_loop) = SERVO_LOOP {
                servo_loop.tick();
            } else {
                *SERVO_LOOP = $crate::timer::InstructionCounter::take(&$crate::board::BOARD)
                    .and_then(|counter| PLACE.try_init(<$servo_loop>::new(&$crate::board::BOARD, $link, counter)));
                $crate::board::BOARD.start_timer($rate);
            }
        }
    };
}
