//! A knob on a Nucleo-G474RE: a SimpleFOCShield with a gimbal motor, a magnetic sensor behind it, a button that asks
//! for force and one that chooses the feel.
//!
//! The loop is that of every board (`boards/src`), in the interrupt of TIM7; here are this one's
//! pins. `docs/howto/knob.md` has the wiring; `palpate_bench::knob` is the file to change first.

#![no_std]
#![no_main]

mod bus;
mod choice;
mod currents;
mod felt;
mod stage;

use cortex_m::peripheral::NVIC;
use cortex_m_rt::entry;
use embedded_hal::spi::MODE_1;
use palpate::device::drive::NoPin;
use palpate::wire::Record;
use palpate::wire::telemetry::Queue;
use palpate_bench::cortex::{Shared, program_check};
use palpate_bench::knob::{CHOPPER, CURRENTS, JOG, SETTINGS, SUPPLY};
use palpate_bench::sensors::{Angles, Bounded, max_step};
use palpate_bench::store::KeptFeels;
use palpate_bench::{
    Bench, Cause, Chopped, Chopper, ClockCheck, CurrentWatched, CycleDelay, Idle, Lines, Memo, OneChannel, Parts,
    ReadBack, Settings, heartbeat,
};
use palpate_stm32g4::flash::{Bank2, watched};
use palpate_stm32g4::{
    CLOCK, Clock, Iwdg, MEMO, Slow, Ticks, Volts, accept, converters, open_port, option_bytes, start,
};
use stm32g4xx_hal::gpio::{AF5, AnyPin, Input, Output, PA5, PA6, PA7, PB6, PC1, PinState};
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::stm32::{Interrupt, Peripherals, interrupt};
use stm32g4xx_hal::time::RateExtU32;

use crate::bus::Spi;
use crate::choice::Choice;
use crate::currents::Shunts;
use crate::felt::{DEVICE, This};
use crate::stage::Stage;

const BENCH: Settings = Settings { supply: Some(SUPPLY), jog: Some(JOG), ..Settings::new(CLOCK) };

type Pin = AnyPin<Input>;
type Sensor = Angles<Bounded<Spi>, PB6<Output>, CycleDelay<Clock>, 1>;
type Drive = ReadBack<CurrentWatched<[Stage; 1], Shunts>>;
type Supply = Chopped<Volts, PC1<Output>>;
type Board = Parts<Clock, Ticks, Sensor, Drive, OneChannel<Pin>, Pin, Pin, Supply, NoPin, 2>;
type Loop = Bench<'static, This, Board, 1>;

static SHARED: Shared<Loop> = Shared::new();

#[interrupt]
fn TIM7() {
    static mut TAKEN: Option<&'static mut Loop> = None;

    SHARED.tick(TAKEN);
}

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Record, 16> = Queue::new();
    static mut LOOP: Option<Loop> = None;

    stage::motors_off();
    let (Some(mut core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        panic!("the peripherals are taken here and nowhere else")
    };
    accept(option_bytes(&chip.FLASH));
    let (mut rcc, reset) = start(chip.RCC, chip.PWR, &chip.FLASH);
    let clock = Clock::start(chip.TIM5, &chip.DBGMCU, &mut rcc);
    let (a, b, c) = (chip.GPIOA.split(&mut rcc), chip.GPIOB.split(&mut rcc), chip.GPIOC.split(&mut rcc));

    // The stage first: not enabled.
    let enable = a.pa9.into_push_pull_output();
    let phases = (b.pb10.into_alternate(), c.pc7.into_alternate(), b.pb4.into_alternate());
    let stage = stage::stage((chip.TIM2, chip.TIM3), phases, enable, &mut rcc);

    let select = b.pb6.into_push_pull_output_in_state(PinState::High);
    let bus: (PA5<AF5>, PA6<AF5>, PA7<AF5>) = (a.pa5.into_alternate(), a.pa6.into_alternate(), a.pa7.into_alternate());
    // The next divider that there is makes 5.3 MHz; of 8 MHz the HAL would make 10.6, and the sensor takes 10.
    let (bus, _) = chip.SPI1.spi(bus, MODE_1, 5.MHz(), &mut rcc).release();
    let step = max_step(&DEVICE.encoders[0], DEVICE.max_joint_rate_rad_per_s, SETTINGS.rate_hz, BENCH.bad_frames);
    let mut sensor = Angles::new(Bounded(Spi(bus)), [select], CycleDelay::new(clock, CLOCK), [step]);
    // If it does not start the loop says so, tick by tick.
    let _ = sensor.start();
    let mut port = open_port(chip.USART2, a.pa2.into_alternate(), a.pa3.into_alternate(), &mut rcc);
    let mut delay = CycleDelay::new(clock, CLOCK);
    let converters = converters(chip.ADC12_COMMON, &mut rcc);
    let shunts = Shunts::new(chip.ADC2, &converters, (a.pa0.into_analog(), a.pa4.into_analog()), &mut delay);
    let volts = Volts::new(chip.ADC1, &converters, b.pb1.into_analog(), &mut delay);

    let board = Parts {
        counter: clock,
        timer: Ticks::start(chip.TIM7, (CLOCK as f32 / SETTINGS.rate_hz) as u16, &mut rcc),
        sensors: sensor,
        drives: ReadBack::new(CurrentWatched::new([stage], shunts, CURRENTS), stage::reads_enabled as fn() -> bool),
        lines: Lines {
            // The blue button: high while pressed.
            enable: OneChannel { pin: c.pc13.into_floating_input().erase(), pressed_level: true },
            stop: c.pc0.into_pull_up_input().erase(),
            // The shield's fault and reset lines, both high while it is well, whichever of the two goes where.
            ready: [b.pb0.into_pull_down_input().erase(), a.pa1.into_pull_down_input().erase()],
            supply: Chopped::new(volts, c.pc1.into_push_pull_output(), Chopper::new(CHOPPER, SETTINGS.rate_hz)),
        },
        // The board's light hangs on the bus's clock.
        light: NoPin,
    };
    let mut choice = Choice::new(a.pa10.into_pull_up_input(), clock);
    let (producer, records) = QUEUE.split();
    let knob = LOOP.insert(Bench::new(This, board, &BENCH, reset, producer, &SHARED.mailbox));
    // Where a body would lie: this image has none. A chip of one bank keeps nothing.
    let kept = Bank2::try_new(chip.FLASH).map(|[page, _]| {
        let ((kept, feel), is_damaged) = watched(|| KeptFeels::find(page));
        // Without a feel that can be read, that this version understands and that the motor bears, the table's first.
        let is_refused = match feel {
            _ if is_damaged => true,
            Some(feel) => knob.restore(feel).is_err(),
            None => false,
        };
        if is_refused {
            kept.refused();
        }
        kept
    });
    SHARED.hand_over(knob);
    MEMO.write(Memo::new(Cause::Running));
    let mut program = program_check();
    program.all();
    let mut clocks = ClockCheck::new((clock, CLOCK), (Slow::start(chip.LPTIMER1), Slow::FREQUENCY));
    // After the 25 ms that a page of flash takes to be erased, for which main waits, the motor held off.
    let mut watchdog = Iwdg::start(chip.IWDG, 40);
    // SAFETY: the interrupt takes what is handed over, and main touches nothing of it any more.
    unsafe {
        core.NVIC.set_priority(Interrupt::TIM7, 0);
        NVIC::unmask(Interrupt::TIM7);
    }
    let mut idle = Idle::new(&SHARED.mailbox, records, heartbeat(SETTINGS.rate_hz)).saying(SETTINGS.rate_hz, 0.0);
    if let Some(flash) = &kept {
        idle = idle.keeping_feels(flash);
    }
    loop {
        idle.step(&mut port, &mut watchdog);
        choice.look(&SHARED.mailbox);
        if let Err(wrong) = clocks.step() {
            panic!("{wrong}");
        }
        let _ = program.step();
    }
}
