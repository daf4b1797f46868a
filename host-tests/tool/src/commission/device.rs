//! A device that is being set up, at the other end of a line.

use anyhow::{Context, bail};
use palpate::commission::{Jog, JogRefusal, JointCalibration, KEY};
use palpate::wire::frame::{self, MAX_FRAME, Received, Receiver};
use palpate::wire::{Answer, Calibrated, DeviceMessage, HostMessage, Marked, PROTOCOL, Reading, hold};
use std::collections::VecDeque;

/// Ticks of a step: a fiftieth of a second at 4 kHz.
const STEP: u32 = 80;
/// How often a line may have nothing to say before the device counts as gone.
const SILENCES: u32 = 200;
/// How often a device is asked to be set up, and how often the line is looked at after each.
const ASKED: u32 = 40;
const LOOKS: u32 = 10;
/// The same while a person is to confirm it, which the device waits half a minute for.
const CONFIRMED: u32 = 350;
/// For how long a simulated hand holds the button to confirm, ticks: 0.6 s at 4 kHz.
const HELD: u32 = 2_400;
/// Maximum wait for the release of the enable button, in fiftieths of a second.
const RELEASES: u32 = 1_500;

/// The bytes between this program and a device.
pub trait Line {
    /// Sends all of it.
    ///
    /// # Errors
    /// A line that broke.
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()>;

    /// Returns the received bytes; waits for at most a hundredth of a second. A simulated device runs for a moment
    /// meanwhile.
    ///
    /// # Errors
    /// As [`Self::send`].
    fn receive(&mut self) -> anyhow::Result<Vec<u8>>;

    /// Lets sent bytes arrive where the device's time stands still meanwhile: that of an emulated board, which a loaded
    /// machine delivers late. `behind` is how many messages the device has not seen yet.
    fn settle(&mut self, _behind: u32) {}

    /// Presses the enable button or releases it, where this program can: one that is simulated. Whether it did.
    ///
    /// # Errors
    /// As [`Self::send`].
    fn press(&mut self, _: bool) -> anyhow::Result<bool> {
        Ok(false)
    }

    /// Resets the device if this program can, as it can a simulated one; returns whether it did.
    ///
    /// # Errors
    /// As [`Self::send`].
    fn reset(&mut self) -> anyhow::Result<bool> {
        Ok(false)
    }
}

/// The key without which no motor moves.
pub trait Key {
    /// Whether it is held now.
    fn is_held(&mut self) -> bool;
}

/// The key of a simulated hand.
#[derive(Clone, Copy, Debug, Default)]
pub struct KeyHeld;

impl Key for KeyHeld {
    fn is_held(&mut self) -> bool {
        true
    }
}

/// No key: nothing can be driven.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoKey;

impl Key for NoKey {
    fn is_held(&mut self) -> bool {
        false
    }
}

/// A device at its line.
pub struct Device {
    line: Box<dyn Line>,
    key: Box<dyn Key>,
    receiver: Receiver<DeviceMessage>,
    /// Received bytes that are not processed yet.
    bytes: VecDeque<u8>,
    /// Number of the last jog sent.
    number: u32,
    last: Reading,
    /// Its report on its calibration; `None` if it cannot store one.
    calibrated: Option<Calibrated>,
    /// Index marks passed since its last reset.
    marked: Marked,
    /// To the last that was to be kept.
    answer: Option<Answer>,
    /// The tick and the holds that it reported last.
    holds: Option<(u32, u8)>,
    /// The tick at which a person was asked to confirm.
    confirms: Option<u32>,
    /// How often in a row nothing came.
    silent: u32,
}

impl Device {
    /// Asks the device to let go of its servo and be set up.
    ///
    /// # Errors
    /// A device that does not answer so.
    pub fn connect(line: Box<dyn Line>, key: Box<dyn Key>) -> anyhow::Result<Self> {
        let (receiver, bytes) = (Receiver::new(), VecDeque::new());
        let last = Reading::default();
        let mut device = Self {
            line,
            key,
            receiver,
            bytes,
            number: 0,
            last,
            calibrated: None,
            marked: Marked::default(),
            answer: None,
            holds: None,
            confirms: None,
            silent: 0,
        };
        device.set_up()?;
        Ok(device)
    }

    /// Greets it, hears how it is calibrated, and has it set up.
    fn set_up(&mut self) -> anyhow::Result<()> {
        for asked in 0..CONFIRMED {
            if asked >= ASKED && self.confirms.is_none() {
                break;
            }
            self.send(HostMessage::Hello { protocol: PROTOCOL })?;
            self.send(HostMessage::SetUp)?;
            for _ in 0..LOOKS {
                if let Some(reading) = self.look()? {
                    (self.number, self.last) = (reading.number, reading);
                    return Ok(());
                }
            }
        }
        bail!(
            "the device does not answer: it lets itself be set up only while its motors are off and its enable button \
             is released"
        )
    }

    /// Its report on its calibration since its last reset; `None` if it cannot store one.
    pub const fn calibrated(&self) -> Option<Calibrated> {
        self.calibrated
    }

    /// Stores a calibration in the device's flash, or deletes the stored one; in effect from its next reset on.
    ///
    /// # Errors
    /// A refusal by the device, an enable button that is not released, a broken line.
    pub fn keep(&mut self, joints: Option<[JointCalibration; 3]>) -> anyhow::Result<()> {
        for _ in 0..RELEASES {
            // The key is let go.
            if !self.step(None)?.enable {
                break;
            }
        }
        // A release lasts.
        self.step(None)?;
        self.step(None)?;
        // Another number than any before, for the device remembers the last.
        let number = self.last.tick as u16;
        self.answer = None;
        for asked in 0..CONFIRMED {
            if asked >= ASKED && self.confirms.is_none() {
                break;
            }
            self.send(HostMessage::Calibrate { number, joints })?;
            for _ in 0..LOOKS {
                self.look()?;
                if let Some(Answer { refused, .. }) = self.answer.take_if(|answer| answer.number == number) {
                    return refused.map_or(Ok(()), |refused| Err(anyhow::anyhow!("{refused}")));
                }
            }
        }
        bail!("the device does not say whether the calibration is kept")
    }

    /// Resets a simulated device and sets it up again; returns whether that was possible.
    ///
    /// # Errors
    /// As [`Self::connect`]'s.
    pub fn reset(&mut self) -> anyhow::Result<bool> {
        let is_reset = self.line.reset()?;
        if is_reset {
            (self.calibrated, self.marked, self.number) = (None, Marked::default(), 0);
            (self.receiver, self.last, self.holds) = (Receiver::new(), Reading::default(), None);
            self.bytes.clear();
            self.set_up()?;
        }
        Ok(is_reset)
    }

    /// Index marks passed since its last reset, as reported.
    pub const fn marked(&self) -> Marked {
        self.marked
    }

    /// The last reading.
    pub const fn last(&self) -> Reading {
        self.last
    }

    /// Runs for a fiftieth of a second: with the key held this motor at this duty, else without current.
    ///
    /// The reading at its end. It is not live if the key was let go, if the enable button is, or if the device refused.
    ///
    /// # Errors
    /// A line that broke or fell silent.
    pub fn step(&mut self, jog: Option<(u8, i16)>) -> anyhow::Result<Reading> {
        self.step_telling(jog, |_| ())
    }

    /// As [`Self::step`]; passes every reading to `tell`.
    ///
    /// # Errors
    /// As [`Self::step`]'s.
    pub fn step_telling(&mut self, jog: Option<(u8, i16)>, mut tell: impl FnMut(&Reading)) -> anyhow::Result<Reading> {
        let began = self.last.tick;
        let mut first = None;
        loop {
            // A key that was let go is let go for the whole step.
            let held = jog.filter(|_| self.key.is_held());
            let (motor, duty) = held.unwrap_or_default();
            self.number = self.number.wrapping_add(1);
            let key = if held.is_some() { KEY } else { 0 };
            self.send(HostMessage::Jog(Jog { number: self.number, key, motor, duty }))?;
            let first = *first.get_or_insert(self.number);
            let reading = self.next()?;
            tell(&reading);
            let is_heard = reading.number.wrapping_sub(first) as i32 >= 0;
            if is_heard && (reading.tick.wrapping_sub(began) >= STEP || held.is_some() != jog.is_some()) {
                return Ok(reading);
            }
        }
    }

    /// Waits until the device has seen the enable button released.
    ///
    /// # Errors
    /// A line that broke, or a button that nobody releases.
    pub fn wait_for_release(&mut self) -> anyhow::Result<()> {
        for _ in 0..RELEASES {
            let reading = self.step(None)?;
            if reading.hold & hold::RELEASE_FIRST == 0 && !reading.enable {
                return Ok(());
            }
        }
        bail!("the enable button was not released for half a minute{}", said(&self.last))
    }

    /// Waits until nothing but the key is missing.
    ///
    /// # Errors
    /// A line that broke, or an enable button that nobody presses, with what keeps the motors off.
    pub fn wait_for_enable(&mut self) -> anyhow::Result<()> {
        for _ in 0..1_500 {
            if self.step(None)?.enable {
                return Ok(());
            }
        }
        bail!("the enable button was not pressed for half a minute{}", said(&self.last))
    }

    /// The next reading.
    fn next(&mut self) -> anyhow::Result<Reading> {
        for _ in 0..SILENCES {
            if let Some(reading) = self.look()? {
                self.last = reading;
                return Ok(reading);
            }
        }
        bail!("the device fell silent")
    }

    /// The newest reading that has come, if any.
    fn look(&mut self) -> anyhow::Result<Option<Reading>> {
        let came = self.line.receive()?;
        self.silent = if came.is_empty() { self.silent + 1 } else { 0 };
        self.bytes.extend(came);
        let mut newest = None;
        let mut holds = self.holds;
        for byte in self.bytes.drain(..) {
            match self.receiver.feed(byte) {
                Some(Received::Message(DeviceMessage::Reading(reading))) => {
                    newest = Some(reading);
                    holds = Some((reading.tick, reading.hold));
                }
                Some(Received::Message(DeviceMessage::Record(record))) => holds = Some((record.tick, record.hold)),
                Some(Received::Message(DeviceMessage::View(view))) => holds = Some((view.tick, view.hold)),
                Some(Received::Message(DeviceMessage::Calibrated(calibrated))) => self.calibrated = Some(calibrated),
                Some(Received::Message(DeviceMessage::Marked(marked))) => self.marked = marked,
                Some(Received::Message(DeviceMessage::Answer(answer))) => self.answer = Some(answer),
                _ => {}
            }
        }
        self.holds = holds;
        // A key that is held must not seem let go because its messages are on their way.
        let unseen = self.number.wrapping_sub(newest.unwrap_or(self.last).number);
        self.line.settle(unseen.max(self.silent));
        self.confirm()?;
        Ok(newest)
    }

    /// Has a person confirm what the device waits for; a simulated hand does it.
    fn confirm(&mut self) -> anyhow::Result<()> {
        let Some((tick, holds)) = self.holds else { return Ok(()) };
        match (holds & hold::CONFIRM != 0, self.confirms) {
            (true, None) => {
                if !self.line.press(true)? {
                    println!("To confirm, hold the device's enable button for half a second, then release it.");
                }
                self.confirms = Some(tick);
            }
            (true, Some(since)) if tick.wrapping_sub(since) > HELD => {
                self.line.press(false)?;
            }
            (false, Some(_)) => self.confirms = None,
            _ => {}
        }
        Ok(())
    }

    fn send(&mut self, command: HostMessage) -> anyhow::Result<()> {
        let mut buffer = [0; MAX_FRAME];
        let frame = frame::pack(&command, &mut buffer).context("a command is too long")?;
        self.line.send(frame)
    }
}

/// The reason why the motors are off according to a reading, as the rest of a sentence.
pub(crate) fn said(reading: &Reading) -> String {
    let mut reasons: Vec<String> = hold::reasons(reading.hold).map(str::to_owned).collect();
    reasons.extend(JogRefusal::from_code(reading.refusal).map(|refusal| refusal.to_string()));
    if reasons.is_empty() { String::new() } else { format!(": {}", reasons.join(", ")) }
}
