//! Parts shared by the panels of all figures.

use super::subject::Subject;
use crate::plot::{Area, Chart, Ink, Key, Svg, View};
use glam::DVec3;

/// Widths of lines, px.
pub const THICK: f64 = 2.0;
pub const THIN: f64 = 1.0;

/// The view, of eight round the surface, that sees these points of the patch most from the front.
pub fn view_of<'a>(subject: &Subject, points: impl IntoIterator<Item = &'a [f64; 2]>) -> View {
    let normal: DVec3 = points.into_iter().map(|at| subject.at(at.map(|parameter| parameter.clamp(0.0, 1.0))).1).sum();
    let views = (0..8).map(|eighth| View {
        turn: View::FRONT_RIGHT.turn + f64::from(eighth) * std::f64::consts::FRAC_PI_4,
        ..View::FRONT_RIGHT
    });
    let facing = |view: &View| view.viewer().dot(normal);
    // The first of equals, so that a symmetric patch is seen from the same side everywhere.
    views
        .reduce(|best, view| if facing(&view) > facing(&best) + 1e-9 { view } else { best })
        .unwrap_or(View::FRONT_RIGHT)
}

/// The view, of eight round the surface and three heights, that sees these lines from the patch to the probe longest,
/// and the patch under them not from behind.
pub fn view_across(subject: &Subject, lines: &[([f64; 2], DVec3)]) -> View {
    let normal: DVec3 = lines.iter().map(|(at, _)| subject.at(*at).1).sum();
    let views = (0..8).flat_map(|eighth| {
        let turn = View::FRONT_RIGHT.turn + f64::from(eighth) * std::f64::consts::FRAC_PI_4;
        [10.0_f64, 20.0, 30.0].map(|tilt| View { turn, tilt: tilt.to_radians() })
    });
    let length = |view: &View| {
        let seen = |(at, probe): &([f64; 2], DVec3)| {
            let (from, to) = (view.seen(subject.at(*at).0.point), view.seen(*probe));
            (from.0 - to.0).hypot(from.1 - to.1)
        };
        // Seen from at least 10° above its plane.
        if view.viewer().dot(normal) < 0.17 * normal.length() { 0.0 } else { lines.iter().map(seen).sum::<f64>() }
    };
    views
        .reduce(|best, view| if length(&view) > length(&best) + 1e-9 { view } else { best })
        .unwrap_or(View::FRONT_RIGHT)
}

/// Draws the patch as a net, scaled so that the given points fit too.
pub fn scene<'s>(
    svg: &'s mut Svg,
    area: Area,
    (title, keys): (&str, &[Key<'_>]),
    subject: &Subject,
    view: &View,
    besides: &[DVec3],
) -> Chart<'s> {
    let mut net = view.net(&subject.patch);
    let points = net.iter().flatten().copied().chain(besides.iter().map(|point| view.seen(*point)));
    let points: Vec<_> = points.collect();
    let mut chart = Chart::scene(svg, area, title, keys, points);
    // The border comes first.
    let inner = net.split_off(4.min(net.len()));
    chart.lines(Ink::Grey, 0.5, inner);
    chart.lines(Ink::Dark, THIN, net);
    chart
}

/// The line of sight from the probe to its closest point.
pub fn sight(chart: &mut Chart<'_>, view: &View, probe: DVec3, closest: DVec3) {
    chart.dashed(Ink::Red, THIN, [view.seen(probe), view.seen(closest)]);
    chart.dot(view.seen(probe), "Q", Ink::Red, (7.0, -8.0));
    chart.dot(view.seen(closest), "P*", Ink::Red, (7.0, 9.0));
}
