//! Every fault that a knob can have, in every phase: it lets go in the same tick.

use super::{SEARCH, dial};
use palpate::device::{Device, Dial};
use palpate::servo::{Config, Event, Fault, Output, ResetReason, Safety, Servo};
use palpate_sim::knob::{HostKnob, NAMES, TOLD_OF_SUPPLY, device, servo};
use palpate_sim::plant::{DialSettings, Fingers, MagneticFault};

/// How a knob comes to a fault.
enum How {
    /// By this, in any phase, in the very next tick.
    Anytime(fn(&mut HostKnob)),
    /// By this, in any phase, within so many ticks.
    Within(u32, fn(&mut HostKnob)),
    /// By this, where something is felt, within so many ticks; the alignment refuses it by another name.
    Felt(u32, fn(&mut HostKnob)),
    /// By a reset.
    Reset(ResetReason),
    /// It cannot, and why.
    Never(&'static str),
}

/// No fault is left out: a new one does not compile until it is said here.
fn how(fault: Fault) -> How {
    match fault {
        Fault::FrameLost => How::Anytime(|knob| knob.dial.spoil(Some(MagneticFault::Absent))),
        Fault::FrameDamaged => How::Anytime(|knob| knob.damaged = true),
        // A hand that is stronger than all feels turns on and on, within the speeds that are allowed.
        Fault::JointOutOfRange => How::Felt(1_000, |knob| {
            knob.dial.hold(Fingers { stiffness: 0.0, damping: 5e-3, aim: 0.0, rate: 30.0 });
        }),
        Fault::JointJumped => How::Anytime(|knob| knob.dial.spoil(Some(MagneticFault::Slipped(900)))),
        Fault::Magnet => How::Anytime(|knob| knob.dial.spoil(Some(MagneticFault::Magnet))),
        Fault::Frozen => How::Felt(1_001, |knob| knob.dial.spoil(Some(MagneticFault::Stuck))),
        Fault::NotFinite => How::Never("feels, maps and counts are finite, and so is what is made of them"),
        Fault::JointStuck => How::Never("one joint has no others: its sensor is watched for freezing"),
        Fault::Overrun => How::Anytime(|knob| (0..64).for_each(|_| knob.note(Event::Overrun))),
        Fault::LinkLost => How::Within(LINK_TICKS + 1, |knob| knob.silent = true),
        Fault::TableCorrupt => How::Never("the feels are part of the program"),
        Fault::OtherRate => How::Never("a dial has no motion of its own"),
        Fault::WatchdogReset => How::Reset(ResetReason::Watchdog),
        Fault::BrownOut => How::Reset(ResetReason::BrownOut),
        Fault::Drive => How::Anytime(|knob| knob.note(Event::DriveFault)),
        Fault::Homing => How::Anytime(|knob| knob.note(Event::HomingRefused)),
        Fault::Stopped => How::Anytime(|knob| knob.note(Event::Stop)),
        Fault::Unreachable => How::Never("a dial has a pose at every angle"),
        Fault::ContactLost => How::Never("a dial touches nothing"),
        // The same hand, faster than it may be and slower than counts are believed.
        Fault::Overspeed => How::Felt(400, |knob| {
            knob.dial.hold(Fingers { stiffness: 0.0, damping: 5e-3, aim: 0.0, rate: 90.0 });
        }),
        Fault::Supply => How::Anytime(|knob| knob.dial.supply(9.9)),
        Fault::Calibration => How::Anytime(|knob| knob.note(Event::CalibrationRefused)),
        Fault::WrongPolarity => How::Never("the alignment finds out which way the counts go"),
    }
}

/// Ticks of silence after which the host is gone.
const LINK_TICKS: u32 = 40;
/// Wide enough for what the hands do before, and narrow enough to be left.
const RANGE: [f32; 2] = [-2.0, 2.0];

fn watched(settings: DialSettings) -> HostKnob {
    let device: &'static Device<Dial, 1> = Box::leak(Box::new(Device { joint_range_rad: [RANGE], ..device(None) }));
    let safety = Safety { link_timeout_s: LINK_TICKS as f32 / super::SETTINGS.rate_hz, ..Safety::DEFAULT };
    let servo = servo(device, SEARCH, TOLD_OF_SUPPLY);
    let config = Config { safety, ..servo.config() };
    HostKnob::new(Servo::protected(device, servo.surface(), TOLD_OF_SUPPLY, config), dial(settings))
}

/// A knob at each place of its life at which it drives, and whether something is felt there.
fn lives() -> Vec<(&'static str, bool, HostKnob)> {
    let mut aligning = watched(DialSettings::gimbal_knob());
    let mut lives = Vec::new();
    for (when, ticks) in [("the field comes up", 400), ("catching", 1_500), ("there", 2_000), ("back", 2_000)] {
        aligning.ticks(ticks);
        lives.push((when, false, aligning.clone()));
    }
    let mut felt = aligning;
    felt.ticks(SEARCH.ticks());
    for (index, name) in NAMES.into_iter().enumerate() {
        felt.choose(index as u8);
        felt.dial.hold(Fingers::turning(0.7 + 1.3, 0.0));
        // In the middle of letting go of the last, and after it.
        felt.ticks(20);
        lives.push(("switching", true, felt.clone()));
        felt.ticks(1_000);
        lives.push((name, true, felt.clone()));
    }
    lives
}

/// Demands that the motor has no current from the period after the fault on, and never again.
#[track_caller]
fn lets_go(mut knob: HostKnob, fault: Fault, within: u32, what: &str) {
    let mut ticks = 0;
    while knob.state().fault().is_none() {
        assert!(ticks < within, "{what}: no fault after {ticks} ticks");
        knob.tick();
        ticks += 1;
    }
    assert_eq!(knob.state().fault().map(|(fault, _)| fault), Some(fault), "{what}");
    assert_eq!((knob.state().output(), knob.widths()), (Output::Off, None), "{what}");
    // The widths come into force within the period.
    for _ in 0..2_000 {
        knob.tick();
        assert_eq!((knob.widths(), knob.dial.currents()), (None, [0.0; 3]), "{what}");
    }
}

#[test]
fn whatever_goes_wrong_in_whatever_phase_lets_go_in_the_same_tick() {
    let lives = lives();
    for fault in Fault::ALL {
        for (when, is_felt, knob) in &lives {
            let (within, spoil) = match how(fault) {
                How::Anytime(spoil) => (1, spoil),
                How::Within(ticks, spoil) => (ticks, spoil),
                // Without a force a dial may be turned as fast as a hand likes.
                How::Felt(..) if fault == Fault::Overspeed && *when == "free" => continue,
                How::Felt(ticks, spoil) if *is_felt => (ticks, spoil),
                How::Felt(..) | How::Reset(_) | How::Never(_) => continue,
            };
            let mut knob = knob.clone();
            assert!(knob.widths().is_some(), "{fault}, {when}: it drives");
            spoil(&mut knob);
            lets_go(knob, fault, within, &format!("{fault}, {when}"));
        }
    }
}

#[test]
fn a_reset_that_is_a_fault_drives_nothing_however_long_the_button_is_held() {
    for fault in Fault::ALL {
        let How::Reset(reason) = how(fault) else { continue };
        let mut knob = HostKnob::at(DialSettings::gimbal_knob(), None).reset_by(reason);
        for _ in 0..SEARCH.ticks() + 2_000 {
            knob.tick();
            assert_eq!((knob.state().output(), knob.dial.currents()), (Output::Off, [0.0; 3]), "{fault}");
        }
        assert_eq!(knob.state().fault(), Some((fault, 0)));
    }
}

#[test]
fn what_a_knob_cannot_have_has_a_reason_and_is_never_seen() {
    let mut seen = lives();
    for (when, _, knob) in &mut seen {
        knob.ticks(2_000);
        assert_eq!(knob.state().fault(), None, "{when}");
    }
    let never = Fault::ALL.into_iter().filter(|fault| matches!(how(*fault), How::Never(why) if !why.is_empty()));
    assert_eq!(never.count(), 7);
}
