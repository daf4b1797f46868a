//! Recorded runs of every kind: patches, bodies and scenes, on devices that ship and on one's own.

use crate::browser::Page;
use crate::tool::{palpate, repository};
use anyhow::{Context as _, ensure};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::fs;

const SCENE: &str = "host-tests/scenes/turntable.toml";

#[test]
fn runs_of_every_kind_are_felt_anew_to_the_same_hash() -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    // Devices that do not ship: a longer thigh and fewer lines, and other masses.
    let own = |from: &str, entry: &str, instead: &str| -> anyhow::Result<String> {
        let file = path(&format!("own-{from}.toml"));
        palpate(&["device", from, "--out", &file])?;
        let text = fs::read_to_string(&file)?;
        ensure!(text.matches(entry).count() > 0, "{from}: no {entry}");
        fs::write(&file, text.replace(entry, instead).replace(&format!("name = \"{from}\""), "name = \"mine\""))?;
        Ok(file)
    };
    let delta = own("falcon", "thigh = 0.06", "thigh = 0.061")?;
    let linkage = own("polhem-v2", "mass = 0.15764", "mass = 0.2")?;
    let page = Page::held_still()?;
    let mut hashes = Vec::new();
    for arguments in [
        &["--model", "table1c", "--device", "falcon", "--protected"][..],
        &["--model", "table1c", "--device", &delta, "--protected"],
        &["--model", "sphere", "--device", "polhem-v2", "--protected"],
        &["--model", "sphere", "--device", &linkage, "--protected"],
        &["--model", "capped_box", "--device", "phantom-premium"],
        &["--model", "capped_box", "--patch", "2"],
        &["--model", "teapot", "--patch", "3"],
        &["--model", SCENE],
        &["--model", SCENE, "--device", &linkage, "--protected"],
    ] {
        let recording = path("sim.json");
        let all = [&["sim", "--seconds", "2", "--recording", &recording], arguments].concat();
        let printed = palpate(&all)?;
        let line = printed.lines().find(|line| line.contains("state hash")).context("no hash")?;
        let hash = line.split_whitespace().last().unwrap_or_default().to_owned();
        replayed(&page, &recording, &hash).with_context(|| arguments.join(" "))?;
        println!("{}: {hash}, in the page too", arguments.join(" "));
        ensure!(!hashes.contains(&hash), "{hash}: another run has it");
        hashes.push(hash);
    }
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

/// How fast the turntable turns, degrees a second, and how its second part begins; of the scene's file.
const TURNS: f64 = 20.0;
const BEGINS: [f64; 2] = [0.0, 90.0];
/// Ticks between two views that the page keeps, and ticks a second.
const STRIDE: usize = 8;
const RATE: f64 = 4_000.0;

#[test]
fn a_scenes_bodies_are_seen_where_they_are_and_its_gap_is_the_hosts() -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let [recording, table] = ["run.json", "run.csv"].map(path);
    let printed = palpate(&["sim", "--model", SCENE, "--seconds", "3", "--recording", &recording, "--csv", &table])?;
    let hash = printed.lines().find(|line| line.contains("state hash")).context("no hash")?;
    let page = Page::held_still()?;
    replayed(&page, &recording, hash.split_whitespace().last().unwrap_or_default())?;
    let views: Vec<Value> = serde_json::from_value(page.ask("palpate.views()")?)?;
    let table = fs::read_to_string(table)?;
    let head: Vec<&str> = table.lines().next().context("an empty table")?.split(',').collect();
    let column = |name: &str| head.iter().position(|found| *found == name).with_context(|| name.to_owned());
    let columns = [column("gap")?, column("probe_x")?, column("probe_y")?, column("probe_z")?];
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|line| line.split(',').collect()).collect();
    ensure!(views.len() == rows.len() / STRIDE, "{} views of {} ticks", views.len(), rows.len());
    let (mut turned, mut touched, mut felt) = (0, 0, [false; 3]);
    for (index, view) in views.iter().enumerate() {
        let number = |value: &Value| value.as_f64().with_context(|| format!("{value} is no number"));
        let vector = |name: &str| -> anyhow::Result<Vec<f64>> {
            view[name].as_array().context("no vector")?.iter().map(number).collect()
        };
        // The view after a stride is that of its last tick. Nine digits tell one f32 from the next.
        let row = &rows[STRIDE * index + STRIDE - 1];
        let [gap, at @ ..] = columns.map(|column| row[column].parse::<f32>());
        let (gap, probe) = (gap?, vector("probe")?);
        ensure!(number(&view["gap"])? as f32 == gap, "view {index}: a gap of {} m, the host says {gap}", view["gap"]);
        for (ours, theirs) in probe.iter().zip(at) {
            ensure!(*ours as f32 == theirs?, "view {index}: the probe is elsewhere: {}", view["probe"]);
        }
        let part = number(&view["part"])? as usize;
        if view["contact"] == 0 {
            continue;
        }
        felt[part] = true;
        touched += usize::from(view["contact"] == 2);
        // In the scene's frame, so that the body's place is in it: a few roundings of coordinates of 0.1 m.
        let apart = vector("point")?.iter().zip(&probe).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let error = (apart - f64::from(gap.abs())).abs();
        ensure!(error < 2e-6, "view {index}: the closest point is {apart} m away, and the gap {gap} m");
        if let Some(begins) = BEGINS.get(part) {
            let place: Vec<f64> =
                view["places"][part].as_array().context("no place")?.iter().map(number).collect::<Result<_, _>>()?;
            let angle = place[1].atan2(place[0]).to_degrees();
            let seconds = (STRIDE * (index + 1)) as f64 / RATE;
            // Up to a tick, and roundings of 1e-6 rad.
            ensure!((angle - begins - TURNS * seconds).abs() < TURNS / RATE + 1e-4, "view {index}: {angle} degrees");
            turned += 1;
        }
    }
    println!("{} views of a scene: {touched} touched, {turned} on what turns, parts felt: {felt:?}", views.len());
    ensure!(touched > 50 && turned > 100 && felt.iter().filter(|felt| **felt).count() > 1, "too little was felt");
    if std::env::var_os("PALPATE_WRITE").is_some() {
        opened(&page, &fs::read(&recording)?)?;
        page.prefer("dark")?;
        page.ask("palpate.draw(true)")?;
        // Pressed into what turns.
        let pressed = |view: &&Value| view["contact"] == 2 && view["part"] == 1 && view["gap"].as_f64() < Some(-1e-3);
        let count = views.iter().filter(pressed).count();
        let at = views.iter().position(|view| Some(view) == views.iter().filter(pressed).nth(count / 2));
        page.ask(&format!("palpate.seek({})", at.unwrap_or(0) as f64 * STRIDE as f64 / RATE))?;
        page.ask("palpate.drawn(40)")?;
        fs::write(repository("docs/figures/page-scene.webp"), page.picture([900, 560], "main")?)?;
    }
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

#[test]
fn a_recording_of_another_body_device_or_run_is_refused_and_says_which() -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let made = |name: &str, model: &str, device: &str| -> anyhow::Result<Value> {
        let (path, table) = (path(name), path("run.csv"));
        let arguments =
            ["sim", "--seconds", "1", "--model", model, "--device", device, "--recording", &path, "--csv", &table];
        palpate(&arguments)?;
        Ok(serde_json::from_slice(&fs::read(path)?)?)
    };
    let other = made("other.json", "ellipsoid_body", "falcon")?;
    let run = made("run.json", "sphere_body", "polhem-v2")?;
    let page = Page::held_still()?;
    let state = opened(&page, run.to_string().as_bytes())?;
    ensure!(state["refusal"].is_null() && state["replay"]["with"] == "polhem-v2", "{state}");
    let about = state["held"]["about"].as_str().unwrap_or_default();
    ensure!(about.contains("polhem-v2"), "the reader sees another device: {about:?}");
    let chosen = |state: &Value| ["rate", "stiffness", "rendering"].map(|name| state["choices"][name].as_f64());
    let stiffness = run["settings"][1].as_f64();
    ensure!(chosen(&state) == [Some(4e3), stiffness, Some(2.0)] && stiffness != Some(1e3), "{}", state["choices"]);
    let shown = page.ask("document.getElementById('stiffness').nextElementSibling.textContent")?;
    ensure!(shown == format!("{} N/m", stiffness.unwrap_or_default()), "{shown}");
    page.ask("palpate.page.leave()")?;
    let left = chosen(&page.ask("palpate.state()")?);
    ensure!(left == [Some(4e3), Some(1e3), Some(0.0)], "the settings of before the run: {left:?}");
    let counts = run["counts"].as_str().context("no counts")?;
    let moved = format!("{}{}", if counts.starts_with('A') { 'E' } else { 'A' }, &counts[1..]);
    let with = |change: &dyn Fn(&mut Value)| {
        let mut run = run.clone();
        change(&mut run);
        run
    };
    for (spoiled, words) in [
        (with(&|run| run["bodies"][0]["file"] = other["bodies"][0]["file"].clone()), "the body “"),
        (
            with(&|run| run["device_numbers"] = other["device_numbers"].clone()),
            "the device “polhem-v2” is not that of the run",
        ),
        // Both of another run, as it says of itself: the counts do not come to the hash.
        (
            with(&|run| {
                run["device_numbers"] = other["device_numbers"].clone();
                run["device_hash"] = other["device_hash"].clone();
            }),
            "and ",
        ),
        (with(&|run| run["bodies"] = other["bodies"].clone()), "was recorded: "),
        (with(&|run| run["counts"] = moved.as_str().into()), "comes to the state hash "),
        (with(&|run| run["hash"] = "01234567".into()), "and 01234567 was recorded"),
        (with(&|run| run["settings"][1] = 321.0.into()), "was recorded: its counts or settings were changed"),
        (with(&|run| run["device_hash"] = Value::Null), "another version of palpate; record it again"),
    ] {
        let state = opened(&page, spoiled.to_string().as_bytes())?;
        let refusal = state["refusal"].as_str().with_context(|| format!("{words}: taken"))?;
        ensure!(refusal.contains(words) && refusal.contains("record it again"), "{words}: {refusal}");
    }
    // A table of another device than the one in the hand.
    let table = STANDARD.encode(fs::read(path("run.csv"))?);
    for (held, is_taken) in [("falcon", false), ("polhem-v2", true), ("", true)] {
        page.ask(&format!("palpate.take('sphere_body').then(() => palpate.holdDevice({held:?}))"))?;
        let taken = page.ask(&format!("palpate.open('run.csv', {table:?})"))?;
        ensure!(taken == is_taken, "{held}: {}", page.ask("palpate.state().refusal")?);
    }
    // A table of another body than the one that is selected selects its own, or names it where the page has none.
    page.ask("palpate.take('ellipsoid_body')")?;
    ensure!(page.ask(&format!("palpate.open('run.csv', {table:?})"))? == true, "{}", page.ask("palpate.state()")?);
    let state = page.ask("palpate.state()")?;
    ensure!(state["name"] == "sphere_body" && state["refusal"].is_null(), "{state}");
    let own = STANDARD.encode(fs::read_to_string(path("run.csv"))?.replace("sphere_body.toml", "part.step"));
    ensure!(page.ask(&format!("palpate.open('run.csv', {own:?})"))? == false, "a run on a body that is not here");
    let words = page.ask("palpate.state().refusal")?;
    let says = ["part.step", "“sphere_body”", "open its body, part.palp"];
    ensure!(says.iter().all(|part| words.as_str().is_some_and(|words| words.contains(part))), "{words}");
    ensure!(page.ask(&format!("palpate.open('run.csv', {table:?})"))? == true, "{words}");
    // A table that is shown says so, has the bar of a recording, and is computed again when a setting changes.
    let shown = "['proven', 'timeline'].map((id) => !document.getElementById(id).hidden)";
    ensure!(page.ask(shown)? == json!([true, true]), "a table without a bar");
    let words = page.ask("document.getElementById('proven').textContent")?;
    ensure!(words.as_str().is_some_and(|text| text.contains("run.csv, made with polhem-v2")), "{words}");
    let deepest = "Math.max(...palpate.views().map(({ force }) => Math.hypot(...force)))";
    let firm = page.number(deepest)?;
    page.ask("((slider) => { slider.value = 200; slider.dispatchEvent(new Event('input')); })(document.getElementById('stiffness'))")?;
    let soft = page.number(deepest)?;
    ensure!(soft > 0.0 && soft < 0.5 * firm, "{firm} N, and softer {soft} N");
    page.ask("palpate.page.leave()")?;
    ensure!(page.ask(shown)? == json!([false, false]), "the bar stays");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

/// Opens a recording, which must come to its hash.
pub fn replayed(page: &Page, recording: &str, hash: &str) -> anyhow::Result<()> {
    let state = opened(page, &fs::read(recording)?)?;
    ensure!(state["refusal"].is_null(), "{}", state["refusal"]);
    ensure!(state["replay"]["hash"] == hash, "{hash}: {}", state["replay"]);
    Ok(())
}

fn opened(page: &Page, recording: &[u8]) -> anyhow::Result<Value> {
    page.ask(&format!("palpate.open('run.json', {:?})", STANDARD.encode(recording)))?;
    page.ask("palpate.state()")
}

/// How far the lowest point of the bodies is above bar and words, pixels.
const ABOVE_THE_FOOT: &str = "(() => {
    const { room } = palpate.page, { top, height } = room.canvas.getBoundingClientRect();
    // The browser says that it is of another size with its next frame.
    room.resize();
    room.draw(false);
    const place = room.camera.position.clone();
    let lowest = 0;
    for (const face of room.faces) {
        const position = face.geometry.getAttribute('position');
        for (let at = 0; at < position.count; at += 1) {
            place.fromBufferAttribute(position, at).applyMatrix4(face.matrixWorld).project(room.camera);
            lowest = Math.max(lowest, ((1 - place.y) / 2) * height);
        }
    }
    return document.getElementById('foot').getBoundingClientRect().top - top - lowest;
})()";

#[test]
fn words_and_the_bar_of_a_recording_lie_below_the_body() -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let recording = folder.path().join("sim.json").to_string_lossy().into_owned();
    let printed = palpate(&["sim", "--seconds", "0.5", "--model", "capped_box", "--recording", &recording])?;
    let line = printed.lines().find(|line| line.contains("state hash")).context("no hash")?;
    let page = Page::held_still()?;
    page.ask("palpate.take('capped_box')")?;
    lie_below(&page, "words")?;
    // As a finger has it.
    let touch = json!({ "enabled": true, "maxTouchPoints": 5 });
    page.call("Emulation.setTouchEmulationEnabled", &touch)?;
    let coarse = json!({ "features": [{ "name": "pointer", "value": "coarse" }] });
    page.call("Emulation.setEmulatedMedia", &coarse)?;
    replayed(&page, &recording, line.split_whitespace().last().unwrap_or_default())?;
    lie_below(&page, "the bar")?;
    let hash = line.split_whitespace().last().unwrap_or_default();
    let proven = page.ask("document.getElementById('proven').textContent")?;
    ensure!(proven.as_str().is_some_and(|words| words.contains(hash)), "{proven}");
    let low = page.ask(
        "[...document.querySelectorAll('#timeline :is(button, input)')].filter((of) => of.getBoundingClientRect().height < 40)\
         .map(({ id }) => id)",
    )?;
    ensure!(low == json!([]), "lower than a finger: {low}");
    Ok(())
}

fn lie_below(page: &Page, what: &str) -> anyhow::Result<()> {
    for size in [[1280, 800], [1200, 800], [1920, 1080], [390, 800], [844, 390], [740, 360], [320, 640]] {
        page.set_size(size, 0.25)?;
        let above = page.number(ABOVE_THE_FOOT)?;
        println!("{size:?}, {what}: {above:.0} px");
        ensure!(above > 0.0, "at {size:?} {what} lie over the body by {:.0} px", -above);
    }
    Ok(())
}
