//! An SVG as text: paths and words in named inks, light or dark as its reader has chosen.

use std::fmt::Write as _;

/// A colour of all drawings: class, on light paper, on dark paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// The paper itself, over something else.
    Paper,
    /// Words.
    Text,
    /// Grids, nets, what stands behind.
    Grey,
    Blue,
    Red,
    Green,
    Purple,
    Orange,
    /// Pale fills of faces, in turn.
    Face(u16),
    /// Fills of edges, in turn.
    Edge(u16),
    /// Fills of vertices, in turn.
    Vertex(u16),
    /// Starts that do not converge.
    Dark,
}

const PALE: [(&str, &str, &str); 6] = [
    ("f0", "#ffd6a5", "#6b4a20"),
    ("f1", "#cae6b8", "#3d5c2a"),
    ("f2", "#bbd8f7", "#26486e"),
    ("f3", "#f8c7cc", "#6e2f38"),
    ("f4", "#d9ccf2", "#4a3a70"),
    ("f5", "#f6eeac", "#5e5620"),
];
const EDGES: [(&str, &str, &str); 2] = [("e0", "#96a0ac", "#77818d"), ("e1", "#7c8794", "#929ca8")];
const VERTICES: [(&str, &str, &str); 2] = [("v0", "#484f58", "#c9d1d9"), ("v1", "#626a74", "#b1bac4")];
const PAPER: [&str; 2] = ["#fff", "#0d1117"];

impl Ink {
    /// For curves of a family.
    pub const FAMILY: [Self; 6] = [Self::Blue, Self::Red, Self::Green, Self::Purple, Self::Orange, Self::Grey];
    const PLAIN: [Self; 9] = [
        Self::Paper,
        Self::Text,
        Self::Grey,
        Self::Blue,
        Self::Red,
        Self::Green,
        Self::Purple,
        Self::Orange,
        Self::Dark,
    ];

    fn row(self) -> (&'static str, &'static str, &'static str) {
        let [light, dark] = PAPER;
        match self {
            Self::Paper => ("p", light, dark),
            Self::Text => ("k", "#1b1f24", "#e6edf3"),
            Self::Grey => ("g", "#aeb6bf", "#545d68"),
            Self::Blue => ("b", "#1f6feb", "#58a6ff"),
            Self::Red => ("r", "#d1242f", "#ff7b72"),
            Self::Green => ("n", "#1a7f37", "#56d364"),
            Self::Purple => ("u", "#8250df", "#bc8cff"),
            Self::Orange => ("o", "#bc4c00", "#f0883e"),
            Self::Dark => ("d", "#57606a", "#8b949e"),
            Self::Face(index) => PALE[usize::from(index) % PALE.len()],
            Self::Edge(index) => EDGES[usize::from(index) % EDGES.len()],
            Self::Vertex(index) => VERTICES[usize::from(index) % VERTICES.len()],
        }
    }

    fn class(self) -> &'static str {
        self.row().0
    }
}

/// The side of a place on which words stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// A part of a drawing.
#[derive(Clone, Copy, Debug)]
pub struct Area {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

impl Area {
    /// Equal parts, row after row.
    pub fn split(self, rows: usize, columns: usize) -> Vec<Self> {
        let (width, height) = (self.width / columns as f64, self.height / rows as f64);
        let part = |index: usize| Self {
            x: self.x + width * (index % columns) as f64,
            y: self.y + height * (index / columns) as f64,
            width,
            height,
        };
        (0..rows * columns).map(part).collect()
    }

    /// The part above a line this far below the top, and the rest.
    pub fn split_at(self, height: f64) -> (Self, Self) {
        (Self { height, ..self }, Self { y: self.y + height, height: self.height - height, ..self })
    }
}

/// Height of words, px.
pub const FONT: f64 = 13.0;

/// About how wide words are, px: no font of a usual system is much wider.
pub fn width_of(words: &str) -> f64 {
    0.59 * FONT * words.chars().count() as f64
}

/// Words, cut to a width, px.
pub fn cut(words: &str, width: f64) -> String {
    let fits = (width / (0.59 * FONT)).max(1.0) as usize;
    if words.chars().count() <= fits {
        return words.to_owned();
    }
    words.chars().take(fits - 1).chain(['…']).collect()
}

/// A drawing.
#[derive(Debug)]
pub struct Svg {
    area: Area,
    text: String,
}

impl Svg {
    /// Empty paper of this size, px.
    pub fn new(width: f64, height: f64) -> Self {
        Self { area: Area { x: 0.0, y: 0.0, width, height }, text: String::new() }
    }

    pub const fn area(&self) -> Area {
        self.area
    }

    /// A line along a path, px wide.
    pub fn stroke(&mut self, ink: Ink, width: f64, path: &Path) {
        self.path(ink, &format!(" stroke-width=\"{}\"", number(width)), path);
    }

    pub fn dashed(&mut self, ink: Ink, width: f64, path: &Path) {
        self.path(ink, &format!(" stroke-width=\"{}\" stroke-dasharray=\"5 4\"", number(width)), path);
    }

    /// A path's inside, or its dots, see [`Path::dot`].
    pub fn fill(&mut self, ink: Ink, path: &Path) {
        if !path.0.is_empty() {
            let _ = writeln!(self.text, "<path class=\"{} f\" d=\"{}\"/>", ink.class(), path.0);
        }
    }

    pub fn dots(&mut self, ink: Ink, radius: f64, path: &Path) {
        self.path(ink, &format!(" stroke-width=\"{}\"", number(2.0 * radius)), path);
    }

    fn path(&mut self, ink: Ink, style: &str, path: &Path) {
        if !path.0.is_empty() {
            let _ = writeln!(self.text, "<path class=\"{}\"{style} d=\"{}\"/>", ink.class(), path.0);
        }
    }

    /// Words, their middle at this height.
    pub fn words(&mut self, (x, y): (f64, f64), anchor: Anchor, ink: Ink, words: &str) {
        self.any_words(ink.class(), (x, y), anchor, words);
    }

    /// The same on paper of their own, over lines. Not of signs that fonts share among them: each one's paper would
    /// cover the next.
    pub fn words_over(&mut self, at: (f64, f64), anchor: Anchor, ink: Ink, words: &str) {
        self.any_words(&format!("{} w", ink.class()), at, anchor, words);
    }

    /// Bold ones.
    pub fn heading(&mut self, at: (f64, f64), words: &str) {
        self.any_words("k h", at, Anchor::Start, words);
    }

    fn any_words(&mut self, class: &str, (x, y): (f64, f64), anchor: Anchor, words: &str) {
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let words = words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let (x, y) = (number(x), number(y + 0.35 * FONT));
        let _ = writeln!(self.text, "<text class=\"{class}\" x=\"{x}\" y=\"{y}\"{anchor}>{words}</text>");
    }

    /// The file.
    pub fn finish(self) -> String {
        let Area { width, height, .. } = self.area;
        let (width, height, text) = (number(width), number(height), self.text);
        let mut light = String::new();
        let mut dark = String::new();
        let inks = Ink::PLAIN.map(Ink::row).into_iter().chain(PALE).chain(EDGES).chain(VERTICES);
        for (class, on_light, on_dark) in inks {
            // Only what is used: a name stands alone, or before others of its class.
            if class == "p"
                || text.contains(&format!("class=\"{class}\""))
                || text.contains(&format!("class=\"{class} "))
            {
                let _ = write!(light, ".plot .{class}{{color:{on_light}}}");
                let _ = write!(dark, ".plot .{class}{{color:{on_dark}}}");
            }
        }
        let [paper, night] = PAPER;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\">\n<style>.plot path{{fill:none;stroke:currentColor;stroke-linejoin:round;\
             stroke-linecap:round}}.plot .f{{fill:currentColor;stroke:none}}.plot text{{font:{FONT}px system-ui,sans-serif;\
             fill:currentColor}}.plot .w{{stroke:{paper};stroke-width:3px;stroke-linejoin:round;paint-order:stroke}}\
             .plot .h{{font-weight:600}}{light}@media(prefers-color-scheme:dark){{.plot .w{{stroke:{night}}}{dark}}}\
             </style>\n<path class=\"p f\" d=\"M0 0h{width}v{height}h-{width}z\"/>\n{text}</svg>\n"
        )
    }
}

/// A number with a tenth of a pixel, as short as it can be.
fn number(value: f64) -> String {
    let tenths = (value * 10.0).round() as i64;
    if tenths % 10 == 0 { (tenths / 10).to_string() } else { (tenths as f64 / 10.0).to_string() }
}

/// The way of a pen, in pixels.
#[derive(Clone, Debug, Default)]
pub struct Path(String);

impl Path {
    /// A polyline. Steps that no screen shows are left out.
    pub fn line(points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let mut path = Self::default();
        path.add_line(points);
        path
    }

    /// One more.
    pub fn add_line(&mut self, points: impl IntoIterator<Item = (f64, f64)>) {
        // Tenths of a pixel, so that relative steps add up to where they should.
        let mut last: Option<[i64; 2]> = None;
        for (x, y) in points {
            let at = [x, y].map(|coordinate| (coordinate * 10.0).round() as i64);
            match last {
                None => {
                    let _ = write!(self.0, "M{} {}l", tenths(at[0]), tenths(at[1]));
                }
                Some(before) if before == at => continue,
                Some(before) => {
                    let [x, y] = [at[0] - before[0], at[1] - before[1]].map(tenths);
                    let between = if y.starts_with('-') { "" } else { " " };
                    let ends = self.0.ends_with('l') || x.starts_with('-');
                    let _ = write!(self.0, "{}{x}{between}{y}", if ends { "" } else { " " });
                }
            }
            last = Some(at);
        }
        if self.0.ends_with('l') {
            self.0.push_str("0 0");
        }
    }

    /// A dot, of the stroke's width.
    pub fn dot(&mut self, (x, y): (f64, f64)) {
        let _ = write!(self.0, "M{} {}h0", number(x), number(y));
    }

    /// A cross.
    pub fn cross(&mut self, (x, y): (f64, f64), half: f64) {
        let (side, left, top) = (number(2.0 * half), number(x - half), number(y - half));
        let _ = write!(self.0, "M{left} {top}l{side} {side}m0-{side}l-{side} {side}");
    }

    /// A ring.
    pub fn ring(&mut self, (x, y): (f64, f64), radius: f64) {
        let (r, side) = (number(radius), number(2.0 * radius));
        let _ = write!(self.0, "M{} {}a{r} {r} 0 1 0 {side} 0a{r} {r} 0 1 0-{side} 0", number(x - radius), number(y));
    }

    /// A rectangle between two corners.
    pub fn rectangle(&mut self, [a, b]: [(f64, f64); 2]) {
        let (left, top) = (a.0.min(b.0), a.1.min(b.1));
        let (width, height) = (number((a.0 - b.0).abs()), number((a.1 - b.1).abs()));
        let _ = write!(self.0, "M{} {}h{width}v{height}h-{width}z", number(left), number(top));
    }
}

fn tenths(value: i64) -> String {
    let text = number(value as f64 / 10.0);
    // 0.3 is .3 to SVG.
    match text.strip_prefix("-0.") {
        Some(rest) => format!("-.{rest}"),
        None => text.strip_prefix("0.").map_or(text.clone(), |rest| format!(".{rest}")),
    }
}
