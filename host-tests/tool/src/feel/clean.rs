//! The greatest clean stiffness: the stiffest wall along which a hand slides without feeling the loop.

use super::rows::{Wish, slide};
use crate::devices::ShippedDevice;
use crate::zwidth::{Loop, Slice, max_stiffness};
use palpate_feel::Threshold;

/// Servo rates, Hz.
pub const RATES: [f32; 5] = [1_000.0, 2_000.0, 4_000.0, 8_000.0, 10_000.0];
/// The softest and the stiffest wall that is tried, N/m.
pub const TRIED: [f64; 2] = [100.0, 10_000.0];
/// Steps a decade from one stiffness to the next; then halvings between the last clean one and the first that is not:
/// 8 %.
const STEPS_PER_DECADE: f64 = 4.0;
const HALVINGS: usize = 3;
/// A tick's duty takes effect at the next.
const DELAY: f64 = 1.0;

/// What a device gives at a rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clean {
    /// Servo rate, Hz.
    pub rate: f32,
    /// The stiffest wall below which each that was tried is clean, N/m; 0 if the softest is not.
    pub clean: f64,
    /// The stiffest wall of the same damping that comes to rest, N/m: the Z-width.
    pub stable: f64,
}

/// The greatest clean stiffness at a rate, whatever the device is recommended for; beside it the Z-width's.
///
/// # Errors
/// Settings that are refused, a start out of reach, a fault of the loop.
pub fn clean_stiffness(device: &ShippedDevice, wish: &Wish, threshold: &Threshold) -> anyhow::Result<Clean> {
    let is_clean = |stiffness: f64| -> anyhow::Result<bool> {
        let wish = Wish { stiffness: stiffness as f32, ..*wish };
        Ok(slide(device, &wish, threshold)?.is_below())
    };
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
    let servo = Loop {
        rate: f64::from(wish.rate),
        delay_periods: DELAY,
        velocity: wish.rendering.velocity,
        corner: f64::from(wish.corner),
        ease: wish.rendering.ease,
    };
    let damping = f64::from(wish.settings(device).damping);
    Ok(Clean { rate: wish.rate, clean: below, stable: max_stiffness(&Slice::of(device), damping, &servo) })
}
