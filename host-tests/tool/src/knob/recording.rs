//! The cogging of a knob's motor, recorded over its line while somebody holds button and key.

use super::cogging::{LED, Recording, Sample, analyse};
use super::{JOG, led_torque};
use crate::commission::device::said;
use crate::commission::{Device, Hands};
use anyhow::bail;
use palpate::wire::Reading;

/// Steps of a fiftieth of a second in which the key may be found: half a minute.
const PATIENCE: u32 = 1_500;

/// What a reading says of field and rotor.
const fn sample(reading: &Reading) -> Sample {
    Sample { field: reading.counts[2], counts: reading.counts[0] }
}

/// Leads the field of a knob that is being set up round its motor, there and back, and makes its map.
///
/// # Errors
/// Key or button let go of, what the device refuses, and a rotor that did not follow: nothing is recorded then.
pub fn record(device: &mut Device, hands: &mut dyn Hands) -> anyhow::Result<Recording> {
    hands.enable(false)?;
    device.step(None)?;
    hands.enable(true)?;
    device.wait_for_enable()?;
    let duty = (JOG.share * 32_767.0) as i16;
    wait_for_key(device, duty)?;
    let begun = sample(&device.last()).field;
    let mut ways = [Vec::new(), Vec::new()];
    for (way, duty) in ways.iter_mut().zip([duty, -duty]) {
        loop {
            let reading = device.step_telling(Some((0, duty)), |reading| {
                let Sample { field, counts } = sample(reading);
                way.push(Sample { field: field.wrapping_sub(begun), counts });
            })?;
            if !reading.live {
                let why = said(&reading);
                // What was refused stands until the key is let go.
                device.step(None)?;
                bail!("the recording has ended before its time{why}; nothing is written: begin anew");
            }
            let gone = sample(&reading).field.wrapping_sub(begun);
            if if duty > 0 { gone >= LED } else { gone <= 0 } {
                break;
            }
        }
    }
    device.step(None)?;
    hands.enable(false)?;
    let [there, back] = &ways;
    Ok(analyse([there, back], f64::from(led_torque(JOG.share)))?)
}

/// Until the key is held.
fn wait_for_key(device: &mut Device, duty: i16) -> anyhow::Result<()> {
    for _ in 0..PATIENCE {
        let reading = device.step(Some((0, duty)))?;
        if reading.live {
            return Ok(());
        }
        if reading.refusal != 0 {
            bail!("the knob does not begin{}", said(&reading));
        }
    }
    bail!("nobody holds the key for half a minute{}", said(&device.last()))
}
