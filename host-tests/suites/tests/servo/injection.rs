//! Every fault, brought about in a running loop.

use crate::harmed::{Decayed, LINK_TICKS, Poisoned, TestServo};
use palpate::device::{Counts, Device, Kinematics};
use palpate::servo::{Event, Fault, Input, Phase, ResetReason, ServoState};
use palpate::track::Contact;
use rand::Rng;
use rand_pcg::Pcg64;

/// Of the table check: two for each of 33 words, and two ends.
pub const TICKS_PER_PASS: u32 = 272;
/// Until a sensor that stands still is called stuck by limits that allow next to no travel: eight turns of the probe and
/// three joints.
pub const STUCK_TICKS: u32 = 32;

/// What injecting a fault came to.
pub enum Seen {
    /// A tick was run, or an event noted, in which it must have been seen; whether the sensors of that tick are to be
    /// believed.
    Now { believable: bool },
    /// In this phase it cannot be seen, and why that does no harm.
    Not,
}

/// Servos to harm, and what they are harmed with.
pub struct Bench<'a> {
    pub servo: TestServo<'a>,
    /// The same, but that any travel of another joint makes a sensor stuck.
    pub strict: TestServo<'a>,
    /// The same, but that next to no depth is contact lost.
    pub shallow: TestServo<'a>,
    pub device: &'a Device<Poisoned, 3>,
    pub patch: &'a Decayed,
    pub random: Pcg64,
}

impl Bench<'_> {
    pub fn below(&mut self, bound: u32) -> u32 {
        (self.random.next_u64() >> 33) as u32 % bound
    }

    /// Brings a fault about in a state whose next good sensors are `counts`.
    pub fn inject(&mut self, fault: Fault, state: &mut ServoState<3>, counts: [Counts; 3], enable: bool) -> Seen {
        let joint = self.below(3) as usize;
        let sensors = |counts| Input::Sensors { counts, enable };
        match fault {
            Fault::FrameLost => {
                let _ = self.servo.tick(state, Input::Lost);
                Seen::Now { believable: false }
            }
            Fault::FrameDamaged => {
                let _ = self.servo.tick(state, Input::Damaged);
                Seen::Now { believable: false }
            }
            Fault::Magnet => {
                let _ = self.servo.tick(state, Input::Magnet);
                Seen::Now { believable: false }
            }
            Fault::Frozen => {
                let _ = self.servo.tick(state, Input::Frozen);
                Seen::Now { believable: false }
            }
            Fault::JointOutOfRange => {
                // All bits alike, the sign turned, far off.
                let choices = [i32::MIN, i32::MAX, -1_000_000 - self.below(1 << 30) as i32, 1_000_000];
                let mut bad = counts;
                bad[joint] = Counts(choices[self.below(4) as usize]);
                let _ = self.servo.tick(state, sensors(bad));
                Seen::Now { believable: false }
            }
            Fault::JointJumped => {
                if state.counts().is_none() {
                    return Seen::Not; // the first word has nothing to have jumped from; the motors are off
                }
                // 25 rad/s at 4 kHz are 32 counts of the turntable and 24 of the links: a jump of 40 to 140.
                let jump = 40 + self.below(100) as i32;
                let mut bad = counts;
                bad[joint].0 += if self.below(2) == 0 { jump } else { -jump };
                let _ = self.servo.tick(state, sensors(bad));
                Seen::Now { believable: false }
            }
            Fault::NotFinite => {
                let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][self.below(3) as usize];
                self.device.kinematics.with.set(Some(bad));
                let _ = self.servo.tick(state, sensors(counts));
                self.device.kinematics.with.set(None);
                Seen::Now { believable: false }
            }
            Fault::JointStuck => {
                // Five times dry friction is a load; twice that, so that it still is one when this count stays behind.
                let felt = self.device.kinematics.pose(state.angles()).unwrap().torques(state.force())[joint];
                if felt.abs() < 10.0 * self.device.dry_friction_n_m[joint] || state.counts().is_none() {
                    return Seen::Not; // without load a joint may rest
                }
                // The last count again, while the other joints come a count a tick: seven pieces of the way, one of which
                // is seen in four ticks, for the joints have their turns between.
                let mut bad = counts;
                bad[joint] = state.counts().unwrap()[joint];
                for _ in 0..STUCK_TICKS {
                    if state.fault().is_none() {
                        let _ = self.strict.tick(state, sensors(bad));
                        bad[(joint + 1) % 3].0 += 1;
                        bad[(joint + 2) % 3].0 += 1;
                    }
                }
                if state.fault().is_none() {
                    return Seen::Not; // the move took the load away
                }
                Seen::Now { believable: false }
            }
            Fault::ContactLost => {
                // Only contact can be lost, and only where there is force does it matter how often.
                let is_deep = state.contact() == Contact::Touching && state.gap() < -5e-4;
                if !(state.phase() == Phase::Running && enable && is_deep) {
                    return Seen::Not;
                }
                let _ = self.shallow.tick(state, sensors(counts));
                Seen::Now { believable: true }
            }
            Fault::Unreachable => {
                self.device.kinematics.open.set(true);
                let _ = self.servo.tick(state, sensors(counts));
                self.device.kinematics.open.set(false);
                Seen::Now { believable: false }
            }
            // Of a loop that is protected: see `guard.rs`.
            Fault::Overspeed | Fault::Supply | Fault::WrongPolarity => Seen::Not,
            // From the start of a loop on a surface for another rate: see `a_loop_of_another_rate_…`.
            Fault::OtherRate => Seen::Not,
            Fault::Overrun => {
                self.servo.note(state, Event::Overrun);
                Seen::Now { believable: false }
            }
            Fault::LinkLost => {
                for silent in 0..=LINK_TICKS {
                    if silent == 0 || state.fault().is_none() {
                        let _ = self.servo.tick(state, sensors(counts));
                    }
                }
                Seen::Now { believable: true }
            }
            Fault::TableCorrupt => {
                self.patch.bit.set(Some(self.below(33 * 32)));
                // The pass under way may have gone by; the next one has not.
                for _ in 0..2 * TICKS_PER_PASS {
                    if state.fault().is_none() {
                        self.servo.note(state, Event::LinkAlive);
                        let _ = self.servo.tick(state, sensors(counts));
                    }
                }
                self.patch.bit.set(None);
                Seen::Now { believable: true }
            }
            Fault::WatchdogReset => {
                *state = self.servo.start_after(ResetReason::Watchdog);
                Seen::Now { believable: false }
            }
            Fault::BrownOut => {
                *state = self.servo.start_after(ResetReason::BrownOut);
                Seen::Now { believable: false }
            }
            Fault::Drive => {
                self.servo.note(state, Event::DriveFault);
                Seen::Now { believable: false }
            }
            Fault::Homing => {
                self.servo.note(state, Event::HomingRefused);
                Seen::Now { believable: false }
            }
            Fault::Calibration => {
                self.servo.note(state, Event::CalibrationRefused);
                Seen::Now { believable: false }
            }
            Fault::Stopped => {
                self.servo.note(state, Event::Stop);
                Seen::Now { believable: false }
            }
        }
    }
}
