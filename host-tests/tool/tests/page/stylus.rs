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

/// Presses the stylus into places of each face that the reader sees; those at which the pen's shaft is in the body, or
/// leaves it through another face.
const BURIED: &str = "(async () => {
    const { room, marks, pointer } = palpate.page, size = palpate.about().size, found = [];
    let pressed = 0;
    room.draw(false);
    for (const face of room.faces) for (const share of [0.5, 0.06, 0.93]) {
        const { position, normal } = face.geometry.attributes, vertex = Math.floor(share * position.count);
        const at = room.camera.position.clone().fromBufferAttribute(position, vertex),
            out = at.clone().fromBufferAttribute(normal, vertex);
        at.applyMatrix4(face.matrixWorld);
        if (out.dot(room.camera.position.clone().sub(at).normalize()) < 0.1) continue;
        for (const height of [0.2, -0.05]) palpate.hold(room.unplace(at.clone().addScaledVector(out, height)), 2000);
        for (let frame = 0; frame < 60; frame += 1) palpate.page.picture();
        const { contact, feature } = palpate.state();
        if (contact !== 2 || feature >> 14) continue;
        pressed += 1;
        pointer.ray.set(marks.stylus.position, marks.lean);
        const [first] = pointer.ray.intersectObjects(room.faces, false);
        if (first?.object !== room.faces[feature]) found.push([feature, share]);
        for (const along of [0.25, 0.35, 0.45]) {
            const place = marks.stylus.position.clone().addScaledVector(marks.lean, along);
            pointer.ray.set(place, at.clone().set(0.123, 0.234, 0.965).normalize());
            if (pointer.ray.intersectObjects(room.faces, false).length % 2) found.push([feature, share, along]);
        }
    }
    return { pressed, found };
})()";

#[test]
fn a_pen_pressed_into_any_face_in_view_is_drawn_outside() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    for body in ["capped_box", "rounded_cylinder"] {
        page.ask(&format!("palpate.take('{body}')"))?;
        let state = page.ask(BURIED)?;
        println!("{body}: {state}");
        ensure!(state["pressed"].as_u64() > Some(2) && state["found"] == json!([]), "{body}: {state}");
    }
    Ok(())
}

#[test]
fn the_first_view_of_each_patch_shows_the_side_that_is_touched() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    let patches =
        page.ask("JSON.parse(document.getElementById('given').textContent).bodies.map(({ name }) => name)")?;
    let mut patches_seen = 0;
    for name in patches.as_array().into_iter().flatten().filter_map(|name| name.as_str()) {
        page.ask(&format!("palpate.take('{name}')"))?;
        // Of the surface's normals, the share that faces the reader.
        let share = page.number(
            "(({ room, body }) => { let [seen, all] = [0, 0]; for (const { geometry, matrixWorld } of room.faces) { \
             const { position, normal } = geometry.attributes, at = room.camera.position.clone(), out = at.clone(); \
             for (let i = 0; i < position.count; i += 1) { at.fromBufferAttribute(position, i).applyMatrix4(matrixWorld); \
             out.fromBufferAttribute(normal, i); all += 1; \
             seen += out.dot(room.camera.position.clone().sub(at)) > 0 ? 1 : 0; } } \
             return body.device.isPatch ? seen / all : 1; })(palpate.page)",
        )?;
        println!("{name}: {share:.2}");
        patches_seen += usize::from(share < 1.0);
        ensure!(share > 0.5, "{name}: the reader sees {share} of the side that is touched");
    }
    ensure!(patches_seen > 1, "no patches");
    Ok(())
}

/// Presses the stylus in over one face and moves the hand to another at once, at a frame a second; how often it is
/// pressed in over the first, and how often behind the surface twelve frames later, of the frames' 50 ms each.
const LEAPS: &str = "(() => {
    const { loop, pointer, room, body } = palpate.page, feet = [];
    room.draw(false);
    for (const face of room.faces) {
        const { position, normal } = face.geometry.attributes, middle = Math.floor(position.count / 2);
        const point = room.camera.position.clone().fromBufferAttribute(position, middle).applyMatrix4(face.matrixWorld);
        feet.push({ point, normal: point.clone().fromBufferAttribute(normal, middle) });
    }
    const frames = (count) => {
        for (let frame = 0; frame < count; frame += 1) palpate.page.advance(0.05);
        return palpate.page.view.contact;
    };
    let leaps = 0, behind = 0;
    loop.presence.come(true);
    Object.assign(loop, { paused: false, strolls: false });
    for (const from of feet.filter((_, face) => face % 3 === 0)) for (const to of feet) {
        pointer.begin();
        pointer.foot = from;
        loop.place = room.unplace(pointer.over(0.1));
        body.device.restart(loop.place);
        if (frames(6) !== 1) continue;
        pointer.pressed = true;
        if (frames(6) !== 2) continue;
        leaps += 1;
        Object.assign(pointer, { foot: to, moved: true });
        behind += frames(12) === 0;
    }
    loop.paused = true;
    return { leaps, behind };
})()";

#[test]
fn a_stylus_dragged_through_the_body_is_lifted_to_where_it_is_felt() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    page.ask("palpate.take('teapot')")?;
    let state = page.ask(LEAPS)?;
    println!("{state}");
    let [leaps, behind] = ["leaps", "behind"].map(|name| state[name].as_u64().unwrap_or_default());
    // Its patches pass through each other, and beyond an open border nothing is felt.
    ensure!(leaps > 200 && 10 * behind < leaps, "{state}");
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}
