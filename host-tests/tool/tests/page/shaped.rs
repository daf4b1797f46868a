//! A tool with a shape in the reader's hand.

use crate::browser::Page;
use anyhow::ensure;
use serde_json::{Value, json};

/// Presses a tool by a millimetre into the middle of the bottom of the capped box, 60 by 40 mm from the origin on, and rests.
fn pressed(page: &Page, half: [f64; 3], radius: f64, turned: &str) -> anyhow::Result<Value> {
    let place = format!(
        "(() => {{ const device = palpate.page.body.device, size = device.size, tool = palpate.page.tool;
        const {{ point: [x, y, z] }} = device.closest([0.03, 0.02, -size]);
        {turned}
        const reach = tool.reach(palpate.page.room.front.clone().set(0, 0, 1)) * size;
        for (const before of [0.01, 0.01, -0.001, -0.001]) palpate.hold([x, y, z - reach - before], 4000);
        return {{ ...palpate.state(), ...palpate.tool(), wall: z, size, reach, half: {half:?}, radius: {radius:?} }}; }})()"
    );
    page.ask(&place)
}

/// How far the tool reaches along z by its drawn pose: the corners of its core, and the radius.
const TOP: &str = "(({ position, orientation: [x, y, z, w], half, radius, size }) => {
    const upward = [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)];
    return position[2] + size * (radius + upward.reduce((sum, part, axis) => sum + Math.abs(part) * half[axis], 0));
})";

#[test]
fn a_tool_is_held_outside_and_pushed_back_by_the_wall_whichever_way_it_is_turned() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    page.ask("palpate.take('capped_box')")?;
    let turned = "tool.turned.set(0.2, -0.4, 0.1, 0.9).normalize(); device.turnTool(tool.turned.toArray());";
    for (name, half, radius) in
        [("ball", [0.0; 3], 0.07), ("capsule", [0.0, 0.0, 0.15], 0.05), ("box", [0.14, 0.09, 0.05], 0.02)]
    {
        for turn in ["", turned] {
            page.ask(&format!("palpate.takeTool('{name}')"))?;
            let state = pressed(&page, half, radius, turn)?;
            let [gap, wall] = ["gap", "wall"].map(|key| state[key].as_f64().unwrap_or(f64::NAN));
            let force = state["force"][2].as_f64().unwrap_or(f64::NAN);
            let top = page.number(&format!("{TOP}({state})"))?;
            println!("{name} {turn:.5}: gap {gap}, force {force} N, {:.2} µm from the wall", 1e6 * (top - wall));
            ensure!(state["contact"] == 2, "{name}: {state}");
            // The wall's stiffness of 1,000 N/m; roundings of the encoders, a quarter of a micrometre.
            ensure!((gap + 0.001).abs() < 2e-6 && (force + 1.0).abs() < 2e-3, "{name}: {gap} m, {force} N");
            ensure!((top - wall).abs() < 2e-6, "{name}: drawn {} m from the wall", top - wall);
            let pushes = state["contacts"].as_array().into_iter().flatten();
            let pushed: f64 = pushes.filter_map(|contact| contact["force"][2].as_f64()).sum();
            ensure!((pushed - force).abs() < 2e-3, "{name}: contacts give {pushed} N");
        }
    }
    ensure!(page.errors().is_empty(), "on the console: {:?}", page.errors());
    Ok(())
}

#[test]
fn a_drag_turns_the_tool_about_the_axes_of_the_picture() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    page.ask("palpate.takeTool('box')")?;
    page.ask("(() => { const hand = document.getElementById('hand'); hand.value = 'turn'; hand.dispatchEvent(new Event('change')); })()")?;
    for (event, x, buttons) in [("mousePressed", 500.0, 1), ("mouseMoved", 600.0, 1), ("mouseReleased", 600.0, 0)] {
        let button =
            json!({ "type": event, "x": x, "y": 400.0, "button": "left", "buttons": buttons, "clickCount": 1 });
        page.call("Input.dispatchMouseEvent", &button)?;
    }
    // Half the angle of a radian, about the upward axis of the picture.
    let off = page.number(
        "(() => { const { room, tool } = palpate.page, up = room.front.clone().set(0, 1, 0).applyQuaternion(room.camera.quaternion);
         const { x, y, z, w } = tool.turned, sine = Math.sin(0.5);
         return Math.hypot(x - sine * up.x, y - sine * up.y, z - sine * up.z, w - Math.cos(0.5)); })()",
    )?;
    ensure!(off < 1e-6, "{off} from a turn of a radian: {}", page.ask("palpate.page.tool.turned.toArray()")?);
    // The hand takes its time: 6 rad/s.
    let at = page.ask("(palpate.page.body.device.run(4000, palpate.page.loop.place), palpate.tool().hand)")?;
    let turned = page.ask("palpate.page.tool.turned.toArray()")?;
    for axis in 0..4 {
        let [now, to] = [&at, &turned].map(|of| of[axis].as_f64().unwrap_or(f64::NAN));
        ensure!((now - to).abs() < 1e-5, "{at} for {turned}");
    }
    Ok(())
}

#[test]
fn a_tool_goes_with_the_reader_to_another_body_and_not_to_a_patch() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    let tool = "[document.getElementById('tool').value, document.getElementById('tool').disabled, !palpate.tool()]";
    page.ask("palpate.takeTool('capsule')")?;
    page.ask("palpate.take('rounded_cylinder')")?;
    ensure!(page.ask(tool)? == json!(["capsule", false, false]), "{}", page.ask(tool)?);
    page.ask("palpate.take('table1')")?;
    ensure!(page.ask(tool)? == json!(["", true, true]), "{}", page.ask(tool)?);
    ensure!(page.ask("palpate.state().refusal")? == json!(null), "{}", page.ask("palpate.state()")?);
    Ok(())
}
