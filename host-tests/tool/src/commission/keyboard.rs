//! The space bar of a terminal as the key without which no motor moves.

use super::Key;
use anyhow::bail;
use std::io::{IsTerminal as _, stdin};
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

/// The next line of the terminal, shown while it is typed whatever a [`Keyboard`] does; `None` at its end. What was
/// pressed before is forgotten: a bar that was held is no answer.
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

    /// What a terminal was like before; it is again once this is dropped.
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
