//! A part and its patches, held against what the file's text states.

use super::corners::Corners;
use super::{Outline, Reread};
use crate::bezier::Bezier;
use crate::error::ImportError;
use crate::part::Part;

/// The relative difference that is allowed between a volume or area in the file and that of the patches: systems give
/// four digits and more; an area grows by the tolerance over the radius too: it is
/// compared where the tolerance is below a thousandth of its root. To a volume, what the tolerance encloses
/// over the area is added.
const STATED: [f64; 2] = [2e-3, 5e-3];

impl Reread {
    /// Holds a part as it was read against the file: faces, and the edges of each with the sense of its outline.
    ///
    /// # Errors
    /// The first face that differs.
    pub fn compare_outlines(&self, part: &Part, is_whole: bool) -> Result<(), ImportError> {
        // A face that two shells of a model list is read twice.
        if is_whole && part.faces.len() < self.faces {
            let reason = format!("{} of its {} faces were read; export the part again", part.faces.len(), self.faces);
            return Err(ImportError::face(part.name.clone(), reason));
        }
        for face in &part.faces {
            let Some(wanted) = face.number.and_then(|number| self.outlines.get(&number)) else { continue };
            let mut found = Outline::new();
            for used in face.loops.iter().flatten() {
                let Some(number) = part.edges[used.edge].number else { continue };
                *found.entry((number, !used.reversed)).or_insert(0) += 1;
            }
            if found != *wanted {
                let reason = "its outline is not the one that the file's text has, or runs the other way; export the \
                              part again";
                return Err(ImportError::face(face.label(), reason));
            }
        }
        Ok(())
    }

    /// Holds a part as it was divided against the file: the outline of every face runs as there, or is marked as
    /// healed. On a surface that closes on itself it would bound another part of it.
    ///
    /// # Errors
    /// The first face that differs.
    pub fn compare_senses(&self, part: &Part) -> Result<(), ImportError> {
        for face in part.faces.iter().filter(|face| !face.is_healed) {
            let Some(wanted) = face.number.and_then(|number| self.outlines.get(&number)) else { continue };
            let mut senses = face.loops.iter().flatten().filter_map(|used| {
                let number = part.edges[used.edge].number?;
                // Both ways round: a seam, of whose two edges in the file one may be left.
                if face.loops.iter().flatten().any(|o| o.edge == used.edge && o.reversed != used.reversed) {
                    return None;
                }
                let [with, against] = [!used.reversed, used.reversed].map(|way| wanted.contains_key(&(number, way)));
                // Of an edge that was joined to another's the file's face knows nothing.
                Some(with || !against)
            });
            if senses.any(|is_right| !is_right) {
                let reason = "its outline runs against the file's: it is the wrong part of its surface; export the part again, \
                              with the face split";
                return Err(ImportError::face(face.label(), reason));
            }
        }
        Ok(())
    }

    /// Holds patches against the file: every vertex, placed by its text, has one within `near`, millimetres, if that is
    /// given. `whole` is their volume and area.
    ///
    /// # Errors
    /// A vertex without one, or a volume or area other than that which the file's own system computed.
    pub fn compare_patches(
        &self,
        part: &Part,
        patches: &[&Bezier],
        near: Option<f64>,
        whole: [f64; 2],
    ) -> Result<(), ImportError> {
        let Some(near) = near else { return Ok(()) };
        let found = Corners::new(patches, near);
        if let Some(lost) = self.points.iter().find(|point| !found.has(point.at)) {
            let face = part.faces.iter().find(|face| face.number == Some(lost.face));
            let label = face.map_or_else(|| format!("face #{}", lost.face), crate::part::Face::label);
            let reason = format!(
                "its vertex #{} lies at ({:.3}, {:.3}, {:.3}) mm by the file's units and placements, and no patch \
                 within {near:.6} mm of it; export the part again, in one unit, or its solids one by one",
                lost.vertex, lost.at.x, lost.at.y, lost.at.z
            );
            return Err(ImportError::face(label, reason));
        }
        // An open part has no volume, and the shells of such a part have areas of their own.
        if part.solids.iter().any(|solid| !solid.is_closed) {
            return Ok(());
        }
        // Half of it is the tolerance, or more.
        let slack = [0.5 * near * whole[1], 0.0];
        let is_fine = near <= 1e-3 * whole[1].sqrt();
        for (k, (kind, unit)) in
            [("volume", "mm³"), ("area", "mm²")].into_iter().take(1 + usize::from(is_fine)).enumerate()
        {
            let (found, allowed) = (whole[k], |stated: f64| STATED[k] * stated.abs() + slack[k]);
            if let Some(stated) = self.stated[k].filter(|stated| (found - stated).abs() > allowed(*stated)) {
                let reason = format!(
                    "its {kind} is {found:.3} {unit}, and {stated:.3} by the file's own validation properties; export \
                     the part again"
                );
                return Err(ImportError::face(part.name.clone(), reason));
            }
        }
        Ok(())
    }
}
