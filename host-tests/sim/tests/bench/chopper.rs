//! A supply that a braking hand pumps up, and the resistor that burns it.

use embedded_hal::digital::{ErrorType, OutputPin};
use palpate::wire::hold;
use palpate_bench::{Chopped, Chopper, ChopperSettings, Hold, Panel, Settings, Supply};
use palpate_sim::rig::{RATE, settings};
use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

const SETTINGS: ChopperSettings =
    ChopperSettings { on_v: 28.0, off_v: 27.0, resistance_ohm: 10.0, continuous_w: 10.0, energy_j: 20.0 };
/// F.
const CAPACITY: f64 = 2e-3;
const PERIOD: f64 = 1.0 / RATE;

/// A capacitor behind the diode of a supply of 24 V.
struct Bus {
    volts: f64,
    burns: bool,
    is_measured: bool,
}

impl Bus {
    /// A period in which the motors give back `amps`; the energy that the resistor takes, J.
    fn advance(&mut self, amps: f64) -> f64 {
        let burnt = if self.burns { self.volts / 10.0 } else { 0.0 };
        let energy = burnt * self.volts * PERIOD;
        self.volts = (self.volts + (amps - burnt) * PERIOD / CAPACITY).max(24.0);
        energy
    }
}

struct Pins(Rc<RefCell<Bus>>);

impl ErrorType for Pins {
    type Error = Infallible;
}

impl OutputPin for Pins {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().burns = false;
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().burns = true;
        Ok(())
    }
}

impl Supply for Pins {
    fn volts(&mut self) -> Option<f32> {
        let bus = self.0.borrow();
        bus.is_measured.then_some(bus.volts as f32)
    }
}

fn bus() -> (Rc<RefCell<Bus>>, Chopped<Pins, Pins>) {
    let bus = Rc::new(RefCell::new(Bus { volts: 24.0, burns: false, is_measured: true }));
    let supply = Chopped::new(Pins(Rc::clone(&bus)), Pins(Rc::clone(&bus)), Chopper::new(SETTINGS, RATE as f32));
    (bus, supply)
}

/// Whether a loop with this supply is held in this tick.
fn holds(hold: &mut Hold, supply: Option<f32>) -> bool {
    let panel = Panel { enable: true, enable_disagrees: false, stop: false, ready: true, supply };
    hold.next(&panel, true).hold & hold::SUPPLY != 0
}

#[test]
fn a_braking_hand_is_held_between_the_two_voltages_and_without_the_chopper_the_motors_are_held_off() {
    let settings: Settings = settings();
    let (mut with, mut without) = (Hold::new(&settings, RATE as f32), Hold::new(&settings, RATE as f32));
    let (bus, mut supply) = bus();
    let mut bare = Bus { volts: 24.0, burns: false, is_measured: true };
    let (mut highest, mut lowest, mut held) = (0.0_f64, f64::INFINITY, false);
    // 2 A for 300 ms.
    for tick in 0..1_200 {
        assert!(!holds(&mut with, supply.volts()), "tick {tick}: {} V", bus.borrow().volts);
        held |= holds(&mut without, Some(bare.volts as f32));
        bus.borrow_mut().advance(2.0);
        bare.advance(2.0);
        let volts = bus.borrow().volts;
        highest = highest.max(volts);
        lowest = if highest > 28.0 { lowest.min(volts) } else { lowest };
    }
    assert!(held, "2 A into 2 mF are 1 V/ms");
    // A period late either way: 2 A up, 2.825 A less 2 A down, of 2 mF.
    assert!(
        highest <= 28.0 + 2.0 * PERIOD / CAPACITY && lowest >= 27.0 - 0.825 * PERIOD / CAPACITY,
        "{highest} {lowest}"
    );
    // At rest it burns nothing.
    (0..400).for_each(|_| {
        supply.volts();
        bus.borrow_mut().advance(0.0);
    });
    assert!(!bus.borrow().burns && bus.borrow().volts <= 28.0);
}

#[test]
fn a_resistor_that_has_taken_its_energy_is_left_to_cool_and_the_hold_takes_over() {
    let (bus, mut supply) = bus();
    let mut hold = Hold::new(&settings(), RATE as f32);
    let (mut taken, mut held, mut longest) = (0.0_f64, None, 0.0_f64);
    for tick in 0..4_000 {
        if holds(&mut hold, supply.volts()) && held.is_none() {
            held = Some(tick);
        }
        taken += bus.borrow_mut().advance(2.0);
        longest = longest.max(taken - 10.0 * f64::from(tick) * PERIOD);
        if held.is_some() {
            break;
        }
    }
    // 2 A at 27 to 28.25 V less 10 W: 20 J after 0.430 to 0.455 s, then 1 V/ms up to 30 V.
    assert!(held.is_some_and(|tick| (1_720..1_840).contains(&tick)), "{held:?}");
    // A period of 28.25 V at most above its energy.
    assert!(longest <= 20.0 + 28.25 * 28.25 / 10.0 * PERIOD, "{longest} J");
    // Without a measurement it burns nothing.
    bus.borrow_mut().is_measured = false;
    supply.volts();
    assert!(!bus.borrow().burns);
}
