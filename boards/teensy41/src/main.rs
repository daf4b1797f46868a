//! palpate on a Teensy 4.1: three magnetic angle sensors, three current amplifiers, a button that asks for force.
//!
//! The servo runs in the interrupt of the periodic timer (PIT), which nothing can delay. Below it `main` sends
//! telemetry and feeds the watchdog. The README has the wiring; [`body`] is what to change first, `build.rs` is the
//! memory map.

#![no_std]
#![no_main]

mod body;
mod panic;
mod pulse_width;
mod sensors;
mod watchdog;

use core::cell::Cell;
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::{DWT, NVIC};
use critical_section::Mutex;
use embedded_hal_bus::util::AtomicCell;
use imxrt_rt::{entry, interrupt};
use palpate::device::drive::{Drive, SetPointDrive, SetPointRange};
use palpate::servo::{Deadline, Event, Heartbeat, Input, Phase, ServoState};
use palpate::wire::Record;
use palpate::wire::frame::{self, MAX_FRAME};
use palpate::wire::telemetry::{Queue, Recorder};
use teensy4_bsp::board::{self, ARM_FREQUENCY, Lpspi, LpspiPins, Lpuart, PERCLK_FREQUENCY};
use teensy4_bsp::hal::flexpwm::SM;
use teensy4_bsp::hal::gpio::{Input as PinInput, Output};
use teensy4_bsp::hal::iomuxc::{self, Config, PullKeeper};
use teensy4_bsp::hal::lpspi::MODE_1;
use teensy4_bsp::hal::pit::{Channel::Chan0, Pit};
use teensy4_bsp::{Interrupt, interrupt};

use crate::body::{SERVO, SETTINGS};
use crate::pulse_width::PulseWidth;
use crate::sensors::Sensors;
use crate::watchdog::{Watchdog, reset_reason};

/// Counts of the periodic timer a tick.
const PERIOD: u32 = (PERCLK_FREQUENCY as f32 / SETTINGS.rate) as u32;
const DEADLINE: Deadline = Deadline::of_period(ARM_FREQUENCY as f32, SETTINGS.rate);
/// 921,600 baud carry about 1,200 records a second; at 4 kHz this makes 200.
const TICKS_PER_RECORD: u32 = 20;
/// Pins 16, 17 and 18, which enable the amplifiers, are these bits of GPIO1.
pub const ENABLE_BITS: u32 = 1 << 23 | 1 << 22 | 1 << 17;

/// What the interrupt owns.
struct Loop {
    timer: Pit,
    sensors: Sensors,
    amplifiers: [SetPointDrive<PulseWidth, Output>; 3],
    /// Low while force is asked for.
    button: PinInput,
    /// Low when an amplifier reports a fault.
    ready: PinInput,
    state: ServoState<3>,
    recorder: Recorder<'static>,
}

/// On its way from main to the interrupt.
static HANDED_OVER: Mutex<Cell<Option<Loop>>> = Mutex::new(Cell::new(None));
/// Ticks done, for the watchdog.
static TICKS: AtomicU32 = AtomicU32::new(0);

impl Loop {
    #[inline]
    fn tick(&mut self) {
        let began = DWT::cycle_count();
        let input = match self.sensors.read() {
            Ok(counts) => Input::Sensors { counts, enable: !self.button.is_set() },
            Err(_) => Input::Damaged,
        };
        if !self.ready.is_set() {
            SERVO.note(&mut self.state, Event::DriveFault);
        }
        SERVO.tick(&mut self.state, input);
        self.drive();
        if DEADLINE.overrun(began, DWT::cycle_count()) {
            SERVO.note(&mut self.state, Event::Overrun);
            self.drive();
        }
        self.recorder.note(&self.state, began, DWT::cycle_count());
        TICKS.store(self.state.ticks(), Ordering::Relaxed);
    }

    /// Applies the state's duties; in any phase that has none the amplifiers are disabled.
    #[inline]
    fn drive(&mut self) {
        let running = self.state.phase() == Phase::Running;
        let mut obeyed = true;
        for (amplifier, duty) in self.amplifiers.iter_mut().zip(self.state.duties()) {
            obeyed &= if running { amplifier.apply(duty).is_ok() } else { amplifier.release().is_ok() };
        }
        if !obeyed {
            // No pin of this chip refuses; the type allows for one that does.
            SERVO.note(&mut self.state, Event::DriveFault);
        }
    }
}

#[interrupt]
fn PIT() {
    // Taken at the first tick: from then on no lock is needed.
    static mut LOOP: Option<Loop> = None;

    if LOOP.is_none() {
        *LOOP = critical_section::with(|section| HANDED_OVER.borrow(section).take());
    }
    if let Some(servo_loop) = LOOP {
        servo_loop.timer.clear_elapsed(Chan0);
        servo_loop.tick();
        // Else the core may leave before the flag is down, and come back at once.
        cortex_m::asm::dsb();
    }
}

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Record, 16> = Queue::new();
    static mut BUS: Option<AtomicCell<Lpspi>> = None;

    let Some(mut core) = cortex_m::Peripherals::take() else {
        panic!("the peripherals are taken at the start and nowhere else")
    };
    let board::Resources { mut pins, mut gpio1, mut gpio2, mut pit, lpspi4, lpuart6, .. } =
        board::t41(board::instances());
    // SAFETY: nothing else uses these two; the board's crate leaves them alone.
    let (reset, watchdog) = unsafe { (imxrt_ral::src::SRC::instance(), imxrt_ral::rtwdog::RTWDOG::instance()) };
    let reset = reset_reason(&reset);

    // Motors first: not enabled, 20 kHz, no force.
    let enables = [gpio1.output(pins.p16).ok(), gpio1.output(pins.p17).ok(), gpio1.output(pins.p18).ok()];
    iomuxc::flexpwm::prepare(&mut pins.p4);
    iomuxc::flexpwm::prepare(&mut pins.p5);
    iomuxc::flexpwm::prepare(&mut pins.p6);
    // SAFETY: each submodule once; from here on only the interrupt sets them.
    let widths = unsafe { [SM::SM0, SM::SM1, SM::SM2].map(|submodule| PulseWidth::start(submodule)) };
    let [Some(enable_a), Some(enable_b), Some(enable_c)] = enables else { panic!("pins 16 to 18 are of GPIO1") };
    let [width_a, width_b, width_c] = widths;
    let range = SetPointRange::TEN_TO_NINETY;
    let amplifiers = [
        SetPointDrive::new(width_a, enable_a, range),
        SetPointDrive::new(width_b, enable_b, range),
        SetPointDrive::new(width_c, enable_c, range),
    ];

    let lines = LpspiPins { sdo: pins.p11, sdi: pins.p12, sck: pins.p13 };
    let mut bus: Lpspi = board::lpspi(lpspi4, lines, 8_000_000);
    bus.set_mode(MODE_1);
    let selects = [gpio2.output(pins.p8).ok(), gpio2.output(pins.p9).ok(), gpio2.output(pins.p10).ok()];
    let [Some(select_a), Some(select_b), Some(select_c)] = selects else { panic!("pins 8 to 10 are of GPIO2") };
    let selects = [select_a, select_b, select_c];
    for select in &selects {
        select.set();
    }
    let Ok(mut sensors) = Sensors::start(BUS.insert(AtomicCell::new(bus)), selects) else {
        panic!("a sensor is missing")
    };

    let pulled_up = Config::zero().set_pull_keeper(Some(PullKeeper::Pullup22k));
    iomuxc::configure(&mut pins.p14, pulled_up);
    iomuxc::configure(&mut pins.p15, pulled_up);
    let (Ok(button), Ok(ready)) = (gpio1.input(pins.p14), gpio1.input(pins.p15)) else {
        panic!("pins 14 and 15 are of GPIO1")
    };
    let mut serial: Lpuart = board::lpuart(lpuart6, pins.p1, pins.p0, 921_600);

    // Homing: the counts are zero where the arm is held when the button goes down.
    while button.is_set() {}
    if sensors.zero().is_err() {
        panic!("a sensor failed");
    }

    core.DCB.enable_trace();
    // On a Cortex-M7 the counter is locked until it is asked for.
    DWT::unlock();
    core.DWT.enable_cycle_counter();
    let (producer, mut records) = QUEUE.split();
    pit.set_load_timer_value(Chan0, PERIOD - 1);
    pit.set_interrupt_enable(Chan0, true);
    pit.enable(Chan0);
    let servo_loop = Loop {
        timer: pit,
        sensors,
        amplifiers,
        button,
        ready,
        state: SERVO.start_after(reset),
        recorder: Recorder::new(producer, ARM_FREQUENCY, TICKS_PER_RECORD),
    };
    critical_section::with(|section| HANDED_OVER.borrow(section).set(Some(servo_loop)));
    // SAFETY: the interrupt takes what is handed over, and main touches nothing of it any more.
    unsafe {
        core.NVIC.set_priority(Interrupt::PIT, 0);
        NVIC::unmask(Interrupt::PIT);
    }

    let mut watchdog = Watchdog::start(watchdog);
    let mut heartbeat = Heartbeat::default();
    let mut buffer = [0; MAX_FRAME];
    loop {
        if heartbeat.may_feed(TICKS.load(Ordering::Relaxed)) {
            watchdog.feed();
        }
        let Some(record) = records.dequeue() else { continue };
        if let Ok(bytes) = frame::pack(&record, &mut buffer) {
            // A record takes about 0.8 ms on the line: well below the watchdog's patience.
            for byte in bytes {
                while !serial.try_write(*byte) {}
            }
        }
    }
}
