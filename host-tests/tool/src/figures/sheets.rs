//! All figures of a patch: files of drawings and numbers, and the lines of the table.

use super::attraction::{Comparison, DRAWN};
use super::attraction::{Contender, seeded_targets, start_grid};
use super::invariance::draw_passage;
use super::invariance::{self, Passage};
use super::rate::draw_rates;
use super::rate::{Lag, Rate};
use super::subject::Subject;
use super::tour::Touring;
use super::tour::{draw_regions, draw_tour};
use super::tracking::{self, Configuration, Limit};
use super::tracking::{draw_limits, draw_tracking};
use super::{attraction_plot, rate};
use anyhow::ensure;
use palpate::track::Integrator;
use std::fmt::Write as _;

/// Settings of the figures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Probes of Figure 7.
    pub probes: usize,
    /// Minimum and maximum distance of the probes from the patch, as multiples of its size.
    pub distances: [f64; 2],
    /// Their seed.
    pub seed: u64,
}

/// Stage of the computation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Figure 6: the search for a passage.
    Passage,
    /// Figure 7: the basins.
    Basins,
}

/// A figure of a patch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sheet {
    /// Name and contents of each file.
    pub files: Vec<(String, String)>,
    /// Name and value of each number that the table shows.
    pub rows: Vec<(String, String)>,
}

impl Sheet {
    fn row(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.rows.push((name.into(), value.into()));
    }
}

/// Computes all figures of a patch. `progress` receives the stage, the number of finished parts and their total.
///
/// # Errors
/// A patch without a probe for Figure 7, a measured limit far from the prediction, or a drawing that failed.
pub fn sheets(
    subject: &Subject,
    options: Options,
    mut progress: impl FnMut(Stage, usize, usize),
) -> anyhow::Result<Vec<Sheet>> {
    Ok(vec![
        invariance(subject, |done, all| progress(Stage::Passage, done, all))?,
        attraction(subject, options, |done, all| progress(Stage::Basins, done, all))?,
        tracking(subject)?,
        rates(subject)?,
    ])
}

/// Cells of a slice of Figure 3, along each side.
const CELLS: usize = 120;

/// Figures 3 and 9 of a body.
///
/// # Errors
/// A drawing that failed.
pub fn body_sheet(touring: &Touring) -> anyhow::Result<Sheet> {
    let mut sheet = Sheet::default();
    let slices = touring.slices(CELLS);
    let owners: std::collections::BTreeSet<u16> =
        slices.iter().flat_map(|slice| slice.cells.iter().flatten().flatten()).map(|feature| feature.code()).collect();
    sheet.row("figure 3", format!("{} regions in two slices", owners.len()));
    sheet.files.push((format!("{}-figure3.svg", touring.name), draw_regions(&slices)));
    let samples = touring.tour();
    let features: Vec<_> = samples.chunk_by(|a, b| a.feature == b.feature).collect();
    let settled = samples.iter().skip(100).map(|sample| sample.excess).fold(0.0, f64::max);
    let rise = samples.iter().map(|sample| sample.rise).fold(0.0, f64::max);
    sheet.row("figure 9", format!("{} ticks, {} features one after another", samples.len(), features.len()));
    sheet.row("  distance too long by", format!("{:.1e} m at most after 0.1 s", settled));
    sheet.row("  largest rise of ‖ΔR‖", format!("{rise:.1e} m in a tick, switches included"));
    let mut csv = "time_s,qx_mm,qy_mm,qz_mm,px_mm,py_mm,pz_mm,feature,u,v,excess_mm\n".to_owned();
    for sample in &samples {
        let ([qx, qy, qz], [px, py, pz]) = ((sample.probe * 1e3).to_array(), (sample.witness * 1e3).to_array());
        let ([u, v], feature, excess) = (sample.parameters, sample.feature, sample.excess * 1e3);
        let feature = format!("{feature:?}").to_lowercase().replace('(', " ").replace(')', "");
        let time = sample.time;
        writeln!(csv, "{time:.3},{qx:.5},{qy:.5},{qz:.5},{px:.5},{py:.5},{pz:.5},{feature},{u:.7},{v:.7},{excess:.7}")?;
    }
    sheet.files.push((format!("{}-figure9.svg", touring.name), draw_tour(touring, &samples)));
    sheet.files.push((format!("{}-figure9.csv", touring.name), csv));
    Ok(sheet)
}

fn invariance(subject: &Subject, progress: impl FnMut(usize, usize)) -> anyhow::Result<Sheet> {
    let mut sheet = Sheet::default();
    let Some(passage) = Passage::search(subject, progress) else {
        sheet.row("figure 6", "left out: no start of the search goes interior, border, interior");
        return Ok(sheet);
    };
    let mut csv = "time_s,u,v,x_mm,y_mm,z_mm,mode,psi_u,psi_v,distance_mm\n".to_owned();
    for sample in &passage.samples {
        let ([u, v], [x, y, z]) = (sample.parameters, (sample.point * 1e3).to_array());
        let ([psi_u, psi_v], mode) = (sample.errors, sample.mode as u8);
        let (time, distance) = (sample.time, sample.distance * 1e3);
        writeln!(csv, "{time:.3},{u:.7},{v:.7},{x:.5},{y:.5},{z:.5},{mode},{psi_u:.7},{psi_v:.7},{distance:.5}")?;
    }
    let [start, closest] = [passage.samples[0].parameters, passage.closest.parameters];
    sheet.row("figure 6", format!("K = {} 1/s, {}", invariance::GAIN, modes(&passage)));
    sheet.row("  P0, P*", format!("({:.3}, {:.3}), ({:.3}, {:.3})", start[0], start[1], closest[0], closest[1]));
    let times = [passage.meets_border, passage.leaves_border, passage.arrives];
    sheet.row("  t1, t2, t3", format!("{:.3}, {:.3}, {:.3} s", times[0], times[1], times[2]));
    let rises = |axis| if passage.error_rises(axis) { "rises" } else { "falls throughout" };
    sheet.row("  |psi_u|, |psi_v|", format!("{}, {}", rises(0), rises(1)));
    sheet.row("  largest rise of ‖ΔR‖", format!("{:.1e} m", passage.largest_rise()));
    sheet.row("  second order", format!("at rest after {} ticks", passage.second_order.len() - 1));
    sheet.files.push((format!("{}-figure6.svg", subject.name), draw_passage(subject, &passage)));
    sheet.files.push((format!("{}-figure6.csv", subject.name), csv));
    Ok(sheet)
}

fn modes(passage: &Passage) -> String {
    let numbers: Vec<_> =
        passage.samples.chunk_by(|a, b| a.mode == b.mode).map(|stretch| (stretch[0].mode as u8).to_string()).collect();
    format!("modes {}", numbers.join(" → "))
}

fn attraction(subject: &Subject, options: Options, progress: impl FnMut(usize, usize)) -> anyhow::Result<Sheet> {
    let targets = seeded_targets(subject, options.probes, options.distances, options.seed);
    ensure!(
        targets.len() == options.probes && !targets.is_empty(),
        "{}: figure 7: only {} of {} probes have their closest point where they were set out",
        subject.name,
        targets.len(),
        options.probes
    );
    let comparison = Comparison::new(subject, targets, progress);
    let mut sheet = Sheet::default();
    let drawn = comparison.drawn;
    sheet.row("figure 7", format!("{} probes, probe {drawn} drawn; mean, worst, drawn:", comparison.targets.len()));
    for (index, contender) in Contender::ALL.into_iter().enumerate() {
        let (mean, worst) = comparison.mean_and_worst(contender);
        let shares = [mean, worst, comparison.shares[drawn][index]].map(|share| format!("{:6.2} %", 100.0 * share));
        sheet.row(format!("  {}", contender.name()), shares.join(" "));
    }
    sheet.files.push((format!("{}-figure7.svg", subject.name), attraction_plot::draw(subject, &comparison)));

    let mut probes = "probe,qx_mm,qy_mm,qz_mm,distance_mm,u,v".to_owned();
    Contender::ALL.iter().try_for_each(|contender| write!(probes, ",{}", contender.name()))?;
    for (index, (target, shares)) in comparison.targets.iter().zip(&comparison.shares).enumerate() {
        let [x, y, z] = (target.probe.as_dvec3() * 1e3).to_array();
        let ([u, v], distance) = (target.closest.parameters, target.closest.distance * 1e3);
        write!(probes, "\n{index},{x:.5},{y:.5},{z:.5},{distance:.5},{u:.7},{v:.7}")?;
        shares.iter().try_for_each(|share| write!(probes, ",{share:.6}"))?;
    }
    probes.push('\n');
    sheet.files.push((format!("{}-figure7-probes.csv", subject.name), probes));

    let mut basins = "controller,u,v,converges,steps\n".to_owned();
    let mut paths = "controller,step,u,v\n".to_owned();
    for (contender, (basin, run)) in DRAWN.iter().zip(comparison.basins.iter().zip(&comparison.runs)) {
        for ([u, v], (found, steps)) in start_grid().zip(&basin.starts) {
            writeln!(basins, "{},{u:.2},{v:.2},{},{steps}", contender.name(), u8::from(*found))?;
        }
        for (step, [u, v]) in run.path.iter().enumerate() {
            writeln!(paths, "{},{step},{u:.7},{v:.7}", contender.name())?;
        }
    }
    sheet.files.push((format!("{}-figure7-basins.csv", subject.name), basins));
    sheet.files.push((format!("{}-figure7-paths.csv", subject.name), paths));
    Ok(sheet)
}

fn tracking(subject: &Subject) -> anyhow::Result<Sheet> {
    let mut sheet = Sheet::default();
    let oracle = subject.oracle();
    let Some(rest) = Configuration::find(subject, &oracle) else {
        sheet.row("figure 8", "left out: no convex place to track over");
        return Ok(sheet);
    };
    let runs = tracking::runs(subject, &rest);
    let certified = tracking::certified_runs(subject, &rest);
    let mut csv = "gain,time_s,u,v,psi_u,psi_v,distance_mm\n".to_owned();
    let gains = tracking::GAINS.map(|gain| gain.to_string());
    let laws = gains.iter().map(String::as_str).chain(["certified", "second-order"]);
    for (gain, run) in laws.zip(runs.iter().chain(&certified)) {
        // The slow run is long: what it shows needs no more rows than the others.
        for sample in run.iter().step_by(run.len().div_ceil(2_000)) {
            let ([u, v], [psi_u, psi_v]) = (sample.parameters, sample.errors);
            let distance = sample.witness.distance(sample.probe) * 1e3;
            writeln!(csv, "{gain},{:.3},{u:.7},{v:.7},{psi_u:.7},{psi_v:.7},{distance:.5}", sample.time)?;
        }
    }
    let limits = tracking::limits(subject, &oracle, &rest)?;
    let predicted = rest.predicted_limit(Integrator::Euler);
    let measured = rest.measured_limit(subject, Integrator::Euler)?;
    let product = rest.curvature * rest.distance;
    sheet.row(
        "figure 8",
        format!("κ = {:.1} 1/m, ‖ΔR‖ = {:.3} mm, κ ‖ΔR‖ = {product:.3}", rest.curvature, rest.distance * 1e3),
    );
    sheet.row("  stable below", format!("{measured:.1} 1/s measured, {predicted:.1} 1/s predicted"));
    let error = |limit: &Limit| (limit.measured / limit.predicted - 1.0).abs();
    let worst = limits.iter().map(error).fold(0.0, f64::max);
    sheet.row("  all integrators, distances", format!("measured within {:.2} % of predicted", 100.0 * worst));
    for (gain, run) in tracking::GAINS.iter().zip(&runs) {
        let left = run.last().map_or(0.0, |sample| sample.errors[0].hypot(sample.errors[1]));
        let end = run.last().map_or(0.0, |sample| sample.time);
        sheet.row(format!("  K = {gain} 1/s"), format!("‖Ψ‖ = {left:.1e} after {end:.1} s"));
    }
    for (law, run) in ["the paper's, certified gain", "second order"].iter().zip(&certified) {
        // From the tick on at which the start is corrected: a fifth of the motion.
        let behind = run.iter().filter(|sample| (0.1..tracking::MOTION).contains(&sample.time));
        let most = behind.map(|sample| sample.left).fold(0.0, f64::max);
        sheet.row(
            format!("  {law}"),
            format!("a tick leaves ‖Ψ‖ = {most:.1e} at most, from 0.1 s to {} s", tracking::MOTION),
        );
    }
    sheet.files.push((format!("{}-figure8.svg", subject.name), draw_tracking(subject, &runs, &certified)));
    sheet.files.push((format!("{}-figure8.csv", subject.name), csv));
    sheet.files.push((format!("{}-figure8-limits.svg", subject.name), draw_limits(&limits, &rest)));
    let mut csv = "integrator,curvature_times_distance,predicted_per_s,measured_per_s\n".to_owned();
    for Limit { integrator, product, predicted, measured } in &limits {
        writeln!(csv, "{integrator:?},{product:.1},{predicted:.2},{measured:.2}")?;
    }
    sheet.files.push((format!("{}-figure8-limits.csv", subject.name), csv));
    Ok(sheet)
}

/// How fast the laws arrive, and how far behind they are: local rate and lag.
fn rates(subject: &Subject) -> anyhow::Result<Sheet> {
    let mut sheet = Sheet::default();
    let oracle = subject.oracle();
    let rates = rate::rates(subject, &oracle);
    let Some(rest) = Configuration::find(subject, &oracle).filter(|_| !rates.is_empty()) else {
        sheet.row("rate", "left out: no convex place to arrive at");
        return Ok(sheet);
    };
    let lags = rate::lags(subject, &rest);
    sheet.row("rate", "‖x − x*‖ after each tick of second order");
    for Rate { place, errors: [_, second], .. } in &rates {
        let ticks: Vec<_> = second.iter().take(6).map(|error| format!("{error:.0e}")).collect();
        sheet.row(format!("  {place}"), ticks.join(", "));
    }
    for (law, index) in [("the paper's law", 0), ("second order", 1)] {
        sheet.row(format!("  lag, {law}"), format!("grows as the speed to the power {:.2}", rate::power(&lags, index)));
    }
    let mut csv = "place,tick,first_order,second_order\n".to_owned();
    for Rate { place, errors: [first, second] } in &rates {
        for (tick, (first, second)) in first.iter().zip(second).enumerate() {
            writeln!(csv, "{place},{tick},{first:.3e},{second:.3e}")?;
        }
    }
    sheet.files.push((format!("{}-rate.csv", subject.name), csv));
    let mut csv = "speed_m_per_s,first_order,second_order\n".to_owned();
    for Lag { speed, errors: [first, second] } in &lags {
        writeln!(csv, "{speed:.4},{first:.3e},{second:.3e}")?;
    }
    sheet.files.push((format!("{}-lag.csv", subject.name), csv));
    sheet.files.push((format!("{}-rate.svg", subject.name), draw_rates(&rates, &lags)));
    Ok(sheet)
}
