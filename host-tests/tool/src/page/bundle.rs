//! One file out of all: a browser opens it without a server, and nothing is fetched.
//!
//! Modules of a page that lies in a file cannot import each other by path. Each is a `data:` address under its bare
//! name in the page's import map; so no bundler is needed, and what the browser runs is what lies in the repository.

use super::recording::{Recording, in_base64};
use crate::repository;
use anyhow::{Context as _, ensure};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Data of a page, as its modules read it.
#[derive(Debug, Serialize)]
pub struct Given {
    /// The name of the body that is shown first.
    pub first: String,
    /// The bodies to choose from.
    pub bodies: Vec<Shown>,
    /// The devices to choose from, beside the mouse.
    pub devices: Vec<Holdable>,
    /// The name of the one that is held first; `None` for the mouse.
    pub held: Option<String>,
    /// State hash after the million ticks of `palpate_bench::exercise` on the host; every tested board must reach the
    /// same.
    pub script: String,
    /// Words and address of each link.
    pub links: Vec<(String, String)>,
    /// A run to show at once.
    pub recording: Option<Recording>,
}

/// A body to choose.
#[derive(Debug, Serialize)]
pub struct Shown {
    /// Its name.
    pub name: String,
    /// Its title in the list.
    pub title: String,
    /// Its file, in base64.
    pub palp: String,
    /// The numbers of its modes, in base64; `None` of a rigid body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub modes: Option<String>,
}

/// A device to choose.
#[derive(Debug, Serialize)]
pub struct Holdable {
    /// Its name.
    pub name: String,
    /// Its full name and its kind of mechanism.
    pub about: String,
    /// The text of its file.
    pub file: String,
    /// Recommended stiffness, N/m.
    pub stiffness: f32,
}

impl Shown {
    /// A body of a name, from its file.
    pub fn new(name: &str, file: &[u8]) -> Self {
        Self::encoded(name, STANDARD.encode(file))
    }

    /// The same, from its file in base64.
    pub fn encoded(name: &str, palp: String) -> Self {
        Self { name: name.to_owned(), title: name.replace('_', " "), palp, modes: None }
    }

    /// The same body with modes of these numbers.
    #[must_use]
    pub fn with_modes(self, numbers: &[f32]) -> Self {
        Self { modes: Some(in_base64(numbers)), ..self }
    }
}

/// The page, with its firmware.
///
/// # Errors
/// If a file of the page, or a placeholder in it, is missing.
pub fn bundle(given: &Given, firmware: &[u8]) -> anyhow::Result<String> {
    let folder = repository::root()?.join("host-tests/page");
    let web = folder.join("web");
    let modules = serde_json::json!({ "imports": modules(&folder)? });
    let mut page = read(&web.join("index.html"))?;
    for (place, text) in [
        ("/*palpate:style*/", read(&web.join("style.css"))?),
        ("/*palpate:modules*/", in_script(&modules)?),
        ("/*palpate:given*/", in_script(given)?),
        ("/*palpate:firmware*/", STANDARD.encode(firmware)),
    ] {
        ensure!(page.matches(place).count() == 1, "{}: {place} is to stand there once", web.display());
        page = page.replace(place, &text);
    }
    Ok(page)
}

/// The address of every module, by its name: three.js, and those of the page.
fn modules(folder: &Path) -> anyhow::Result<BTreeMap<String, String>> {
    let web = folder.join("web");
    let entries = fs::read_dir(&web).with_context(|| format!("{}: cannot be read", web.display()))?;
    let scripts = entries.flatten().map(|entry| entry.path()).filter(|path| path.extension() == Some("js".as_ref()));
    let mut modules = BTreeMap::new();
    for path in scripts.chain([folder.join("three/three.js")]) {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        modules.insert(name, format!("data:text/javascript;base64,{}", STANDARD.encode(read(&path)?)));
    }
    Ok(modules)
}

/// As JSON that ends no script.
fn in_script(value: &impl Serialize) -> anyhow::Result<String> {
    Ok(serde_json::to_string(value)?.replace('<', "\\u003c"))
}

fn read(path: &Path) -> anyhow::Result<String> {
    fs::read_to_string(path).with_context(|| format!("{}: cannot be read", path.display()))
}
