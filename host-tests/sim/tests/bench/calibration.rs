//! A calibration in flash: written while the device is set up and nothing moves, whole or not at all; believed after a
//! reset only if it can be this device's.

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use palpate::commission::{Calibration, CalibrationError, Jog, JointCalibration, KEY, Wiring};
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Device as ArmDevice, Encoder, SerialArm, ZeroOf};
use palpate::servo::{Config, Fault, Heartbeat, Phase, ResetReason, SafeOutput, Safety, Servo};
use palpate::wire::frame::{MAX_FRAME, Received, Receiver, pack};
use palpate::wire::{
    Answer, Calibrated, DeviceMessage, HostMessage, KeepError, PROTOCOL, Reading, Refused, Upload, hold,
};
use palpate_bench::store::{Built, KeptCalibration};
use palpate_bench::{Calibrations as _, Idle};
use palpate_sim::rig::{Made, Rig, SETTINGS, WALL, held_at, settings};
use palpate_sim::simulated::{NoWatchdog, Wire};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::cell::{Cell, RefCell};
use std::rc::Rc;

static DEVICE: ArmDevice<SerialArm, 3> = WOODEN_HAPTICS_2016;
const PAGE: usize = 2_048;

/// A page of flash with the rules of the Nucleo's: double words, each written once. The power goes after so many of
/// them, or erasures; then nothing happens any more.
#[derive(Clone)]
struct Page(Rc<Inside>);

struct Inside {
    bytes: RefCell<[u8; PAGE]>,
    left: Cell<u32>,
    erased: Cell<u32>,
}

impl Page {
    fn erased() -> Self {
        Self::of([0xff; PAGE])
    }

    fn of(bytes: [u8; PAGE]) -> Self {
        Self(Rc::new(Inside { bytes: RefCell::new(bytes), left: Cell::new(u32::MAX), erased: Cell::new(0) }))
    }

    fn has_power(&self) -> bool {
        let left = self.0.left.get();
        self.0.left.set(left.saturating_sub(1));
        left > 0
    }
}

#[derive(Clone, Copy, Debug)]
struct Broken;

impl NorFlashError for Broken {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl ErrorType for Page {
    type Error = Broken;
}

impl ReadNorFlash for Page {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Broken> {
        let from = offset as usize;
        bytes.copy_from_slice(&self.0.bytes.borrow()[from..from + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        PAGE
    }
}

impl NorFlash for Page {
    const WRITE_SIZE: usize = 8;
    const ERASE_SIZE: usize = PAGE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Broken> {
        assert_eq!((from, to), (0, PAGE as u32));
        if self.has_power() {
            self.0.bytes.borrow_mut().fill(0xff);
            self.0.erased.set(self.0.erased.get() + 1);
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Broken> {
        assert!(offset.is_multiple_of(8) && bytes.len().is_multiple_of(8));
        for (number, word) in bytes.chunks(8).enumerate() {
            let from = offset as usize + 8 * number;
            let place = &mut self.0.bytes.borrow_mut()[from..from + 8];
            if self.has_power() {
                assert_eq!(place, [0xff; 8], "a double word is written once");
                place.copy_from_slice(word);
            }
        }
        Ok(())
    }
}

/// Zero of the second joint elsewhere, and the third motor weaker.
fn joints() -> [JointCalibration; 3] {
    core::array::from_fn(|joint| JointCalibration {
        input: joint as u8,
        output: joint as u8,
        radians_per_count: DEVICE.encoders[joint].radians_per_count,
        zero_of: ZeroOf::Count,
        angle_at_zero_rad: DEVICE.encoders[joint].angle_at_zero_rad + [0.0, 0.01, 0.0][joint],
        torque_at_full_n_m: DEVICE.motors[joint].torque_at_full_n_m * [1.0, 1.0, 0.95][joint],
        dry_friction_n_m: 0.02,
    })
}

/// The loops of these tests begin where their counters are zero.
const BUILT: Built<SerialArm, 3> =
    Built { device: &DEVICE, wiring: Wiring::STRAIGHT, homed_by: Some(ZeroOf::Count), gains: SETTINGS.gains() };

type Kept = KeptCalibration<Page, SerialArm, 3>;

/// What is found at a start with this flash.
fn found(page: &Page) -> Calibrated {
    Kept::find(page.clone(), BUILT).0.in_use()
}

/// A device from its reset on, with what its flash has.
struct Device {
    rig: Rig<SerialArm>,
    idle: Idle<'static>,
    wire: Wire,
    receiver: Receiver<DeviceMessage>,
    number: u16,
    jogs: u32,
    answer: Option<Answer>,
    calibrated: Option<Calibrated>,
    reading: Option<Reading>,
}

impl Device {
    fn start(page: &Page, reset: ResetReason) -> Self {
        let (kept, found) = Kept::find(page.clone(), BUILT);
        let device: &'static _ = Box::leak(Box::new(found.device));
        let safety = Safety { output: SafeOutput::Damping(5.0), ..Safety::DEFAULT };
        let built = Servo::new(&DEVICE, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT });
        let made = Made(built.calibrated(device), found.is_miscalibrated, found.wiring);
        let mut rig = Rig::made(made, held_at([0.0, 0.0, -0.004]), &settings(), reset);
        let kept: &'static Kept = Box::leak(Box::new(kept));
        let idle = Idle::new(rig.mailbox, rig.take_records(), Heartbeat::default()).calibrating(kept);
        let (wire, receiver) = (Wire::default(), Receiver::new());
        Self { rig, idle, wire, receiver, number: 0, jogs: 0, answer: None, calibrated: None, reading: None }
    }

    fn new(page: &Page) -> Self {
        let mut device = Self::start(page, ResetReason::PowerOn);
        device.send(&HostMessage::Hello { protocol: PROTOCOL });
        // Its button is released for long enough.
        device.ticks(150);
        device
    }

    fn set_up(page: &Page) -> Self {
        let mut device = Self::new(page);
        device.send(&HostMessage::SetUp);
        device.tick();
        device.confirm();
        device.ticks(150);
        assert!(device.reading.is_some(), "it is being set up");
        device
    }

    fn send(&mut self, command: &HostMessage) {
        let mut buffer = [0; MAX_FRAME];
        self.wire.to_device.extend(pack(command, &mut buffer).unwrap());
        self.below();
    }

    fn below(&mut self) {
        for _ in 0..4 * MAX_FRAME {
            self.idle.step(&mut self.wire, &mut NoWatchdog);
        }
        for byte in self.wire.from_device.drain(..) {
            match self.receiver.feed(byte) {
                Some(Received::Message(DeviceMessage::Answer(answer))) => self.answer = Some(answer),
                Some(Received::Message(DeviceMessage::Calibrated(calibrated))) => self.calibrated = Some(calibrated),
                Some(Received::Message(DeviceMessage::Reading(reading))) => self.reading = Some(reading),
                _ => {}
            }
        }
    }

    fn tick(&mut self) {
        self.rig.tick();
        self.below();
    }

    fn ticks(&mut self, ticks: u32) {
        (0..ticks).for_each(|_| self.tick());
    }

    fn ticks_off(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.tick();
            assert!(self.rig.is_off());
        }
    }

    /// A person holds the enable button for half a second, and releases it.
    fn confirm(&mut self) {
        for (pressed, ticks) in [(true, 2_100), (false, 150)] {
            self.rig.set(|world| world.button = pressed);
            (0..ticks).for_each(|_| self.tick());
        }
    }

    /// Holds the key for so many ticks.
    fn hold_key(&mut self, ticks: u32) {
        for tick in 0..ticks {
            if tick % 80 == 0 {
                self.jogs += 1;
                self.send(&HostMessage::Jog(Jog { number: self.jogs, key: KEY, motor: 1, duty: 5_000 }));
            }
            self.tick();
        }
    }

    /// What comes of it a tick later.
    fn keep(&mut self, joints: Option<[JointCalibration; 3]>) -> Option<Refused> {
        (self.number, self.answer) = (self.number + 1, None);
        self.send(&HostMessage::Calibrate { number: self.number, joints });
        self.tick();
        if self.answer.is_none() {
            self.confirm();
        }
        let answer = self.answer.expect("an answer");
        assert_eq!(answer.number, self.number);
        answer.refused
    }
}

fn refused(error: KeepError) -> Option<Refused> {
    Some(Refused::Calibration(error))
}

/// Makes of joints what a device cannot be.
type Spoil = fn(&mut [JointCalibration; 3]);

#[test]
fn it_is_kept_by_a_device_that_is_set_up_and_used_after_the_reset() {
    let page = Page::erased();
    let device = Device::new(&page);
    assert_eq!(device.calibrated, Some(Calibrated::BuiltIn));
    let mut device = Device::set_up(&page);
    assert_eq!(device.keep(Some(joints())), None);
    assert_eq!(device.calibrated, Some(Calibrated::BuiltIn), "until the reset");
    let crc = Calibration(joints()).crc();
    let mut device = Device::new(&page);
    assert_eq!(device.calibrated, Some(Calibrated::Kept { crc }));
    let loop_device = device.rig.bench.felt().0.device();
    assert_eq!(loop_device.encoders[1].angle_at_zero_rad, DEVICE.encoders[1].angle_at_zero_rad + 0.01);
    assert_eq!(loop_device.motors[2].torque_at_full_n_m, DEVICE.motors[2].torque_at_full_n_m * 0.95);
    assert_eq!(device.rig.state().angles_at_zero()[1], DEVICE.encoders[1].angle_at_zero_rad + 0.01);
    device.rig.press_until_it_runs();
    // Forgotten: what it was built with.
    assert_eq!(Device::set_up(&page).keep(None), None);
    let mut device = Device::new(&page);
    assert_eq!(device.calibrated, Some(Calibrated::BuiltIn));
    device.rig.press_until_it_runs();
}

#[test]
fn an_order_of_the_same_number_answers_for_no_calibration_nor_the_other_way_round() {
    let page = Page::erased();
    let mut device = Device::set_up(&page);
    let order = |device: &mut Device| {
        device.send(&HostMessage::Command {
            number: device.number + 1,
            command: palpate::scene::Command::Choose { index: 0 },
        });
        device.tick();
        device.answer.take().expect("an answer")
    };
    assert_eq!(order(&mut device), Answer { number: 1, refused: Some(Refused::SetUp) });
    // The number of that order.
    assert_eq!(device.keep(Some(joints())), None);
    assert_eq!(found(&page), Calibrated::Kept { crc: Calibration(joints()).crc() });
    // And one that comes again is answered as before, and not done again.
    device.number -= 1;
    page.0.bytes.borrow_mut()[20] ^= 4;
    assert_eq!(device.keep(Some(joints())), None);
    assert_eq!(found(&page), Calibrated::Refused(CalibrationError::Damaged));
    device.number -= 1;
    assert_eq!(order(&mut device), Answer { number: 1, refused: Some(Refused::SetUp) });
}

#[test]
fn words_that_a_chip_could_not_read_are_a_calibration_that_cannot_be_used_though_they_read_as_erased() {
    let (kept, found) = Kept::find(Page::erased(), BUILT);
    assert_eq!((kept.in_use(), found.is_miscalibrated), (Calibrated::BuiltIn, false));
    let (kept, found) = kept.damaged();
    assert_eq!((kept.in_use(), found.is_miscalibrated), (Calibrated::Refused(CalibrationError::Damaged), true));
    // Another one is kept in its place.
    assert_eq!(kept.keep(Some(&joints())), Ok(()));
}

#[test]
fn a_loop_that_is_calibrated_is_the_loop_of_that_device_bit_for_bit() {
    let device: &'static _ = Box::leak(Box::new(DEVICE.calibrated(&Calibration(joints())).unwrap()));
    let built = Servo::new(&DEVICE, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    let rebuilt = Servo::new(device, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    assert_ne!(format!("{built:?}"), format!("{rebuilt:?}"));
    assert_eq!(format!("{:?}", built.calibrated(device)), format!("{rebuilt:?}"));
}

#[test]
fn flash_is_written_thirty_two_times_between_two_resets_and_no_more() {
    let page = Page::erased();
    let mut device = Device::set_up(&page);
    for write in 0..32 {
        assert_eq!(device.keep(Some(joints())), None, "{write}");
    }
    assert_eq!(device.keep(None), refused(KeepError::Worn));
    assert_eq!(found(&page), Calibrated::Kept { crc: Calibration(joints()).crc() });
    // After a reset again.
    assert_eq!(Device::set_up(&page).keep(None), None);
}

#[test]
fn nothing_is_written_while_a_motor_may_move_or_by_a_device_that_is_not_set_up() {
    let page = Page::erased();
    // Not set up: quiet, or giving force.
    let mut device = Device::new(&page);
    assert_eq!(device.keep(Some(joints())), refused(KeepError::NotSetUp));
    device.rig.press_until_it_runs();
    assert_eq!(device.keep(Some(joints())), refused(KeepError::Driven));
    assert_eq!(device.rig.state().phase(), Phase::Running);
    // Set up: enable held, key held.
    let mut device = Device::set_up(&page);
    device.rig.set(|world| world.button = true);
    device.ticks_off(10);
    assert_eq!(device.keep(Some(joints())), refused(KeepError::Driven));
    device.hold_key(400);
    assert!(!device.rig.is_off(), "the key does move it");
    assert_eq!(device.keep(None), refused(KeepError::Driven));
    assert!(!device.rig.is_off());
    assert_eq!(page.0.erased.get(), 0);
    // Let go: kept, and with the key still held nothing moves until the button was released.
    device.rig.set(|world| world.button = false);
    device.ticks_off(150);
    assert_eq!(device.keep(Some(joints())), None);
    assert!(device.rig.is_off());
    assert_eq!(page.0.erased.get(), 1);
    // Bodies are not for a device that is being set up.
    device.send(&HostMessage::Upload { number: 900, part: Upload::Keep { bytes: 64 } });
    device.tick();
    assert!(device.answer.is_some_and(|answer| answer.refused.is_some()));
}

#[test]
fn a_host_says_hello_first_and_a_number_that_comes_again_is_not_written_again() {
    let page = Page::erased();
    let mut stranger = Device::start(&page, ResetReason::PowerOn);
    stranger.ticks(150);
    assert_eq!(stranger.keep(Some(joints())), Some(Refused::Hello));
    let mut device = Device::set_up(&page);
    assert_eq!(device.keep(Some(joints())), None);
    for _ in 0..3 {
        device.answer = None;
        device.send(&HostMessage::Calibrate { number: device.number, joints: Some(joints()) });
        device.tick();
        assert_eq!(device.answer, Some(Answer { number: device.number, refused: None }));
    }
    assert_eq!(page.0.erased.get(), 1);
    // A device without flash for it says so, and nothing of calibrations otherwise.
    let mut plain = Device::start(&page, ResetReason::PowerOn);
    let servo = Servo::new(&DEVICE, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    plain.rig = Rig::new(servo, held_at([0.0, 0.0, 0.02]), &settings(), ResetReason::PowerOn);
    plain.idle = Idle::new(plain.rig.mailbox, plain.rig.take_records(), Heartbeat::default());
    plain.send(&HostMessage::Hello { protocol: PROTOCOL });
    plain.ticks(10);
    assert_eq!((plain.keep(Some(joints())), plain.calibrated), (refused(KeepError::NoFlash), None));
}

#[test]
fn what_cannot_be_this_device_is_refused_by_its_joint_and_what_is_kept_stays() {
    let page = Page::erased();
    let mut device = Device::set_up(&page);
    assert_eq!(device.keep(Some(joints())), None);
    let before = *page.0.bytes.borrow();
    let wrong: [(Spoil, CalibrationError); 7] = [
        (|joints| joints[2].zero_of = ZeroOf::Pose, CalibrationError::ZeroOf { joint: 2 }),
        (|joints| joints[2].radians_per_count *= 8.0, CalibrationError::Encoder { joint: 2 }),
        (|joints| joints[1].torque_at_full_n_m *= 0.6, CalibrationError::Force { joint: 1 }),
        (|joints| joints[2].radians_per_count *= 2.0, CalibrationError::Stiffness),
        (|joints| joints[0].torque_at_full_n_m = f32::NAN, CalibrationError::NotFinite { joint: 0 }),
        (|joints| joints[1].torque_at_full_n_m *= 0.3, CalibrationError::Torque { joint: 1 }),
        (|joints| joints[1].output = 2, CalibrationError::Channels),
    ];
    for (change, error) in wrong {
        let mut joints = joints();
        change(&mut joints);
        assert_eq!(device.keep(Some(joints)), refused(KeepError::Calibration(error)));
    }
    assert_eq!((*page.0.bytes.borrow(), page.0.erased.get()), (before, 1));
}

#[test]
fn whenever_the_power_goes_there_is_the_whole_calibration_or_none() {
    let old = Page::erased();
    assert_eq!(Kept::find(old.clone(), BUILT).0.keep(Some(&joints())), Ok(()));
    let kept = Calibrated::Kept { crc: Calibration(joints()).crc() };
    let mut other = joints();
    other[0].dry_friction_n_m = 0.03;
    let rebuilt = Calibrated::Kept { crc: Calibration(other).crc() };
    // One erasure, and eight double words.
    for left in 0..=9 {
        let page = Page::of(*old.0.bytes.borrow());
        let mut device = Device::set_up(&page);
        page.0.left.set(left);
        let said = device.keep(Some(other));
        assert_eq!(said, if left == 9 { None } else { refused(KeepError::Flash) }, "{left}");
        let wanted = match left {
            0 => kept,
            1 => Calibrated::BuiltIn,
            9 => rebuilt,
            _ => Calibrated::Refused(CalibrationError::Interrupted),
        };
        page.0.left.set(u32::MAX);
        assert_eq!(found(&page), wanted, "the power goes after {left}");
        // The motors of one that was being written stay off; kept again, it is as new.
        let device = Device::new(&page);
        assert_eq!(device.rig.fault(), matches!(wanted, Calibrated::Refused(_)).then_some(Fault::Calibration));
        assert_eq!(Device::set_up(&page).keep(Some(other)), None);
        assert_eq!(found(&page), rebuilt);
    }
}

#[test]
fn any_bit_that_flips_is_found_and_keeps_the_motors_off_whatever_is_pressed_or_said() {
    let good = Page::erased();
    assert_eq!(Kept::find(good.clone(), BUILT).0.keep(Some(&joints())), Ok(()));
    for bit in 0..64 * 8 {
        let page = Page::of(*good.0.bytes.borrow());
        page.0.bytes.borrow_mut()[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(found(&page), Calibrated::Refused(CalibrationError::Damaged), "bit {bit}");
    }
    let page = Page::of(*good.0.bytes.borrow());
    page.0.bytes.borrow_mut()[20] ^= 4;
    for reset in ResetReason::ALL {
        let mut device = Device::start(&page, reset);
        device.send(&HostMessage::Hello { protocol: PROTOCOL });
        device.ticks_off(250);
        assert_eq!(device.calibrated, Some(Calibrated::Refused(CalibrationError::Damaged)));
        // A reset that is a fault comes first, and is acknowledged: it is a fault still.
        let by_hand = |device: &mut Device| {
            for stop in [true, false] {
                device.rig.set(|world| world.stop_open = stop);
                device.ticks_off(210);
            }
        };
        by_hand(&mut device);
        device.send(&HostMessage::Acknowledge);
        device.ticks_off(10);
        assert_eq!(device.rig.fault(), Some(Fault::Calibration), "{reset:?}");
        // It does not damp either, for nobody knows which way.
        device.rig.set(|world| world.button = true);
        device.ticks_off(1_000);
        for _ in 0..3 {
            device.rig.set(|world| world.button = false);
            device.send(&HostMessage::Acknowledge);
            device.send(&HostMessage::Alive);
            device.ticks_off(10);
            device.rig.set(|world| world.button = true);
            device.ticks_off(400);
        }
        by_hand(&mut device);
        assert_eq!(device.rig.fault(), Some(Fault::Calibration));
        // The way out.
        device.rig.set(|world| world.button = false);
        device.ticks_off(150);
        device.send(&HostMessage::SetUp);
        device.ticks_off(10);
        device.confirm();
        let page = page.clone();
        assert!(device.reading.is_some(), "{reset:?}");
        let before = *page.0.bytes.borrow();
        assert_eq!(device.keep(Some(joints())), None);
        Device::new(&page).rig.press_until_it_runs();
        *page.0.bytes.borrow_mut() = before;
    }
}

#[test]
fn a_record_of_another_device_is_refused_by_name() {
    let arm = Calibration([joints()[0]; 2]);
    let page = Page::erased();
    for (place, word) in page.0.bytes.borrow_mut().chunks_mut(4).zip(arm.to_words()) {
        place.copy_from_slice(&word.to_le_bytes());
    }
    assert_eq!(found(&page), Calibrated::Refused(CalibrationError::Joints { joints: 2 }));
    // Of this very arm, homed by its marks before and by a pose with the firmware of now.
    let page = Page::erased();
    let of_marks = joints().map(|joint| JointCalibration { zero_of: ZeroOf::Mark, ..joint });
    assert_eq!(
        Kept::find(page.clone(), Built { homed_by: Some(ZeroOf::Mark), ..BUILT }).0.keep(Some(&of_marks)),
        Ok(())
    );
    let (kept, found) = Kept::find(page, Built { homed_by: Some(ZeroOf::Pose), ..BUILT });
    assert_eq!(kept.in_use(), Calibrated::Refused(CalibrationError::ZeroOf { joint: 0 }));
    assert!(found.is_miscalibrated && found.device.encoders == DEVICE.encoders);
    // Whole and finite, and of an arm whose encoders are not these.
    static COARSE: ArmDevice<SerialArm, 3> =
        ArmDevice { encoders: [Encoder::geared(100.0, 1.0, 0.0); 3], ..WOODEN_HAPTICS_2016 };
    let page = Page::erased();
    assert_eq!(Kept::find(page.clone(), BUILT).0.keep(Some(&joints())), Ok(()));
    let (kept, found) = Kept::find(page, Built { device: &COARSE, ..BUILT });
    assert_eq!(kept.in_use(), Calibrated::Refused(CalibrationError::Encoder { joint: 0 }));
    assert!(found.is_miscalibrated && found.device.encoders == COARSE.encoders);
}

#[test]
fn no_fuzzed_calibration_moves_a_motor_or_leaves_half_a_record() {
    const COMMANDS: u32 = 20_000;
    let page = Page::erased();
    let mut device = Device::set_up(&page);
    let mut random = Pcg64::seed_from_u64(7);
    let (mut taken, mut refused) = (0, 0);
    for command in 0..COMMANDS {
        let draw = random.next_u64();
        let mut joints = joints();
        for _ in 0..draw & 3 {
            let [which, bits] = [random.next_u64(), random.next_u64()];
            let joint = &mut joints[(which % 3) as usize];
            let number = f32::from_bits(bits as u32 & u32::MAX << (bits >> 32 & 31));
            match which >> 2 & 7 {
                0 => joint.radians_per_count = number,
                1 => joint.radians_per_count = -joint.radians_per_count,
                2 => joint.angle_at_zero_rad = number,
                3 => joint.torque_at_full_n_m = number,
                4 => joint.dry_friction_n_m = number,
                5 => joint.input = bits as u8 & 3,
                6 => joint.output = bits as u8,
                _ => joint.angle_at_zero_rad += (bits % 7) as f32 - 3.0,
            }
        }
        let joints = (draw & 60 != 0).then_some(joints);
        if command % 300 == 0 {
            device.rig.set(|world| world.button = draw & 128 != 0);
        }
        let number = if draw & 0x300 == 0 { device.number } else { device.number.wrapping_add(1) };
        device.number = number;
        device.answer = None;
        device.send(&HostMessage::Calibrate { number, joints });
        if draw & 0x400 != 0 {
            // Bytes of nobody in between.
            device.wire.to_device.extend(random.next_u64().to_le_bytes());
            device.wire.to_device.push_back(0);
        }
        device.tick();
        assert!(device.rig.is_off(), "command {command}");
        match device.answer.map(|answer| answer.refused) {
            Some(None) => taken += 1,
            _ => refused += 1,
        }
        assert!(!matches!(found(&page), Calibrated::Refused(_)), "command {command}");
    }
    println!("{taken} taken, {refused} refused or still on their way");
    assert_eq!(taken, 0, "nobody has confirmed one");
    assert!(refused > 1_000);
    device.confirm();
    // The key works as before: the device is none the worse.
    device.rig.set(|world| world.button = false);
    device.ticks_off(150);
    device.rig.set(|world| world.button = true);
    device.ticks_off(10);
    device.hold_key(400);
    assert!(!device.rig.is_off());
    assert_eq!(device.reading.map(|reading| reading.hold & hold::WRITING), Some(0));
}
