//! palpate on a Raspberry Pi Pico 2: three magnetic angle sensors, three bridges, a button that asks for force.
//!
//! The servo runs in the interrupt of a PWM slice that is used as a timer; nothing can delay it. Below it `main` sends
//! telemetry and feeds the watchdog. The README has the wiring; [`body`] is what to change first.

#![no_std]
#![no_main]

mod body;
mod hot;
mod panic;
mod sensors;

use core::cell::Cell;
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::{DWT, NVIC};
use critical_section::Mutex;
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal_bus::util::AtomicCell;
use palpate::device::Duty;
use palpate::device::drive::{Drive, HBridge};
use palpate::servo::{Deadline, Event, Heartbeat, Input, Phase, ResetReason, ServoState};
use palpate::wire::Record;
use palpate::wire::frame::{self, MAX_FRAME};
use palpate::wire::telemetry::{Queue, Recorder};
use rp235x_hal::clocks::{Clock, init_clocks_and_plls};
use rp235x_hal::fugit::{ExtU32, RateExtU32};
use rp235x_hal::gpio::bank0::{Gpio11, Gpio13, Gpio15, Gpio16, Gpio17, Gpio18, Gpio25};
use rp235x_hal::gpio::{FunctionSio, Pin, Pins, PullDown, PullUp, SioInput, SioOutput};
use rp235x_hal::pac::{Interrupt, Peripherals, interrupt};
use rp235x_hal::pwm::{A, Channel, FreeRunning, Pwm0, Pwm5, Pwm6, Pwm7, Slice, Slices};
use rp235x_hal::uart::{DataBits, StopBits, UartConfig, UartPeripheral};
use rp235x_hal::{Sio, Spi, Watchdog, block::ImageDef, entry};

use crate::body::{SERVO, SETTINGS};
use crate::sensors::{Bus, Sensors};

/// Told to the boot ROM: a program for the secure state of an Arm core.
#[unsafe(link_section = ".start_block")]
#[used]
// SAFETY: nothing else lies in this section; the boot ROM reads it.
static IMAGE: ImageDef = ImageDef::secure_exe();

const CRYSTAL: u32 = 12_000_000;
/// What the HAL sets the core to.
const CLOCK: u32 = 150_000_000;
/// Counts of a PWM slice a tick; 16 bits hold it down to 2,289 Hz.
const PERIOD: u16 = {
    let counts = CLOCK as f32 / SETTINGS.rate;
    assert!(counts <= 65_536.0, "the rate is too low for a slice without divider");
    (counts - 1.0) as u16
};
const DEADLINE: Deadline = Deadline::of_period(CLOCK as f32, SETTINGS.rate);
/// 20 kHz for the motors.
const MOTOR_PERIOD: u16 = (CLOCK / 20_000 - 1) as u16;
/// 921,600 baud carry about 1,200 records a second; at 4 kHz this makes 200.
const TICKS_PER_RECORD: u32 = 20;
/// The pin that switches the bridges on.
pub const ENABLE_PIN: u32 = 16;

/// Output A of a slice and a direction pin.
type Bridge<S, P> = HBridge<Channel<Slice<S, FreeRunning>, A>, Output<P>>;
type Output<P> = Pin<P, FunctionSio<SioOutput>, PullDown>;
type Switch<P> = Pin<P, FunctionSio<SioInput>, PullUp>;

/// What the interrupt owns.
struct Loop {
    timer: Slice<Pwm0, FreeRunning>,
    sensors: Sensors,
    bridges: (Bridge<Pwm5, Gpio11>, Bridge<Pwm6, Gpio13>, Bridge<Pwm7, Gpio15>),
    /// High switches all bridges on.
    enable: Output<Gpio16>,
    /// Low while force is asked for.
    button: Switch<Gpio17>,
    /// Low when a bridge reports a fault.
    fault: Switch<Gpio18>,
    /// Lit while there is force.
    light: Output<Gpio25>,
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
            Ok(counts) => Input::Sensors { counts, enable: self.button.is_low().unwrap_or(false) },
            Err(_) => Input::Damaged,
        };
        if self.fault.is_low().unwrap_or(true) {
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

    /// Applies the state's duties; in any phase that has none the bridges are off.
    #[inline]
    fn drive(&mut self) {
        let running = self.state.phase() == Phase::Running;
        let [duty_a, duty_b, duty_c] = if running { self.state.duties() } else { [Duty::ZERO; 3] };
        let (a, b, c) = &mut self.bridges;
        let obeyed = self.enable.set_state(running.into()).is_ok()
            & self.light.set_state(running.into()).is_ok()
            & a.apply(duty_a).is_ok()
            & b.apply(duty_b).is_ok()
            & c.apply(duty_c).is_ok();
        if !obeyed {
            // No pin of this chip refuses; the type allows for one that does.
            SERVO.note(&mut self.state, Event::DriveFault);
        }
    }
}

#[interrupt]
fn PWM_IRQ_WRAP_0() {
    // Taken at the first tick: from then on no lock is needed.
    static mut LOOP: Option<Loop> = None;

    if LOOP.is_none() {
        *LOOP = critical_section::with(|section| HANDED_OVER.borrow(section).take());
    }
    if let Some(servo_loop) = LOOP {
        servo_loop.timer.clear_interrupt();
        servo_loop.tick();
    }
}

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Record, 16> = Queue::new();
    static mut BUS: Option<AtomicCell<Bus>> = None;

    let (Some(mut core), Some(mut chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else { unreachable() };
    let reset = reset_reason(&chip.WATCHDOG);
    let mut watchdog = Watchdog::new(chip.WATCHDOG);
    let Ok(clocks) = init_clocks_and_plls(
        CRYSTAL,
        chip.XOSC,
        chip.CLOCKS,
        chip.PLL_SYS,
        chip.PLL_USB,
        &mut chip.RESETS,
        &mut watchdog,
    ) else {
        panic!("the crystal does not start")
    };
    let sio = Sio::new(chip.SIO);
    let pins = Pins::new(chip.IO_BANK0, chip.PADS_BANK0, sio.gpio_bank0, &mut chip.RESETS);

    // Motors first: off.
    let enable = pins.gpio16.into_push_pull_output();
    let mut slices = Slices::new(chip.PWM, &mut chip.RESETS);
    slices.pwm5.set_top(MOTOR_PERIOD);
    slices.pwm6.set_top(MOTOR_PERIOD);
    slices.pwm7.set_top(MOTOR_PERIOD);
    slices.pwm5.channel_a.output_to(pins.gpio10);
    slices.pwm6.channel_a.output_to(pins.gpio12);
    slices.pwm7.channel_a.output_to(pins.gpio14);
    slices.pwm5.enable();
    slices.pwm6.enable();
    slices.pwm7.enable();
    let bridges = (
        HBridge::new(slices.pwm5.channel_a, pins.gpio11.into_push_pull_output()),
        HBridge::new(slices.pwm6.channel_a, pins.gpio13.into_push_pull_output()),
        HBridge::new(slices.pwm7.channel_a, pins.gpio15.into_push_pull_output()),
    );

    let lines = (pins.gpio3.reconfigure(), pins.gpio4.reconfigure(), pins.gpio2.reconfigure());
    let speed = clocks.peripheral_clock.freq();
    let bus: Bus =
        Spi::<_, _, _, 8>::new(chip.SPI0, lines).init(&mut chip.RESETS, speed, 8.MHz(), embedded_hal::spi::MODE_1);
    let (a, b, c) = (
        pins.gpio5.into_push_pull_output_in_state(true.into()),
        pins.gpio6.into_push_pull_output_in_state(true.into()),
        pins.gpio7.into_push_pull_output_in_state(true.into()),
    );
    let Ok(mut sensors) = Sensors::start(BUS.insert(AtomicCell::new(bus)), a, b, c) else {
        panic!("a sensor is missing")
    };
    let mut button = pins.gpio17.into_pull_up_input();
    let fault = pins.gpio18.into_pull_up_input();
    let light = pins.gpio25.into_push_pull_output();

    let settings = UartConfig::new(921_600.Hz(), DataBits::Eight, None, StopBits::One);
    let lines = (pins.gpio0.into_function(), pins.gpio1.into_function());
    let Ok(serial) = UartPeripheral::new(chip.UART0, lines, &mut chip.RESETS).enable(settings, speed) else {
        panic!("the speed is one that the port has")
    };

    // Homing: the counts are zero where the arm is held when the button goes down.
    while button.is_high().unwrap_or(true) {}
    if sensors.zero().is_err() {
        panic!("a sensor failed");
    }

    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
    let (producer, mut records) = QUEUE.split();
    let mut timer = slices.pwm0;
    timer.set_top(PERIOD);
    timer.enable_interrupt0();
    timer.enable();
    let servo_loop = Loop {
        timer,
        sensors,
        bridges,
        enable,
        button,
        fault,
        light,
        state: SERVO.start_after(reset),
        recorder: Recorder::new(producer, CLOCK, TICKS_PER_RECORD),
    };
    critical_section::with(|section| HANDED_OVER.borrow(section).set(Some(servo_loop)));
    // SAFETY: the interrupt takes what is handed over, and main touches nothing of it any more.
    unsafe {
        core.NVIC.set_priority(Interrupt::PWM_IRQ_WRAP_0, 0);
        NVIC::unmask(Interrupt::PWM_IRQ_WRAP_0);
    }

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
            serial.write_full_blocking(bytes);
        }
    }
}

/// The hardware is taken once, at the start.
fn unreachable() -> ! {
    panic!("the peripherals are taken at the start and nowhere else")
}

fn reset_reason(watchdog: &rp235x_hal::pac::WATCHDOG) -> ResetReason {
    let reason = watchdog.reason().read();
    if reason.timer().bit_is_set() {
        ResetReason::Watchdog
    } else if reason.force().bit_is_set() {
        ResetReason::Software
    } else {
        // Power-on, the run pin, a debugger or a brown-out: this register does not tell them apart.
        ResetReason::PowerOn
    }
}
