//! Clocks, pins and memory, in an order in which no motor moves.

use cortex_m::peripheral::NVIC;
use palpate::device::SupplyRange;
use palpate::device::drive::{SetPointDrive, SetPointRange};
use palpate::wire::telemetry::Queue;
use palpate_bench::cortex::{Below, Cycles};
use palpate_bench::sensors::{Angles, Bounded, max_steps, ticks_per_round};
use palpate_bench::usb::{Cdc, Either};
use palpate_bench::{
    Breakable, Cause, ClockCheck, ClocksDisagree, CycleDelay, Lines, OneChannel, OptionBytes, Parts, Port, RECORDS_HZ,
    ReadBack, Settings,
};
use teensy4_bsp::Interrupt;
use teensy4_bsp::board::{self, IPG_FREQUENCY, LpspiPins, lpuart};
use teensy4_bsp::hal::flexpwm::SM;
use teensy4_bsp::hal::gpio::{Input, Output};
use teensy4_bsp::hal::iomuxc::{self, Config, Hysteresis, PullKeeper};

use crate::body::{RATE_HZ, SETTINGS, This};
use crate::bus::Spi;
use crate::pulse_width::{DWELL, PulseWidth};
use crate::supply::Volts;
use crate::ticks::{Clock, Slow, Ticks};
use crate::watchdog::Rtwdog;
use crate::{Loop, Message, SHARED, chip, fault_input, port, usb};

/// The settings of this board's loop.
pub const BENCH: Settings = Settings {
    supply: Some(SupplyRange::TWENTY_FOUR),
    needs_host: false,
    ticks_per_record: RATE_HZ / RECORDS_HZ,
    ..Settings::new(IPG_FREQUENCY)
};

type Sensors = Angles<Bounded<Spi>, Output, CycleDelay<Clock>, 3>;
type Amplifier = SetPointDrive<PulseWidth, Output, Output>;
type Drives = ReadBack<Breakable<[Amplifier; 3]>>;
/// The parts that the loop runs on.
pub type Board = Parts<Clock, Ticks, Sensors, Drives, OneChannel<Input>, Input, Input, Volts, Output, 3>;

/// Ticks from one reading of a sensor to its next.
const ROUND: u32 = ticks_per_round(3, SETTINGS.rate_hz);

/// Sets all up, in an order in which no motor moves.
#[inline(never)]
pub fn set_up(
    queue: &'static mut Queue<Message, 16>,
    servo_loop: &'static mut Option<Loop>,
) -> Below<Message, impl Port, impl FnMut() -> Result<(), ClocksDisagree>, impl FnOnce() -> Rtwdog> {
    let Some(mut core) = cortex_m::Peripherals::take() else {
        panic!("the peripherals are taken here and nowhere else")
    };
    chip::motors_off();
    chip::test_memory();
    let (flags, memo) = chip::reset();
    let reset = flags.reason(memo);
    let board::Resources { mut pins, mut gpio1, mut gpio2, mut gpio4, pit, lpspi4, lpuart6, adc1, usb, gpt1, .. } =
        board::t41(board::instances());
    // Motors first: not enabled.
    // Their levels are read back, which an output's pad takes "SION" for.
    iomuxc::set_sion(&mut pins.p16);
    iomuxc::set_sion(&mut pins.p17);
    iomuxc::set_sion(&mut pins.p18);
    let enables = [gpio1.output(pins.p16).ok(), gpio1.output(pins.p17).ok(), gpio1.output(pins.p18).ok()];
    let ways = [gpio4.output(pins.p2).ok(), gpio4.output(pins.p3).ok(), gpio2.output(pins.p7).ok()];
    let selects = [gpio2.output(pins.p8).ok(), gpio2.output(pins.p9).ok(), gpio2.output(pins.p10).ok()];
    let ([Some(enable_a), Some(enable_b), Some(enable_c)], [Some(way_a), Some(way_b), Some(way_c)]) = (enables, ways)
    else {
        panic!("pins 16 to 18, 2, 3 and 7 are of these ports")
    };
    let [Some(a), Some(b), Some(c)] = selects else { panic!("pins 8 to 10 are of GPIO2") };
    let selects = [a, b, c];
    selects.iter().for_each(Output::set);
    // What stays in flash is cached.
    core.SCB.enable_icache();
    core.SCB.enable_dcache(&mut core.CPUID);
    let cycles = Cycles::start(&mut core.DCB, core.DWT);
    let clock = Clock::start(gpt1);

    iomuxc::flexpwm::prepare(&mut pins.p4);
    iomuxc::flexpwm::prepare(&mut pins.p5);
    iomuxc::flexpwm::prepare(&mut pins.p6);
    // SAFETY: each submodule once; from here on only the interrupt sets them.
    let [a, b, c] = unsafe { [SM::SM0, SM::SM1, SM::SM2].map(|submodule| PulseWidth::start(submodule)) };
    // As WoodenHaptics configures its amplifiers: 10 % is no current, and a pin says which way.
    let range = SetPointRange::TEN_TO_NINETY;
    fault_input::start(pins.p33);
    let drives = [
        SetPointDrive::with_direction(a, enable_a, way_a, range, DWELL),
        SetPointDrive::with_direction(b, enable_b, way_b, range, DWELL),
        SetPointDrive::with_direction(c, enable_c, way_c, range, DWELL),
    ];
    let drives = Breakable::new(drives, fault_input::is_active as fn() -> bool, RATE_HZ);
    let drives = ReadBack::new(drives, chip::reads_enabled as fn() -> bool);

    let bus = board::lpspi(lpspi4, LpspiPins { sdo: pins.p11, sdi: pins.p12, sck: pins.p13 }, 8_000_000);
    let bus = Bounded(Spi(bus));
    let mut sensors = Angles::new(
        bus,
        selects,
        CycleDelay::new(clock, IPG_FREQUENCY),
        max_steps(&This, BENCH.bad_frames + ROUND - 1),
    )
    .at(SETTINGS.rate_hz);
    // One that does not start is a fault of the loop, which names it in its first tick.
    let _ = sensors.start();
    let input = Config::zero().set_hysteresis(Hysteresis::Enabled);
    let (up, down) =
        (input.set_pull_keeper(Some(PullKeeper::Pullup22k)), input.set_pull_keeper(Some(PullKeeper::Pulldown100k)));
    iomuxc::configure(&mut pins.p14, up);
    iomuxc::configure(&mut pins.p21, up);
    iomuxc::configure(&mut pins.p15, down);
    iomuxc::configure(&mut pins.p19, down);
    iomuxc::configure(&mut pins.p20, down);
    let (Ok(enable), Ok(stop)) = (gpio1.input(pins.p14), gpio1.input(pins.p21)) else { panic!("they are of GPIO1") };
    let ready = (gpio1.input(pins.p15), gpio1.input(pins.p19), gpio1.input(pins.p20));
    let (Ok(ready_a), Ok(ready_b), Ok(ready_c)) = ready else { panic!("they are of GPIO1") };
    let (Ok(light), Ok(supply)) = (gpio1.output(pins.p22), adc1.input::<_, 1>(pins.p23)) else {
        panic!("they are as wired")
    };
    let bus = usb::bus(usb);
    let Ok(plug) = Cdc::try_new(bus, usb::Plug) else { panic!("it is a device that USB allows") };
    let port = Either::new(plug, port::Uart(lpuart(lpuart6, pins.p1, pins.p0, port::BAUD)));

    let lines = Lines {
        enable: OneChannel { pin: enable, pressed_level: false },
        stop,
        ready: [ready_a, ready_b, ready_c],
        supply: Volts::new(adc1, supply),
    };
    if ROUND > 1 {
        let _ = sensors.place();
    }
    let board = Parts { counter: clock, timer: Ticks::start(pit), sensors, drives, lines, light };
    let (producer, messages) = queue.split();
    let made = Loop::new(This, board, &BENCH, reset, producer, &SHARED.mailbox);
    SHARED.hand_over(servo_loop.insert(made));
    chip::remember(Cause::Running);
    let mut clocks = ClockCheck::new((clock, IPG_FREQUENCY), (Slow::start(), Slow::FREQUENCY));
    let start = move || {
        // SAFETY: nothing else uses it.
        let watchdog = Rtwdog::start(unsafe { imxrt_ral::rtwdog::RTWDOG::instance() });
        // SAFETY: the interrupt takes what is handed over, and main touches nothing of it any more.
        unsafe {
            core.NVIC.set_priority(Interrupt::PIT, 0);
            NVIC::unmask(Interrupt::PIT);
        }
        watchdog
    };
    let options = OptionBytes::default();
    Below {
        messages,
        cycles,
        reset,
        options,
        port,
        clocks: move || clocks.step(),
        program: chip::program_check(),
        start,
    }
}
