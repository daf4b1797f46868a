//! The tick of a board.

use crate::acknowledging::Acknowledging;
use crate::confirming::{Asked, Confirming, Outcome};
use crate::light::is_lit;
use crate::mailbox::Plain;
use crate::set_up::SetUp;
use crate::{Board, Hold, Interlock, Mailbox, Panel, Settings, Verdict};
use palpate::commission::Wiring;
use palpate::device::Kinematics;
use palpate::math::Vec3;
use palpate::render::Feel;
use palpate::scene::{Commanded, SceneError};
use palpate::servo::{
    Deadline, Event, FrameBridge, Guard, Input, Output, PeriodWindow, ResetReason, Servo, ServoState, Surface,
};
use palpate::wire::telemetry::{Producer, Recorder};
use palpate::wire::{Answer, DIALS_HZ, Dial, MODES_HZ, Modes, Record, Refused, View, hold};

/// Where the loop finds its servo.
///
/// Give a `static` in it: then the compiler knows every number of body, device and settings, and leaves out what they
/// do not need.
pub trait Felt<const JOINTS: usize> {
    /// The surface.
    type Surface: Commanded + 'static;
    /// The mechanism of the device.
    type Mechanism: Kinematics<JOINTS> + 'static;
    /// The guard of motors and hand beyond the servo's own checks: on a real device, its protection. It measures no
    /// supply; the loop's own settings do.
    type Guard: Guard<JOINTS> + 'static;

    /// The servo.
    fn servo(&self) -> &Servo<'static, Self::Surface, Self::Mechanism, JOINTS, Self::Guard>;

    /// Which input and output of the board each joint is on. There is no default: a device whose wiring nobody stated
    /// would be driven by the wrong motors.
    fn wiring(&self) -> Wiring<JOINTS>;

    /// Whether a calibration is kept that the servo could not be made with: then no motor is driven.
    #[inline(always)]
    fn is_miscalibrated(&self) -> bool {
        false
    }
}

/// The servo's state between two ticks.
pub(crate) type State<F, const JOINTS: usize> = ServoState<
    JOINTS,
    <<F as Felt<JOINTS>>::Surface as Surface>::Witness,
    <<F as Felt<JOINTS>>::Guard as Guard<JOINTS>>::State,
>;

/// The loop of a board, which its timer's interrupt owns.
pub struct Bench<'a, F: Felt<JOINTS>, B, const JOINTS: usize> {
    felt: F,
    board: B,
    state: State<F, JOINTS>,
    hold: Hold,
    interlock: Interlock,
    /// The same for homing by hand, which no hold locks.
    by_hand: Interlock,
    bridge: FrameBridge<JOINTS>,
    deadline: Deadline,
    /// The start of the last tick; `None` before the first, and where this one need not come in time.
    began: Option<u32>,
    /// The time from it to the start of the next.
    window: PeriodWindow,
    recorder: Recorder<'a>,
    mailbox: &'a Mailbox,
    /// Of the loop, Hz.
    rate: u32,
    /// Ticks done, in whatever phase.
    ticks: u32,
    /// Ticks until a knob tells of its dial.
    dial_in: u32,
    /// The same of the modes.
    modes_in: u32,
    acknowledging: Acknowledging,
    confirming: Confirming,
    /// Takes the servo's place once the host asks for it; `None` where jogging is not offered.
    set_up: Option<SetUp<JOINTS>>,
    is_set_up: bool,
    /// Whether the link is watched: a host has said something, or commanded something where none is needed.
    is_host_heard: bool,
    needs_host: bool,
    /// Whether the drives were enabled in the last tick.
    drove: bool,
}

impl<'a, F: Felt<JOINTS>, B: Board<JOINTS>, const JOINTS: usize> Bench<'a, F, B, JOINTS> {
    /// A loop before its first tick, on a board whose motors are off. It reads the tables whole: do this before the
    /// watchdog runs.
    pub fn new(
        felt: F,
        board: B,
        settings: &Settings,
        reset: ResetReason,
        records: Producer<'a, Record>,
        mailbox: &'a Mailbox,
    ) -> Self {
        let rate = felt.servo().settings().rate_hz;
        Self {
            board,
            state: felt.servo().start_after(reset),
            hold: Hold::new(settings, rate),
            interlock: Interlock::new(rate),
            by_hand: Interlock::new(rate),
            bridge: FrameBridge::new(settings.bad_frames),
            deadline: Deadline::of_period(settings.clock as f32, rate),
            recorder: Recorder::new(records, settings.clock, settings.ticks_per_record),
            mailbox,
            // At least 1 Hz, and below 2³² by far.
            rate: rate as u32,
            ticks: 0,
            dial_in: 0,
            modes_in: 0,
            acknowledging: Acknowledging::new(rate),
            confirming: Confirming::new(rate),
            began: None,
            window: PeriodWindow::of_period(settings.clock as f32, rate),
            // Limits that make no sense jog nothing.
            set_up: settings.jog.and_then(|jog| {
                let (device, continuous) = (felt.servo().device(), felt.servo().guard().continuous());
                SetUp::try_new(&jog, device, &felt.wiring(), continuous, rate).ok()
            }),
            is_set_up: false,
            is_host_heard: !felt.servo().watches_link(),
            needs_host: settings.needs_host,
            drove: false,
            felt,
        }
    }

    /// One tick, from the timer's interrupt.
    #[inline]
    pub fn tick(&mut self) {
        let began = self.board.now();
        self.board.acknowledge();
        let is_late = self.begins_out_of_time(began);
        let panel = self.board.panel();
        self.listen(&panel);
        if self.is_set_up {
            return self.jog((began, is_late), &panel);
        }
        if is_late {
            self.felt.servo().note(&mut self.state, Event::Overrun);
        }
        if !self.drove && self.board.reads_enabled() {
            self.felt.servo().note(&mut self.state, Event::DriveFault);
        }
        if self.felt.servo().device().needs_supply()
            && let Some(volts) = panel.supply
        {
            // The cast saturates, and takes NaN for 0.
            self.felt.servo().note(&mut self.state, Event::Supply { millivolts: (volts * 1e3) as u32 });
        }
        let mut verdict = self.hold.next(&panel, matches!(self.state.output(), Output::Drive(_)));
        verdict.hold |= self.holds_for_host();
        if verdict.is_drive_fault {
            self.felt.servo().note(&mut self.state, Event::DriveFault);
        }
        let asks = self.interlock.next(panel.enable, verdict.hold != 0);
        // Homing by hand needs no motors: a device is homed and its encoders are looked at before their supply is on.
        let needs_no_motors = !self.state.homed() && !self.felt.servo().homing_drives();
        let homes = self.by_hand.next(panel.enable, self.confirming.is_asked()) && needs_no_motors;
        let enable = asks || homes;

        let input = match self.board.read() {
            Ok(counts) => {
                self.note_marks(enable);
                Input::Sensors { counts: self.felt.wiring().joints(counts), enable }
            }
            Err(bad) => bad.input(),
        };
        let input = self.bridge.input(self.felt.servo(), &self.state, input, enable);
        let was_homed = self.state.homed();
        // Applied below, from the state: a hold of this board withholds it.
        let _ = self.felt.servo().tick(&mut self.state, input);
        if !was_homed && self.state.homed() {
            // The press that asked for homing does not ask for force too.
            self.interlock.lock();
        }

        self.output(verdict);
        if self.overran(began) {
            if !is_late {
                self.felt.servo().note(&mut self.state, Event::Overrun);
            }
            self.output(verdict);
        }
        self.tell(began, verdict);
    }

    /// Whether a tick that starts now comes too late or too early after the one before: early, too, if the counter
    /// stands still. While flash is written, and in the tick after it, whatever reads flash may wait for it: the motors
    /// are off meanwhile.
    #[inline]
    fn begins_out_of_time(&mut self, began: u32) -> bool {
        let is_written = self.mailbox.writing().is_granted();
        let last = if is_written { None } else { self.began };
        self.began = if is_written { None } else { Some(began) };
        last.is_some_and(|last| !self.window.contains(last, began))
    }

    /// Whether a tick took too long. The next one, which had to wait for it, is then not late besides.
    #[inline]
    fn overran(&mut self, began: u32) -> bool {
        let is_over = self.deadline.overrun(began, self.board.now());
        if is_over {
            self.began = None;
        }
        is_over
    }

    /// Index marks that joints have passed, while the device is homed by hand: those that were passed while the button
    /// was up say nothing, for another mark may have been nearer then. No motor is driven for them.
    #[inline]
    fn note_marks(&mut self, enable: bool) {
        let marks = self.felt.wiring().joints(self.board.marks());
        for (joint, mark) in marks.into_iter().enumerate() {
            if let Some(counts) = mark.filter(|_| enable) {
                self.felt.servo().note(&mut self.state, Event::IndexPassed { joint, counts });
            }
        }
    }

    /// The state after the last tick.
    pub const fn state(&self) -> &State<F, JOINTS> {
        &self.state
    }

    /// Starts a knob with a feel that was kept, or changes nothing: before the first tick.
    ///
    /// # Errors
    /// The value that this device does not bear, or a surface that is no knob.
    pub fn restore(&mut self, feel: Feel) -> Result<(), SceneError> {
        self.felt.servo().restore(&mut self.state, feel)
    }

    /// The servo's place.
    pub const fn felt(&self) -> &F {
        &self.felt
    }

    /// The board.
    pub const fn board(&mut self) -> &mut B {
        &mut self.board
    }

    /// Bad frames bridged so far.
    pub const fn bridged(&self) -> u32 {
        self.bridge.total()
    }

    /// Takes the host's commands, and those of the stop button.
    #[inline]
    fn listen(&mut self, panel: &Panel) {
        let commands = self.mailbox.take();
        if commands.has(Plain::Alive) {
            self.is_host_heard |= self.needs_host;
            self.felt.servo().note(&mut self.state, Event::LinkAlive);
        }
        if commands.has(Plain::Stop) {
            self.felt.servo().note(&mut self.state, Event::Stop);
            self.confirming.cancel();
            if let Some(set_up) = &mut self.set_up {
                set_up.stop();
            }
        }
        if commands.has(Plain::SetUp) && self.may_be_set_up() {
            self.confirming.ask(Asked::SetUp);
        }
        if let Some(index) = commands.chosen() {
            self.felt.servo().note(&mut self.state, Event::Chosen { index });
        }
        if let Some((number, order)) = self.mailbox.take_order() {
            self.is_host_heard = true;
            let refused = if self.is_set_up {
                Some(Refused::SetUp)
            } else {
                self.felt.servo().apply(&mut self.state, &order).err().map(Refused::Command)
            };
            if let Some(feel) = self.felt.servo().own_feel(&self.state) {
                self.mailbox.tell_feel(&feel);
            }
            self.mailbox.put_answer(Answer { number, refused });
        }
        if commands.has(Plain::Acknowledge) && self.is_reset_pending() && self.interlock.is_released() {
            self.confirming.ask(Asked::Acknowledge);
        }
        if self.acknowledging.next(panel) {
            self.acknowledge();
        }
        // Whatever fault stood before it was acknowledged.
        if self.felt.is_miscalibrated() && self.state.fault().is_none() {
            self.felt.servo().note(&mut self.state, Event::CalibrationRefused);
        }
    }

    /// Somebody at the device has acknowledged a reset that is a fault.
    fn acknowledge(&mut self) {
        let was_fault = self.state.fault().is_some();
        self.felt.servo().note(&mut self.state, Event::Acknowledged);
        // If enable was held during the acknowledge, require a release first.
        if was_fault && self.state.fault().is_none() {
            self.interlock.lock();
            self.by_hand.lock();
        }
    }

    /// Whether the reset was a fault, and nobody has acknowledged it.
    #[inline]
    fn is_reset_pending(&self) -> bool {
        self.state.reset().fault().is_some_and(|fault| self.state.fault() == Some((fault, 0)))
    }

    /// The host wants to set the device up. Nobody is surprised by it: not while anything is driven, not while somebody
    /// holds the enable button, nor before a reset that is a fault has been acknowledged. The servo is stopped first,
    /// and that is latched, whatever else goes wrong.
    fn may_be_set_up(&self) -> bool {
        let is_quiet = self.is_quiet() && !self.is_reset_pending() && !self.mailbox.writing().is_granted();
        self.set_up.is_some() && !self.is_set_up && is_quiet
    }

    /// And a person has confirmed it.
    fn begin_to_set_up(&mut self) {
        if !self.may_be_set_up() {
            return;
        }
        self.felt.servo().note(&mut self.state, Event::Stop);
        self.is_set_up = true;
        self.interlock.lock();
        // Discard earlier jog commands.
        let _ = self.mailbox.take_jog();
    }

    /// Nothing is driven, and nobody asks for it: one sample of a button that chatters does not say so.
    fn is_quiet(&self) -> bool {
        matches!(self.state.output(), Output::Off) && self.interlock.is_released()
    }

    /// Holds for the host's sake: a required host was never heard, or flash is being written.
    #[inline]
    fn holds_for_host(&mut self) -> u8 {
        let mut holds = 0;
        if !self.is_host_heard {
            // Nothing was lost that was never there.
            self.felt.servo().note(&mut self.state, Event::LinkAlive);
            holds |= if self.needs_host { hold::NO_HOST } else { 0 };
        }
        let outcome = self.confirming.next(&self.interlock);
        match outcome {
            Some(Outcome::Confirmed(Asked::SetUp)) => {
                self.begin_to_set_up();
                // The servo that was just stopped damps nothing in its last tick.
                holds |= hold::CONFIRM;
            }
            Some(Outcome::Confirmed(Asked::Acknowledge)) => self.acknowledge(),
            _ => {}
        }
        let is_off = matches!(self.state.output(), Output::Off);
        holds | self.confirming.holds(outcome, self.mailbox.writing(), (&self.interlock, is_off), false)
    }

    /// Whether a person is asked to hold the enable button, and to release it.
    pub const fn asks_to_confirm(&self) -> bool {
        self.confirming.is_asked()
    }

    /// A tick of a device that is being set up. A function of its own: it leaves the fastest memory to the servo's tick.
    #[inline(never)]
    fn jog(&mut self, (began, is_late): (u32, bool), panel: &Panel) {
        let Some(set_up) = &mut self.set_up else { return };
        // A line that stays enabled ends commissioning.
        if !set_up.is_live() && self.board.reads_enabled() {
            set_up.stop();
        }
        if is_late {
            set_up.overran(&mut self.board);
        }
        let supervisors = (&mut self.hold, &mut self.interlock, &mut self.confirming);
        set_up.tick(&mut self.board, supervisors, panel, self.mailbox);
        if self.overran(began)
            && let Some(set_up) = &mut self.set_up
        {
            set_up.overran(&mut self.board);
        }
        let Some(set_up) = &self.set_up else { return };
        self.board.show(is_lit(self.ticks, self.rate, set_up.is_live(), false, set_up.hold() != 0));
        self.ticks = self.ticks.wrapping_add(1);
        self.mailbox.tell_reading(&set_up.reading(self.ticks));
        self.mailbox.tell_ticks(self.ticks);
    }

    /// Whether the motors are driven: not while something holds, and not even to damp before the enable input has been
    /// seen released and a reset that is a fault has been acknowledged.
    #[inline]
    fn drives(&self, verdict: Verdict) -> bool {
        let may = verdict.hold == 0 && self.interlock.was_open() && !self.is_reset_pending();
        may && matches!(self.state.output(), Output::Drive(_))
    }

    /// Gives the motors what the state says, as far as they may be driven.
    #[inline]
    fn output(&mut self, verdict: Verdict) {
        if let Some(fields) = self.felt.servo().fields(&self.state) {
            self.board.aim(self.felt.wiring().outputs(fields));
        }
        let obeyed = match self.state.output() {
            Output::Drive(duties) if self.drives(verdict) => {
                self.drove = true;
                self.board.drive(self.felt.wiring().outputs(duties))
            }
            Output::Drive(_) | Output::Off => {
                self.drove = false;
                self.board.release()
            }
        };
        if obeyed.is_err() {
            self.felt.servo().note(&mut self.state, Event::DriveFault);
            // Release the drives that still respond.
            self.drove = false;
            let _ = self.board.release();
        }
    }

    /// A knob tells of its dial.
    #[inline]
    fn tell_dial(&mut self) {
        self.dial_in = self.dial_in.saturating_sub(1);
        if self.dial_in == 0
            && let Some(dial) = self.felt.servo().dial(&self.state)
        {
            self.dial_in = self.rate / DIALS_HZ;
            self.mailbox.tell_dial(&Dial {
                tick: self.ticks,
                turns: dial.turns,
                angle: dial.angle_rad,
                rate: self.state.rates().first().copied().unwrap_or(0.0),
                torque: dial.torque_n_m,
                feel: dial.feel,
                detent: dial.detent,
                end: dial.end,
                kept: 0,
            });
        }
    }

    /// A device with a surface that deforms tells of its modes.
    #[inline]
    fn tell_modes(&mut self) {
        if let Some(modes) = Modes::new(&self.state) {
            self.modes_in = self.modes_in.saturating_sub(1);
            if self.modes_in == 0 {
                self.modes_in = self.rate / MODES_HZ;
                self.mailbox.tell_modes(&modes);
            }
        }
    }

    /// Telemetry, light and heartbeat.
    #[inline]
    fn tell(&mut self, began: u32, verdict: Verdict) {
        let release_first = if self.interlock.is_locked() { hold::RELEASE_FIRST } else { 0 };
        let holds = verdict.hold | release_first;
        let drives = self.drives(verdict);
        self.board.show(is_lit(self.ticks, self.rate, drives, self.state.fault().is_some(), holds != 0));
        if self.mailbox.is_looked_at() {
            let (angles, rates) = (self.state.angles(), self.state.rates());
            let pose = self.felt.servo().device().kinematics.pose(angles);
            let velocity = pose.map_or(Vec3::ZERO, |pose| pose.velocity(rates));
            self.mailbox.tell_view(&View::new(&self.state, velocity, holds));
        }
        self.tell_dial();
        self.tell_modes();
        self.recorder.set_board(self.bridge.total(), holds);
        let gains = self.felt.wiring().joints(self.board.gains());
        self.recorder.set_sensors(self.bridge.rate().per_10_000(), &gains);
        self.recorder.note(&self.state, began, self.board.now());
        self.ticks = self.ticks.wrapping_add(1);
        self.mailbox.tell_ticks(self.ticks);
    }
}
