//! How much of a frame's time the page's own work takes.

use crate::browser::Page;
use anyhow::{Context as _, ensure};

/// A frame at sixty a second, ms.
const FRAME: f64 = 1e3 / 60.0;
/// Frames of a stroll: in the air, pressed in, over edges.
const FRAMES: usize = 300;

#[test]
fn a_frames_work_at_four_kilohertz_leaves_time_for_the_picture() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    page.ask("palpate.pause(false)")?;
    for body in ["capped_box", "teapot"] {
        page.ask(&format!("palpate.take({body:?})"))?;
        let [mean, worst] = work(&page)?;
        println!(
            "{body}: a frame's work at 4 kHz, 66 or 67 ticks, closest point, marks and words: {mean:.2} ms, \
             {worst:.2} ms at most, of {FRAME:.1} ms"
        );
        // At most is no figure of the page: the processor does other work between.
        ensure!(mean < FRAME, "{mean} ms");
    }
    page.ask("palpate.draw(true)")?;
    let [mean, worst] = work(&page)?;
    println!("the same with what the browser is told to draw: {mean:.2} ms, {worst:.2} ms at most");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

/// Milliseconds of a frame, the mean as the browser's clock has steps of 0.1 ms, and of the longest.
fn work(page: &Page) -> anyhow::Result<[f64; 2]> {
    let before = page.ask("palpate.state().digest")?;
    let took = page.ask(&format!("palpate.work({FRAMES})"))?;
    ensure!(page.ask("palpate.state().digest")? != before, "no tick has run");
    let took: Vec<f64> = serde_json::from_value(took)?;
    let longest = took.iter().copied().reduce(f64::max).context("no frames")?;
    Ok([took.iter().sum::<f64>() / took.len() as f64, longest])
}
