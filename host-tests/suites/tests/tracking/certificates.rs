//! Certificates of patches whose geometry is known.

use palpate_bake::certificate::{Certificate, Finding};
use palpate_bake::survey::{Survey, Verdict};
use palpate_bake::{BakedPatch, Model};
use std::error::Error;

/// Metres.
const RANGE: f64 = 0.03;

fn surveys(model: &Model) -> Result<Vec<Survey>, Box<dyn Error>> {
    let survey = |patch| {
        let baked = BakedPatch::new(patch)?;
        let survey = Survey::new(patch, &baked, RANGE);
        assert_eq!(Certificate::all_hold(&[(patch, &baked)], RANGE), survey.certificate.is_certified());
        Ok(survey)
    };
    model.patches.iter().map(survey).collect()
}

fn one(points: &str, degree: &str) -> Result<(Model, Survey), Box<dyn Error>> {
    let text = format!("unit = \"mm\"\n[[patch]]\ndegree = {degree}\npoints = [{points}]\n");
    let model = Model::parse(&text, "m.toml")?;
    let survey = surveys(&model)?.remove(0);
    Ok((model, survey))
}

#[test]
fn every_face_of_the_capped_box_is_certified() -> Result<(), Box<dyn Error>> {
    for survey in surveys(&palpate_suites::model("capped_box"))? {
        assert_eq!(survey.verdict, Verdict::Certified, "{:?}", survey.reasons);
        assert!(survey.reasons.is_empty(), "{:?}", survey.reasons);
        assert_eq!(survey.certificate.proved_range, RANGE);
    }
    Ok(())
}

/// A trough: probes beyond its radius of curvature have two resting places.
#[test]
fn a_hollow_is_refused_with_its_reason_and_no_cut_is_offered() -> Result<(), Box<dyn Error>> {
    let row = |x: f64| format!("[[{x}, 0, 10], [{x}, 10, -10], [{x}, 20, 10]]");
    let (model, survey) = one(&format!("{}, {}", row(0.0), row(20.0)), "[1, 2]")?;
    let certificate = &survey.certificate;
    assert!(matches!(&certificate.convex, Finding::Failed(reason) if reason.contains("bends inward")));
    assert!(matches!(&certificate.equilibrium, Finding::Failed(reason) if reason.contains("second resting place")));
    // Curvature at the bottom: z'' / |y'|² = 80 / 20² per mm, a radius of 5 mm.
    assert!(certificate.proved_range < 5e-3, "{}", certificate.proved_range);
    assert_eq!(certificate.cut(&model.patches[0], &BakedPatch::new(&model.patches[0])?), None);
    assert_eq!(survey.verdict, Verdict::Usable);
    Ok(())
}

/// A half cylinder's normals span 180°: cut across, each half is a patch with 90°, each quarter with 45°.
#[test]
fn an_arch_that_turns_too_far_is_to_be_cut_across_the_turn() -> Result<(), Box<dyn Error>> {
    let row = |x: f64| format!("[[{x}, -20, 0], [{x}, -14, 20], [{x}, 14, 20], [{x}, 20, 0]]");
    let (model, survey) = one(&format!("{}, {}", row(0.0), row(20.0)), "[1, 3]")?;
    let certificate: &Certificate = &survey.certificate;
    // The end tangents are (6, 20): 73.3° from the middle one.
    assert!((certificate.cone_angle - 73.3).abs() < 3.0, "{}", certificate.cone_angle);
    assert!(matches!(&certificate.normal_cone, Finding::Failed(_)));
    let cut = certificate.cut(&model.patches[0], &BakedPatch::new(&model.patches[0])?);
    assert_eq!(cut.map(|cut| (cut.axis, cut.at)), Some((1, 0.5)));
    Ok(())
}

#[test]
fn a_flat_patch_is_certified_and_a_pole_is_not() -> Result<(), Box<dyn Error>> {
    let (_, flat) = one("[[0, 0, 0], [0, 9, 0]], [[9, 0, 0], [9, 9, 0]]", "[1, 1]")?;
    assert_eq!(flat.verdict, Verdict::Certified, "{:?}", flat.reasons);
    let (_, pole) = one("[[0, 0, 0], [0, 0, 0]], [[9, 0, 0], [9, 9, 0]]", "[1, 1]")?;
    assert!(matches!(&pole.certificate.regular, Finding::Failed(_)));
    assert_eq!(pole.verdict, Verdict::Usable);
    Ok(())
}
