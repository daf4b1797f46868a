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

#[test]
fn in_a_plane_that_faces_the_reader_a_finger_and_a_key_press_and_the_slider_moves_the_plane() -> anyhow::Result<()> {
    let page = Page::open()?;
    let chosen = "((list) => { list.value = 'plane'; list.dispatchEvent(new Event('change')); })(document.getElementById('hand'))";
    let in_front = "palpate.state().contact === 1 && palpate.state().gap > 1e-3";
    // From where a finger was over the surface, and on a body that was taken since.
    fingers(&page, "touchStart", &[OVER])?;
    fingers(&page, "touchEnd", &[])?;
    page.comes_to(HOVERS)?;
    page.ask(chosen)?;
    for body in ["", "capped_box"] {
        if !body.is_empty() {
            page.ask(&format!("palpate.take('{body}')"))?;
        }
        fingers(&page, "touchStart", &[OVER])?;
        page.comes_to(PRESSED)?;
        fingers(&page, "touchEnd", &[])?;
        page.comes_to(in_front)?;
        key(&page, "keydown")?;
        page.comes_to(PRESSED)?;
        key(&page, "keyup")?;
        page.comes_to(in_front)?;
        page.ask("palpate.drawn(60)")?;
        let before = place(&page)?;
        // However long nobody has been at the picture.
        page.ask("void (palpate.page.loop.presence.away = 4.9)")?;
        page.ask("((slider) => { slider.value = 60; slider.dispatchEvent(new Event('input')); })(document.getElementById('height'))")?;
        // Half a size straight towards the reader, who looks at the middle of the picture.
        let moved = format!("palpate.state().probe.map((x, axis) => (x - {before:?}[axis]) / palpate.about().size)");
        page.comes_to(&format!("Math.abs(Math.hypot(...{moved}) - 0.5) < 1e-3"))?;
        page.ask("palpate.drawn(20)")?;
        ensure!(page.ask("palpate.state().strolls")? == false, "it strolls while the slider is moved");
        let towards = page.number(&format!(
            "(({{ room }}) => {{ const from = room.camera.position.clone().sub(room.orbit.target).normalize().toArray(); \
             return {moved}.reduce((sum, x, axis) => sum + x * from[axis], 0); }})(palpate.page)"
        ))?;
        ensure!((towards - 0.5).abs() < 1e-3, "{body}: {towards} sizes towards the reader");
    }
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

/// Explained words of the panel that a finger meets over less than 32 px of height, px; 31 of those are whole.
const LOW: &str = "[...document.querySelectorAll('[data-why]')].filter((word) => word.checkVisibility() && word.textContent).map((word) => {
    word.scrollIntoView({ block: 'center' });
    const { left, top, bottom } = word.getBoundingClientRect();
    let height = 0;
    for (let y = Math.floor(top) - 8; y < bottom + 8; y += 1)
        height += document.elementFromPoint(left + 4, y)?.closest('[data-why]') === word ? 1 : 0;
    return [word.textContent, height];
}).filter(([, height]) => height < 31)";
/// Bodies whose names are cut in their list: as wide as one that holds the name alone.
const CUT: &str = "(() => {
    const list = document.getElementById('body'), probe = list.cloneNode();
    document.body.append(probe);
    const cut = [...list.options].filter(({ text }) => {
        probe.replaceChildren(new Option(text));
        Object.assign(probe.style, { position: 'absolute', width: 'auto' });
        return probe.offsetWidth > list.offsetWidth;
    });
    probe.remove();
    return cut.map(({ text }) => text);
})()";

#[test]
fn a_finger_meets_each_explained_word_and_reads_the_names_of_bodies() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    page.call("Emulation.setTouchEmulationEnabled", &json!({ "enabled": true, "maxTouchPoints": 5 }))?;
    let coarse = json!({ "features": [{ "name": "pointer", "value": "coarse" }] });
    page.call("Emulation.setEmulatedMedia", &coarse)?;
    page.ask("palpate.hold([0, 0, 0], 100)")?;
    for size in [[390, 844], [320, 640], [844, 390]] {
        page.set_size(size, 0.25)?;
        for panel in ["knob", "feel"] {
            page.ask(&format!("palpate.panel('{panel}')"))?;
            page.ask("palpate.drawn(2)")?;
            let low = page.ask(LOW)?;
            ensure!(low == json!([]), "{panel} at {size:?}, lower than a finger: {low}");
        }
        let cut = page.ask(CUT)?;
        ensure!(cut == json!([]), "cut at {size:?}: {cut}");
        let [list, look] = ["body", "look"]
            .map(|id| page.number(&format!("document.getElementById('{id}').getBoundingClientRect().top")));
        ensure!((list? - look?).abs() < 2.0, "the buttons are below the list at {size:?}");
    }
    page.ask("document.getElementById('contact').scrollIntoView({ block: 'center' })")?;
    page.ask("palpate.drawn(5)")?;
    let at = page.ask("(({ left, top, height }) => [left + 4, top + height / 2])(document.getElementById('contact').getBoundingClientRect())")?;
    let at: [f64; 2] = serde_json::from_value(at)?;
    fingers(&page, "touchStart", &[at])?;
    fingers(&page, "touchEnd", &[])?;
    page.comes_to("!document.getElementById('why').hidden")?;
    let words = page.ask("document.getElementById('why').textContent")?;
    ensure!(words.as_str().is_some_and(|words| words.contains("radius of curvature")), "{words}");
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
