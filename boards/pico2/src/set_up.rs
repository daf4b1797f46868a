//! Clocks, pins and memory, in an order in which no motor moves.

use cortex_m::peripheral::NVIC;
use palpate::device::SupplyRange;
use palpate::device::drive::HBridge;
use palpate::wire::telemetry::Queue;
use palpate_bench::cortex::{Below, Cycles, program_check};
use palpate_bench::sensors::{Angles, Bounded, max_steps, ticks_per_round};
use palpate_bench::usb::{Cdc, Either, Plain};
use palpate_bench::{
    Cause, ClocksDisagree, CycleDelay, Lines, OneChannel, OptionBytes, Parts, Port, RECORDS_HZ, ReadBack, Settings,
    Switched,
};
use rp235x_hal::adc::{Adc, AdcPin};
use rp235x_hal::clocks::{Clock as _, init_clocks_and_plls};
use rp235x_hal::fugit::RateExtU32;
use rp235x_hal::gpio::Pins;
use rp235x_hal::pac::{Interrupt, Peripherals};
use rp235x_hal::pwm::Slices;
use rp235x_hal::spi::Spi;
use rp235x_hal::uart::{DataBits, StopBits, UartConfig, UartPeripheral};
use rp235x_hal::{Sio, Watchdog};

use crate::body::{RATE_HZ, SETTINGS, This, own};
use crate::bus;
use crate::chip::{CLOCK, CRYSTAL};
use crate::ring::Ring;
use crate::supply::Volts;
use crate::ticks::{Clock, Ticks};
use crate::{Loop, Message, SHARED, chip, pins, port, supply, usb};

/// The settings of this board's loop.
pub const BENCH: Settings = Settings {
    supply: Some(SupplyRange::TWENTY_FOUR),
    needs_host: false,
    ticks_per_record: RATE_HZ / RECORDS_HZ,
    ..Settings::new(CLOCK)
};

const _: () = palpate_bench::check_supply(&own::DEVICE, BENCH.supply);

/// Ticks from one reading of a sensor to its next.
const ROUND: u32 = ticks_per_round(3, SETTINGS.rate_hz);

/// Sets all up, in an order in which no motor moves.
#[inline(never)]
pub fn set_up(
    queue: &'static mut Queue<Message, 16>,
    servo_loop: &'static mut Option<Loop>,
) -> Below<Message, impl Port, impl FnMut() -> Result<(), ClocksDisagree>, impl FnOnce() -> port::ChipWatchdog> {
    let (Some(mut core), Some(mut chip)) = (cortex_m::Peripherals::take(), Peripherals::take()) else {
        panic!("the peripherals are taken here and nowhere else")
    };
    chip::motors_off();
    let reset = chip::reset(&chip.WATCHDOG, &chip.POWMAN);
    let sio = Sio::new(chip.SIO);
    let pins = Pins::new(chip.IO_BANK0, chip.PADS_BANK0, sio.gpio_bank0, &mut chip.RESETS);
    // Motors first: off.
    let enable = pins.gpio16.into_push_pull_output().into_dyn_pin();

    let mut watchdog = Watchdog::new(chip.WATCHDOG);
    let clocks = init_clocks_and_plls(
        CRYSTAL,
        chip.XOSC,
        chip.CLOCKS,
        chip.PLL_SYS,
        chip.PLL_USB,
        &mut chip.RESETS,
        &mut watchdog,
    );
    let Ok(clocks) = clocks else { panic!("the crystal does not start") };
    let speed = clocks.peripheral_clock.freq();
    let cycles = Cycles::start(&mut core.DCB, core.DWT);
    let clock = Clock::start(chip.TIMER0, &mut chip.RESETS, &clocks);

    let mut slices = Slices::new(chip.PWM, &mut chip.RESETS);
    pins::start(&mut slices.pwm5, &mut slices.pwm6, &mut slices.pwm7);
    slices.pwm5.channel_a.output_to(pins.gpio10);
    slices.pwm6.channel_a.output_to(pins.gpio12);
    slices.pwm7.channel_a.output_to(pins.gpio14);
    let bridges = (
        HBridge::dwelling(slices.pwm5.channel_a, pins.gpio11.into_push_pull_output().into_dyn_pin(), pins::DWELL),
        HBridge::dwelling(slices.pwm6.channel_a, pins.gpio13.into_push_pull_output().into_dyn_pin(), pins::DWELL),
        HBridge::dwelling(slices.pwm7.channel_a, pins.gpio15.into_push_pull_output().into_dyn_pin(), pins::DWELL),
    );

    let lines: pins::Bus = (pins.gpio3.reconfigure(), pins.gpio4.reconfigure(), pins.gpio2.reconfigure());
    let bus: Spi<_, _, _, 8> = Spi::new(chip.SPI0, lines);
    let (bus, _) = bus.init(&mut chip.RESETS, speed, 8.MHz(), embedded_hal::spi::MODE_1).free();
    let selects = [
        pins.gpio5.into_push_pull_output_in_state(true.into()).into_dyn_pin(),
        pins.gpio6.into_push_pull_output_in_state(true.into()).into_dyn_pin(),
        pins.gpio7.into_push_pull_output_in_state(true.into()).into_dyn_pin(),
    ];
    let bus = Bounded(bus::Spi(bus));
    let mut sensors =
        Angles::new(bus, selects, CycleDelay::new(clock, CLOCK), max_steps(&This, BENCH.bad_frames + ROUND - 1))
            .at(SETTINGS.rate_hz);
    // One that does not start is a fault of the loop, which names it in its first tick.
    let _ = sensors.start();

    let settings = UartConfig::new(500_000.Hz(), DataBits::Eight, None, StopBits::One);
    let uart =
        UartPeripheral::new(chip.UART0, (pins.gpio0.into_function(), pins.gpio1.into_function()), &mut chip.RESETS);
    let Ok(uart) = uart.enable(settings, speed) else { panic!("150 MHz make 500,000 baud") };
    let Ok(supply_pin) = AdcPin::new(supply::pin(pins.gpio26)) else { panic!("GP26 is a pin of the converter") };
    if ROUND > 1 {
        let _ = sensors.place();
    }
    let board = Parts {
        counter: clock,
        timer: Ticks::start(slices.pwm0),
        sensors,
        drives: ReadBack::new(Switched::new(bridges, enable), chip::reads_enabled as fn() -> bool),
        lines: Lines {
            enable: OneChannel { pin: pins.gpio17.into_pull_up_input().into_dyn_pin(), pressed_level: false },
            stop: pins.gpio21.into_pull_up_input().into_dyn_pin(),
            ready: [
                pins.gpio18.reconfigure().into_dyn_pin(),
                pins.gpio19.reconfigure().into_dyn_pin(),
                pins.gpio20.reconfigure().into_dyn_pin(),
            ],
            supply: Volts::new(Adc::new(chip.ADC, &mut chip.RESETS), supply_pin),
        },
        light: pins.gpio25.into_push_pull_output().into_dyn_pin(),
    };
    let bus = usb::bus(chip.USB, chip.USB_DPRAM, clocks.usb_clock, &mut chip.RESETS);
    let Ok(plug) = Cdc::try_new(bus, Plain) else { panic!("it is a device that USB allows") };
    let port = Either::new(plug, port::Uart(uart));
    let (producer, messages) = queue.split();
    let made = Loop::new(This, board, &BENCH, reset, producer, &SHARED.mailbox);
    SHARED.hand_over(servo_loop.insert(made));
    chip::remember(Cause::Running);
    let mut ring = Ring::start();
    let start = move || {
        let watchdog = port::ChipWatchdog::start(watchdog);
        // SAFETY: the interrupt takes what is handed over, and main touches nothing of it any more.
        unsafe {
            core.NVIC.set_priority(Interrupt::PWM_IRQ_WRAP_0, 0);
            NVIC::unmask(Interrupt::PWM_IRQ_WRAP_0);
        }
        watchdog
    };
    let options = OptionBytes::default();
    Below { messages, cycles, reset, options, port, clocks: move || ring.step(), program: program_check(), start }
}
