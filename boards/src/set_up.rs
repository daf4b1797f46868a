//! A device that is being set up: one motor at a time, gently, while somebody holds a key.

use crate::confirming::Confirming;
use crate::led::Led;
use crate::{Board, Hold, Interlock, Mailbox, NotObeyed, Panel};
use palpate::commission::{JogLimits, JogLimitsError, JogRefusal, JogState, Jogging, Wiring};
use palpate::device::drive::{Feed, Field, Supply};
use palpate::device::{Counts, Device, Duty};
use palpate::wire::{Marked, Reading, hold};

/// Ticks after which passed marks are reported again.
const AGAIN: u32 = 500;

/// The limits of a jog, whatever the host asks for. They lie in the device's own flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JogSettings {
    /// The maximum fraction of a motor's full duty of torque; half at most, and never more than what each motor bears
    /// continuously, where the loop's guard knows that. Of a motor whose field is led, a share of the voltage.
    pub share: f32,
    /// The maximum speed of any joint, rad/s, by the encoders as the device believes they are: which is on which joint
    /// is not known yet, so this is what the coarsest may go, and a finer one less.
    pub rate: f32,
    /// How far any joint may go while the key is held, rad; with a finer encoder less, as above.
    pub travel: f32,
    /// Seconds without a frame after which the key counts as let go; half a second at most.
    pub patience: f32,
    /// Ticks in which the field of a motor with three phases is led round an electrical turn, 64 at least: on for a
    /// duty above zero, back for one below. `None` for motors without phases; one that has them is then not driven.
    pub turn_ticks: Option<u32>,
}

impl JogSettings {
    /// Four tenths of full duty, for a third is what it takes to lift the plate of a Novint Falcon with one leg: 2 N at
    /// the probe of a WoodenHaptics; 4 rad/s; 1 rad; a tenth of a second.
    pub const DEFAULT: Self = Self { share: 0.4, rate: 4.0, travel: 1.0, patience: 0.1, turn_ticks: None };

    /// The limits in counts and duties.
    fn limits<K, const JOINTS: usize>(
        &self,
        device: &Device<K, JOINTS>,
        continuous: [f32; JOINTS],
    ) -> JogLimits<JOINTS> {
        // Of the coarsest encoder: nothing is known yet of which is where, and on any other joint it is less.
        let coarsest = device.encoders.iter().map(|encoder| encoder.radians_per_count.abs()).fold(0.0, f32::max);
        // Nor which motor is where, and no heat is counted: the limit is the minimum of the continuous limits. Of a
        // field that is led it is the voltage at rest.
        let mut most = Duty::from_fraction(self.share);
        for (continuous, feed) in continuous.into_iter().zip(&device.feeds) {
            let borne = Duty::from_fraction(continuous);
            let borne = if self.turn_ticks.is_some() { feed.command(borne, 0.0, Supply::UNMEASURED) } else { borne };
            most = Duty(most.0.min(borne.0));
        }
        JogLimits {
            max_duty: [most; JOINTS],
            max_speed_counts_per_s: self.rate / coarsest,
            // The cast saturates.
            max_travel_counts: (self.travel / coarsest) as u32,
            patience_s: self.patience,
        }
    }
}

/// The loop in the place of the servo, which is stopped for good: only a reset leads back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SetUp<const JOINTS: usize> {
    jogging: Jogging<JOINTS>,
    state: JogState<JOINTS>,
    /// The command of each output's drive for a duty of torque of the motor that the device believes is there.
    feeds: [Feed; JOINTS],
    supply: Supply,
    /// The field, of motors that have one.
    led: Option<Led>,
    counts: [Counts; JOINTS],
    /// The last index mark of each input, and how often each came.
    marked: Marked,
    /// Ticks until that is reported again: a host may have missed it.
    tells_in: u32,
    /// Whether the enable input asks for it.
    enable: bool,
    hold: u8,
    /// The host said stop: nothing moves any more.
    is_stopped: bool,
}

impl<const JOINTS: usize> SetUp<JOINTS> {
    /// Of a device with these continuous limits, fractions of full duty, in a loop of `rate` Hz.
    ///
    /// # Errors
    /// The limit that is refused: nothing will be jogged.
    pub fn try_new<K>(
        settings: &JogSettings,
        device: &Device<K, JOINTS>,
        wiring: &Wiring<JOINTS>,
        continuous: [f32; JOINTS],
        rate: f32,
    ) -> Result<Self, JogLimitsError> {
        let jogging = Jogging::try_new(settings.limits(device, continuous), rate)?;
        let led = match settings.turn_ticks.map(Led::try_new) {
            Some(None) => return Err(JogLimitsError::Speed),
            Some(led) => led,
            None => None,
        };
        let (state, counts, feeds) = (JogState::default(), [Counts(0); JOINTS], wiring.outputs(device.feeds));
        Ok(Self {
            jogging,
            state,
            feeds,
            supply: Supply::UNMEASURED,
            led,
            counts,
            marked: Marked::default(),
            tells_in: AGAIN,
            enable: false,
            hold: 0,
            is_stopped: false,
        })
    }

    /// A tick up to the motors, whose duties this leaves with the board.
    #[inline]
    pub fn tick<B: Board<JOINTS>>(
        &mut self,
        board: &mut B,
        (holds, interlock, confirming): (&mut Hold, &mut Interlock, &mut Confirming),
        panel: &Panel,
        mailbox: &Mailbox,
    ) {
        self.supply.tick();
        if let Some(volts) = panel.supply {
            self.supply.measured(volts);
        }
        let mut verdict = holds.next(panel, self.state.is_live());
        // A key held meanwhile moves nothing: enable is locked.
        let outcome = confirming.next(interlock);
        verdict.hold |= confirming.holds(outcome, mailbox.writing(), (interlock, !self.state.is_live()), true);
        self.enable = interlock.next(panel.enable, verdict.hold != 0) && !self.is_stopped;
        let stopped = if self.is_stopped { hold::STOP } else { 0 };
        self.hold = verdict.hold | stopped | if interlock.is_locked() { hold::RELEASE_FIRST } else { 0 };
        if verdict.is_drive_fault {
            self.jogging.refuse(&mut self.state, JogRefusal::Drive);
        }
        let counts = board.read().ok();
        self.counts = counts.unwrap_or(self.counts);
        if counts.is_some() {
            self.look_for_marks(board.marks(), mailbox);
        }
        if let Some(jog) = mailbox.take_jog() {
            self.jogging.command(&mut self.state, jog);
        }
        self.jogging.tick(&mut self.state, counts, self.enable);
        self.output(board);
    }

    /// Tells of marks that were passed, and again now and then.
    fn look_for_marks(&mut self, marks: [Option<Counts>; JOINTS], mailbox: &Mailbox) {
        let places = self.marked.counts.iter_mut().zip(&mut self.marked.passes);
        for ((counts, passes), mark) in places.zip(marks) {
            if let Some(Counts(mark)) = mark {
                (*counts, *passes) = (mark, passes.wrapping_add(1));
                self.tells_in = 0;
            }
        }
        self.tells_in = match self.tells_in.checked_sub(1) {
            Some(left) => left,
            None => {
                if self.marked != Marked::default() {
                    mailbox.tell_marked(&self.marked);
                }
                AGAIN
            }
        };
    }

    /// The host says stop: until the next reset, as everywhere.
    pub const fn stop(&mut self) {
        self.is_stopped = true;
    }

    /// The tick took too long.
    #[cold]
    pub fn overran<B: Board<JOINTS>>(&mut self, board: &mut B) {
        self.jogging.refuse(&mut self.state, JogRefusal::Late);
        self.output(board);
    }

    /// Whether a motor is driven.
    pub const fn is_live(&self) -> bool {
        self.state.is_live()
    }

    /// The user's inputs that keep the motors off.
    pub const fn hold(&self) -> u8 {
        self.hold
    }

    /// The message of a tick.
    pub fn reading(&self, tick: u32) -> Reading {
        let mut reading = Reading {
            tick,
            number: self.state.number(),
            live: self.state.is_live(),
            enable: self.enable,
            refusal: self.state.refusal().map_or(0, JogRefusal::code),
            hold: self.hold,
            ..Reading::default()
        };
        for (told, Counts(count)) in reading.counts.iter_mut().zip(self.counts) {
            *told = count;
        }
        for (told, Duty(duty)) in reading.duties.iter_mut().zip(self.state.duties()) {
            *told = duty;
        }
        if let (Some(led), 1 | 2) = (&self.led, JOINTS) {
            reading.counts[2] = led.gone();
        }
        reading
    }

    fn drive<B: Board<JOINTS>>(&mut self, board: &mut B) -> Result<(), NotObeyed> {
        let mut duties = self.state.duties();
        if let Some(led) = &mut self.led {
            // One motor at a time: the others have no duty, wherever their fields are.
            duties.into_iter().for_each(|duty| led.on(duty));
            board.aim([Field::at_rest(led.angle()); JOINTS]);
            // The sign says which way the field goes, not which way it points. It is led by a fraction of the voltage.
            duties = duties.map(|Duty(duty)| Duty(duty.saturating_abs()));
        } else {
            // As of a joint at rest: nothing is known yet of which encoder is whose, and back-EMF then brakes.
            for (duty, feed) in duties.iter_mut().zip(&self.feeds) {
                *duty = feed.command(*duty, 0.0, self.supply);
            }
        }
        board.drive(duties)
    }

    fn output<B: Board<JOINTS>>(&mut self, board: &mut B) {
        let obeyed = if self.state.is_live() { self.drive(board) } else { board.release() };
        if obeyed.is_err() {
            self.jogging.refuse(&mut self.state, JogRefusal::Drive);
            // Release the drives that still respond.
            let _ = board.release();
        }
    }
}
