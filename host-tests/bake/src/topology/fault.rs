//! What can be wrong between patches, as the person who made the model reads it.

use thiserror::Error;

/// Why patches do not make a body. `first` and `second` say a border and its patch, `side u = 0 of patch "dome"`.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SeamFault {
    /// More than two faces share an edge.
    #[error("{first}, {second} and {third} are one curve: an edge has two faces at most")]
    ThreeFaces {
        /// One border.
        first: String,
        /// Another.
        second: String,
        /// One too many.
        third: String,
    },
    /// Two patches are the same surface.
    #[error("patch {first} and patch {second} are the same surface twice: leave one out")]
    Duplicate {
        /// One.
        first: String,
        /// The other.
        second: String,
    },
    /// Neighbours do not agree which side is outside.
    #[error(
        "{first} and {second} are one edge, but the outward normals disagree across it: turn `flip` of patch {suspect}"
    )]
    Orientation {
        /// One border.
        first: String,
        /// The other.
        second: String,
        /// The patch that disagrees with most of those it meets.
        suspect: String,
    },
    /// Two borders have a part in common and go apart elsewhere.
    #[error(
        "{first} from {from:.3} to {to:.3} lies on {second}, but they are not one edge: edges that meet only in part \
         must be cut where they part"
    )]
    Partial {
        /// One border.
        first: String,
        /// The other.
        second: String,
        /// Where the common part begins on the first, of its parameter.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// The same curve at another pace.
    #[error(
        "{first} and {second} are the same curve with different parametrisations ({deviation:.3e} m apart at the same \
         parameter): give both the same degree, knots and control points"
    )]
    Parametrisation {
        /// One border.
        first: String,
        /// The other.
        second: String,
        /// How far apart they are at equal parameters, metres.
        deviation: f64,
    },
    /// Two borders nearly meet.
    #[error("{first} and {second} nearly meet: they are up to {deviation:.3e} m apart, {tolerance:.1e} m is one edge")]
    Gap {
        /// One border.
        first: String,
        /// The other.
        second: String,
        /// How far apart, metres.
        deviation: f64,
        /// What would count as one curve, metres.
        tolerance: f64,
    },
    /// A closed body whose normals point inward.
    #[error("the body is closed and inside out (its volume is {volume:.3e} m³): turn `flip` of every patch")]
    InsideOut {
        /// By the divergence theorem, m³.
        volume: f64,
    },
    /// A closed body without an inside.
    #[error("the body is closed but encloses no volume")]
    NoVolume,
    /// More patches than a body's tables can name.
    #[error("{count} patches after splitting: a body has {limit} at most")]
    TooMany {
        /// How many.
        count: usize,
        /// How many can be.
        limit: usize,
    },
}
