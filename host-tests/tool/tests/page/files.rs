//! Files that are dropped on the page, and bytes of a device.

use crate::browser::Page;
use crate::tool::{palpate, repository, said};
use anyhow::{Context as _, ensure};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::fs;

#[test]
fn a_body_is_taken_and_a_spoiled_one_is_refused_in_the_words_of_the_device() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    // One that did not come with the page.
    palpate(&["bake", "host-tests/suites/data/rounded_box.toml", "--out", &path("own.palp")])?;
    let bytes = fs::read(path("own.palp"))?;
    let state = dropped(&page, "own.palp", &bytes)?;
    ensure!(state["name"] == "own" && state["refusal"].is_null(), "{state}");
    ensure!(page.number("palpate.about().faces")? >= 6.0, "{state}");
    for at in [0, 4, 40, bytes.len() / 2, bytes.len() - 1] {
        let mut spoiled = bytes.clone();
        spoiled[at] ^= 0x40;
        fs::write(path("spoiled.palp"), &spoiled)?;
        let (code, words) = said(&["check", &path("spoiled.palp")])?;
        ensure!(code == Some(2), "the tool takes it: {words}");
        let state = dropped(&page, "spoiled.palp", &spoiled)?;
        let refusal = state["refusal"].as_str().with_context(|| format!("byte {at}: not refused"))?;
        ensure!(words.contains(refusal), "byte {at}: the page says\n{refusal}\nand the tool\n{words}");
        ensure!(state["name"] == "own", "the body before it stays: {state}");
    }
    let state = dropped(&page, "short.palp", &bytes[..7])?;
    ensure!(state["refusal"].is_string(), "a file cut short is taken");
    for (name, bytes, words) in [
        ("part.stl", &b"solid"[..], "part.stl: the page takes a body (.palp), a device (.toml), "),
        ("photo.png", b"\x89PNG", "photo.png: the page takes a body (.palp), "),
        ("none.palp", b"", "none.palp: the file is empty"),
        ("none.csv", b"", "none.csv: the file is empty"),
        ("head.csv", b"time,probe_x,probe_y,probe_z\n", "a table needs rows"),
    ] {
        let state = dropped(&page, name, bytes)?;
        ensure!(state["refusal"].as_str().is_some_and(|text| text.starts_with(words)), "{name}: {state}");
    }
    let state = dropped(&page, "run.json", b"{}")?;
    ensure!(state["refusal"].as_str().is_some_and(|words| words.contains("not a recording")), "{state}");
    // A device's file has the same ending.
    let state = dropped(&page, "box.toml", &fs::read(repository("host-tests/models/capped_box.toml"))?)?;
    ensure!(
        state["refusal"].as_str().is_some_and(|words| words.contains("on a computer: cargo palpate bake box.toml")),
        "{state}"
    );
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

#[test]
fn the_frames_of_a_device_are_read_as_the_wire_has_them() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    let wire = fs::read_to_string(repository("docs/reference/wire.md"))?;
    let section = wire.split("\n## ").find(|section| section.starts_with("Record")).context("no records")?;
    let frame = section.lines().find_map(|line| line.strip_prefix("Frame: `")).context("no frame")?;
    let frame: Vec<u8> = frame
        .trim_end_matches('`')
        .split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16))
        .collect::<Result<_, _>>()?;
    let mut spoiled = frame.clone();
    spoiled[20] ^= 1;
    // From the first end of a frame on: a line may be joined in the middle of one.
    let joined = [&frame[9..], &spoiled, &frame].concat();
    let record = page.ask(&format!("palpate.monitor({joined:?})"))?;
    ensure!(record["tick"] == 70_000 && record["contact"] == 2 && record["feature"] == 16_387, "{record}");
    ensure!(record["gap"].as_f64().map(|gap| gap as f32) == Some(-0.0015), "{record}");
    ensure!(record["records"] == 1 && record["damaged"] == 1, "{record}");
    Ok(())
}

pub fn dropped(page: &Page, name: &str, bytes: &[u8]) -> anyhow::Result<serde_json::Value> {
    page.ask(&format!("palpate.open({name:?}, {:?})", STANDARD.encode(bytes)))?;
    page.ask("palpate.state()")
}
