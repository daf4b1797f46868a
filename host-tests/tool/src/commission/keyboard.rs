//! The space bar of a terminal as the key without which no motor moves.

use super::{Hands, Key, keyboard};
use anyhow::{Context, bail};
use std::io::{IsTerminal as _, Write as _, stdin, stdout};
use std::time::{Duration, Instant};

/// How long after a repeat the bar counts as held: keyboards repeat 10 to 40 times a second.
const REPEATS: Duration = Duration::from_millis(150);

/// The space bar.
///
/// A terminal says nothing of keys that are let go; it repeats those that are held. A single press therefore moves
/// nothing: the bar counts as held from its first repeat on, and until 0.15 s after the last.
#[derive(Debug)]
pub struct Keyboard {
    terminal: terminal::Raw,
    /// When the bar was last heard of.
    heard: Option<Instant>,
    repeats: bool,
}

impl Keyboard {
    /// Of this program's terminal, which is as it was once this is dropped.
    ///
    /// # Errors
    /// Where there is none: a script or a pipe holds no key.
    pub fn new() -> anyhow::Result<Self> {
        if !stdin().is_terminal() {
            bail!("motors move only while a key is held, and standard input is no terminal");
        }
        Ok(Self { terminal: terminal::Raw::new()?, heard: None, repeats: false })
    }

    /// Looks at the terminal.
    fn look(&mut self) {
        let now = Instant::now();
        let is_fresh = |heard: Instant| now.duration_since(heard) < REPEATS;
        while let Some(byte) = self.terminal.byte() {
            if byte == b' ' {
                // The keyboard's own delay before it repeats is longer than this: a press alone is forgotten.
                self.repeats = self.heard.is_some_and(is_fresh);
                self.heard = Some(now);
            } else {
                // Any other key lets go.
                (self.repeats, self.heard) = (false, None);
            }
        }
        self.repeats &= self.heard.is_some_and(is_fresh);
    }
}

impl Key for Keyboard {
    fn is_held(&mut self) -> bool {
        self.look();
        self.repeats
    }
}

/// The next line of the terminal, with echo independent of a [`Keyboard`]; `None` at its end. Earlier key presses are
/// discarded: a held space bar is no answer.
pub(super) fn line() -> std::io::Result<Option<String>> {
    let _shown = terminal::shown();
    let mut answer = String::new();
    let read = stdin().read_line(&mut answer)?;
    Ok((read > 0).then(|| answer.trim().to_owned()))
}

#[cfg(unix)]
mod terminal {
    use anyhow::Context;
    use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
    use nix::sys::termios::{FlushArg, LocalFlags, SetArg, Termios, tcflush, tcgetattr, tcsetattr};
    use std::io::stdin;
    use std::os::fd::AsFd as _;

    /// Lines, shown as they are typed, until this is dropped.
    pub fn shown() -> Option<Raw> {
        let before = tcgetattr(stdin()).ok()?;
        let mut shown = before.clone();
        shown.local_flags.insert(LocalFlags::ICANON | LocalFlags::ECHO);
        tcflush(stdin(), FlushArg::TCIFLUSH).ok()?;
        tcsetattr(stdin(), SetArg::TCSANOW, &shown).ok()?;
        Some(Raw(before))
    }

    /// The terminal's previous mode, restored on drop.
    #[derive(Debug)]
    pub struct Raw(Termios);

    impl Raw {
        pub fn new() -> anyhow::Result<Self> {
            let before = tcgetattr(stdin()).context("cannot ask the terminal for its settings")?;
            let mut raw = before.clone();
            // Interrupts stay: Ctrl-C ends it.
            raw.local_flags.remove(LocalFlags::ICANON | LocalFlags::ECHO);
            tcsetattr(stdin(), SetArg::TCSANOW, &raw).context("cannot set the terminal")?;
            Ok(Self(before))
        }

        pub fn byte(&mut self) -> Option<u8> {
            let stdin = stdin();
            let mut waiting = [PollFd::new(stdin.as_fd(), PollFlags::POLLIN)];
            let has_come = poll(&mut waiting, PollTimeout::ZERO).is_ok_and(|ready| ready > 0);
            let mut byte = [0];
            // Past the buffer of the standard library, which `poll` knows nothing of.
            let read = has_come.then(|| nix::unistd::read(stdin.as_fd(), &mut byte));
            matches!(read, Some(Ok(1))).then_some(byte[0])
        }
    }

    impl Drop for Raw {
        fn drop(&mut self) {
            let _ = tcsetattr(stdin(), SetArg::TCSANOW, &self.0);
        }
    }
}

#[cfg(not(unix))]
mod terminal {
    use anyhow::bail;

    /// They are shown anyway.
    pub const fn shown() -> Option<Raw> {
        None
    }

    /// None on this system.
    #[derive(Debug)]
    pub struct Raw(());

    impl Raw {
        pub fn new() -> anyhow::Result<Self> {
            bail!("keys are read from a Unix terminal")
        }

        pub fn byte(&mut self) -> Option<u8> {
            let Self(()) = self;
            None
        }
    }
}

// A person at the device, who reads prompts.

/// Somebody at a terminal.
pub struct Person {
    /// The joints' names.
    names: Vec<String>,
    /// N/kg.
    gravity: f64,
    /// The hands that follow in a rehearsal, where nobody answers.
    rehearsed_by: Option<Box<dyn Hands>>,
}

impl Person {
    /// A person who reads and answers at this terminal; its [`Keyboard`] refuses a script.
    pub const fn new(names: Vec<String>) -> Self {
        Self { names, gravity: 9.81, rehearsed_by: None }
    }

    /// The same, whose answers are given and followed by simulated hands.
    pub fn rehearsed(names: Vec<String>, by: impl Hands + 'static) -> Self {
        Self { rehearsed_by: Some(Box::new(by)), ..Self::new(names) }
    }

    /// Says something, and waits for Enter.
    fn ask(&self, what: &str) -> anyhow::Result<()> {
        self.ask_for(what, "").map(drop)
    }

    /// Says something, and waits for a line; in a rehearsal it is this answer.
    fn ask_for(&self, what: &str, rehearsed: &str) -> anyhow::Result<String> {
        print!("\n{what}\n> ");
        stdout().flush()?;
        if self.rehearsed_by.is_some() {
            println!("{rehearsed}");
            return Ok(rehearsed.to_owned());
        }
        keyboard::line().context("cannot read the terminal")?.context("standard input was closed")
    }

    /// Follows in a rehearsal.
    fn follow(&mut self, what: impl FnOnce(&mut dyn Hands) -> anyhow::Result<()>) -> anyhow::Result<()> {
        self.rehearsed_by.as_mut().map_or(Ok(()), |hands| what(hands.as_mut()))
    }
}

impl Hands for Person {
    fn place(&mut self, angles: [f64; 3]) -> anyhow::Result<()> {
        let places = self.names.iter().zip(angles);
        let places: Vec<_> = places.map(|(name, angle)| format!("{name} at {:.2}°", angle.to_degrees())).collect();
        self.ask(&format!("Put joint {}, and hold them there. Enter when they are.", places.join(", ")))?;
        self.follow(|hands| hands.place(angles))
    }

    fn pose(&mut self, angles: [f64; 3]) -> anyhow::Result<()> {
        let places = self.names.iter().zip(angles);
        let places: Vec<_> = places.map(|(name, angle)| format!("{name} at {:.2}°", angle.to_degrees())).collect();
        self.ask(&format!(
            "Hold the arm in the pose in which its board will be homed (by the file, joint {}): that pose is measured. \
             Enter when it is there.",
            places.join(", ")
        ))?;
        self.follow(|hands| hands.pose(angles))
    }

    fn pass(&mut self, joint: usize, angles: [f64; 3]) -> anyhow::Result<()> {
        let (name, angle) = (&self.names[joint], angles[joint].to_degrees());
        self.ask(&format!(
            "Move joint {name} alone, slowly, to about {angle:.0}°, past its index mark. Enter when it is."
        ))?;
        self.follow(|hands| hands.pass(joint, angles))
    }

    fn rest(&mut self, joint: usize, towards: f64) -> anyhow::Result<()> {
        let (name, way) = (&self.names[joint], if towards > 0.0 { "rising" } else { "falling" });
        let what = format!(
            "Let joint {name} rest against a support, so that it can move only towards {way} angles, and hold the \
             others. Fingers out. Enter, press the enable button, and hold the space bar: its motor pulls by and by."
        );
        self.ask(&what)?;
        self.follow(|hands| hands.rest(joint, towards))
    }

    fn carry(&mut self, output: u8) -> anyhow::Result<()> {
        let what = format!(
            "Have a second person carry the arm, so that it can move and not fall. Fingers out. The motor on output \
             {output} is next. Enter."
        );
        self.ask(&what)?;
        self.follow(|hands| hands.carry(output))
    }

    fn pull(&mut self, force: [f64; 3]) -> anyhow::Result<f64> {
        let size = force.iter().map(|part| part * part).sum::<f64>().sqrt();
        if size == 0.0 {
            self.ask("Take the weight off. Enter.")?;
            return self.follow(|hands| hands.pull(force).map(drop)).map(|()| 0.0);
        }
        let [x, y, z] = force.map(|part| part / size);
        let wanted = size / self.gravity;
        let question = format!(
            "Let about {wanted:.3} kg pull at the probe along ({x:.2}, {y:.2}, {z:.2}) of the device's frame, by a \
             thread over a pulley where that is not down. How many kg are they?"
        );
        let answer = self.ask_for(&question, &format!("{wanted:.3}"))?;
        self.follow(|hands| hands.pull(force).map(drop))?;
        let kilograms: f64 = answer.parse().with_context(|| format!("{answer:?} is no number of kg"))?;
        if !(kilograms > 0.0 && kilograms <= 1.5 * wanted) {
            bail!("{kilograms} kg: more than {:.3} kg are more than the motor may lift here", 1.5 * wanted);
        }
        Ok(kilograms * self.gravity)
    }

    fn enable(&mut self, pressed: bool) -> anyhow::Result<()> {
        let what = if pressed {
            "From here on a motor moves while BOTH the device's enable button and the space bar are held. Enter, then \
             press the enable button."
        } else {
            "Let the enable button go: no motor is needed now. Enter."
        };
        self.ask(what)?;
        self.follow(|hands| hands.enable(pressed))
    }
}
