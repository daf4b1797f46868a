//! Processor time and memory.

#[cfg(unix)]
use nix::sys::resource::{Usage, UsageWho, getrusage};

/// Processor time of this process so far, seconds, all threads together; `None` if unknown.
#[cfg(unix)]
pub fn seconds() -> Option<f64> {
    Some(spent(&getrusage(UsageWho::RUSAGE_SELF).ok()?))
}

/// The same of the programs that it ran and that have ended.
#[cfg(unix)]
pub fn seconds_of_children() -> Option<f64> {
    Some(spent(&getrusage(UsageWho::RUSAGE_CHILDREN).ok()?))
}

#[cfg(unix)]
fn spent(usage: &Usage) -> f64 {
    let seconds = |time: nix::sys::time::TimeVal| time.tv_sec() as f64 + 1e-6 * time.tv_usec() as f64;
    seconds(usage.user_time()) + seconds(usage.system_time())
}

/// The most memory that this process or one that it ran has taken so far, megabytes; `None` if unknown.
#[cfg(target_os = "linux")]
pub fn megabytes() -> Option<f64> {
    let most = |of| getrusage(of).ok().map(|usage| usage.max_rss() as f64 * 1024e-6);
    Some(most(UsageWho::RUSAGE_SELF)?.max(most(UsageWho::RUSAGE_CHILDREN)?))
}

/// Processor time of this process so far, seconds, all threads together; `None` if unknown.
#[cfg(not(unix))]
pub fn seconds() -> Option<f64> {
    None
}

/// The same of the programs that it ran and that have ended.
#[cfg(not(unix))]
pub fn seconds_of_children() -> Option<f64> {
    None
}

/// The most memory that this process or one that it ran has taken so far, megabytes; `None` if unknown.
#[cfg(not(target_os = "linux"))]
pub fn megabytes() -> Option<f64> {
    None
}
