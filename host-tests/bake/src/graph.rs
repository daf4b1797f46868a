//! The automaton of a body as Graphviz: its features, and between which of them the tracker switches (the paper's
//! Figure 3 D).
//!
//! A face and a face across a smooth edge hand over to each other directly: the edge's region is empty. Any other edge
//! is a state of its own between its faces and its vertices.

use super::body::{BakedBody, BakedSide};
use palpate::body::EdgeKind;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// The graph; `name` is the body's, `labels` are the faces'.
pub fn graph(body: &BakedBody, name: &str, labels: &[String]) -> String {
    let mut text = format!("graph {} {{\n  layout = neato;\n  overlap = false;\n", quoted(name));
    // Writing to a string does not fail.
    for (index, label) in labels.iter().enumerate() {
        let _ = writeln!(text, "  f{index} [shape = box, label = {}];", quoted(label.trim_matches('"')));
    }
    let mut lines = BTreeSet::new();
    let mut vertices = BTreeSet::new();
    for (index, edge) in body.edges.iter().enumerate() {
        let faces = edge.faces.map(|of| usize::from(of.face));
        if edge.kind == EdgeKind::Smooth {
            lines.insert(format!("  f{} -- f{} [label = \"e{index}\"];", faces[0], faces[1]));
            continue;
        }
        let _ = writeln!(text, "  e{index} [shape = ellipse, label = \"e{index} {}\"];", kind(edge.kind));
        for face in faces.into_iter().filter(|face| *face < body.faces.len()) {
            lines.insert(format!("  f{face} -- e{index};"));
        }
        for end in edge.ends {
            vertices.insert(end);
            lines.insert(format!("  e{index} -- v{end};"));
        }
    }
    for (index, face) in body.faces.iter().enumerate() {
        for side in &face.sides {
            if let BakedSide::Pole { vertex } = side {
                vertices.insert(*vertex);
                lines.insert(format!("  f{index} -- v{vertex};"));
            }
        }
    }
    for vertex in vertices {
        let _ = writeln!(text, "  v{vertex} [shape = point, xlabel = \"v{vertex}\"];");
    }
    for line in lines {
        let _ = writeln!(text, "{line}");
    }
    text.push_str("}\n");
    text
}

const fn kind(kind: EdgeKind) -> &'static str {
    match kind {
        EdgeKind::Convex => "convex",
        EdgeKind::Smooth => "smooth",
        EdgeKind::Reflex => "reflex",
        EdgeKind::Mixed => "mixed",
        EdgeKind::Open => "open",
    }
}

/// As a string of Graphviz: quotes and backslashes escaped, no line ends.
fn quoted(text: &str) -> String {
    let plain: String = text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect();
    format!("\"{}\"", plain.replace('\\', "\\\\").replace('"', "\\\""))
}
