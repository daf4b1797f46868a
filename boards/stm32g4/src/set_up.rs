//! Clocks, pins and memory, in an order in which no motor moves.

use cortex_m::peripheral::NVIC;
use palpate::device::SupplyRange;
use palpate::wire::telemetry::Queue;
use palpate_bench::cortex::{Below, Cycles, program_check};
use palpate_bench::sensors::{Counters, max_steps};
use palpate_bench::{
    Cause, ClockCheck, ClocksDisagree, CycleDelay, Lines, Memo, OneChannel, Parts, Port, RECORDS_HZ, ReadBack,
    Settings, tick_counts,
};
use palpate_stm32g4::{CLOCK, Clock, Iwdg, MEMO, Slow, Ticks, Volts, converters, open_port, option_bytes, start};
use stm32g4xx_hal::gpio::{AnyPin, Input};
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::stm32::{Interrupt, Peripherals};

use crate::body::RATE_HZ;
use crate::encoders::Encoders;
#[cfg(not(feature = "analog"))]
use crate::pulse_width as set_points;
#[cfg(feature = "analog")]
use crate::voltage as set_points;
use crate::{Loop, Message, SHARED, amplifiers};
use set_points::{Drives, Light};

/// The settings of this board's loop.
pub const BENCH: Settings = Settings {
    supply: Some(SupplyRange::TWENTY_FOUR),
    needs_host: false,
    ticks_per_record: RATE_HZ / RECORDS_HZ,
    ..Settings::new(CLOCK)
};

/// Cycles of a tick; 16 bits hold it down to 2,595 Hz.
const PERIOD: u16 = {
    let counts = tick_counts(CLOCK, RATE_HZ);
    assert!(counts <= u16::MAX as u32, "the rate is too low for the timer without divider");
    counts as u16
};

/// The watchdog's timeout, ms: with a host after the 25 ms that a page of flash takes to be erased, motors held off.
const TIMEOUT_MS: u32 = if cfg!(feature = "host") { 40 } else { 20 };

type Pin = AnyPin<Input>;
/// The parts that the loop runs on.
pub type Board =
    Parts<Clock, Ticks, Counters<Encoders, 3>, ReadBack<Drives>, OneChannel<Pin>, Pin, Pin, Volts, Light, 3>;

/// Sets all up, in an order in which no motor moves.
#[inline(never)]
pub fn set_up(
    queue: &'static mut Queue<Message, 16>,
    servo_loop: &'static mut Option<Loop>,
) -> Below<Message, impl Port, impl FnMut() -> Result<(), ClocksDisagree>, impl FnOnce() -> Iwdg> {
    let (Some(mut core), Some(chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        panic!("the peripherals are taken here and nowhere else")
    };
    amplifiers::motors_off();
    let options = option_bytes(&chip.FLASH);
    let (mut rcc, reset) = start(chip.RCC, chip.PWR, &chip.FLASH);
    let cycles = Cycles::start(&mut core.DCB, core.DWT);
    let clock = Clock::start(chip.TIM5, &chip.DBGMCU, &mut rcc);
    let (a, b, c) = (chip.GPIOA.split(&mut rcc), chip.GPIOB.split(&mut rcc), chip.GPIOC.split(&mut rcc));

    // Motors first: not enabled.
    let enables = (c.pc0.into_push_pull_output(), c.pc1.into_push_pull_output(), c.pc2.into_push_pull_output());
    let ways = (b.pb13.into_push_pull_output(), b.pb14.into_push_pull_output(), b.pb15.into_push_pull_output());
    let mut delay = CycleDelay::new(clock, CLOCK);
    #[cfg(not(feature = "analog"))]
    let (outputs, light) = (
        set_points::outputs(
            chip.TIM1,
            (a.pa8.into_alternate(), a.pa9.into_alternate(), a.pa10.into_alternate()),
            b.pb12.into_pull_down_input().into_alternate(),
            (&chip.DBGMCU, &chip.SYSCFG),
            &mut rcc,
        ),
        a.pa5.into_push_pull_output(),
    );
    #[cfg(feature = "analog")]
    let (outputs, light) = (
        set_points::outputs(
            (chip.DAC1, chip.DAC2),
            (a.pa4.into_analog(), a.pa5.into_analog(), a.pa6.into_analog()),
            &mut delay,
            &mut rcc,
        ),
        palpate::device::drive::NoPin,
    );
    let drives = amplifiers::amplifiers(outputs, enables, ways, set_points::RANGE, set_points::DWELL);
    let drives = ReadBack::new(set_points::guarded(drives), amplifiers::reads_enabled as fn() -> bool);

    // Once the light can say so. An image that drives nothing reports them.
    #[cfg(not(feature = "accept"))]
    palpate_stm32g4::accept(options);

    let pins = (
        (a.pa0.into_alternate(), a.pa1.into_alternate(), b.pb10.into_pull_down_input().into_alternate()),
        (c.pc6.into_alternate(), c.pc7.into_alternate(), c.pc8.into_pull_down_input().into_alternate()),
        (b.pb6.into_alternate(), b.pb7.into_alternate(), b.pb9.into_pull_down_input().into_alternate()),
    );
    let encoders = Encoders::new((chip.TIM2, chip.TIM3, chip.TIM4), pins, &mut rcc);
    #[cfg(feature = "host")]
    let felt = crate::host::find(chip.FLASH);
    #[cfg(not(feature = "host"))]
    let felt = crate::body::This;
    let port = open_port(chip.USART2, a.pa2.into_alternate(), a.pa3.into_alternate(), &mut rcc);

    let board = Parts {
        counter: clock,
        timer: Ticks::start(chip.TIM7, PERIOD, &mut rcc),
        sensors: Counters::new(encoders, max_steps(&felt, BENCH.bad_frames)),
        drives,
        lines: Lines {
            // The blue button: high while pressed.
            enable: OneChannel { pin: c.pc13.into_floating_input().erase(), pressed_level: true },
            stop: b.pb0.into_pull_up_input().erase(),
            ready: [
                c.pc3.into_pull_down_input().erase(),
                c.pc4.into_pull_down_input().erase(),
                c.pc5.into_pull_down_input().erase(),
            ],
            supply: Volts::new(chip.ADC1, &converters(chip.ADC12_COMMON, &mut rcc), b.pb1.into_analog(), &mut delay),
        },
        light,
    };
    let (producer, messages) = queue.split();
    let made = Loop::new(felt, board, &BENCH, reset, producer, &SHARED.mailbox);
    SHARED.hand_over(servo_loop.insert(made));
    MEMO.write(Memo::new(Cause::Running));
    let mut clocks = ClockCheck::new((clock, CLOCK), (Slow::start(chip.LPTIMER1), Slow::FREQUENCY));
    let start_ticks = move || {
        let watchdog = Iwdg::start(chip.IWDG, TIMEOUT_MS);
        // SAFETY: the interrupt takes what is handed over, and main touches nothing of it any more.
        unsafe {
            core.NVIC.set_priority(Interrupt::TIM7, 0);
            NVIC::unmask(Interrupt::TIM7);
        }
        watchdog
    };
    Below {
        messages,
        cycles,
        reset,
        options,
        port,
        clocks: move || clocks.step(),
        program: program_check(),
        start: start_ticks,
    }
}
