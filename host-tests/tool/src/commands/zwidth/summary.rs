//! Every device on a line.

use super::sweeping::{best, sweep_with_bar};
use crate::devices::DEVICES;
use palpate_sim::zwidth::{Loop, Slice, in_words};

/// The delay of the simulated devices, periods: a tick's duty takes effect at the next.
const DELAY: f64 = 1.0;

/// Sweeps every device and prints the maximum stiffness at each rate.
///
/// # Errors
/// If the progress bar cannot be drawn.
pub fn print(rates: &[f64], like: Loop) -> anyhow::Result<()> {
    println!(
        "maximum stiffness at any damping, N/m, behind {DELAY} period: simulated (passive, without damping); any: even full force at half a count"
    );
    print!("{:<20}{:>8}{:>9}{:>8}{:>6}", "device", "kg", "N·s/m", "N", "µm");
    rates.iter().for_each(|rate| print!("{:>18}", format!("{} kHz", rate / 1_000.0)));
    let ends = rates.first().zip(rates.last()).filter(|(first, last)| first < last);
    if let Some((first, last)) = ends {
        print!("{:>14}", format!("{} : {} kHz", last / 1_000.0, first / 1_000.0));
    }
    println!();
    for device in &DEVICES {
        let slice = Slice::of(device);
        let limits = sweep_with_bar(&slice, rates, &[DELAY], like)?;
        print!(
            "{:<20}{:>8.4}{:>9.3}{:>8.3}{:>6.0}",
            slice.name,
            slice.mass,
            slice.viscous,
            slice.coulomb,
            slice.resolution * 1e6
        );
        for rate in rates {
            let [simulated, passive] = best(&limits, *rate, DELAY);
            print!("{:>18}", format!("{} ({passive:.1})", in_words(&slice, simulated)));
        }
        if let Some((first, last)) = ends {
            let [low, high] = [first, last].map(|rate| best(&limits, *rate, DELAY)[0]);
            print!("{:>14.2}", high / low);
        }
        println!();
        if let Some(low) = limits.iter().find(|limit| limit.simulated < limit.passive * 0.98) {
            println!("BELOW THE PASSIVE BOUND: {low:?}");
        }
    }
    println!();
    for device in &DEVICES {
        println!("{}: {}", device.name, device.assumed);
    }
    Ok(())
}
