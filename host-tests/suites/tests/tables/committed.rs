//! Tables: exact shapes, the Rust source, and the committed table against its model.

use glam::DVec3;
use palpate::body::TickLimit;
use palpate::patch::{Curvature, Patch as _, SplinePatch};
use palpate_bake::certificate::Certificate;
use palpate_bake::source::{self, Origin};
use palpate_bake::survey::Survey;
use palpate_bake::{BakedPatch, Model};
use std::error::Error;

/// Metres: how far probes may be over a patch.
const RANGE: f64 = 0.03;

/// The committed table, as firmware takes it.
mod table1c {
    include!("../../../../boards/bodies/table1c.rs");
}

#[test]
fn the_compiled_table_has_the_bits_of_the_baked_patch() -> Result<(), Box<dyn Error>> {
    let model = palpate_suites::model("table1c");
    let patch = BakedPatch::new(&model.patches[0])?.to_patch()?;
    let compiled: &SplinePatch = &table1c::PATCHES[0];
    assert_eq!(table1c::PATCHES.len(), model.patches.len());
    assert_eq!(compiled.shape(), patch.shape());
    assert_eq!(compiled.size().to_bits(), patch.size().to_bits());
    assert_eq!((compiled.orientation(), compiled.degree()), (patch.orientation(), patch.degree()));
    for i in 0..=64_u16 {
        for j in 0..=64_u16 {
            let (u, v) = (f32::from(i) / 64.0, f32::from(j) / 64.0);
            assert_eq!(compiled.evaluate(u, v), patch.evaluate(u, v));
        }
    }
    Ok(())
}

#[test]
fn numbers_of_the_source_read_back_as_the_same_bits() -> Result<(), Box<dyn Error>> {
    let text = model("mm", "[1, 1]", "[[0, 0, 0], [0, 1.234567e-3, -0.3]], [[33.3, 0, 0.02], [77.7, 66.6, 0.01]]");
    let baked = BakedPatch::all(&Model::parse(&text, "m.toml")?, "m.toml")?;
    let origin = Origin {
        model_file: "m.toml\n#!",
        out_file: "m.rs",
        model: text.as_bytes(),
        centre: DVec3::ZERO,
        limit: TickLimit::BENCH,
    };
    let source = source::rust_source(&origin, &baked)?;
    assert!(!source.contains("\n#!"), "a file name cannot leave its comment");
    let file = syn::parse_file(&source)?;
    assert_eq!(
        file.items.len(),
        9,
        "two sets of borders, the coefficients, PATCHES, Surface, SURFACE, with_effort, TABLE_CRC, CENTRE"
    );
    let start = source.find("COEFFICIENTS: [[f32; 3]; 4] = ").ok_or("no coefficients")?;
    let body = source[start..].split_once("= ").and_then(|(_, rest)| rest.split_once(';')).ok_or("no end")?.0;
    let numbers: Vec<f32> = body
        .split(['[', ']', ',', ' ', '\n'])
        .filter(|word| !word.is_empty())
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    let palpate_bake::BakedCoefficients::Polynomial(entries) = &baked[0].coefficients else {
        return Err("not polynomial".into());
    };
    let bits = |numbers: &mut dyn Iterator<Item = f32>| numbers.map(f32::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(&mut numbers.into_iter()), bits(&mut entries.iter().flatten().copied()));
    assert_eq!(source, source::rust_source(&origin, &baked)?);
    Ok(())
}

#[test]
fn a_quarter_cylinder_and_an_octant_of_a_sphere_have_their_radius_everywhere() -> Result<(), Box<dyn Error>> {
    const W: f64 = std::f64::consts::FRAC_1_SQRT_2;
    let cylinder = format!(
        "[[50, 0, 0, 1], [50, 0, 80, 1]], [[50, 50, 0, {W}], [50, 50, 80, {W}]], [[0, 50, 0, 1], [0, 50, 80, 1]]"
    );
    let middle = W * W;
    let sphere = format!(
        "[[50, 0, 0, 1], [50, 0, 50, {W}], [0, 0, 50, 1]],
         [[50, 50, 0, {W}], [50, 50, 50, {middle}], [0, 0, 50, {W}]],
         [[0, 50, 0, 1], [0, 50, 50, {W}], [0, 0, 50, 1]]"
    );
    for (degree, points, height) in [("[2, 1]", cylinder, 0.0), ("[2, 2]", sphere, 1.0)] {
        let parsed = Model::parse(&model("mm", degree, &points), "round.toml")?;
        let patch = BakedPatch::new(&parsed.patches[0])?.to_patch()?;
        for i in 0..=100_u16 {
            for j in 0..=100_u16 {
                let point = patch.evaluate(f32::from(i) / 100.0, f32::from(j) / 100.0).point.as_dvec3();
                let radius = (point.x * point.x + point.y * point.y + height * point.z * point.z).sqrt();
                assert!((radius - 0.05).abs() < 2e-6 * 0.05, "degree {degree}: radius {radius}");
            }
        }
    }
    Ok(())
}

#[test]
fn a_pole_has_no_bound_of_the_curvature_and_says_so() -> Result<(), Box<dyn Error>> {
    let row = |x: f64, y: f64, w: f64| {
        let weight = std::f64::consts::FRAC_1_SQRT_2;
        format!("[[{x}, {y}, 0, {w}], [{x}, {y}, 50, {}], [0, 0, 50, {w}]]", w * weight)
    };
    let octant =
        [row(50.0, 0.0, 1.0), row(50.0, 50.0, std::f64::consts::FRAC_1_SQRT_2), row(0.0, 50.0, 1.0)].join(", ");
    let parsed = Model::parse(&model("mm", "[2, 2]", &octant), "octant.toml")?;
    let baked = BakedPatch::all(&parsed, "octant.toml")?;
    let shape = baked[0].to_patch()?.shape();
    assert_eq!(shape.curvature, Curvature::UNBOUNDED);
    assert!(shape.min_stretch < 1e-6 && shape.max_stretch < 0.02 && shape.max_bend.is_infinite());
    let origin = Origin {
        model_file: "octant.toml",
        out_file: "octant.rs",
        model: b"",
        centre: DVec3::ZERO,
        limit: TickLimit::BENCH,
    };
    let source = source::rust_source(&origin, &baked)?;
    assert!(source.contains("max: f32::INFINITY") && source.contains("min: f32::NEG_INFINITY"), "{source}");
    let survey = Survey::new(&parsed.patches[0], &baked[0], RANGE);
    assert_eq!(survey.convexity.to_string(), "convex: not proved (the curvature has no bound)");
    Ok(())
}

#[test]
fn the_shapes_of_the_models_are_proved_as_they_are_known() -> Result<(), Box<dyn Error>> {
    // Least and greatest curvature, 1/m, where they are constant.
    for (name, known, convexity) in [
        ("sphere", Some([20.0, 20.0]), "convex: proved"),
        ("cylinder", Some([0.0, 20.0]), "convex: up to rounding"),
        ("ellipsoid", None, "convex: proved"),
        ("table1c", None, "convex: up to rounding"),
        ("table1", None, "convex: no"),
    ] {
        let parsed = palpate_suites::model(name);
        let baked = BakedPatch::new(&parsed.patches[0])?;
        let survey = Survey::new(&parsed.patches[0], &baked, RANGE);
        let holds = Certificate::all_hold(&[(&parsed.patches[0], &baked)], RANGE);
        assert_eq!(holds, survey.certificate.is_certified(), "{name}");
        assert!(survey.convexity.to_string().starts_with(convexity), "{name}: {}", survey.convexity);
        let Curvature { min: least, max: greatest } = baked.shape.curvature;
        if let Some([low, high]) = known {
            // The slack, 2 % of the largest curvature, and the rounding of the table.
            assert!(least <= low && low - least <= 0.0201 * high, "{name}: {least}");
            assert!(greatest >= high * (1.0 - 1e-7) && greatest - high <= 0.0201 * high, "{name}: {greatest}");
        }
    }
    Ok(())
}

#[test]
fn a_rational_patch_whose_weights_are_equal_is_polynomial() -> Result<(), Box<dyn Error>> {
    let points = "[[0, 0, 0, 3], [0, 9, 0, 3]], [[9, 0, 0, 3], [9, 9, 2, 3]]";
    let with = Model::parse(&model("mm", "[1, 1]", points), "m.toml")?;
    let without = Model::parse(&model("mm", "[1, 1]", &points.replace(", 3]", "]")), "m.toml")?;
    assert!(!with.patches[0].is_rational());
    assert_eq!(BakedPatch::new(&with.patches[0])?, BakedPatch::new(&without.patches[0])?);
    Ok(())
}

#[test]
fn units_agree() -> Result<(), Box<dyn Error>> {
    let points = |scale: f64| {
        let at = |x: f64, y: f64, z: f64| format!("[{}, {}, {}]", x * scale, y * scale, z * scale);
        format!("[{}, {}], [{}, {}]", at(0., 0., 0.), at(0., 1., 0.), at(1., 0., 0.), at(1., 1., 0.5))
    };
    let in_unit = |unit: &str, scale: f64| Model::parse(&model(unit, "[1, 1]", &points(scale)), "m.toml");
    let metres = in_unit("m", 0.25)?.patches;
    assert_eq!(in_unit("cm", 25.0)?.patches, metres);
    assert_eq!(in_unit("mm", 250.0)?.patches, metres);
    Ok(())
}

fn model(unit: &str, degree: &str, points: &str) -> String {
    format!("name = \"m\"\nunit = \"{unit}\"\n[[patch]]\ndegree = {degree}\npoints = [{points}]\n")
}
