//! The same bits: a million ticks beside the host's compiler, which every emulated core agrees with, and a run that
//! the emulated board itself has recorded.

use crate::browser::Page;
use crate::replay::replayed;
use crate::tool::{self, palpate};
use anyhow::{Context as _, ensure};
use std::fs;
use std::time::Instant;

#[test]
fn the_million_ticks_of_the_boards_come_to_the_same_and_their_time_is_told() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    let mut script = String::new();
    let began = Instant::now();
    palpate_bench::exercise::run(&mut |name, tally| script += &format!("{name} {tally}\n"));
    let native = began.elapsed();
    let shown = page.ask(
        "palpate.verify().then((same) => ({ same, hash: document.getElementById('hash').textContent, \
                          verdict: document.getElementById('verdict').textContent }))",
    )?;
    ensure!(shown["same"] == true, "the page says: {}", shown["verdict"]);
    let hash = script.bytes().fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    ensure!(shown["hash"] == format!("{hash:08x}"), "the page shows {}, and it is {hash:08x}", shown["hash"]);
    let seconds = page.number("palpate.exerciseSeconds()")?;
    println!("the script of the boards: {hash:08x}; {}", shown["verdict"]);
    println!("a tick of it: {:.0} ns in wasm, {:.0} ns native", seconds * 1e3, native.as_secs_f64() * 1e3);
    println!("a tick of the capped box: {:.0} ns in wasm", page.number("palpate.nanoseconds()")?);
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

#[test]
fn a_run_that_the_emulated_board_has_recorded_is_felt_anew_to_the_same_hash() -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    // Once the page's code has been built here, the report has its run in 3-D beside it.
    tool::address();
    let printed = palpate(&["demo", "--report", &path("demo.html")])?;
    let word = |name: &str| {
        let line = printed.lines().find(|line| line.trim_start().starts_with(name));
        line.and_then(|line| line.split_whitespace().last()).map(str::to_owned)
    };
    // Only now: the image may have taken minutes to build, and a browser does not wait for ever.
    let page = Page::held_still()?;
    let hash = word("state hash").context("the demo prints no hash")?;
    replayed(&page, &path("demo.json"), &hash)?;
    println!("{}", printed.lines().next().unwrap_or_default());
    println!("its 20,000 ticks in the page: state hash {hash}, the board's");
    let report = fs::read_to_string(path("demo.html"))?;
    ensure!(report.contains("<a href=\"demo.replay.html\">"), "the report opens no page");
    let beside = Page::open_at(&format!("file://{}", path("demo.replay.html")))?;
    let state = beside.ask("palpate.state()")?;
    ensure!(state["replay"]["hash"] == hash, "{hash}: {state}");
    ensure!(beside.errors().is_empty(), "on the console: {:?}", beside.errors());
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}
