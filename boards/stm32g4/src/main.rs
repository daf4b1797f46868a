//! palpate on a Nucleo-G474RE: three encoders, three current amplifiers, a button that asks for force.
//!
//! The servo runs in the interrupt of TIM7, which nothing can delay. Below it `main` sends telemetry and feeds the
//! watchdog. The README has the wiring; [`body`] is what to change first.

#![no_std]
#![no_main]

mod body;
mod encoders;
mod hot;
mod panic;

use core::cell::Cell;
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::interrupt::Mutex;
use cortex_m::peripheral::{DWT, NVIC};
use cortex_m_rt::entry;
use embedded_io::Write;
use palpate::device::drive::{Drive, SetPointDrive, SetPointRange};
use palpate::servo::{Deadline, Event, Heartbeat, Input, Phase, ResetReason, ServoState};
use palpate::wire::Record;
use palpate::wire::frame::{self, MAX_FRAME};
use palpate::wire::telemetry::{Queue, Recorder};
use stm32g4xx_hal::gpio::{Input as PinInput, Output, PA5, PC0, PC1, PC2, PC3, PC13};
use stm32g4xx_hal::independent_watchdog::IndependentWatchdog;
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::pwm::{ActiveHigh, C1, C2, C3, ComplementaryDisabled, Pwm};
use stm32g4xx_hal::pwr::VoltageScale;
use stm32g4xx_hal::rcc::{Config, PllConfig, PllMDiv, PllNMul, PllRDiv, PllSrc};
use stm32g4xx_hal::serial::FullConfig;
use stm32g4xx_hal::stm32::{Interrupt, Peripherals, TIM1, TIM7, interrupt};
use stm32g4xx_hal::time::{ExtU32, RateExtU32};
use stm32g4xx_hal::timer::{CountDownTimer, Event as TimerEvent, Timer};

use crate::body::{SERVO, SETTINGS};
use crate::encoders::Encoders;

/// 16 MHz / 4 · 85 / 2: the most that the chip takes.
const CLOCK: u32 = 170_000_000;
const PERIOD_MICROSECONDS: u32 = (1e6 / SETTINGS.rate) as u32;
const DEADLINE: Deadline = Deadline::of_period(CLOCK as f32, SETTINGS.rate);
/// 921,600 baud carry about 1,200 records a second; at 4 kHz this makes 200.
const TICKS_PER_RECORD: u32 = 20;

/// A channel of TIM1 and an enable pin.
type Amplifier<C, P> = SetPointDrive<Pwm<TIM1, C, ComplementaryDisabled, ActiveHigh, ActiveHigh>, P>;
/// The three, each with its own pins.
type Amplifiers = (Amplifier<C1, PC0<Output>>, Amplifier<C2, PC1<Output>>, Amplifier<C3, PC2<Output>>);

/// What the interrupt owns.
struct Loop {
    timer: CountDownTimer<TIM7>,
    encoders: Encoders,
    amplifiers: Amplifiers,
    /// High while force is asked for.
    button: PC13<PinInput>,
    /// Low when an amplifier reports a fault.
    ready: PC3<PinInput>,
    /// Lit while there is force.
    light: PA5<Output>,
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
        let input = match self.encoders.read() {
            Ok(counts) => Input::Sensors { counts, enable: self.button.is_high() },
            Err(_) => Input::Damaged,
        };
        if self.ready.is_low() {
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
        let (a, b, c) = &mut self.amplifiers;
        let obeyed = if self.state.phase() == Phase::Running {
            self.light.set_high();
            let [duty_a, duty_b, duty_c] = self.state.duties();
            a.apply(duty_a).is_ok() & b.apply(duty_b).is_ok() & c.apply(duty_c).is_ok()
        } else {
            self.light.set_low();
            a.release().is_ok() & b.release().is_ok() & c.release().is_ok()
        };
        if !obeyed {
            // No pin of this chip refuses; the type allows for one that does.
            SERVO.note(&mut self.state, Event::DriveFault);
        }
    }
}

#[interrupt]
fn TIM7() {
    // Taken at the first tick: from then on no lock is needed.
    static mut LOOP: Option<Loop> = None;

    if LOOP.is_none() {
        *LOOP = cortex_m::interrupt::free(|section| HANDED_OVER.borrow(section).take());
    }
    if let Some(servo_loop) = LOOP {
        servo_loop.timer.clear_interrupt(TimerEvent::TimeOut);
        servo_loop.tick();
    }
}

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Record, 16> = Queue::new();

    let (Some(mut core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else { unreachable() };
    let power = chip.PWR.constrain().vos(VoltageScale::Range1 { enable_boost: true }).freeze();
    let pll = PllConfig {
        mux: PllSrc::HSI,
        m: PllMDiv::DIV_4,
        n: PllNMul::MUL_85,
        r: Some(PllRDiv::DIV_2),
        ..PllConfig::default()
    };
    let mut rcc = chip.RCC.freeze(Config::pll().pll_cfg(pll), power);
    let reset = reset_reason(&rcc.get_reset_reason());
    rcc.clear_reset_reason();
    let (a, b, c) = (chip.GPIOA.split(&mut rcc), chip.GPIOB.split(&mut rcc), chip.GPIOC.split(&mut rcc));

    // Motors first: 20 kHz, no force, not enabled.
    let enables = (c.pc0.into_push_pull_output(), c.pc1.into_push_pull_output(), c.pc2.into_push_pull_output());
    let outputs = (a.pa8.into_alternate(), a.pa9.into_alternate(), a.pa10.into_alternate());
    let (mut width_a, mut width_b, mut width_c) = chip.TIM1.pwm(outputs, 20.kHz(), &mut rcc);
    width_a.enable();
    width_b.enable();
    width_c.enable();
    let range = SetPointRange::TEN_TO_NINETY;
    let amplifiers = (
        SetPointDrive::new(width_a, enables.0, range),
        SetPointDrive::new(width_b, enables.1, range),
        SetPointDrive::new(width_c, enables.2, range),
    );

    let pins = (
        (a.pa0.into_alternate(), a.pa1.into_alternate()),
        (a.pa6.into_alternate(), a.pa7.into_alternate()),
        (b.pb6.into_alternate(), b.pb7.into_alternate()),
    );
    let mut encoders = Encoders::new((chip.TIM2, chip.TIM3, chip.TIM4), pins, &mut rcc);
    let button = c.pc13.into_floating_input();
    let ready = c.pc3.into_pull_up_input();
    let light = a.pa5.into_push_pull_output();

    let lines = (a.pa2.into_alternate(), a.pa3.into_alternate());
    let settings = FullConfig::default().baudrate(921_600.bps());
    let Ok(mut serial) = chip.USART2.usart(lines.0, lines.1, settings, &mut rcc) else { unreachable() };

    // Homing: the counts are zero where the arm is held when the button goes down.
    while button.is_low() {}
    encoders.zero();

    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
    let (producer, mut records) = QUEUE.split();
    let mut timer = Timer::new(chip.TIM7, &rcc.clocks).start_count_down(PERIOD_MICROSECONDS.micros());
    timer.listen(TimerEvent::TimeOut);
    let servo_loop = Loop {
        timer,
        encoders,
        amplifiers,
        button,
        ready,
        light,
        state: SERVO.start_after(reset),
        recorder: Recorder::new(producer, CLOCK, TICKS_PER_RECORD),
    };
    cortex_m::interrupt::free(|section| HANDED_OVER.borrow(section).set(Some(servo_loop)));
    // SAFETY: the interrupt takes what is handed over, and main touches nothing of it any more.
    unsafe {
        core.NVIC.set_priority(Interrupt::TIM7, 0);
        NVIC::unmask(Interrupt::TIM7);
    }

    let mut watchdog = IndependentWatchdog::new(chip.IWDG);
    watchdog.start(20.millis());
    let mut heartbeat = Heartbeat::default();
    let mut buffer = [0; MAX_FRAME];
    loop {
        if heartbeat.may_feed(TICKS.load(Ordering::Relaxed)) {
            watchdog.feed();
        }
        let Some(record) = records.dequeue() else { continue };
        if let Ok(bytes) = frame::pack(&record, &mut buffer) {
            // A record takes about 0.8 ms on the line: well below the watchdog's patience.
            let _ = serial.write_all(bytes);
        }
    }
}

/// The hardware is taken once, at the start.
fn unreachable() -> ! {
    panic!("the peripherals are taken at the start and nowhere else")
}

fn reset_reason(flags: &stm32g4xx_hal::rcc::ResetReason) -> ResetReason {
    if flags.independent_watchdog || flags.window_watchdog {
        ResetReason::Watchdog
    } else if flags.brown_out {
        // The chip cannot tell a brown-out from power-on, which raises the same flag.
        ResetReason::PowerOn
    } else if flags.software {
        ResetReason::Software
    } else {
        ResetReason::Pin
    }
}
