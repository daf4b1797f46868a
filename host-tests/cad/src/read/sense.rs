//! What the reader takes and no part can have: radii that are not positive, lists of nothing, products made of
//! themselves.

use super::statements::Statement;
use std::collections::{HashMap, HashSet};

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
