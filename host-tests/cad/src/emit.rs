//! The model file.

use crate::part::Part;
use crate::patches::Made;
use glam::DVec3;
use std::collections::HashMap;
use std::fmt::Write as _;

/// The text of a model file; `header` goes in front as comments.
pub fn toml(part: &Part, made: &[Made], header: &[String]) -> String {
    let mut text = String::new();
    for line in header {
        let _ = writeln!(text, "# {line}");
    }
    let _ = write!(text, "name = {}\nunit = \"mm\"\n", quoted(&part.name));
    for (name, made) in names(part, made).iter().zip(made) {
        let [p, q] = made.bezier.degree;
        let _ = write!(text, "\n[[patch]]\nname = {}\ndegree = [{p}, {q}]\npoints = [\n", quoted(name));
        for i in 0..=p {
            let row: Vec<String> = (0..=q).map(|j| point(made.bezier.points[made.bezier.index(i, j)])).collect();
            let _ = writeln!(text, "  [{}],", row.join(", "));
        }
        text.push_str("]\n");
        if part.faces[made.face].flip {
            text.push_str("flip = true\n");
        }
    }
    text
}

/// The names of the patches: their face's, with a number where it has more than one.
pub fn names(part: &Part, made: &[Made]) -> Vec<String> {
    let own = |made: &Made| part.faces[made.face].name.as_str();
    let mut counts: HashMap<&str, usize> = HashMap::new();
    made.iter().for_each(|made| *counts.entry(own(made)).or_insert(0) += 1);
    let mut next: HashMap<&str, usize> = HashMap::new();
    let name = |made: &Made| {
        let name = own(made);
        let number = next.entry(name).or_insert(0);
        *number += 1;
        if counts[name] == 1 { name.to_owned() } else { format!("{name}/{number}") }
    };
    made.iter().map(name).collect()
}

/// Nine digits behind the point: a picometre, and the same digits wherever the same number stands.
fn point(point: DVec3) -> String {
    let number = |value: f64| {
        let text = format!("{value:.9}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        if text == "-0" { "0".to_owned() } else { text.to_owned() }
    };
    format!("[{}, {}, {}]", number(point.x), number(point.y), number(point.z))
}

/// A TOML string.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted.push(' '),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}
