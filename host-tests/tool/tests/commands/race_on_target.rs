//! The contestants of the race on the target, against a sphere in closed form.

use palpate::math::Vec3;
use palpate_rivals::{Answer, Grid, Mesh, Newton};
use palpate_tool::firmware::Progress;
use palpate_tool::race::on_target::{AHEAD, Course};
use std::error::Error;
use std::path::Path;

/// Ticks of the path, and flash of a grid or mesh, bytes.
const TICKS: usize = 1_000;
const FLASH: usize = 64 * 1024;
/// Rounding of single precision, in sizes of the body: some ten units in the last place.
const ROUNDING: f64 = 1e-6;

/// The largest errors of distance, in metres, and of the normal, as the length of the difference.
fn errors(probes: &[Vec3], radius: f64, mut tick: impl FnMut(Vec3) -> Answer) -> [f64; 2] {
    probes.iter().fold([0.0, 0.0], |[gap, normal], probe| {
        let (at, answer) = (probe.as_dvec3(), tick(*probe));
        [
            gap.max((f64::from(answer.gap_m) - (at.length() - radius)).abs()),
            normal.max((answer.normal.as_dvec3() - at.normalize()).length()),
        ]
    })
}

#[test]
fn rivals_are_as_near_to_a_sphere_as_their_tables() -> Result<(), Box<dyn Error>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../boards/bodies/sphere_body.palp");
    let course = Course::new(file.to_str().ok_or("the path is text")?, &Progress::new())?;
    let radius = 0.5 * course.size();
    let probes: Vec<Vec3> = course.path(TICKS).iter().map(|row| row.probe).collect();
    let most = probes.iter().map(|probe| (probe.as_dvec3().length() - radius - AHEAD).abs()).fold(0.0, f64::max);
    assert!(most < ROUNDING * radius, "the path is {most} m off its distance");

    let samples = course.samples(FLASH);
    let linear = samples.linear();
    let spacing = 1.0 / f64::from(f32::from_bits(linear[6]));
    // h²/8 times the second derivatives along three axes, whose sum is 2/r.
    let bound = spacing * spacing / (4.0 * (radius - spacing));
    let grid = Grid::of(&linear).ok_or("no grid")?;
    let [gap, normal] = errors(&probes, radius, |probe| grid.trilinear(probe));
    println!("trilinear: {gap:.1e} of {bound:.1e} m, normal {normal:.1e}");
    assert!(gap < bound && gap > 0.1 * bound && normal < spacing / radius);

    // 5h⁴/384 times the fourth derivatives along three axes, at most 3/r³; each interpolation enlarges the error of those
    // before it by at most 1.6.
    let bound =
        (1.0 + 1.6 + 1.6 * 1.6) * 15.0 / 384.0 * spacing.powi(4) / (radius - spacing).powi(3) + ROUNDING * radius;
    let cubic = samples.cubic();
    let grid = Grid::of(&cubic).ok_or("no grid")?;
    let [gap, normal] = errors(&probes, radius, |probe| grid.tricubic(probe));
    println!("tricubic: {gap:.1e} of {bound:.1e} m, normal {normal:.1e}");
    // A gradient loses one power.
    assert!(gap < bound && normal < 10.0 * bound / spacing);

    // A point of a triangle with longest side l is at most l²/6r below the sphere.
    let mesh = course.triangles(FLASH, true);
    assert_eq!(mesh.open_sides(), 0);
    let longest = mesh.longest_side();
    let bound = longest * longest / (6.0 * radius) + ROUNDING * radius;
    let words = mesh.words();
    let mesh = Mesh::of(&words).ok_or("no mesh")?;
    let (mut facets, mut shaded) = (mesh.start(probes[0]), mesh.start(probes[0]));
    let [gap, normal] = errors(&probes, radius, |probe| facets.facets(probe));
    println!("facets: {gap:.1e} of {bound:.1e} m, normal {normal:.1e}");
    assert!(gap < bound && gap > 0.05 * bound && normal < longest / radius);
    // Normals at the corners blend to the very normal of the sphere, at a foot that is off by the facet's tilt.
    let bound = [bound, longest / radius * (AHEAD / radius) + ROUNDING];
    let [gap, normal] = errors(&probes, radius, |probe| shaded.shaded(probe));
    println!("shaded: {gap:.1e} m, normal {normal:.1e} of {:.1e}", bound[1]);
    assert!(gap < bound[0] && normal < bound[1]);

    let body = course.tables()?;
    let mut newton = Newton::start(&body, probes[0]);
    let [gap, normal] = errors(&probes, radius, |probe| newton.tick(probe));
    println!("Newton: {gap:.1e} m, normal {normal:.1e}");
    // The difference of point and probe over the gap: rounding over 0.4 mm.
    assert!(gap < ROUNDING * radius && normal < ROUNDING * radius / AHEAD);
    Ok(())
}
