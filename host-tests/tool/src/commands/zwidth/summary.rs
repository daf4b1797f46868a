//! Every device on a line.

use super::sweeping::{best, sweep_with_bar};
use crate::devices::ShippedDevice;
use palpate_sim::zwidth::{Loop, Slice, SoftWall, in_words};

/// The delay of the simulated devices, periods: a tick's duty takes effect at the next.
const DELAY: f64 = 1.0;

/// Sweeps devices and prints the maximum stiffness at each rate; below it that on a body that gives way, with an entry
/// for each rate.
///
/// # Errors
/// If the progress bar cannot be drawn.
pub fn print(devices: &[&ShippedDevice], rates: &[f64], like: Loop, soft: Option<&[SoftWall]>) -> anyhow::Result<()> {
    println!(
        "maximum stiffness at any damping, N/m, along z at the middle of the workspace (two joints: y, one: x; `--device NAME` \
         adds the weakest direction), behind {DELAY} period: simulated (passive, without damping); any: even full force at half a count"
    );
    print!("{:<20}{:>8}{:>9}{:>8}{:>6}", "device", "kg", "N·s/m", "N", "µm");
    rates.iter().for_each(|rate| print!("{:>18}", format!("{} kHz", rate / 1_000.0)));
    let ends = rates.first().zip(rates.last()).filter(|(first, last)| first < last);
    if let Some((first, last)) = ends {
        print!("{:>14}", format!("{} : {} kHz", last / 1_000.0, first / 1_000.0));
    }
    println!();
    for device in devices {
        let slice = Slice::of(device);
        let limits = sweep_with_bar(&slice, rates, &[DELAY], like, None)?;
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
        if soft.is_some() {
            let limits = sweep_with_bar(&slice, rates, &[DELAY], like, soft)?;
            print!("{:<51}", "  on the body");
            for rate in rates {
                print!("{:>18}", in_words(&slice, best(&limits, *rate, DELAY)[0]));
            }
            println!();
        }
        if let Some(low) = limits.iter().find(|limit| limit.simulated < limit.passive * 0.98) {
            println!("BELOW THE PASSIVE BOUND: {low:?}");
        }
    }
    println!();
    for device in devices {
        println!("{}: {}", device.name, device.assumed);
    }
    Ok(())
}
