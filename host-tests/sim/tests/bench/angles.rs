//! AS5047P sensors at their pins: a simulated one that minds its data sheet's times.

use embedded_hal::digital::{ErrorType as PinErrorType, OutputPin};
use embedded_hal::spi::{ErrorKind, ErrorType as BusErrorType, SpiBus};
use palpate::device::Counts;
use palpate_bench::sensors::{Angles, BadFrame, Sensors};
use palpate_bench::{Counter, CycleDelay, cycles};
use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

/// What the data sheet asks for, nanoseconds: written here once more, from its table.
const HIGH: f64 = 350.0;
const SET_UP: f64 = 350.0;
/// Half a clock of 8 MHz.
const HOLD: f64 = 62.5;
const POWER_UP: f64 = 10e6;
const CLOCKS: f64 = 16.0 * 125.0;

/// One sensor.
#[derive(Clone, Debug)]
struct Chip {
    angle: u16,
    /// What the next frame answers.
    answer: u16,
    error: bool,
    /// Frames to come whose command arrives damaged.
    deaf: u32,
    /// When it answers, cycles.
    ready_at: u64,
    is_there: bool,
    /// What its data line reads where nobody drives it: it is pulled, or broken on the side of a level.
    silence: u16,
    selected: bool,
    risen: Option<u64>,
    fallen: u64,
}

/// The sensors, their bus and the core's counter.
struct Table {
    cycles: u64,
    frequency: f64,
    /// Cycles of a look at the counter.
    look: u64,
    chips: Vec<Chip>,
    last_clock: u64,
    frames: u32,
    least: [f64; 3],
}

impl Table {
    fn nanoseconds(&self, cycles: u64) -> f64 {
        cycles as f64 * 1e9 / self.frequency
    }

    fn fall(&mut self, joint: usize) {
        let now = self.cycles;
        if let Some(risen) = self.chips[joint].risen {
            self.least[0] = self.least[0].min(self.nanoseconds(now - risen));
        }
        (self.chips[joint].selected, self.chips[joint].fallen) = (true, now);
    }

    fn rise(&mut self, joint: usize) {
        let now = self.cycles;
        if self.chips[joint].selected {
            self.least[2] = self.least[2].min(self.nanoseconds(now - self.last_clock));
        }
        (self.chips[joint].selected, self.chips[joint].risen) = (false, Some(now));
    }

    fn exchange(&mut self, command: u16) -> u16 {
        self.frames += 1;
        let selected: Vec<usize> = (0..self.chips.len()).filter(|joint| self.chips[*joint].selected).collect();
        let [joint] = selected[..] else { panic!("{selected:?} are selected at once") };
        let set_up = self.nanoseconds(self.cycles - self.chips[joint].fallen);
        self.least[1] = self.least[1].min(set_up);
        self.cycles += (CLOCKS * self.frequency / 1e9).ceil() as u64;
        self.last_clock = self.cycles;
        let now = self.cycles;
        let chip = &mut self.chips[joint];
        if !chip.is_there || now < chip.ready_at {
            return chip.silence;
        }
        let answer = chip.answer | if chip.error { 1 << 14 } else { 0 };
        let is_whole = chip.deaf == 0 && command.count_ones().is_multiple_of(2);
        chip.deaf = chip.deaf.saturating_sub(1);
        chip.error |= !is_whole;
        chip.answer = match command & 0x3fff {
            0x3fff => chip.angle,
            // Settled, and the field is good.
            0x3ffc => 0x0180,
            0x0001 => {
                if is_whole {
                    chip.error = false;
                }
                0
            }
            other => panic!("{other:#x} is no address"),
        };
        answer | ((answer.count_ones() % 2) as u16) << 15
    }
}

type Shared = Rc<RefCell<Table>>;

struct Bus(Shared);

impl BusErrorType for Bus {
    type Error = ErrorKind;
}

impl SpiBus for Bus {
    fn read(&mut self, _: &mut [u8]) -> Result<(), ErrorKind> {
        unreachable!()
    }

    fn write(&mut self, _: &[u8]) -> Result<(), ErrorKind> {
        unreachable!()
    }

    fn transfer(&mut self, _: &mut [u8], _: &[u8]) -> Result<(), ErrorKind> {
        unreachable!()
    }

    fn transfer_in_place(&mut self, words: &mut [u8]) -> Result<(), ErrorKind> {
        let [high, low] = words else { panic!("{words:?} is no frame") };
        [*high, *low] = self.0.borrow_mut().exchange(u16::from_be_bytes([*high, *low])).to_be_bytes();
        Ok(())
    }

    fn flush(&mut self) -> Result<(), ErrorKind> {
        Ok(())
    }
}

struct Select(Shared, usize);

impl PinErrorType for Select {
    type Error = Infallible;
}

impl OutputPin for Select {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().fall(self.1);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().rise(self.1);
        Ok(())
    }
}

#[derive(Clone)]
struct Cycles(Shared);

impl Counter for Cycles {
    fn now(&self) -> u32 {
        let mut table = self.0.borrow_mut();
        table.cycles += table.look;
        // The lower 32 bits: it wraps.
        table.cycles as u32
    }
}

type Joints = Angles<Bus, Select, CycleDelay<Cycles>, 3>;

fn table(frequency: u32, look: u64) -> (Shared, Joints) {
    let chip = Chip {
        angle: 0,
        answer: 0,
        error: true,
        deaf: 0,
        ready_at: (POWER_UP * f64::from(frequency) / 1e9) as u64,
        is_there: true,
        silence: u16::MAX,
        selected: false,
        risen: None,
        fallen: 0,
    };
    let shared = Rc::new(RefCell::new(Table {
        cycles: 0,
        frequency: f64::from(frequency),
        look,
        chips: vec![chip; 3],
        last_clock: 0,
        frames: 0,
        least: [f64::INFINITY; 3],
    }));
    let selects = [0, 1, 2].map(|joint| Select(Rc::clone(&shared), joint));
    let delay = CycleDelay::new(Cycles(Rc::clone(&shared)), frequency);
    let joints = Angles::new(Bus(Rc::clone(&shared)), selects, delay, [4_096; 3]);
    (shared, joints)
}

/// The clocks of the boards that read angles: 150 MHz of the Pico 2, 600 MHz of the Teensy, and a core so slow that a
/// look at the counter alone is long.
const CLOCKS_OF_BOARDS: [(u32, u64); 4] = [(150_000_000, 1), (150_000_000, 6), (600_000_000, 2), (8_000_000, 10)];

#[test]
fn a_select_line_is_high_and_set_up_as_long_as_the_data_sheet_asks_at_every_boards_clock() {
    for (frequency, look) in CLOCKS_OF_BOARDS {
        let (shared, mut joints) = table(frequency, look);
        joints.start().unwrap();
        for turn in 0..200_i32 {
            for (joint, chip) in shared.borrow_mut().chips.iter_mut().enumerate() {
                chip.angle = (turn * 100 * (joint as i32 + 1)) as u16 & 0x3fff;
            }
            let counts = joints.read().unwrap();
            assert_eq!(counts, [1, 2, 3].map(|joint| Counts(turn * 100 * joint)));
        }
        let [high, set_up, hold] = shared.borrow().least;
        assert!(high >= HIGH && set_up >= SET_UP && hold >= HOLD, "{frequency} Hz: {high} {set_up} {hold} ns");
        // And not much longer: all three are read within 30 µs at 150 MHz.
        assert!(frequency < 100_000_000 || (high < 600.0 && set_up < 600.0 && hold < 700.0), "{high} {set_up} {hold}");
    }
}

#[test]
fn a_delay_is_never_short_by_a_cycle() {
    for frequency in [150_000_000_u32, 170_000_000, 600_000_000, 8_000_000] {
        for nanoseconds in [1_u32, 50, 100, 350, 351, 1_000, 10_000_000, u32::MAX] {
            // The last full count before the end, and the one that may be over already: both lie beyond it.
            let counts = u64::from(cycles(nanoseconds, frequency));
            let exact = u64::from(nanoseconds) * u64::from(frequency);
            assert!((counts - 1) * 1_000_000_000 >= exact, "{nanoseconds} ns at {frequency} Hz: {counts}");
            assert!((counts - 2) * 1_000_000_000 < exact, "{nanoseconds} ns at {frequency} Hz: {counts}");
        }
    }
}

#[test]
fn nothing_is_sent_before_the_sensors_have_powered_up_and_a_slow_one_is_waited_for() {
    let (shared, mut joints) = table(150_000_000, 6);
    // 40 ms later than its data sheet says: the supply came up slowly.
    shared.borrow_mut().chips[1].ready_at += 6_000_000;
    joints.start().unwrap();
    assert!(shared.borrow().cycles >= 7_500_000);

    // The first frame comes no earlier than 10 ms after power-on.
    let (shared, mut joints) = table(150_000_000, 6);
    shared.borrow_mut().chips.iter_mut().for_each(|chip| chip.ready_at = 1_500_000);
    joints.start().unwrap();
    // Three frames each: not one was in vain.
    assert_eq!(shared.borrow().frames, 9);
}

#[test]
fn a_sensor_that_is_not_there_is_said_so_within_a_fifth_of_a_second_and_found_when_it_comes() {
    let (shared, mut joints) = table(150_000_000, 6);
    shared.borrow_mut().chips[2].is_there = false;
    assert_eq!(joints.start(), Err(BadFrame::Absent));
    assert!(shared.borrow().cycles < 150_000_000 / 5);
    assert_eq!(joints.read(), Err(BadFrame::Absent));
    shared.borrow_mut().chips[2].is_there = true;
    assert!(joints.read().is_ok());
}

#[test]
fn a_sensor_whose_data_line_dies_is_absent_whichever_level_it_reads_then() {
    for silence in [0, u16::MAX] {
        for angle in [0, 8, 1_000] {
            let (shared, mut joints) = table(150_000_000, 6);
            for chip in &mut shared.borrow_mut().chips {
                (chip.silence, chip.angle) = (silence, angle);
            }
            joints.start().unwrap();
            assert_eq!(joints.read(), Ok([Counts(i32::from(angle)); 3]));
            shared.borrow_mut().chips[1].is_there = false;
            for _ in 0..10 {
                assert_eq!(joints.read(), Err(BadFrame::Absent), "{silence:#x} at {angle}");
            }
        }
    }
}

#[test]
fn a_joint_that_rests_at_angle_zero_is_read_there() {
    let (shared, mut joints) = table(150_000_000, 6);
    joints.start().unwrap();
    for angle in [5, 3, 0, 0, 0, 0, 0, 2, 0] {
        shared.borrow_mut().chips[0].angle = angle;
        assert_eq!(joints.read(), Ok([Counts(i32::from(angle)), Counts(0), Counts(0)]));
    }
    // Where one answers, and another one has died, the dead one is found.
    shared.borrow_mut().chips[2].silence = 0;
    shared.borrow_mut().chips[2].is_there = false;
    assert_eq!(joints.read(), Err(BadFrame::Absent));
}

#[test]
fn a_command_that_arrives_damaged_costs_one_reading_and_its_flag_is_cleared_in_the_next() {
    let (shared, mut joints) = table(150_000_000, 6);
    joints.start().unwrap();
    joints.read().unwrap();
    for joint in 0..3 {
        shared.borrow_mut().chips[joint].deaf = 1;
        assert_eq!(joints.read(), Err(BadFrame::Damaged), "joint {joint}");
        assert_eq!(joints.read(), Ok([Counts(0); 3]), "joint {joint}");
    }
}

#[test]
fn a_jump_that_no_hand_makes_is_refused_and_measured_against_the_last_good_one() {
    let (shared, mut joints) = table(150_000_000, 6);
    joints.start().unwrap();
    joints.read().unwrap();
    shared.borrow_mut().chips[0].angle = 6_000;
    assert_eq!(joints.read(), Err(BadFrame::Jumped));
    shared.borrow_mut().chips[0].angle = 300;
    assert_eq!(joints.read(), Ok([Counts(300), Counts(0), Counts(0)]));
}
