//! A device that is being set up, from the bytes on its line to the current in its motors: nothing moves without the
//! enable button *and* the key, and whatever goes wrong lets go at once.

use palpate::commission::{Jog, JogRefusal, KEY};
use palpate::device::drive::{Feed, VoltageFeed};
use palpate::device::presets::{WOODEN_HAPTICS_2016, WOODEN_HAPTICS_2016_PROTECTION};
use palpate::device::{Endurance, Protection, SerialArm, SupplyRange};
use palpate::patch::SplinePatch;
use palpate::servo::{Config, Fault, Guard, Heartbeat, Phase, ResetReason, SafeOutput, Safety, Servo, Unguarded};
use palpate::wire::frame::{MAX_FRAME, Received, Receiver, pack};
use palpate::wire::{DeviceMessage, HostMessage, PROTOCOL, Reading, hold};
use palpate_bench::{Idle, Settings, check_supply};
use palpate_sim::rig::{RATE, Rig, SETTINGS, WALL, World, held_at, settings};
use palpate_sim::simulated::{NoWatchdog, Wire};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::sync::OnceLock;

/// The whole device side: interrupt, main and line.
struct Device<G: Guard<3> + 'static = Unguarded> {
    rig: Rig<SerialArm, G>,
    idle: Idle<'static>,
    wire: Wire,
    receiver: Receiver<DeviceMessage>,
    last: Option<Reading>,
    number: u32,
}

impl Device {
    fn new(settings: &Settings, safety: Safety) -> Self {
        Self::after(ResetReason::PowerOn, settings, safety)
    }

    fn after(reset: ResetReason, settings: &Settings, safety: Safety) -> Self {
        let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT });
        Self::of(servo, reset, settings)
    }

    /// One being set up, whose enable button is held as it should be.
    fn being_set_up() -> Self {
        Self::being_set_up_with(&settings())
    }

    fn being_set_up_with(settings: &Settings) -> Self {
        Self::new(settings, Safety::DEFAULT).set_up()
    }
}

impl<G: Guard<3> + 'static> Device<G> {
    fn of(servo: Servo<'static, SplinePatch<'static>, SerialArm, 3, G>, reset: ResetReason, of: &Settings) -> Self {
        let mut rig = Rig::new(servo, held_at([0.0, 0.0, 0.02]), of, reset);
        let records = rig.take_records();
        let idle = Idle::new(rig.mailbox, records, Heartbeat::default());
        let (wire, receiver) = (Wire::default(), Receiver::new());
        let mut device = Self { rig, idle, wire, receiver, last: None, number: 0 };
        device.send(HostMessage::Hello { protocol: PROTOCOL });
        device
    }

    /// A person holds the enable button for half a second, and releases it.
    fn confirm(&mut self) {
        for (pressed, ticks) in [(true, 2_100), (false, 150)] {
            self.rig.set(|world| world.button = pressed);
            (0..ticks).for_each(|_| self.tick());
        }
    }

    fn send(&mut self, command: HostMessage) {
        let mut buffer = [0; MAX_FRAME];
        self.wire.to_device.extend(pack(&command, &mut buffer).unwrap());
    }

    fn jog(&mut self, key: u32, motor: u8, duty: i16) {
        self.number += 1;
        self.send(HostMessage::Jog(Jog { number: self.number, key, motor, duty }));
    }

    /// Main as long as it has something to do.
    fn idle(&mut self) {
        while !self.wire.to_device.is_empty() {
            self.idle.step(&mut self.wire, &mut NoWatchdog);
        }
        for _ in 0..2 * MAX_FRAME {
            self.idle.step(&mut self.wire, &mut NoWatchdog);
        }
        for byte in self.wire.from_device.drain(..) {
            if let Some(Received::Message(DeviceMessage::Reading(reading))) = self.receiver.feed(byte) {
                self.last = Some(reading);
            }
        }
    }

    fn tick(&mut self) {
        self.idle();
        self.rig.tick();
        self.idle();
    }

    fn ticks(&mut self, ticks: u32) {
        (0..ticks).for_each(|_| self.tick());
    }

    /// The same being set up, with its enable button held.
    fn set_up(mut self) -> Self {
        self.ticks(150);
        self.send(HostMessage::SetUp);
        self.ticks(10);
        assert!(self.last.is_none(), "nobody has confirmed it");
        self.confirm();
        self.ticks(150);
        assert!(self.last.is_some(), "it is being set up");
        self.rig.set(|world| world.button = true);
        self.ticks(10);
        self
    }

    /// Holds the key for so many ticks, a frame every 20 ms.
    fn hold_key(&mut self, ticks: u32, motor: u8, duty: i16) {
        for tick in 0..ticks {
            if tick % 80 == 0 {
                self.jog(KEY, motor, duty);
            }
            self.tick();
        }
    }

    fn reading(&self) -> Reading {
        self.last.unwrap()
    }

    #[track_caller]
    fn assert_off(&mut self, ticks: u32) {
        for tick in 0..ticks {
            self.tick();
            assert!(self.rig.is_off(), "tick {tick}: {:?}", self.reading());
        }
    }
}

#[test]
fn one_motor_moves_while_key_and_button_are_held_by_no_more_than_its_limit() {
    let mut device = Device::being_set_up();
    for motor in 0..3 {
        device.hold_key(1_000, motor, i16::MAX);
        let reading = device.reading();
        // Four tenths of full scale, rounded.
        let mut wanted = [0; 3];
        wanted[usize::from(motor)] = 13_107;
        assert_eq!((reading.live, reading.duties, reading.refusal), (true, wanted, 0));
        let currents = device.rig.world.borrow().currents();
        for (joint, current) in currents.into_iter().enumerate() {
            let wanted = if joint == usize::from(motor) { 0.4 } else { 0.0 };
            // Half a step of 8,500 on a range of 0.4.
            assert!((current - wanted).abs() < 2e-4, "{currents:?}");
        }
        device.jog(0, motor, 0);
        device.assert_off(100);
    }
}

#[test]
fn a_bridge_that_gives_a_voltage_is_told_the_voltage_of_the_duty() {
    let amps = 3.0;
    let voltage = |ohms| {
        Feed::Voltage(VoltageFeed {
            supply_v: 24.0,
            full_fraction: 1.0,
            resistance_ohm: ohms,
            torque_constant_n_m_per_a: 0.0259,
            current_at_full_a: amps,
            ratio: 16.0,
            back_emf_fraction: 0.8,
        })
    };
    static FED: OnceLock<palpate::device::Device<SerialArm, 3>> = OnceLock::new();
    let feeds = [voltage(0.711), Feed::Current, voltage(2.0)];
    let within = |min_mv, max_mv| {
        let device = palpate::device::Device { feeds, ..WOODEN_HAPTICS_2016 };
        std::panic::catch_unwind(|| check_supply(&device, Some(SupplyRange { min_mv, max_mv }))).is_ok()
    };
    let ranges = [(20_000, 30_000), (24_000, 24_000), (10_000, 23_000), (25_000, 30_000)];
    assert_eq!(ranges.map(|(least, most)| within(least, most)), [true, true, false, false], "24 V");
    let fed = FED.get_or_init(|| palpate::device::Device { feeds, ..WOODEN_HAPTICS_2016 });
    let servo = Servo::new(fed, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    let mut device = Device::of(servo, ResetReason::PowerOn, &settings()).set_up();
    // 1.2 A through each winding at rest: a stalled motor has no more current than a moving one.
    for (motor, told) in [(0, 0.4 * amps * 0.711 / 24.0), (1, 0.4), (2, 0.4 * amps * 2.0 / 24.0)] {
        for sign in [1, -1] {
            device.hold_key(1_000, motor, sign * i16::MAX);
            let (reading, motor) = (device.reading(), usize::from(motor));
            assert_eq!((reading.live, reading.duties[motor]), (true, sign * 13_107), "the torque's share is told");
            let current = device.rig.world.borrow().currents()[motor];
            // As above.
            assert!((current - f64::from(sign) * f64::from(told)).abs() < 2e-4, "{motor}: {current} for {told}");
        }
        device.jog(0, motor, 0);
        device.assert_off(100);
    }
}

/// A tick's part of a joint's turning at so many rad/s, for a time: the refusal that ends it, and how far it went, rad.
fn turned_at(rate: f64, joint: usize) -> (Option<JogRefusal>, f64) {
    let mut device = Device::being_set_up();
    let counts_per_radian = 1.0 / f64::from(WOODEN_HAPTICS_2016.encoders[joint].radians_per_count).abs();
    let begin = i32::MAX / 2;
    let mut from = begin;
    for tick in 0..4_000_u32 {
        let angle = rate * f64::from(tick) / RATE;
        device.rig.set(|world| world.turned[joint] = (angle * counts_per_radian) as i32);
        if tick % 80 == 0 {
            device.jog(KEY, 0, 0);
        }
        device.tick();
        if from == begin {
            from = device.reading().counts[joint];
        }
        if device.reading().refusal != 0 {
            let moved = f64::from((device.reading().counts[joint] - from).abs()) / counts_per_radian;
            return (JogRefusal::from_code(device.reading().refusal), moved);
        }
    }
    (None, 0.0)
}

#[test]
fn no_joint_goes_further_or_faster_than_is_said_however_coarse_its_encoder() {
    // Joint 1 has three counts where joint 0 has four. A third of a radian less is what the finer one may go.
    for joint in 0..3 {
        let (refusal, moved) = turned_at(3.0, joint);
        assert_eq!(refusal, Some(JogRefusal::TooFar), "{joint}");
        // A hundredth: what the hand lets it move besides.
        assert!((0.74..1.01).contains(&moved), "{joint}: {moved} rad");
        // A tenth more than it may, for as long as it takes to have gone a fiftieth of a second's way too far.
        let (refusal, moved) = turned_at(4.4, joint);
        assert_eq!(refusal, Some(JogRefusal::TooFast), "{joint}: {moved} rad");
    }
}

#[test]
fn no_motor_is_jogged_with_more_than_every_motor_bears_for_ever() {
    // Which motor is on which output is not known yet, and nobody counts the heat.
    let endurance = |continuous| Endurance { continuous, time_constant_s: 16.0 };
    let motors = [1.1, 0.22, 0.5].map(endurance);
    let servo = Servo::protected(
        &WOODEN_HAPTICS_2016,
        &WALL,
        Protection { motors, ..WOODEN_HAPTICS_2016_PROTECTION },
        Config { settings: SETTINGS, ..Config::DEFAULT },
    );
    let mut device = Device::of(servo, ResetReason::PowerOn, &settings()).set_up();
    for motor in 0..3 {
        device.hold_key(1_000, motor, i16::MAX);
        let reading = device.reading();
        // Rounded.
        assert_eq!((reading.live, reading.duties[usize::from(motor)]), (true, 7_209));
        device.jog(0, motor, 0);
        device.assert_off(100);
    }
}

#[test]
fn a_key_that_falls_silent_is_let_go_after_a_tenth_of_a_second() {
    let mut device = Device::being_set_up();
    device.hold_key(1_000, 1, 5_000);
    device.jog(KEY, 1, 5_000);
    device.ticks(400);
    assert!(!device.rig.is_off());
    device.assert_off(2_000);
    assert_eq!(device.reading().duties, [0; 3]);
}

#[test]
fn whatever_goes_wrong_lets_go_in_the_same_tick() {
    type Harm = (&'static str, fn(&mut World), u8, u8);
    let harms: [Harm; 6] = [
        ("the button is released", |world| world.button = false, 0, 0),
        ("stop is pressed", |world| world.stop_open = true, 0, hold::STOP),
        ("an amplifier fails", |world| world.amplifiers_well = false, 0, hold::NOT_READY),
        ("a sensor fails", |world| world.bad = 1, JogRefusal::Sensor.code(), 0),
        ("a tick is late", |world| world.reading = 43_000, JogRefusal::Late.code(), 0),
        ("a tick begins late", |world| world.cycles = world.cycles.wrapping_add(43_000), JogRefusal::Late.code(), 0),
    ];
    for (name, harm, refusal, holds) in harms {
        let mut device = Device::being_set_up();
        device.hold_key(1_000, 0, 5_000);
        assert!(!device.rig.is_off(), "{name}");
        device.rig.set(harm);
        device.jog(KEY, 0, 5_000);
        device.assert_off(1);
        assert_eq!((device.reading().refusal, device.reading().hold & holds), (refusal, holds), "{name}");
    }
    // The supply is believed for three readings more: one may be noise.
    let mut device = Device::being_set_up();
    device.hold_key(1_000, 0, 5_000);
    device.rig.set(|world| world.supply = 12.0);
    device.ticks(3);
    device.assert_off(1);
    // The host says stop, and stop it is until the next reset.
    let mut device = Device::being_set_up();
    device.hold_key(1_000, 0, 5_000);
    device.send(HostMessage::Stop);
    device.assert_off(1);
    device.rig.set(|world| world.button = false);
    device.ticks(150);
    device.rig.set(|world| world.button = true);
    for _ in 0..20 {
        device.jog(KEY, 0, 5_000);
        device.assert_off(80);
    }
    assert_eq!(device.reading().hold, hold::STOP);
}

#[test]
fn after_a_hold_the_button_must_be_released_first() {
    let mut device = Device::being_set_up();
    device.hold_key(1_000, 0, 5_000);
    device.rig.set(|world| world.stop_open = true);
    device.assert_off(10);
    device.rig.set(|world| world.stop_open = false);
    for _ in 0..20 {
        device.jog(KEY, 0, 5_000);
        device.assert_off(80);
    }
    assert_eq!(device.reading().hold, hold::RELEASE_FIRST);
    device.rig.set(|world| world.button = false);
    device.assert_off(150);
    device.rig.set(|world| world.button = true);
    device.hold_key(200, 0, 5_000);
    assert!(!device.rig.is_off());
}

#[test]
fn nobody_is_surprised_by_it() {
    // Not while force is given, nor while the button is held, nor while something damps.
    let mut device = Device::new(&settings(), Safety { output: SafeOutput::Damping(5.0), ..Safety::DEFAULT });
    device.rig.press_until_it_runs();
    device.send(HostMessage::SetUp);
    device.ticks(10);
    assert_eq!((device.last, device.rig.state().phase()), (None, Phase::Running));
    device.rig.set(|world| world.bad = 3);
    device.ticks(10);
    device.rig.set(|world| world.button = false);
    device.ticks(150);
    assert!(device.rig.fault().is_some() && !device.rig.is_off(), "it damps");
    device.send(HostMessage::SetUp);
    device.ticks(10);
    assert_eq!(device.last, None);
    let mut device = Device::new(&settings(), Safety::DEFAULT);
    device.ticks(150);
    device.rig.set(|world| (world.button, world.stop_open) = (true, true));
    device.ticks(10);
    device.send(HostMessage::SetUp);
    device.ticks(10);
    assert_eq!(device.last, None);
    // A board that does not offer it is never set up.
    let mut device = Device::new(&Settings { jog: None, ..settings() }, Safety::DEFAULT);
    device.ticks(150);
    device.send(HostMessage::SetUp);
    device.ticks(10);
    assert_eq!((device.last, device.rig.fault()), (None, None));
}

#[test]
fn the_servo_is_stopped_for_good() {
    let mut device = Device::being_set_up();
    assert_eq!(device.rig.fault(), Some(Fault::Stopped));
    for command in [HostMessage::Acknowledge, HostMessage::Alive, HostMessage::SetUp] {
        device.send(command);
        device.assert_off(100);
    }
    device.rig.set(|world| world.button = false);
    device.assert_off(100);
    device.rig.set(|world| world.button = true);
    device.assert_off(1_000);
    assert_eq!(device.rig.fault(), Some(Fault::Stopped));
}

#[test]
fn a_jog_to_a_device_that_is_not_set_up_does_nothing_and_is_forgotten() {
    let mut device = Device::new(&settings(), Safety::DEFAULT);
    device.ticks(150);
    device.hold_key(200, 0, 5_000);
    assert!(device.rig.is_off());
    device.send(HostMessage::SetUp);
    device.ticks(10);
    device.confirm();
    device.rig.set(|world| world.button = true);
    device.assert_off(100);
    assert_eq!(device.reading().number, 0);
}

/// What a line may say that holds no key: frames of every kind with anything in them, frames with a key that came
/// before, frames with a key that were harmed on the way, and rubbish. And the button is pressed all the while, or off
/// and on.
#[test]
fn no_fuzzed_command_moves_a_motor_without_the_key() {
    const COMMANDS: u32 = 1_000_000;
    let mut device = Device::being_set_up();
    let mut random = Pcg64::seed_from_u64(5);
    let (mut buffer, mut stale) = ([0; MAX_FRAME], Vec::new());
    // Held once, and let go: numbers up to this one hold no key any more.
    device.number = 1_000;
    device.hold_key(400, 0, 5_000);
    assert!(!device.rig.is_off(), "the key does move it");
    for number in 0..=device.number {
        let jog = HostMessage::Jog(Jog { number, key: KEY, motor: (number % 3) as u8, duty: 9_000 });
        stale.push(pack(&jog, &mut buffer).unwrap().to_vec());
    }
    device.jog(0, 0, 0);
    device.assert_off(1);
    let mut kinds = [0_u32; 4];
    for command in 0..COMMANDS {
        let draw = random.next_u64();
        let kind = (draw & 3) as usize;
        kinds[kind] += 1;
        let [a, b] = [random.next_u64(), random.next_u64()];
        let jog = Jog { number: a as u32, key: (a >> 32) as u32, motor: b as u8, duty: (b >> 8) as i16 };
        match kind {
            0 => {
                let key = match jog.key {
                    // One in eight is nearly right.
                    key if key & 7 == 0 => KEY ^ (1 << (key >> 8 & 31)),
                    KEY => 0,
                    key => key,
                };
                // Not to run away with the number: what is older is refused by itself.
                let number = device.number.wrapping_add(jog.number % 3);
                let commands = [
                    HostMessage::Alive,
                    HostMessage::Acknowledge,
                    HostMessage::SetUp,
                    HostMessage::Jog(Jog { number, key, ..jog }),
                    HostMessage::Jog(Jog { number, key, motor: jog.motor % 4, ..jog }),
                ];
                device.number = number;
                device.send(commands[(draw >> 8) as usize % commands.len()]);
            }
            1 => device.wire.to_device.extend(&stale[(draw >> 8) as usize % stale.len()]),
            2 => {
                let held = Jog { number: device.number.wrapping_add(1), key: KEY, motor: jog.motor % 3, duty: 9_000 };
                let mut frame = pack(&HostMessage::Jog(held), &mut buffer).unwrap().to_vec();
                // One bit to three: that many any CRC-32 finds in a frame this short.
                let bits = frame.len() * 8;
                let first = a as usize % bits;
                frame[first / 8] ^= 1 << (first % 8);
                for (at, also) in [(b as usize % bits, draw & 16 != 0), ((b >> 32) as usize % bits, draw & 32 != 0)] {
                    if also && at != first {
                        frame[at / 8] ^= 1 << (at % 8);
                    }
                }
                // Two flips of one bit are none.
                if frame != pack(&HostMessage::Jog(held), &mut buffer).unwrap() {
                    device.wire.to_device.extend(frame);
                }
            }
            _ => device.wire.to_device.extend(&a.to_le_bytes()[..(draw >> 8) as usize % 9]),
        }
        while !device.wire.to_device.is_empty() {
            device.idle.step(&mut device.wire, &mut NoWatchdog);
        }
        device.wire.from_device.clear();
        if command % 1_000 == 0 {
            device.rig.set(|world| world.button = draw & 64 != 0);
        }
        device.rig.bench.tick();
        // A period; the plant need not move.
        device.rig.set(|world| world.cycles = world.cycles.wrapping_add(42_500));
        assert!(device.rig.is_off(), "command {command}");
        assert_eq!(device.rig.world.borrow().currents(), [0.0; 3]);
    }
    println!("{COMMANDS} commands of the kinds {kinds:?}, and no motor moved");
    // It was alive all the while: the key moves it still.
    device.rig.set(|world| world.button = false);
    device.wire.to_device.push_back(0);
    device.ticks(150);
    device.rig.set(|world| world.button = true);
    device.ticks(10);
    device.number = device.number.wrapping_add(10);
    device.jog(0, 0, 0);
    device.hold_key(200, 2, 5_000);
    assert!(!device.rig.is_off());
}

#[test]
fn after_a_reset_by_the_watchdog_nothing_is_set_up_before_it_is_acknowledged() {
    let mut device = Device::after(ResetReason::Watchdog, &settings(), Safety::DEFAULT);
    device.ticks(150);
    device.send(HostMessage::SetUp);
    device.ticks(10);
    device.rig.set(|world| world.button = true);
    device.jog(KEY, 0, 3_000);
    for _ in 0..200 {
        device.tick();
        assert!(device.rig.is_off() && device.last.is_none());
    }
    device.rig.set(|world| world.button = false);
    device.ticks(150);
    device.send(HostMessage::Acknowledge);
    device.ticks(10);
    assert_eq!(device.rig.fault(), Some(Fault::WatchdogReset), "nobody has confirmed it");
    device.confirm();
    assert_eq!(device.rig.fault(), None);
    device.send(HostMessage::SetUp);
    device.ticks(10);
    device.confirm();
    assert!(device.last.is_some(), "it is being set up");
}

#[test]
fn a_host_that_has_not_said_hello_may_stop_the_device_and_nothing_else() {
    for protocol in [None, Some(PROTOCOL - 1), Some(PROTOCOL + 1)] {
        let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
        let mut device = Device::of(servo, ResetReason::Watchdog, &settings());
        device.wire.to_device.clear();
        if let Some(protocol) = protocol {
            device.send(HostMessage::Hello { protocol });
        }
        device.ticks(150);
        for command in [HostMessage::Acknowledge, HostMessage::SetUp] {
            device.send(command);
            device.confirm();
            assert_eq!((device.rig.fault(), device.last), (Some(Fault::WatchdogReset), None), "{protocol:?}");
        }
        device.hold_key(200, 0, 5_000);
        assert!(device.rig.is_off());
        device.send(HostMessage::Stop);
        device.ticks(2);
        assert!(device.rig.is_off() && device.rig.fault().is_some());
    }
    // Stop, of a device that gives force.
    let mut device = Device::new(&settings(), Safety::DEFAULT);
    device.wire.to_device.clear();
    device.rig.press_until_it_runs();
    device.send(HostMessage::Stop);
    device.assert_off(10);
    assert_eq!(device.rig.fault(), Some(Fault::Stopped));
}

#[test]
fn only_a_button_that_is_held_for_half_a_second_and_released_confirms() {
    let asked = || {
        let mut device = Device::new(&settings(), Safety::DEFAULT);
        device.ticks(150);
        device.send(HostMessage::SetUp);
        device.ticks(10);
        device
    };
    // Not a tap, not one that chatters, not one that is held on, and no press meanwhile gives force.
    for (pressed, released, times) in [(400, 150, 5), (400, 2, 12), (20_000, 0, 1)] {
        let mut device = asked();
        for _ in 0..times {
            device.rig.set(|world| world.button = true);
            device.assert_off(pressed);
            device.rig.set(|world| world.button = false);
            device.assert_off(released);
        }
        assert_eq!(device.last, None, "{pressed} ticks");
    }
    // Too late: half a minute is 120,000 ticks.
    let mut device = asked();
    device.assert_off(120_100);
    device.confirm();
    assert_eq!(device.last, None);
    device.rig.press_until_it_runs();
    // A stop ends it.
    let mut device = asked();
    device.send(HostMessage::Stop);
    device.confirm();
    assert_eq!(device.last, None);
    // In time.
    let mut device = asked();
    device.confirm();
    assert!(device.last.is_some());
}
