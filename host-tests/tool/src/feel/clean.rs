//! The maximum clean stiffness: the stiffest wall along which a hand slides without feeling the loop.
//!
//! The estimates of position and velocity decide it as much as the rate: an observer that estimates positions between
//! counts has a lag of its own, and on a stiff wall its lag rings at every rate; a faster one lets counts through. So
//! the estimator is chosen again for each device, encoder and rate.

use super::rows::{Wish, slide};
use crate::devices::ShippedDevice;
use palpate::device::VelocityMethod;
use palpate::servo::Rendering;
use palpate_sim::feel::{RunError, Threshold};
use palpate_sim::zwidth::{Loop, Slice, max_stiffness};

/// Servo rates, Hz.
pub const RATES: [f32; 5] = [1_000.0, 2_000.0, 4_000.0, 8_000.0, 10_000.0];
/// Encoders: the device's own, and finer ones by these factors.
pub const ENCODERS: [f64; 3] = [1.0, 4.0, 16.0];
/// The softest and the stiffest wall that is tried, N/m.
pub const TRIED: [f64; 2] = [100.0, 10_000.0];
/// Steps a decade from one stiffness to the next; then halvings between the last clean one and the first that is not:
/// 8 %.
const STEPS_PER_DECADE: f64 = 4.0;
const HALVINGS: usize = 3;
/// A tick's duty takes effect at the next.
const DELAY: f64 = 1.0;
/// Corners that are tried, Hz: from the slowest whose damper still brakes to as fast as the observer goes at 10 kHz. Of
/// counts as they are one slow and one fast: their noise is the counts', not the corner's.
const BETWEEN: [f32; 6] = [40.0, 60.0, 80.0, 120.0, 160.0, 320.0];
const COUNTED: [f32; 2] = [80.0, 320.0];
/// The observer's corner as a share of the rate, at most: faster it is held back ([`palpate::device::BetweenCounts`]).
const FASTEST: f32 = 0.5 / (2.0 * core::f32::consts::TAU);

/// The result of a device at a rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clean {
    /// Servo rate, Hz.
    pub rate: f32,
    /// How many times as fine as the device's own its encoders are.
    pub finer: f64,
    /// The stiffest wall below which each that was tried is clean, N/m; 0 if the softest is not.
    pub clean: f64,
    /// With this estimator,
    pub method: VelocityMethod,
    /// and corner, Hz.
    pub corner: f32,
    /// The stiffest wall of the same damping and estimator that comes to rest, N/m: the Z-width.
    pub stable: f64,
}

/// The estimators that are tried at a rate, Hz.
fn estimators(rate: f32) -> Vec<(VelocityMethod, f32)> {
    let fastest = FASTEST * rate;
    let mut corners: Vec<f32> = BETWEEN.into_iter().filter(|corner| *corner < fastest).collect();
    corners.push(fastest.min(2.0 * BETWEEN[BETWEEN.len() - 1]));
    let between = corners.into_iter().map(|corner| (VelocityMethod::BetweenCounts, corner));
    between.chain(COUNTED.map(|corner| (VelocityMethod::LowPass, corner))).collect()
}

/// The maximum clean stiffness at a rate with the best estimator, independent of the device's recommendation; beside it
/// the Z-width's.
///
/// # Errors
/// Settings that are refused, a start out of reach.
pub fn clean_stiffness(
    device: &ShippedDevice,
    wish: &Wish,
    finer: f64,
    threshold: &Threshold,
) -> anyhow::Result<Clean> {
    let mut best = (0.0, VelocityMethod::BetweenCounts, BETWEEN[0]);
    for (velocity, corner) in estimators(wish.rate) {
        let wish = Wish { corner, rendering: Rendering { velocity, ..wish.rendering }, ..*wish };
        let is_clean = |stiffness: f64| -> anyhow::Result<bool> {
            let wish = Wish { stiffness: stiffness as f32, ..wish };
            match slide(device, &wish, finer, threshold) {
                Ok(sensation) => Ok(sensation.is_below()),
                // A wall that shakes the device until its loop stops.
                Err(error) if matches!(error.downcast_ref(), Some(RunError::Fault { .. })) => Ok(false),
                Err(error) => Err(error),
            }
        };
        // What is not clean where another is need not be looked at.
        if best.0 > 0.0 && !is_clean(best.0)? {
            continue;
        }
        let stiffest = stiffest(&is_clean)?;
        if stiffest > best.0 {
            best = (stiffest, velocity, corner);
        }
    }
    let (clean, method, corner) = best;
    let servo = Loop {
        rate: f64::from(wish.rate),
        delay_periods: DELAY,
        velocity: method,
        corner: f64::from(corner),
        ease: wish.rendering.ease,
    };
    let damping = f64::from(wish.settings(device).damping_n_s_per_m);
    let slice = slice(device, finer);
    Ok(Clean { rate: wish.rate, finer, clean, method, corner, stable: max_stiffness(&slice, damping, &servo) })
}

/// A device along the wall's normal, with encoders finer by a factor.
pub fn slice(device: &ShippedDevice, finer: f64) -> Slice {
    let own = Slice::of(device);
    Slice { resolution: own.resolution / finer, ..own }
}

/// The stiffest wall below which each that was tried is clean, N/m.
fn stiffest(is_clean: &impl Fn(f64) -> anyhow::Result<bool>) -> anyhow::Result<f64> {
    let ratio = 10_f64.powf(1.0 / STEPS_PER_DECADE);
    let (mut below, mut stiffness) = (0.0, TRIED[0]);
    while stiffness <= TRIED[1] * 1.001 && is_clean(stiffness)? {
        below = stiffness;
        stiffness *= ratio;
    }
    if below > 0.0 && stiffness <= TRIED[1] * 1.001 {
        let mut above = stiffness;
        for _ in 0..HALVINGS {
            let middle = (below * above).sqrt();
            if is_clean(middle)? {
                below = middle;
            } else {
                above = middle;
            }
        }
    }
    Ok(below)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_estimator_is_tried_that_the_rate_holds_back() {
        for rate in RATES {
            let between = estimators(rate).into_iter().filter(|entry| entry.0 == VelocityMethod::BetweenCounts);
            assert!(between.clone().count() >= 1 && between.into_iter().all(|(_, corner)| corner <= FASTEST * rate));
        }
    }
}
