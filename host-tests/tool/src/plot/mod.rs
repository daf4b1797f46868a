//! All plots and figures: SVG with a background, for light and dark, whose words keep their size.

mod chart;
mod svg;
mod view;

pub use chart::{Axes, Axis, Chart, Key, Mark};
pub use svg::{Anchor, Area, Ink, Svg};
pub use view::View;

/// Widths of a plot on a wide page and on a phone, px.
pub const WIDTHS: [f64; 2] = [880.0, 350.0];
/// Of a figure in a page of the documentation, so that a phone shows its words 10 px high.
pub const FIGURE: f64 = 440.0;

/// Draws one chart, or several below each other, into an SVG of its own.
pub fn draw(width: f64, height: f64, content: impl FnOnce(&mut Svg, Area)) -> String {
    let mut svg = Svg::new(width, height);
    let area = svg.area();
    content(&mut svg, area);
    svg.finish()
}

/// The same for a report: on a wide page, and on a phone.
pub fn at_widths(height: f64, content: impl Fn(&mut Svg, Area)) -> [String; 2] {
    WIDTHS.map(|width| draw(width, height, &content))
}
