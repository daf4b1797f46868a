//! Every device on a line.

use super::sweeping::{best, sweep_with_bar};
use crate::devices::ShippedDevice;
use palpate::device::VelocityMethod;
use palpate::servo::recommended::Recommended;
use palpate_sim::zwidth::{Loop, Slice, SoftWall, in_words, max_stiffness};

/// The delay of the simulated devices, periods: a tick's duty takes effect at the next.
const DELAY: f64 = 1.0;

/// Sweeps devices and prints the maximum stiffness at each rate; below it that on a body that gives way, with an entry
/// for each rate.
///
/// # Errors
/// If the progress bar cannot be drawn.
pub fn print(devices: &[&ShippedDevice], rates: &[f64], like: Loop, soft: Option<&[SoftWall]>) -> anyhow::Result<()> {
    println!(
        "maximum stiffness at any damping, N/m, along z at the middle of the workspace (two joints: y, one: x) and in the \
         weakest direction of the workspace, behind {DELAY} period: simulated (passive, without damping); any: even full \
         force at half a count"
    );
    print!("{:<20}{:>8}{:>9}{:>8}{:>6}", "device", "kg", "N·s/m", "N", "µm");
    rates.iter().for_each(|rate| print!("{:>18}", format!("{} kHz", rate / 1_000.0)));
    if let Some([first, last]) = ends(rates) {
        print!("{:>14}", format!("{} : {} kHz", last / 1_000.0, first / 1_000.0));
    }
    println!();
    for device in devices {
        let slice = Slice::of(device);
        print_row(slice.name, &slice, rates, like)?;
        if soft.is_some() {
            let limits = sweep_with_bar(&slice, rates, &[DELAY], like, soft)?;
            print!("{:<51}", "  on the body");
            for rate in rates {
                print!("{:>18}", in_words(&slice, best(&limits, *rate, DELAY)[0]));
            }
            println!();
        }
        if let Some((_, weak)) = weakest(device) {
            print_row("  weakest direction", &weak, rates, like)?;
        }
    }
    println!();
    for device in devices {
        println!("{}: {}", device.name, device.assumed);
        if let Some((place, _)) = weakest(device) {
            println!("  weakest direction {place}");
        }
    }
    Ok(())
}

/// The maximum stiffness with the rendering recommended for a device, at 4 kHz or the first of the rates, and half of it
/// as the entry of the device file: the simulation assumes what the file does not state. A stiffer wall than 10,000 N/m
/// is not looked at in `palpate feel --clean` either.
pub(super) fn answer(device: &ShippedDevice, rates: &[f64]) -> String {
    let Recommended { settings, .. } = device.recommended();
    let rate = typical(rates);
    let (servo, damping) = recommended(device, rate);
    let corner = servo.corner;
    let (place, slice) =
        weakest(device).unwrap_or_else(|| ("in the middle of the workspace".to_owned(), Slice::of(device)));
    let most = max_stiffness(&slice, damping, &servo);
    let entry = (10.0 * (0.05 * most).floor()).min(10_000.0);
    let limit = f64::from(device.preset.limits().stiffness);
    let recommended = settings.stiffness_n_per_m;
    let margins = [limit, recommended.into()].map(|stiffness| most / stiffness);
    let beyond = if margins[0] < 1.0 { ", unstable here" } else { "" };
    format!(
        "recommended rendering (smooth: position between counts, {corner} Hz; eased), {damping} N·s/m, {} kHz, weakest \
         direction {place}: up to {} N/m\ngain margin there: {:.1} with this device's max_stiffness, {limit} N/m{beyond}; \
         {:.1} with the recommended stiffness, {recommended} N/m\nmax_stiffness = {entry:.1}   # half of it, a gain margin of 2; then the bench",
        rate / 1_000.0,
        in_words(&slice, most),
        margins[0],
        margins[1]
    )
}

/// The maximum stiffness with the rendering recommended for a device along each axis at the middle of its workspace, and
/// the cause that limits it most, a line each.
pub(super) fn axes(device: &ShippedDevice, rate: f64) -> Vec<String> {
    let (servo, damping) = recommended(device, rate);
    let axes = ["x", "y", "z"].into_iter().enumerate().take(device.plant.mechanism(0.0).joints());
    let each = axes.filter_map(|(axis, name)| {
        let mut direction = [0.0; 3];
        direction[axis] = 1.0;
        let slice = Slice::along(device, [0.0; 3], direction)?;
        let most = in_words(&slice, max_stiffness(&slice, damping, &servo));
        Some(format!("  {name}  {:>6} N/m, limited by {}", most, limited_by(&slice, damping, &servo)))
    });
    each.collect()
}

/// The one of counts, delay and velocity estimator without which a wall may be stiffest.
fn limited_by(slice: &Slice, damping: f64, servo: &Loop) -> &'static str {
    let without = [
        ("counts", Slice { resolution: FINE * slice.resolution, ..*slice }, *servo),
        ("delay", Slice { time_constant: 0.0, ..*slice }, Loop { delay_periods: 0.0, ..*servo }),
        // The difference of two ticks.
        ("estimator", *slice, Loop { velocity: VelocityMethod::LowPass, corner: servo.rate, ..*servo }),
    ];
    let found = without.map(|(cause, slice, servo)| (cause, max_stiffness(&slice, damping, &servo)));
    found.into_iter().max_by(|(_, one), (_, other)| one.total_cmp(other)).map_or("nothing", |(cause, _)| cause)
}

/// A count so small that it limits nothing, as a fraction of the real one.
const FINE: f64 = 1e-3;

/// The recommended loop of a device at a rate, Hz, behind a period, and its damping, N·s/m.
fn recommended(device: &ShippedDevice, rate: f64) -> (Loop, f64) {
    let Recommended { settings, rendering } = device.recommended();
    let corner = f64::from(settings.velocity_corner_hz);
    let servo = Loop { rate, delay_periods: DELAY, velocity: rendering.velocity, corner, ease: rendering.ease };
    (servo, settings.damping_n_s_per_m.into())
}

/// 4 kHz or the first of several rates, Hz.
pub(super) fn typical(rates: &[f64]) -> f64 {
    rates.iter().copied().find(|rate| *rate == 4_000.0).or(rates.first().copied()).unwrap_or(4_000.0)
}

/// Where and along what an undamped wall of a device is weakest, and its slice there.
pub(super) fn weakest(device: &ShippedDevice) -> Option<(String, Slice)> {
    let ([x, y, z], [along_x, along_y, along_z], slice) = Slice::weakest(device)?;
    let [x, y, z] = [x, y, z].map(|length| 1e3 * length);
    Some((format!("at ({x:.0}, {y:.0}, {z:.0}) mm along ({along_x:.2}, {along_y:.2}, {along_z:.2})"), slice))
}

/// The first and the last of several rates.
fn ends(rates: &[f64]) -> Option<[f64; 2]> {
    let ends = [*rates.first()?, *rates.last()?];
    (ends[0] < ends[1]).then_some(ends)
}

fn print_row(name: &str, slice: &Slice, rates: &[f64], like: Loop) -> anyhow::Result<()> {
    let limits = sweep_with_bar(slice, rates, &[DELAY], like, None)?;
    let Slice { mass, viscous, coulomb, resolution, .. } = slice;
    print!("{name:<20}{mass:>8.4}{viscous:>9.3}{coulomb:>8.3}{:>6.0}", resolution * 1e6);
    for rate in rates {
        let [simulated, passive] = best(&limits, *rate, DELAY);
        print!("{:>18}", format!("{} ({passive:.1})", in_words(slice, simulated)));
    }
    if let Some(ends) = ends(rates) {
        let [low, high] = ends.map(|rate| best(&limits, rate, DELAY)[0]);
        print!("{:>14.2}", high / low);
    }
    println!();
    if let Some(low) = limits.iter().find(|limit| limit.simulated < limit.passive * 0.98) {
        println!("BELOW THE PASSIVE BOUND: {low:?}");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::own_device;
    use palpate_sim::devices::{OwnDevice, named};

    #[test]
    fn each_axis_has_its_limit_and_cause() {
        let slice = Slice::of(named("woodenhaptics-2016").expect("it ships"));
        let (servo, damping) = recommended(named("woodenhaptics-2016").expect("it ships"), 4_000.0);
        // A count of 5 mm, and a delay of ten periods behind fine counts.
        let coarse = Slice { resolution: 5e-3, ..slice };
        assert_eq!(limited_by(&coarse, damping, &servo), "counts");
        let fine = Slice { resolution: 1e-8, ..slice };
        assert_eq!(limited_by(&fine, damping, &Loop { delay_periods: 10.0, ..servo }), "delay");
        for (name, rows) in [("woodenhaptics-2016", 3), ("haply-2diy-v3", 2), ("hapkit", 1)] {
            let lines = axes(named(name).expect("it ships"), 4_000.0);
            println!("{name}: {lines:?}");
            assert_eq!(lines.len(), rows, "{lines:?}");
            assert!(lines.iter().all(|line| line.contains(" N/m, limited by ")), "{lines:?}");
        }
    }

    #[test]
    fn the_entry_holds_what_is_recommended_and_falls_with_coarser_encoders() {
        let entry = |counts: f64| {
            let mut file = named("woodenhaptics-2016").and_then(|device| device.file()).expect("a file of it");
            file.joint.iter_mut().for_each(|joint| joint.encoder.counts = counts);
            let device = own_device(&OwnDevice::new(file, "arm.toml").expect("a device"), "arm.toml");
            let answer = answer(device, &[1_000.0, 4_000.0]);
            // The shipped device's own limit and its recommended stiffness, N/m.
            assert!(answer.contains("max_stiffness, 1000 N/m") && answer.contains("stiffness, 500 N/m\n"), "{answer}");
            let entry = answer.lines().last().and_then(|line| line.strip_prefix("max_stiffness = "));
            let entry = entry.and_then(|entry| entry.split(' ').next()).and_then(|entry| entry.parse::<f64>().ok());
            assert!(answer.contains(" 4 kHz, "), "{answer}");
            entry.expect("an entry of the file")
        };
        let [fine, coarse] = [2_000.0, 250.0].map(entry);
        assert!((500.0..=10_000.0).contains(&fine), "{fine}");
        assert!(coarse < fine, "{coarse} {fine}");
    }
}
