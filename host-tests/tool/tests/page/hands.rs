//! What moves the stylus besides a mouse: fingers and keys. Each test waits for what a reader would see, however slow
//! the frames.

use crate::browser::Page;
use anyhow::{Context as _, ensure};
use serde_json::json;

/// Where the body is drawn, pixels.
const OVER: [f64; 2] = [540.0, 380.0];

/// In front of the body by the height it hovers at.
const HOVERS: &str =
    "palpate.state().contact === 1 && Math.abs(palpate.state().gap - 0.1 * palpate.about().size) < 1e-4";
const PRESSED: &str = "palpate.state().contact === 2 && palpate.state().gap < -1e-3";

#[test]
fn a_finger_presses_where_it_is_and_two_turn_the_view_and_zoom() -> anyhow::Result<()> {
    let page = Page::open()?;
    fingers(&page, "touchStart", &[OVER])?;
    page.comes_to(PRESSED)?;
    let before = place(&page)?;
    fingers(&page, "touchMove", &[[OVER[0] + 60.0, OVER[1]]])?;
    page.comes_to(&format!("Math.hypot(...palpate.state().probe.map((x, axis) => x - {before:?}[axis])) > 1e-3"))?;
    fingers(&page, "touchEnd", &[])?;
    page.comes_to(HOVERS)?;
    let from = page.ask("palpate.state().looksFrom")?;
    let far = page.number("Math.hypot(...palpate.state().looksFrom)")?;
    let second = [OVER[0] + 80.0, OVER[1]];
    fingers(&page, "touchStart", &[OVER, second])?;
    // One of them comes down first, and the stylus goes there; in so many frames it is where it stays.
    page.ask("palpate.drawn(20)")?;
    let stylus = place(&page)?;
    for step in 1..=4 {
        let along = 30.0 * f64::from(step);
        let moved = [OVER, second].map(|[x, y]| [x + along, y]);
        fingers(&page, "touchMove", &moved)?;
    }
    page.comes_to(&format!("Math.hypot(...palpate.state().looksFrom.map((x, axis) => x - {from}[axis])) > 0.2"))?;
    fingers(&page, "touchEnd", &[])?;
    page.ask("palpate.drawn(10)")?;
    let now = page.number("Math.hypot(...palpate.state().looksFrom)")?;
    ensure!((now / far - 1.0).abs() < 0.02, "the view has come nearer: {far} to {now}");
    let moved = place(&page)?.iter().zip(&stylus).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // A finger's way is 1 cm on the body.
    ensure!(moved < 5e-4, "the stylus went along: {moved} m");
    // From 80 px apart to 160.
    fingers(&page, "touchStart", &[OVER, second])?;
    for step in 1..=4 {
        let apart = [OVER[0] + 80.0 + 20.0 * f64::from(step), OVER[1]];
        fingers(&page, "touchMove", &[OVER, apart])?;
    }
    fingers(&page, "touchEnd", &[])?;
    page.ask("palpate.drawn(10)")?;
    let near = page.number("Math.hypot(...palpate.state().looksFrom)")?;
    ensure!((near / now - 0.5).abs() < 0.05, "a pinch apart: {now} to {near}");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

#[test]
fn keys_move_the_stylus_raise_it_and_press_it_in() -> anyhow::Result<()> {
    let page = Page::open()?;
    // The picture has the keys from the beginning.
    page.press_key("ArrowLeft")?;
    page.comes_to(HOVERS)?;
    let before = place(&page)?;
    for _ in 0..4 {
        page.press_key("ArrowRight")?;
    }
    page.comes_to(&format!("Math.hypot(...palpate.state().probe.map((x, axis) => x - {before:?}[axis])) > 1e-3"))?;
    for _ in 0..2 {
        page.press_key("PageUp")?;
    }
    page.comes_to("Math.abs(palpate.state().gap - 0.14 * palpate.about().size) < 1e-4")?;
    // A key that stays down: `press_key` lets go at once.
    key(&page, "keydown")?;
    page.comes_to(PRESSED)?;
    key(&page, "keyup")?;
    page.comes_to("palpate.state().contact === 1 && palpate.state().gap > 1e-3")?;
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

fn key(page: &Page, what: &str) -> anyhow::Result<()> {
    page.ask(&format!(
        "document.activeElement.dispatchEvent(new KeyboardEvent({what:?}, {{ key: ' ', bubbles: true }})) && null"
    ))?;
    Ok(())
}

/// Where the probe is, metres.
fn place(page: &Page) -> anyhow::Result<Vec<f64>> {
    let probe = page.ask("palpate.state().probe")?;
    probe.as_array().context("no probe")?.iter().map(|x| x.as_f64().context("no number")).collect()
}

fn fingers(page: &Page, event: &str, at: &[[f64; 2]]) -> anyhow::Result<()> {
    let points = at.iter().enumerate().map(|(finger, [x, y])| json!({ "x": x, "y": y, "id": finger }));
    let points: Vec<_> = points.collect();
    page.call("Input.dispatchTouchEvent", &json!({ "type": event, "touchPoints": points }))?;
    Ok(())
}
