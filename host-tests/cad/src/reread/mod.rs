//! A second reading of the file, by its text alone: how many faces lie where, with which vertices and outlines. It
//! shares no code with the first, and the part and its patches are held against it: a unit, a placement, a hole, a
//! face or the sense of an outline that the first got wrong is found without another program.

mod records;

use crate::bezier::Bezier;
use crate::error::ImportError;
use crate::part::Part;
use crate::remarks::without_remarks;
use glam::{DAffine3, DMat3, DVec3};
use records::{Records, fields, number, numbers, reference, references};
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// Assemblies in assemblies, and placed vertices: beyond, nothing is compared.
const DEEPEST: usize = 64;
const MOST_POINTS: usize = 2_000_000;
/// Entities that hold faces.
const SHAPES: [&str; 3] = ["MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "SHELL_BASED_SURFACE_MODEL"];
/// The relative difference that is allowed between a volume or area in the file and that of the patches: systems give
/// four digits and more; an area grows by the tolerance over the radius too: it is
/// compared where the tolerance is below a thousandth of its root. To a volume, what the tolerance encloses
/// over the area is added.
const STATED: [f64; 2] = [2e-3, 5e-3];

/// The measures that are compared, by type and by the name that CAD systems have agreed on.
const MEASURES: [(&str, &str); 2] =
    [("VOLUME_MEASURE", "'volume measure'"), ("AREA_MEASURE", "'surface area measure'")];

/// A vertex where the file places it, millimetres.
struct Point {
    at: DVec3,
    vertex: u64,
    face: u64,
}

/// The edges of a face, each with whether it is run along from its first vertex to its second, by the face's bounds:
/// seen from the surface's own normal, the face on the left.
type Outline = HashMap<(u64, bool), usize>;

/// The parts, outlines and places that the file's text states.
pub struct Reread {
    /// Faces by their numbers.
    outlines: HashMap<u64, Outline>,
    /// Faces, each as often as it is placed.
    faces: usize,
    points: Vec<Point>,
    /// Volume and area that the file's own system computed, mm³ and mm².
    stated: [Option<f64>; 2],
}

/// Reads a file again; `None` where it has what this reading does not follow.
pub fn read(path: &Path) -> Option<Reread> {
    let text = String::from_utf8_lossy(&std::fs::read(path).ok()?).into_owned();
    of_text(&text)
}

fn of_text(text: &str) -> Option<Reread> {
    let text = without_remarks(text);
    let records = Records::new(&text);
    let mut walk = Walk::new(&records)?;
    let roots = walk.roots();
    for root in &roots {
        walk.product(*root, DAffine3::IDENTITY, 0)?;
    }
    if walk.placed.is_empty() {
        if !records.all("MAPPED_ITEM").is_empty() {
            return None;
        }
        let units: Vec<f64> = walk.units.values().copied().collect();
        let unit = *units.first()?;
        if units.iter().any(|other| *other != unit) {
            return None;
        }
        let solids: Vec<u64> = SHAPES.iter().flat_map(|kind| records.all(kind)).collect();
        walk.placed.extend(solids.into_iter().map(|solid| (solid, DAffine3::IDENTITY, unit)));
    }
    let placed = std::mem::take(&mut walk.placed);
    let (mut outlines, mut points, mut count) = (HashMap::new(), Vec::new(), 0);
    for (solid, placement, unit) in placed {
        let faces = below(&records, solid, &["ADVANCED_FACE", "FACE_SURFACE"]);
        count += faces.len();
        let mut seen = HashSet::new();
        for face in faces {
            if let Entry::Vacant(vacant) = outlines.entry(face) {
                vacant.insert(outline(&records, face)?);
            }
            for vertex in below(&records, face, &["VERTEX_POINT"]).into_iter().filter(|vertex| seen.insert(*vertex)) {
                let at = point(&records, reference(records.part(vertex, "VERTEX_POINT")?.get(1)?)?)?;
                points.push(Point { at: placement.transform_point3(at * unit), vertex, face });
            }
        }
        if points.len() > MOST_POINTS {
            return None;
        }
    }
    let stated = if roots.len() == 1 { walk.stated(roots[0]) } else { [None; 2] };
    Some(Reread { outlines, faces: count, points, stated })
}

/// All entities of some types that an entity refers to, directly or not.
fn below(records: &Records<'_>, start: u64, kinds: &[&str]) -> Vec<u64> {
    let (mut found, mut next, mut seen) = (Vec::new(), vec![start], HashSet::new());
    while let Some(id) = next.pop() {
        if !seen.insert(id) {
            continue;
        }
        if kinds.iter().any(|kind| records.is(id, kind)) {
            found.push(id);
        } else {
            next.extend(records.references(id));
        }
    }
    found.sort_unstable();
    found
}

fn outline(records: &Records<'_>, face: u64) -> Option<Outline> {
    let is_true = |field: &&str| *field == ".T.";
    let of = records.part(face, "ADVANCED_FACE").or_else(|| records.part(face, "FACE_SURFACE"))?;
    let sense = is_true(of.last()?);
    let mut outline = Outline::new();
    for bound in references(of.get(1)?) {
        let of = records.part(bound, "FACE_BOUND").or_else(|| records.part(bound, "FACE_OUTER_BOUND"))?;
        let way = is_true(of.get(2)?) == sense;
        let Some(edges) = records.part(reference(of.get(1)?)?, "EDGE_LOOP") else { continue };
        for used in references(edges.get(1)?) {
            let used = records.part(used, "ORIENTED_EDGE")?;
            *outline.entry((reference(used.get(3)?)?, is_true(used.get(4)?) == way)).or_insert(0) += 1;
        }
    }
    Some(outline)
}

fn point(records: &Records<'_>, id: u64) -> Option<DVec3> {
    let of = records.part(id, "CARTESIAN_POINT")?;
    let [x, y, z] = numbers(of.get(1)?)[..] else { return None };
    Some(DVec3::new(x, y, z))
}

/// The way through products, representations and placements.
struct Walk<'r, 't> {
    records: &'r Records<'t>,
    /// Millimetres of the unit of each context.
    units: HashMap<u64, f64>,
    /// Representations that are one shape.
    same: HashMap<u64, Vec<u64>>,
    /// The representations of each product's definition.
    shapes: HashMap<u64, Vec<u64>>,
    /// The parts of a definition: theirs, and the relationship that places them.
    uses: HashMap<u64, Vec<(u64, Option<u64>)>>,
    placed: Vec<(u64, DAffine3, f64)>,
}

impl<'r, 't> Walk<'r, 't> {
    fn new(records: &'r Records<'t>) -> Option<Self> {
        let unit = |context: u64| {
            let units = records.part(context, "GLOBAL_UNIT_ASSIGNED_CONTEXT")?;
            let length = references(units[0]).into_iter().find(|unit| records.is(*unit, "LENGTH_UNIT"))?;
            Some((context, millimetres(records, length, 0)?))
        };
        let units: HashMap<u64, f64> =
            records.all("GLOBAL_UNIT_ASSIGNED_CONTEXT").into_iter().filter_map(unit).collect();
        let field = |fields: &[&str], k: usize| fields.get(k).and_then(|field| reference(field));
        let mut same: HashMap<u64, Vec<u64>> = HashMap::new();
        for id in records.all("SHAPE_REPRESENTATION_RELATIONSHIP") {
            if records.is(id, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") {
                continue;
            }
            let own = records.part(id, "SHAPE_REPRESENTATION_RELATIONSHIP").filter(|fields| fields.len() > 3);
            let of = own.or_else(|| records.part(id, "REPRESENTATION_RELATIONSHIP"))?;
            let (a, b) = (field(&of, 2)?, field(&of, 3)?);
            same.entry(a).or_default().push(b);
            same.entry(b).or_default().push(a);
        }
        let mut shapes: HashMap<u64, Vec<u64>> = HashMap::new();
        for id in records.all("SHAPE_DEFINITION_REPRESENTATION") {
            let of = records.part(id, "SHAPE_DEFINITION_REPRESENTATION")?;
            let Some(shape) = field(&of, 0).and_then(|of| records.part(of, "PRODUCT_DEFINITION_SHAPE")) else {
                continue;
            };
            shapes.entry(field(&shape, 2)?).or_default().push(field(&of, 1)?);
        }
        let mut places: HashMap<u64, u64> = HashMap::new();
        for id in records.all("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION") {
            let of = records.part(id, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")?;
            let shape = records.part(field(&of, 1)?, "PRODUCT_DEFINITION_SHAPE")?;
            places.insert(field(&shape, 2)?, field(&of, 0)?);
        }
        let mut uses: HashMap<u64, Vec<(u64, Option<u64>)>> = HashMap::new();
        for id in records.all("NEXT_ASSEMBLY_USAGE_OCCURRENCE") {
            let of = records.part(id, "NEXT_ASSEMBLY_USAGE_OCCURRENCE")?;
            uses.entry(field(&of, 3)?).or_default().push((field(&of, 4)?, places.get(&id).copied()));
        }
        Some(Self { records, units, same, shapes, uses, placed: Vec::new() })
    }

    /// Definitions that no other uses.
    fn roots(&self) -> Vec<u64> {
        let used: HashSet<u64> = self.uses.values().flatten().map(|(part, _)| *part).collect();
        let mut all: Vec<u64> = self.shapes.keys().chain(self.uses.keys()).copied().collect();
        all.sort_unstable();
        all.dedup();
        all.retain(|product| !used.contains(product));
        all
    }

    /// All representations of a definition.
    fn representations(&self, product: u64) -> Vec<u64> {
        let mut all = self.shapes.get(&product).cloned().unwrap_or_default();
        let mut next = 0;
        while let Some(of) = all.get(next) {
            next += 1;
            for other in self.same.get(of).cloned().unwrap_or_default() {
                if !all.contains(&other) {
                    all.push(other);
                }
            }
        }
        all
    }

    /// The fields of a representation: name, items, context.
    fn representation(&self, id: u64) -> Option<Vec<&'t str>> {
        let parts = self.records.get(id)?;
        let of = parts.iter().find(|(kind, _)| kind.ends_with("REPRESENTATION"));
        let of = parts.iter().map(|(_, fields)| *fields).find(|part| fields(part).len() >= 3).or(of.map(|of| of.1))?;
        Some(fields(of))
    }

    fn unit(&self, representation: u64) -> Option<f64> {
        let context = reference(self.representation(representation)?.get(2)?)?;
        self.units.get(&context).copied()
    }

    fn product(&mut self, product: u64, placement: DAffine3, depth: usize) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        let start = self.placed.len();
        for of in self.representations(product) {
            self.items(of, placement, depth)?;
        }
        // A solid that two representations of a product list is one.
        let mut own: Vec<(u64, DAffine3, f64)> = Vec::new();
        for placed in self.placed.split_off(start) {
            if !own.iter().any(|(solid, by, _)| *solid == placed.0 && *by == placed.1) {
                own.push(placed);
            }
        }
        self.placed.extend(own);
        for (part, relation) in self.uses.get(&product).cloned().unwrap_or_default() {
            let own = self.representations(part);
            let by = match relation {
                Some(relation) => self.transformation(relation, &own)?,
                None => DAffine3::IDENTITY,
            };
            self.product(part, placement * by, depth + 1)?;
        }
        Some(())
    }

    /// Shapes of a representation, and those that are mapped into it.
    fn items(&mut self, of: u64, placement: DAffine3, depth: usize) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        let list = self.representation(of)?;
        for item in references(list.get(1)?) {
            if SHAPES.iter().any(|kind| self.records.is(item, kind)) {
                self.placed.push((item, placement, self.unit(of)?));
            } else if let Some(fields) = self.records.part(item, "MAPPED_ITEM") {
                let map = self.records.part(reference(fields.get(1)?)?, "REPRESENTATION_MAP")?;
                let (origin, mapped) = (reference(map.first()?)?, reference(map.get(1)?)?);
                let origin = self.axes(origin, self.unit(mapped)?)?;
                let target = self.axes(reference(fields.get(2)?)?, self.unit(of)?)?;
                self.items(mapped, placement * target * origin.inverse(), depth + 1)?;
            }
        }
        Some(())
    }

    /// From a part with these representations into the whole that it belongs to.
    fn transformation(&self, relation: u64, own: &[u64]) -> Option<DAffine3> {
        let of = self.records.part(relation, "REPRESENTATION_RELATIONSHIP")?;
        let [first, second] = [2, 3].map(|k| of.get(k).and_then(|field| reference(field)));
        let with = self.records.part(relation, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION")?;
        let by = self.records.part(reference(with.first()?)?, "ITEM_DEFINED_TRANSFORMATION")?;
        let first_place = self.axes(reference(by.get(2)?)?, self.unit(first?)?)?;
        let second_place = self.axes(reference(by.get(3)?)?, self.unit(second?)?)?;
        if own.contains(&first?) {
            return Some(second_place * first_place.inverse());
        }
        own.contains(&second?).then(|| first_place * second_place.inverse())
    }

    fn axes(&self, id: u64, unit: f64) -> Option<DAffine3> {
        let of = self.records.part(id, "AXIS2_PLACEMENT_3D")?;
        let direction = |k: usize| {
            let of = self.records.part(reference(of.get(k)?)?, "DIRECTION")?;
            let [x, y, z] = numbers(of.get(1)?)[..] else { return None };
            Some(DVec3::new(x, y, z))
        };
        let z = direction(2).unwrap_or(DVec3::Z).try_normalize()?;
        let along = |x: DVec3| x.reject_from_normalized(z).try_normalize();
        let x = match direction(3) {
            Some(x) => along(x)?,
            None => along(if z.x.abs() > 1.0 - 1e-12 { DVec3::Y } else { DVec3::X })?,
        };
        let at = point(self.records, reference(of.get(1)?)?)? * unit;
        Some(DAffine3 { matrix3: DMat3::from_cols(x, z.cross(x), z), translation: at })
    }

    /// Volume and area that validation properties of the whole give, mm³ and mm².
    fn stated(&self, root: u64) -> [Option<f64>; 2] {
        let mut found = [None; 2];
        for id in self.records.all("PROPERTY_DEFINITION_REPRESENTATION") {
            let _ = self.property(id, root, &mut found);
        }
        found
    }

    fn property(&self, id: u64, root: u64, found: &mut [Option<f64>; 2]) -> Option<()> {
        let of = self.records.part(id, "PROPERTY_DEFINITION_REPRESENTATION")?;
        let definition = self.records.part(reference(of.first()?)?, "PROPERTY_DEFINITION")?;
        let shape = self.records.part(reference(definition.get(2)?)?, "PRODUCT_DEFINITION_SHAPE");
        let shape = shape.and_then(|shape| reference(shape.get(2)?)).or_else(|| reference(definition.get(2)?));
        if *definition.first()? != "'geometric validation property'" || shape != Some(root) {
            return None;
        }
        let list = self.representation(reference(of.get(1)?)?)?;
        for item in references(list.get(1)?) {
            let own = self.records.get(item)?;
            let measure = own.iter().find_map(|(_, part)| {
                let all = fields(part);
                let at = all.iter().position(|field| field.contains("_MEASURE("))?;
                Some((all[at], reference(all.get(at + 1)?)?))
            });
            let Some((measure, unit)) = measure else { continue };
            let named = |name: &str| own.iter().any(|(_, part)| part.contains(name));
            for (k, (kind, name)) in MEASURES.into_iter().enumerate() {
                // Areas of shells by themselves and wetted areas have other names.
                if measure.starts_with(kind) && named(name) && self.records.is(unit, "DERIVED_UNIT") {
                    let length = below(self.records, unit, &["LENGTH_UNIT"]);
                    let scale = millimetres(self.records, *length.first()?, 0)?;
                    found[k] = Some(number(measure)? * scale.powi(3 - k as i32));
                }
            }
        }
        Some(())
    }
}

/// A unit of length in millimetres.
fn millimetres(records: &Records<'_>, unit: u64, depth: usize) -> Option<f64> {
    if let Some(of) = records.part(unit, "SI_UNIT") {
        let prefix = match of[of.len() - 2] {
            ".KILO." => 1e6,
            "$" => 1e3,
            ".DECI." => 1e2,
            ".CENTI." => 1e1,
            ".MILLI." => 1.0,
            ".MICRO." => 1e-3,
            ".NANO." => 1e-6,
            _ => return None,
        };
        return (of[of.len() - 1] == ".METRE.").then_some(prefix);
    }
    let of = records.part(unit, "CONVERSION_BASED_UNIT")?;
    let factor = reference(of.get(1)?)?;
    let parts = records.get(factor)?.iter().map(|(_, part)| fields(part));
    let measure = parts.into_iter().find(|fields| fields.len() == 2)?;
    (depth < DEEPEST).then_some(())?;
    Some(number(measure[0])? * millimetres(records, reference(measure[1])?, depth + 1)?)
}

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

/// Corners of patches by cells, and the patches for points that are none.
struct Corners<'b> {
    near: f64,
    cells: HashMap<[i64; 3], Vec<DVec3>>,
    patches: Vec<(DVec3, DVec3, &'b Bezier)>,
}

impl<'b> Corners<'b> {
    fn new(patches: &[&'b Bezier], near: f64) -> Self {
        let mut cells: HashMap<[i64; 3], Vec<DVec3>> = HashMap::new();
        let mut boxed = Vec::new();
        for patch in patches {
            let [p, q] = patch.degree;
            for corner in [(0, 0), (p, 0), (0, q), (p, q)].map(|(i, j)| patch.points[patch.index(i, j)]) {
                cells.entry(cell(corner, near)).or_default().push(corner);
            }
            let low = patch.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
            let high = patch.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
            boxed.push((low - near, high + near, *patch));
        }
        Self { near, cells, patches: boxed }
    }

    fn has(&self, point: DVec3) -> bool {
        let [x, y, z] = cell(point, self.near);
        let about = (0..27).map(|k: i64| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let mut corners = about.filter_map(|cell| self.cells.get(&cell)).flatten();
        corners.any(|corner| corner.distance(point) <= self.near) || self.is_on_a_patch(point)
    }

    /// Where a closed edge starts, or at a pole.
    fn is_on_a_patch(&self, point: DVec3) -> bool {
        const GRID: usize = 5;
        let near = self.patches.iter().filter(|(low, high, _)| point.cmpge(*low).all() && point.cmple(*high).all());
        near.into_iter().any(|(_, _, patch)| {
            let guess = |k: usize| [k % GRID, k / GRID].map(|k| k as f64 / (GRID - 1) as f64);
            let far = |at: [f64; 2]| patch.at(at[0], at[1])[0].distance_squared(point);
            let mut starts: Vec<[f64; 2]> = (0..GRID * GRID).map(guess).collect();
            starts.sort_by(|a, b| far(*a).total_cmp(&far(*b)));
            starts.into_iter().take(3).any(|start| patch.project(point, start).1 <= self.near)
        })
    }
}

fn cell(point: DVec3, size: f64) -> [i64; 3] {
    (point / size).floor().to_array().map(|along| along as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Imported, Options, heal, import, read as first, sew, turn};
    use std::path::PathBuf;

    fn path(name: &str) -> PathBuf {
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/parts/{name}.step"))
    }

    fn part(name: &str) -> (Reread, Part) {
        (read(&path(name)).unwrap(), first::read(&path(name), None, 0.01, crate::part::Sweep::Start).unwrap())
    }

    /// The errors for patches that are moved and scaled.
    fn said(reread: &Reread, part: &Part, of: &[Imported], by: impl Fn(usize, DVec3) -> DVec3) -> Result<(), String> {
        let moved = |(index, imported): (usize, &Imported)| {
            let mut patches: Vec<Bezier> = imported.patches.iter().map(|patch| patch.surface.clone()).collect();
            patches.iter_mut().flat_map(|patch| &mut patch.points).for_each(|point| *point = by(index, *point));
            patches
        };
        let patches: Vec<Bezier> = of.iter().enumerate().flat_map(moved).collect();
        let patches: Vec<&Bezier> = patches.iter().collect();
        reread.compare_patches(part, &patches, Some(0.02), [0.0; 2]).map_err(|error| error.to_string())
    }

    #[test]
    fn a_wrong_unit_is_found_without_another_program() {
        for name in ["s02", "s02_inch", "s06"] {
            let (reread, part) = part(name);
            let right = [import(&path(name), &Options::default()).unwrap()];
            said(&reread, &part, &right, |_, at| at).unwrap();
            for scale in [25.4, 10.0, 1e-3, 1.005] {
                let message = said(&reread, &part, &right, |_, at| at * scale).expect_err(name);
                assert!(message.contains("by the file's units and placements"), "{name}, {scale}: {message}");
            }
        }
    }

    #[test]
    fn a_lost_placement_is_found_without_another_program() {
        let (reread, part) = part("s11");
        let solid = |name: &str| Options { solid: Some(name.to_owned()), ..Options::default() };
        let both = ["base", "pin"].map(|name| import(&path("s11"), &solid(name)).unwrap());
        said(&reread, &part, &both, |_, at| at).unwrap();
        // Moved by little, turned by a degree about an axis through it, and each solid where the other is.
        let by_little = |at: DVec3| at + DVec3::X * 0.1;
        let turned = |at: DVec3| DMat3::from_rotation_z(1_f64.to_radians()) * at;
        for index in 0..2 {
            said(&reread, &part, &both, |k, at| if k == index { by_little(at) } else { at }).unwrap_err();
            said(&reread, &part, &both, |k, at| if k == index { turned(at) } else { at }).unwrap_err();
            said(&reread, &part, &both[index..=index], |_, at| at).unwrap_err();
        }
    }

    #[test]
    fn a_hole_a_face_or_an_edge_that_is_dropped_is_found() {
        let (reread, whole) = part("s02");
        reread.compare_outlines(&whole, true).unwrap();
        let said = |fault: &dyn Fn(&mut Part)| {
            let mut part = whole.clone();
            fault(&mut part);
            reread.compare_outlines(&part, true).unwrap_err().to_string()
        };
        let drilled = whole.faces.iter().position(|face| face.loops.len() == 2).unwrap();
        let message = said(&|part| drop(part.faces[drilled].loops.pop()));
        assert!(message.starts_with(&whole.faces[drilled].label()), "{message}");
        assert!(said(&|part| drop(part.faces.pop())).contains("6 of its 7 faces"));
        assert!(said(&|part| part.faces[0].loops[0].truncate(3)).starts_with(&whole.faces[0].label()));
        said(&|part| part.faces[0].loops[0].iter_mut().for_each(|used| used.reversed = !used.reversed));
    }

    /// The other half of a torus that is cut through its axis: closed, and folded nowhere. Rays would turn it back with
    /// its whole shell.
    #[test]
    fn the_complement_of_a_torus_runs_against_the_file() {
        let (reread, mut part) = part("torus_cut");
        sew::sew(&mut part, 0.01).unwrap();
        let seams = heal::take_out_seams(&mut part);
        turn::turn(&mut part, &seams, 0.01).unwrap();
        reread.compare_senses(&part).unwrap();
        let face = part.faces.iter_mut().find(|face| face.kind == "torus").unwrap();
        let label = face.label();
        face.flip = !face.flip;
        for uses in &mut face.loops {
            uses.reverse();
            uses.iter_mut().for_each(|used| used.reversed = !used.reversed);
        }
        assert!(reread.compare_senses(&part).unwrap_err().to_string().starts_with(&label));
    }

    /// An inch in feet, as a file may have it.
    #[test]
    fn units_are_followed() {
        let text = "#1=(CONVERSION_BASED_UNIT('IN;CH',#2)LENGTH_UNIT()NAMED_UNIT(#9));\n/* #1=X(); */\
                    #2=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(0.0833333333333333),#3);\n\
                    #3=(CONVERSION_BASED_UNIT('FOOT',#4) LENGTH_UNIT() NAMED_UNIT(#9));\n\
                    #4=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(3.048),#5);\n\
                    #5=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.DECI.,.METRE.));\n";
        let found = millimetres(&Records::new(&without_remarks(text)), 1, 0).unwrap();
        assert!((found - 25.4).abs() < 1e-9, "{found}");
    }
}
