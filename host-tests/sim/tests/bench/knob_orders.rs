//! A host at the knob's line: it chooses what is felt, and nothing that it says makes a step or drives by itself.

use crate::knob::Rig;
use palpate::scene::{BodyPose, Command, SceneError};
use palpate::servo::{Heartbeat, ResetReason};
use palpate::wire::frame::{MAX_FRAME, Received, Receiver, pack};
use palpate::wire::{Answer, DeviceMessage, Hello, HostMessage, PROTOCOL, Refused, Upload};
use palpate_bench::Idle;
use palpate_sim::knob::{FEELS, LET_GO, SETTINGS};
use palpate_sim::plant::Fingers;
use palpate_sim::simulated::{NoWatchdog, Wire};
use rand::{Rng, SeedableRng};
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
        assert_eq!(refused, Some(Refused::Command(SceneError::Missing(index))));
    }
    for (number, order) in (500..).zip([Command::Push { force: [1.0; 3] }, Command::Limit { force: 100.0 }]) {
        assert_eq!(device.order(number, order), Some(Refused::Command(SceneError::NotOffered)));
    }
    assert_eq!((device.feel(), device.rig.fault(), device.rig.enabled()), (last, None, true));
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
