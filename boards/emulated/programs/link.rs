//! The loop of the boards for the bench over a scene that a host may change: its pins over two FIFOs, the host at the
//! UART. Two bodies; another may come over the line in the place of the second.

#![no_std]
#![no_main]

use core::cell::Cell;

use cortex_m::interrupt::{Mutex, free};
use cortex_m_rt::entry;
use palpate::body::Body;
use palpate::commission::Wiring;
use palpate::math::vec3;
use palpate::scene::{Limits, Material, Motion, Part, Scene, Slot};
use palpate::servo::{Config, Heartbeat, Safety, Servo, Unguarded};
use palpate::track::{Controller, Placement};
use palpate::wire::Record;
use palpate::wire::telemetry::{Producer, Queue};
use palpate_bench::store::{Bodies, Both, Kept, PretendedFlash};
use palpate_bench::{Bench, Felt, Idle, Mailbox, Settings};
use palpate_emulated::board::BOARD;
use palpate_emulated::body::{DEVICE, EFFORT, Mechanism, SETTINGS, WIRING};
use palpate_emulated::link_semihosting::FifoLink;
use palpate_emulated::link_uart::Uart;
use palpate_emulated::pins::{NoWatchdog, Pins};
use palpate_emulated::vectors::interrupt;

mod tables {
    include!(env!("PALPATE_BODY_FILE"));
}

/// 64 KB a bank, and faces and edges of some 200 patches.
type Memory = Bodies<16_640, 240, 600>;
type Flash = Kept<240, 600>;
type Store = Both<'static, Memory, Flash>;
type Surface = Scene<'static, Slot<'static, Store>, 2>;

static BODIES: Memory = Bodies::with_effort(EFFORT);
/// No emulator here has flash that a program can write: RAM with its rules, which a reset empties.
static FLASH: PretendedFlash<16_384> = PretendedFlash::new();
static KEPT: Flash = Kept::with_effort(FLASH.region(), EFFORT);
static STORE: Store = Both(&BODIES, &KEPT);
static BODY: Body = tables::BODY.with_effort(EFFORT);
static SLOTS: [Slot<Store>; 2] = [Slot::fixed(&BODY), Slot::exchangeable(&BODY, &STORE)];
/// Side by side, the second to the right of the first.
static SCENE: Surface = Scene::new(
    Limits::of(&DEVICE, SETTINGS.rate_hz),
    [
        Part::in_slot(&SLOTS[0], Motion::Resting(Placement::IDENTITY), Material::new(500.0, 1.5)),
        Part::in_slot(
            &SLOTS[1],
            Motion::Resting(Placement { origin: vec3(0.0, 0.06, 0.0), ..Placement::IDENTITY }),
            Material::new(500.0, 1.5),
        ),
    ],
);

/// A host that falls silent for ten seconds is gone: the emulator's line takes the host's own time, while emulated time
/// goes on. On a board it would be a tenth of a second.
static SERVO: Servo<'static, Surface, Mechanism, 3> = Servo::new(
    &DEVICE,
    &SCENE,
    Config { settings: SETTINGS, safety: Safety { link_timeout_s: 10.0, ..Safety::DEFAULT }, ..Config::DEFAULT },
);

struct This;

impl Felt<3> for This {
    type Surface = Surface;
    type Mechanism = Mechanism;
    type Guard = Unguarded;

    #[inline(always)]
    fn servo(&self) -> &Servo<'static, Surface, Mechanism, 3, Unguarded> {
        &SERVO
    }

    #[inline(always)]
    fn wiring(&self) -> Wiring<3> {
        WIRING
    }
}

type Loop = Bench<'static, This, Pins<FifoLink>, 3>;

/// The interrupt's end of the queue, on its way there from main.
static HANDED_OVER: Mutex<Cell<Option<Producer<'static, Record>>>> = Mutex::new(Cell::new(None));
static MAILBOX: Mailbox = Mailbox::new();

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Record, 16> = Queue::new();

    let (producer, records) = QUEUE.split();
    free(|section| HANDED_OVER.borrow(section).set(Some(producer)));
    let uploads = BODIES.main();
    let mut idle = Idle::new(&MAILBOX, records, Heartbeat::default()).saying(SETTINGS.rate_hz, SETTINGS.max_force_n);
    if let Some(uploads) = &uploads {
        idle = idle.taking(uploads);
    }
    let keeping = FLASH.writer().and_then(|flash| KEPT.main(flash, &mut || ())).map(|(keeping, _)| keeping);
    if let Some(keeping) = &keeping {
        idle = idle.keeping(keeping);
    }
    let mut port = Uart::new(&BOARD);
    BOARD.start_timer(SETTINGS.rate_hz);
    loop {
        idle.step(&mut port, &mut NoWatchdog);
    }
}

#[interrupt]
fn TIMER0() {
    // As in `bench`: made where it is used.
    static mut LOOP: Option<Loop> = None;

    BOARD.acknowledge_timer();
    if let Some(servo_loop) = LOOP {
        servo_loop.tick();
        servo_loop.board().report();
    } else if let Some(records) = free(|section| HANDED_OVER.borrow(section).take()) {
        let pins = Pins::new(&BOARD, FifoLink::open());
        *LOOP = Some(Bench::new(This, pins, &Settings::new(BOARD.clock), BOARD.reset_reason(), records, &MAILBOX));
        BOARD.start_timer(SETTINGS.rate_hz);
    }
}
