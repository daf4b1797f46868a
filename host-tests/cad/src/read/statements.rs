//! A glance at the text of a file: its statements with their numbers, for messages, and for what the reader does not
//! mind.

use step_io::EntityKey;

/// A statement `#id = TYPE(…);`, in the order of the file.
pub(super) struct Statement<'t> {
    /// Its number.
    pub id: u64,
    /// Its type; of a complex entity all its parts, joined by `+`.
    pub kind: String,
    /// What stands behind the type, with both parentheses.
    pub arguments: &'t str,
}

/// The number and the type of the statement that a text begins, and how much of the text stands from its type on.
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

/// All of them, as far as a glance tells: a semicolon in a name hides the statement that it is in.
pub(super) fn statements(text: &str) -> Vec<Statement<'_>> {
    let all = text.split(';').filter_map(|part| {
        let (id, kind, rest) = statement(part)?;
        let rest = &part[part.len() - rest..];
        let arguments = rest.strip_prefix(kind.as_str()).unwrap_or(rest).trim();
        Some(Statement { id, kind, arguments })
    });
    all.collect()
}

/// Numbers of the entities that messages name.
pub(super) struct Numbers {
    faces: Vec<u64>,
    edges: Vec<u64>,
    breps: Vec<u64>,
    hollow_breps: Vec<u64>,
    occurrences: Vec<u64>,
}

impl Numbers {
    pub(super) fn new(statements: &[Statement<'_>]) -> Self {
        let of = |kind: &str| statements.iter().filter(|of| of.kind == kind).map(|of| of.id).collect();
        Self {
            faces: of("ADVANCED_FACE"),
            edges: of("EDGE_CURVE"),
            breps: of("MANIFOLD_SOLID_BREP"),
            hollow_breps: of("BREP_WITH_VOIDS"),
            occurrences: of("NEXT_ASSEMBLY_USAGE_OCCURRENCE"),
        }
    }

    /// The number and the type of an entity. The reader keeps entities of a type in the order of the file, and a file
    /// of which it dropped any of these types is refused.
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
