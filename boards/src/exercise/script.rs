//! Sensor readings and events: straight strokes between random places of the joints, and now and then harm.

use palpate::device::{Counts, Encoder};
use palpate::servo::{Event, Input, ResetReason};

use super::random::Random;

/// Fastest stroke, counts a tick: below what a hand does on any of the devices.
const FASTEST: u32 = 8;
/// One stroke in this many is harmed.
const HARMED: u32 = 4;

/// The fault in a stroke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Harm {
    Lost,
    Damaged,
    OutOfRange,
    Jump,
    Overrun,
    Drive,
    Homing,
    Stop,
    /// The host says nothing any more.
    Silence,
    /// The first joint's count stays.
    Stuck,
}

const HARMS: [Harm; 10] = [
    Harm::Lost,
    Harm::Damaged,
    Harm::OutOfRange,
    Harm::Jump,
    Harm::Overrun,
    Harm::Drive,
    Harm::Homing,
    Harm::Stop,
    Harm::Silence,
    Harm::Stuck,
];

const RESETS: [ResetReason; 6] = [
    ResetReason::PowerOn,
    ResetReason::Pin,
    ResetReason::Software,
    ResetReason::Watchdog,
    ResetReason::BrownOut,
    ResetReason::Unknown,
];

/// One tick of the script.
#[derive(Clone, Copy, Debug)]
pub struct Order {
    /// Start again before the tick.
    pub restart: Option<ResetReason>,
    /// Events to note before the tick.
    pub events: [Option<Event>; 2],
    /// The tick's input.
    pub input: Input<3>,
}

/// The script so far.
#[derive(Clone, Copy, Debug)]
pub struct Script {
    random: Random,
    /// Minimum count of each joint, and the number of counts.
    places: [(i32, u32); 3],
    from: [i32; 3],
    to: [i32; 3],
    length: u32,
    at: u32,
    enable: bool,
    harm: Option<(Harm, u32)>,
    restart: Option<ResetReason>,
}

impl Script {
    /// A script for joints with these encoders that stay within `reach`, radians.
    pub fn new(seed: u32, encoders: &[Encoder; 3], reach: [[f32; 2]; 3]) -> Self {
        let mut places = [(0, 0); 3];
        for ((place, encoder), ends) in places.iter_mut().zip(encoders).zip(reach) {
            let [a, b] = ends.map(|angle| ((angle - encoder.angle_at_zero_rad) / encoder.radians_per_count) as i32);
            *place = (a.min(b), a.abs_diff(b));
        }
        let mut script = Self {
            random: Random::new(seed),
            places,
            from: [0; 3],
            to: [0; 3],
            length: 0,
            at: 0,
            enable: true,
            harm: None,
            restart: Some(ResetReason::PowerOn),
        };
        script.to = script.anywhere();
        script
    }

    fn anywhere(&mut self) -> [i32; 3] {
        self.places.map(|(lowest, count)| lowest + self.random.below(count) as i32)
    }

    /// The next stroke starts where the last one ended.
    fn begin_stroke(&mut self) {
        if self.harm.is_some() {
            self.restart = RESETS.get(self.random.below(RESETS.len() as u32) as usize).copied();
        }
        self.from = self.to;
        self.to = self.anywhere();
        let mut longest = 0;
        for (from, to) in self.from.iter().zip(self.to) {
            longest = from.abs_diff(to).max(longest);
        }
        self.length = longest / (1 + self.random.below(FASTEST)) + 1;
        self.at = 0;
        self.enable = self.random.below(8) > 0;
        // A loop that a reset stopped for good gets its next reset after this stroke.
        let stopped = self.restart.is_some_and(|reset| reset.fault().is_some());
        let harmed = stopped || self.random.below(HARMED) == 0;
        let harm = HARMS.get(self.random.below(HARMS.len() as u32) as usize).copied();
        let when = self.random.below(self.length);
        self.harm = if harmed { harm.map(|harm| (harm, when)) } else { None };
    }

    /// The next tick.
    pub fn next_order(&mut self) -> Order {
        if self.at >= self.length {
            self.begin_stroke();
        }
        let mut counts = self.places_at(self.at);
        let mut input = None;
        let mut event = None;
        let mut alive = Some(Event::LinkAlive);
        if let Some((harm, when)) = self.harm {
            let now = self.at == when;
            match harm {
                Harm::Lost if now => input = Some(Input::Lost),
                Harm::Damaged if now => input = Some(Input::Damaged),
                Harm::OutOfRange if now => counts[2] = Counts(i32::MAX),
                Harm::Jump if now => counts[0].0 += 100,
                Harm::Overrun if now => event = Some(Event::Overrun),
                Harm::Drive if now => event = Some(Event::DriveFault),
                Harm::Homing if now => event = Some(Event::HomingRefused),
                Harm::Stop if now => event = Some(Event::Stop),
                Harm::Silence if self.at >= when => alive = None,
                Harm::Stuck if self.at >= when => counts[0] = self.places_at(when)[0],
                _ => {}
            }
        }
        let restart = self.restart.take();
        // Homing takes a few ticks.
        if self.at == 5 {
            event = event.or(Some(Event::Homed));
        }
        self.at += 1;
        Order {
            restart,
            events: [alive, event],
            input: input.unwrap_or(Input::Sensors { counts, enable: self.enable }),
        }
    }

    fn places_at(&self, at: u32) -> [Counts; 3] {
        let mut counts = [Counts(0); 3];
        for ((count, from), to) in counts.iter_mut().zip(self.from).zip(self.to) {
            let way = i64::from(to - from) * i64::from(at) / i64::from(self.length.max(1));
            *count = Counts(from + way as i32);
        }
        counts
    }
}
