//! A device on a serial port: what an emulated board says of itself, through the page's own reader of a port.

use crate::browser::Page;
use crate::tool::palpate;
use anyhow::{Context as _, bail, ensure};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::fs;

/// A port with these bytes on it: the one thing that a headless browser has none of. They come in pieces that mean
/// nothing to the frames, and the line stays open.
const PORT: &str = "(() => {
    const bytes = Uint8Array.from(atob('BYTES'), (letter) => letter.charCodeAt(0));
    const said = (window.said = { speed: null, closed: false });
    let at = 0;
    const readable = new ReadableStream({
        pull(line) {
            if (at >= bytes.length) return new Promise(() => {});
            const piece = 1 + ((at * 7919) % 97);
            line.enqueue(bytes.slice(at, at + piece));
            at += piece;
        },
    });
    const port = {
        readable,
        open: async ({ baudRate }) => { said.speed = baudRate; },
        close: async () => { said.closed = true; },
    };
    Object.defineProperty(navigator, 'serial', { value: { requestPort: async () => port }, configurable: true });
    return true;
})()";

#[test]
fn what_the_emulated_board_says_on_its_line_is_shown_as_monitor_reads_it() -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    let [raw, csv] = ["line.bin", "line.csv"].map(|name| folder.path().join(name).to_string_lossy().into_owned());
    let said = palpate(&["monitor", "--emulator", "m4", "--seconds", "3", "--raw", &raw, "--csv", &csv])?;
    // "355 records, 0 lost on the line, 0 of them damaged, 0 resets".
    let counted = said.lines().find(|line| line.contains(" lost on the line, ")).context("no count of records")?;
    let counts: Vec<u32> = counted.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let &[records, _, damaged, _] = &counts[..] else { bail!("{counted}") };
    let table = fs::read_to_string(csv)?;
    let head: Vec<&str> = table.lines().next().context("an empty table")?.split(',').collect();
    let last: Vec<&str> = table.lines().next_back().context("no row")?.split(',').collect();
    let cell = |name: &str| -> anyhow::Result<f64> {
        let column = head.iter().position(|found| *found == name).with_context(|| name.to_owned())?;
        Ok(last[column].parse()?)
    };
    ensure!(records > 50 && cell("contact")? > 0.0, "{records} records, the last: {last:?}");
    let page = Page::held_still()?;
    page.ask("palpate.take('capped_box')")?;
    ensure!(page.ask(&PORT.replace("BYTES", &STANDARD.encode(fs::read(raw)?)))? == true);
    page.ask("document.getElementById('serial').click()")?;
    let told = format!("{records} records, {damaged} damaged;");
    page.comes_to(&format!("document.getElementById('live').textContent.startsWith('{told}')"))
        .with_context(|| format!("{:?}", page.ask("document.getElementById('live').textContent")))?;
    page.ask("palpate.drawn(2)")?;
    let state = page.ask("palpate.state()")?;
    for (name, shown) in [("gap", &state["gap"]), ("contact", &state["contact"]), ("feature", &state["feature"])] {
        let shown = shown.as_f64().context("no number")?;
        // Nine digits tell one f32 from the next.
        ensure!(shown as f32 == cell(name)? as f32, "{name}: {shown}, and monitor has {}", cell(name)?);
    }
    for (axis, name) in ["probe_x", "probe_y", "probe_z"].into_iter().enumerate() {
        ensure!(state["probe"][axis].as_f64().map(|x| x as f32) == Some(cell(name)? as f32), "{name}: {state}");
    }
    // The stylus is where the board's probe is, and so the page's closest point as far away as the board says.
    let found = page.ask(&format!("palpate.closest({})", state["probe"]))?;
    let (distance, gap) = (found["distance"].as_f64().context("no distance")?, cell("gap")?);
    ensure!((distance - gap.abs()).abs() < 1e-6, "{distance} m from the body, and the board says {gap}");
    ensure!(page.ask("window.said.speed")? == 500_000, "the port is open at another speed");
    page.ask("document.getElementById('serial').click()")?;
    page.comes_to("window.said.closed && document.getElementById('serial').textContent.startsWith('Connect')")?;
    println!("{records} records of the emulated board over a port of the browser's: shown as monitor has them");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}
