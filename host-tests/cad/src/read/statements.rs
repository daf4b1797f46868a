//! A glance at the text of a file: its statements with their numbers, for messages, and for what the reader does not
//! mind.

use crate::error::ImportError;
use crate::remarks::{pieces, references};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use step_io::{DropKind, EntityKey, Error, Report};

/// A statement `#id = TYPE(…);`, in the order of the file.
pub(super) struct Statement<'t> {
    /// Its number.
    pub id: u64,
    /// Its type; of a complex entity all its parts, joined by `+`.
    pub kind: String,
    /// The arguments behind the type, with both parentheses.
    pub arguments: &'t str,
}

/// Number and type of the statement at the start of a text, and the length of the text from its type on.
pub(super) fn statement(text: &str) -> Option<(u64, String, usize)> {
    let (id, rest) = text.trim_start().strip_prefix('#')?.split_once('=')?;
    let rest = rest.trim_start();
    let kind = if let Some(parts) = rest.strip_prefix('(') {
        let words = parts.split(|c: char| !(c.is_ascii_uppercase() || c == '_' || c.is_ascii_digit()));
        let is_type = |word: &&str| word.len() > 3 && word.starts_with(|c: char| c.is_ascii_uppercase());
        words.filter(is_type).collect::<Vec<_>>().join("+")
    } else {
        rest.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect()
    };
    Some((id.trim().parse().ok()?, kind, rest.len()))
}

/// All of them, of a text without remarks.
pub(super) fn statements(text: &str) -> Vec<Statement<'_>> {
    let all = pieces(text).filter_map(|part| {
        let (id, kind, rest) = statement(part)?;
        let rest = &part[part.len() - rest..];
        let arguments = rest.strip_prefix(kind.as_str()).unwrap_or(rest).trim();
        Some(Statement { id, kind, arguments })
    });
    all.collect()
}

/// The text with the reference directions that the reader needs and a file may leave out: of placements along x, where
/// the default is y.
pub(super) fn with_directions(text: &str) -> Cow<'_, str> {
    let all = statements(text);
    let mut written = Vec::new();
    for of in all.iter().filter(|of| of.kind == "AXIS2_PLACEMENT_3D") {
        let Some(rest) = of.arguments.strip_suffix(')').map(str::trim_end).and_then(|rest| rest.strip_suffix('$'))
        else {
            continue;
        };
        let axis =
            rest.trim_end().trim_end_matches(',').rsplit(',').next().and_then(|axis| axis.trim().strip_prefix('#'));
        if let Some(axis) = axis.and_then(|axis| axis.parse::<u64>().ok()) {
            written.push((rest.as_ptr() as usize - text.as_ptr() as usize + rest.len(), axis));
        }
    }
    if written.is_empty() {
        return Cow::Borrowed(text);
    }
    let directions: HashMap<u64, &str> =
        all.iter().filter(|of| of.kind == "DIRECTION").map(|of| (of.id, of.arguments)).collect();
    let is_along_x = |axis: &u64| {
        let numbers = directions.get(axis).and_then(|of| of.rsplit('(').next()).unwrap_or("");
        let [x, y, z] = [0, 1, 2].map(|k| {
            let number = numbers.trim_end_matches(')').split(',').nth(k).map_or("", str::trim);
            number.parse::<f64>().unwrap_or(0.0)
        });
        y.hypot(z) <= 1e-9 * x.abs()
    };
    let own = all.iter().map(|of| of.id).max().unwrap_or(0) + 1;
    let mut whole = String::with_capacity(text.len() + 64);
    let mut done = 0;
    for (place, _) in written.into_iter().filter(|(_, axis)| is_along_x(axis)) {
        whole += &text[done..place];
        whole += &format!("#{own}");
        done = place + 1;
    }
    if done == 0 {
        return Cow::Borrowed(text);
    }
    let end = text.rfind("ENDSEC").filter(|end| *end >= done).unwrap_or(text.len());
    whole += &text[done..end];
    whole += &format!("#{own} = DIRECTION('',(0.,1.,0.));\n{}", &text[end..]);
    Cow::Owned(whole)
}

/// The surfaces of which the reader knows the offsets itself.
const SIMPLE: [&str; 6] = [
    "PLANE",
    "CYLINDRICAL_SURFACE",
    "CONICAL_SURFACE",
    "SPHERICAL_SURFACE",
    "TOROIDAL_SURFACE",
    // Of an offset there is none.
    "OFFSET_SURFACE",
];

/// The text with the surface itself in place of each offset of free form, and the distances by the faces' numbers.
pub(super) fn without_offsets(text: &str) -> (Cow<'_, str>, HashMap<u64, f64>) {
    let all = statements(text);
    if !all.iter().any(|of| of.kind == "OFFSET_SURFACE") {
        return (Cow::Borrowed(text), HashMap::new());
    }
    let number = |field: Option<&str>| field.and_then(|field| field.trim().strip_prefix('#')?.parse::<u64>().ok());
    let by_number: HashMap<u64, &Statement<'_>> = all.iter().map(|of| (of.id, of)).collect();
    let mut distances: HashMap<u64, f64> = HashMap::new();
    let (mut whole, mut done) = (String::with_capacity(text.len()), 0);
    for of in all.iter().filter(|of| of.kind == "OFFSET_SURFACE") {
        let mut fields = of.arguments.rsplit(',').skip(1);
        let distance = fields.next().and_then(|field| field.trim().parse::<f64>().ok());
        let basis = number(fields.next()).and_then(|basis| by_number.get(&basis));
        let (Some(distance), Some(basis)) = (distance, basis) else { continue };
        if SIMPLE.contains(&basis.kind.as_str()) {
            continue;
        }
        distances.insert(of.id, distance);
        let end = of.arguments.as_ptr() as usize - text.as_ptr() as usize;
        whole += text[done..end].trim_end().trim_end_matches("OFFSET_SURFACE");
        // Of a complex entity the arguments are all of it.
        whole += if basis.kind.contains('+') { "" } else { &basis.kind };
        whole += basis.arguments;
        done = end + of.arguments.len();
    }
    whole += &text[done..];
    let faces = all.iter().filter(|of| matches!(of.kind.as_str(), "ADVANCED_FACE" | "FACE_SURFACE"));
    let of_face = |of: &Statement<'_>| Some((of.id, *distances.get(&number(of.arguments.rsplit(',').nth(1))?)?));
    let distances = faces.filter_map(of_face).collect();
    (Cow::Owned(whole), distances)
}

/// Numbers of the entities that messages name.
pub(super) struct Numbers {
    faces: Vec<u64>,
    edges: Vec<u64>,
    breps: Vec<u64>,
    hollow_breps: Vec<u64>,
    occurrences: Vec<u64>,
    /// How far a face lies off the surface that the file has for it, in its unit.
    pub(super) offsets: HashMap<u64, f64>,
}

impl Numbers {
    pub(super) fn new(statements: &[Statement<'_>], offsets: HashMap<u64, f64>) -> Self {
        let of = |kind: &str| {
            let mut all: Vec<u64> = statements.iter().filter(|of| of.kind == kind).map(|of| of.id).collect();
            all.sort_unstable();
            all
        };
        Self {
            faces: of("ADVANCED_FACE"),
            edges: of("EDGE_CURVE"),
            breps: of("MANIFOLD_SOLID_BREP"),
            hollow_breps: of("BREP_WITH_VOIDS"),
            occurrences: of("NEXT_ASSEMBLY_USAGE_OCCURRENCE"),
            offsets,
        }
    }

    /// The number and the type of an entity. The reader keeps entities of a type in the order of their numbers, and a
    /// file of which it dropped any of these types is refused.
    pub(super) fn of(&self, key: EntityKey) -> Option<(u64, &'static str)> {
        let (numbers, index, kind) = match key {
            EntityKey::AdvancedFace(id) => (&self.faces, id.0, "ADVANCED_FACE"),
            EntityKey::EdgeCurve(id) => (&self.edges, id.0, "EDGE_CURVE"),
            EntityKey::ManifoldSolidBrep(id) => (&self.breps, id.0, "MANIFOLD_SOLID_BREP"),
            EntityKey::BrepWithVoids(id) => (&self.hollow_breps, id.0, "BREP_WITH_VOIDS"),
            EntityKey::NextAssemblyUsageOccurrence(id) => (&self.occurrences, id.0, "NEXT_ASSEMBLY_USAGE_OCCURRENCE"),
            _ => return None,
        };
        numbers.get(index as usize).map(|number| (*number, kind))
    }
}

// Where a file stops being one: the line, and the entity that stands there.

/// Message for a text that the reader refuses: fault and place.
pub(super) fn message(text: &str, error: &Error) -> String {
    let place = match error {
        Error::UnexpectedEof { .. } => return ended(text),
        Error::Lex(error) => Some((error.span.line, error.span.column)),
        Error::UnexpectedToken { span, .. }
        | Error::MalformedFileSchema { span }
        | Error::InvalidAttributePosition { span, .. }
        | Error::NestingTooDeep { span }
        | Error::TooLarge { span } => Some((span.line, span.column)),
        _ => None,
    };
    let entity = place.and_then(|(line, column)| {
        let before = up_to(text, line as usize, column as usize);
        begun(&before[behind_statements(before)..])
    });
    entity.map_or_else(|| error.to_string(), |entity| format!("{error}, in {entity}"))
}

/// Of a text that is cut off: the line of its end, and the entity there, or the last one before.
fn ended(text: &str) -> String {
    let line = text.trim_end().lines().count().max(1);
    let whole = behind_statements(text);
    let last = || text[..whole].trim_end_matches(';').rsplit(';').find_map(begun);
    let place = begun(&text[whole..])
        .map(|entity| format!("inside {entity}"))
        .or_else(|| last().map(|entity| format!("behind {entity}")))
        .unwrap_or_else(|| "before its first entity".to_owned());
    format!("it ends on line {line}, {place}")
}

/// The text before a place, both numbers from 1.
fn up_to(text: &str, line: usize, column: usize) -> &str {
    let start: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let length = text[start..].char_indices().nth(column.saturating_sub(1)).map(|(at, _)| at);
    &text[..length.map_or(text.len(), |length| start + length)]
}

/// Where the last whole statement ends. A semicolon in a name ends none.
fn behind_statements(text: &str) -> usize {
    let (mut is_name, mut end) = (false, 0);
    for (at, c) in text.char_indices() {
        is_name ^= c == '\'';
        if c == ';' && !is_name {
            end = at + 1;
        }
    }
    end
}

/// The entity at the start of a text: its number and, if present, its type.
fn begun(text: &str) -> Option<String> {
    let (id, kind, _) = statement(text)?;
    Some(if kind.is_empty() { format!("#{id}") } else { format!("#{id} ({kind})") })
}

// Entities that could not be read: those that the shape needs are refused by number.

/// Types, or parts of types' names, of which no shape can do without one.
const NEEDED: [&str; 22] = [
    "FACE",
    "LOOP",
    "EDGE",
    "VERTEX",
    "CARTESIAN_POINT",
    "DIRECTION",
    "VECTOR",
    "AXIS",
    "LINE",
    "CIRCLE",
    "ELLIPSE",
    "CONIC",
    "CURVE",
    "SURFACE",
    "PLANE",
    "SHELL",
    "BREP",
    "SHAPE_REPRESENTATION",
    "NEXT_ASSEMBLY_USAGE",
    "ITEM_DEFINED_TRANSFORMATION",
    "MAPPED_ITEM",
    "LENGTH_UNIT",
];
/// Types whose names contain such a word only describe looks, dimensions or a flat picture of the shape.
const LOOKS: [&str; 10] =
    ["STYLE", "COLOUR", "PCURVE", "DIMENSION", "TOLERANCE", "ANNOTATION", "CALLOUT", "DRAUGHTING", "ASPECT", "CAMERA"];

/// Refuses a file of which the reader dropped what the shape needs.
pub fn check(statements: &[Statement<'_>], report: &Report, file: &str) -> Result<(), ImportError> {
    if report.dropped.is_empty() {
        return Ok(());
    }
    let types: HashMap<u64, &str> = statements.iter().map(|of| (of.id, of.kind.as_str())).collect();
    let name = |id: u64| types.get(&id).map_or_else(|| "of no type".to_owned(), |name| (*name).to_owned());
    let is_needed = |name: &str| {
        NEEDED.iter().any(|needed| name.contains(needed)) && !LOOKS.iter().any(|looks| name.contains(looks))
    };
    let of_the_shape = || report.dropped.iter().filter(|(id, _)| is_needed(&name(*id)));
    // The first that is bad by itself says more than those that only refer to it.
    let first = of_the_shape().find(|(_, reason)| reason.kind != DropKind::Cascade).or_else(|| of_the_shape().next());
    let Some((id, reason)) = first else { return Ok(()) };
    let detail: &str = reason.detail.as_ref();
    // Not all that refer to it by others, up to the whole shape.
    let absent = || {
        let mut of_the_shape = statements.iter().filter(|of| is_needed(&of.kind));
        of_the_shape.find_map(|of| {
            let absent = references(of.arguments).into_iter().find(|id| !types.contains_key(id))?;
            Some((of.id, format!("it refers to #{absent}, which the file does not have")))
        })
    };
    let (id, reason) = match detail.strip_prefix("via-") {
        Some("dangling") => absent().unwrap_or_else(|| (*id, "it goes round in a circle".to_owned())),
        Some(kind) => (*id, format!("it refers to a {kind}, which is not read: leave that out")),
        None if reason.kind == DropKind::Unimplemented => (*id, unread(detail)),
        None => (*id, reason.to_string()),
    };
    let reason = format!("{reason}; export the part again");
    Err(ImportError::Entity { file: file.to_owned(), id, kind: name(id), reason })
}

/// Why an entity of a type that is not read is refused, and the types in whose place it stands.
fn unread(kind: &str) -> String {
    let is_surface = kind.ends_with("SURFACE") || kind.contains("SURFACE_OF");
    let instead = if is_surface && !kind.contains("CURVE_ON") {
        "with this face as a plane, cylinder, cone, sphere, torus, extrusion, revolution or B-spline (NURBS) surface"
    } else if kind.contains("CURVE") && !is_surface {
        "with this edge as a line, circle, ellipse or B-spline (NURBS) curve"
    } else {
        "as a solid of AP203, AP214 or AP242, without construction history"
    };
    format!("this type is not read; the CAD program must write it {instead}")
}

// What the reader takes and no part can have: radii that are not positive, lists of nothing, products made of
// themselves.

/// An entity that makes no sense, and why.
pub(super) struct Nonsense {
    pub id: u64,
    pub kind: String,
    pub reason: String,
}

/// The first that makes none.
pub(super) fn find(statements: &[Statement<'_>]) -> Option<Nonsense> {
    let nonsense = |of: &Statement<'_>, reason: String| Nonsense { id: of.id, kind: of.kind.clone(), reason };
    let by_itself = statements.iter().find_map(|of| reason(of).map(|reason| nonsense(of, reason)));
    by_itself.or_else(|| {
        let of = circle(statements)?;
        Some(nonsense(of, "a product is made of itself: the assembly goes round in a circle".to_owned()))
    })
}

fn reason(of: &Statement<'_>) -> Option<String> {
    let (count, least) = match of.kind.as_str() {
        "CLOSED_SHELL" | "OPEN_SHELL" | "EDGE_LOOP" => {
            let is_empty = of.arguments.split(',').next_back()?.split_whitespace().collect::<String>().ends_with("())");
            return is_empty.then(|| "its list is empty".to_owned());
        }
        "CIRCLE" | "CYLINDRICAL_SURFACE" | "SPHERICAL_SURFACE" => (1, f64::MIN_POSITIVE),
        "ELLIPSE" | "TOROIDAL_SURFACE" => (2, f64::MIN_POSITIVE),
        _ => return None,
    };
    let numbers = of.arguments.trim_end_matches(')').rsplit(',').take(count);
    let radius = numbers.filter_map(|number| number.trim().parse::<f64>().ok()).find(|radius| *radius < least)?;
    Some(format!("its radius is {radius}"))
}

/// An occurrence of a product in what it is made of.
fn circle<'s, 't>(statements: &'s [Statement<'t>]) -> Option<&'s Statement<'t>> {
    let mut parts: HashMap<&str, Vec<(&str, &Statement<'t>)>> = HashMap::new();
    for of in statements.iter().filter(|of| of.kind == "NEXT_ASSEMBLY_USAGE_OCCURRENCE") {
        // What uses and what is used are the first two references.
        let mut references = of.arguments.split([',', '(', ')']).map(str::trim).filter(|word| word.starts_with('#'));
        if let (Some(whole), Some(part)) = (references.next(), references.next()) {
            parts.entry(whole).or_default().push((part, of));
        }
    }
    let mut done = HashSet::new();
    for start in parts.keys() {
        // Depth first, with a path of its own: an assembly may be deeper than the stack.
        let mut path = vec![(*start, 0)];
        while let Some((whole, next)) = path.pop() {
            let Some((part, of)) = parts.get(whole).and_then(|parts| parts.get(next)) else {
                done.insert(whole);
                continue;
            };
            path.push((whole, next + 1));
            if path.iter().any(|(above, _)| above == part) {
                return Some(*of);
            }
            if !done.contains(part) {
                path.push((*part, 0));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::ended;

    #[test]
    fn an_end_is_named_by_line_and_entity() {
        let head = "ISO-10303-21;\nHEADER;\n";
        assert_eq!(ended(head), "it ends on line 2, before its first entity");
        let data = format!("{head}DATA;\n#7 = LINE('a;b',#8,#9);\n");
        assert_eq!(ended(&data), "it ends on line 4, behind #7 (LINE)");
        assert_eq!(ended(&format!("{data}#8 = CARTESIAN")), "it ends on line 5, inside #8 (CARTESIAN)");
        assert_eq!(ended(&format!("{data}#8")), "it ends on line 5, behind #7 (LINE)");
        assert_eq!(ended(&format!("{data}#8=")), "it ends on line 5, inside #8");
        assert_eq!(ended(""), "it ends on line 1, before its first entity");
    }
}
