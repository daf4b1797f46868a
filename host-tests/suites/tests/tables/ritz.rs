//! Modes of elastic bodies by Ritz's method, against closed forms.

use palpate_bake::ritz::{Material, Modes};
use palpate_bake::{BakedBody, Model};
use std::f64::consts::TAU;
use std::path::Path;

/// Poisson's ratio as in Lamb's tables.
const RUBBER: Material =
    Material { youngs_modulus_pa: 2e5, poissons_ratio: 0.25, density_kg_per_m3: 1_000.0, damping_ratio: 0.05 };

/// A box in millimetres, as a model file.
fn block([x, y, z]: [f64; 3]) -> String {
    let mut text = "name = \"block\"\nunit = \"mm\"\n".to_owned();
    let sides = [x, y, z];
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        for end in 0..2 {
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |i: usize, j: usize| {
                let mut at = [0.0; 3];
                (at[axis], at[a], at[b]) = (sides[axis] * end as f64, sides[a] * i as f64, sides[b] * j as f64);
                format!("{at:?}")
            };
            text += &format!(
                "[[patch]]\nname = \"{name}{end}\"\ndegree = [1, 1]\nflip = {}\npoints = [[{}, {}], [{}, {}]]\n",
                end == 0,
                corner(0, 0),
                corner(0, 1),
                corner(1, 0),
                corner(1, 1)
            );
        }
    }
    text
}

fn modes(model: &Model, count: usize, held: &[&str]) -> Modes {
    let body = BakedBody::new(model, "model").unwrap();
    let held: Vec<_> = held.iter().map(|&name| name.to_owned()).collect();
    Modes::new(model, &body, &RUBBER, count, &held).unwrap()
}

/// Lamb's sphere: its lowest mode is the torsional one of degree 2, x = 2.5011 of ω a/c_t, five
/// times; the next is the spheroidal one of degree 2, x = 0.840 π, five times.
#[test]
fn a_sphere_has_the_frequencies_of_lamb() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/sphere_body.toml");
    let model = Model::read(&path).unwrap();
    let body = BakedBody::new(&model, "sphere").unwrap();
    let radius = 0.5 * body.topology.size;
    let found = modes(&model, 8, &[]);
    let shear = RUBBER.youngs_modulus_pa / (2.0 * (1.0 + RUBBER.poissons_ratio));
    let unit = (shear / RUBBER.density_kg_per_m3).sqrt() / radius / TAU;
    let mass = RUBBER.density_kg_per_m3 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    assert!((found.mass_kg / mass - 1.0).abs() < 1e-6, "{} {mass}", found.mass_kg);
    let ratios: Vec<_> = found.held.iter().map(|mode| mode.frequency_hz / unit).collect();
    println!("{ratios:.4?}, left out {:?}", found.left_out);
    // Degree 6 is 0.1 % above; torsion of degree 2 is a quadratic field.
    assert!(ratios[..5].iter().all(|ratio| (ratio / 2.5011 - 1.0).abs() < 1e-3), "{ratios:?}");
    assert!(ratios[5..].iter().all(|ratio| (ratio / (0.840 * std::f64::consts::PI) - 1.0).abs() < 2e-3), "{ratios:?}");
}

#[test]
fn bars_have_the_frequencies_of_beam_theory() {
    let (length, side) = (0.1, 0.01);
    let model = Model::parse(&block([100.0, 10.0, 10.0]), "bar").unwrap();
    let Material { youngs_modulus_pa: young, density_kg_per_m3: density, poissons_ratio: nu, .. } = RUBBER;
    let mass = density * length * side * side;
    // Held at an end: Euler and Bernoulli's cantilever. Shear and rotation, (side/length)², lower it by some 1 %.
    let free = modes(&model, 1, &["x0"]);
    let bending = (young * side * side / (12.0 * density)).sqrt() / (length * length);
    let expected = 1.875_104_f64.powi(2) * bending / TAU;
    println!("cantilever {} Hz, {expected}; mass {} of {mass}", free.held[0].frequency_hz, free.held[0].mass_kg);
    assert!((free.held[0].frequency_hz / expected - 1.0).abs() < 0.02);
    // A quarter of its mass at the tip.
    assert!((free.held[0].mass_kg / mass / 0.25 - 1.0).abs() < 0.02);
    assert!(free.held[0].share > 0.95);
    // Its tip bends by F/k: 3 E I/L³ has all modes, the first one 97 % of it.
    let stiffness = free.held[0].mass_kg * (TAU * free.held[0].frequency_hz).powi(2);
    let expected = 3.0 * young * side.powi(4) / 12.0 / length.powi(3);
    assert!((stiffness / expected * 0.971 - 1.0).abs() < 0.02, "{stiffness} {expected}");
    // Free: bending twice, and twist by Saint-Venant's 0.1406 a⁴ of a square.
    let found = modes(&model, 8, &[]);
    let expected = 4.730_041_f64.powi(2) * bending / TAU;
    for mode in &found.held[..2] {
        // Shear and rotation again, three times as much.
        assert!((mode.frequency_hz / expected - 1.0).abs() < 0.05, "{} {expected}", mode.frequency_hz);
        assert!(mode.share > 0.9, "{}", mode.share);
    }
    let shear = young / (2.0 * (1.0 + nu));
    let twist = 0.5 / length * (shear / density * 0.1406 / (1.0 / 6.0)).sqrt();
    let near = |expected: f64| {
        found.held.iter().map(|mode| (mode.frequency_hz / expected - 1.0).abs()).fold(f64::INFINITY, f64::min)
    };
    assert!(near(twist) < 0.01, "{twist}: {:?}", found.held);
    // Stretching: √(E/ρ)/2L, lowered by ν² of the sides.
    assert!(near(0.5 / length * (young / density).sqrt()) < 0.01, "{:?}", found.held);
}
