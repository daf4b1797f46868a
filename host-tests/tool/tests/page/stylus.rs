//! The mouse is the stylus.

use crate::browser::Page;
use anyhow::ensure;
use serde_json::json;
use std::thread;
use std::time::{Duration, Instant};

#[test]
fn the_mouse_moves_the_stylus_and_its_button_presses_it_in() -> anyhow::Result<()> {
    let page = Page::open()?;
    let over = [540.0, 380.0];
    // Again and again, as a hand does that sees nothing happen: a page not drawn yet has no place for a mouse.
    let hovers = "palpate.state().contact === 1 && Math.abs(palpate.state().gap - 0.1 * palpate.about().size) < 1e-4";
    let began = Instant::now();
    loop {
        page.move_mouse(over)?;
        if page.ask(hovers)? == true {
            break;
        }
        ensure!(began.elapsed() < Duration::from_secs(60), "{hovers}: {}", page.ask("palpate.state()")?);
        thread::sleep(Duration::from_millis(100));
    }
    mouse(&page, "mousePressed", over)?;
    comes_to(&page, "palpate.state().contact === 2 && palpate.state().gap < -1e-3")?;
    let touching = page.ask("document.getElementById('caption').textContent")?;
    ensure!(touching.as_str().is_some_and(|words| words.starts_with("pressed ")), "{touching}");
    mouse(&page, "mouseReleased", over)?;
    comes_to(&page, "palpate.state().contact === 1 && palpate.state().gap > 1e-3")?;
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

/// Seconds after the pointer has left until the stylus strolls again.
const IDLE: f64 = 5.0;

#[test]
fn the_stylus_strolls_again_five_seconds_after_the_mouse_has_left() -> anyhow::Result<()> {
    let page = Page::open()?;
    ensure!(page.ask("palpate.state().strolls")? == true, "nobody is here, and it stands");
    let over = [540.0, 380.0];
    page.move_mouse(over)?;
    comes_to(&page, "!palpate.state().strolls")?;
    // A mouse that rests is still there: more frames than any browser draws in that time.
    page.ask("palpate.drawn(60 * 7)")?;
    ensure!(page.ask("palpate.state().strolls")? == false, "it strolls under a mouse that rests");
    page.move_mouse([1_300.0, 400.0])?;
    let began = Instant::now();
    loop {
        let state = page.ask("palpate.state()")?;
        let (strolls, away) = (state["strolls"] == true, state["away"].as_f64().unwrap_or_default());
        ensure!(strolls == (away >= IDLE), "{away} s after it has left: strolls {strolls}");
        if strolls {
            break;
        }
        ensure!(began.elapsed() < Duration::from_secs(120), "{state}");
        thread::sleep(Duration::from_millis(200));
    }
    ensure!(began.elapsed() > Duration::from_secs_f64(0.9 * IDLE), "after {:?}", began.elapsed());
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

/// Waits until an expression is true: frames are slow where a processor draws them.
fn comes_to(page: &Page, expression: &str) -> anyhow::Result<()> {
    let began = Instant::now();
    while page.ask(expression)? != true {
        ensure!(began.elapsed() < Duration::from_secs(60), "{expression}: {}", page.ask("palpate.state()")?);
        thread::sleep(Duration::from_millis(100));
    }
    Ok(())
}

fn mouse(page: &Page, event: &str, [x, y]: [f64; 2]) -> anyhow::Result<()> {
    let button = json!({ "type": event, "x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1 });
    page.call("Input.dispatchMouseEvent", &button)?;
    Ok(())
}
