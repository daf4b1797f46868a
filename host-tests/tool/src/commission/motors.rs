//! Output and sign of each motor: which one moves a joint that rests against a support, and with which duty.

use super::device::said;
use super::encoders::angle;
use super::{Finding, Lab};
use anyhow::{Context, bail};
use palpate::wire::Reading;
use palpate_sim::devices::{DeviceFile, OwnDevice};

/// Minimum motion of a joint, rad: many counts, and little for the person who holds the others.
pub const MOVED: f64 = 0.01;

/// Finds the motors and writes them into the file. `loads` are gravity's torques on the joints, N·m: the direction in
/// which each falls.
pub(super) fn find_motors(
    lab: &mut Lab,
    file: &mut DeviceFile,
    most: f64,
    (centre, loads): ([f64; 3], [f64; 3]),
    findings: &mut Vec<Finding>,
) -> anyhow::Result<()> {
    let mut taken = [false; 3];
    for (index, load) in loads.into_iter().enumerate() {
        let towards = away(load);
        let (output, with) = find_motor(lab, file, (index, most), (centre, towards), taken)?;
        taken[output] = true;
        let joint = &mut file.joint[index];
        if joint.motor.channel != output {
            findings
                .push(Finding(format!("joint {}: motor on output {output}, not {}", joint.name, joint.motor.channel)));
            joint.motor.channel = output;
        }
        if (joint.motor.ratio > 0.0) != with {
            joint.motor.ratio = -joint.motor.ratio;
            findings.push(Finding(format!("joint {}: motor sign, ratio {:.3}", joint.name, joint.motor.ratio)));
        }
    }
    Ok(())
}

/// Which way a load falls off its support.
pub(super) fn away(load: f64) -> f64 {
    if load > 0.0 { -1.0 } else { 1.0 }
}

/// The output that moves a joint off its support, and whether a positive duty moves it towards rising angles.
fn find_motor(
    lab: &mut Lab,
    file: &DeviceFile,
    (joint, most): (usize, f64),
    (centre, towards): ([f64; 3], f64),
    taken: [bool; 3],
) -> anyhow::Result<(usize, bool)> {
    // The one that the file names first: most files are right.
    let named = file.joint[joint].motor.channel;
    let mut outputs: Vec<usize> = (0..3).filter(|output| !taken[*output]).collect();
    outputs.sort_by_key(|output| *output != named);
    for output in outputs {
        for sign in [1.0, -1.0] {
            lab.place(centre)?;
            lab.hands.rest(joint, towards)?;
            let counts = lab.device.step(None)?.counts;
            let before = angle(file, joint, counts);
            let moved = |counts| towards * (angle(file, joint, counts) - before);
            if (0..5).any(|_| lab.device.step(None).is_ok_and(|reading| moved(reading.counts).abs() > 0.5 * MOVED)) {
                bail!("joint {}: it moves by itself; support it against falling", file.joint[joint].name);
            }
            let output_byte = u8::try_from(output)?;
            let found =
                grow(lab, output_byte, sign, (0.0, Growth::BRISK, most), |reading| moved(reading.counts) > MOVED)?;
            lab.device.step(None)?;
            if found.is_some() {
                return Ok((output, sign * towards > 0.0));
            }
        }
    }
    None.with_context(|| format!("joint {}: no motor moves it", file.joint[joint].name))
}

// A duty that grows while the key is held, until something moves.

/// Maximum duty of the search, as a fraction of full duty: slightly less than the device's limit of four tenths or, if
/// lower, the smallest continuous limit of the motors. The assignment of motors to outputs is not known yet.
pub(super) fn most(own: &OwnDevice) -> f64 {
    own.protection.motors.iter().map(|motor| f64::from(motor.continuous)).fold(0.4, f64::min) - 0.01
}
/// Number of releases of the key after which the search gives up.
const TRIES: u32 = 20;

/// Growth of a duty in a fiftieth of a second.
#[derive(Clone, Copy, Debug)]
pub(super) struct Growth {
    /// Minimum increment, as a fraction of full duty.
    pub least: f64,
    /// Increment as a fraction of the duty.
    pub share: f64,
}

impl Growth {
    /// To [`most`] within a second.
    pub const BRISK: Self = Self { least: 0.002, share: 0.04 };
    /// A fiftieth of full duty in a second: slow enough that the duty at the first motion is hardly above the necessary
    /// one.
    pub const FINE: Self = Self { least: 0.0003, share: 0.0 };
    /// The other way, from where something moves: it must come to rest before it has gone where the load is another.
    pub const BACK: Self = Self { least: 0.0005, share: 0.015 };
    /// The same once it rests: slow, as the duty at the first motion is read.
    pub const SINK: Self = Self { least: 0.0002, share: 0.005 };

    pub fn next(self, duty: f64) -> f64 {
        duty + self.least + self.share * duty
    }
}

/// A share of full duty, with its sign, for the device.
pub(super) fn duty(share: f64) -> i16 {
    (share.clamp(-1.0, 1.0) * 32_767.0).round() as i16
}

/// Lets an output's duty grow from a share to `most`, in the direction of `sign`, until `has_moved` says so of a
/// reading. The share at which it did, and the reading; `None` if it never did. The motor is still driven.
///
/// # Errors
/// A line that broke, a key that nobody holds, a device that refuses.
pub(super) fn grow(
    lab: &mut Lab,
    output: u8,
    sign: f64,
    (from, growth, most): (f64, Growth, f64),
    mut has_moved: impl FnMut(&Reading) -> bool,
) -> anyhow::Result<Option<(f64, Reading)>> {
    let mut share = from;
    let mut tries = 0;
    while share < most {
        share = growth.next(share);
        let reading = lab.device.step(Some((output, duty(sign * share))))?;
        if has_moved(&reading) {
            return Ok(Some((share, reading)));
        }
        if reading.refusal != 0 {
            bail!("output {output}: the device stopped{}", said(&reading));
        }
        if !reading.live {
            // The key or the button was let go: from the start.
            tries += 1;
            if tries == TRIES {
                bail!(
                    "output {output}: key or enable button were released repeatedly{}; hold both and start again",
                    said(&reading)
                );
            }
            lab.device.wait_for_enable()?;
            share = from;
        }
    }
    lab.device.step(None)?;
    Ok(None)
}
