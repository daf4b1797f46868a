//! The generated models: the files are what the generator makes, and the shapes are exact.

use glam::DVec3;
use palpate_bake::Model;
use palpate_truth::generate::models;
use palpate_truth::oracle::OraclePoint;
use std::error::Error;
use std::fs;
use std::path::PathBuf;

fn folder() -> PathBuf {
    palpate_suites::repository("host-tests/models")
}

#[test]
fn the_files_are_what_the_generator_makes() -> Result<(), Box<dyn Error>> {
    for model in models::all() {
        let file = folder().join(model.file);
        if std::env::var_os("PALPATE_WRITE").is_some() {
            fs::write(&file, &model.text)?;
        }
        let again = "PALPATE_WRITE=1 cargo test -p palpate-suites --test tables models";
        assert!(fs::read_to_string(&file)? == model.text, "{} has drifted: {again}", model.file);
    }
    Ok(())
}

/// `f(point)` is 0 on the surface and has slope 1 about a size away, so that its value is the error in sizes.
fn worst(file: &str, off: impl Fn(DVec3) -> f64) -> Result<f64, Box<dyn Error>> {
    let model = Model::read(&folder().join(file))?;
    let grid = || (0..=40).map(|k| f64::from(k) / 40.0);
    let mut worst: f64 = 0.0;
    for patch in &model.patches {
        for (u, v) in grid().flat_map(|u| grid().map(move |v| (u, v))) {
            worst = worst.max(off(OraclePoint::evaluate(patch, u, v).point * 1e3).abs());
        }
    }
    println!("{file}: off by {worst:.1e}");
    Ok(worst)
}

#[test]
fn the_ellipsoids_are_exact() -> Result<(), Box<dyn Error>> {
    let [a, b, c] = models::HALF_AXES;
    let radius = |axes: [f64; 3]| move |point: DVec3| (point / DVec3::from_array(axes)).length() - 1.0;
    // Decimals of 17 digits and sums of 25 products in f64.
    assert!(worst("sphere_body.toml", radius([models::RADIUS; 3]))? < 1e-12);
    assert!(worst("ellipsoid_body.toml", radius([a, b, c]))? < 1e-12);
    assert!(worst("ellipsoid_poles.toml", radius([a, b, c]))? < 1e-12);
    Ok(())
}

#[test]
fn the_rounded_cylinder_is_exact() -> Result<(), Box<dyn Error>> {
    // The distance from a cylinder of radius 22 and half height 17, less the rounding of 8.
    let off = |point: DVec3| {
        let (out, up) = (point.x.hypot(point.y) - 22.0, point.z.abs() - 17.0);
        let distance = out.max(0.0).hypot(up.max(0.0));
        (distance - 8.0) / 60.0
    };
    assert!(worst("rounded_cylinder.toml", off)? < 1e-12);
    Ok(())
}

#[test]
fn neighbours_of_the_spheres_share_their_borders_to_the_last_bit() -> Result<(), Box<dyn Error>> {
    use palpate_bake::topology::{Border, Sense, Topology};
    for file in ["sphere_body.toml", "ellipsoid_body.toml", "ellipsoid_poles.toml"] {
        let model = Model::read(&folder().join(file))?;
        let topology = Topology::new(&model.patches, &|index| index.to_string())?;
        for edge in &topology.edges {
            let (other, sense) = edge.partner.ok_or("open")?;
            let controls = |border: Border| border.controls(&model.patches[border.patch]).ok_or("not clamped");
            let (first, mut second) = (controls(edge.owner)?, controls(other)?);
            if sense == Sense::Reversed {
                second.reverse();
            }
            assert_eq!(first, second, "{file}: {edge:?}");
        }
    }
    Ok(())
}
