//! A flaw of a body, and its words.

use crate::model::Unit;
use glam::DVec3;

/// A flaw of a body. Patches go by their indices.
#[derive(Clone, Debug, PartialEq)]
pub enum Flaw {
    /// Two patches, or a patch and itself, cut each other.
    Crossing {
        /// The patches.
        patches: [usize; 2],
        /// How many pairs of patches do.
        pairs: usize,
        /// Where, metres.
        at: DVec3,
    },
    /// A piece lies in another, both of them solid; or one that is hollow lies in none.
    Nested {
        /// A patch of the piece.
        patch: usize,
        /// How many solid pieces it lies in, less the hollows.
        inside: i32,
        /// Whether its normals point inward, as those of a hollow do.
        hollow: bool,
    },
    /// Edges with one face.
    Open {
        /// How many.
        edges: usize,
        /// One of them: patch and side.
        first: [usize; 2],
        /// The two that are nearest to one another, patch and side each, and how far they are apart, metres.
        nearest: Option<([[usize; 2]; 2], f64)>,
    },
}

impl Flaw {
    /// Whether what is proved of the patches does not hold of the body: a point inside may be taken for one outside.
    pub const fn is_wrong(&self) -> bool {
        matches!(self, Self::Crossing { .. } | Self::Nested { .. })
    }

    /// In words, in a unit; `label` names a patch, `centre` is where the patches' frame lies, metres.
    pub fn describe(&self, label: &dyn Fn(usize) -> String, centre: DVec3, unit: Unit) -> String {
        let (per_metre, unit) = (unit.per_metre(), unit.symbol());
        let side = |[patch, side]: [usize; 2]| {
            format!("side {} of patch {}", ["u = 0", "u = 1", "v = 0", "v = 1"][side], label(patch))
        };
        let length = |metres: f64| format!("{:.4} {unit}", metres * per_metre);
        match self {
            Self::Crossing { patches: [a, b], pairs, at } => {
                let [x, y, z] = ((*at + centre) * per_metre).to_array();
                let who = if a == b {
                    format!("patch {} cuts itself", label(*a))
                } else {
                    format!("patch {} and patch {} cut each other", label(*a), label(*b))
                };
                let more = if *pairs > 1 { format!(", and {} more pairs do", pairs - 1) } else { String::new() };
                format!(
                    "{who} near {x:.4}, {y:.4}, {z:.4} {unit}{more}: inside the body there is surface, and what is deep in it may count as outside"
                )
            }
            Self::Nested { patch, hollow: true, .. } => {
                format!(
                    "the closed piece with patch {} is inside out, and no hollow: it lies in no other piece",
                    label(*patch)
                )
            }
            Self::Nested { patch, inside, .. } => format!(
                "the closed piece with patch {} lies in {}: turn `flip` of all its patches if it is a hollow, or leave it out",
                label(*patch),
                if *inside == 1 { "another piece".to_owned() } else { format!("{inside} others") }
            ),
            Self::Open { edges, first, nearest } => {
                let near = nearest.map_or_else(String::new, |([a, b], gap)| {
                    format!("; {} and {} are {} apart: a seam that gapes?", side(a), side(b), length(gap))
                });
                format!("the body is open: {edges} edges have one face, the first is {}{near}", side(*first))
            }
        }
    }
}
