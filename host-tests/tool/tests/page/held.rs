//! Devices in the hand: those that ship, and a file of one's own.

use crate::browser::Page;
use crate::files::dropped;
use crate::tool::{palpate, said};
use anyhow::{Context as _, ensure};
use serde_json::Value;
use std::fs;

/// Those with three joints, and the stiffness that is recommended for each, N/m: docs of `servo::recommended`.
const DEVICES: [(&str, f64); 4] =
    [("woodenhaptics-2016", 500.0), ("polhem-v2", 500.0), ("phantom-premium", 400.0), ("falcon", 400.0)];

/// A number of a device file.
fn entry(file: &toml::Table, section: &str, name: &str) -> anyhow::Result<f64> {
    file[section][name].as_float().with_context(|| format!("{section}.{name}"))
}

fn number(of: &Value, name: &str) -> anyhow::Result<f64> {
    of[name].as_f64().with_context(|| format!("{name}: {of}"))
}

/// How long a vector is.
fn length(of: &Value) -> anyhow::Result<f64> {
    let parts = of.as_array().with_context(|| of.to_string())?;
    Ok(parts.iter().filter_map(Value::as_f64).map(|x| x * x).sum::<f64>().sqrt())
}

#[test]
fn a_device_gives_no_more_than_its_force_counts_and_ends_where_its_links_do() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    page.ask("palpate.take('sphere_body')")?;
    let folder = tempfile::tempdir()?;
    for (name, stiffness) in DEVICES {
        let path = folder.path().join("device.toml").to_string_lossy().into_owned();
        palpate(&["device", name, "--out", &path])?;
        let file: toml::Table = toml::from_str(&fs::read_to_string(&path)?)?;
        ensure!(page.ask(&format!("palpate.holdDevice({name:?})"))? == true, "{name} is refused");
        let state = page.ask("palpate.state()")?;
        let (held, limit) = (&state["held"], entry(&file, "limits", "max_force")?);
        ensure!((number(held, "maxForce")? - limit).abs() < 1e-5 * limit, "{name}: {held}, the file says {limit} N");
        let choices = &state["choices"];
        ensure!(number(choices, "stiffness")? == stiffness && choices["rendering"] == 2, "{name}: {choices}");
        // In front of the sphere, 2 mm into it, and deeper than its force.
        let radius = page.number("palpate.closest([1, 0, 0]).point[0]")?;
        let at = |above: f64, ticks: u32| page.ask(&format!("palpate.hold([{}, 0, 0], {ticks})", radius + above));
        at(5e-3, 4_000)?;
        // Twice: the damper pushes while it moves.
        at(-2e-3, 4_000)?;
        let view = at(-2e-3, 400)?;
        let (force, gap) = (length(&view["force"])?, number(&view, "gap")?);
        ensure!(view["fault"] == 0 && view["phase"] == 3, "{name}: {view}");
        // A count is 0.1 mm at most.
        ensure!((force + stiffness * gap).abs() < 0.01 && (gap + 2e-3).abs() < 1e-4, "{name}: {force} N at {gap} m");
        // Beyond the limit by a fifth: farther in the loop gives the contact up.
        let view = at(-1.2 * limit / stiffness, 8_000)?;
        let force = length(&view["force"])?;
        // Less where the workspace's margin is small.
        ensure!((0.9..1.00001).contains(&(force / limit)), "{name}: {force} N of {limit} N: {view}");
        // As many places in a millimetre as there are counts.
        at(5e-3, 4_000)?;
        let mut places = Vec::new();
        for step in 0..50 {
            places.push(at(5e-3 + 2e-5 * f64::from(step), 40)?["probe"].to_string());
        }
        places.dedup();
        let most = 50.0_f64.min(4.0 + 3.0 * 1e-3 / (number(held, "perCount")? * 0.2));
        ensure!((4.0..=most).contains(&(places.len() as f64)), "{name}: {} places: {held}", places.len());
        // No farther than all its lengths together; the hand stays there, and comes back.
        let lengths = |value: &toml::Value| -> f64 {
            let each = |value: &toml::Value| value.as_float().map_or(0.0, f64::abs);
            value.as_array().map_or_else(|| each(value), |all| all.iter().map(each).sum())
        };
        let whole: f64 = file["mechanism"].as_table().context("no mechanism")?.values().map(lengths).sum();
        let view = at(5.0, 40_000)?;
        let far = length(&view["probe"])?;
        ensure!(view["fault"] == 0 && far > 0.05 && far < whole, "{name}: {far} m of {whole} m: {view}");
        let margin = number(&page.ask("palpate.state()")?, "margin")?;
        ensure!(margin < 0.2, "{name}: a margin of {margin} at the end");
        at(5e-3, 20_000)?;
        let state = page.ask("palpate.state()")?;
        ensure!((number(&state, "gap")? - 5e-3).abs() < 2e-4, "{name}: it does not come back: {state}");
        println!("{name}: {}", state["held"]["about"]);
    }
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

#[test]
fn a_file_of_ones_own_is_held_and_a_bad_one_is_refused_in_the_words_of_the_tool() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    palpate(&["device", "falcon", "--out", &path("mine.toml")])?;
    let text = fs::read_to_string(path("mine.toml"))?.replace("name = \"falcon\"", "name = \"mine\"");
    let state = dropped(&page, "mine.toml", text.as_bytes())?;
    ensure!(state["held"]["name"] == "mine" && state["refusal"].is_null(), "{state}");
    // What a shipped device is measured to bear is not one's own.
    ensure!(state["choices"]["stiffness"] == 500, "{}", state["choices"]);
    for (from, to) in [
        ("max_force = ", "max_force = -"),
        ("max_stiffness = ", "max_stifness = "),
        ("thigh = ", "thigh = 100"),
        ("channel = 1", "channel = 7"),
        ("kind = \"delta\"", "kind = \"theta\""),
        ("[limits]", "[limits"),
    ] {
        let spoiled = text.replacen(from, to, 1);
        fs::write(path("spoiled.toml"), &spoiled)?;
        let (code, words) = said(&["device", &path("spoiled.toml"), "--out", &path("never.rs")])?;
        ensure!(code == Some(2), "{to}: the tool takes it: {words}");
        let state = dropped(&page, "spoiled.toml", spoiled.as_bytes())?;
        let refusal = state["refusal"].as_str().with_context(|| format!("{to}: not refused"))?;
        ensure!(refusal.len() > 20 && words.contains(refusal), "{to}: the page says\n{refusal}\nand the tool\n{words}");
        ensure!(state["held"]["name"] == "mine", "the device before it stays: {state}");
    }
    // Under another body it stays in the hand.
    page.ask("palpate.take('sphere')")?;
    let state = page.ask("palpate.state()")?;
    ensure!(state["held"]["name"] == "mine" && state["choices"]["stiffness"] == 500, "{state}");
    let far = length(&page.ask("palpate.hold([5, 0, 0], 40000)")?["probe"])?;
    ensure!(far < 0.2, "under the next body its workspace has no end: {far} m");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}
