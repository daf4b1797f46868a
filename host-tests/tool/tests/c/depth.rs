//! How deep a probe may be: in a sphere the closest point is no longer the only one from the middle on.

use crate::running::{is_wanted, program, run};
use palpate_tool::repository;

/// Radius of the shipped sphere, m.
const RADIUS: f32 = 0.05;

#[test]
fn a_probe_beyond_the_middle_of_a_sphere_is_too_deep_and_none_before_it() {
    if !is_wanted("a depth in C") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut depth = program("tests/depth.c", folder.path(), &[]);
    depth.arg(repository::root().expect("in the repository").join("boards/bodies/sphere_body.palp"));
    let said = run(depth.args(["0.06", "-0.01", "2000"]));
    let mut deep = 0;
    for row in said.lines() {
        let (gap, is_deep) = row.split_once(' ').expect("two words");
        let depth = -gap.parse::<f32>().expect("a gap");
        // The table's bound of the curvature is proved, and so above 1/radius: by less than two percent.
        if !(0.98 * RADIUS..=RADIUS).contains(&depth) {
            assert_eq!(is_deep == "1", depth > RADIUS, "{row}");
        }
        deep += u32::from(depth > RADIUS);
    }
    assert!(said.lines().count() > 1_500 && deep > 0, "{deep}");
}
