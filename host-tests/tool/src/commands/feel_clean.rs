//! `palpate feel --clean`: the stiffest walls that are clean to slide along, by device, encoder and rate.

use crate::devices::ShippedDevice;
use crate::feel::{Clean, TRIED, Wish, clean_stiffness, plot, slice};
use anyhow::Context;
use palpate::device::VelocityMethod;
use palpate_sim::feel::Threshold;
use palpate_sim::zwidth::in_words;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Finds, prints, writes and draws them.
///
/// # Errors
/// Settings that are refused; a folder that cannot be written.
pub fn run(
    devices: &[&ShippedDevice],
    wish: impl Fn(&ShippedDevice) -> Wish + Sync,
    threshold: &Threshold,
    (rates, encoders): (&[f32], &[f64]),
    out: &Path,
) -> anyhow::Result<ExitCode> {
    // With one joint nothing slides.
    let devices: Vec<&ShippedDevice> =
        devices.iter().copied().filter(|device| device.preset.feeds().len() > 1).collect();
    println!("maximum stiffness, N/m, that is clean to slide along (that comes to rest), and its estimator:");
    println!("c: counts as they are, b: positions between counts; with its corner, Hz");
    print!("{:<20}{:>8}{:>6}", "device", "encoder", "µm");
    rates.iter().for_each(|rate| print!("{:>24}", format!("{} kHz", rate / 1_000.0)));
    println!();
    let all = find(&devices, wish, threshold, (rates, encoders))?;
    for (device, points) in devices.iter().zip(&all) {
        for row in points.chunks(rates.len()) {
            let finer = row.first().map_or(1.0, |point| point.finer);
            let slice = slice(device, finer);
            print!("{:<20}{:>8}{:>6.0}", device.name, format!("x{finer}"), slice.resolution * 1e6);
            for Clean { clean, stable, method, corner, .. } in row {
                let more = if *clean >= TRIED[1] * 0.99 { ">" } else { "" };
                let by = if *method == VelocityMethod::BetweenCounts { "b" } else { "c" };
                let by = if *clean > 0.0 { format!(" {by}{corner:.0}") } else { String::new() };
                print!("{:>24}", format!("{more}{clean:.0} ({}){by}", in_words(&slice, *stable)));
            }
            println!();
        }
    }
    let names = devices.iter().map(|device| device.name);
    let named: Vec<(&str, Vec<Clean>)> = names.zip(all).collect();
    std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    let (table, picture) = (out.join("clean.csv"), out.join("clean.svg"));
    write(&named, &table).with_context(|| format!("cannot write {}", table.display()))?;
    std::fs::write(&picture, plot::clean(&named)).with_context(|| format!("cannot write {}", picture.display()))?;
    println!("figures: {}\npicture: {}", table.display(), picture.display());
    Ok(ExitCode::SUCCESS)
}

/// By device: encoder after encoder, rate after rate; on all cores.
fn find(
    devices: &[&ShippedDevice],
    wish: impl Fn(&ShippedDevice) -> Wish + Sync,
    threshold: &Threshold,
    (rates, encoders): (&[f32], &[f64]),
) -> anyhow::Result<Vec<Vec<Clean>>> {
    let each = encoders.len() * rates.len();
    let next = AtomicUsize::new(0);
    let found = Mutex::new(Vec::new());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(device) = devices.get(index / each) else { return };
                    let [encoder, rate] = [index % each / rates.len(), index % rates.len()];
                    let wish = Wish { rate: rates[rate], ..wish(device) };
                    let point = clean_stiffness(device, &wish, encoders[encoder], threshold);
                    if let Ok(mut found) = found.lock() {
                        found.push((index, point));
                    }
                }
            });
        }
    });
    let mut found = found.into_inner().unwrap_or_default();
    found.sort_by_key(|(index, _)| *index);
    let points = found.into_iter().map(|(_, point)| point).collect::<anyhow::Result<Vec<Clean>>>()?;
    Ok(points.chunks(each).map(<[Clean]>::to_vec).collect())
}

fn write(all: &[(&str, Vec<Clean>)], path: &Path) -> csv::Result<()> {
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record(["device", "finer", "rate", "clean", "method", "corner", "stable"])?;
    for (device, points) in all {
        for Clean { rate, finer, clean, method, corner, stable } in points {
            let numbers = [finer.to_string(), rate.to_string(), clean.to_string()];
            let mut row = vec![(*device).to_owned()];
            row.extend(numbers);
            row.extend([format!("{method:?}"), corner.to_string(), stable.to_string()]);
            writer.write_record(row)?;
        }
    }
    writer.flush()?;
    Ok(())
}
