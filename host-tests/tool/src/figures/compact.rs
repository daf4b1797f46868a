//! Smaller SVG: marks that look alike share their style.

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
