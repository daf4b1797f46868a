//! Parts shared by the panels of all figures.

use super::subject::Subject;
use crate::drawing::{Drawing, DrawingResult, RED_INK, SURFACE_INK, TEXT_INK, View, draw, equal_scale};
use glam::DVec3;
use plotters::chart::ChartContext;
use plotters::coord::types::RangedCoordf64;
use plotters::element::{DashedPathElement, PathElement};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The backend places everything on whole pixels: drawn at this multiple of the size, paths are smooth.
const FINENESS: u32 = 2;

/// Sizes of text, in drawn pixels.
pub const TITLE: i32 = 30;
pub const LABEL: i32 = 26;
const TICKS: i32 = 22;
/// Widths of lines, in drawn pixels.
pub const THICK: u32 = 4;
pub const THIN: u32 = 2;

pub type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// An SVG of this size on the page.
pub fn page(
    (width, height): (u32, u32),
    content: impl FnOnce(&Drawing<'_>) -> DrawingResult,
) -> anyhow::Result<String> {
    let (fine_width, fine_height) = (width * FINENESS, height * FINENESS);
    let text = draw((fine_width, fine_height), |area| {
        area.fill(&WHITE)?;
        content(area)
    })?;
    let size = |width, height| format!("width=\"{width}\" height=\"{height}\"");
    Ok(compact(&text.replacen(&size(fine_width, fine_height), &size(width, height), 1)))
}

/// A font of this size, in drawn pixels.
pub fn font(size: i32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&TEXT_INK)
}

/// A panel's axes: title, ranges and descriptions.
pub struct Axes<'a> {
    pub title: &'a str,
    pub x: (f64, f64),
    pub y: (f64, f64),
    pub x_label: &'a str,
    pub y_label: &'a str,
}

impl Axes<'_> {
    /// Draws the axes.
    pub fn chart<'a, 'b>(&self, area: &'a Drawing<'b>) -> Result<Chart<'a, 'b>, Box<dyn std::error::Error>> {
        let mut chart = ChartBuilder::on(area)
            .caption(self.title, font(TITLE))
            .margin(16)
            .margin_right(30)
            .x_label_area_size(70)
            .y_label_area_size(104)
            .build_cartesian_2d(self.x.0..self.x.1, self.y.0..self.y.1)?;
        chart
            .configure_mesh()
            .x_desc(self.x_label)
            .y_desc(self.y_label)
            .axis_desc_style(font(LABEL))
            .label_style(font(TICKS))
            .x_label_formatter(&plain)
            .y_label_formatter(&plain)
            .x_labels(6)
            .y_labels(6)
            .light_line_style(TRANSPARENT)
            .bold_line_style(SURFACE_INK.mix(0.35))
            .draw()?;
        Ok(chart)
    }
}

/// A number without the digits that rounding left behind.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "the axes hand out references")]
fn plain(value: &f64) -> String {
    ((value * 1e6).round() / 1e6).to_string()
}

/// A vertical dashed line with a name at the top.
pub fn mark_time(chart: &mut Chart<'_, '_>, time: f64, name: &str) -> DrawingResult {
    let (low, high) = (chart.y_range().start, chart.y_range().end);
    let line = DashedPathElement::new(vec![(time, low), (time, high)], 8, 8, TEXT_INK.stroke_width(1));
    chart.draw_series([line])?;
    let style = font(LABEL).pos(Pos::new(HPos::Left, VPos::Top));
    chart.draw_series([Text::new(name.to_owned(), (time, high), style)])?;
    Ok(())
}

/// Names of the series, in a corner of the chart.
pub fn legend<'a, 'b: 'a>(chart: &mut Chart<'a, 'b>, position: SeriesLabelPosition) -> DrawingResult {
    chart
        .configure_series_labels()
        .position(position)
        .margin(14)
        .legend_area_size(46)
        .label_font(font(LABEL))
        .background_style(WHITE.mix(0.85))
        .border_style(SURFACE_INK)
        .draw()?;
    Ok(())
}

/// The key of a line in the legend.
pub fn key(ink: RGBColor) -> impl Fn((i32, i32)) -> PathElement<(i32, i32)> {
    move |(x, y)| PathElement::new(vec![(x, y), (x + 30, y)], ink.stroke_width(THICK))
}

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
pub fn scene<'a, 'b>(
    area: &'a Drawing<'b>,
    title: &str,
    subject: &Subject,
    view: &View,
    besides: &[DVec3],
) -> Result<Chart<'a, 'b>, Box<dyn std::error::Error>> {
    let net = view.net(&subject.patch);
    let (width, height) = area.dim_in_pixel();
    // Margins and the caption take some of it.
    let size = (f64::from(width) - 80.0, f64::from(height) - 140.0);
    let points = net.iter().flatten().copied().chain(besides.iter().map(|point| view.seen(*point)));
    let (x, y) = equal_scale(points, size);
    let mut chart = ChartBuilder::on(area).caption(title, font(TITLE)).margin(40).build_cartesian_2d(x, y)?;
    for (index, line) in net.into_iter().enumerate() {
        // The border comes first.
        let style = if index < 4 { TEXT_INK.mix(0.7).stroke_width(THIN) } else { SURFACE_INK.mix(0.8).stroke_width(1) };
        chart.draw_series([PathElement::new(line, style)])?;
    }
    Ok(chart)
}

/// A named dot.
pub fn dot(chart: &mut Chart<'_, '_>, at: (f64, f64), name: &str, ink: RGBColor, offset: (i32, i32)) -> DrawingResult {
    let mark = EmptyElement::at(at)
        + Circle::new((0, 0), 7, ink.filled())
        + Text::new(name.to_owned(), offset, font(LABEL).color(&ink));
    chart.draw_series([mark])?;
    Ok(())
}

/// The line of sight from the probe to its closest point.
pub fn sight(chart: &mut Chart<'_, '_>, view: &View, probe: DVec3, closest: DVec3) -> DrawingResult {
    let line = vec![view.seen(probe), view.seen(closest)];
    chart.draw_series([DashedPathElement::new(line, 10, 8, RED_INK.stroke_width(THIN))])?;
    dot(chart, view.seen(probe), "Q", RED_INK, (12, -28))?;
    dot(chart, view.seen(closest), "P*", RED_INK, (12, 6))
}

// Smaller SVG: marks that look alike share their style.

/// Attributes that differ from mark to mark.
const GEOMETRY: [&str; 7] = ["cx", "cy", "r", "x1", "y1", "x2", "y2"];

/// Puts successive lines, or circles, of one style into a group that carries it. The drawing stays the same; one of a
/// thousand marks is half as long.
pub fn compact(svg: &str) -> String {
    let mut text = String::with_capacity(svg.len());
    let mut open: Option<(&str, String)> = None;
    for line in svg.lines() {
        let mark = split(line);
        let key = mark.as_ref().map(|(tag, style, _)| (*tag, style.clone()));
        if open.is_some() && open != key {
            text.push_str("</g>\n");
        }
        match mark {
            Some((tag, style, geometry)) => {
                if open != key {
                    text.push_str(&format!("<g{style}>\n"));
                }
                text.push_str(&format!("<{tag}{geometry}/>\n"));
            }
            None => {
                text.push_str(line);
                text.push('\n');
            }
        }
        open = key;
    }
    text
}

/// A mark on a line of its own: its tag, its style and its geometry.
fn split(line: &str) -> Option<(&str, String, String)> {
    let body = line.strip_prefix('<')?.strip_suffix("/>")?;
    let (tag, attributes) = body.split_once(' ')?;
    if !matches!(tag, "line" | "circle") {
        return None;
    }
    let (mut style, mut geometry) = (String::new(), String::new());
    for attribute in attributes.split_whitespace() {
        let (name, _) = attribute.split_once('=')?;
        let part = if GEOMETRY.contains(&name) { &mut geometry } else { &mut style };
        part.push(' ');
        part.push_str(attribute);
    }
    Some((tag, style, geometry))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_of_one_style_share_a_group_and_others_stay() {
        let svg = "<svg>\n<circle cx=\"1\" cy=\"2\" r=\"3\" fill=\"none\"/>\n<circle cx=\"4\" cy=\"5\" r=\"3\" fill=\"none\"/>\n\
                   <line opacity=\"1\" x1=\"0\" y1=\"0\" x2=\"1\" y2=\"1\"/>\n<text x=\"1\">\nA\n</text>\n</svg>\n";
        let expected = "<svg>\n<g fill=\"none\">\n<circle cx=\"1\" cy=\"2\" r=\"3\"/>\n<circle cx=\"4\" cy=\"5\" r=\"3\"/>\n</g>\n\
                        <g opacity=\"1\">\n<line x1=\"0\" y1=\"0\" x2=\"1\" y2=\"1\"/>\n</g>\n<text x=\"1\">\nA\n</text>\n</svg>\n";
        assert_eq!(compact(svg), expected);
    }
}
