//! A host that speaks with the emulated board: orders at random instants, bytes that are none, a body that comes over
//! the line while another is felt. The simulated device is at the board's pins, the test at its serial port.

use crate::running::is_wanted;
use palpate::scene::{BodyPose, Command};
use palpate::servo::{Fault, Phase};
use palpate::wire::frame::{DELIMITER, MAX_FRAME, Received, Receiver, pack};
use palpate::wire::{
    Answer, CHUNK, DeviceMessage, Hello, HostMessage, PROTOCOL, Record, Refused, Sensors, Upload, UploadError, View,
    hold,
};
use palpate_bake::{BakedBody, Model, file};
use palpate_sim::plant::{HandPath, HandSettings, Plant, PlantSettings, Vector};
use palpate_tool::firmware::{Board, Emulator, Link as _, Program, Progress};
use palpate_truth::dunes::dunes;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;
use std::collections::VecDeque;
use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::time::{Duration, Instant};

const RATE: f64 = 4_000.0;
/// What the loop's settings allow, N.
const MAX_FORCE: f32 = 5.0;
/// How long to wait for what comes over the line: a byte takes the host's own time, ticks go on meanwhile.
const PATIENCE: Duration = Duration::from_secs(120);
/// Instructions a tick may take here: two bodies on the move, an order, a view and a record, all in one tick, and the
/// frame with the sensors, which a real board has not.
const MOST: u32 = 9_000;
/// Instructions in a count: the emulator is run at 8 ns each, so that there is time left below the tick.
const IN_A_COUNT: u32 = 5;

/// A hand that goes up and down over both bodies, and through the gap between them.
struct Sway;

impl HandPath for Sway {
    fn target(&self, time: f64) -> Vector {
        [0.0, 0.03 + 0.045 * (1.3 * time).sin(), 0.02 + 0.012 * (7.0 * time).sin()]
    }

    fn velocity(&self, time: f64) -> Vector {
        [0.0, 0.045 * 1.3 * (1.3 * time).cos(), 0.012 * 7.0 * (7.0 * time).cos()]
    }
}

/// The board, the device at its pins, and what has come over its line.
struct Desk {
    pins: Emulator,
    port: TcpStream,
    plant: Plant,
    random: Pcg32,
    tick: u32,
    /// What is still to be sent.
    out: VecDeque<u8>,
    receiver: Receiver<DeviceMessage>,
    in_step: bool,
    damaged: u32,
    hellos: Vec<Hello>,
    answers: Vec<Answer>,
    view: View,
    views: u32,
    record: Record,
    /// The most that a tick took, counts, and the largest force told, N.
    took: u32,
    force: f32,
    /// Ticks in which a motor was driven.
    driven: u32,
    _program: Program,
}

impl Desk {
    fn new() -> Self {
        let program = Program::prepare(Board::default(), "link", &["link"], &Progress::new()).expect("it builds");
        let (pins, port) = program.start_with_telemetry().expect("it starts");
        port.set_nonblocking(true).expect("a socket");
        let hand = HandSettings { stiffness: 800.0, damping: 10.0, mass: 0.0 };
        let plant = Plant::new(&PlantSettings::wooden_haptics_2016(), hand, Box::new(Sway), RATE).expect("a device");
        let mut desk = Self {
            pins,
            port,
            plant,
            random: Pcg32::seed_from_u64(11),
            tick: 0,
            out: VecDeque::new(),
            receiver: Receiver::new(),
            in_step: false,
            damaged: 0,
            hellos: Vec::new(),
            answers: Vec::new(),
            view: View::default(),
            views: 0,
            record: Record::default(),
            took: 0,
            force: 0.0,
            driven: 0,
            _program: program,
        };
        // It checks its tables, and has to see the button released.
        while desk.record.phase != Phase::Armed as u8 {
            desk.tick(false);
        }
        desk
    }

    fn send(&mut self, command: &HostMessage) {
        let mut buffer = [0; MAX_FRAME];
        self.out.extend(pack(command, &mut buffer).expect("it fits"));
    }

    /// A tick of the board, the device and the line. `enable`: the person's button.
    fn tick(&mut self, enable: bool) {
        let counts = self.plant.counts();
        let report = self.pins.exchange(&Sensors { tick: self.tick, counts, enable }).expect("the board answers");
        assert_eq!(report.tick, self.tick);
        // Nobody holds the button: no current in any motor, whatever came over the line.
        assert!(enable || report.duties == [0; 3], "{report:?}");
        self.driven += u32::from(report.duties != [0; 3]);
        self.plant.advance(report.duties);
        self.tick += 1;
        let bytes: Vec<u8> = self.out.iter().copied().take(64).collect();
        match self.port.write(&bytes) {
            Ok(sent) => drop(self.out.drain(..sent)),
            Err(error) => assert_eq!(error.kind(), ErrorKind::WouldBlock),
        }
        let mut buffer = [0; 4096];
        match self.port.read(&mut buffer) {
            Ok(read) => buffer[..read].iter().for_each(|byte| self.take(*byte)),
            Err(error) => assert_eq!(error.kind(), ErrorKind::WouldBlock),
        }
    }

    fn take(&mut self, byte: u8) {
        if !self.in_step {
            self.in_step = byte == DELIMITER;
        }
        match self.receiver.feed(byte) {
            Some(Received::Message(DeviceMessage::Hello(hello))) => self.hellos.push(hello),
            Some(Received::Message(DeviceMessage::Answer(answer))) => self.answers.push(answer),
            Some(Received::Message(DeviceMessage::View(view))) => {
                (self.view, self.views) = (view, self.views + 1);
                self.saw(view.force);
            }
            Some(Received::Message(DeviceMessage::Record(record))) => {
                self.took = self.took.max(record.took);
                self.record = record;
                self.saw(record.force);
            }
            Some(Received::Damaged) => self.damaged += 1,
            _ => {}
        }
    }

    fn saw(&mut self, force: [f32; 3]) {
        let [x, y, z] = force;
        self.force = self.force.max((x * x + y * y + z * z).sqrt());
    }

    /// Ticks until this holds.
    fn until(&mut self, what: &str, holds: impl Fn(&Self) -> bool) {
        let start = Instant::now();
        while !holds(self) {
            let Self { damaged, record, .. } = self;
            assert!(start.elapsed() < PATIENCE, "waited in vain for {what}, {damaged} damaged; {record:?}");
            self.tick(true);
        }
    }

    fn hello(&mut self) -> Hello {
        let heard = self.hellos.len();
        self.send(&HostMessage::Hello { protocol: PROTOCOL });
        self.until("a hello", |desk| desk.hellos.len() > heard);
        // Force only once the button was let go of for 25 ms since a host was heard.
        for _ in 0..(RATE / 32.0) as u32 {
            self.tick(false);
        }
        self.hellos[heard]
    }

    /// Sends it, and waits for its answer.
    fn ask(&mut self, number: u16, command: &HostMessage) -> Option<Refused> {
        self.send(command);
        self.until("an answer", |desk| desk.answers.last().is_some_and(|answer| answer.number == number));
        self.answers.last().expect("it came").refused
    }

    /// What must be so at the end of every run.
    fn is_well(&self, what: &str) {
        let Self { record, took, force, driven, views, tick, .. } = self;
        let instructions = took * IN_A_COUNT;
        println!(
            "{what}: {tick} ticks, {driven} with motors driven, {views} views; a tick took {instructions} instructions \
             at most, the frame with its sensors among them; force {force:.2} N at most"
        );
        assert_eq!((record.overruns, record.fault), (0, 0), "{record:?}");
        assert!(instructions <= MOST, "{instructions}");
        // Rounding.
        assert!(*force <= MAX_FORCE * (1.0 + 1e-6), "{force}");
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.random.random::<f32>()
    }

    fn numbers(&mut self, size: f32) -> [f32; 3] {
        [0; 3].map(|_| self.between(-size, size))
    }

    /// An order that the scene takes.
    fn good_order(&mut self) -> Command {
        let body = self.random.random_range(0..2);
        let position = [self.between(-0.002, 0.002), self.between(-0.002, 0.002) + 0.06 * f32::from(body), 0.0];
        let angle = self.between(-0.05, 0.05);
        let pose = BodyPose { position, orientation: [0.0, 0.0, (0.5 * angle).sin(), (0.5 * angle).cos()] };
        let (velocity, angular_velocity) = (self.numbers(0.03), self.numbers(0.3));
        let seconds = self.between(0.0, 0.01);
        match self.random.random_range(0..10) {
            0 => Command::Place { body, pose },
            1 => Command::Lead { body, pose, velocity, angular_velocity, seconds },
            2 => Command::Move { body, velocity, angular_velocity, seconds },
            3 => Command::Switch { groups: self.random.random_range(0..4) },
            4 => Command::Choose { index: 0 },
            5 => Command::Harden { body, stiffness: self.between(100.0, 500.0), damping: self.between(0.0, 1.5) },
            6 => Command::Rub { body, friction: self.random.random_bool(0.5).then_some([400.0, 0.5, 0.5, 0.4]) },
            7 => Command::Tip { radius: self.between(0.0, 0.003) },
            8 => Command::Limit { force: self.between(1.0, MAX_FORCE) },
            _ => Command::Push { force: self.numbers(1.0) },
        }
    }
}

/// A count from the environment.
fn count(name: &str, otherwise: u32) -> u32 {
    std::env::var(name).map_or(otherwise, |count| count.parse().expect("a number"))
}

/// `PALPATE_ORDERS` says how many.
#[test]
fn orders_at_any_instant_are_answered_and_no_tick_is_late() {
    let name = "orders_at_any_instant_are_answered_and_no_tick_is_late";
    if !is_wanted(name) {
        return;
    }
    let mut desk = Desk::new();
    // Before hello none is taken.
    let early = HostMessage::Command { number: 7, command: Command::Limit { force: 1.0 } };
    assert_eq!(desk.ask(7, &early), Some(Refused::Hello));
    let hello = desk.hello();
    assert_eq!((hello.protocol, hello.rate, hello.max_force), (PROTOCOL, RATE as f32, MAX_FORCE));
    let orders = count("PALPATE_ORDERS", 3_000);
    for number in 0..orders {
        let order = desk.good_order();
        let answer = desk.ask(number as u16, &HostMessage::Command { number: number as u16, command: order });
        assert_eq!(answer, None, "{order:?}");
        for _ in 0..desk.random.random_range(0..3) {
            desk.tick(true);
        }
    }
    assert_eq!(desk.damaged, 0);
    assert!(desk.driven > desk.tick / 4 && desk.views > orders / 2, "{} {}", desk.driven, desk.views);
    desk.is_well(&format!("{orders} orders"));
}

/// Bytes at random, frames with a bit or a byte changed, frames cut short, and whole frames of numbers that make no
/// sense, with the button held and let go. `PALPATE_BYTES` says how many.
#[test]
fn whatever_comes_over_the_line_moves_nothing_that_nobody_asked_for() {
    if !is_wanted("whatever_comes_over_the_line_moves_nothing_that_nobody_asked_for") {
        return;
    }
    let mut desk = Desk::new();
    desk.hello();
    let wanted = count("PALPATE_BYTES", 100_000);
    let (mut sent, mut heard) = (0, 0);
    while sent < wanted {
        // The socket takes megabytes before the board has read them: now and then until it has. It still listens.
        if sent - heard > 20_000 {
            heard = sent;
            desk.out.push_back(DELIMITER);
            desk.hello();
        }
        let mut frame = [0; MAX_FRAME];
        let length = match desk.random.random_range(0..4) {
            0 => {
                desk.random.fill(&mut frame[..]);
                desk.random.random_range(1..MAX_FRAME)
            }
            kind => {
                let mut order = desk.good_order();
                if kind == 3 {
                    let wrong = [f32::NAN, f32::INFINITY, -1e30][desk.random.random_range(0..3)];
                    order = match order {
                        Command::Harden { body, damping, .. } => {
                            Command::Harden { body: body + 3, stiffness: wrong, damping }
                        }
                        Command::Tip { .. } => Command::Tip { radius: wrong },
                        Command::Limit { .. } => Command::Limit { force: wrong },
                        Command::Push { .. } => Command::Push { force: [wrong; 3] },
                        Command::Move { body, velocity, .. } => {
                            Command::Move { body, velocity, angular_velocity: [wrong; 3], seconds: wrong }
                        }
                        _ => {
                            Command::Place { body: 1, pose: BodyPose { position: [wrong; 3], orientation: [wrong; 4] } }
                        }
                    };
                }
                let command = match desk.random.random_range(0..12) {
                    // What is begun in flash holds the motors off until it ends, or nobody goes on with it.
                    0 => {
                        HostMessage::Upload { number: sent as u16, part: Upload::Keep { bytes: desk.random.random() } }
                    }
                    1 => {
                        HostMessage::Upload { number: sent as u16, part: Upload::Begin { bytes: desk.random.random() } }
                    }
                    2 => HostMessage::Upload { number: sent as u16, part: Upload::End },
                    _ => HostMessage::Command { number: sent as u16, command: order },
                };
                let length = pack(&command, &mut frame).expect("it fits").len();
                if kind == 1 {
                    let at = desk.random.random_range(0..length);
                    frame[at] ^= 1 << desk.random.random_range(0..8);
                }
                if kind == 2 { desk.random.random_range(1..=length) } else { length }
            }
        };
        desk.out.extend(&frame[..length]);
        sent += length as u32;
        while desk.out.len() > 200 {
            // Somebody lets go of the button now and then.
            let enable = desk.tick % 4_000 < 3_000;
            desk.tick(enable);
        }
    }
    // And does what it is told.
    desk.out.push_back(DELIMITER);
    desk.hello();
    assert_eq!(desk.ask(1, &HostMessage::Command { number: 1, command: Command::Limit { force: 2.0 } }), None);
    assert_eq!(desk.damaged, 0);
    desk.is_well(&format!("{sent} bytes"));
    // And stops when it is told to.
    desk.send(&HostMessage::Stop);
    desk.until("the stop", |desk| desk.record.fault == Fault::Stopped.code());
}

/// A plate with dunes, of 96 patches, nearly as large as the room for bodies.
fn dunes_file() -> Vec<u8> {
    let model = Model::parse(&dunes(6), "dunes").expect("a model");
    let body = BakedBody::new(&model, "dunes").expect("it bakes");
    file::write([0; 32], &model, &body).expect("a file")
}

/// The part of a file that begins here.
fn chunk(file: &[u8], at: usize) -> Upload {
    let mut bytes = [[0; 16]; CHUNK / 16];
    let rest = &file[at..file.len().min(at + CHUNK)];
    bytes.as_flattened_mut()[..rest.len()].copy_from_slice(rest);
    Upload::Bytes { at: at as u32, bytes }
}

#[test]
fn a_body_comes_over_the_line_while_another_is_felt() {
    if !is_wanted("a_body_comes_over_the_line_while_another_is_felt") {
        return;
    }
    let file = dunes_file();
    let mut desk = Desk::new();
    let room = desk.hello().room;
    println!("a body of {} bytes, into {room}", file.len());
    assert!(file.len() as u32 <= room);
    let mut number = 0;
    let mut ask = |desk: &mut Desk, part: Upload| {
        number += 1;
        desk.ask(number, &HostMessage::Upload { number, part })
    };
    let wrong = |error| Some(Refused::Upload(error));
    assert_eq!(ask(&mut desk, Upload::End), wrong(UploadError::NotBegun));
    assert_eq!(ask(&mut desk, Upload::Begin { bytes: room + 1 }), wrong(UploadError::TooLong { room }));
    for is_spoiled in [true, false] {
        let (began, driven) = (desk.tick, desk.driven);
        assert_eq!(ask(&mut desk, Upload::Begin { bytes: file.len() as u32 }), None);
        assert_eq!(ask(&mut desk, chunk(&file, 2 * CHUNK)), wrong(UploadError::Order { at: 0 }));
        for at in (0..file.len()).step_by(CHUNK) {
            let mut part = chunk(&file, at);
            if let Upload::Bytes { bytes, .. } = &mut part
                && is_spoiled
                && at == 100 * CHUNK
            {
                bytes[1][3] ^= 4;
            }
            assert_eq!(ask(&mut desk, part), None);
        }
        let checked = ask(&mut desk, Upload::End);
        // A repeated number is answered again and not done again.
        let number = if is_spoiled { 60_000 } else { 60_001 };
        let take = HostMessage::Command { number, command: Command::Take { body: 1 } };
        if is_spoiled {
            assert_eq!(checked, wrong(UploadError::NoBody));
            assert!(matches!(desk.ask(number, &take), Some(Refused::Command(_))));
        } else {
            assert_eq!(checked, None);
            assert_eq!(desk.ask(number, &take), None);
        }
        assert!(desk.driven > driven, "the old one is felt meanwhile");
        println!("it took {} ticks", desk.tick - began);
    }
    // Now it is felt, where it is put: a face that the one before has not.
    let pose = BodyPose { position: [0.03, 0.08, 0.028], orientation: [0.0, 0.0, 0.0, 1.0] };
    assert_eq!(
        desk.ask(60_002, &HostMessage::Command { number: 60_002, command: Command::Place { body: 1, pose } }),
        None
    );
    desk.until("a face of the new body", |Desk { view, .. }| {
        view.body == 1 && view.contact == 2 && view.force != [0.0; 3] && (6..1 << 14).contains(&view.feature)
    });
    for tick in 0..20_000 {
        if tick % 1_000 == 0 {
            desk.send(&HostMessage::Alive);
        }
        desk.tick(true);
    }
    desk.is_well("an upload");
}

#[test]
fn a_body_is_kept_only_while_no_motor_is_driven_and_none_is_driven_until_it_is() {
    if !is_wanted("a_body_is_kept_only_while_no_motor_is_driven_and_none_is_driven_until_it_is") {
        return;
    }
    let file = dunes_file();
    let mut desk = Desk::new();
    let hello = desk.hello();
    println!("a body of {} bytes, into {} of flash", file.len(), hello.flash);
    assert!(file.len() as u32 <= hello.flash);
    assert_eq!(hello.kept, 0);
    let keep = Upload::Keep { bytes: file.len() as u32 };
    desk.until("force", |desk| desk.driven > 0);
    let refused = Some(Refused::Upload(UploadError::Driven));
    assert_eq!(desk.ask(1, &HostMessage::Upload { number: 1, part: keep }), refused);
    // Let go of, and pressed again as soon as it has begun: nothing is driven until the last part, and not after it.
    for _ in 0..400 {
        desk.tick(false);
    }
    desk.send(&HostMessage::Upload { number: 2, part: keep });
    // Until it is asked for.
    for _ in 0..200 {
        desk.tick(false);
    }
    // Confirmed by the button, held for 0.6 s and released.
    for tick in 0_u32.. {
        if desk.answers.last().is_some_and(|answer| answer.number == 2) {
            break;
        }
        desk.tick(tick < 2_400);
    }
    assert_eq!(desk.answers.last(), Some(&Answer { number: 2, refused: None }));
    let driven = desk.driven;
    for (number, at) in (3..).zip((0..file.len()).step_by(CHUNK)) {
        let answer = desk.ask(number, &HostMessage::Upload { number, part: chunk(&file, at) });
        assert_eq!(answer, None, "{at}");
        assert_ne!(desk.view.hold & hold::WRITING, 0);
    }
    assert_eq!(desk.ask(60_000, &HostMessage::Upload { number: 60_000, part: Upload::End }), None);
    assert_eq!(desk.ask(60_001, &HostMessage::Command { number: 60_001, command: Command::Take { body: 1 } }), None);
    for tick in 0..4_000 {
        if tick % 1_000 == 0 {
            desk.send(&HostMessage::Alive);
        }
        desk.tick(true);
    }
    assert_eq!(desk.driven, driven);
    assert_eq!(desk.view.hold, hold::RELEASE_FIRST);
    let kept = desk.hello().kept;
    assert_eq!(Some(&kept.to_le_bytes()), file.last_chunk());
    desk.tick(false);
    // Now it is felt, where it is put: a face that the one before has not.
    let pose = BodyPose { position: [0.03, 0.08, 0.028], orientation: [0.0, 0.0, 0.0, 1.0] };
    assert_eq!(
        desk.ask(60_002, &HostMessage::Command { number: 60_002, command: Command::Place { body: 1, pose } }),
        None
    );
    desk.until("a face of the new body", |Desk { view, .. }| {
        view.body == 1 && view.contact == 2 && view.force != [0.0; 3] && (6..1 << 14).contains(&view.feature)
    });
    desk.is_well("a body kept");
}
