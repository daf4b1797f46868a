//! `palpate page` and `palpate view`: the page for the browser, as a file and on the loopback.

use super::bake;
use super::device::toml_of;
use super::felt::SoftModes;
use super::output::{print, write_whole};
use crate::devices::{self, DEVICES};
use crate::firmware::Progress;
use crate::models::{self, SHIPPED};
use crate::page::{self, Given, Holdable, Recording, Shown};
use crate::repository;
use anyhow::{Context as _, ensure};
use clap::Args;
use palpate::body::FileHead;
use palpate_sim::devices::OwnDevice;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The body that is shown first.
const FIRST: &str = "capped_box";
/// The body that gives way: its name, its model, its modes.
const SOFT: [&str; 3] = ["foam_box", "capped_box", "host-tests/soft/capped_box.modes.toml"];

/// Writes the page for the browser: every shipped model, rendered by the firmware's own code, with the mouse as stylus.
///
/// One HTML file, usable offline: the firmware's servo loop as wasm, three.js, the models. The first run builds the
/// browser code and installs and lists missing tools.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Folder for the page, index.html
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Address of the documentation that the page links to
    #[arg(long, value_name = "URL", value_parser = address)]
    docs: Option<String>,
}

/// Serves the page with a model on the loopback.
///
/// Prints the address and runs until Ctrl-C.
#[derive(Args, Debug)]
pub struct ViewArguments {
    /// Model: a file, or the name of a shipped one; default: all shipped ones
    model: Option<PathBuf>,
    /// Modes of a model that gives way, from `bake --soft`
    #[arg(long, value_name = "MODES.toml", requires = "model")]
    modes: Option<PathBuf>,
    /// Recorded run of `demo` or `sim`, shown with its body
    #[arg(long, value_name = "FILE.json", conflicts_with = "model")]
    recording: Option<PathBuf>,
    /// Device in the hand: a name, or your own file (my.toml); default: three slides for the mouse
    #[arg(long, value_name = "DEVICE", conflicts_with = "recording")]
    device: Option<PathBuf>,
    /// Port; 0: any free one
    #[arg(long, default_value_t = 0)]
    port: u16,
}

/// Runs `page`.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let links = arguments.docs.iter().map(|docs| ("Documentation".to_owned(), docs.clone())).collect();
    let text = written(Given { first: FIRST.to_owned(), bodies: shipped()?, links, ..given()? })?;
    let out = &arguments.out;
    fs::create_dir_all(out).with_context(|| format!("{}: the folder cannot be made", out.display()))?;
    let path = out.join("index.html");
    write_whole(&path, text.as_bytes())?;
    println!("{}", path.display());
    Ok(ExitCode::SUCCESS)
}

/// Runs `view`.
///
/// # Errors
/// The cause, for the terminal.
pub fn view(arguments: &ViewArguments) -> anyhow::Result<ExitCode> {
    let mut bodies = Vec::new();
    let mut first = FIRST.to_owned();
    if let Some(model) = &arguments.model {
        first = model.file_stem().unwrap_or(model.as_os_str()).to_string_lossy().into_owned();
        bodies.push(match &arguments.modes {
            Some(modes) => soft(&first, model, modes)?,
            None => Shown::new(&first, &bake::file_of(model)?),
        });
    }
    let recording = arguments.recording.as_deref().map(read).transpose()?;
    bodies.extend(shipped()?.into_iter().filter(|body| body.name != first));
    let mut given = Given { first, bodies, recording, ..given()? };
    if let Some(device) = &arguments.device {
        let own = devices::own(device)?;
        let name = &own.file.name;
        if devices::named(&device.to_string_lossy()).is_none() {
            given.devices.retain(|shipped| shipped.name != *name);
            given.devices.push(holdable("yours", own.preset.recommended().settings.stiffness_n_per_m, &own)?);
        }
        given.held = Some(own.file.name);
    }
    let text = written(given)?;
    page::serve(&text, arguments.port, |address| {
        // Whoever reads it may have gone.
        let _ = print(format!("{address}\n").as_bytes());
    })?;
    Ok(ExitCode::SUCCESS)
}

/// An address that a browser opens.
fn address(text: &str) -> Result<String, &'static str> {
    let opens = ["https://", "http://", "./", "../"].iter().any(|start| text.starts_with(start));
    opens.then(|| text.to_owned()).ok_or("an address starts with https://, http://, ./ or ../")
}

/// Writes a page that shows a recording, with its own bodies alone; `false` where the page's code has not been built
/// here before: this sets nothing up.
///
/// # Errors
/// The compiler's error, or a file that cannot be written.
pub(super) fn write_replay(recording: &Recording, path: &Path) -> anyhow::Result<bool> {
    let Some(firmware) = page::compiled(&Progress::new())? else { return Ok(false) };
    let bodies: Vec<Shown> =
        recording.bodies.iter().map(|body| Shown::encoded(&body.name, body.file.clone())).collect();
    let first = bodies.first().map(|body| body.name.clone()).unwrap_or_default();
    // Beside its report.
    let report = path.file_name().unwrap_or_default().to_string_lossy().replace(".replay.html", ".html");
    let links = vec![("The run’s report".to_owned(), format!("./{report}"))];
    let given = Given { first, bodies, links, recording: Some(recording.clone()), ..given()? };
    write_whole(path, page::bundle(&given, &firmware)?.as_bytes())?;
    Ok(true)
}

/// The parts of every page.
fn given() -> anyhow::Result<Given> {
    let mut all = Vec::new();
    for device in DEVICES.iter().filter(|device| device.source.is_some()) {
        let stiffness = device.recommended().settings.stiffness_n_per_m;
        all.push(holdable(device.about, stiffness, &devices::own(Path::new(device.name))?)?);
    }
    let (first, bodies, links) = (String::new(), Vec::new(), Vec::new());
    Ok(Given { first, bodies, devices: all, held: None, script: script(), links, recording: None })
}

fn holdable(about: &str, stiffness: f32, own: &OwnDevice) -> anyhow::Result<Holdable> {
    let file = toml_of(own, "A device of palpate.")?;
    Ok(Holdable { name: own.file.name.clone(), about: about.to_owned(), file, stiffness })
}

fn written(given: Given) -> anyhow::Result<String> {
    let firmware = page::compile(&Progress::new())?;
    page::bundle(&given, &firmware)
}

/// A body that gives way.
fn soft(name: &str, model: &Path, modes: &Path) -> anyhow::Result<Shown> {
    let numbers = SoftModes::read(modes, &models::read(model)?)?.numbers();
    let file = bake::file_of(model)?;
    ensure!(FileHead::of(&file)?.faces > 1, "{}: --modes applies to bodies, and this is one patch", model.display());
    Ok(Shown::new(name, &file).with_modes(&numbers))
}

/// Every model that ships, bodies before patches, and the one that gives way behind the body that it is at rest.
fn shipped() -> anyhow::Result<Vec<Shown>> {
    let mut bodies = Vec::new();
    for (name, _) in SHIPPED {
        let file = bake::file_of(Path::new(name))?;
        bodies.push((FileHead::of(&file)?.faces == 1, Shown::new(name, &file)));
    }
    bodies.sort_by_key(|(is_patch, _)| *is_patch);
    let mut bodies: Vec<Shown> = bodies.into_iter().map(|(_, body)| body).collect();
    let [name, model, modes] = SOFT;
    let behind = bodies.iter().position(|body| body.name == model).map_or(bodies.len(), |index| index + 1);
    bodies.insert(behind, soft(name, Path::new(model), &repository::root()?.join(modes))?);
    Ok(bodies)
}

/// The result of the emulated boards' script.
fn script() -> String {
    let mut text = String::new();
    palpate_bench::exercise::run(&mut |name, tally| text += &format!("{name} {tally}\n"));
    text
}

fn read(path: &Path) -> anyhow::Result<Recording> {
    let text = fs::read_to_string(path).with_context(|| format!("{}: cannot be read", path.display()))?;
    serde_json::from_str(&text).with_context(|| format!("{}: not a recording of a run", path.display()))
}
