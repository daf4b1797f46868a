//! Report of an import, for the terminal and the model's first lines.

use crate::measure::Measured;
use crate::mesh::{Mesh, Side};
use crate::patches::Made;
use std::collections::BTreeMap;

/// The lines.
pub fn lines(mesh: &Mesh<'_>, made: &[Made], measured: &Measured, tolerance: f64) -> Vec<String> {
    let part = mesh.part;
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    // A face that was divided counts once.
    let faces: BTreeMap<&str, &str> = part.faces.iter().map(|face| (face.name.as_str(), face.kind)).collect();
    faces.values().for_each(|kind| *kinds.entry(kind).or_insert(0) += 1);
    let kinds: Vec<String> = kinds.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    let mut solids: Vec<&str> = part.solids.iter().map(|solid| solid.name.as_str()).collect();
    solids.dedup();
    let name = |face: usize| &part.faces[face].name;
    let mut lines = vec![
        format!("imported from a STEP file: {}, within {tolerance} mm", solids.join(", ")),
        format!(
            "{} faces ({}): {} patches, {} control points",
            faces.len(),
            kinds.join(", "),
            made.len(),
            points(made)
        ),
        format!(
            "largest deviation: patches from part {:.6} mm ({}), part from patches {:.6} mm ({})",
            measured.out.0,
            name(measured.out.1),
            measured.back.0,
            name(measured.back.1)
        ),
        format!("largest angle between the normals: {:.4} degrees ({})", measured.normal.0, name(measured.normal.1)),
        format!("area: patches {:.3} mm², part {:.3} mm²", measured.area[0], measured.area[1]),
    ];
    if is_closed(mesh) {
        lines.push(format!("volume: patches {:.3} mm³, part {:.3} mm³", measured.volume[0], measured.volume[1]));
    } else {
        lines.push("the body is open: it has no inside".to_owned());
    }
    lines.extend(part.remarks.iter().cloned());
    lines
}

fn points(made: &[Made]) -> usize {
    made.iter().map(|made| made.bezier.points.len()).sum()
}

/// Whether every wire has two sides.
fn is_closed(mesh: &Mesh<'_>) -> bool {
    let mut uses = vec![0; mesh.wires.len()];
    let sides =
        mesh.regions.iter().flat_map(|region| region.quads.iter().flat_map(|quad: &crate::mesh::Quad| &quad.sides));
    for (wire, _) in sides.filter_map(|side: &Side| side.wire) {
        uses[wire] += 1;
    }
    uses.iter().all(|uses| *uses != 1)
}
