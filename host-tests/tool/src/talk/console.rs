//! A device, and a user who sends it commands a line at a time.

use super::Log;
use super::asked::{Asked, FORMS};
use palpate::servo::{Fault, Phase};
use palpate::track::Contact;
use palpate::wire::hold;
use palpate_bake::file::BakedFile;
use palpate_link::{BodyPose, Command, Device, Dial, Error, Hello, Line, Modes, View};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};

/// Interval at which a force is repeated and the loop shown.
const PUSHES: Duration = Duration::from_millis(30);
const SHOWS: Duration = Duration::from_millis(100);
/// How long the device may take at most to report that a released button has ended its force.
const RELEASES: Duration = Duration::from_secs(1);
/// How long one look at the device takes at most.
const LOOK: Duration = Duration::from_millis(10);

/// Whether the conversation goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// It does.
    GoesOn,
    /// Somebody has said quit.
    Ends,
}

/// Makes a body's file of what somebody names.
pub type Bake = dyn Fn(&Path) -> anyhow::Result<Vec<u8>> + Sync;

/// Actions of a simulated finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Press {
    /// It presses the button.
    Down,
    /// It releases it.
    Up,
    /// It confirms what the device is going to ask for.
    Confirm,
    /// It releases the button, and resets the device.
    Reset,
}

/// The finger at an enable button; whether it could do that.
pub type Button = Box<dyn Fn(Press) -> bool>;

/// A session with a device. No method waits for a person: call [`Self::tend`] while no command comes.
pub struct Console<'a, L> {
    device: Device<L>,
    bake: &'a Bake,
    /// Where bodies were put from here; one that moves is nowhere known.
    poses: BTreeMap<u8, BodyPose>,
    /// A force, when it ends, and when it was asked for last.
    pushes: Option<([f32; 3], Instant, Option<Instant>)>,
    /// Until when the loop is shown, and when it was last.
    watches: Option<(Instant, Option<Instant>)>,
    /// The same for the dial.
    turns: Option<(Instant, Option<Instant>)>,
    /// The enable button of a simulated device.
    button: Option<Button>,
    waits: Option<Instant>,
    log: Option<Log>,
}

impl<'a, L: Line> Console<'a, L> {
    /// With this device; bodies that are uploaded come from `bake`.
    pub fn new(device: Device<L>, bake: &'a Bake) -> Self {
        Self {
            device,
            bake,
            poses: BTreeMap::new(),
            pushes: None,
            watches: None,
            turns: None,
            button: None,
            waits: None,
            log: None,
        }
    }

    /// With a hand at its enable button.
    #[must_use]
    pub fn with_button(self, button: Option<Button>) -> Self {
        Self { button, ..self }
    }

    /// With a log of this rate, Hz, from now on.
    ///
    /// # Errors
    /// A rate above the servo's, or a file that cannot be written.
    pub fn with_log(mut self, path: &Path, rate: Option<f64>) -> anyhow::Result<Self> {
        self.log = Some(Log::create(path, &self.device.hello(), rate)?);
        self.device.take_views();
        self.device.take_dials();
        Ok(self)
    }

    /// Ends the log, if there is one, and prints its number of rows.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn end_log(&mut self, output: &mut dyn Write) -> anyhow::Result<()> {
        // A device that is gone has no newer view.
        if let Ok(view) = self.device.view(Duration::ZERO) {
            self.write_log(&view)?;
        }
        if let Some(log) = self.log.take() {
            writeln!(output, "{}", log.end(self.button.is_none())?)?;
        }
        Ok(())
    }

    /// Whether the next line of a file should wait.
    pub fn is_busy(&self) -> bool {
        self.watches.is_some() || self.turns.is_some() || self.waits.is_some()
    }

    /// Keeps the session alive for a moment; call it repeatedly.
    ///
    /// # Errors
    /// A device that is gone, or output that cannot be written.
    pub fn tend(&mut self, output: &mut dyn Write) -> anyhow::Result<()> {
        let view = match self.device.view(LOOK) {
            Ok(view) => view,
            Err(Error::BeganAnew { .. }) => return self.begin_anew(output),
            Err(error) => return Err(error.into()),
        };
        self.write_log(&view)?;
        let now = self.device.now();
        self.waits = self.waits.filter(|until| now < *until);
        if let Some((force, until, last)) = self.pushes {
            self.pushes = Some((force, until, last)).filter(|_| now < until);
            let is_due = last.is_none_or(|last| now.saturating_duration_since(last) >= PUSHES);
            if is_due && self.pushes.is_some() {
                self.pushes = Some((force, until, Some(now)));
                self.device.push(force)?;
            }
        }
        if let Some((until, last)) = self.watches {
            if last.is_none_or(|last| now.saturating_duration_since(last) >= SHOWS) {
                self.watches = Some((until, Some(now)));
                let line = self.said(&view)?;
                writeln!(output, "{line}")?;
            }
            self.watches = self.watches.filter(|_| now < until);
        }
        if let Some((until, last)) = self.turns {
            if last.is_none_or(|last| now.saturating_duration_since(last) >= SHOWS) {
                self.turns = Some((until, Some(now)));
                let dial = self.device.dial(Duration::ZERO)?;
                writeln!(output, "{}{}", turned(&dial), idle(&view))?;
            }
            self.turns = self.turns.filter(|_| now < until);
        }
        Ok(())
    }

    /// Does what a line asks for.
    ///
    /// # Errors
    /// A line that is not understood, what the device refuses, or a device that is gone.
    pub fn obey(&mut self, line: &str, output: &mut dyn Write) -> anyhow::Result<Step> {
        let asked: Asked = line.parse()?;
        let later = |seconds: f32, now: Instant| now + Duration::from_secs_f32(seconds);
        let now = self.device.now();
        match asked {
            Asked::Nothing => return Ok(Step::GoesOn),
            Asked::Quit => return Ok(Step::Ends),
            Asked::Help => {
                let width = FORMS.iter().map(|(form, _)| form.chars().count()).max().unwrap_or(0);
                for (form, meaning) in FORMS {
                    writeln!(output, "{form:<width$}  {meaning}")?;
                }
                return Ok(Step::GoesOn);
            }
            Asked::Who => {
                writeln!(output, "{}", self.who())?;
                return Ok(Step::GoesOn);
            }
            Asked::Where => {
                let view = self.device.view(SHOWS)?;
                let line = self.said(&view)?;
                writeln!(output, "{line}")?;
                return Ok(Step::GoesOn);
            }
            Asked::Watch(seconds) => {
                self.watches = Some((later(seconds, now), None));
                return Ok(Step::GoesOn);
            }
            Asked::Dial(seconds) => {
                // A device that is no knob says so at once.
                self.device.dial(SHOWS)?;
                self.turns = Some((later(seconds, now), None));
                return Ok(Step::GoesOn);
            }
            Asked::Feel(part) => self.device.feel(part)?,
            Asked::KeepFeel(keeps) => {
                self.release()?;
                let button = &self.button;
                let confirm = || match button {
                    Some(button) => {
                        button(Press::Confirm);
                        let _ = writeln!(output, "the simulated hand has released the button, and holds it to confirm");
                    }
                    None => {
                        // A person who does not read it does not confirm, and that is refused.
                        let _ = writeln!(output, "now hold the enable button for half a second, and release it");
                        let _ = output.flush();
                    }
                };
                self.device.keep_feel(keeps, confirm)?;
                let outcome =
                    if keeps { "kept: the knob starts with this feel" } else { "cleared: it starts with its table" };
                writeln!(output, "{outcome} from the next reset on")?;
                return Ok(Step::GoesOn);
            }
            Asked::Press(pressed) => {
                let button = self.button.as_ref();
                let button = button.ok_or_else(|| anyhow::anyhow!("a real device has its own button: press that"))?;
                if pressed {
                    button(Press::Down);
                } else {
                    self.release()?;
                }
            }
            Asked::Reset => {
                if !self.button.as_ref().is_some_and(|button| button(Press::Reset)) {
                    anyhow::bail!(
                        "only the simulated knob is reset from here (--device knob --host): end this session and start another"
                    );
                }
            }
            Asked::Wait(seconds) => {
                self.waits = Some(later(seconds, now));
                return Ok(Step::GoesOn);
            }
            Asked::Push(force, seconds) => {
                // A force that is refused is refused before anything is promised.
                self.device.push(force)?;
                self.pushes = Some((force, later(seconds, now), Some(now))).filter(|_| force != [0.0; 3]);
            }
            Asked::Place(body, position, orientation) => {
                let upright = self.poses.get(&body).map_or([0.0, 0.0, 0.0, 1.0], |pose| pose.orientation);
                self.place(body, BodyPose { position, orientation: orientation.unwrap_or(upright) })?;
            }
            Asked::Turn(body, orientation) => {
                let Some(BodyPose { position, .. }) = self.poses.get(&body).copied() else {
                    anyhow::bail!("the place of body {body} is unknown; place it first");
                };
                self.place(body, BodyPose { position, orientation })?;
            }
            Asked::Move(body, motion, seconds) => {
                self.poses.remove(&body);
                self.device.move_along(body, motion, seconds)?;
            }
            Asked::Switch(groups) => self.device.switch(groups)?,
            Asked::Choose(index) => self.device.choose(index)?,
            Asked::Harden(body, stiffness, damping) => self.device.harden(body, stiffness, damping)?,
            Asked::Rub(body, friction) => self.device.order(Command::Rub { body, friction })?,
            Asked::Tip(radius) => self.device.tip(radius)?,
            Asked::Limit(newtons) => self.device.limit(newtons)?,
            Asked::Upload(body, path) => self.upload(body, &path, Memory::Ram, output)?,
            Asked::Keep(body, path) => self.upload(body, &path, Memory::Flash, output)?,
            Asked::PutBack(body) => self.device.put_back(body)?,
            Asked::Forget(body) => self.device.forget_kept(body)?,
            Asked::Stop => {
                self.pushes = None;
                self.device.stop()?;
            }
            Asked::Acknowledge => self.device.acknowledge()?,
        }
        writeln!(output, "done")?;
        Ok(Step::GoesOn)
    }

    /// A simulated finger releases the button. The next line may need motors that are off, so this waits until the device
    /// reports no force, up to [`RELEASES`]; a device that goes on refuses that line itself.
    fn release(&mut self) -> Result<(), Error> {
        let Some(button) = &self.button else { return Ok(()) };
        button(Press::Up);
        let began = self.device.now();
        loop {
            let runs = self.device.view(LOOK)?.phase == Phase::Running as u8;
            // Reports from before the release are over within `SHOWS`.
            let needed = if runs { RELEASES } else { SHOWS };
            if self.device.now().saturating_duration_since(began) >= needed {
                return Ok(());
            }
        }
    }

    /// The device's identity.
    pub fn who(&self) -> String {
        let hello = self.device.hello();
        let memory = match hello.room {
            0 => "no memory for bodies".to_owned(),
            room => format!("memory for a body of {room} bytes, {} faces and {} edges", hello.faces, hello.edges),
        };
        let flash = match (hello.flash, hello.kept) {
            (0, _) => String::new(),
            (flash, 0) => format!(", and {flash} bytes of flash to keep one in"),
            (flash, kept) => format!(", and {flash} bytes of flash, which keep the body with the CRC {kept:08x}"),
        };
        let [rate, force] = [hello.rate, hello.max_force];
        let device = if is_knob(&hello) {
            format!("a knob of {rate} Hz; `dial` shows its angle and torque")
        } else {
            format!("a device of {rate} Hz, {force} N at most, {memory}{flash}")
        };
        format!("{device}; protocol {}", hello.protocol)
    }

    /// The loop in a line: of a knob its dial.
    fn said(&mut self, view: &View) -> Result<String, Error> {
        Ok(if is_knob(&self.device.hello()) {
            format!("{}; {}", turned(&self.device.dial(Duration::ZERO)?), phase(view))
        } else {
            format!("{}{}", said(view), deformed(self.device.modes()?))
        })
    }

    fn write_log(&mut self, view: &View) -> anyhow::Result<()> {
        let Some(log) = &mut self.log else { return Ok(()) };
        if is_knob(&self.device.hello()) {
            log.take_dials(&self.device.take_dials(), view)
        } else {
            log.take(&self.device.take_views())
        }
    }

    fn begin_anew(&mut self, output: &mut dyn Write) -> anyhow::Result<()> {
        (self.pushes, self.poses) = (None, BTreeMap::new());
        self.device.greet()?;
        let starts = if is_knob(&self.device.hello()) {
            "with the kept feel, or its table"
        } else {
            "with its built-in body, in its first place"
        };
        writeln!(output, "the device was reset: it starts {starts}")?;
        Ok(())
    }

    fn place(&mut self, body: u8, pose: BodyPose) -> Result<(), Error> {
        self.device.place(body, pose)?;
        self.poses.insert(body, pose);
        Ok(())
    }

    fn upload(&mut self, body: u8, path: &Path, into: Memory, output: &mut dyn Write) -> anyhow::Result<()> {
        let bake = self.bake;
        // A model may take long to bake, and the device hears from here meanwhile.
        let file = std::thread::scope(|scope| {
            let baking = scope.spawn(|| bake(path));
            while !baking.is_finished() {
                self.tend(output)?;
            }
            baking.join().map_err(|_| anyhow::anyhow!("the bake panicked"))?
        })?;
        let mut shown = 0;
        let progress = |came: usize, all: usize| {
            let tenth = came * 10 / all.max(1);
            if tenth > shown {
                shown = tenth;
                // What cannot be shown is no reason to leave a body half sent.
                let _ = writeln!(output, "{came} of {all} bytes");
            }
        };
        match into {
            Memory::Ram => self.device.upload(body, &file, progress)?,
            Memory::Flash => self.device.keep(body, &file, progress)?,
        }
        let [x, y, z] = (BakedFile::read(&file)?.model.centre * 1e3).to_array();
        writeln!(output, "its origin is at {x:.3} {y:.3} {z:.3} mm of the model")?;
        Ok(())
    }
}

/// Where a body is put.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Memory {
    Ram,
    Flash,
}

/// The modes of the foremost body, in millimetres, up to the last that is not at rest.
fn deformed(modes: Option<Modes>) -> String {
    let Some(Modes { q, .. }) = modes else { return String::new() };
    let count = q.iter().rposition(|q| *q != 0.0).map_or(1, |last| last + 1);
    let shown: String = q[..count].iter().map(|q| format!(" {:.3}", q * 1e3)).collect();
    format!("; modes{shown} mm")
}

/// Whether it is a knob: it has a torque and no force.
pub(super) fn is_knob(hello: &Hello) -> bool {
    hello.max_force == 0.0
}

/// The angle by which the parts of its feel are placed.
pub(super) fn degrees(dial: &Dial) -> f64 {
    f64::from(dial.angle).to_degrees()
}

/// The dial in a line.
fn turned(dial: &Dial) -> String {
    let end = match dial.end {
        0 => "",
        1.. => ", beyond the upper end",
        ..0 => ", beyond the lower end",
    };
    let kept = match dial.kept {
        1 => "; the kept feel was used",
        2 => "; a kept feel is damaged or beyond this device's limits: set it and keep it again, or forget it",
        _ => "",
    };
    let turn = if dial.turns == 0 { String::new() } else { format!(" of turn {}", dial.turns) };
    format!(
        "dial at {:.1} degrees{turn}, {:.2} rad/s, {:.1} mN·m; detent {}{end}; feel {}{kept}",
        degrees(dial),
        dial.rate,
        1e3 * dial.torque,
        dial.detent,
        dial.feel,
    )
}

/// Why there is no force, if there is none.
fn idle(view: &View) -> String {
    if view.phase == Phase::Running as u8 { String::new() } else { format!("; {}", phase(view)) }
}

/// Where the reason of a fault is, which a view does not have.
const fn reason(fault: Fault) -> &'static str {
    match fault {
        Fault::Homing => " (`monitor` shows the reason, docs/troubleshooting.md what to do)",
        _ => "",
    }
}

/// A view in a line.
fn said(view: &View) -> String {
    let millimetres = |vector: [f32; 3]| vector.map(|part| format!("{:.2}", part * 1e3)).join(" ");
    let force = view.force.map(|part| format!("{part:.2}")).join(" ");
    let contact = match Contact::ALL.into_iter().find(|contact| *contact as u8 == view.contact) {
        Some(Contact::Touching) => "touching",
        Some(Contact::InFront) => "in front",
        Some(Contact::Behind) | None => "behind",
    };
    format!(
        "at {} mm, {} mm/s; body {}, {contact}, gap {:.2} mm; force {force} N; {}",
        millimetres(view.position),
        millimetres(view.velocity),
        view.body,
        view.gap * 1e3,
        phase(view),
    )
}

/// Phase, fault and what keeps the motors off.
fn phase(view: &View) -> String {
    let phase = match Phase::ALL.into_iter().find(|phase| *phase as u8 == view.phase) {
        Some(Phase::Running) => "running",
        Some(Phase::Armed) => "armed",
        Some(Phase::Calibrate) => "calibrating",
        Some(Phase::Fault) => "stopped",
        Some(Phase::Reset) | None => "reset",
    };
    let fault = Fault::from_code(view.fault).map_or_else(String::new, |fault| format!(": {fault}{}", reason(fault)));
    let holds: String = hold::reasons(view.hold).map(|why| format!("; {why}")).collect();
    format!("{phase}{fault}{holds}")
}
