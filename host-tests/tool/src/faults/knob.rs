//! Failures of a knob: its loop at the simulated dial, with phase currents and a brake chopper.

use palpate::servo::Fault;
use palpate_bench::{Chopper, CurrentWatch};
use palpate_sim::knob::{CHOPPER, CURRENTS, HostKnob, PROTECTION, SETTINGS, dial};
use palpate_sim::plant::{Fingers, MagneticFault};

/// The spring, in which a turned dial needs every phase.
const SPRING: u8 = 3;
/// A hand that turns it, rad/s.
const RATE: f64 = 2.0;
/// Of the supply behind its diode, F and V.
const CAPACITY: f64 = 1e-3;
const SUPPLY: f64 = 12.0;
/// How fast a hand that is stronger than the motor gains speed, rad/s²: 2 g at a rim of 20 mm. At once, the back-EMF
/// would be a fault of the currents first.
const SPEEDING: f64 = 1_000.0;
/// Given back by a braking motor, A.
const BRAKING: f64 = 1.0;

/// A knob and what else is on its bench.
pub struct KnobBench {
    knob: HostKnob,
    watch: CurrentWatch,
    are_currents_measured: bool,
    chopper: Chopper,
    chopper_burns: bool,
    /// A, given back.
    braking: f64,
    /// A hand that turns the dial faster and faster, up to this rate, rad/s.
    up_to: Option<f64>,
    rate: f64,
}

/// A failure of a knob.
#[derive(Clone, Copy, Debug)]
pub struct KnobFailure {
    /// The failure.
    pub failure: &'static str,
    /// The detector.
    pub detected_by: &'static str,
    /// Promised time until the motor is off, ms.
    pub within_ms: f64,
    /// The fault.
    pub fault: Fault,
    /// The test that shows it.
    pub test: &'static str,
    plant: fn(&mut KnobBench),
}

/// The effect of a planted failure.
#[derive(Clone, Copy, Debug)]
pub struct KnobFound {
    /// The time until the motor was off, ms; `None` if it never was.
    pub off_ms: Option<f64>,
    /// The latched fault.
    pub fault: Option<Fault>,
    /// Largest motion of the dial meanwhile, degrees. A hand turns it.
    pub motion_degrees: f64,
}

impl KnobBench {
    fn running(knob: HostKnob) -> Self {
        let rate = SETTINGS.rate_hz;
        let mut bench = Self {
            knob,
            watch: CurrentWatch::new(CURRENTS),
            are_currents_measured: true,
            chopper: Chopper::new(CHOPPER, rate),
            chopper_burns: true,
            braking: 0.0,
            up_to: None,
            rate: RATE,
        };
        bench.knob.choose(SPRING);
        bench.knob.dial.hold(Fingers { damping: 0.05, rate: RATE, ..Fingers::NONE });
        (0..1_000).for_each(|_| bench.tick());
        bench
    }

    fn tick(&mut self) {
        let dial = &mut self.knob.dial;
        let volts = dial.supply_volts();
        let burnt = if self.chopper.next(Some(volts as f32)) && self.chopper_burns {
            volts / f64::from(CHOPPER.resistance_ohm)
        } else {
            0.0
        };
        let period = 1.0 / f64::from(SETTINGS.rate_hz);
        if let Some(most) = self.up_to {
            self.rate = (self.rate + SPEEDING * period).min(most);
            dial.hold(Fingers::forcing(self.rate));
        }
        dial.supply((volts + (self.braking - burnt) * period / CAPACITY).max(volts.min(SUPPLY)));
        // As `CurrentWatched` does, for the field of the last tick.
        let driven = self.knob.widths().and_then(|_| self.knob.servo().fields(self.knob.state()));
        let amps = self.are_currents_measured.then(|| self.knob.dial.currents().map(|current| current as f32));
        self.knob.tick();
        if let Some([field]) = driven
            && self.watch.next(field.angle, amps).is_err()
        {
            self.knob.note(palpate::servo::Event::DriveFault);
        }
    }
}

impl KnobFailure {
    /// The effect on the simulated knob.
    pub fn plant(&self) -> KnobFound {
        self.plant_in(HostKnob::running(dial(), None))
    }

    fn plant_in(&self, knob: HostKnob) -> KnobFound {
        let mut bench = KnobBench::running(knob);
        assert!(bench.knob.widths().is_some() && bench.knob.state().fault().is_none(), "it drives");
        (self.plant)(&mut bench);
        let start = bench.knob.dial.angle();
        let (mut off_ms, mut motion_degrees) = (None, 0.0_f64);
        for tick in 1..=8_000 {
            bench.tick();
            motion_degrees = motion_degrees.max((bench.knob.dial.angle() - start).abs().to_degrees());
            if bench.knob.widths().is_none() {
                off_ms = Some(1e3 * f64::from(tick) / f64::from(SETTINGS.rate_hz));
                break;
            }
        }
        KnobFound { off_ms, fault: bench.knob.state().fault().map(|(fault, _)| fault), motion_degrees }
    }

    /// Whether it is detected as stated.
    pub fn is_as_stated(&self, found: &KnobFound) -> bool {
        found.fault == Some(self.fault) && found.off_ms.is_some_and(|time| time <= self.within_ms)
    }
}

const CURRENTS_TEST: &str = "a_short_an_open_phase_and_a_lost_measurement_of_the_currents_stop_the_motor";
const DIAL_TEST: &str = "whatever_goes_wrong_in_whatever_phase_lets_go_in_the_same_tick";

const fn row(
    [failure, detected_by, test]: [&'static str; 3],
    within_ms: f64,
    fault: Fault,
    plant: fn(&mut KnobBench),
) -> KnobFailure {
    KnobFailure { failure, detected_by, within_ms, fault, test, plant }
}

/// The failures of a knob.
pub const KNOB: [KnobFailure; 10] = [
    row(["a phase opens", "phase currents", CURRENTS_TEST], 500.0, Fault::Drive, |bench| bench.knob.dial.lose(Some(0))),
    row(["two phases are shorted", "phase currents", CURRENTS_TEST], 500.0, Fault::Drive, |bench| {
        bench.knob.dial.short(0.3);
    }),
    row(["the currents are not measured", "phase currents", CURRENTS_TEST], 0.5, Fault::Drive, |bench| {
        bench.are_currents_measured = false;
    }),
    row(
        [
            "the chopper's resistor is open while the motor brakes",
            "supply range",
            "a_braking_hand_is_held_between_the_two_voltages_and_without_the_chopper_the_motors_are_held_off",
        ],
        5.0,
        Fault::Supply,
        |bench| (bench.braking, bench.chopper_burns) = (BRAKING, false),
    ),
    row(["the supply dips", "supply range", DIAL_TEST], 0.25, Fault::Supply, |bench| bench.knob.dial.supply(9.0)),
    row(["the sensor is silent", "every tick", DIAL_TEST], 0.5, Fault::FrameLost, |bench| {
        bench.knob.dial.spoil(Some(MagneticFault::Absent));
    }),
    row(["the magnet is lost", "its flags", DIAL_TEST], 0.5, Fault::Magnet, |bench| {
        bench.knob.dial.spoil(Some(MagneticFault::Magnet));
    }),
    row(["the magnet slips", "faster than a hand", DIAL_TEST], 0.5, Fault::JointJumped, |bench| {
        bench.knob.dial.spoil(Some(MagneticFault::Slipped(900)));
    }),
    row(["a reading freezes", "1,000 equal readings", DIAL_TEST], 251.0, Fault::Frozen, |bench| {
        bench.knob.dial.spoil(Some(MagneticFault::Stuck));
    }),
    row(["it is turned too fast under force", "speed limit", DIAL_TEST], 100.0, Fault::Overspeed, |bench| {
        let [limit] = PROTECTION.max_joint_rates_rad_per_s;
        bench.up_to = Some(1.1 * f64::from(limit));
    }),
];

/// That a chopper which works keeps a braking motor's supply in range: the fault within a second, if there is one.
pub fn brakes_with_a_chopper() -> Option<Fault> {
    let mut bench = KnobBench::running(HostKnob::running(dial(), None));
    bench.braking = BRAKING;
    (0..SETTINGS.rate_hz as u32).for_each(|_| bench.tick());
    bench.knob.state().fault().map(|(fault, _)| fault)
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate::device::drive::{Feed, VoltageFeed};
    use palpate::device::{Device, Motor};
    use palpate_sim::knob::{MOTOR, SEARCH, SUPPLY_V, TOLD_OF_SUPPLY, servo};
    use palpate_sim::plant::Dial;

    /// The knob with another motor, running.
    fn with_motor(phase_ohm: f32, rpm_per_v: f32) -> HostKnob {
        let Feed::Voltage(feed) = MOTOR.feeds[0] else { panic!("a bridge") };
        let feed = VoltageFeed::three_phase(SUPPLY_V, phase_ohm, rpm_per_v, feed.current_at_full_a);
        let motor = Motor::current_driven(feed.torque_constant_n_m_per_a, feed.current_at_full_a, 1.0);
        let device = Box::leak(Box::new(Device { motors: [motor], feeds: [Feed::Voltage(feed)], ..MOTOR }));
        let mut dial = dial();
        (dial.motor.resistance, dial.motor.rpm_per_volt) = (f64::from(phase_ohm), f64::from(rpm_per_v));
        let mut knob =
            HostKnob::new(servo(device, SEARCH, TOLD_OF_SUPPLY), Dial::new(dial, f64::from(SETTINGS.rate_hz)));
        knob.ticks(SEARCH.ticks() + 2_000);
        knob
    }

    #[test]
    fn the_hand_is_faster_than_the_speed_limit_against_a_motor_that_brakes_more_too() {
        let row = KNOB.iter().find(|row| row.fault == Fault::Overspeed).expect("a row");
        for (phase_ohm, rpm_per_v) in [(7.5, 80.0), (5.6, 40.0)] {
            let found = row.plant_in(with_motor(phase_ohm, rpm_per_v));
            assert!(row.is_as_stated(&found), "{rpm_per_v} rpm/V: {found:?}");
        }
    }
}
