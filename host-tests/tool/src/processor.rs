//! Processor time.

/// What this process has spent so far, seconds, all its threads together; none where that is not known.
#[cfg(unix)]
pub fn seconds() -> Option<f64> {
    use nix::sys::resource::{UsageWho, getrusage};
    let usage = getrusage(UsageWho::RUSAGE_SELF).ok()?;
    let seconds = |time: nix::sys::time::TimeVal| time.tv_sec() as f64 + 1e-6 * time.tv_usec() as f64;
    Some(seconds(usage.user_time()) + seconds(usage.system_time()))
}

/// What this process has spent so far, seconds, all its threads together; none where that is not known.
#[cfg(not(unix))]
pub fn seconds() -> Option<f64> {
    None
}
