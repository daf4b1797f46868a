//! Standard output whose reader is gone (`palpate zwidth | head`): the tool ends without a message.

use std::any::Any;
use std::io::{self, ErrorKind};
use std::panic::{self, UnwindSafe};
use std::process::ExitCode;

/// Exit status of a program that SIGPIPE ends, as shells report it: neither a verdict nor a failure.
const UNREAD: u8 = 141;

/// Runs a command. If the reader of its output goes, it ends there. It unwinds, so that emulators end and terminals are
/// restored; SIGPIPE stays ignored, so that a socket to an emulator gives an error.
///
/// # Errors
/// Those of the command.
pub fn run(command: impl FnOnce() -> anyhow::Result<ExitCode> + UnwindSafe) -> anyhow::Result<ExitCode> {
    let report = panic::take_hook();
    panic::set_hook(Box::new(move |panic| {
        if !is_unread(panic.payload()) {
            report(panic);
        }
    }));
    match panic::catch_unwind(command) {
        Err(panic) if is_unread(&*panic) => Ok(ExitCode::from(UNREAD)),
        Err(panic) => panic::resume_unwind(panic),
        Ok(Err(error)) if is_broken_pipe(&error) && has_no_reader() => Ok(ExitCode::from(UNREAD)),
        Ok(outcome) => outcome,
    }
}

/// Whether a panic is that of `println!` or `eprintln!` without a reader.
fn is_unread(panic: &(dyn Any + Send)) -> bool {
    let message = panic.downcast_ref::<String>();
    message.is_some_and(|message| message.starts_with("failed printing to std") && message.contains("Broken pipe"))
}

/// Whether a write to some pipe or socket failed.
fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let of_system = error.chain().filter_map(|cause| cause.downcast_ref::<io::Error>());
    of_system.into_iter().any(|cause| cause.kind() == ErrorKind::BrokenPipe)
}

/// Whether standard output is a pipe whose reader is gone.
#[cfg(unix)]
fn has_no_reader() -> bool {
    use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
    use std::os::fd::AsFd as _;
    let stdout = io::stdout();
    let mut pipe = [PollFd::new(stdout.as_fd(), PollFlags::empty())];
    poll(&mut pipe, PollTimeout::ZERO).is_ok_and(|ready| ready > 0)
        && pipe[0].revents().is_some_and(|events| events.contains(PollFlags::POLLERR))
}

#[cfg(not(unix))]
fn has_no_reader() -> bool {
    false
}
