//! The limits of performance against measurement: where the gain stops being stable, how far the witness point lags,
//! how fast the exponential gain is, and that the bounds they are computed from are bounds.

use glam::DVec3;
use palpate::patch::{Curvature, Patch as _, SplinePatch};
use palpate::track::{
    Controller, FeedForward, FirstOrder, Gain, Integrator, Outcome, PerformanceLimits, Probe, Witness,
};
use palpate_bake::{BakedPatch, NurbsPatch};
use palpate_truth::measured::measured;
use palpate_truth::oracle::{Oracle, OraclePoint};

/// A model of this repository: the surface, and its table.
struct Body {
    name: &'static str,
    surface: NurbsPatch,
    patch: SplinePatch<'static>,
}

impl Body {
    fn load(name: &'static str) -> Self {
        let surface = palpate_suites::model(name).patches.swap_remove(0);
        let patch = BakedPatch::new(&surface).expect("it bakes").to_patch().expect("the table is good");
        Self { name, surface, patch }
    }

    fn at(&self, [u, v]: [f64; 2]) -> OraclePoint {
        OraclePoint::evaluate(&self.surface, u, v)
    }

    /// The probe at a gap straight out from a point.
    fn probe(&self, parameters: [f64; 2], gap: f64) -> DVec3 {
        let surface = self.at(parameters);
        surface.point + surface.normal(self.surface.flip) * gap
    }

    /// The principal curvatures at a point.
    fn curvature(&self, parameters: [f64; 2]) -> Curvature {
        let [least, greatest] = self.at(parameters).principal_curvatures(self.surface.flip);
        Curvature { min: least as f32, max: greatest as f32 }
    }
}

const INTEGRATORS: [Integrator; 3] = [Integrator::Euler, Integrator::Heun, Integrator::RungeKutta4];

/// Whether a small perturbation of the closest point dies out.
fn decays(body: &Body, foot: [f64; 2], query: DVec3, integrator: Integrator, gain: f32) -> bool {
    const TICKS: usize = 300;
    // Small beside the radii of curvature, large beside the rounding of 1e-7 of the size.
    const PERTURBATION: f64 = 2e-4;
    let controller = Controller::FirstOrder(FirstOrder::CERTIFIED.gain(Gain::Unlimited(gain)).integrator(integrator));
    let surface = body.at(foot);
    let size = f64::from(body.patch.size());
    // In a direction that is no principal one.
    let start = [
        foot[0] + PERTURBATION * size / surface.tangent_u.length(),
        foot[1] + 0.6 * PERTURBATION * size / surface.tangent_v.length(),
    ];
    let mut witness = Witness::at(&body.patch, start[0] as f32, start[1] as f32);
    let away = |witness: &Witness| witness.surface.point.as_dvec3().distance(surface.point);
    let before = away(&witness);
    for _ in 0..TICKS {
        controller.step(&body.patch, &mut witness, Probe::at(query.as_vec3()), 1.0);
        // Far beyond doubt; the rest of the run would only wander.
        if away(&witness) > 20.0 * before {
            return false;
        }
    }
    away(&witness) < before
}

#[test]
fn the_gain_at_which_stability_ends_is_the_predicted_one() {
    // Inside spans, away from knots: the curvature of one side holds on both.
    let feet = [[0.5, 0.5], [0.2, 0.45], [0.77, 0.22], [0.4, 0.8]];
    let gaps = [0.002, 0.01, 0.05, -0.004];
    let (mut worst, mut lowest, mut highest) = (0.0_f64, f64::INFINITY, 0.0_f64);
    println!("{:<10} {:<12} {:>18} {:>18}", "patch", "integrator", "measured/predicted", "patch/local");
    for name in ["sphere", "ellipsoid", "table1c"] {
        let body = Body::load(name);
        for integrator in INTEGRATORS {
            let (mut least, mut most, mut loosest) = (f64::INFINITY, 0.0_f64, f32::INFINITY);
            for foot in feet {
                for gap in gaps {
                    let query = body.probe(foot, gap);
                    // A rate of 1 Hz: K is K h.
                    let local =
                        PerformanceLimits::at_point(body.curvature(foot), integrator, 1.0, gap as f32).stable_gain();
                    let whole = PerformanceLimits::new(&body.patch.shape(), integrator, 1.0, gap as f32).stable_gain();
                    assert!(whole <= local * (1.0 + 1e-6), "{name}: the patch allows {whole}, the point {local}");
                    loosest = loosest.min(whole / local);
                    let (mut low, mut high) = (0.5 * local, 2.0 * local);
                    assert!(decays(&body, foot, query, integrator, low), "{name} {foot:?} {gap}: grows at {low}");
                    assert!(!decays(&body, foot, query, integrator, high), "{name} {foot:?} {gap}: decays at {high}");
                    for _ in 0..10 {
                        let middle = 0.5 * (low + high);
                        if decays(&body, foot, query, integrator, middle) { low = middle } else { high = middle }
                    }
                    let ratio = f64::from(low / local);
                    (least, most) = (least.min(ratio), most.max(ratio));
                    worst = worst.max((ratio - 1.0).abs());
                }
            }
            println!("{name:<10} {:<12} {least:>8.4} to {most:.4} {loosest:>10.3} to 1", format!("{integrator:?}"));
            (lowest, highest) = (lowest.min(least), highest.max(most));
        }
    }
    assert!(worst <= 0.05, "measured and predicted limit differ by {worst}");
    measured("stability limit of the gain, measured over predicted: minimum", format!("{lowest:.4}"));
    measured("stability limit of the gain, measured over predicted: maximum", format!("{highest:.4}"));
}

/// A smooth closed path of feet, all inside the patch, and the probe above them at a speed.
struct Probing {
    gap: f64,
    /// Turns a second.
    frequency: f64,
}

impl Probing {
    fn foot(&self, time: f64) -> [f64; 2] {
        let angle = std::f64::consts::TAU * self.frequency * time;
        [0.5 + 0.3 * angle.cos(), 0.5 + 0.28 * (angle + 0.5 * angle.sin()).sin()]
    }

    fn probe(&self, body: &Body, time: f64) -> DVec3 {
        body.probe(self.foot(time), self.gap)
    }

    fn velocity(&self, body: &Body, time: f64) -> DVec3 {
        let step = 1e-6 / self.frequency.max(1e-3);
        (self.probe(body, time + step) - self.probe(body, time - step)) / (2.0 * step)
    }

    /// The path on which the probe is never faster, and nearly so somewhere.
    fn with_speed(body: &Body, gap: f64, speed: f64) -> Self {
        let once = Self { gap, frequency: 1.0 };
        let fastest = (0..400).map(|k| once.velocity(body, f64::from(k) / 400.0).length()).fold(0.0, f64::max);
        // What 400 samples of a smooth curve miss.
        Self { gap, frequency: speed / (1.001 * fastest) }
    }
}

/// The largest lag, metres, and the largest ratio to the first-order lag of the place and moment.
struct Lag {
    largest: f64,
    to_first_order: f64,
    rejected: usize,
}

fn track(body: &Body, path: &Probing, controller: &Controller, rate: f64) -> Lag {
    // A quarter of the path, or as much as a tick's step lets be measured well; the first steps fade the start out.
    let ticks = (0.25 * rate / path.frequency).clamp(400.0, 4_000.0) as u32;
    let settle = 200;
    let oracle = Oracle::new(&body.surface);
    let mut witness = Witness::at(&body.patch, path.foot(0.0)[0] as f32, path.foot(0.0)[1] as f32);
    let mut lag = Lag { largest: 0.0, to_first_order: 0.0, rejected: 0 };
    for tick in 1..ticks + settle {
        let time = f64::from(tick) / rate;
        let query = path.probe(body, time).as_vec3();
        let velocity = path.velocity(body, time);
        let probe = Probe { position: query, velocity: velocity.as_vec3() };
        let step = controller.step(&body.patch, &mut witness, probe, (1.0 / rate) as f32);
        lag.rejected += usize::from(step.outcome == Outcome::Rejected);
        if tick < settle {
            continue;
        }
        let foot = path.foot(time);
        let closest = body.at(foot).point;
        if tick % 97 == 0 {
            // The foot of the path is the closest point of the whole patch, not only of its neighbourhood.
            assert!(oracle.closest(query.as_dvec3()).point.distance(closest) < 1e-7, "{}: {foot:?}", body.name);
        }
        let found = witness.surface.point.as_dvec3().distance(closest);
        lag.largest = lag.largest.max(found);
        let limits = PerformanceLimits::at_point(body.curvature(foot), Integrator::Euler, rate as f32, path.gap as f32);
        let first_order = limits.lag((f64::from(step.gain) * rate) as f32, velocity.length() as f32);
        lag.to_first_order = lag.to_first_order.max((found - floor(body)).max(0.0) / f64::from(first_order));
    }
    lag
}

/// What single precision can tell of a point: 4 units in the last place of the size.
fn floor(body: &Body) -> f64 {
    f64::from(4.0 * f32::EPSILON * body.patch.size())
}

#[test]
fn the_lag_behind_a_moving_probe_is_within_its_bound() {
    let (mut settings, mut finite) = (0, 0);
    println!(
        "{:<10} {:>6} {:>6} {:>6} {:>9} {:>10} {:>10} {:>10}",
        "patch", "gap/mm", "Hz", "m/s", "K h", "lag/um", "bound/um", "/1st order"
    );
    for name in ["table1c", "ellipsoid"] {
        let body = Body::load(name);
        let greatest = f64::from(body.patch.shape().curvature.max);
        for gap in [0.0005, 0.01] {
            for rate in [1_000.0, 4_000.0, 10_000.0] {
                for speed in [0.01, 0.1, 1.0] {
                    let path = Probing::with_speed(&body, gap, speed);
                    let limits =
                        PerformanceLimits::new(&body.patch.shape(), Integrator::Euler, rate as f32, gap as f32);
                    let monotone = limits.monotone_gain(0.0);
                    for (share, gain) in [
                        (0.1, Gain::Constant(0.1 * monotone)),
                        (0.5, Gain::Constant(0.5 * monotone)),
                        (1.0, Gain::Certified),
                    ] {
                        let controller = Controller::FirstOrder(FirstOrder::CERTIFIED.gain(gain));
                        let found = track(&body, &path, &controller, rate);
                        let bound = f64::from(limits.lag_bound(share * monotone, speed as f32));
                        println!(
                            "{name:<10} {:>6} {rate:>6} {speed:>6} {:>9} {:>10.3} {:>10.3} {:>10.3}",
                            gap * 1e3,
                            match gain {
                                Gain::Constant(gain) => format!("{:.3}", gain / rate as f32),
                                _ => "certified".to_owned(),
                            },
                            found.largest * 1e6,
                            bound * 1e6,
                            found.to_first_order
                        );
                        assert_eq!(found.rejected, 0);
                        assert!(found.largest <= bound + floor(&body), "{} above {bound}", found.largest);
                        settings += 1;
                        finite += usize::from(bound.is_finite());
                        // At 1 m/s and 1 kHz the lag is as large as the radius of curvature: the proof ends there.
                        assert!(bound.is_finite() || speed / rate > 5e-4, "no bound at {speed} m/s, {rate} Hz");
                        if share < 1.0 {
                            // What the lag and the way of a tick leave of the first order, beside the radius of
                            // curvature.
                            let beyond = 2.0 * greatest * (found.largest + speed / rate);
                            assert!(
                                found.to_first_order <= 1.0 + beyond,
                                "{} of the first order",
                                found.to_first_order
                            );
                        }
                    }
                }
            }
        }
    }
    println!("a finite bound in {finite} of {settings} settings");
}

#[test]
fn feed_forward_takes_the_lag_away_to_first_order() {
    println!(
        "{:<10} {:>8} {:>8} {:>10} {:>10} {:>10} {:>8} {:>8}",
        "patch", "kappa d", "m/s", "none/um", "gated/um", "full/um", "ratio", "theory"
    );
    for name in ["table1c", "ellipsoid"] {
        let body = Body::load(name);
        let greatest = f64::from(body.patch.shape().curvature.max);
        for product in [0.0, 0.01, 0.05, 0.2, 0.5] {
            for speed in [0.05, 0.2] {
                let gap = product / greatest;
                let rate = 4_000.0;
                let path = Probing::with_speed(&body, gap, speed);
                let share = 0.1;
                let gain = Gain::Constant((share * rate) as f32);
                let [none, gated, full] =
                    [FeedForward::None, FeedForward::Gated, FeedForward::Full].map(|feed_forward| {
                        let controller =
                            Controller::FirstOrder(FirstOrder::CERTIFIED.gain(gain).feed_forward(feed_forward));
                        let found = track(&body, &path, &controller, rate);
                        assert_eq!(found.rejected, 0);
                        found.largest
                    });
                println!(
                    "{name:<10} {product:>8} {speed:>8} {:>10.3} {:>10.3} {:>10.3} {:>8.4} {:>8.4}",
                    none * 1e6,
                    gated * 1e6,
                    full * 1e6,
                    full / none,
                    product / (1.0 - share)
                );
                assert!(gated <= none + floor(&body), "{name}: gated {gated}, none {none}");
                let certified = [FeedForward::None, FeedForward::Full].map(|feed_forward| {
                    let controller = Controller::FirstOrder(FirstOrder::CERTIFIED.feed_forward(feed_forward));
                    track(&body, &path, &controller, rate).largest
                });
                // The certified step is as long as may be, so there is nothing to add; nor does it do harm.
                assert!(certified[1] <= 1.05 * certified[0] + floor(&body), "{certified:?}");
                println!("    at the certified gain: none {:.3}, full {:.3}", certified[0] * 1e6, certified[1] * 1e6);
                if product <= 0.05 {
                    assert!(full <= 0.1 * none + floor(&body), "{name} at {product}: {full} of {none}");
                }
            }
        }
    }
}

#[test]
fn the_exponential_gain_decays_at_least_exponentially_until_it_is_capped() {
    for name in ["sphere", "ellipsoid", "table1c"] {
        let body = Body::load(name);
        let stretch = f64::from(body.patch.shape().min_stretch);
        let gap = 0.01;
        for foot in [[0.5, 0.5], [0.3, 0.6], [0.7, 0.35]] {
            let query = body.probe(foot, gap);
            let least = body.at(foot).point.distance(query);
            // A per cent a tick at least, so that tens of them pass before the cap.
            let rate = (0.02 / stretch) as f32;
            let controller = Controller::FirstOrder(FirstOrder::CERTIFIED.gain(Gain::Exponential(rate)));
            let capped = Controller::FirstOrder(FirstOrder::CERTIFIED);
            let mut witness = Witness::at(&body.patch, 0.1, 0.9);
            let excess =
                |witness: &Witness| witness.surface.point.as_dvec3().distance(query.as_vec3().as_dvec3()) - least;
            let (mut free, mut before) = (0, excess(&witness));
            let first = before;
            for _ in 0..2_000 {
                let mut other = witness;
                let limit = capped.step(&body.patch, &mut other, Probe::at(query.as_vec3()), 1.0);
                let step = controller.step(&body.patch, &mut witness, Probe::at(query.as_vec3()), 1.0);
                let now = excess(&witness);
                if step.gain < limit.gain {
                    free += 1;
                    // V falls at least at rate · λ_min(I) · ‖ΔR‖ in continuous time; a step below the certified gain
                    // keeps half.
                    let factor = 1.0 - 0.5 * f64::from(rate) * stretch;
                    assert!(now <= factor * before + floor(&body), "{name}: {before} to {now}, {factor}");
                } else {
                    assert!(now <= before + floor(&body));
                }
                before = now;
            }
            println!("{name}: {free} ticks below the cap, from {first:.2e} m to {before:.2e} m");
            assert!(free >= 10, "{name}: only {free} ticks below the cap");
            assert!(before <= floor(&body));
        }
    }
}

#[test]
fn no_gain_but_the_unlimited_one_goes_beyond_the_certified_one() {
    let body = Body::load("table1c");
    let query = body.probe([0.6, 0.4], 0.02).as_vec3();
    let start = Witness::at(&body.patch, 0.2, 0.7);
    let gain = |gain| {
        let (controller, mut witness) = (Controller::FirstOrder(FirstOrder::CERTIFIED.gain(gain)), start);
        controller.step(&body.patch, &mut witness, Probe::at(query), 1.0).gain
    };
    let certified = gain(Gain::Certified);
    assert_eq!([gain(Gain::Constant(1e6)), gain(Gain::Exponential(1e12))], [certified; 2]);
    assert_eq!(gain(Gain::Constant(0.5 * certified)), 0.5 * certified);
    assert_eq!(gain(Gain::Unlimited(1.5)), 1.5);
    // And the certified one is not below what the limits promise for projection errors of this length.
    let errors = palpate::track::ProjectionErrors::new(&start.surface, query);
    let descent = palpate::track::Descent::new(&errors, start.parameters);
    let distance = errors.difference.length();
    let limits = PerformanceLimits::new(&body.patch.shape(), Integrator::Euler, 1.0, distance);
    assert!(limits.monotone_gain(descent.slope.sqrt()) <= certified * (1.0 + 1e-6));
}
