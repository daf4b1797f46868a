//! A line to the simulated device that loses frames and spoils bytes.

use palpate::wire::frame::{DELIMITER, Received, Receiver};
use palpate::wire::{DeviceMessage, HostMessage, Upload};
use palpate_link::{Device, Line, View};
use palpate_sim::simulated::{Hand, Kind, Simulated};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use std::io;
use std::time::{Duration, Instant};

/// What is between a host and the simulated device.
pub struct Bad {
    pub device: Simulated,
    /// When it was switched on, by its own clock, and by that of the line.
    began: [Instant; 2],
    /// Answers to come that are lost, and orders and parts of uploads.
    pub lose_answers: u32,
    pub lose_orders: u32,
    /// After so many answers one is lost.
    pub lose_after: Option<u32>,
    /// Answers are kept for now, and come later.
    pub holds_answers: bool,
    held: Vec<u8>,
    /// After so many parts of uploads the first of them comes once more.
    pub stray_after: Option<u32>,
    begun: Vec<u8>,
    /// After so many parts of uploads all that follow are lost.
    pub dies_after: Option<u32>,
    /// Stops to come that are lost.
    pub lose_stops: u32,
    /// Of a million bytes, either way, so many are lost, and so many have a bit flipped.
    pub spoils: u32,
    /// Every order and part that was said, lost or not, by its number.
    pub numbers: Vec<u16>,
    random: Pcg64,
    told: Receiver<DeviceMessage>,
    /// A frame on its way to the host.
    frame: Vec<u8>,
}

/// Greets a simulated device over such a line, and waits until its enable input counts as released.
pub fn device(kind: Kind) -> Device<Bad> {
    over(Bad::new(kind, 1))
}

/// The same over a line of one's own.
pub fn over(line: Bad) -> Device<Bad> {
    let mut device = Device::over(line).unwrap();
    for_seconds(&mut device, 0.05);
    device
}

/// The same, felt: enabled, and the hand where it was.
pub fn running() -> (Device<Bad>, Hand) {
    let mut device = device(Kind::default());
    let hand = device.line().device.hand();
    for_seconds(&mut device, 0.1);
    hand.enables(true);
    for_seconds(&mut device, 0.5);
    (device, hand)
}

/// Lets time go by, and gives the view at its end.
pub fn for_seconds(device: &mut Device<Bad>, seconds: f32) -> View {
    let until = device.now() + Duration::from_secs_f32(seconds);
    while device.now() < until {
        device.view(Duration::from_millis(5)).unwrap();
    }
    device.view(Duration::from_millis(20)).unwrap()
}

impl Bad {
    pub fn new(kind: Kind, seed: u64) -> Self {
        let device = Simulated::new(kind).unwrap();
        Self {
            began: [device.now(); 2],
            device,
            lose_answers: 0,
            lose_orders: 0,
            lose_after: None,
            holds_answers: false,
            held: Vec::new(),
            stray_after: None,
            begun: Vec::new(),
            dies_after: None,
            lose_stops: 0,
            spoils: 0,
            numbers: Vec::new(),
            random: Pcg64::seed_from_u64(seed),
            told: Receiver::new(),
            frame: Vec::new(),
        }
    }

    /// The device is switched off and on, between two frames or in the middle of one.
    pub fn restart(&mut self, between: bool) {
        if between {
            (self.frame, self.told) = (Vec::new(), Receiver::new());
        } else {
            self.frame.push(1);
        }
        let now = self.now();
        self.device = self.device.reset(Kind::default()).unwrap();
        self.began = [self.device.now(), now];
    }

    /// What becomes of bytes on the way.
    fn spoil(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut left = Vec::new();
        for byte in bytes {
            let dice = self.random.next_u32() % 1_000_000;
            if dice < self.spoils {
                left.push(byte ^ 1 << (dice % 8));
            } else if dice >= 2 * self.spoils {
                left.push(*byte);
            }
        }
        left
    }

    /// A part of an upload that comes once more, much later.
    fn stray(&mut self, bytes: &[u8]) -> io::Result<()> {
        let mut receiver = Receiver::<HostMessage>::new();
        let heard = bytes.iter().find_map(|byte| receiver.feed(*byte));
        let Some(Received::Message(HostMessage::Upload { part, .. })) = heard else { return Ok(()) };
        if matches!(part, Upload::Begin { .. }) {
            self.begun = bytes.to_vec();
        }
        if self.stray_after == Some(0) {
            self.device.send(&self.begun)?;
        }
        self.stray_after = self.stray_after.and_then(|left| left.checked_sub(1));
        Ok(())
    }

    /// Whether an answer is lost.
    fn loses_answer(&mut self) -> bool {
        if self.lose_after == Some(0) {
            self.lose_after = None;
            return true;
        }
        self.lose_after = self.lose_after.map(|left| left - 1);
        let is_lost = self.lose_answers > 0;
        self.lose_answers = self.lose_answers.saturating_sub(1);
        is_lost
    }

    /// Whether a frame of the host's is lost.
    fn loses(&mut self, bytes: &[u8]) -> bool {
        let mut receiver = Receiver::<HostMessage>::new();
        let heard = bytes.iter().find_map(|byte| receiver.feed(*byte));
        let left = match heard {
            Some(Received::Message(HostMessage::Command { number, .. } | HostMessage::Upload { number, .. })) => {
                self.numbers.push(number);
                if matches!(heard, Some(Received::Message(HostMessage::Upload { .. })))
                    && let Some(left) = &mut self.dies_after
                {
                    let is_dead = *left == 0;
                    *left = left.saturating_sub(1);
                    return is_dead;
                }
                &mut self.lose_orders
            }
            Some(Received::Message(HostMessage::Stop)) => &mut self.lose_stops,
            _ => return false,
        };
        let is_lost = *left > 0;
        *left = left.saturating_sub(1);
        is_lost
    }
}

impl Line for Bad {
    fn name(&self) -> String {
        "a bad line".to_owned()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        if self.loses(bytes) {
            return Ok(());
        }
        self.stray(bytes)?;
        let bytes = self.spoil(bytes);
        self.device.send(&bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let came = self.device.receive(buffer, wait)?;
        let mut left = if self.holds_answers { Vec::new() } else { std::mem::take(&mut self.held) };
        for byte in &buffer[..came] {
            self.frame.push(*byte);
            let told = self.told.feed(*byte);
            if *byte != DELIMITER {
                continue;
            }
            let frame = std::mem::take(&mut self.frame);
            if matches!(told, Some(Received::Message(DeviceMessage::Answer(_)))) {
                if self.holds_answers {
                    self.held.extend(&frame);
                    continue;
                }
                if self.loses_answer() {
                    continue;
                }
            }
            left.extend(self.spoil(&frame));
        }
        // A frame is in the buffer once its end has come, and no longer than what the buffer held before and now.
        let fits = left.len().min(buffer.len());
        buffer[..fits].copy_from_slice(&left[..fits]);
        Ok(fits)
    }

    fn now(&self) -> Instant {
        self.began[1] + (self.device.now() - self.began[0])
    }
}
