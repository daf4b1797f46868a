//! Patches as the text of a model file.

use std::fmt::Write as _;

/// A Bézier patch, in millimetres: `points[i][j] = [x, y, z, w]`, not multiplied by the weight.
#[derive(Clone, Debug)]
pub(super) struct BezierPatch {
    pub name: String,
    pub degree: [usize; 2],
    pub points: Vec<Vec<[f64; 4]>>,
    pub flip: bool,
}

/// The file. Every number is the shortest decimal that reads back as the same `f64`.
pub(super) fn model(about: &str, name: &str, patches: &[BezierPatch]) -> String {
    let mut text = format!("# {about}\nname = \"{name}\"\nunit = \"mm\"\n");
    for patch in patches {
        let flip = if patch.flip { "flip = true\n" } else { "" };
        let is_rational = patch.points.iter().flatten().any(|[.., w]| *w != 1.0);
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "\n[[patch]]\nname = \"{}\"\ndegree = [{}, {}]\n{flip}points = [\n",
            patch.name, patch.degree[0], patch.degree[1]
        );
        for row in &patch.points {
            let point = |[x, y, z, w]: &[f64; 4]| {
                let numbers = if is_rational { vec![*x, *y, *z, *w] } else { vec![*x, *y, *z] };
                // A zero has no sign in a file.
                let numbers: Vec<_> = numbers.iter().map(|number| format!("{:?}", number + 0.0)).collect();
                format!("[{}]", numbers.join(", "))
            };
            let _ = writeln!(text, "  [{}],", row.iter().map(point).collect::<Vec<_>>().join(", "));
        }
        text.push_str("]\n");
    }
    text
}
