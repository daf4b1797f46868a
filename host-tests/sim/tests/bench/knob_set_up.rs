//! A knob that is being set up: its field is led round while button and key are held, within the board's own limits,
//! and by nothing else.

use crate::knob::{HARMS, Rig};
use crate::knob_orders::Device;
use palpate::commission::{Jog, JogRefusal, KEY};
use palpate::servo::ResetReason;
use palpate::wire::{DeviceMessage, HostMessage, PROTOCOL, Reading};
use palpate_sim::knob::JOG;
use palpate_sim::plant::Fingers;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

/// What a host at such a knob says.
struct Host {
    device: Device,
    number: u32,
}

impl Host {
    /// At a knob that is being set up, with its button up.
    fn new() -> Self {
        let mut device = Device::new(Rig::new(ResetReason::PowerOn));
        device.send(&HostMessage::Hello { protocol: PROTOCOL });
        (0..150).for_each(|_| device.tick());
        device.send(&HostMessage::SetUp);
        for (pressed, ticks) in [(true, 2_100), (false, 150)] {
            device.rig.set(|world| world.button = pressed);
            (0..ticks).for_each(|_| device.tick());
        }
        (0..150).for_each(|_| device.tick());
        assert!(device.told.iter().any(|told| matches!(told, DeviceMessage::Reading(_))), "it is being set up");
        Self { device, number: 0 }
    }

    /// The same, with its button pressed.
    fn pressed() -> Self {
        let mut host = Self::new();
        host.device.rig.set(|world| world.button = true);
        host.ticks(10);
        host
    }

    /// Led on for long enough to have caught the rotor.
    fn led() -> Self {
        let mut host = Self::pressed();
        host.hold(6_000, i16::MAX);
        assert!(host.device.rig.enabled(), "{:?}", host.reading());
        host
    }

    fn jog(&mut self, key: u32, motor: u8, duty: i16) {
        self.number += 1;
        self.device.send(&HostMessage::Jog(Jog { number: self.number, key, motor, duty }));
    }

    fn ticks(&mut self, ticks: u32) {
        (0..ticks).for_each(|_| self.device.tick());
    }

    /// Holds the key for so many ticks, a frame every 20 ms.
    fn hold(&mut self, ticks: u32, duty: i16) {
        for tick in 0..ticks {
            if tick % 80 == 0 {
                self.jog(KEY, 0, duty);
            }
            self.device.tick();
        }
    }

    /// The newest.
    fn reading(&self) -> Reading {
        let reading =
            |told: &DeviceMessage| if let DeviceMessage::Reading(reading) = told { Some(*reading) } else { None };
        self.device.told.iter().rev().find_map(reading).expect("a reading")
    }

    #[track_caller]
    fn assert_off(&mut self, ticks: u32) {
        for tick in 0..ticks {
            self.device.tick();
            let rig = &self.device.rig;
            assert!(!rig.enabled() && rig.world.borrow().dial.currents() == [0.0; 3], "tick {tick}");
        }
    }
}

#[test]
fn the_field_is_led_there_and_back_by_no_more_than_the_boards_own_limits() {
    let mut host = Host::led();
    let (from, angle) = (host.reading().counts[2], host.device.rig.world.borrow().dial.angle());
    let turn = JOG.turn_ticks.unwrap();
    let mut most = 0.0_f64;
    for (duty, way) in [(i16::MAX, 1), (-i16::MAX, 0)] {
        // The duty comes down and up again within a fifth of a second, and the field turns back in the middle of it.
        for _ in 0..turn / 80 {
            host.hold(80, duty);
            let currents = host.device.rig.world.borrow().dial.currents();
            most = currents.into_iter().map(f64::abs).fold(most, f64::max);
        }
        let reading = host.reading();
        assert_eq!((reading.live, reading.refusal), (true, 0));
        let limit = (JOG.share * 32_767.0 + 0.5) as i16;
        assert_eq!(reading.duties[0], limit * duty.signum(), "whatever is asked for");
        let gone = f64::from(reading.counts[2].wrapping_sub(from)) / 65_536.0;
        // The ramps, 800 ticks there and as many back, and the frame that is on its way.
        assert!((gone - f64::from(way)).abs() < 1_000.0 / f64::from(turn), "{gone}");
        let turned = (host.device.rig.world.borrow().dial.angle() - angle).abs() * 11.0 / std::f64::consts::TAU;
        // How far a rotor may be behind.
        assert!((turned - f64::from(way)).abs() < 0.2, "{turned}");
    }
    // 40 mN·m, of which √(2/3) of the current is a phase's amplitude: 0.39 A; dead time is made up for to a part.
    assert!(most > 0.3 && most < 0.41, "{most} A");
}

#[test]
fn a_key_that_falls_silent_or_is_let_go_of_and_a_button_let_go_of_end_it() {
    let mut host = Host::led();
    let silent = (JOG.patience * 4_000.0) as u32;
    host.ticks(silent + 1);
    host.assert_off(400);
    let mut host = Host::led();
    host.jog(0, 0, 0);
    host.device.tick();
    host.assert_off(400);
    let mut host = Host::led();
    host.device.rig.set(|world| world.button = false);
    host.device.tick();
    assert!(!host.device.rig.enabled());
    // The key alone does nothing.
    host.hold(400, i16::MAX);
    host.assert_off(1);
}

#[test]
fn whatever_breaks_while_it_is_led_disables_the_stage() {
    for (what, harm, within) in HARMS {
        let mut host = Host::led();
        host.device.rig.set(harm);
        host.hold(within, i16::MAX);
        assert!(!host.device.rig.enabled(), "{what}");
        host.hold(800, i16::MAX);
        assert!(!host.device.rig.enabled() && !host.reading().live, "{what}");
    }
}

#[test]
fn a_dial_that_is_turned_too_fast_or_too_far_is_let_go_of() {
    for (rate, refusal) in [(40.0, JogRefusal::TooFast), (12.0, JogRefusal::TooFar)] {
        let mut host = Host::led();
        host.device.rig.set(|world| world.dial.hold(Fingers { stiffness: 0.0, damping: 2e-2, aim: 0.0, rate }));
        host.hold(8_000, i16::MAX);
        assert!(!host.device.rig.enabled(), "{rate}");
        assert_eq!(JogRefusal::from_code(host.reading().refusal), Some(refusal), "{rate}");
    }
}

/// A command that holds no key, whatever else it is.
fn keyless(random: &mut Pcg64, number: u32) -> HostMessage {
    let [kind, a, b] = [(); 3].map(|()| random.next_u64());
    let key = match a as u32 {
        // One in eight is nearly right.
        key if key & 7 == 0 => KEY ^ (1 << (key >> 8 & 31)),
        KEY => 0,
        key => key,
    };
    let jog =
        Jog { number: number.wrapping_add(b as u32 % 3), key, motor: (b >> 32) as u8 % 3, duty: (b >> 40) as i16 };
    match kind % 8 {
        0 => HostMessage::Alive,
        1 => HostMessage::Acknowledge,
        2 => HostMessage::SetUp,
        3 => HostMessage::Hello { protocol: PROTOCOL },
        4 => HostMessage::Command { number: a as u16, command: palpate::scene::Command::Choose { index: b as u8 } },
        _ => HostMessage::Jog(jog),
    }
}

#[test]
fn no_command_moves_the_motor_without_the_key_and_no_key_without_the_button() {
    const COMMANDS: u32 = 100_000;
    let mut host = Host::led();
    // What held the key before is stale.
    let stale = host.number;
    host.jog(0, 0, 0);
    host.device.tick();
    let mut random = Pcg64::seed_from_u64(3);
    for command in 0..COMMANDS {
        if command % 16 == 0 {
            let number = random.next_u64() as u32 % (stale + 1);
            host.device.send(&HostMessage::Jog(Jog { number, key: KEY, motor: 0, duty: 9_000 }));
        } else {
            let fuzzed = keyless(&mut random, host.number);
            if let HostMessage::Jog(Jog { number, .. }) = fuzzed {
                host.number = number;
            }
            host.device.send(&fuzzed);
        }
        if command % 4 == 0 {
            host.device.told.clear();
            host.assert_off(1);
        }
    }
    assert!(host.device.rig.world.borrow().button, "only the key was missing");
    host.hold(800, 9_000);
    assert!(host.device.rig.enabled(), "and with it the motor is driven");
    // A key that is held all along, while the button goes up and down: never without it.
    let mut host = Host::new();
    for tick in 0..20_000_u32 {
        if tick % 80 == 0 {
            host.jog(KEY, 0, (random.next_u64() >> 48) as i16);
            host.device.told.clear();
        }
        if random.next_u64() % 200 == 0 {
            host.device.rig.set(|world| world.button = !world.button);
        }
        host.device.tick();
        let world = host.device.rig.world.borrow();
        assert!(world.button || !world.enabled, "{tick}");
    }
}
