//! Flash: written while the motors are held off, and what lies there after whatever happened.

use crate::orders::parts;
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use palpate::body::FileError;
use palpate::device::SerialArm;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::scene::BodyStore as _;
use palpate::servo::{Config, Fault, Heartbeat, Phase, ResetReason, SafeOutput, Safety, Servo};
use palpate::wire::frame::{MAX_FRAME, Received, Receiver, pack};
use palpate::wire::{Answer, CHUNK, DeviceMessage, HostMessage, PROTOCOL, Refused, Upload, UploadError, hold};
use palpate_bench::store::{Bodies, Both, Kept, Pretended, PretendedFlash};
use palpate_bench::{Idle, Uploads, Watchdog};
use palpate_sim::rig::{Rig, SETTINGS, WALL, held_at, settings};
use palpate_sim::simulated::{NoWatchdog, Wire};
use std::cell::{Cell, RefCell};
use std::path::Path;

const WORDS: usize = 8_192;
type Flash = PretendedFlash<WORDS>;

fn kept_for_good<T>(what: T) -> &'static T {
    Box::leak(Box::new(what))
}

fn file(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../boards/bodies").join(name)).unwrap()
}

/// Memory that takes everything, and notes it.
#[derive(Default)]
struct Takes {
    came: RefCell<Vec<Upload>>,
    refuses: Cell<Option<UploadError>>,
}

impl Uploads for Takes {
    fn room(&self) -> (u32, u16, u16) {
        (1_024, 8, 16)
    }

    fn put(&self, part: &Upload, _: &mut dyn FnMut()) -> Result<(), UploadError> {
        self.came.borrow_mut().push(*part);
        self.refuses.get().map_or(Ok(()), Err)
    }
}

/// A device whose flash takes everything.
struct Device {
    rig: Rig<SerialArm>,
    idle: Idle<'static>,
    memory: &'static Takes,
    flash: &'static Takes,
    wire: Wire,
    receiver: Receiver<DeviceMessage>,
    number: u16,
    answer: Option<Answer>,
}

impl Device {
    fn new(safety: Safety) -> Self {
        let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT });
        let mut rig = Rig::new(servo, held_at([0.0, 0.0, -0.004]), &settings(), ResetReason::PowerOn);
        let [memory, flash] = [Takes::default(), Takes::default()].map(kept_for_good);
        let idle = Idle::new(rig.mailbox, rig.take_records(), Heartbeat::default()).taking(memory).keeping(flash);
        let (wire, receiver) = (Wire::default(), Receiver::new());
        Self { rig, idle, memory, flash, wire, receiver, number: 0, answer: None }
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
            if let Some(Received::Message(DeviceMessage::Answer(answer))) = self.receiver.feed(byte) {
                self.answer = Some(answer);
            }
        }
    }

    fn tick(&mut self) {
        self.rig.tick();
        self.below();
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

    /// Greeted, with its button released for long enough.
    fn hello(&mut self) {
        self.send(&HostMessage::Hello { protocol: PROTOCOL });
        (0..150).for_each(|_| self.tick());
    }

    /// Its answer, once a tick has gone by.
    fn part(&mut self, part: Upload) -> Option<Refused> {
        (self.number, self.answer) = (self.number + 1, None);
        self.send(&HostMessage::Upload { number: self.number, part });
        if matches!(part, Upload::Keep { .. }) {
            self.tick();
            if self.answer.is_none() {
                self.confirm();
            }
        }
        let answer = self.answer.expect("an answer");
        assert_eq!(answer.number, self.number);
        answer.refused
    }

    /// What the view after some ticks says holds.
    fn holds(&mut self) -> u8 {
        let mut hold = None;
        for _ in 0..4 {
            self.rig.tick();
            for _ in 0..4 * MAX_FRAME {
                self.idle.step(&mut self.wire, &mut NoWatchdog);
            }
            for byte in self.wire.from_device.drain(..) {
                if let Some(Received::Message(DeviceMessage::View(view))) = self.receiver.feed(byte) {
                    hold = Some(view.hold);
                }
            }
        }
        hold.expect("a view")
    }
}

const KEEP: Upload = Upload::Keep { bytes: 100 };
const PART: Upload = Upload::Bytes { at: 0, bytes: [[0; 16]; CHUNK / 16] };

fn refused(error: UploadError) -> Option<Refused> {
    Some(Refused::Upload(error))
}

#[test]
fn flash_is_not_touched_while_motors_are_driven_or_enable_is_held() {
    let mut device = Device::new(Safety { output: SafeOutput::Damping(1.0), ..Safety::DEFAULT });
    device.hello();
    device.rig.press_until_it_runs();
    assert_eq!(device.part(KEEP), refused(UploadError::Driven));
    assert_eq!(device.rig.state().phase(), Phase::Running);
    // Held, but not driven: somebody is about to be.
    device.rig.set(|world| world.stop_open = true);
    device.tick();
    assert!(device.rig.is_off());
    assert_eq!(device.part(KEEP), refused(UploadError::Driven));
    // A fault that is damped is driven too.
    device.rig.set(|world| world.stop_open = false);
    device.rig.press_until_it_runs();
    device.send(&HostMessage::Stop);
    device.tick();
    device.rig.set(|world| world.button = false);
    device.tick();
    assert_eq!(device.rig.fault(), Some(Fault::Stopped));
    assert!(!device.rig.is_off(), "it damps");
    assert_eq!(device.part(KEEP), refused(UploadError::Driven));
    assert_eq!(*device.flash.came.borrow(), []);
    assert_eq!(device.part(PART), None, "to memory, as before");
    assert_eq!(*device.memory.came.borrow(), [PART]);
}

#[test]
fn no_motor_is_driven_from_the_first_word_to_the_last_and_then_only_by_a_new_press() {
    let mut device = Device::new(Safety::DEFAULT);
    device.hello();
    assert_eq!(device.part(KEEP), None);
    assert_eq!(device.holds(), hold::WRITING | hold::RELEASE_FIRST);
    device.rig.set(|world| world.button = true);
    device.ticks_off(100);
    assert_eq!(device.part(PART), None);
    device.ticks_off(100);
    assert_eq!(device.part(Upload::End), None);
    assert_eq!(*device.flash.came.borrow(), [Upload::Begin { bytes: 100 }, PART, Upload::End]);
    // Another body that was uploaded and not taken is not taken in its place.
    assert_eq!(*device.memory.came.borrow(), [Upload::Begin { bytes: 0 }]);
    device.ticks_off(1_000);
    device.rig.press_until_it_runs();
    // The last word again, for its answer was lost; a part that is late is not for flash any more.
    assert_eq!(device.part(Upload::End), None);
    assert_eq!(device.part(PART), refused(UploadError::NotBegun));
    assert_eq!(device.rig.state().phase(), Phase::Running);
}

#[test]
fn a_tick_that_waits_for_flash_while_it_is_written_does_not_begin_late() {
    // 25 ms, as long as a page takes: before the last word, and with it.
    let erase = |device: &Device| device.rig.set(|world| world.cycles = world.cycles.wrapping_add(4_250_000));
    let mut device = Device::new(Safety::DEFAULT);
    device.hello();
    assert_eq!(device.part(KEEP), None);
    device.ticks_off(10);
    erase(&device);
    device.ticks_off(10);
    assert_eq!(device.part(Upload::End), None);
    erase(&device);
    device.ticks_off(10);
    assert_eq!(device.rig.fault(), None);
    erase(&device);
    device.ticks_off(1);
    assert_eq!(device.rig.fault(), Some(Fault::Overrun), "nothing is written any more");
}

#[test]
fn what_ends_badly_or_is_left_lets_go() {
    for end in 0..4 {
        let mut device = Device::new(Safety::DEFAULT);
        device.hello();
        if end == 0 {
            device.flash.refuses.set(Some(UploadError::Felt));
            assert_eq!(device.part(KEEP), refused(UploadError::Felt));
        } else {
            assert_eq!(device.part(KEEP), None);
        }
        if end == 1 {
            device.flash.refuses.set(Some(UploadError::NoBody));
            assert_eq!(device.part(Upload::End), refused(UploadError::NoBody));
        }
        if end == 2 {
            assert_eq!(device.part(Upload::Begin { bytes: 4 }), None);
        }
        if end == 3 {
            device.flash.refuses.set(Some(UploadError::Order { at: 64 }));
            assert_eq!(device.part(Upload::End), refused(UploadError::Order { at: 64 }));
            // It goes on; but nobody does.
            device.rig.set(|world| world.button = true);
            device.ticks_off(20_000);
            device.rig.set(|world| world.button = false);
            device.ticks_off(150);
            assert_eq!(device.part(PART), refused(UploadError::NotBegun));
        }
        device.rig.press_until_it_runs();
    }
}

#[test]
fn an_end_that_failed_writes_nothing_when_it_is_said_again_later() {
    let mut device = Device::new(Safety::DEFAULT);
    device.hello();
    assert_eq!(device.part(KEEP), None);
    device.flash.refuses.set(Some(UploadError::NoBody));
    assert_eq!(device.part(Upload::End), refused(UploadError::NoBody));
    device.rig.press_until_it_runs();
    device.flash.came.borrow_mut().clear();
    device.flash.refuses.set(None);
    // Its answer was lost, or somebody says it hours later: the same answer, and flash is not touched.
    assert_eq!(device.part(Upload::End), refused(UploadError::NoBody));
    assert_eq!(*device.flash.came.borrow(), []);
    assert_eq!(device.rig.state().phase(), Phase::Running);
}

#[test]
fn a_device_is_not_set_up_while_flash_is_written() {
    let mut device = Device::new(Safety::DEFAULT);
    device.hello();
    assert_eq!(device.part(KEEP), None);
    device.send(&HostMessage::SetUp);
    device.ticks_off(10);
    assert_eq!(device.rig.fault(), None, "being set up stops the servo for good");
    assert_eq!(device.part(Upload::End), None);
    device.rig.press_until_it_runs();
}

#[test]
fn a_device_that_is_set_up_writes_no_flash() {
    let mut device = Device::new(Safety::DEFAULT);
    device.hello();
    device.send(&HostMessage::SetUp);
    device.tick();
    device.confirm();
    assert_eq!(device.part(KEEP), refused(UploadError::Driven));
    assert_eq!(*device.flash.came.borrow(), []);
}

#[test]
fn a_loop_that_watches_its_link_waits_for_its_host_and_then_misses_it() {
    let mut device = Device::new(Safety { link_timeout_s: 0.05, ..Safety::DEFAULT });
    device.ticks_off(10);
    device.rig.set(|world| world.button = true);
    // Nobody was lost that was never there.
    device.ticks_off(1_000);
    assert_eq!(device.rig.fault(), None);
    // A press from before asks for nothing now.
    device.hello();
    for _ in 0..10 {
        device.send(&HostMessage::Alive);
        device.ticks_off(100);
    }
    device.send(&HostMessage::Alive);
    device.rig.set(|world| world.button = false);
    device.ticks_off(150);
    device.rig.set(|world| world.button = true);
    for _ in 0..8 {
        device.send(&HostMessage::Alive);
        (0..100).for_each(|_| device.tick());
    }
    assert_eq!(device.rig.state().phase(), Phase::Running);
    (0..201).for_each(|_| device.tick());
    assert_eq!(device.rig.fault(), Some(Fault::LinkLost));
    assert!(device.rig.is_off());
}

/// Memory whose check takes ticks.
struct Slow(RefCell<Rig<SerialArm>>, Cell<bool>);

impl Uploads for Slow {
    fn room(&self) -> (u32, u16, u16) {
        (1_024, 8, 16)
    }

    fn put(&self, _: &Upload, pause: &mut dyn FnMut()) -> Result<(), UploadError> {
        for _ in 0..3 {
            if self.1.get() {
                self.0.borrow_mut().ticks(40);
            }
            pause();
        }
        Ok(())
    }
}

#[derive(Default)]
struct Counted(u32);

impl Watchdog for Counted {
    fn feed(&mut self) {
        self.0 += 1;
    }
}

#[test]
fn the_watchdog_is_fed_through_a_long_check_as_long_as_ticks_go_on() {
    for goes_on in [true, false] {
        let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
        let mut rig = Rig::new(servo, held_at([0.0; 3]), &settings(), ResetReason::PowerOn);
        let (mailbox, records) = (rig.mailbox, rig.take_records());
        let slow = Slow(RefCell::new(rig), Cell::new(goes_on));
        let mut idle = Idle::new(mailbox, records, Heartbeat::default()).taking(&slow);
        let (mut wire, mut watchdog) = (Wire::default(), Counted::default());
        let mut buffer = [0; MAX_FRAME];
        for command in [HostMessage::Hello { protocol: PROTOCOL }, HostMessage::Upload { number: 1, part: Upload::End }]
        {
            wire.to_device.extend(pack(&command, &mut buffer).unwrap());
        }
        for _ in 0..4 * MAX_FRAME {
            idle.step(&mut wire, &mut watchdog);
        }
        assert_eq!(watchdog.0, if goes_on { 3 } else { 0 });
    }
}

/// Puts a file, up to so many of its parts.
fn put(flash: &impl Uploads, file: &[u8], most: usize) -> Result<(), UploadError> {
    parts(file).iter().take(most).try_for_each(|part| flash.put(part, &mut || ()))
}

fn crc(file: &[u8]) -> u32 {
    u32::from_le_bytes(*file.last_chunk().unwrap())
}

#[test]
fn whenever_the_power_goes_there_is_the_whole_body_or_none() {
    let [capped_box, sphere] = ["capped_box.palp", "sphere_body.palp"].map(file);
    let flash: &'static Flash = kept_for_good(Flash::new());
    let kept: &'static Kept<8, 16> = kept_for_good(Kept::new(flash.region()));
    let (keeping, found) = kept.main(flash.writer().unwrap(), &mut || ()).unwrap();
    assert_eq!((found, keeping.kept(), kept.take()), (Err(FileError::Magic), 0, None));
    assert!(flash.writer().is_none() && kept.main(Broken::default(), &mut || ()).is_none(), "one main");
    put(&keeping, &sphere, usize::MAX).unwrap();
    let mut flash = flash;
    let all = parts(&capped_box).len();
    for parts in 0..=all {
        let written: &'static Flash = kept_for_good(flash.after_reset());
        let kept: &'static Kept<8, 16> = kept_for_good(Kept::new(written.region()));
        let (keeping, found) = kept.main(written.writer().unwrap(), &mut || ()).unwrap();
        assert_eq!((found, keeping.kept()), (Ok(()), crc(&sphere)));
        put(&keeping, &capped_box, parts).unwrap();

        let left: &'static Flash = kept_for_good(written.after_reset());
        let after: &'static Kept<8, 16> = kept_for_good(Kept::new(left.region()));
        let (keeping, found) = after.main(left.writer().unwrap(), &mut || ()).unwrap();
        let is_there = found.is_ok();
        // The first part erases; with the last the body is there.
        let wanted = if parts == 0 {
            crc(&sphere)
        } else if parts == all {
            crc(&capped_box)
        } else {
            0
        };
        assert_eq!((keeping.kept(), after.take().is_some()), (wanted, is_there), "{parts} parts");
        assert_eq!(is_there, wanted != 0);
    }
    // Forgotten.
    let last: &'static Flash = kept_for_good(flash.after_reset());
    flash = last;
    let kept: &'static Kept<8, 16> = kept_for_good(Kept::new(flash.region()));
    let (keeping, _) = kept.main(flash.writer().unwrap(), &mut || ()).unwrap();
    assert_eq!(kept.take(), Some(0));
    assert_eq!(keeping.put(&Upload::Begin { bytes: 0 }, &mut || ()), Err(UploadError::Felt));
    // Left, and taken again, for it is there still.
    kept.leave(0);
    assert_eq!((kept.body(0).is_none(), kept.take()), (true, Some(0)));
    kept.leave(0);
    keeping.put(&Upload::Begin { bytes: 0 }, &mut || ()).unwrap();
    assert_eq!(keeping.put(&Upload::End, &mut || ()), Err(UploadError::NotBegun));
    let left: &'static Flash = kept_for_good(flash.after_reset());
    let kept: &'static Kept<8, 16> = kept_for_good(Kept::new(left.region()));
    assert_eq!(kept.main(left.writer().unwrap(), &mut || ()).unwrap().1, Err(FileError::Magic));
}

#[test]
fn two_memories_of_one_slot_are_told_apart() {
    static BODIES: Bodies<8_192, 8, 16> = Bodies::new();
    static FLASH: Flash = Flash::new();
    static KEPT: Kept<8, 16> = Kept::new(FLASH.region());
    static BOTH: Both<'static, Bodies<8_192, 8, 16>, Kept<8, 16>> = Both(&BODIES, &KEPT);
    let [capped_box, sphere] = ["capped_box.palp", "sphere_body.palp"].map(file);
    let (keeping, _) = KEPT.main(FLASH.writer().unwrap(), &mut || ()).unwrap();
    let memory = BODIES.main().unwrap();
    put(&keeping, &sphere, usize::MAX).unwrap();
    put(&memory, &capped_box, usize::MAX).unwrap();
    let faces = |bank| BOTH.body(bank).map(|body| (body.faces().len(), body.edges().len()));
    let first = BOTH.take().unwrap();
    let second = BOTH.take().unwrap();
    assert_eq!(BOTH.take(), None);
    assert_eq!(faces(first), KEPT.body(0).map(|_| (6, 12)), "the capped box");
    assert_ne!(first, second);
    let size = |bank| BOTH.body(bank).map(|body| body.table_crc());
    assert_ne!(size(first), size(second));
    BOTH.leave(first);
    assert_eq!((faces(first), faces(second).is_some()), (None, true));
    BOTH.leave(second);
    assert_eq!(faces(second), None);
}

/// Flash with the rules of the other, which breaks after so many words are written or pages erased.
#[derive(Default)]
struct Broken {
    within: Option<Pretended<WORDS>>,
    left: Cell<u32>,
    /// Whether it says so, or says that it wrote and did not.
    is_silent: bool,
}

#[derive(Clone, Copy, Debug)]
struct Worn;

impl NorFlashError for Worn {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl ErrorType for Broken {
    type Error = Worn;
}

impl ReadNorFlash for Broken {
    const READ_SIZE: usize = 4;

    fn read(&mut self, _: u32, _: &mut [u8]) -> Result<(), Worn> {
        Err(Worn)
    }

    fn capacity(&self) -> usize {
        WORDS * 4
    }
}

impl NorFlash for Broken {
    const WRITE_SIZE: usize = 8;
    const ERASE_SIZE: usize = 2_048;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Worn> {
        self.breaks()?.erase(from, to).map_err(|_| Worn)
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Worn> {
        if self.left.get() == 0 && self.is_silent {
            return Ok(());
        }
        self.breaks()?.write(offset, bytes).map_err(|_| Worn)
    }
}

impl Broken {
    fn breaks(&mut self) -> Result<&mut Pretended<WORDS>, Worn> {
        self.left.set(self.left.get().checked_sub(1).ok_or(Worn)?);
        self.within.as_mut().ok_or(Worn)
    }
}

#[test]
fn flash_that_does_not_take_it_is_said_with_the_place() {
    let capped_box = file("capped_box.palp");
    // Nothing at all; the first page erased; two parts more; the second page, after the 31 parts that follow the head;
    // the head itself, after all other parts and the pages.
    let head = (capped_box.len().div_ceil(64) - 1 + capped_box.len().div_ceil(2_048)) as u32;
    let breaks = [(0, 0, false), (1, 64, false), (3, 192, false), (32, 2_048, false), (3, 192, true), (head, 0, false)];
    for (left, at, is_silent) in breaks {
        let flash: &'static Flash = kept_for_good(Flash::new());
        let kept: &'static Kept<8, 16> = kept_for_good(Kept::new(flash.region()));
        let broken = Broken { within: flash.writer(), left: Cell::new(left), is_silent };
        let (keeping, _) = kept.main(broken, &mut || ()).unwrap();
        assert_eq!(put(&keeping, &capped_box, usize::MAX), Err(UploadError::Flash { at }), "{left}");
        assert_eq!((keeping.kept(), kept.take()), (0, None));
    }
    let flash: &'static Flash = kept_for_good(Flash::new());
    let kept: &'static Kept<8, 16> = kept_for_good(Kept::new(flash.region()));
    let (keeping, _) = kept.main(flash.writer().unwrap(), &mut || ()).unwrap();
    assert_eq!(keeping.room(), (32_768, 8, 16));
    assert_eq!(keeping.put(&Upload::Begin { bytes: 32_769 }, &mut || ()), Err(UploadError::TooLong { room: 32_768 }));
    assert_eq!(keeping.put(&PART, &mut || ()), Err(UploadError::NotBegun));
    // A part that comes twice is compared, for it cannot be written twice.
    let parts = parts(&capped_box);
    for part in &parts[..3] {
        keeping.put(part, &mut || ()).unwrap();
        keeping.put(part, &mut || ()).unwrap();
    }
    let Upload::Bytes { at, mut bytes } = parts[2] else { panic!("a part") };
    bytes[0][0] ^= 1;
    assert_eq!(keeping.put(&Upload::Bytes { at, bytes }, &mut || ()), Err(UploadError::Flash { at: 64 }));
    // What is no body is not found at the next start either, and its end is over.
    assert_eq!(put(&keeping, &spoiled(&capped_box), usize::MAX), Err(UploadError::NoBody));
    assert_eq!(keeping.put(&Upload::End, &mut || ()), Err(UploadError::NotBegun));
    let left: &'static Flash = kept_for_good(flash.after_reset());
    let kept: &'static Kept<8, 16> = kept_for_good(Kept::new(left.region()));
    assert_eq!(kept.main(left.writer().unwrap(), &mut || ()).unwrap().1, Err(FileError::Magic));
}

fn spoiled(file: &[u8]) -> Vec<u8> {
    let mut file = file.to_vec();
    file[3_000] ^= 1;
    file
}
