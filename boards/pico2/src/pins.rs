//! The peripherals on the pins.

use embedded_hal::pwm::SetDutyCycle;
use palpate::device::drive::HBridge;
use palpate_bench::sensors::{Angles, Bounded};
use palpate_bench::{CycleDelay, OneChannel, Parts, ReadBack, Switched, dwell};
use rp235x_hal::gpio::{
    DynPinId, FunctionSio, FunctionSpi, Pin, PullDown, PullNone, PullUp, SioInput, SioOutput, bank0,
};
use rp235x_hal::pwm::{A, Channel, FreeRunning, Pwm5, Pwm6, Pwm7, Slice, SliceId};

use crate::body::RATE_HZ;
use crate::bus::Spi;
use crate::chip::CLOCK;
use crate::supply::Volts;
use crate::ticks::{Clock, Ticks};

/// For the motors, Hz.
const FREQUENCY: u32 = 20_000;
const MOTOR_PERIOD: u16 = (CLOCK / FREQUENCY - 1) as u16;
/// How long a reversal stays at no width: one tick at 4 kHz, two at 20.
pub const DWELL: u8 = dwell(RATE_HZ, FREQUENCY, 1);

type Line<P> = Pin<P, FunctionSpi, PullDown>;
/// The pins of the sensors' bus.
pub type Bus = (Line<bank0::Gpio3>, Line<bank0::Gpio4>, Line<bank0::Gpio2>);
/// An output.
pub type Output = Pin<DynPinId, FunctionSio<SioOutput>, PullDown>;
type Switch = Pin<DynPinId, FunctionSio<SioInput>, PullUp>;
/// Not pulled: a resistor of 4.7 kΩ does that, which the chip's own pull-down cannot (erratum RP2350-E9).
type Ready = Pin<DynPinId, FunctionSio<SioInput>, PullNone>;
/// Output A of a slice and a direction pin.
type Bridge<S> = HBridge<Channel<Slice<S, FreeRunning>, A>, Output>;
type Drives = ReadBack<Switched<(Bridge<Pwm5>, Bridge<Pwm6>, Bridge<Pwm7>), Output>>;
type Sensors = Angles<Bounded<Spi>, Output, CycleDelay<Clock>, 3>;
/// All of them.
pub type Board = Parts<Clock, Ticks, Sensors, Drives, OneChannel<Switch>, Switch, Ready, Volts, Output, 3>;

/// A slice that runs.
type Running<S> = Slice<S, FreeRunning>;

/// Starts the motors' pulse widths, at no width. Their pins are given to them after: a reset of the core alone leaves
/// the slices as they were.
pub fn start(a: &mut Running<Pwm5>, b: &mut Running<Pwm6>, c: &mut Running<Pwm7>) {
    start_one(a);
    start_one(b);
    start_one(c);
}

fn start_one<S: SliceId>(slice: &mut Running<S>) {
    let Ok(()) = slice.channel_a.set_duty_cycle_fully_off();
    slice.set_top(MOTOR_PERIOD);
    slice.enable();
}
