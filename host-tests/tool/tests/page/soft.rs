//! A body that gives way: what is drawn, pressed and held, beside the modes file's own polynomials and closed forms.

use crate::browser::Page;
use crate::tool::{palpate, repository};
use anyhow::{Context as _, ensure};
use serde::Deserialize;
use std::f64::consts::TAU;
use std::fs;

const MODES: &str = "host-tests/soft/capped_box.modes.toml";
/// A surface is drawn again once a mode has moved by 1e-5 of the size, which moves it by at most 1.4 times as much, and
/// coordinates of 1 are rounded by 6e-8, in sizes.
const DRAWN: f64 = 1.5e-5;

type Vector = [f64; 3];

#[derive(Deserialize)]
struct File {
    budget: f64,
    mode: Vec<Mode>,
}

#[derive(Deserialize)]
struct Mode {
    frequency: f64,
    mass: f64,
    damping: f64,
    centre: Vector,
    half: f64,
    poly: [Vector; 10],
}

impl Mode {
    /// Displacement at a point in the model's frame, metres for each metre of `q`.
    fn at(&self, point: Vector) -> Vector {
        let [x, y, z] = [0, 1, 2].map(|axis| (point[axis] - self.centre[axis]) / self.half);
        let monomials = [1.0, x, y, z, x * x, x * y, x * z, y * y, y * z, z * z];
        [0, 1, 2].map(|axis| monomials.iter().zip(&self.poly).map(|(monomial, term)| monomial * term[axis]).sum())
    }
}

struct Foam {
    page: Page,
    file: File,
    size: f64,
    centre: Vector,
    middle: Vector,
    /// Corners of the triangles at rest, in sizes.
    rest: Vec<f64>,
}

/// Corners of all triangles that are drawn.
const CORNERS: &str = "palpate.page.room.faces.flatMap(({ geometry }) => [...geometry.attributes.position.array])";

impl Foam {
    fn open() -> anyhow::Result<Self> {
        let page = Page::held_still()?;
        page.ask("palpate.take('foam_box')")?;
        let about = page.ask("palpate.about()")?;
        let vector = |name: &str| -> anyhow::Result<Vector> { Ok(serde_json::from_value(about[name].clone())?) };
        let (centre, middle) = (vector("centre")?, vector("middle")?);
        let size = about["size"].as_f64().context("no size")?;
        let rest = serde_json::from_value(page.ask(CORNERS)?)?;
        Ok(Self { page, file: toml::from_str(&fs::read_to_string(repository(MODES))?)?, size, centre, middle, rest })
    }

    fn q(&self) -> anyhow::Result<Vec<f64>> {
        Ok(serde_json::from_value(self.page.ask("palpate.page.body.device.modes().map(({ q }) => q)")?)?)
    }

    /// Puts the stylus somewhere for some ticks.
    fn hold(&self, place: Vector, ticks: u32) -> anyhow::Result<serde_json::Value> {
        self.page.ask(&format!("palpate.hold({place:?}, {ticks})"))
    }

    /// The displacement of a point at rest in the frame of the tables, metres.
    fn displacement(&self, q: &[f64], rest: Vector) -> Vector {
        let point = [0, 1, 2].map(|axis| rest[axis] + self.centre[axis]);
        self.file.mode.iter().zip(q).fold([0.0; 3], |sum, (mode, q)| {
            let by = mode.at(point);
            [0, 1, 2].map(|axis| sum[axis] + q * by[axis])
        })
    }

    /// Whether every corner is drawn where the file's polynomials take it; the farthest that one has moved, metres.
    fn check_drawn(&self) -> anyhow::Result<f64> {
        let (q, drawn): (_, Vec<f64>) = (self.q()?, serde_json::from_value(self.page.ask(CORNERS)?)?);
        ensure!(drawn.len() == self.rest.len() && drawn.len() > 1_000, "{} numbers", drawn.len());
        let mut farthest = 0.0_f64;
        for (drawn, rest) in drawn.as_chunks::<3>().0.iter().zip(self.rest.as_chunks::<3>().0) {
            let moved = self.displacement(&q, rest.map(|coordinate| coordinate * self.size));
            for axis in 0..3 {
                let error = (drawn[axis] - rest[axis] - moved[axis] / self.size).abs();
                ensure!(error < DRAWN, "{drawn:?} is drawn for {rest:?}, which moves by {moved:?} m at {q:?}");
            }
            farthest = farthest.max(moved.iter().map(|x| x * x).sum::<f64>().sqrt());
        }
        Ok(farthest)
    }
}

#[test]
fn a_press_moves_the_drawn_surface_as_statics_says_and_the_host_finds_the_same_gap() -> anyhow::Result<()> {
    let foam = Foam::open()?;
    // From the side, where it gives way most that is far from all edges: the box is held at its bottom.
    let beside = [foam.middle[0] + foam.size, foam.middle[1], foam.middle[2]];
    let side: Vector = serde_json::from_value(foam.page.ask(&format!("palpate.closest({beside:?}).point"))?)?;
    foam.hold([side[0] + 1e-3, side[1], side[2]], 400)?;
    // A second, in which the slowest mode has lost all but e^-26 of its swing.
    let pressed = [side[0] - 2e-3, side[1], side[2]];
    foam.hold(pressed, 200)?;
    let view = foam.hold(pressed, 4_000)?;
    let vector = |name: &str| -> anyhow::Result<Vector> { Ok(serde_json::from_value(view[name].clone())?) };
    let (q, force, normal, point, probe) =
        (foam.q()?, vector("force")?, vector("normal")?, vector("point")?, vector("probe")?);
    ensure!(view["contact"] == 2, "{view}");
    let farthest = foam.check_drawn()?;
    ensure!(farthest > 3e-4, "the surface has moved by {farthest} m at most");
    // The material point under the stylus, by rounds each of which shrinks its error to a tenth.
    let mut rest = point;
    for _ in 0..12 {
        let moved = foam.displacement(&q, rest);
        rest = [0, 1, 2].map(|axis| point[axis] - moved[axis]);
    }
    let push: f64 = (0..3).map(|axis| force[axis] * normal[axis]).sum();
    for (mode, q) in foam.file.mode.iter().zip(&q) {
        let by = mode.at([0, 1, 2].map(|axis| rest[axis] + foam.centre[axis]));
        let along: f64 = (0..3).map(|axis| by[axis] * normal[axis]).sum();
        let stiffness = (TAU * mode.frequency).powi(2) * mode.mass;
        let expected = -push * along / stiffness;
        // Duties have 15 bits of 20 N: 0.6 mN, of 1 N and more.
        let error = (q - expected).abs();
        ensure!(error < 2e-3 * expected.abs() + 2e-7, "{q} m of {} Hz, by statics {expected}", mode.frequency);
    }
    // The host's cold search on the same deformed body.
    let units = foam.page.number("palpate.about().units")?;
    let [x, y, z] = [0, 1, 2].map(|axis| (probe[axis] + foam.centre[axis]) * units);
    let folder = tempfile::tempdir()?;
    let [asked, answered] = ["in.csv", "out.csv"].map(|name| folder.path().join(name).to_string_lossy().into_owned());
    let columns: String = (0..q.len()).map(|mode| format!(",q{mode}")).collect();
    let values: String = q.iter().map(|q| format!(",{q:.9e}")).collect();
    fs::write(&asked, format!("qx,qy,qz{columns}\n{x:.17e},{y:.17e},{z:.17e}{values}\n"))?;
    let modes = repository(MODES).display().to_string();
    let command = ["closest", "--model", "capped_box", "--modes", &modes, "--queries", &asked, "--out", &answered];
    palpate(&[&command[..], &["--mode", "cold"]].concat())?;
    let table = fs::read_to_string(&answered)?;
    let mut lines = table.lines().map(|line| line.split(','));
    let (mut head, mut row) = (lines.next().context("no head")?, lines.next().context("no row")?);
    let gap: f64 = row.nth(head.position(|name| name == "gap").context("no gap")?).context("no cell")?.parse()?;
    let shown = view["shown"].as_f64().context("the page shows no gap")?;
    // As of rigid bodies: the rounding of coordinates.
    ensure!((gap / units - shown).abs() < 1e-6 * foam.size, "a gap of {shown} m, the host says {}", gap / units);
    println!("{push:.3} N move the surface by up to {:.3} mm, gap {:.4} mm", 1e3 * farthest, 1e3 * shown);
    ensure!(foam.page.errors().is_empty(), "on the console: {:?}", foam.page.errors());
    Ok(())
}

#[test]
fn a_slider_holds_its_mode_within_the_budget_and_let_go_it_rings() -> anyhow::Result<()> {
    let foam = Foam::open()?;
    let away = [foam.middle[0], foam.middle[1], foam.middle[2] + foam.size];
    let budget = foam.file.budget;
    let slide = "((slider) => { slider.value = 50; slider.dispatchEvent(new Event('input')); return slider.value; })";
    foam.page.ask(&format!("{slide}(document.querySelectorAll('#modes input')[1])"))?;
    foam.hold(away, 100)?;
    let q = foam.q()?;
    ensure!((q[1] - 0.5 * budget).abs() < 1e-7 * budget && q[0] == 0.0, "{q:?}, of {budget}");
    let text = foam.page.ask("document.querySelectorAll('#modes output')[1].textContent")?;
    ensure!(text == format!("{:.2} mm", 500.0 * budget), "{text}");
    let farthest = foam.check_drawn()?;
    ensure!(farthest > 0.3 * budget, "the surface has moved by {farthest} m at most");
    // Beyond the budget a mode stays at it.
    foam.page.ask("palpate.page.body.device.holdMode(1, 1.0)")?;
    foam.hold(away, 2)?;
    ensure!((foam.q()?[1] / budget - 1.0).abs() < 1e-7, "{:?}, of {budget}", foam.q()?);
    foam.page.ask("document.getElementById('let-go').click()")?;
    let Mode { frequency, damping, .. } = foam.file.mode[1];
    let (rate, ticks_a_second) = (TAU * frequency, foam.page.number("Number(document.getElementById('rate').value)")?);
    let (decay, ringing) = (damping * rate, rate * (1.0 - damping * damping).sqrt());
    let mut ticks = 0;
    for more in [44, 44, 88] {
        foam.hold(away, more)?;
        ticks += more;
        // The last tick in which it was held moves it too, after the tracker; this view is the tracker's.
        let time = f64::from(ticks) / ticks_a_second;
        let expected =
            budget * (-decay * time).exp() * ((ringing * time).cos() + decay / ringing * (ringing * time).sin());
        let q = foam.q()?[1];
        // The step's constants are rounded to 24 bits each tick.
        ensure!((q - expected).abs() < 1e-4 * budget, "after {ticks} ticks: {q}, in closed form {expected}");
        let shown = foam.page.number("Number(document.querySelectorAll('#modes input')[1].value)")?;
        ensure!((shown - 100.0 * q / budget).abs() <= 0.5, "the slider stands at {shown}, and the mode at {q}");
    }
    foam.check_drawn()?;
    ensure!(foam.page.errors().is_empty(), "on the console: {:?}", foam.page.errors());
    Ok(())
}
