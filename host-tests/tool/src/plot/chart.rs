//! Axes with ticks and names, and the marks between them.
//!
//! From top to bottom: title, names of the curves, name of the upward axis, the chart, its ticks, name of the other
//! axis. Nothing but marks stands in the chart, so nothing can cover a curve.

use super::svg::{Anchor, Area, FONT, Ink, Path, Svg, cut, width_of};
use super::view::equal_scale;

/// Height of a line of words, px.
const LINE: f64 = 19.0;
/// Length of a key, px.
const KEY: f64 = 20.0;

/// Which numbers stand along an axis.
#[derive(Clone, Copy, Debug)]
pub enum Scale<'a> {
    Linear,
    Log,
    /// Names for 0, 1, 2, …
    Named(&'a [String]),
}

#[derive(Clone, Copy, Debug)]
pub struct Axis<'a> {
    pub label: &'a str,
    pub range: [f64; 2],
    pub scale: Scale<'a>,
}

impl<'a> Axis<'a> {
    pub const fn linear(label: &'a str, range: [f64; 2]) -> Self {
        Self { label, range, scale: Scale::Linear }
    }

    pub const fn log(label: &'a str, range: [f64; 2]) -> Self {
        Self { label, range, scale: Scale::Log }
    }

    pub const fn named(label: &'a str, names: &'a [String]) -> Self {
        Self { label, range: [-0.6, names.len() as f64 - 0.4], scale: Scale::Named(names) }
    }

    /// The linear one over all of these numbers, with a little margin.
    pub fn over(label: &'a str, values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = values.into_iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
        let room = (0.04 * (high - low)).max(1e-9);
        Self::linear(label, if low > high { [0.0, 1.0] } else { [low - room, high + room] })
    }

    /// Places and names of the ticks on a length, px.
    fn ticks(&self, length: f64, is_across: bool) -> Vec<(f64, String)> {
        let [low, high] = self.range;
        match self.scale {
            Scale::Named(names) => names.iter().enumerate().map(|(at, name)| (at as f64, name.clone())).collect(),
            Scale::Linear => {
                let room = if is_across { 64.0 } else { 30.0 };
                let wanted = (high - low) / (length / room).max(1.0);
                let decade = 10_f64.powf(wanted.log10().floor());
                let step =
                    [1.0, 2.0, 5.0, 10.0].map(|part| part * decade).into_iter().find(|step| *step >= wanted * 0.999);
                let step = step.unwrap_or(10.0 * decade);
                // Where that leaves fewer than three, the longest below it that does not.
                let leaves_three = |step: &f64| (high / step + 1e-6).floor() - (low / step - 1e-6).ceil() >= 2.0;
                let shorter = [5.0, 4.0, 2.0, 1.0, 0.5].map(|part| part * decade);
                let step = [step].into_iter().chain(shorter.into_iter().filter(|shorter| *shorter < step));
                let step = step.clone().find(leaves_three).or_else(|| step.clone().next()).unwrap_or(decade);
                let digits = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
                let first = (low / step - 1e-6).ceil() as i64;
                (first..)
                    .map(|index| index as f64 * step)
                    .take_while(|value| *value <= high + 1e-6 * step)
                    .map(|value| (value, minus(format!("{:.digits$}", if value == 0.0 { 0.0 } else { value }))))
                    .collect()
            }
            Scale::Log => {
                let decades = [(low.log10() - 1e-9).ceil() as i32, (high.log10() + 1e-9).floor() as i32];
                let room = if is_across { 58.0 } else { 24.0 };
                let apart = length / (high / low).log10();
                let every = (room / apart).ceil().max(1.0) as usize;
                let parts: &[f64] = if apart > 3.5 * room { &[1.0, 2.0, 5.0] } else { &[1.0] };
                (decades[0] - 1..=decades[1])
                    .flat_map(|decade| parts.iter().map(move |part| (decade, *part)))
                    .map(|(decade, part)| (decade, part * 10_f64.powi(decade), part))
                    .filter(|(decade, value, _)| {
                        let place = decade.rem_euclid(every as i32) == 0;
                        place && *value >= low * 0.999 && *value <= high * 1.001
                    })
                    .map(|(decade, value, part)| (value, power(decade, value, part)))
                    .collect()
            }
        }
    }
}

/// A minus that is as wide as a plus.
fn minus(text: String) -> String {
    text.replace('-', "−")
}

fn power(decade: i32, value: f64, part: f64) -> String {
    if (-3..=4).contains(&decade) {
        return value
            .to_string()
            .parse::<f64>()
            .map_or_else(|_| value.to_string(), |v| format!("{}", (v * 1e6).round() / 1e6));
    }
    let digits = decade.to_string();
    let raised: String =
        digits.chars().filter_map(|letter| "⁻⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth("-0123456789".find(letter)?)).collect();
    if part == 1.0 { format!("10{raised}") } else { format!("{part}·10{raised}") }
}

/// How a curve's name is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    Line,
    Dashed,
    Dot,
    Ring,
    Fill,
}

/// The name of a curve, its ink and its mark.
pub type Key<'a> = (&'a str, Ink, Mark);

/// Two axes with a title and the names of the curves.
#[derive(Clone, Copy, Debug)]
pub struct Axes<'a> {
    pub title: &'a str,
    pub x: Axis<'a>,
    pub y: Axis<'a>,
    pub keys: &'a [Key<'a>],
}

/// A chart to draw in.
#[derive(Debug)]
pub struct Chart<'s> {
    svg: &'s mut Svg,
    inner: Area,
    x: (f64, f64, bool),
    y: (f64, f64, bool),
}

/// Lines of names that this needs at a width, px.
fn key_lines(keys: &[Key<'_>], width: f64) -> Vec<Vec<(f64, usize)>> {
    let mut lines: Vec<Vec<(f64, usize)>> = Vec::new();
    let mut at = width;
    for (index, (name, ..)) in keys.iter().enumerate() {
        let needs = KEY + 8.0 + width_of(name) + 18.0;
        if at + needs > width {
            lines.push(Vec::new());
            at = 0.0;
        }
        if let Some(line) = lines.last_mut() {
            line.push((at, index));
        }
        at += needs;
    }
    lines
}

/// The names of several faces, a line for as many as fit a width, px.
fn wrapped(names: &str, width: f64) -> Vec<String> {
    const BETWEEN: &str = " | ";
    let mut lines: Vec<String> = Vec::new();
    for name in names.split(BETWEEN) {
        match lines.last_mut().filter(|line| width_of(line) + width_of(BETWEEN) + width_of(name) <= width) {
            Some(line) => *line += &format!("{BETWEEN}{name}"),
            None => lines.push(name.to_owned()),
        }
    }
    lines
}

/// Title and names of curves; the part below them.
fn head(svg: &mut Svg, area: Area, title: &str, keys: &[Key<'_>]) -> Area {
    const SIDE: f64 = 10.0;
    let mut top = area.y + 6.0;
    if !title.is_empty() {
        svg.heading((area.x + SIDE, top + 0.5 * LINE), &cut(title, area.width - 2.0 * SIDE));
        top += LINE + 2.0;
    }
    for line in key_lines(keys, area.width - 2.0 * SIDE) {
        for (at, index) in line {
            let (name, ink, mark) = keys[index];
            let (left, middle) = (area.x + SIDE + at, top + 0.5 * LINE);
            let (line, dot) = (Path::line([(left, middle), (left + KEY, middle)]), (left + 0.5 * KEY, middle));
            let mut path = Path::default();
            match mark {
                Mark::Line => svg.stroke(ink, 2.5, &line),
                Mark::Dashed => svg.dashed(ink, 2.0, &line),
                Mark::Dot => {
                    path.dot(dot);
                    svg.dots(ink, 3.5, &path);
                }
                Mark::Ring => {
                    path.ring(dot, 4.0);
                    svg.stroke(ink, 1.0, &path);
                }
                Mark::Fill => {
                    path.rectangle([(left, middle - 5.0), (left + KEY, middle + 5.0)]);
                    svg.fill(ink, &path);
                }
            }
            svg.words((left + KEY + 8.0, middle), Anchor::Start, Ink::Text, &cut(name, area.width - KEY - 2.0 * SIDE));
        }
        top += LINE;
    }
    Area { y: top, height: area.height - (top - area.y), ..area }
}

impl Axes<'_> {
    /// Draws them; what the chart is to hold comes then.
    pub fn on<'s>(&self, svg: &'s mut Svg, area: Area) -> Chart<'s> {
        let rest = head(svg, area, self.title, self.keys);
        let top = rest.y + if self.y.label.is_empty() { 6.0 } else { LINE + 6.0 };
        let bottom = rest.y + rest.height - if self.x.label.is_empty() { LINE } else { 2.0 * LINE } - 4.0;
        let upward = self.y.ticks(bottom - top, false);
        let lines = upward.iter().flat_map(|(_, name)| wrapped(name, 0.4 * area.width));
        let widest = lines.map(|line| width_of(&line)).fold(0.0, f64::max).min(0.4 * area.width);
        let left = area.x + 10.0 + widest + 8.0;
        let right = area.x + area.width - 22.0;
        let inner = Area { x: left, y: top, width: right - left, height: bottom - top };
        let is_log = |axis: &Axis<'_>| matches!(axis.scale, Scale::Log);
        let chart = Chart {
            svg,
            inner,
            x: (self.x.range[0], self.x.range[1], is_log(&self.x)),
            y: (self.y.range[0], self.y.range[1], is_log(&self.y)),
        };
        let mut grid = Path::default();
        for (value, name) in &upward {
            let y = chart.up(*value);
            grid.add_line([(left, y), (right, y)]);
            let lines = wrapped(name, 0.4 * area.width);
            let first = y - 0.5 * (lines.len() - 1) as f64 * FONT;
            for (number, line) in lines.iter().enumerate() {
                let place = (left - 8.0, first + number as f64 * FONT);
                chart.svg.words(place, Anchor::End, Ink::Text, &cut(line, 0.4 * area.width));
            }
        }
        for (value, name) in self.x.ticks(inner.width, true) {
            let x = chart.across(value);
            grid.add_line([(x, top), (x, bottom)]);
            chart.svg.words((x, bottom + 0.5 * LINE + 3.0), Anchor::Middle, Ink::Text, &name);
        }
        chart.svg.stroke(Ink::Grey, 0.5, &grid);
        let frame = [(left, top), (left, bottom), (right, bottom)];
        chart.svg.stroke(Ink::Dark, 1.0, &Path::line(frame));
        chart.svg.words((area.x + 10.0, rest.y + 0.5 * LINE), Anchor::Start, Ink::Text, self.y.label);
        let middle = (left + 0.5 * inner.width, bottom + 1.5 * LINE + 2.0);
        chart.svg.words(middle, Anchor::Middle, Ink::Text, self.x.label);
        chart
    }
}

impl<'s> Chart<'s> {
    /// A view of things in space without axes, that holds all of these points.
    pub fn scene(
        svg: &'s mut Svg,
        area: Area,
        title: &str,
        keys: &[Key<'_>],
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let rest = head(svg, area, title, keys);
        // Room for names of dots.
        let inner = Area { x: rest.x + 24.0, y: rest.y + 12.0, width: rest.width - 48.0, height: rest.height - 24.0 };
        let (x, y) = equal_scale(points, (inner.width, inner.height));
        Self { svg, inner, x: (x.start, x.end, false), y: (y.start, y.end, false) }
    }

    fn across(&self, value: f64) -> f64 {
        self.inner.x + self.inner.width * share(self.x, value)
    }

    fn up(&self, value: f64) -> f64 {
        self.inner.y + self.inner.height * (1.0 - share(self.y, value))
    }

    /// Where a point is drawn, at the chart's border if it lies beyond.
    pub fn place(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (self.across(x), self.up(y))
    }

    pub fn line(&mut self, ink: Ink, width: f64, points: impl IntoIterator<Item = (f64, f64)>) {
        let path = Path::line(self.thinned(points));
        self.svg.stroke(ink, width, &path);
    }

    pub fn dashed(&mut self, ink: Ink, width: f64, points: impl IntoIterator<Item = (f64, f64)>) {
        let path = Path::line(self.thinned(points));
        self.svg.dashed(ink, width, &path);
    }

    /// Lines of one ink.
    pub fn lines(&mut self, ink: Ink, width: f64, lines: impl IntoIterator<Item = Vec<(f64, f64)>>) {
        let mut path = Path::default();
        for line in lines {
            path.add_line(line.into_iter().map(|point| self.place(point)));
        }
        self.svg.stroke(ink, width, &path);
    }

    pub fn dots(&mut self, ink: Ink, radius: f64, points: impl IntoIterator<Item = (f64, f64)>) {
        let mut path = Path::default();
        points.into_iter().for_each(|point| path.dot(self.place(point)));
        self.svg.dots(ink, radius, &path);
    }

    pub fn rings(&mut self, ink: Ink, radius: f64, points: impl IntoIterator<Item = (f64, f64)>) {
        let mut path = Path::default();
        points.into_iter().for_each(|point| path.ring(self.place(point), radius));
        self.svg.stroke(ink, 1.0, &path);
    }

    pub fn crosses(&mut self, ink: Ink, half: f64, points: impl IntoIterator<Item = (f64, f64)>) {
        let mut path = Path::default();
        points.into_iter().for_each(|point| path.cross(self.place(point), half));
        self.svg.stroke(ink, 1.2, &path);
    }

    pub fn fill(&mut self, ink: Ink, rectangles: impl IntoIterator<Item = [(f64, f64); 2]>) {
        let mut path = Path::default();
        rectangles.into_iter().for_each(|corners| path.rectangle(corners.map(|corner| self.place(corner))));
        self.svg.fill(ink, &path);
    }

    /// Words this far from a point, px.
    pub fn words(&mut self, at: (f64, f64), (dx, dy): (f64, f64), anchor: Anchor, ink: Ink, words: &str) {
        let (x, y) = self.place(at);
        self.svg.words_over((x + dx, y + dy), anchor, ink, words);
    }

    /// A dot with a name this far from it, px.
    pub fn dot(&mut self, at: (f64, f64), name: &str, ink: Ink, offset: (f64, f64)) {
        self.dots(ink, 3.5, [at]);
        self.words(at, offset, Anchor::Start, ink, name);
    }

    /// An upright dashed line with a name at its top.
    pub fn mark(&mut self, x: f64, name: &str) {
        let (low, high) = (self.y.0, self.y.1);
        self.dashed(Ink::Text, 1.0, [(x, low), (x, high)]);
        self.words((x, high), (5.0, 0.6 * FONT), Anchor::Start, Ink::Text, name);
    }

    /// In pixels; of each column of them only first, lowest, highest and last, so that no peak is lost.
    fn thinned(&self, points: impl IntoIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
        let places: Vec<_> = points.into_iter().map(|point| self.place(point)).collect();
        let mut thin = Vec::new();
        for column in places.chunk_by(|a, b| (2.0 * a.0).floor() == (2.0 * b.0).floor()) {
            if column.len() < 5 {
                thin.extend(column);
                continue;
            }
            let ends = |pick: fn(&f64, &f64) -> bool| {
                (0..column.len()).reduce(|best, at| if pick(&column[at].1, &column[best].1) { at } else { best })
            };
            let mut kept = [Some(0), ends(|a, b| a < b), ends(|a, b| a > b), Some(column.len() - 1)];
            kept.sort_unstable();
            thin.extend(kept.into_iter().flatten().map(|at| column[at]));
        }
        thin
    }
}

/// How far along a range a value lies, 0 to 1.
fn share((low, high, is_log): (f64, f64, bool), value: f64) -> f64 {
    let share = if is_log { (value.max(1e-300) / low).ln() / (high / low).ln() } else { (value - low) / (high - low) };
    share.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_inside_the_range() {
        let names =
            |axis: Axis<'_>, length| axis.ticks(length, true).into_iter().map(|tick| tick.1).collect::<Vec<_>>();
        assert_eq!(names(Axis::linear("", [-0.1, 1.02]), 300.0), ["0.0", "0.5", "1.0"]);
        assert_eq!(names(Axis::linear("", [-30.0, 30.0]), 500.0), ["−30", "−20", "−10", "0", "10", "20", "30"]);
        // Three at least, on a phone too.
        assert_eq!(names(Axis::linear("", [-45.0, 45.0]), 110.0), ["−40", "0", "40"]);
        assert_eq!(names(Axis::linear("", [0.0, 0.19]), 110.0), ["0.00", "0.05", "0.10", "0.15"]);
        assert_eq!(names(Axis::log("", [20.0, 1_000.0]), 800.0), ["20", "50", "100", "200", "500", "1000"]);
        assert_eq!(names(Axis::log("", [1e-6, 100.0]), 200.0), ["10⁻⁶", "0.001", "1"]);
    }

    #[test]
    fn names_that_do_not_fit_a_line_go_on_in_the_next() {
        assert_eq!(wrapped("side_y0 | side_x60 | dome", 150.0), ["side_y0 | side_x60", "dome"]);
        assert_eq!(wrapped("side_y0 | side_x60 | dome", 60.0), ["side_y0", "side_x60", "dome"]);
    }

    #[test]
    fn a_thinned_curve_keeps_its_peak() {
        let mut svg = Svg::new(400.0, 200.0);
        let area = svg.area();
        let axes = Axes { title: "", x: Axis::linear("", [0.0, 1.0]), y: Axis::linear("", [0.0, 1.0]), keys: &[] };
        let chart = axes.on(&mut svg, area);
        let peak = |at: usize| if at == 71_234 { 1.0 } else { 0.5 };
        let thin = chart.thinned((0..100_000).map(|at| (at as f64 / 1e5, peak(at))));
        let top = chart.place((0.0, 1.0)).1;
        assert!(thin.len() < 4_000 && thin.iter().any(|place| place.1 == top), "{}", thin.len());
    }
}
