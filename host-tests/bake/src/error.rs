//! The errors of a model file, for the person who wrote it.

use crate::patch::Axis;
use palpate::patch::{MAX_DEGREE, MAX_SPANS};
use thiserror::Error;

/// Why a model file is refused. Names the file, and where there is one the patch and the entry.
#[derive(Debug, Error)]
pub enum ModelError {
    /// The file cannot be read.
    #[error("{file}: cannot be read: {cause}")]
    Read {
        /// The file.
        file: String,
        /// Why.
        cause: std::io::Error,
    },
    /// Not TOML, or not the keys and types of a model file.
    #[error("{file}: {message}")]
    Syntax {
        /// The file.
        file: String,
        /// The parser's message, with line and column.
        message: String,
    },
    /// A STEP file.
    #[error("{file}: a STEP file: make a model of it with `cargo palpate import {file} --out MODEL.toml`")]
    Step {
        /// The file.
        file: String,
    },
    /// The unit is none of those known.
    #[error("{file}: unit \"{unit}\" is unknown: m, cm or mm")]
    Unit {
        /// The file.
        file: String,
        /// The unit in the file.
        unit: String,
    },
    /// There is no patch.
    #[error("{file}: the model has no patch")]
    Empty {
        /// The file.
        file: String,
    },
    /// Two patches have one name.
    #[error("{file}: patches {first} and {second} are both named \"{name}\"")]
    DuplicateName {
        /// The file.
        file: String,
        /// The name.
        name: String,
        /// Index of the first.
        first: usize,
        /// Index of the second.
        second: usize,
    },
    /// Something is wrong with one patch.
    #[error("{file}: patch {patch}: {fault}")]
    Patch {
        /// The file.
        file: String,
        /// Its name, or its index if it has none.
        patch: String,
        /// The fault.
        fault: PatchFault,
    },
    /// The body lies too far away from the origin for the digits of its own file.
    #[error(
        "{file}: the body lies {distance:.1e} m from the origin, above {limit:e} times its size of {size:.1e} m: move the origin nearer"
    )]
    FarAway {
        /// The file.
        file: String,
        /// The largest coordinate, metres.
        distance: f64,
        /// The largest side of the bounding box, metres.
        size: f64,
        /// The limit, in sizes.
        limit: f64,
    },
    /// The patches do not make a body.
    #[error("{file}: {fault}")]
    Seam {
        /// The file.
        file: String,
        /// The fault between its patches.
        fault: SeamFault,
    },
}

/// A fault of a patch.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PatchFault {
    /// The name is empty.
    #[error("name is empty: leave it out and the patch goes by its index")]
    EmptyName,
    /// Not one degree for each parameter.
    #[error("degree has {count} numbers: one along u and one along v")]
    DegreeCount {
        /// How many.
        count: usize,
    },
    /// A degree is out of range.
    #[error("degree along {axis} is {degree}: 1 to {MAX_DEGREE}")]
    Degree {
        /// Along which parameter.
        axis: Axis,
        /// The degree in the file.
        degree: i64,
    },
    /// Fewer control points than degree + 1.
    #[error("{count} points along {axis}: degree {degree} needs at least {}", degree + 1)]
    TooFewPoints {
        /// Along which parameter.
        axis: Axis,
        /// How many there are.
        count: usize,
        /// The degree.
        degree: usize,
    },
    /// A Bézier patch whose number of points is not degree + 1.
    #[error("{count} points along {axis} without knots_{axis}: a Bézier patch of degree {degree} has {}", degree + 1)]
    BezierPoints {
        /// Along which parameter.
        axis: Axis,
        /// How many there are.
        count: usize,
        /// The degree.
        degree: usize,
    },
    /// A row of points is of another length than the first.
    #[error("points[{row}] has {count} points, points[0] has {expected}")]
    RaggedRow {
        /// The row.
        row: usize,
        /// How many it has.
        count: usize,
        /// How many the first has.
        expected: usize,
    },
    /// A point is not made of three or four numbers.
    #[error("points[{row}][{column}] has {count} numbers: x, y, z and, if rational, the weight")]
    PointLength {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
        /// How many numbers.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("points[{row}][{column}]: {coordinate} is {value}")]
    Coordinate {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
        /// `x`, `y` or `z`.
        coordinate: char,
        /// The value in the file.
        value: f64,
    },
    /// A weight is not a positive finite number.
    #[error("points[{row}][{column}]: the weight is {value}: it must be positive and finite")]
    Weight {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
        /// The value in the file.
        value: f64,
    },
    /// The number of knots does not match.
    #[error("knots_{axis} has {count} knots: {points} points of degree {degree} need {}", points + degree + 1)]
    KnotCount {
        /// Along which parameter.
        axis: Axis,
        /// How many there are.
        count: usize,
        /// Control points along the parameter.
        points: usize,
        /// The degree.
        degree: usize,
    },
    /// A knot is NaN or infinite.
    #[error("knots_{axis}[{index}] is {value}")]
    KnotNotFinite {
        /// Along which parameter.
        axis: Axis,
        /// Which.
        index: usize,
        /// The value in the file.
        value: f64,
    },
    /// A knot with which nothing can be computed.
    #[error("knots_{axis}[{index}] is {value:e}: {limit:e} at most, either way")]
    KnotTooLarge {
        /// Along which parameter.
        axis: Axis,
        /// Which.
        index: usize,
        /// The value in the file.
        value: f64,
        /// The limit.
        limit: f64,
    },
    /// A knot is below the one before it.
    #[error("knots_{axis}[{index}] = {value} is below knots_{axis}[{}] = {before}", index - 1)]
    KnotDecreases {
        /// Along which parameter.
        axis: Axis,
        /// Which.
        index: usize,
        /// Its value.
        value: f64,
        /// The one before it.
        before: f64,
    },
    /// An inner knot is repeated so often that the surface is torn there.
    #[error("knots_{axis}: {value} appears {times} times inside: above degree {degree} the surface is torn there")]
    Torn {
        /// Along which parameter.
        axis: Axis,
        /// The knot.
        value: f64,
        /// How often.
        times: usize,
        /// The degree.
        degree: usize,
    },
    /// An end knot is repeated more than degree + 1 times.
    #[error("knots_{axis}: {value} appears {times} times at an end: at most degree + 1 = {}", degree + 1)]
    EndMultiplicity {
        /// Along which parameter.
        axis: Axis,
        /// The knot.
        value: f64,
        /// How often.
        times: usize,
        /// The degree.
        degree: usize,
    },
    /// The range of the parameter is empty.
    #[error("knots_{axis}: the range of {axis} is empty, from {value} to {value}")]
    EmptyRange {
        /// Along which parameter.
        axis: Axis,
        /// Both ends.
        value: f64,
    },
    /// Two knots become one in the table.
    #[error("knots_{axis}: {first} and {second} are too close to be distinguished in single precision")]
    KnotsTooNear {
        /// Along which parameter.
        axis: Axis,
        /// The lower.
        first: f64,
        /// The upper.
        second: f64,
    },
    /// More spans than the target takes.
    #[error("{count} spans along {axis}: at most {MAX_SPANS}; cut the patch in two")]
    TooManySpans {
        /// Along which parameter.
        axis: Axis,
        /// How many.
        count: usize,
    },
    /// More spans in all than are proved in seconds, or have a place in a controller's flash.
    #[error("{u} × {v} spans: a patch has {limit} in all at most; cut it, or take fewer knots")]
    TooManyCells {
        /// Along `u`.
        u: usize,
        /// Along `v`.
        v: usize,
        /// How many there can be.
        limit: usize,
    },
    /// The patch is a point, a curve, or thinner than single precision can tell.
    #[error("it has no area: all its points lie on one curve or in one point")]
    NoArea,
    /// The patch is so narrow that two of its borders are one.
    #[error("it is a sliver, at most {width:.1e} m wide along {axis}: borders within {tolerance:.1e} m are one")]
    Sliver {
        /// Along which parameter.
        axis: Axis,
        /// Length of its longest control polygon along it, metres.
        width: f64,
        /// The tolerance, metres.
        tolerance: f64,
    },
    /// The patch is smaller or larger than the arithmetic is meant for.
    #[error("it is {size:e} m large: from 1e-6 m to 1e3 m; is the unit right?")]
    Size {
        /// The largest side of its bounding box, metres.
        size: f64,
    },
    /// The patch is too small beside the rest of the body.
    #[error("it is {size:.1e} m large, below {share:e} of the body's {body:.1e} m: single precision cannot hold both")]
    Tiny {
        /// The largest side of its bounding box, metres.
        size: f64,
        /// The body's, metres.
        body: f64,
        /// The minimum fraction of the body's size.
        share: f64,
    },
    /// A bound does not fit single precision.
    #[error("its second derivatives cannot be bounded in single precision: weights or knots are too uneven")]
    NoBounds,
    /// A coefficient does not fit single precision.
    #[error("span {u}, {v}: weights or knots are too uneven for single precision")]
    Uneven {
        /// Index of the span along `u`.
        u: usize,
        /// Index of the span along `v`.
        v: usize,
    },
}

// What can be wrong between patches, as the person who made the model reads it.

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
    /// Two sides of a patch that meet are one point, and its other borders touch there.
    #[error(
        "patch {patch}: its sides {first} and {second} are both one point, in which its other borders are one curve: let one \
         of the two be a point, and give the other a length"
    )]
    Cusp {
        /// The patch.
        patch: String,
        /// A side along `u`.
        first: String,
        /// A side along `v`.
        second: String,
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
        /// The start of the common part on the first, in its parameter.
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
        /// The tolerance for one curve, metres.
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
