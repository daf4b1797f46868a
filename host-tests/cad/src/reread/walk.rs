//! The way through products, representations and placements, by a file's text.

use super::records::{Records, fields, number, numbers, reference};
use super::{below, point};
use crate::remarks::references;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::{HashMap, HashSet};

/// Assemblies in assemblies: beyond, nothing is compared.
const DEEPEST: usize = 64;
/// Entities that hold faces.
pub const SHAPES: [&str; 3] = ["MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "SHELL_BASED_SURFACE_MODEL"];
/// The measures that are compared, by type and by the name that CAD systems have agreed on.
const MEASURES: [(&str, &str); 2] =
    [("VOLUME_MEASURE", "'volume measure'"), ("AREA_MEASURE", "'surface area measure'")];

/// The way through products, representations and placements.
pub struct Walk<'r, 't> {
    records: &'r Records<'t>,
    /// Millimetres of the unit of each context.
    pub units: HashMap<u64, f64>,
    /// Representations that are one shape.
    same: HashMap<u64, Vec<u64>>,
    /// The representations of each product's definition.
    shapes: HashMap<u64, Vec<u64>>,
    /// The parts of a definition: theirs, and the relationship that places them.
    uses: HashMap<u64, Vec<(u64, Option<u64>)>>,
    /// Solids, each with its placement and unit.
    pub placed: Vec<(u64, DAffine3, f64)>,
}

impl<'r, 't> Walk<'r, 't> {
    /// By all records of a file.
    pub fn new(records: &'r Records<'t>) -> Option<Self> {
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
    pub fn roots(&self) -> Vec<u64> {
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

    /// Places the solids of a definition and of its parts.
    pub fn product(&mut self, product: u64, placement: DAffine3, depth: usize) -> Option<()> {
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
    pub fn stated(&self, root: u64) -> [Option<f64>; 2] {
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
pub fn millimetres(records: &Records<'_>, unit: u64, depth: usize) -> Option<f64> {
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
