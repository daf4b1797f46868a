//! Figure 7 in numbers: all controllers on all probes, and the probe and start that are drawn.

use super::attraction::{Basin, Contender, Run, Target, start_grid};
use super::subject::Subject;
use palpate_truth::baselines::Errors;

/// The controllers of the paper's figure, in its order, and the law of second order.
pub const DRAWN: [Contender; 4] = [
    Contender::Newton(Errors::MeasureNumbers),
    Contender::SaturatedNewton(Errors::MeasureNumbers),
    Contender::Switching,
    Contender::SecondOrder,
];

/// All controllers on all probes.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The probes.
    pub targets: Vec<Target>,
    /// A row a probe: the share of starts that find the closest point, for [`Contender::ALL`].
    pub shares: Vec<[f64; Contender::ALL.len()]>,
    /// Index of the probe that is drawn.
    pub drawn: usize,
    /// The start of the paths that are drawn.
    pub start: [f64; 2],
    /// The basins of [`DRAWN`] for that probe.
    pub basins: [Basin; DRAWN.len()],
    /// The paths of [`DRAWN`] from that start.
    pub runs: [Run; DRAWN.len()],
}

impl Comparison {
    /// Compares; there must be a probe. `progress` hears of every probe done.
    pub fn new(subject: &Subject, targets: Vec<Target>, mut progress: impl FnMut(usize, usize)) -> Self {
        let count = targets.len();
        let row = |(index, target): (usize, &Target)| {
            let shares = Contender::ALL.map(|contender| Basin::new(contender, subject, target).share());
            progress(index + 1, count);
            shares
        };
        let shares: Vec<_> = targets.iter().enumerate().map(row).collect();
        let (drawn, start) = representative(subject, &targets, &shares);
        let target = &targets[drawn];
        Self {
            basins: DRAWN.map(|contender| Basin::new(contender, subject, target)),
            runs: DRAWN.map(|contender| contender.run(subject, target.probe, start)),
            targets,
            shares,
            drawn,
            start,
        }
    }

    /// The mean and the least share of a controller over all probes.
    pub fn mean_and_worst(&self, contender: Contender) -> (f64, f64) {
        let index = Contender::ALL.iter().position(|other| *other == contender).unwrap_or_default();
        let shares = || self.shares.iter().map(|row| row[index]);
        (shares().sum::<f64>() / self.shares.len() as f64, shares().fold(1.0, f64::min))
    }
}

/// The probe whose basin under Newton is nearest to the mean in size, among those with a start that tells the paper's
/// story: Newton leaves the patch, saturation bounces off the border at least twice and still arrives. Of its starts
/// the one that bounces least, then the one that saturation is done with first. Without such a probe, the most average
/// one and its first start from which Newton fails.
fn representative(subject: &Subject, targets: &[Target], shares: &[[f64; Contender::ALL.len()]]) -> (usize, [f64; 2]) {
    let mean = shares.iter().map(|row| row[0]).sum::<f64>() / shares.len() as f64;
    let mut order: Vec<usize> = (0..targets.len()).collect();
    order.sort_by(|a, b| (shares[*a][0] - mean).abs().total_cmp(&(shares[*b][0] - mean).abs()));
    let [newton, saturated, ..] = DRAWN;
    let fails = |index: usize, start| newton.run(subject, targets[index].probe, start).left;
    for &index in &order {
        let story = start_grid().filter(|start| fails(index, *start)).filter_map(|start| {
            let run = saturated.run(subject, targets[index].probe, start);
            let inside = start.iter().all(|parameter| *parameter > 0.0 && *parameter < 1.0);
            let tells = inside && run.border_visits() >= 2 && run.found(subject, &targets[index]);
            tells.then(|| ((run.border_visits(), run.steps()), start))
        });
        if let Some((_, start)) = story.min_by_key(|(bounces, _)| *bounces) {
            return (index, start);
        }
    }
    let index = order.first().copied().unwrap_or_default();
    (index, start_grid().find(|start| fails(index, *start)).unwrap_or_default())
}
