//! Each planted fault is found by this reading alone.

use super::records::Records;
use super::walk::millimetres;
use super::*;
use crate::bezier::Bezier;
use crate::part::Part;
use crate::{Imported, Options, heal, import, read as first, sew, turn};
use glam::DMat3;
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
