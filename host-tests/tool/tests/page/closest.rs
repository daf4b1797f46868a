//! The stylus along a script, over bodies of every kind, beside the host's `closest`.

use crate::browser::Page;
use crate::tool::palpate;
use anyhow::{Context as _, ensure};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;

/// The bodies: sharp edges, smooth ones, poles, hollows with open borders, and a patch alone.
const BODIES: [&str; 6] = ["capped_box", "rounded_cylinder", "ellipsoid_poles", "sphere_body", "teapot", "table1c"];

/// The tracker rests where no step is proved to bring it nearer, some 1e-6 of the size along the surface, which is
/// 1e-12 across it; what is left is the rounding of the gap from coordinates of up to the size, a few 6e-8 of it.
const GAP: f64 = 1e-6;

/// Places on a spiral around a body, in its sizes from its middle.
fn places() -> Vec<[f64; 3]> {
    let spiral = |step: u32| {
        let share = (f64::from(step) + 0.5) / 48.0;
        let (height, turn) = (1.0 - 2.0 * share, 2.399_963 * f64::from(step));
        let (wide, far) = ((1.0 - height * height).sqrt(), 0.72 + 0.25 * (3.0 * share).sin());
        [far * wide * turn.cos(), far * wide * turn.sin(), far * height]
    };
    (0..48).map(spiral).collect()
}

fn numbers(value: &Value) -> anyhow::Result<Vec<f64>> {
    let list = value.as_array().with_context(|| format!("{value} is no list"))?;
    list.iter().map(|number| number.as_f64().with_context(|| format!("{number} is no number"))).collect()
}

#[test]
fn the_page_has_the_closest_points_of_the_host_and_its_gaps() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    for body in BODIES {
        check(&page, body).with_context(|| body.to_owned())?;
    }
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

/// What the frames do between a script's steps: whether they are drawn, and how many times slower the processor is.
const FRAMES: [(bool, f64); 3] = [(false, 1.0), (true, 1.0), (true, 20.0)];

#[test]
fn a_script_comes_to_the_same_state_whatever_the_frames_do() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    // Small: a processor draws each frame.
    page.set_size([320, 200], 0.25)?;
    let mut seen = Vec::new();
    for (draws, times) in FRAMES {
        page.ask(&format!("palpate.draw({draws})"))?;
        page.ask("palpate.take('teapot')")?;
        page.slow_down(times)?;
        let about = page.ask("palpate.about()")?;
        let (size, middle) = (about["size"].as_f64().context("size")?, numbers(&about["middle"])?);
        for place in &places()[..4] {
            let at = [0, 1, 2].map(|axis| middle[axis] + size * place[axis]);
            page.ask(&format!("palpate.hold({at:?}, 300)"))?;
            page.ask("palpate.drawn(2)")?;
        }
        page.slow_down(1.0)?;
        let state = page.ask("palpate.state()")?;
        let rate = state["rate"].as_f64().context("rate")?;
        println!("draws: {draws}, slower {times} times: {rate:.0} frames a second, state {}", state["digest"]);
        seen.push(state["digest"].clone());
    }
    ensure!(seen.iter().all(|digest| *digest == seen[0]), "states {seen:?}");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

fn check(page: &Page, body: &str) -> anyhow::Result<()> {
    page.ask(&format!("palpate.take({body:?})"))?;
    let about = page.ask("palpate.about()")?;
    let (size, units) = (about["size"].as_f64().context("size")?, about["units"].as_f64().context("units")?);
    let (centre, middle) = (numbers(&about["centre"])?, numbers(&about["middle"])?);
    let around: Vec<[f64; 3]> =
        places().iter().map(|place| [0, 1, 2].map(|axis| middle[axis] + size * place[axis])).collect();
    // So many ticks that the audit has been all around. In one go: between two the browser draws.
    let walked = page.ask(&format!(
        "{around:?}.map((at) => {{ const view = palpate.hold(at, 1500); \
         return [view, palpate.closest(view.probe)]; }})"
    ))?;
    let seen: Vec<(Value, Value)> = serde_json::from_value(walked)?;
    let mut queries = String::from("qx,qy,qz\n");
    for (view, _) in &seen {
        let probe = numbers(&view["probe"])?;
        let [x, y, z] = [0, 1, 2].map(|axis| (probe[axis] + centre[axis]) * units);
        writeln!(queries, "{x:.17e},{y:.17e},{z:.17e}")?;
    }
    let folder = tempfile::tempdir()?;
    let [asked, answered] = ["in.csv", "out.csv"].map(|name| folder.path().join(name).to_string_lossy().into_owned());
    fs::write(&asked, queries)?;
    palpate(&["closest", "--model", body, "--queries", &asked, "--mode", "cold", "--out", &answered])?;
    let table = fs::read_to_string(&answered)?;
    let mut worst = 0.0_f64;
    let (mut rows, mut compared) = (0, 0);
    let is_body = about["faces"] != 1;
    for (line, (view, cold)) in table.lines().skip(1).zip(&seen) {
        let row: Vec<&str> = line.split(',').collect();
        let gap: f64 = row[6].parse::<f64>()? / units;
        let shown = view["shown"].as_f64().context("the page shows no gap")?;
        // A patch alone is tracked to a local minimum, and its gap is taken along the normal: both are the body's,
        // where the probe is in front and not beyond the rim.
        let [u, v] = [row[1].parse::<f64>()?, row[2].parse::<f64>()?];
        let is_over = [u, v].iter().all(|parameter| (1e-3..=1.0 - 1e-3).contains(parameter));
        if is_body || (is_over && shown > 0.0) {
            let error = (gap.abs() - shown.abs()).abs() / size;
            ensure!(error < GAP, "the page shows a gap of {shown} m, the host says {gap}: {line}");
            worst = worst.max(error);
            compared += 1;
        }
        let words = view["text"].as_str().context("no words")?.replace('−', "-").parse::<f64>()?;
        ensure!((words - shown * 1e3).abs() <= 5.1e-4, "{words} mm is written, and it is {shown} m");
        // The cold search is the same in every bit: nine digits tell one f32 from the next.
        for (name, text) in [("u", row[1]), ("v", row[2])] {
            let (ours, theirs) = (cold[name].as_f64().context("no parameter")? as f32, text.parse::<f32>()?);
            ensure!(ours.to_bits() == theirs.to_bits(), "{name}: {ours} in the page, {theirs} on the host: {line}");
        }
        rows += 1;
    }
    ensure!(rows == places().len(), "{rows} of {} rows", places().len());
    ensure!(compared >= if is_body { rows } else { 8 }, "{compared} gaps were compared");
    println!(
        "{body}: {rows} places, the same closest points in every bit; {compared} gaps differ by {worst:.1e} sizes at most"
    );
    Ok(())
}
