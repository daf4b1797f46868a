//! A duty that grows while the key is held, until something moves.

use super::Lab;
use super::device::said;
use anyhow::bail;
use palpate_sim::devices::OwnDevice;

/// The greatest share of full duty that is tried: a little less than a device allows, which is four tenths, or what the
/// motor that bears least bears for ever. Which motor is where is not known yet.
pub(super) fn most(own: &OwnDevice) -> f64 {
    own.protection.motors.iter().map(|motor| f64::from(motor.continuous)).fold(0.4, f64::min) - 0.01
}
/// How often a key may be let go before whoever holds it has given up.
const TRIES: u32 = 20;

/// How fast a duty grows, a fiftieth of a second at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Growth {
    /// By how much at least, as a share of full duty.
    pub least: f64,
    /// By how much of itself.
    pub share: f64,
}

impl Growth {
    /// To [`most`] within a second.
    pub const BRISK: Self = Self { least: 0.002, share: 0.04 };
    /// A fiftieth of full duty in a second: so slowly that what just moves has hardly been pushed more than it takes.
    pub const FINE: Self = Self { least: 0.0003, share: 0.0 };
    /// The other way, from where something moves: it must come to rest before it has gone where the load is another.
    pub const BACK: Self = Self { least: 0.0005, share: 0.015 };

    pub fn next(self, duty: f64) -> f64 {
        duty + self.least + self.share * duty
    }
}

/// A share of full duty, with its sign, for the device.
pub(super) fn duty(share: f64) -> i16 {
    (share.clamp(-1.0, 1.0) * 32_767.0).round() as i16
}

/// Lets an output's duty grow from a share to `most`, in the direction of `sign`, until `has_moved` says so of the
/// counts. The share at which it did, and the counts; `None` if it never did. The motor is still driven.
///
/// # Errors
/// A line that broke, a key that nobody holds, a device that refuses.
pub(super) fn grow(
    lab: &mut Lab,
    output: u8,
    sign: f64,
    (from, growth, most): (f64, Growth, f64),
    has_moved: impl Fn([i32; 3]) -> bool,
) -> anyhow::Result<Option<(f64, [i32; 3])>> {
    let mut share = from;
    let mut tries = 0;
    while share < most {
        share = growth.next(share);
        let reading = lab.device.step(Some((output, duty(sign * share))))?;
        if has_moved(reading.counts) {
            return Ok(Some((share, reading.counts)));
        }
        if reading.refusal != 0 {
            bail!("output {output}: the device stopped{}", said(&reading));
        }
        if !reading.live {
            // The key or the button was let go: from the start.
            tries += 1;
            if tries == TRIES {
                bail!("output {output}: key or enable button are let go again and again{}", said(&reading));
            }
            lab.device.wait_for_enable()?;
            share = from;
        }
    }
    lab.device.step(None)?;
    Ok(None)
}
