//! A host at the knob's line: it chooses what is felt, and nothing that it says makes a step or drives by itself.

use crate::knob::Rig;
use palpate::render::{Detents, DialFriction, Ends, Feel, FeelPart, Notch, Spring, Wave};
use palpate::scene::{BodyPose, Command, SceneError};
use palpate::servo::{Heartbeat, KnobError, ResetReason};
use palpate::wire::frame::{MAX_FRAME, Received, Receiver, pack};
use palpate::wire::{Answer, DeviceMessage, Hello, HostMessage, KeepError, PROTOCOL, Refused, Upload};
use palpate_bench::Idle;
use palpate_sim::knob::{FEELS, LET_GO, SETTINGS};
use palpate_sim::plant::{DialSettings, Fingers, ThreePhaseMotor};
use palpate_sim::simulated::{NoWatchdog, Wire};
use rand::{Rng, RngExt as _, SeedableRng};
use rand_pcg::Pcg64;

/// The whole device side, and what it said.
pub struct Device {
    pub rig: Rig,
    idle: Idle<'static>,
    pub wire: Wire,
    receiver: Receiver<DeviceMessage>,
    pub told: Vec<DeviceMessage>,
}

impl Device {
    pub fn new(mut rig: Rig) -> Self {
        let idle = Idle::new(rig.mailbox, rig.take_records(), Heartbeat::default());
        let idle = idle.saying(SETTINGS.rate_hz, SETTINGS.max_force_n);
        Self { rig, idle, wire: Wire::default(), receiver: Receiver::new(), told: Vec::new() }
    }

    pub fn send(&mut self, command: &HostMessage) {
        let mut buffer = [0; MAX_FRAME];
        self.wire.to_device.extend(pack(command, &mut buffer).unwrap());
    }

    /// Main as long as it has something to hear, a tick, and a moment of main to say what came of it.
    pub fn tick(&mut self) {
        while !self.wire.to_device.is_empty() {
            self.idle.step(&mut self.wire, &mut NoWatchdog);
        }
        self.rig.tick();
        for _ in 0..2 * MAX_FRAME {
            self.idle.step(&mut self.wire, &mut NoWatchdog);
        }
        for byte in self.wire.from_device.drain(..) {
            if let Some(Received::Message(told)) = self.receiver.feed(byte) {
                self.told.push(told);
            }
        }
    }

    /// What became of an order.
    fn order(&mut self, number: u16, order: Command) -> Option<Refused> {
        self.send(&HostMessage::Command { number, command: order });
        self.told.clear();
        (0..4).for_each(|_| self.tick());
        let answer = |told: &DeviceMessage| match told {
            DeviceMessage::Answer(Answer { number: of, refused }) if *of == number => Some(*refused),
            _ => None,
        };
        self.told.iter().find_map(answer).expect("an answer")
    }

    fn feel(&self) -> u8 {
        self.rig.bench.state().witness().feel()
    }
}

#[test]
fn a_host_chooses_what_is_felt_and_is_told_what_there_is_not() {
    let mut device = Device::new(Rig::running());
    device.send(&HostMessage::Hello { protocol: PROTOCOL });
    (0..4).for_each(|_| device.tick());
    let says = |told: &DeviceMessage| {
        matches!(told, DeviceMessage::Hello(Hello { rate: 4_000.0, max_force: 2.8, room: 0, .. }))
    };
    assert!(device.told.iter().any(says), "{:?}", device.told);
    for (number, index) in (1..).zip(0..FEELS.len() as u8) {
        assert_eq!(device.order(number, Command::Choose { index }), None);
        assert_eq!((device.feel(), device.rig.enabled()), (index, true));
    }
    let last = device.feel();
    for index in [FEELS.len() as u8, 255] {
        let refused = device.order(u16::from(index) + 100, Command::Choose { index });
        let missing = KnobError::Missing { asked: index, last: FEELS.len() as u8 - 1 };
        assert_eq!(refused, Some(Refused::Command(SceneError::Feel(missing))));
    }
    for (number, order) in (500..).zip([Command::Push { force: [1.0; 3] }, Command::Limit { force: 100.0 }]) {
        assert_eq!(device.order(number, order), Some(Refused::Command(SceneError::NotOffered)));
    }
    assert_eq!((device.feel(), device.rig.fault(), device.rig.enabled()), (last, None, true));
    // The host falls silent: two seconds, where an arm's board waits for a tenth of one.
    (0..8_000).for_each(|_| device.tick());
    assert_eq!((device.feel(), device.rig.fault(), device.rig.enabled()), (last, None, true));
}

/// Any part, up to the device's limits, near this angle.
fn stiff_part(random: &mut Pcg64, angle: f32) -> FeelPart {
    let by = random.random_range(0.5..8.0_f32);
    match part(random, angle) {
        FeelPart::Spring(Some(of)) => FeelPart::Spring(Some(Spring {
            stiffness_n_m_per_rad: by * of.stiffness_n_m_per_rad,
            rest_rad: angle + 0.2 * (of.rest_rad - angle),
            // A weak one is a constant torque for most of a wide swing.
            max_torque_n_m: random.random_range(0.005..0.056),
        })),
        FeelPart::Ends(Some(of)) => FeelPart::Ends(Some(Ends {
            between_rad: of.between_rad.map(|end| angle + (end - angle) * random.random::<f32>()),
            stiffness_n_m_per_rad: 1.6 * of.stiffness_n_m_per_rad,
            ..of
        })),
        FeelPart::Clicks(Some(of)) => FeelPart::Clicks(Some(Detents {
            stiffness: by * of.stiffness,
            wall_stiffness: 2.0 * of.wall_stiffness,
            max_force: 0.056,
            ..of
        })),
        part => part,
    }
}

#[test]
fn whatever_feel_is_taken_a_dial_that_is_let_go_of_comes_to_rest() {
    let usual = DialSettings::gimbal_knob();
    comes_to_rest(usual);
    // Without friction nothing but the loop brakes it.
    let free = DialSettings { coulomb_friction: 0.0, viscous_friction: 0.0, ..usual };
    comes_to_rest(free);
    // Nor does a motor whose speed for a volt was stated a quarter too low.
    let motor = ThreePhaseMotor { rpm_per_volt: usual.motor.rpm_per_volt / 0.75, ..usual.motor };
    comes_to_rest(DialSettings { motor, ..free });
}

fn comes_to_rest(dial: DialSettings) {
    let mut device = Device::new(Rig::running_with(dial));
    device.send(&HostMessage::Hello { protocol: PROTOCOL });
    (0..4).for_each(|_| device.tick());
    let mut random = Pcg64::seed_from_u64(71);
    let (mut sent, mut refused, mut stiffest, mut longest, mut felt) = (1_u16, 0, 0.0_f32, 0, 0);
    assert_eq!(device.order(0, Command::Feel(FeelPart::Free)), None);
    let undamped = Spring { stiffness_n_m_per_rad: 0.2, rest_rad: 0.0, max_torque_n_m: 0.056 };
    let answer = device.order(1, Command::Feel(FeelPart::Spring(Some(undamped)))).expect("a refusal");
    assert!(answer.to_string().contains("damped by 0.00 mN·m·s/rad and stiff enough to need 0.14"), "{answer}");
    for round in 0..number("PALPATE_LET_GO", 60) {
        let angle = device.rig.bench.state().witness().angle().expect("aligned");
        // The stiffest spring and stops of the device first, without damping and with.
        let spring = Spring { stiffness_n_m_per_rad: 1.6, rest_rad: angle, max_torque_n_m: 0.056 };
        let ends =
            Ends { between_rad: [angle - 0.01, angle + 0.01], stiffness_n_m_per_rad: 1.6, damping_n_m_s_per_rad: 0.0 };
        let softer = Spring { stiffness_n_m_per_rad: 0.2, ..spring };
        let parts = match round {
            0 => vec![FeelPart::Damping(1.4e-4), FeelPart::Spring(Some(softer))],
            1 => vec![FeelPart::Damping(1.12e-3), FeelPart::Spring(Some(spring))],
            2 => vec![FeelPart::Damping(3.2e-3), FeelPart::Spring(Some(spring))],
            3 => vec![FeelPart::Damping(1.12e-3), FeelPart::Ends(Some(ends))],
            4 => vec![],
            _ => {
                let damping = FeelPart::Damping(random.random_range(0.0..1.5e-3));
                [damping].into_iter().chain((0..5).map(|_| stiff_part(&mut random, angle))).collect()
            }
        };
        let mut taken = 0;
        for part in [FeelPart::Free].into_iter().chain(parts) {
            sent = sent.wrapping_add(1);
            let answer = device.order(sent, Command::Feel(part));
            taken += u32::from(answer.is_none());
            refused +=
                u32::from(matches!(answer, Some(Refused::Command(SceneError::Feel(KnobError::Undamped { .. })))));
        }
        assert!(round > 3 || (taken > 1 && refused == 0), "{round}");
        let stiffness = device.rig.bench.state().witness().own().expect("it is set").stiffness();
        (felt, stiffest) = (felt + u32::from(taken > 1), stiffest.max(stiffness));
        let (from, turn) = (device.rig.world.borrow().dial.angle(), random.random_range(-0.5..0.5));
        for tick in 1..=2_000 {
            let aim = from + turn * (f64::from(tick) / 1_500.0).min(1.0);
            device.rig.set(|world| world.dial.hold(Fingers::clamp(aim)));
            device.tick();
        }
        device.rig.set(|world| world.dial.hold(Fingers::NONE));
        // A dial that rings never stops; one that slips off the top of a detent takes some time.
        let mut turned = f64::INFINITY;
        for window in 0..48 {
            let rates = (0..500).map(|_| {
                device.tick();
                device.rig.world.borrow().dial.rate().abs()
            });
            turned = rates.fold(0.0, f64::max);
            if turned < 0.3 {
                longest = longest.max(window);
                break;
            }
        }
        let feel = device.rig.bench.state().witness().own().copied();
        assert!(turned < 0.3 && device.rig.fault().is_none(), "{round}: {turned} rad/s with {feel:?}");
    }
    println!(
        "{felt} feels of up to {stiffest:.2} N·m/rad, {refused} parts refused: at rest {:.2} s after it is let go of",
        f64::from(longest) * 0.125
    );
    assert!(felt > 40 && refused > 10 && stiffest > 1.5, "{felt} {refused} {stiffest}");
}

#[test]
fn the_documented_part_is_taken_and_a_refusal_comes_with_its_limit() {
    let page = include_str!("../../../../docs/reference/wire.md");
    let section = page.split("## HostMessage: order, part of a feel").nth(1).expect("its section");
    let frame = section.split("Frame: `").nth(1).and_then(|rest| rest.split('`').next()).expect("a frame");
    let mut device = Device::new(Rig::running());
    device.send(&HostMessage::Hello { protocol: PROTOCOL });
    device.tick();
    device.wire.to_device.extend(frame.split(' ').map(|byte| u8::from_str_radix(byte, 16).expect("a byte")));
    (0..4).for_each(|_| device.tick());
    let takes = |told: &DeviceMessage| matches!(told, DeviceMessage::Answer(Answer { number: 303, refused: None }));
    assert!(device.told.iter().any(takes), "{:?}", device.told);
    // Beside the detents of the table's first feel, 30 mN·m.
    let spring = Spring { stiffness_n_m_per_rad: 0.125, rest_rad: -0.5, max_torque_n_m: 0.03125 };
    let refused = device.order(304, Command::Feel(FeelPart::Spring(Some(spring)))).expect("a refusal");
    assert!(
        refused.to_string().contains("up to 61.25 mN·m, and the device's limit is 56.00 mN·m (max_force_n)"),
        "{refused}"
    );
    // A board without flash for it says so.
    device.send(&HostMessage::KeepFeel { number: 305, keeps: true });
    (0..4).for_each(|_| device.tick());
    let refused = Some(Refused::Feel(KeepError::NoFlash));
    assert!(device.told.contains(&DeviceMessage::Answer(Answer { number: 305, refused })), "{:?}", device.told);
}

/// Whatever a host may send that does not stop the knob or set it up: orders that make sense and that do not, repeats,
/// and bytes that are nothing.
fn anything(device: &mut Device, random: &mut Pcg64, number: u16) {
    let [kind, a, b] = [(); 3].map(|()| random.next_u64());
    let float = |bits: u64| f32::from_bits(bits as u32);
    let three = [float(a), float(a >> 32), float(b)];
    let index = if kind & 64 == 0 { a as u8 % FEELS.len() as u8 } else { a as u8 };
    let pose = BodyPose { position: three, orientation: [float(b), float(a), float(b >> 32), 1.0] };
    let order = match kind % 12 {
        0..=6 => Command::Choose { index },
        7 => Command::Push { force: three },
        8 => Command::Limit { force: float(b) },
        9 => Command::Place { body: index, pose },
        10 => Command::Harden { body: index, stiffness: float(a), damping: float(b) },
        _ => Command::PutBack { body: index },
    };
    match (kind >> 32) % 16 {
        0 => device.send(&HostMessage::Hello { protocol: if b & 7 == 0 { b as u16 } else { PROTOCOL } }),
        1 => device.send(&HostMessage::Alive),
        2 => device.send(&HostMessage::Acknowledge),
        3 => device.send(&HostMessage::Upload { number, part: Upload::Keep { bytes: a as u32 % 100 } }),
        4 => device.wire.to_device.extend(a.to_le_bytes()),
        // The same again, as if its answer had been lost.
        5 => (0..2).for_each(|_| device.send(&HostMessage::Command { number, command: order })),
        _ => device.send(&HostMessage::Command { number, command: order }),
    }
}

/// Torque that the feels ask for, N·m.
fn torque(device: &Device) -> f32 {
    device.rig.bench.state().witness().torque()
}

#[test]
fn no_order_makes_a_step_in_torque() {
    // Held in the end stop, where feels differ most. What the sensor's noise makes of each feel by itself:
    let mut device = Device::new(Rig::running_quietly());
    device.send(&HostMessage::Hello { protocol: PROTOCOL });
    let from = device.rig.world.borrow().dial.angle();
    for tick in 1..=800 {
        let aim = from + (0.7 + 1.03 - from) * f64::from(tick) / 800.0;
        device.rig.set(|world| world.dial.hold(Fingers::clamp(aim)));
        device.tick();
    }
    let (mut noise, mut least, mut most) = (0.0_f32, f32::INFINITY, f32::NEG_INFINITY);
    for index in 0..FEELS.len() as u8 {
        device.order(u16::from(index), Command::Choose { index });
        (0..800).for_each(|_| device.tick());
        let mut before = torque(&device);
        for _ in 0..4_000 {
            device.tick();
            noise = noise.max((torque(&device) - before).abs());
            before = torque(&device);
        }
        (least, most) = (least.min(before), most.max(before));
    }
    let step = LET_GO / SETTINGS.rate_hz;
    assert!(most - least > 10.0 * (2.0 * noise + step), "feels differ: {least} {most}, noise {noise}");
    let mut random = Pcg64::seed_from_u64(18);
    let (mut before, mut chosen) = (torque(&device), [0_u32; FEELS.len()]);
    for number in 0..40_000_u32 {
        // Often as fast as they can come, and with time to arrive.
        if number % 4_000 < 2_000 || number % 40 == 0 {
            anything(&mut device, &mut random, number as u16);
        }
        device.tick();
        // What is left over of as many feels as were switched lately has their noise: each at most.
        assert!((torque(&device) - before).abs() <= step + 2.0 * noise, "{number}: {before} {}", torque(&device));
        before = torque(&device);
        chosen[usize::from(device.feel())] += 1;
        assert_eq!((device.rig.fault(), device.rig.enabled()), (None, true), "{number}");
    }
    assert!(chosen.into_iter().all(|ticks| ticks > 1_000), "{chosen:?}");
}

#[test]
fn no_order_drives_a_knob_whose_button_is_up() {
    for (when, rig) in [
        ("never aligned", Rig::new(ResetReason::PowerOn)),
        ("aligned", Rig::running()),
        ("reset by the watchdog", Rig::new(ResetReason::Watchdog)),
    ] {
        let mut device = Device::new(rig);
        device.rig.set(|world| world.button = false);
        device.send(&HostMessage::Hello { protocol: PROTOCOL });
        device.tick();
        let mut random = Pcg64::seed_from_u64(7);
        for number in 0..20_000_u32 {
            anything(&mut device, &mut random, number as u16);
            device.tick();
            assert!(!device.rig.enabled(), "{when}: {number}");
        }
        assert_eq!(device.rig.world.borrow().dial.currents(), [0.0; 3]);
    }
}

/// What a feel asks for at an angle and a rate, N·m, in double precision, from the formulas on its parts' pages; `None`
/// where a click is about to snap, within a rounding, and from there on until the dial is where one detent alone can
/// hold it.
fn asked(feel: &Feel, held: &mut Option<i32>, angle: f64, rate: f64) -> Option<f64> {
    let number = |number: f32| f64::from(number);
    let wave = |wave: &Wave| {
        let turns = (angle - number(wave.centre_rad)) / number(wave.pitch_rad);
        -number(wave.torque_n_m) * (std::f64::consts::TAU * turns).sin()
    };
    let mut sum = -number(feel.damping_n_m_s_per_rad) * rate;
    sum += feel.detents.as_ref().map_or(0.0, wave) + feel.texture.as_ref().map_or(0.0, wave);
    if let Some(clicks) = &feel.clicks {
        let (pitch, most) = (number(clicks.pitch), number(clicks.max_force));
        let off = |click: i32| angle - f64::from(click) * pitch;
        let nearest = ((angle / pitch).round() as i32).clamp(clicks.first, clicks.last);
        let is_outside =
            |click: i32| (click == clicks.first && off(click) < 0.0) || (click == clicks.last && off(click) > 0.0);
        let is_alone = is_outside(nearest) || off(nearest).abs() < (1.0 - number(clicks.snap)) * pitch - 1e-5;
        let click = held.or(is_alone.then_some(nearest))?;
        let margin = off(click).abs() - number(clicks.snap) * pitch;
        *held = if margin.abs() < 1e-5 { None } else { Some(if margin > 0.0 { nearest } else { click }) };
        let click = (*held)?;
        let stiffness = number(if is_outside(click) { clicks.wall_stiffness } else { clicks.stiffness });
        sum += (-stiffness * off(click) - number(clicks.damping) * rate).clamp(-most, most);
    }
    if let Some(spring) = &feel.spring {
        let most = number(spring.max_torque_n_m);
        sum += (number(spring.stiffness_n_m_per_rad) * (number(spring.rest_rad) - angle)).clamp(-most, most);
    }
    if let Some(ends) = &feel.ends {
        let [least, most] = ends.between_rad.map(f64::from);
        let (stiffness, damping) = (number(ends.stiffness_n_m_per_rad), number(ends.damping_n_m_s_per_rad));
        sum += if angle > most {
            (stiffness * (most - angle) - damping * rate).min(0.0)
        } else if angle < least {
            (stiffness * (least - angle) - damping * rate).max(0.0)
        } else {
            0.0
        };
    }
    if let Some(friction) = &feel.friction {
        let share = (rate / number(friction.whole_at_rad_per_s)).clamp(-1.0, 1.0);
        sum -= number(friction.torque_n_m) * share;
    }
    if let Some(notch) = &feel.notch {
        let off = angle - number(notch.at_rad);
        if off.abs() < 0.5 * number(notch.width_rad) {
            sum -= number(notch.torque_n_m) * (std::f64::consts::TAU * off / number(notch.width_rad)).sin();
        }
    }
    Some(sum)
}

/// A part that makes sense by itself, at this angle; the device may refuse what it makes together with the others.
fn part(random: &mut Pcg64, angle: f32) -> FeelPart {
    let mut between = |least: f32, most: f32| least + (most - least) * random.random::<f32>();
    let wave = |pitch: f32, share: f32| Wave { pitch_rad: pitch, torque_n_m: 0.1 * share * pitch, centre_rad: share };
    match between(0.0, 9.5) as u32 {
        0 => FeelPart::Detents(Some(wave(between(0.05, 0.6), between(0.0, 1.0)))),
        1 => {
            let (pitch, first) = (between(0.1, 0.5), (angle / 0.3) as i32 - between(0.0, 6.0) as i32);
            let (last, max_force) = (first + between(3.0, 20.0) as i32, between(0.005, 0.03));
            let (snap, stiffness) = (between(0.5, 0.9), between(0.0, 0.2));
            let (damping, wall_stiffness) = (between(0.0, 5e-4), between(0.0, 0.5));
            FeelPart::Clicks(Some(Detents { pitch, stiffness, damping, snap, first, last, wall_stiffness, max_force }))
        }
        2 => FeelPart::Texture(Some(wave(between(0.02, 0.06), between(0.0, 1.0)))),
        3 => FeelPart::Spring(Some(Spring {
            stiffness_n_m_per_rad: between(0.0, 0.2),
            rest_rad: angle + between(-1.0, 1.0),
            max_torque_n_m: between(0.0, 0.03),
        })),
        4 => FeelPart::Ends(Some(Ends {
            between_rad: [angle - between(-0.2, 1.0), angle + between(0.3, 1.0)],
            stiffness_n_m_per_rad: between(0.0, 1.0),
            damping_n_m_s_per_rad: between(0.0, 1e-3),
        })),
        5 => FeelPart::Damping(between(0.0, 1e-3)),
        6 => FeelPart::Friction(Some(DialFriction {
            torque_n_m: between(0.0, 5e-3),
            whole_at_rad_per_s: between(4.0, 10.0),
        })),
        7 => FeelPart::Notch(Some(Notch {
            at_rad: angle + between(-0.5, 0.5),
            width_rad: between(0.2, 1.0),
            torque_n_m: between(0.0, 0.03),
        })),
        8 => [FeelPart::Detents(None), FeelPart::Clicks(None), FeelPart::Spring(None), FeelPart::Ends(None)]
            [between(0.0, 3.99) as usize],
        _ => FeelPart::Free,
    }
}

/// Bytes as they are.
struct Raw(Vec<u8>);

impl serde::Serialize for Raw {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeTuple as _;
        let mut tuple = serializer.serialize_tuple(self.0.len())?;
        self.0.iter().try_for_each(|byte| tuple.serialize_element(byte))?;
        tuple.end()
    }
}

/// The bytes of a message, without checksum and COBS.
fn unpacked(message: &HostMessage) -> Vec<u8> {
    let mut buffer = [0; MAX_FRAME];
    let mut frame = pack(message, &mut buffer).expect("it fits");
    let mut bytes = Vec::new();
    while let [length, rest @ ..] = frame
        && *length > 0
    {
        let (run, next) = rest.split_at(usize::from(*length) - 1);
        bytes.extend(run);
        bytes.push(0);
        frame = next;
    }
    // The last zero is COBS's own, before it is the checksum.
    bytes.truncate(bytes.len() - 5);
    bytes
}

/// A number of tests, from the environment.
fn number(name: &str, default: u32) -> u32 {
    std::env::var(name).map_or(default, |number| number.parse().expect("a whole number"))
}

#[test]
fn no_change_of_the_feel_makes_a_step_while_a_hand_turns_the_dial() {
    let (valid, spoiled) = (number("PALPATE_FEELS", 1_000), number("PALPATE_SPOILED_FEELS", 5_000));
    let mut device = Device::new(Rig::running());
    device.send(&HostMessage::Hello { protocol: PROTOCOL });
    device.tick();
    let mut random = Pcg64::seed_from_u64(39);
    let step = f64::from(LET_GO / SETTINGS.rate_hz);
    let limit = 2.8 * 0.02;
    let (mut largest, mut taken, mut checked, mut click) = (0.0_f64, 0, 0_u32, Some(0));
    let (mut left_over, mut clicks, mut was_own) = (0.0_f64, None, true);
    let (from, began) = (device.rig.world.borrow().dial.angle(), device.rig.world.borrow().dial.time());
    for number in 0..valid + spoiled {
        let angle = device.rig.bench.state().witness().angle().expect("it has ticked");
        let feel = HostMessage::Command { number: number as u16, command: Command::Feel(part(&mut random, angle)) };
        if number < valid {
            device.send(&feel);
        } else {
            // A byte or two of it are others, under a checksum that is right: half of them make no frame at all.
            let mut message = unpacked(&feel);
            for _ in 0..1 + random.random_range(0..2) {
                let at = random.random_range(3..message.len());
                message[at] = random.random();
            }
            let mut buffer = [0; MAX_FRAME];
            let frame = pack(&Raw(message), &mut buffer).expect("it fits");
            let damage = if random.random() { 0 } else { random.random_range(0..frame.len()) };
            device
                .wire
                .to_device
                .extend(frame.iter().enumerate().map(|(at, byte)| if at + 1 == damage { !byte } else { *byte }));
            device.wire.to_device.push_back(0);
        }
        for tick in 0..random.random_range(2..5) {
            // There and back by two radians, by fits and starts.
            let time = device.rig.world.borrow().dial.time() - began;
            let aim = from + 2.0 * (1.3 * time).sin() + 0.3 * (7.1 * time).sin();
            let rate = 2.6 * (1.3 * time).cos() + 2.13 * (7.1 * time).cos();
            device.rig.set(|world| world.dial.hold(Fingers { stiffness: 2.0, damping: 0.01, aim, rate }));
            let before = f64::from(torque(&device));
            let from_angle = f64::from(device.rig.bench.state().witness().angle().expect("it has ticked"));
            device.told.clear();
            device.tick();
            let is_taken = |told: &DeviceMessage| matches!(told, DeviceMessage::Answer(Answer { refused: None, .. }));
            let changed = device.told.iter().any(is_taken);
            let (after, state) = (f64::from(torque(&device)), device.rig.bench.state());
            let witness = state.witness();
            assert_eq!((device.rig.fault(), device.rig.enabled()), (None, true), "{number}");
            assert!(after.abs() <= limit + 1e-9, "{number}: {after}");
            if changed {
                taken += 1;
                largest = largest.max((after - before).abs());
                assert!((after - before).abs() <= 1e-3, "{number}, {tick}: a step of {} N·m", after - before);
            }
            // A spoiled message may choose from the table, and then back, with the clicks nearest to the dial.
            let is_own = usize::from(witness.feel()) == FEELS.len();
            let Some(feel) = witness.own().filter(|_| is_own) else {
                (left_over, clicks, was_own) = (f64::NAN, None, false);
                continue;
            };
            // New clicks hold the dial in the detent that was nearest when they came. Chosen again, they hold it in the
            // one that is nearest by the angle of this tick, from which whole turns were taken.
            let nearest_by = if was_own { from_angle } else { f64::from(witness.angle().expect("it has ticked")) };
            was_own = true;
            if let Some(new) = feel.clicks.filter(|_| feel.clicks != clicks) {
                click = Some(((nearest_by / f64::from(new.pitch)).round() as i32).clamp(new.first, new.last));
            }
            clicks = feel.clicks;
            // By its own formula the torque is that of the feel, and what is left over of the one before.
            let (angle, [rate]) = (witness.angle().expect("it has ticked"), state.rates());
            let Some(asked) = asked(feel, &mut click, f64::from(angle), f64::from(rate)) else {
                left_over = f64::NAN;
                continue;
            };
            let rest = after - asked.clamp(-limit, limit);
            // Roundings of three radians by 1.6 N·m/rad and of the rate by 3.2e-3 N·m·s/rad.
            if !changed && left_over.is_finite() {
                let bound = (left_over.abs() - step).max(0.0) + 5e-6;
                assert!(rest.abs() <= bound, "{number}, {tick}: {rest} left of {left_over} in {feel:?}");
                checked += 1;
            }
            // At the limit the rest of what is left over is not seen.
            left_over = if after.abs() < limit - 1e-6 { rest } else { f64::NAN };
        }
    }
    println!("{taken} changes taken, largest torque step {:.3} mN·m; {checked} ticks compared", 1e3 * largest);
    assert!(taken > valid / 4 && checked > valid, "{taken} {checked}");
}

#[test]
fn a_kept_or_early_spring_leaves_the_dial_where_it_is() {
    use palpate_sim::knob::{KnobFlash, SharedKnob, SimulatedKnob};

    /// Ticks until the knob is aligned and its force is there, after a hand has turned the dial on.
    fn enable(device: &mut palpate_link::Device<SimulatedKnob>, knob: &SharedKnob, turned: f64) -> f64 {
        let press = |device: &mut palpate_link::Device<SimulatedKnob>, pressed: bool, ticks: u32| {
            knob.world().enable = pressed;
            (0..ticks).for_each(|_| device.line().tick());
            device.tend().unwrap();
        };
        if !device.line().board.bench.state().homed() {
            press(device, false, 400);
            press(device, true, palpate_sim::knob::SEARCH.ticks() + 10);
        }
        press(device, false, 400);
        let from = knob.world().dial.angle();
        for tick in 1..=4_000 {
            let aim = from + turned * f64::from(tick) / 4_000.0;
            knob.world().dial.hold(Fingers { rate: turned, ..Fingers::clamp(aim) });
            device.line().tick();
        }
        knob.world().dial.hold(Fingers::clamp(from + turned));
        press(device, false, 400);
        knob.world().dial.hold(Fingers::NONE);
        let from = knob.world().dial.angle();
        press(device, true, 4_000);
        assert_eq!(device.line().board.bench.state().phase(), palpate::servo::Phase::Running);
        knob.world().dial.angle() - from
    }
    let make = |flash: &'static KnobFlash| {
        let knob = SharedKnob::new(DialSettings::gimbal_knob());
        let device = palpate_link::Device::over(SimulatedKnob::new(&knob, flash)).unwrap();
        (device, knob)
    };
    let flash: &'static KnobFlash = Box::leak(Box::new(KnobFlash::new()));
    let spring = Spring { stiffness_n_m_per_rad: 0.2, rest_rad: 60.0, max_torque_n_m: 0.03 };
    let ends = Ends { between_rad: [-0.5, 0.5], stiffness_n_m_per_rad: 0.6, damping_n_m_s_per_rad: 1e-3 };
    let (mut device, knob) = make(flash);
    // Early: before the dial's place is known its rest may be anywhere.
    device.feel(FeelPart::Free).unwrap();
    device.feel(FeelPart::Damping(1.4e-4)).unwrap();
    device.feel(FeelPart::Spring(Some(spring))).unwrap();
    let early = enable(&mut device, &knob, 3.0);
    // Then it must be near.
    let far = device.feel(FeelPart::Spring(Some(spring))).unwrap_err();
    assert!(far.to_string().contains("the limit is an eighth of a turn, 0.79 rad"), "{far}");
    let on = enable(&mut device, &knob, 40.0);
    let at = device.line().board.bench.state().witness().angle().unwrap();
    let [least, most] = ends.between_rad;
    device.feel(FeelPart::Ends(Some(Ends { between_rad: [least + at, most + at], ..ends }))).unwrap();
    // Kept: refused under force, then confirmed.
    let driven = device.keep_feel(true, || ()).unwrap_err();
    assert!(driven.to_string().contains("only while the motors are off"), "{driven}");
    knob.world().enable = false;
    (0..400).for_each(|_| device.line().tick());
    let mut confirms = 0;
    device.keep_feel(true, || confirms += 1).unwrap();
    assert_eq!(confirms, 1, "a person is asked once");
    let own = device.line().board.bench.state().witness().own().copied();
    let reset: &'static KnobFlash = Box::leak(Box::new(flash.after_reset()));
    let (mut device, knob) = make(reset);
    assert_eq!(device.line().board.bench.state().witness().own().copied(), own);
    let kept = enable(&mut device, &knob, -55.0);
    let again = enable(&mut device, &knob, 9.0);
    // Reports come at their rate.
    device.tend().unwrap();
    let (began, dials) = (device.now(), device.dials());
    while (device.now() - began).as_secs_f64() < 1.0 {
        device.dial(std::time::Duration::from_millis(20)).unwrap();
    }
    let dials = device.dials() - dials;
    let dial = device.dial(std::time::Duration::ZERO).unwrap();
    println!("turned by {:?} mrad; {dials} reports in a second", [early, on, kept, again].map(|by| (1e3 * by).round()));
    assert!((99..=101).contains(&dials) && dial.kept == palpate::wire::KeptFeel::Used as u8, "{dials} {dial:?}");
    // A detent of cogging is 5 degrees.
    assert!([early, on, kept, again].iter().all(|by| by.abs() < 0.09), "{early} {on} {kept} {again}");
    // And a flash that is damaged is no feel.
    knob.world().enable = false;
    (0..400).for_each(|_| device.line().tick());
    device.keep_feel(false, || ()).unwrap();
    let (mut device, _) = make(Box::leak(Box::new(reset.after_reset())));
    assert_eq!(device.line().board.bench.state().witness().own(), None);
}
