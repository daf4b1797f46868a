//! Ten bodies that nobody tuned anything to: rounded, grooved, lobed, thin, pointed and hollow ones, polynomial and
//! rational, of degree 1 to 5, with knots and with poles. Lengths in millimetres; from the origin every surface point
//! is seen.

mod cells;
mod grooved;
mod knob;
mod net;
mod revolved;
mod wavy;

use super::models::{ellipsoid, rounded_box};
use net::{Net, text};

/// A body as a model file.
#[derive(Clone, Debug)]
pub struct DrawnBody {
    /// What it is called.
    pub name: &'static str,
    /// The model file.
    pub text: String,
}

/// All ten.
pub fn ten() -> Vec<DrawnBody> {
    vec![rounded(), slab(), pebble(), pocket(), groove(), knob(), spindle(), egg(), spool(), wave()]
}

fn drawn(name: &'static str, nets: &[Net]) -> DrawnBody {
    DrawnBody { name, text: text(name, nets) }
}

/// A box with rounded edges whose corners are octants with a pole.
pub fn rounded() -> DrawnBody {
    DrawnBody { name: "brick", text: rounded_box([64.0, 38.0, 27.0], 5.5) }
}

/// The same, thin.
pub fn slab() -> DrawnBody {
    DrawnBody { name: "slab", text: rounded_box([70.0, 44.0, 3.0], 1.2) }
}

/// An ellipsoid without poles, of degree 4.
fn pebble() -> DrawnBody {
    DrawnBody { name: "pebble", text: ellipsoid("pebble", [31.0, 24.0, 17.0]) }
}

/// A block with a pocket in the middle of its top.
fn pocket() -> DrawnBody {
    let lines: [&[f64]; 3] = [&[-27.0, -12.0, 11.0, 25.0], &[-21.0, -9.0, 10.0, 22.0], &[-15.0, 3.0, 14.0]];
    drawn("pocket", &cells::nets(lines, |cell| cell != [1, 1, 1]))
}

/// A bar with a round groove.
pub fn groove() -> DrawnBody {
    drawn("groove", &grooved::nets())
}

/// A knob with four lobes.
fn knob() -> DrawnBody {
    drawn("knob", &knob::nets())
}

/// Two cones with a piece of a third between them, sharp at both ends.
fn spindle() -> DrawnBody {
    let corners = [[0.0, -25.0], [14.0, -4.0], [9.0, 10.0], [0.0, 22.0]];
    drawn("spindle", &revolved::nets(&corners.windows(2).map(<[_]>::to_vec).collect::<Vec<_>>()))
}

/// Round all over, with a pole at either end.
fn egg() -> DrawnBody {
    drawn("egg", &revolved::nets(&[vec![[0.0, -20.0], [22.0, -20.0], [16.0, 18.0], [0.0, 18.0]]]))
}

/// Two flanges with a waist between them.
fn spool() -> DrawnBody {
    let waist = vec![[16.0, -18.0], [4.0, -8.0], [4.0, 8.0], [16.0, 18.0]];
    let (lower, upper) = (vec![[0.0, -18.0], [16.0, -18.0]], vec![[16.0, 18.0], [0.0, 18.0]]);
    drawn("spool", &revolved::nets(&[lower, waist, upper]))
}

/// A block with hills and hollows, of degree 5 and 4.
fn wave() -> DrawnBody {
    drawn("wave", &wavy::nets())
}

/// A tetrahedron from four triangles, each a square with a side that is one point. The corners turn to the right, seen
/// from the first.
pub fn tetrahedron() -> DrawnBody {
    let [a, b, c, d] = [[21.0, -3.0, -12.0], [-13.0, 19.0, -11.0], [-9.0, -20.0, -14.0], [2.0, 1.0, 24.0]];
    let triangle = |apex, from, to| Net::bilinear([[apex, apex], [from, to]]);
    drawn("tetrahedron", &[triangle(a, c, b), triangle(a, b, d), triangle(a, d, c), triangle(b, c, d)])
}
