//! The whole servo tick of a tool with a shape, on the body of any file: a hand presses it into each face, strokes and
//! turns it.

use core::hint::black_box;

use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face, MAX_FACES, TickLimit};
use palpate::math::{Vec3, sin_cos};
use palpate::pair::{Core, ProxyError, Tool, ToolSurface};
use palpate::patch::Patch as _;
use palpate::servo::{Config, Event, Input, Rendering, Servo, Settings};
use semihosting::println;

use super::servo::{APPROACH, Walk};
use super::tally::Tally;
use crate::body::{DEVICE, SETTINGS};
use crate::timer::InstructionCounter;

static FILE: &Aligned<[u8]> = &Aligned(*include_bytes!(env!("PALPATE_COLD_FILE")));

/// Ticks on a face.
const TICKS: u32 = 6_000;
/// Of the core, metres, and the farthest of it from the middle.
const HALF: [f32; 3] = [0.009, 0.006, 0.003];
const REACH: f32 = 0.012;
const RADIUS: f32 = 0.003;

/// Loads the body and presses the tools into it.
///
/// # Errors
/// That the file or a loop is refused, a fault, or a tool that hardly touches.
pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    let (mut faces, mut edges) = ([Face::VACANT; MAX_FACES], [Edge::VACANT; 4 * MAX_FACES]);
    let buffer = BodyBuffer { faces: &mut faces, edges: &mut edges };
    let loaded = Body::from_bytes_with(&FILE.0, buffer, TickLimit::NONE, &mut || ());
    let body = loaded.map_err(|_| "the body's file was refused")?;
    press(counter, &body, "ball", Core::Point)?;
    press(counter, &body, "capsule", Core::Segment { half: HALF[0] })?;
    press(counter, &body, "box", Core::Box { half: HALF })
}

fn press(counter: &mut InstructionCounter, body: &Body<'_>, name: &str, core: Core<'_>) -> Result<(), &'static str> {
    let tool = Tool::new(core, RADIUS).map_err(|_| "the tool was refused")?;
    let (mut locating, mut holding, mut most, mut left_out) = (Tally::new(), Tally::new(), 0, 0);
    for (index, face) in body.faces().iter().enumerate() {
        let surface = face.patch.evaluate(0.5, 0.5);
        let outward = surface.tangent_u.cross(surface.tangent_v).normalize_or_zero() * face.patch.orientation();
        let along = surface.tangent_u.normalize_or_zero();
        // The middle of the face lies in the middle of the workspace.
        let settings = Settings { body_origin_m: -surface.point, ..SETTINGS };
        let shaped = ToolSurface::new(body, tool, &settings).map_err(|_| "the tool's surface was refused")?;
        let config = Config { settings, rendering: Rendering::SMOOTH, ..Config::DEFAULT };
        let servo = Servo::try_new(&DEVICE, &shaped, config).map_err(|_| "the loop was refused")?;
        let (mut state, mut walk) = (servo.start(), Walk::start());
        let start = outward * (REACH + RADIUS + 0.001);
        for _ in 0..APPROACH {
            walk.counts(start);
        }
        servo.note(&mut state, Event::Homed);
        let (mut located, mut is_inside) = (None, false);
        for index in 0..TICKS {
            let time = index as f32 / TICKS as f32;
            // In by the reach and twice the radius, and out again.
            let depth = (REACH + 2.0 * RADIUS) * (1.0 - (2.0 * time - 1.0) * (2.0 * time - 1.0));
            let position = start - outward * depth + along * (0.003 * sin_cos(40.0 * time).0);
            let (sine, cosine) = sin_cos(0.15 * sin_cos(30.0 * time).0);
            let turn = Vec3::ONE * (sine * 0.577_350_3);
            servo.note(&mut state, Event::LinkAlive);
            servo.note(&mut state, Event::Oriented { quaternion: [turn.x, turn.y, turn.z, cosine] });
            let input = black_box(Input::Sensors { counts: walk.counts(position), enable: true });
            let holds = state.witness().proxy().is_holding();
            let (_, instructions) = counter.count(|| black_box(servo.tick(&mut state, input)));
            located = located.or(state.witness().is_located().then_some(index + 1));
            if holds { &mut holding } else { &mut locating }.add(instructions);
            is_inside = located.is_none() && state.witness().given_up() == Some(ProxyError::Intersects);
            if is_inside {
                break;
            }
        }
        // Read by `palpate budgets`.
        if let Some((fault, tick)) = state.fault() {
            println!("stopped: the {name} on face {index}: {fault} at tick {tick}");
            return Err("the servo found a fault on its path");
        }
        // In a hole the part is on the other side, too: there no hand holds this tool, nor does the loop locate it.
        if is_inside {
            left_out += 1;
            continue;
        }
        let Some(ticks) = located else {
            println!("stopped: the {name} on face {index}: not located within {TICKS} ticks");
            return Err("a tool was never located");
        };
        most = most.max(ticks);
    }
    if left_out == body.faces().len() {
        println!("stopped: the {name} lies in the part 16 mm in front of each of its patches");
        return Err("a tool that is never outside");
    }
    locating.print_as(name, "locating");
    holding.print_as(name, "held");
    println!("\"{name}, ticks until located\" = {most}");
    if left_out > 0 {
        println!("\"{name}, left out: patches with the part 16 mm in front\" = {left_out}");
    }
    println!("\"{name}, bytes of state\" = {}", size_of::<palpate::pair::HeldTool>());
    Ok(())
}
