//! A board's USB plug: packets on a mock of a bus, a host that reads or does not, a plug that is pulled.

use crate::usb_bus::Mock;
use palpate::device::SerialArm;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::servo::{Config, Fault, Heartbeat, ResetReason, Safety, Servo};
use palpate::wire::frame::{DELIMITER, MAX_FRAME, Received, Receiver, pack};
use palpate::wire::{DeviceMessage, HostMessage, PROTOCOL};
use palpate_bench::usb::{Bytes, Cdc, Either, PACKET, Plug, TURNS};
use palpate_bench::{Idle, Port, Watchdog};
use palpate_sim::rig::{Rig, SETTINGS, WALL, held_at, settings};
use std::collections::VecDeque;
use usb_device::bus::UsbBusAllocator;

/// Requests of a host, as USB 2.0 (9.4) and the class of serial devices (PSTN120, 6.3) lay them out.
const SET_ADDRESS: [u8; 8] = [0x00, 5, 7, 0, 0, 0, 0, 0];
const SET_CONFIGURATION: [u8; 8] = [0x00, 9, 1, 0, 0, 0, 0, 0];
const OPEN: [u8; 8] = [0x21, 0x22, 1, 0, 0, 0, 0, 0];
const CLOSED: [u8; 8] = [0x21, 0x22, 0, 0, 0, 0, 0, 0];

type Plugged = Cdc<'static, Mock, Mock>;

/// A plug, which has had no host yet.
fn plug() -> (Mock, Plugged) {
    let mock = Mock::default();
    // It lives as long as the test, as main's does.
    let bus = Box::leak(Box::new(UsbBusAllocator::new(mock.clone())));
    (mock.clone(), Cdc::try_new(bus, mock).unwrap())
}

/// Turns enough for the bus to be asked some times. What came meanwhile.
fn turns(port: &mut impl Port) -> Vec<u8> {
    (0..8 * u32::from(TURNS)).filter_map(|_| port.receive()).collect()
}

fn request(mock: &Mock, port: &mut impl Port, setup: [u8; 8]) -> Vec<u8> {
    mock.wires().control.clear();
    mock.request(setup);
    let came = turns(port);
    assert!(!mock.wires().stalled, "{setup:?}");
    came
}

/// The host finds the device, and a program opens it.
fn open(mock: &Mock, port: &mut impl Port) -> Vec<u8> {
    mock.reset();
    turns(port);
    request(mock, port, SET_ADDRESS);
    request(mock, port, SET_CONFIGURATION);
    request(mock, port, OPEN)
}

fn frame(command: &HostMessage) -> Vec<u8> {
    pack(command, &mut [0; MAX_FRAME]).unwrap().to_vec()
}

/// What a receiver makes of bytes, without what is empty.
fn received(bytes: &[u8]) -> Vec<Received<HostMessage>> {
    let mut receiver = Receiver::new();
    bytes.iter().filter_map(|byte| receiver.feed(*byte)).filter(|made| *made != Received::Empty).collect()
}

#[test]
fn bytes_are_taken_in_their_order_dropped_in_parts_and_refused_without_room() {
    let mut bytes = Bytes::<3>::new();
    assert_eq!((bytes.pop(), bytes.waiting()), (None, [].as_slice()));
    assert_eq!([1, 2, 3, 4].map(|byte| bytes.push(byte)), [true, true, true, false]);
    assert_eq!(bytes.pop(), Some(1));
    // A packet is on its way as it is: nothing is added to it.
    assert!(!bytes.push(4));
    bytes.drop_first(1);
    assert_eq!((bytes.waiting(), bytes.is_empty()), ([3].as_slice(), false));
    bytes.drop_first(usize::MAX);
    assert!(bytes.is_empty() && bytes.push(5));
    bytes.fill(|_| None);
    assert_eq!(bytes.pop(), None);
    // Whatever a bus says that it has read.
    bytes.fill(|place| {
        place.copy_from_slice(&[6, 7, 8]);
        Some(usize::MAX)
    });
    assert_eq!(bytes.waiting(), [6, 7, 8]);
    bytes.clear();
    assert!(bytes.is_empty());
}

#[test]
fn a_host_finds_a_serial_device_of_the_test_numbers_by_its_name() {
    let (mock, mut plug) = plug();
    mock.reset();
    turns(&mut plug);
    request(&mock, &mut plug, SET_ADDRESS);
    assert_eq!(mock.wires().address, 7);
    request(&mock, &mut plug, [0x80, 6, 0, 1, 0, 0, 18, 0]);
    let device = mock.wires().control.clone();
    assert_eq!(device[4], 2, "a communications device");
    assert_eq!((usize::from(device[7]), &device[8..12]), (PACKET, [0x09, 0x12, 0x01, 0x00].as_slice()));
    for name in [1, 2] {
        request(&mock, &mut plug, [0x80, 6, name, 3, 9, 4, 255, 0]);
        let words: Vec<u16> = "palpate".encode_utf16().collect();
        let said: Vec<u16> =
            mock.wires().control[2..].chunks_exact(2).map(|two| u16::from_le_bytes([two[0], two[1]])).collect();
        assert_eq!(said, words);
    }
    assert_eq!(mock.wires().configured, 0);
    request(&mock, &mut plug, SET_CONFIGURATION);
    assert_eq!(mock.wires().configured, 1);
    turns(&mut plug);
    assert_eq!(mock.wires().configured, 1, "once");
    // The other side was reset: anew.
    open(&mock, &mut plug);
    assert_eq!(mock.wires().configured, 2);
}

#[test]
fn the_bus_is_asked_once_in_so_many_turns_whichever_way_they_go() {
    let (mock, mut plug) = plug();
    for _ in 0..u32::from(TURNS) * 10 {
        plug.receive();
        plug.send(1);
    }
    assert_eq!(mock.wires().polls, 20);
}

#[test]
fn nothing_is_taken_or_said_before_a_program_has_the_port_open() {
    let (mock, mut plug) = plug();
    assert!(!plug.send(1), "without a plug");
    mock.reset();
    turns(&mut plug);
    request(&mock, &mut plug, SET_ADDRESS);
    request(&mock, &mut plug, SET_CONFIGURATION);
    mock.wires().out.push_back(frame(&HostMessage::Stop));
    assert_eq!((turns(&mut plug), plug.send(1), plug.is_open()), (vec![], false, false));
    assert_eq!(mock.wires().out.len(), 0, "and forgotten, lest it is done late");
    // Whatever came before, a frame begins here.
    assert_eq!(request(&mock, &mut plug, OPEN), [DELIMITER]);
    assert!(plug.is_open() && plug.send(1));
    request(&mock, &mut plug, CLOSED);
    assert_eq!((plug.is_open(), plug.send(1)), (false, false));
}

#[test]
fn frames_come_whole_in_whatever_packets_and_none_goes_out_in_a_full_one() {
    let (mock, mut plug) = plug();
    open(&mock, &mut plug);
    let said: Vec<u8> = [HostMessage::Alive, HostMessage::Stop, HostMessage::Alive].iter().flat_map(frame).collect();
    for packets in [1, 2, 5, PACKET] {
        mock.wires().out.extend(said.chunks(packets).map(<[u8]>::to_vec));
        let mut came = Vec::new();
        while came.len() < said.len() {
            came.extend(turns(&mut plug));
        }
        assert_eq!(came, said);
    }
    let mut heard = Vec::new();
    let said: Vec<u8> = (0..=u8::MAX).cycle().take(1_000).collect();
    let mut left = said.iter();
    let mut next = left.next();
    for _ in 0..20_000 {
        if next.is_some_and(|byte| plug.send(*byte)) {
            next = left.next();
        }
        assert_eq!(plug.receive(), None);
        heard.extend(mock.take());
    }
    assert_eq!(heard, said);
    let longest = mock.wires().sizes.iter().copied().max();
    assert!(longest.is_some_and(|longest| longest < PACKET), "{longest:?}");
}

#[derive(Default)]
struct Counted(u32);

impl Watchdog for Counted {
    fn feed(&mut self) {
        self.0 += 1;
    }
}

fn rig(safety: Safety) -> Rig<SerialArm> {
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, safety, ..Config::DEFAULT });
    Rig::new(servo, held_at([0.0; 3]), &settings(), ResetReason::PowerOn)
}

#[test]
fn a_host_that_does_not_read_stops_neither_main_nor_the_tick_and_reads_whole_frames_afterwards() {
    let (mock, mut plug) = plug();
    open(&mock, &mut plug);
    let mut rig = rig(Safety::DEFAULT);
    let mut idle = Idle::new(rig.mailbox, rig.take_records(), Heartbeat::default());
    let (mut watchdog, mut heard) = (Counted::default(), Vec::new());
    // More records than the queue has places for.
    let ticks = 2 * 4_096 * 20;
    for tick in 1..=ticks {
        rig.tick();
        for _ in 0..3 {
            idle.step(&mut plug, &mut watchdog);
        }
        assert_eq!(watchdog.0, tick);
    }
    assert_eq!(mock.wires().sizes.len(), 1, "the controller holds one");
    while let packet @ [_, ..] = mock.take().as_slice() {
        heard.extend(packet);
        for _ in 0..4 * u32::from(TURNS) {
            idle.step(&mut plug, &mut watchdog);
        }
    }
    rig.ticks(100);
    for _ in 0..40 * MAX_FRAME {
        idle.step(&mut plug, &mut watchdog);
        heard.extend(mock.take());
    }
    let mut receiver = Receiver::<DeviceMessage>::new();
    let told: Vec<_> = heard.iter().filter_map(|byte| receiver.feed(*byte)).collect();
    assert!(told.iter().all(|told| matches!(told, Received::Message(_))), "{told:?}");
    let Some(Received::Message(DeviceMessage::Record(last))) = told.last() else { panic!("{told:?}") };
    assert!(last.dropped > 4_000, "{last:?}");
    assert!(last.tick > ticks, "what is told is of now");
}

#[test]
fn a_plug_that_is_pulled_closed_reset_or_asleep_is_a_line_that_forgets_what_was_on_its_way() {
    let ends: [fn(&Mock, &mut Plugged); 4] = [
        |mock, plug| drop(request(mock, plug, CLOSED)),
        |mock, _| mock.reset(),
        |mock, _| mock.sleep(),
        |mock, _| mock.wires().is_silent = true,
    ];
    let whole = frame(&HostMessage::Stop);
    for (number, end) in ends.into_iter().enumerate() {
        let (mock, mut plug) = plug();
        open(&mock, &mut plug);
        mock.wires().out.push_back(whole[..3].to_vec());
        let mut came = turns(&mut plug);
        assert_eq!(came, whole[..3]);
        assert!((0..PACKET - 1).all(|_| plug.send(7)), "{number}: room for a packet");
        end(&mock, &mut plug);
        came.extend(turns(&mut plug));
        assert_eq!((came.len(), plug.is_open(), plug.send(7)), (3, false, false), "{number}");
        mock.wires().is_silent = false;
        mock.wake();
        came.extend(open(&mock, &mut plug));
        // What was put in before and taken by nobody stays away.
        turns(&mut plug);
        assert!(mock.take().is_empty(), "{number}");
        mock.wires().out.push_back(whole.clone());
        came.extend(turns(&mut plug));
        assert_eq!(received(&came), [Received::Damaged, Received::Message(HostMessage::Stop)], "{number}");
    }
}

#[test]
fn after_a_sleep_the_port_is_open_as_it_was() {
    let (mock, mut plug) = plug();
    open(&mock, &mut plug);
    mock.sleep();
    turns(&mut plug);
    assert!(!plug.is_open());
    mock.wake();
    assert_eq!((turns(&mut plug), plug.is_open()), (vec![DELIMITER], true));
}

/// A UART, whose bytes lie at both its ends.
#[derive(Default)]
struct Uart {
    to_device: std::rc::Rc<std::cell::RefCell<VecDeque<u8>>>,
    from_device: std::rc::Rc<std::cell::RefCell<Vec<u8>>>,
}

impl Port for Uart {
    fn send(&mut self, byte: u8) -> bool {
        self.from_device.borrow_mut().push(byte);
        true
    }

    fn receive(&mut self) -> Option<u8> {
        self.to_device.borrow_mut().pop_front()
    }
}

#[test]
fn the_uart_is_the_line_while_nobody_has_the_plug_open_and_halves_of_two_lines_make_no_frame() {
    let (mock, plug) = plug();
    let uart = Uart::default();
    let (to_device, from_device) = (uart.to_device.clone(), uart.from_device.clone());
    let mut line = Either::new(plug, uart);
    let whole = frame(&HostMessage::Stop);
    let (first, second) = whole.split_at(3);

    to_device.borrow_mut().extend(first);
    let mut came = turns(&mut line);
    assert_eq!(came, first);
    assert!(line.send(1));
    assert_eq!(*from_device.borrow(), [1]);

    came.extend(open(&mock, &mut line));
    mock.wires().out.push_back(second.to_vec());
    came.extend(turns(&mut line));
    // Said at the UART meanwhile: not heard, neither now nor later.
    to_device.borrow_mut().extend(&whole);
    assert!(line.send(2));
    came.extend(turns(&mut line));
    assert_eq!((from_device.borrow().len(), mock.take()), (1, vec![2]));
    assert_eq!(received(&came), [Received::Damaged, Received::Damaged]);

    mock.wires().out.push_back(whole.clone());
    mock.wires().out.push_back(first.to_vec());
    let mut came = turns(&mut line);
    came.extend(request(&mock, &mut line, CLOSED));
    to_device.borrow_mut().extend(second);
    came.extend(turns(&mut line));
    to_device.borrow_mut().extend(&whole);
    came.extend(turns(&mut line));
    let stop = Received::Message(HostMessage::Stop);
    assert_eq!(received(&came), [stop, Received::Damaged, Received::Damaged, stop]);
    assert!(line.send(3));
    assert_eq!(*from_device.borrow(), [1, 3]);
}

#[test]
fn whoever_does_nothing_but_send_comes_from_a_plug_that_is_closed_to_the_uart() {
    let (mock, plug) = plug();
    let uart = Uart::default();
    let from_device = uart.from_device.clone();
    let mut line = Either::new(plug, uart);
    open(&mock, &mut line);
    turns(&mut line);
    assert!((0..PACKET - 1).all(|_| line.send(1)));
    assert!(!mock.take().is_empty() && from_device.borrow().is_empty());
    mock.request(CLOSED);
    for _ in 0..1_000 {
        line.send(2);
    }
    assert!(from_device.borrow().len() > 900, "{}", from_device.borrow().len());
}

#[test]
fn a_plug_that_is_pulled_is_a_link_that_is_lost() {
    let (mock, plug) = plug();
    let mut line = Either::new(plug, Uart::default());
    open(&mock, &mut line);
    let mut rig = rig(Safety { link_timeout_s: 0.05, ..Safety::DEFAULT });
    let mut idle = Idle::new(rig.mailbox, rig.take_records(), Heartbeat::default());
    let mut tick = |rig: &mut Rig<SerialArm>| {
        rig.tick();
        for _ in 0..100 {
            idle.step(&mut line, &mut Counted::default());
        }
    };
    mock.wires().out.push_back(frame(&HostMessage::Hello { protocol: PROTOCOL }));
    for _ in 0..400 {
        mock.wires().out.push_back(frame(&HostMessage::Alive));
        tick(&mut rig);
    }
    assert_eq!(rig.fault(), None);
    mock.sleep();
    for _ in 0..150 {
        tick(&mut rig);
    }
    assert_eq!(rig.fault(), None, "0.05 s are 200 ticks");
    for _ in 0..100 {
        tick(&mut rig);
    }
    assert_eq!(rig.fault(), Some(Fault::LinkLost));
    assert!(rig.is_off());
}
