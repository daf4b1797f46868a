//! Processor time.

/// Processor time of this process so far, seconds, all threads together; `None` if unknown.
#[cfg(unix)]
pub fn seconds() -> Option<f64> {
    use nix::sys::resource::{UsageWho, getrusage};
    let usage = getrusage(UsageWho::RUSAGE_SELF).ok()?;
    let seconds = |time: nix::sys::time::TimeVal| time.tv_sec() as f64 + 1e-6 * time.tv_usec() as f64;
    Some(seconds(usage.user_time()) + seconds(usage.system_time()))
}

/// Processor time of this process so far, seconds, all threads together; `None` if unknown.
#[cfg(not(unix))]
pub fn seconds() -> Option<f64> {
    None
}
