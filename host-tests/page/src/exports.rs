//! Functions for JavaScript, on numbers, over one state.
//!
//! Bytes come in through [`input`]: request a buffer, write there, then call. Numbers come out through [`output`] and
//! [`output_length`], words through [`text`] and [`text_length`]; all four are valid until the next call.

use alloc::boxed::Box;
use alloc::string::{String, ToString as _};

use alloc::vec::Vec;
use core::fmt::Write as _;
use core::mem;
use palpate::body::Feature;
use palpate::math::vec3;
use palpate::pair::{Core, Tool};
use palpate::patch::{Patch as _, SplinePatch};
use spin::Mutex;

use crate::basin::{self, Method};
use crate::felt::Loaded;
use crate::knob;
use crate::mesh;
use crate::page::{Choices, Stage};
use crate::replay::Monitor;
use crate::replay::{self, Replay, Run};

struct Exports {
    input: Vec<u32>,
    output: Vec<f32>,
    text: String,
    stage: Option<Stage>,
    others: Vec<Loaded>,
    replay: Option<Box<dyn Replay>>,
    monitor: Monitor,
    dial: Option<knob::Turned>,
}

static STATE: Mutex<Exports> = Mutex::new(Exports {
    input: Vec::new(),
    output: Vec::new(),
    text: String::new(),
    stage: None,
    others: Vec::new(),
    replay: None,
    monitor: Monitor::new(),
    dial: None,
});

impl Exports {
    fn say(&mut self, error: &str) -> i32 {
        self.text.clear();
        self.text.push_str(error);
        -1
    }

    /// The first `length` bytes of the input.
    fn bytes(&self, length: usize) -> &[u8] {
        bytemuck::cast_slice(&self.input).get(..length).unwrap_or_default()
    }

    /// Writes the stage's numbers to the output; returns their number.
    fn write(&mut self, write: impl FnOnce(&Stage, &mut Vec<f32>)) -> usize {
        self.output.clear();
        if let Some(stage) = &self.stage {
            write(stage, &mut self.output);
        }
        self.output.len()
    }
}

fn patch_of(stage: &Stage, face: u32) -> Option<&'static SplinePatch<'static>> {
    stage.loaded.body.faces().get(face as usize).map(|face| &face.patch)
}

/// A buffer of this number of bytes.
#[unsafe(no_mangle)]
pub extern "C" fn input(bytes: usize) -> *const u32 {
    let mut state = STATE.lock();
    state.input.clear();
    state.input.resize(bytes.div_ceil(4), 0);
    state.input.as_ptr()
}

/// Where the numbers are.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const f32 {
    STATE.lock().output.as_ptr()
}

/// How many there are.
#[unsafe(no_mangle)]
pub extern "C" fn output_length() -> usize {
    STATE.lock().output.len()
}

/// Where the words are, in UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    STATE.lock().text.as_ptr()
}

/// How many bytes there are.
#[unsafe(no_mangle)]
pub extern "C" fn text_length() -> usize {
    STATE.lock().text.len()
}

/// Takes the body's file in the input, once in the life of an instance, with the hand at a place: 0, or −1 with a
/// message. The output then is: faces, edges, vertices, whether it is convex, its size, its origin in the model, and
/// whether it is rendered as a patch.
#[unsafe(no_mangle)]
pub extern "C" fn load(length: usize, x: f32, y: f32, z: f32) -> i32 {
    let mut state = STATE.lock();
    let words: &'static [u32] = Box::leak(mem::take(&mut state.input).into_boxed_slice());
    let stage = Loaded::new(words, length).and_then(|loaded| Stage::new(loaded, vec3(x, y, z)));
    match stage {
        Ok(stage) => {
            state.stage = Some(stage);
            state.write(|stage, out| {
                let body = stage.loaded.body;
                let counts = [body.faces().len(), body.edges().len(), body.vertices().len()];
                out.extend(counts.map(|count| count as f32));
                out.extend([f32::from(u8::from(body.is_convex())), body.size()]);
                out.extend(stage.loaded.centre.to_array());
                out.push(f32::from(u8::from(body.faces().len() == 1)));
            });
            0
        }
        Err(error) => state.say(&error),
    }
}

/// Gives the loaded body modes, from `count` numbers in the input: 0, or −1 with a message.
#[unsafe(no_mangle)]
pub extern "C" fn soften(count: usize) -> i32 {
    let mut state = STATE.lock();
    let numbers: Vec<f32> = state.input.iter().take(count).map(|word| f32::from_bits(*word)).collect();
    let Some(stage) = &mut state.stage else { return state.say("there is no body") };
    match stage.soften(&numbers) {
        Ok(()) => 0,
        Err(error) => state.say(&error),
    }
}

/// Of each mode: `q` and its limit, metres, its frequency, Hz, and whether it is held.
#[unsafe(no_mangle)]
pub extern "C" fn modes() -> usize {
    STATE.lock().write(Stage::modes)
}

/// Holds a mode at some `q`, metres, or with a NaN lets go of it.
#[unsafe(no_mangle)]
pub extern "C" fn hold_mode(mode: usize, q: f32) {
    if let Some(soft) = STATE.lock().stage.as_ref().and_then(Stage::soft) {
        soft.grasp(mode, q);
    }
}

/// Takes a device in the hand: the first `label` bytes of the input are what messages call its file, the rest up to
/// `length` the file's text; without one it is the mouse's slides. 0, or −1 with a message. The output then describes it,
/// see [`Stage::describe`], and the text is its name.
#[unsafe(no_mangle)]
pub extern "C" fn hold_device(length: usize, label: usize) -> i32 {
    let mut state = STATE.lock();
    let words = String::from_utf8_lossy(state.bytes(length)).into_owned();
    let Exports { stage: Some(stage), output, text, .. } = &mut *state else { return state.say("there is no body") };
    let held =
        words.split_at_checked(label).ok_or_else(String::new).and_then(|(label, words)| stage.hold(words, label));
    match held {
        Ok(()) => {
            output.clear();
            text.clear();
            text.push_str(stage.describe(output));
            0
        }
        Err(error) => state.say(&error),
    }
}

/// Takes a tool in the hand: a box of half lengths, of which any may be 0, with a ball of some radius rolled over it, metres;
/// with a radius of 0 the point. 0, or −1 and why not.
#[unsafe(no_mangle)]
pub extern "C" fn take_tool(x: f32, y: f32, z: f32, radius: f32) -> i32 {
    let mut state = STATE.lock();
    let Some(stage) = &mut state.stage else { return state.say("there is no body") };
    let core = match [x, y, z] {
        [0.0, 0.0, 0.0] => Core::Point,
        [0.0, 0.0, half] => Core::Segment { half },
        half => Core::Box { half },
    };
    let tool = (radius != 0.0).then(|| Tool::new(core, radius)).transpose().map_err(|error| error.to_string());
    match tool.and_then(|tool| stage.take_tool(tool)) {
        Ok(()) => 0,
        Err(error) => state.say(&error),
    }
}

/// Turns the tool towards an orientation, a quaternion, in the next ticks.
#[unsafe(no_mangle)]
pub extern "C" fn turn_tool(x: f32, y: f32, z: f32, w: f32) {
    if let Some(stage) = &mut STATE.lock().stage {
        stage.turn_tool([x, y, z, w]);
    }
}

/// The tool and its contacts, see [`Stage::tool`].
#[unsafe(no_mangle)]
pub extern "C" fn tool() -> usize {
    STATE.lock().write(Stage::tool)
}

/// The workspace margin of the held device, 0 to 1: 1 well inside, and the force is multiplied by it.
#[unsafe(no_mangle)]
pub extern "C" fn workspace_margin() -> f32 {
    STATE.lock().stage.as_ref().map_or(1.0, Stage::workspace_margin)
}

/// Changes what the loop feels like, see [`Choices`]: 0, or −1 and why not.
#[unsafe(no_mangle)]
pub extern "C" fn choose(rate: f32, stiffness: f32, damping: f32, friction: f32, law: u32, rendering: u32) -> i32 {
    let mut state = STATE.lock();
    let Some(stage) = &mut state.stage else { return state.say("there is no body") };
    match stage.choose(Choices { rate, stiffness, damping, friction, law, rendering }) {
        Ok(()) => 0,
        Err(error) => state.say(&error),
    }
}

/// Restarts with the hand at a place.
#[unsafe(no_mangle)]
pub extern "C" fn restart(x: f32, y: f32, z: f32) {
    if let Some(stage) = &mut STATE.lock().stage {
        stage.restart(vec3(x, y, z));
    }
}

/// Runs a number of ticks, in which the pointer moves straight to a place; the hand yields or not.
#[unsafe(no_mangle)]
pub extern "C" fn run(ticks: u32, x: f32, y: f32, z: f32, yields: u32) {
    if let Some(stage) = &mut STATE.lock().stage {
        stage.run(ticks, vec3(x, y, z), yields != 0);
    }
}

/// Runs a number of ticks with the hand at rest, and nothing else: for a clock.
#[unsafe(no_mangle)]
pub extern "C" fn tick_only(ticks: u32) {
    if let Some(stage) = &mut STATE.lock().stage {
        stage.tick_only(ticks);
    }
}

/// The state after the last tick, as `view.rs` has it.
#[unsafe(no_mangle)]
pub extern "C" fn view() -> usize {
    STATE.lock().write(Stage::view)
}

/// The projection errors of the last run's ticks.
#[unsafe(no_mangle)]
pub extern "C" fn errors() -> usize {
    STATE.lock().write(|stage, out| out.extend(&stage.errors))
}

/// A hash of every bit of the loop's state.
#[unsafe(no_mangle)]
pub extern "C" fn digest() -> u32 {
    STATE.lock().stage.as_ref().map_or(0, Stage::digest)
}

/// The closest point of the body from a standing start: face, `u`, `v`, the point, its distance, evaluations, and
/// whether the search was complete.
#[unsafe(no_mangle)]
pub extern "C" fn closest(x: f32, y: f32, z: f32) -> usize {
    STATE.lock().write(|stage, out| {
        let found = stage.closest(vec3(x, y, z));
        let [u, v] = found.parameters;
        out.extend([f32::from(found.face), u, v]);
        out.extend(found.point.to_array());
        out.extend([found.distance(), f32::from(found.evaluations), f32::from(u8::from(found.complete))]);
    })
}

// Faces, edges and sheets are those of the body as it is now.

/// A face as a grid of points and normals, see `mesh.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn face(index: u32, steps: u32) -> usize {
    STATE.lock().write(|stage, out| {
        mesh::face(stage.loaded.body, index, steps, out);
        stage.displace(out, 1);
    })
}

/// An edge as points and normals, see `mesh.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn edge(index: u32, steps: u32) -> usize {
    STATE.lock().write(|stage, out| {
        mesh::edge(stage.loaded.body, index, steps, out);
        stage.displace(out, 2);
    })
}

/// The kind of edge: 0 convex, 1 smooth, 2 reflex, 3 mixed, 4 open.
#[unsafe(no_mangle)]
pub extern "C" fn edge_kind(index: u32) -> u32 {
    let state = STATE.lock();
    let edge = state.stage.as_ref().and_then(|stage| stage.loaded.body.edges().get(index as usize));
    edge.map_or(4, |edge| edge.kind as u32)
}

/// The border of a feature's Voronoi region, see `regions.rs`; the feature by its code.
#[unsafe(no_mangle)]
pub extern "C" fn sheets(code: u32) -> usize {
    let index = (code & 0x3fff) as u16;
    let feature = match code >> 14 {
        0 => Feature::Face(index),
        1 => Feature::Edge(index),
        _ => Feature::Vertex(index),
    };
    STATE.lock().write(|stage, out| {
        mesh::sheets(stage.loaded.body, feature, out);
        stage.displace(out, 1);
    })
}

/// The way of a method from a start on a face to the closest point of a probe: `u`, `v` and the point of each step.
#[unsafe(no_mangle)]
pub extern "C" fn way(face: u32, x: f32, y: f32, z: f32, u: f32, v: f32, method: u32) -> usize {
    STATE.lock().write(|stage, out| {
        let Some(patch) = patch_of(stage, face) else { return };
        for [u, v] in basin::path(patch, vec3(x, y, z), [u, v], Method::of(method)) {
            out.extend([u, v]);
            // What has left the patch is shown at its border.
            out.extend(patch.evaluate(u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)).point.to_array());
        }
    })
}

/// A row of starts on a face at `u`: steps and distance at the end of each, see `basin.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn basin_row(face: u32, x: f32, y: f32, z: f32, u: f32, columns: u32, method: u32) -> usize {
    STATE.lock().write(|stage, out| {
        if let Some(patch) = patch_of(stage, face) {
            basin::row(patch, vec3(x, y, z), u, columns, Method::of(method), out);
        }
    })
}

/// The million ticks of the emulated boards; the text is what they print. Takes about a second.
#[unsafe(no_mangle)]
pub extern "C" fn exercise() {
    let mut text = String::new();
    palpate_bench::exercise::run(&mut |name, tally| {
        // A string takes all that is written.
        let _ = writeln!(text, "{name} {tally}");
    });
    STATE.lock().text = text;
}

/// Takes the file in the input for another body of a recorded scene: 0, or −1 and why not.
#[unsafe(no_mangle)]
pub extern "C" fn replay_body(length: usize) -> i32 {
    let mut state = STATE.lock();
    let words: &'static [u32] = Box::leak(mem::take(&mut state.input).into_boxed_slice());
    match Loaded::new(words, length) {
        Ok(loaded) => {
            state.others.push(loaded);
            0
        }
        Err(error) => state.say(&error),
    }
}

/// Starts a recorded run on the loaded body, from `count` numbers in the input, of which `of_device` are the device's
/// (see [`Run::of`]): 0, or −1 with a message.
#[unsafe(no_mangle)]
pub extern "C" fn replay_begin(count: usize, of_device: usize, link_timeout: f32, rendering: u32) -> i32 {
    let mut state = STATE.lock();
    let words = mem::take(&mut state.input);
    let numbers: Vec<f32> = words.iter().take(count).map(|word| f32::from_bits(*word)).collect();
    let (Some(stage), Some(run)) = (&state.stage, Run::of(&numbers, of_device, link_timeout, rendering)) else {
        return state.say("there is no body, or the run's numbers are no device's");
    };
    match replay::replay(&run, &stage.loaded, &state.others) {
        Ok(replay) => {
            state.replay = Some(replay);
            0
        }
        Err(error) => state.say(&error),
    }
}

/// Runs recorded ticks: three counts and whether force is requested, four words each, in the input.
#[unsafe(no_mangle)]
pub extern "C" fn replay_run(ticks: usize) {
    let mut state = STATE.lock();
    let Exports { input, replay: Some(replay), .. } = &mut *state else { return };
    for [a, b, c, enable] in input.as_chunks().0.iter().take(ticks) {
        replay.tick([*a as i32, *b as i32, *c as i32], *enable != 0);
    }
}

/// The state after the last recorded tick, as in `view.rs`; of a scene also the foremost body, and each placement.
#[unsafe(no_mangle)]
pub extern "C" fn replay_view() -> usize {
    let mut state = STATE.lock();
    let Exports { output, replay: Some(replay), .. } = &mut *state else { return 0 };
    replay.view(output);
    output.len()
}

/// The hash of the recorded ticks so far.
#[unsafe(no_mangle)]
pub extern "C" fn replay_hash() -> u32 {
    STATE.lock().replay.as_ref().map_or(0, |replay| replay.hash())
}

/// Bytes from a device, in the input. The output is the last record, see `monitor.rs`, and how many came whole and
/// damaged.
#[unsafe(no_mangle)]
pub extern "C" fn monitor(length: usize) -> usize {
    let mut state = STATE.lock();
    let bytes = state.bytes(length).to_vec();
    let Exports { monitor, output, .. } = &mut *state;
    monitor.feed(&bytes);
    monitor.view(output);
    if !output.is_empty() {
        output.extend([monitor.records as f32, monitor.damaged as f32]);
    }
    output.len()
}

/// Sets a part of the simulated knob's feel, see `knob.rs`: 0, or −1 with a message.
#[unsafe(no_mangle)]
pub extern "C" fn knob_set(which: u32, a: f32, b: f32, c: f32, d: f32) -> i32 {
    let mut state = STATE.lock();
    match state.dial.get_or_insert_with(knob::Turned::new).set(knob::part(which, [a, b, c, d])) {
        Ok(()) => 0,
        Err(error) => state.say(&error),
    }
}

/// Runs the knob for a number of ticks, in which fingers turn to an angle, radians, or hold nothing. The output is its
/// view, see `knob.rs`.
#[unsafe(no_mangle)]
pub extern "C" fn knob_run(ticks: u32, to: f32, holds: u32) -> usize {
    let mut state = STATE.lock();
    let Exports { dial, output, .. } = &mut *state;
    let dial = dial.get_or_insert_with(knob::Turned::new);
    dial.run(ticks, to, holds != 0);
    output.clear();
    dial.view(output);
    output.len()
}

/// The knob's torque at `count` places of a turn around an angle, radians, and at the last of them, N·m.
#[unsafe(no_mangle)]
pub extern "C" fn knob_curve(middle: f32, count: u32) -> usize {
    let mut state = STATE.lock();
    let Exports { dial, output, .. } = &mut *state;
    output.clear();
    dial.get_or_insert_with(knob::Turned::new).curve(middle, count, output);
    output.len()
}

/// The same part as a frame for a device, under a number; under −1 a greeting, under −2 a sign of life. The output is its bytes, one
/// a number.
#[unsafe(no_mangle)]
pub extern "C" fn knob_frame(number: i32, which: u32, a: f32, b: f32, c: f32, d: f32) -> usize {
    let mut state = STATE.lock();
    let bytes = knob::frame(number, knob::part(which, [a, b, c, d]));
    state.output.clear();
    state.output.extend(bytes.into_iter().map(f32::from));
    state.output.len()
}

/// The last words of a knob on the line: whether it has greeted, the number that it has answered, or −1, whether that
/// was refused, with the reason as the text; then, of its dial, angle, rate, torque, detent and end.
#[unsafe(no_mangle)]
pub extern "C" fn knob_heard() -> usize {
    let mut state = STATE.lock();
    let Exports { monitor, output, text, .. } = &mut *state;
    text.clear();
    text.push_str(&monitor.heard(output));
    output.len()
}
