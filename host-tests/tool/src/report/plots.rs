//! The plots of a run.

use super::Section;
use super::summary::norm;
use crate::plot::{Area, Axes, Axis, Chart, Ink, Key, Mark, Svg, View, at_widths};
use crate::simulation::{Sample, Trace};
use palpate::math::Vec3;
use palpate::track::Contact;
use palpate::wire::Report;

/// Height of a curve over time, and of a line of names, px.
const HIGH: f64 = 240.0;
const LINE: f64 = 18.0;
/// A path of more points shows nothing more.
const MOST_POINTS: usize = 7_200;
/// Names of the boundary modes, by number less one.
const MODES: [&str; 6] = ["u = 0", "u = 1", "v = 0", "v = 1", "interior", "corner"];

/// A surface as lines on the page.
pub type Net = [Vec<(f64, f64)>];

/// All plots of a run over a surface, whose features have names by code.
pub fn sections(trace: &Trace, net: &Net, name: impl Fn(u16) -> String) -> Vec<Section> {
    let (mut met, mut names) = (Vec::new(), Vec::new());
    for sample in &trace.samples {
        if !met.contains(&sample.report.feature) {
            met.push(sample.report.feature);
            names.push(name(sample.report.feature));
        }
    }
    let number =
        |sample: &Sample| met.iter().position(|code| *code == sample.report.feature).unwrap_or_default() as f64;
    let gap = |sample: &Sample| f64::from(sample.report.gap) * 1e3;
    let force = |sample: &Sample| norm(sample.report.force);
    let mode = |sample: &Sample| f64::from(sample.report.mode) - 1.0;
    let instructions = |sample: &Sample| f64::from(sample.report.instructions);
    let values = |curve: Curve<'_>| trace.samples.iter().map(curve).chain([0.0]).collect::<Vec<_>>();
    let modes = MODES.map(str::to_owned);
    let mut sections = vec![
        Section {
            heading: "Probe path".to_owned(),
            note: "The surface, and the probe on its way, seen from the front right.".to_owned(),
            drawing: Some(at_widths(420.0, |svg, area| along(svg, area, trace, net))),
            table: None,
        },
        over_time(
            trace,
            ["Gap", "Signed distance along the outward normal; below zero the probe presses in."],
            HIGH,
            Axis::over("gap, mm", values(&gap)),
            &gap,
            Ink::Blue,
        ),
        over_time(
            trace,
            ["Force", "Magnitude of the force at the probe."],
            HIGH,
            Axis::over("force, N", values(&force)),
            &force,
            Ink::Red,
        ),
        over_time(
            trace,
            [
                "Feature",
                "The face, edge or corner that has the witness point, by the names of its faces, in the order of their first touch.",
            ],
            80.0 + LINE * names.len() as f64,
            Axis::named("", &names),
            &number,
            Ink::Blue,
        ),
        over_time(
            trace,
            ["Boundary mode", "Whether the witness point is held at a border of its patch, and at which."],
            80.0 + LINE * MODES.len() as f64,
            Axis::named("", &modes),
            &mode,
            Ink::Blue,
        ),
    ];
    if trace.samples.iter().any(|sample| sample.report.instructions > 0) {
        sections.push(over_time(
            trace,
            ["Instructions a tick", "Counted under the emulator."],
            HIGH,
            Axis::over("instructions", values(&instructions)),
            &instructions,
            Ink::Blue,
        ));
    }
    sections
}

/// The value of a sample.
type Curve<'a> = &'a dyn Fn(&Sample) -> f64;

fn over_time(
    trace: &Trace,
    [heading, note]: [&str; 2],
    height: f64,
    y: Axis<'_>,
    value: Curve<'_>,
    ink: Ink,
) -> Section {
    let end = trace.samples.last().map_or(1.0, |sample| sample.time);
    let drawing = at_widths(height, |svg, area| {
        let mut chart = Axes { title: "", x: Axis::linear("time, s", [0.0, end]), y, keys: &[] }.on(svg, area);
        chart.line(ink, 1.5, trace.samples.iter().map(|sample| (sample.time, value(sample))));
    });
    Section { heading: heading.to_owned(), note: note.to_owned(), drawing: Some(drawing), table: None }
}

/// The probe's path over the surface, as an SVG of its own.
pub fn path(trace: &Trace, net: &Net) -> String {
    crate::plot::draw(crate::plot::FIGURE, 300.0, |svg, area| along(svg, area, trace, net))
}

fn along(svg: &mut Svg, area: Area, trace: &Trace, net: &Net) {
    let seen = |report: &Report| View::FRONT_RIGHT.seen(Vec3::from_array(report.probe).as_dvec3());
    let stride = trace.samples.len().div_ceil(MOST_POINTS).max(1);
    let samples: Vec<_> = trace.samples.iter().step_by(stride).map(|sample| &sample.report).collect();
    let touches = |report: &&Report| report.contact == Contact::Touching as u8;
    let all: Vec<_> = net.iter().flatten().copied().chain(samples.iter().map(|report| seen(report))).collect();
    let keys: [Key<'_>; 2] = [("in front", Ink::Blue, Mark::Line), ("pressing in", Ink::Red, Mark::Line)];
    let mut chart = Chart::scene(svg, area, "", &keys, all);
    chart.lines(Ink::Grey, 0.6, net.iter().cloned());
    for (ink, wanted) in [(Ink::Blue, false), (Ink::Red, true)] {
        let runs = samples.chunk_by(|a, b| touches(a) == touches(b)).filter(|run| touches(&run[0]) == wanted);
        chart.lines(ink, 1.2, runs.map(|run| run.iter().map(|report| seen(report)).collect()));
    }
}
