//! A host's orders on their way through main and the tick, and bodies in parts.

use palpate::device::SerialArm;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::scene::{BodyStore as _, Command, SceneError};
use palpate::servo::{Config, Heartbeat, ResetReason, Servo};
use palpate::wire::frame::{MAX_FRAME, Received, Receiver, pack};
use palpate::wire::{Answer, CHUNK, DeviceMessage, HostMessage, PROTOCOL, Refused, Upload, UploadError};
use palpate_bench::store::Bodies;
use palpate_bench::{Idle, Uploads as _};
use palpate_sim::rig::{Rig, SETTINGS, WALL, held_at, settings};
use palpate_sim::simulated::{NoWatchdog, Wire};

/// A device that feels a wall: nothing that can be ordered.
struct Device {
    rig: Rig<SerialArm>,
    idle: Idle<'static>,
    wire: Wire,
    receiver: Receiver<DeviceMessage>,
    answers: Vec<Answer>,
}

impl Device {
    fn new() -> Self {
        let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
        let mut rig = Rig::new(servo, held_at([0.0, 0.0, 0.02]), &settings(), ResetReason::PowerOn);
        let idle = Idle::new(rig.mailbox, rig.take_records(), Heartbeat::default());
        Self { rig, idle, wire: Wire::default(), receiver: Receiver::new(), answers: Vec::new() }
    }

    fn send(&mut self, command: &HostMessage) {
        let mut buffer = [0; MAX_FRAME];
        self.wire.to_device.extend(pack(command, &mut buffer).unwrap());
        self.idle();
    }

    fn idle(&mut self) {
        for _ in 0..4 * MAX_FRAME {
            self.idle.step(&mut self.wire, &mut NoWatchdog);
        }
        for byte in self.wire.from_device.drain(..) {
            if let Some(Received::Message(DeviceMessage::Answer(answer))) = self.receiver.feed(byte) {
                self.answers.push(answer);
            }
        }
    }

    fn tick(&mut self) {
        self.rig.tick();
        self.idle();
    }

    fn order(&mut self, number: u16) {
        self.send(&HostMessage::Command { number, command: Command::Tip { radius: 0.001 } });
    }
}

#[test]
fn an_order_is_answered_once_the_tick_has_had_it_and_again_where_it_comes_again() {
    let mut device = Device::new();
    let not_offered = Some(Refused::Command(SceneError::NotOffered));
    device.order(1);
    assert_eq!(device.answers, [Answer { number: 1, refused: Some(Refused::Hello) }]);
    // Another version is not understood.
    device.send(&HostMessage::Hello { protocol: PROTOCOL + 1 });
    device.order(2);
    assert_eq!(device.answers[1..], [Answer { number: 2, refused: Some(Refused::Hello) }]);
    device.send(&HostMessage::Hello { protocol: PROTOCOL });
    device.answers.clear();
    device.order(3);
    assert_eq!(device.answers, [], "before the tick has had it");
    // The same on its way already; another one before that is answered.
    device.order(3);
    device.order(4);
    assert_eq!(device.answers, [Answer { number: 4, refused: Some(Refused::Busy) }]);
    device.tick();
    assert_eq!(device.answers[1..], [Answer { number: 3, refused: not_offered }]);
    // Its answer was lost: it is said again, and the tick is not asked.
    device.answers.clear();
    device.order(3);
    assert_eq!(device.answers, [Answer { number: 3, refused: not_offered }]);
    device.order(4);
    device.tick();
    assert_eq!(device.answers[1..], [Answer { number: 4, refused: not_offered }]);
    // Another host counts anew.
    device.send(&HostMessage::Hello { protocol: PROTOCOL });
    device.order(4);
    assert_eq!(device.answers.len(), 2, "a new order");
    // No memory for bodies; nothing is felt of a device that is being set up.
    device.tick();
    device.answers.clear();
    device.send(&HostMessage::Upload { number: 5, part: Upload::Begin { bytes: 4 } });
    assert_eq!(device.answers, [Answer { number: 5, refused: Some(Refused::Upload(UploadError::NoRoom)) }]);
    (0..150).for_each(|_| device.tick());
    device.send(&HostMessage::SetUp);
    for (pressed, ticks) in [(true, 2_100), (false, 150)] {
        device.rig.set(|world| world.button = pressed);
        (0..ticks).for_each(|_| device.tick());
    }
    device.order(6);
    device.tick();
    assert_eq!(device.answers[1..], [Answer { number: 6, refused: Some(Refused::SetUp) }]);
}

static BODIES: Bodies<8_192, 8, 16> = Bodies::new();

/// The parts of a file, as they come.
pub fn parts(file: &[u8]) -> Vec<Upload> {
    let chunk = |at: usize| {
        let mut bytes = [[0; 16]; CHUNK / 16];
        let rest = &file[at..file.len().min(at + CHUNK)];
        bytes.as_flattened_mut()[..rest.len()].copy_from_slice(rest);
        Upload::Bytes { at: at as u32, bytes }
    };
    let begin = Upload::Begin { bytes: file.len() as u32 };
    [begin].into_iter().chain((0..file.len()).step_by(CHUNK).map(chunk)).chain([Upload::End]).collect()
}

#[test]
fn a_body_is_written_beside_the_one_that_is_felt_and_never_over_it() {
    let file = |name: &str| {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../boards/bodies").join(name);
        std::fs::read(path).unwrap()
    };
    let [capped_box, sphere] = ["capped_box.palp", "sphere_body.palp"].map(file);
    let writing = BODIES.main().unwrap();
    assert!(BODIES.main().is_none(), "one main");
    assert_eq!(writing.room(), (32_768, 8, 16));
    let put = |file: &[u8]| {
        parts(file).iter().map(|part| writing.put(part, &mut || ())).find(Result::is_err).unwrap_or(Ok(()))
    };

    assert_eq!(BODIES.take(), None);
    assert_eq!(writing.put(&Upload::End, &mut || ()), Err(UploadError::NotBegun));
    put(&capped_box).unwrap();
    // Said again, for its answer was lost.
    assert_eq!(writing.put(&Upload::End, &mut || ()), Ok(()));
    let first = BODIES.take().unwrap();
    let crc = |bank| BODIES.body(bank).map(|body| (body.faces().len(), body.table_crc()));
    let felt = crc(first).unwrap();
    assert_eq!((felt.0, BODIES.take()), (6, None), "taken once");
    assert_eq!(BODIES.body(1 - first).map(|_| ()), None, "nothing there");

    // Others come, whole and spoiled, while it is felt.
    put(&sphere).unwrap();
    let mut spoiled = sphere.clone();
    spoiled[20_000] ^= 1;
    assert_eq!(put(&spoiled), Err(UploadError::NoBody));
    assert!(writing.is_vacant(1 - first));
    assert_eq!(BODIES.take(), None, "the sphere that nobody took is gone");
    put(&sphere).unwrap();
    assert_eq!(crc(first), Some(felt));
    let second = BODIES.take().unwrap();
    assert_ne!(first, second);
    assert_eq!(crc(first), Some(felt), "until it is left");
    // Both are the tick's.
    assert_eq!(put(&sphere), Err(UploadError::Busy));
    BODIES.leave(first);
    assert_eq!(crc(first), None);
    put(&capped_box).unwrap();
    assert_ne!(crc(second), Some(felt));
    assert_eq!(BODIES.take(), Some(first));

    // Nothing refers to the words of a file any more when the next is written over them.
    BODIES.leave(second);
    assert!(!writing.is_vacant(first), "the tick's");
    assert!(!writing.is_vacant(second), "until something is to come");
    let parts = parts(&sphere);
    writing.put(&parts[0], &mut || ()).unwrap();
    assert!(writing.is_vacant(second));

    // Parts that do not follow, and files that do not fit.
    assert_eq!(writing.put(&parts[2], &mut || ()), Err(UploadError::Order { at: 0 }));
    writing.put(&parts[1], &mut || ()).unwrap();
    writing.put(&parts[1], &mut || ()).unwrap();
    assert_eq!(writing.put(&Upload::End, &mut || ()), Err(UploadError::Order { at: CHUNK as u32 }));
    assert_eq!(
        writing.put(&Upload::Bytes { at: u32::MAX, bytes: [[0; 16]; CHUNK / 16] }, &mut || ()),
        Err(UploadError::Order { at: CHUNK as u32 })
    );
    assert_eq!(writing.put(&Upload::Begin { bytes: 32_769 }, &mut || ()), Err(UploadError::TooLong { room: 32_768 }));
    assert_eq!(writing.put(&Upload::End, &mut || ()), Err(UploadError::NotBegun));
}
