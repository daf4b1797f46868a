//! The paper's Figures 6 to 8 in numbers.

use palpate::track::{BoundaryMode, Integrator};
use palpate_tool::figures::attraction::{Basin, Contender, Target};
use palpate_tool::figures::invariance::Passage;
use palpate_tool::figures::rate::{self, Rate};
use palpate_tool::figures::tracking::{self, Configuration, PAPER_LIMIT};
use palpate_tool::figures::{Options, Subject, sheets};
use palpate_truth::baselines::Errors;
use palpate_truth::oracle::golden::{ClosestRow, read};
use std::path::{Path, PathBuf};

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn subject(name: &str) -> Subject {
    Subject::read(&here(&format!("../models/{name}.toml"))).expect("the model is good")
}

/// The first probes of a golden file; all lie over the inside of the patch.
fn golden_targets(subject: &Subject, count: usize) -> Vec<Target> {
    let rows: Vec<ClosestRow> =
        read(&here(&format!("../truth/golden/{}_near.csv", subject.name))).expect("golden data");
    let oracle = subject.oracle();
    rows.iter()
        .take(count)
        .map(|row| {
            // The file is in centimetres.
            let probe = (row.query() * 0.01).as_vec3();
            Target { probe, closest: oracle.closest(probe.as_dvec3()) }
        })
        .collect()
}

/// Mean and least share of the starts that converge.
fn shares(contender: Contender, subject: &Subject, targets: &[Target]) -> (f64, f64) {
    let shares: Vec<_> = targets.iter().map(|target| Basin::new(contender, subject, target).share()).collect();
    let (mean, worst) = (shares.iter().sum::<f64>() / shares.len() as f64, shares.iter().copied().fold(1.0, f64::min));
    println!(
        "{}, {}: {:.2} % on average, {:.2} % at worst",
        subject.name,
        contender.name(),
        100.0 * mean,
        100.0 * worst
    );
    (mean, worst)
}

#[test]
fn figure_7_ours_converges_from_every_start_and_newton_from_few() {
    for name in ["table1c", "table1"] {
        let subject = subject(name);
        let targets = golden_targets(&subject, 30);
        // Guaranteed on the convex companion only; on Table I it is what is measured.
        assert_eq!(shares(Contender::Switching, &subject, &targets), (1.0, 1.0), "{name}");
        assert_eq!(shares(Contender::SecondOrder, &subject, &targets), (1.0, 1.0), "{name}");
        // Half the starts or more are lost to Newton on the paper's errors even with saturation, most without; on the
        // covariant errors it does better, and still fails. Measured: 22, 42, 48 and 92 % on Table I.
        let [measure, covariant] = [Errors::MeasureNumbers, Errors::Covariant];
        let (newton, worst) = shares(Contender::Newton(measure), &subject, &targets);
        assert!(newton < 0.35 && worst < 0.15, "{name}");
        let (saturated, worst) = shares(Contender::SaturatedNewton(measure), &subject, &targets);
        assert!((newton..0.6).contains(&saturated) && worst < 0.15, "{name}");
        let (newton, worst) = shares(Contender::Newton(covariant), &subject, &targets);
        assert!(newton < 0.65 && worst < 0.15, "{name}");
        let (saturated, worst) = shares(Contender::SaturatedNewton(covariant), &subject, &targets);
        assert!((newton..0.99).contains(&saturated) && worst < 0.6, "{name}");
    }
}

#[test]
fn figure_6_goes_from_the_inside_to_the_border_and_back_and_always_nearer() {
    for name in ["table1c", "table1"] {
        let subject = subject(name);
        let passage = Passage::search(&subject, |_, _| ()).expect("the grid has such a passage");
        let modes: Vec<_> = passage.samples.chunk_by(|a, b| a.mode == b.mode).map(|stretch| stretch[0].mode).collect();
        let [BoundaryMode::Interior, border, BoundaryMode::Interior] = modes[..] else { panic!("{name}: {modes:?}") };
        let (axis, value) = match border {
            BoundaryMode::LowerU => (0, 0.0),
            BoundaryMode::UpperU => (0, 1.0),
            BoundaryMode::LowerV => (1, 0.0),
            BoundaryMode::UpperV => (1, 1.0),
            BoundaryMode::Interior | BoundaryMode::Corner => panic!("{name}: {border:?}"),
        };
        let [before, on, after] = passage.stretches();
        // The last sample of a stretch is the first of the next.
        assert!(on[..on.len() - 1].iter().all(|sample| sample.parameters[axis] == value), "{name}");
        assert!(before[..before.len() - 1].iter().all(|sample| sample.parameters[axis] != value), "{name}");
        assert!(after[1..].iter().all(|sample| sample.parameters[axis] != value), "{name}");
        let inside = |sample: &[f64; 2]| sample.iter().all(|parameter| (0.0..=1.0).contains(parameter));
        assert!(passage.samples.iter().all(|sample| inside(&sample.parameters)), "{name}");
        assert!(passage.error_rises(0) && passage.error_rises(1), "{name}: the errors are monotone");
        // One unit in the last place of coordinates up to 0.1 m, at both ends of a step.
        let rise = passage.largest_rise();
        assert!(rise <= 2.0 * 0.125 * f64::from(f32::EPSILON), "{name}: ‖ΔR‖ rises by {rise:e} m");
        assert!(passage.meets_border < passage.leaves_border && passage.leaves_border < passage.arrives);
    }
}

#[test]
fn figure_8_chatters_above_the_predicted_limit() -> anyhow::Result<()> {
    for name in ["table1c", "table1"] {
        let subject = subject(name);
        let oracle = subject.oracle();
        let rest = Configuration::find(&subject, &oracle).expect("the patch has a convex place");
        assert!((rest.predicted_limit(Integrator::Euler) - PAPER_LIMIT).abs() < 1e-6 * PAPER_LIMIT);
        let measured = rest.measured_limit(&subject, Integrator::Euler)?;
        println!("{name}: stable below {measured:.1} 1/s, predicted {PAPER_LIMIT} 1/s");
        assert!((measured / PAPER_LIMIT - 1.0).abs() < 0.05, "{name}: {measured} 1/s");
        let limits = tracking::limits(&subject, &oracle, &rest)?;
        assert_eq!(limits.len(), 36, "three integrators at twelve distances");
        for limit in limits {
            assert!((limit.measured / limit.predicted - 1.0).abs() < 0.05, "{name}: {limit:?}");
        }
        let end =
            |run: &Vec<tracking::Sample>| run.last().map_or(1.0, |sample| sample.errors[0].hypot(sample.errors[1]));
        let runs = tracking::runs(&subject, &rest);
        let [good, chatter, slow] = [0, 1, 2].map(|index: usize| end(&runs[index]));
        // Parameters: f32 rounds the errors at some 1e-7; the chatter is as wide as the span where the curvature stays;
        // the slow gain has worked for four of its time constants, so a fiftieth of the start of 0.5 is left.
        assert!(good < 1e-5 && chatter > 0.01 && slow < 0.02, "{name}: {good:e} {chatter:e} {slow:e}");
        // And after one constant, 50 s, not yet.
        let early = &runs[2][25_000].errors;
        assert!(early[0].hypot(early[1]) > 0.1, "{name}: {early:?}");
    }
    Ok(())
}

/// Between two ticks that single precision and the way there leave alone: the error is squared but for a factor.
#[test]
fn the_second_order_law_arrives_quadratically_and_its_lag_grows_with_the_square_of_the_speed() {
    for name in ["table1c", "table1"] {
        let subject = subject(name);
        let oracle = subject.oracle();
        let rates = rate::rates(&subject, &oracle);
        assert_eq!(rates.len(), 4, "{name}: inside, on a knot, on two, on a border");
        for Rate { place, errors: [first, second] } in rates {
            let pairs = second.windows(2).filter(|pair| pair[0] < 1e-2 && pair[1] > 1e-6);
            let factors: Vec<f64> = pairs.map(|pair| pair[1] / pair[0].powi(2)).collect();
            println!("{name}, {place}: {second:?}, factors {factors:.1?}");
            // A third derivative over twice the least curvature of V, in parameters: a dozen at most on these patches.
            assert!(!factors.is_empty() && factors.iter().all(|factor| *factor < 12.0), "{name}, {place}: {second:?}");
            // In the same ticks the first-order law has not half the digits.
            assert!(second[12] < 3e-7 && first[12] > 3e-7, "{name}, {place}: {first:?}");
        }
        let rest = Configuration::find(&subject, &oracle).expect("the patch has a convex place");
        let lags = rate::lags(&subject, &rest);
        let [first, second] = [0, 1].map(|law| rate::power(&lags, law));
        println!("{name}: the lag grows with the speed to the power {first:.2}, to second order {second:.2}");
        assert!((first - 1.0).abs() < 0.2 && (second - 2.0).abs() < 0.1, "{name}: {first}, {second}");
    }
}

#[test]
fn the_same_arguments_give_the_same_bytes() -> anyhow::Result<()> {
    let options = Options { probes: 3, distances: [0.1, 1.0], seed: 5 };
    let once = || sheets(&subject("table1c"), options, |_, _, _| ());
    let (first, second) = (once()?, once()?);
    assert_eq!(first.iter().map(|sheet| sheet.files.len()).sum::<usize>(), 13);
    assert!(first == second, "two runs differ");
    let other = sheets(&subject("table1c"), Options { seed: 6, ..options }, |_, _, _| ())?;
    assert!(first != other, "the seed changes nothing");
    Ok(())
}
